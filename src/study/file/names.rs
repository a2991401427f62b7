//! The names and the title in a study file: plain, and short enough for every table, chart and file.

use std::ops::Range;

use super::context::{Context, Fault};
use super::error::Problem;
use super::sections::{At, StudyFile};
use crate::names::{refused_name, refused_output_name, refused_title, shown};
use crate::space::Space;
use crate::study::Subject;

/// Names stand in every table and chart: they are refused before the work, not when they do not fit.
pub(super) fn refuse_names(context: &Context<'_>, file: &StudyFile) -> Result<(), Fault> {
    let wrong = |key: &str, (found, span): (&str, Range<usize>), expected: String| {
        let (key, found) = (key.to_owned(), shown(found));
        Err(context.fault(span, Problem::WrongType { key, expected, found }))
    };
    if let Some(title) = &file.title
        && let Some(expected) = refused_title(title.get_ref())
    {
        return wrong("title", (title.get_ref(), title.span()), expected);
    }
    for section in &file.factor {
        let fields = section.get_ref();
        let words = |what, at: &At<String>| (what, at.get_ref().clone(), at.span());
        let labels =
            fields.labels.iter().flat_map(|labels| labels.get_ref().iter().map(|l| (l.clone(), labels.span())));
        let labels = labels.map(|(label, span)| ("label", label, span));
        let group = fields.group.iter().map(|group| words("group", group));
        for (what, text, span) in [words("name", &fields.name)].into_iter().chain(group).chain(labels) {
            // Empty ones are told of where it is known what they would be for.
            let expected = refused_name(&text).filter(|_| what == "group" || !text.trim().is_empty());
            if let Some(expected) = expected {
                return wrong(&format!("{what} of a factor"), (&text, span), expected);
            }
        }
    }
    Ok(())
}

/// The same for outputs, after which files are named.
pub(super) fn refuse_output_names(context: &Context<'_>, subject: &dyn Subject, space: &Space) -> Result<(), Fault> {
    let model = subject.model(space);
    let refused = |name: &str| Some((name.to_owned(), refused_output_name(name)?));
    let Some((name, expected)) = model.outputs().iter().find_map(|output| refused(&output.name)) else { return Ok(()) };
    // Where it stands first; escaped ones are not found.
    let start = context.text.find(&name).unwrap_or(0);
    let end = if context.text[start..].starts_with(&name) { start + name.len() } else { start };
    let (key, found) = ("name of an output".to_owned(), shown(&name));
    Err(context.fault(start..end, Problem::WrongType { key, expected, found }))
}
