//! Texts for people, and texts as cells of CSV that no spreadsheet runs.

/// A list as people say it: `a`, `a and b`, `a, b and c`.
///
/// ```
/// assert_eq!(apportion::report::listed(&["length", "width", "height"]), "length, width and height");
/// ```
#[cfg(feature = "charts")]
pub fn listed<S: AsRef<str>>(items: &[S]) -> String {
    match items {
        [] => String::new(),
        [one] => one.as_ref().to_owned(),
        [most @ .., last] => {
            let most: Vec<&str> = most.iter().map(AsRef::as_ref).collect();
            format!("{} and {}", most.join(", "), last.as_ref())
        }
    }
}

/// `word` with its first letter a capital.
pub fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Most letters and digits of a subscript; what is longer is a name, unless it is that of a Greek letter.
#[cfg(feature = "charts")]
const LONGEST_SUBSCRIPT: usize = 4;

/// Names that stand for a letter in a subscript.
#[cfg(feature = "charts")]
const GREEK: [(&str, &str); 12] = [
    ("theta", "θ"),
    ("phi", "φ"),
    ("psi", "ψ"),
    ("alpha", "α"),
    ("beta", "β"),
    ("gamma", "γ"),
    ("delta", "δ"),
    ("sigma", "σ"),
    ("omega", "ω"),
    ("lambda", "λ"),
    ("mu", "μ"),
    ("tau", "τ"),
];

/// The subscript as it is set, if it may be one: at most four letters or digits, or the name of a Greek letter.
#[cfg(feature = "charts")]
pub(crate) fn subscript(text: &str) -> Option<&str> {
    let greek = GREEK.iter().find(|(name, _)| *name == text).map(|(_, letter)| *letter);
    let fits = (1..=LONGEST_SUBSCRIPT).contains(&text.chars().count());
    greek.or((fits && text.chars().all(is_of_symbol)).then_some(text))
}

/// Whether a symbol may begin with the letter.
#[cfg(feature = "charts")]
pub(crate) fn is_letter(c: char) -> bool {
    c.is_ascii_alphabetic() || matches!(c, 'Α'..='Ω' | 'α'..='ω' | 'ϕ' | 'ϑ' | 'µ')
}

#[cfg(feature = "charts")]
fn is_of_symbol(c: char) -> bool {
    is_letter(c) || c.is_ascii_digit()
}

/// The letter and the subscript of a word such as `F_cr`; `None` if it is no symbol.
#[cfg(feature = "charts")]
pub(crate) fn symbol(word: &str) -> Option<(&str, &str)> {
    let (letter, below) = word.split_once('_')?;
    let mut letters = letter.chars();
    let single = letters.next().is_some_and(is_letter) && letters.next().is_none();
    Some((letter, subscript(below).filter(|_| single)?))
}

/// A text as a CSV field, quoted where it must be (RFC 4180).
pub fn csv_field(text: &str) -> String {
    let text = inert(text.to_owned());
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}

/// What a text begins with that a spreadsheet takes for a formula, or a reader of tables for a comment.
const FORMULA: [char; 5] = ['=', '+', '-', '@', '#'];

/// A cell that no spreadsheet runs: a text that it would take for a formula begins with an apostrophe. Numbers stay.
pub fn inert(text: String) -> String {
    if text.starts_with(FORMULA) && text.parse::<f64>().is_err() { format!("'{text}") } else { text }
}

/// A text without the apostrophe of [`inert`].
pub fn plain_field(text: &str) -> &str {
    text.strip_prefix('\'').filter(|text| text.starts_with(FORMULA)).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_no_formulas() {
        for (text, field) in [
            ("=HYPERLINK(\"http://x\",\"y\")", "\"'=HYPERLINK(\"\"http://x\"\",\"\"y\"\")\""),
            ("+x", "'+x"),
            ("-a", "'-a"),
            ("@SUM(1)", "'@SUM(1)"),
            ("# 1", "'# 1"),
            ("-1.5e-3", "-1.5e-3"),
            ("+4", "+4"),
            ("a-b", "a-b"),
        ] {
            assert_eq!(csv_field(text), field);
            let inert = inert(text.to_owned());
            assert_eq!(plain_field(&inert), text);
        }
        assert_eq!(plain_field("'quoted'"), "'quoted'");
    }
}
