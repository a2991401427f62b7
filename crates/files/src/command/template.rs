//! Input files made from a template: text in which `{{name}}` is replaced by the value of a factor.

use std::ops::Range;

use thiserror::Error;

/// A parsed template.
///
/// ```
/// use apportion_files::InputTemplate;
///
/// let factor = |name: &str| (name == "length").then_some(0);
/// let template = InputTemplate::parse("L = {{ length }} um\nbraces: {{{{}}\n", &factor)?;
/// assert_eq!(template.fill(|_, out| out.push_str("225.0")), "L = 225.0 um\nbraces: {{}}\n");
/// let error = InputTemplate::parse("a\nL = {{lenght}}", &factor).unwrap_err();
/// assert_eq!((error.line, error.column), (2, 7));
/// # Ok::<(), apportion_files::TemplateError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputTemplate {
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(String),
    Factor(usize),
}

/// An error in a template, with its place.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{problem}")]
pub struct TemplateError {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The problem.
    pub(crate) problem: TemplateProblem,
}

/// A problem of a template.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(crate) enum TemplateProblem {
    /// A placeholder without an end.
    #[error("`{{{{` without `}}}}` on the same line: write `{{{{{{{{` for two braces that are part of the text")]
    Open,
    /// A placeholder with an unknown name.
    #[error("there is no factor `{0}`")]
    Unknown(String),
}

impl InputTemplate {
    /// Parses a template; `factor` finds factors by name. `{{{{` is two braces of the text itself.
    ///
    /// # Errors
    /// [`TemplateError`] for a name that is not a factor's, and for a placeholder without an end.
    pub fn parse(text: &str, factor: &dyn Fn(&str) -> Option<usize>) -> Result<Self, TemplateError> {
        let (mut parts, mut plain, mut place) = (Vec::new(), String::new(), 0);
        while let Some(open) = text[place..].find("{{").map(|offset| place + offset) {
            plain.push_str(&text[place..open]);
            let rest = &text[open + 2..];
            if rest.starts_with("{{") {
                plain.push_str("{{");
                place = open + 4;
                continue;
            }
            let inside = rest.find("}}").map(|end| 0..end).filter(|inside| !rest[inside.clone()].contains('\n'));
            let Some(Range { end, .. }) = inside else { return Err(error(text, open, TemplateProblem::Open)) };
            let name = rest[..end].trim();
            let Some(number) = factor(name) else {
                let start = open + 2 + rest[..end].len() - rest[..end].trim_start().len();
                return Err(error(text, start, TemplateProblem::Unknown(name.to_owned())));
            };
            parts.push(Part::Text(std::mem::take(&mut plain)));
            parts.push(Part::Factor(number));
            place = open + 2 + end + 2;
        }
        plain.push_str(&text[place..]);
        parts.push(Part::Text(plain));
        Ok(Self { parts })
    }

    /// Returns whether the factor of that number is used in the text.
    pub fn uses(&self, factor: usize) -> bool {
        self.parts.contains(&Part::Factor(factor))
    }

    /// Returns the text with each placeholder replaced by what `write` appends.
    pub fn fill(&self, write: impl Fn(usize, &mut String)) -> String {
        let mut text = String::new();
        for part in &self.parts {
            match part {
                Part::Text(plain) => text.push_str(plain),
                Part::Factor(factor) => write(*factor, &mut text),
            }
        }
        text
    }
}

fn error(text: &str, place: usize, problem: TemplateProblem) -> TemplateError {
    let start = text[..place].rfind('\n').map_or(0, |newline| newline + 1);
    let line = text[..place].matches('\n').count() + 1;
    TemplateError { line, column: text[start..place].chars().count() + 1, problem }
}
