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

/// A text as a CSV field, quoted where it must be (RFC 4180).
pub fn csv_field(text: &str) -> String {
    let text = inert(text.to_owned());
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}

/// What a text begins with that a spreadsheet takes for a formula.
const FORMULA: [char; 4] = ['=', '+', '-', '@'];

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
