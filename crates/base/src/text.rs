//! Text for people, CSV cells that spreadsheets do not execute, and messages of programs shortened to one line that is
//! the same for the same cause.

/// Joins a list as in prose: `a`, `a and b`, `a, b and c`.
///
/// ```
/// assert_eq!(apportion_base::text::listed(&["length", "width", "height"]), "length, width and height");
/// ```
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

/// Returns `word` with its first letter as a capital.
pub fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Maximum length of a subscript; a longer one is part of a name, unless it names a Greek letter.
const LONGEST_SUBSCRIPT: usize = 4;

/// Names that represent a letter in a subscript.
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

/// Returns the subscript as it is typeset, if valid: up to four letters or digits, or the name of a Greek letter.
pub fn subscript(text: &str) -> Option<&str> {
    let greek = GREEK.iter().find(|(name, _)| *name == text).map(|(_, letter)| *letter);
    let fits = (1..=LONGEST_SUBSCRIPT).contains(&text.chars().count());
    greek.or((fits && text.chars().all(is_of_symbol)).then_some(text))
}

/// Returns whether a symbol may begin with the letter.
fn is_letter(c: char) -> bool {
    c.is_ascii_alphabetic() || matches!(c, 'Α'..='Ω' | 'α'..='ω' | 'ϕ' | 'ϑ' | 'µ')
}

fn is_of_symbol(c: char) -> bool {
    is_letter(c) || c.is_ascii_digit()
}

/// Splits a word such as `F_cr` into letter and subscript; returns `None` if it is not a symbol.
pub fn symbol(word: &str) -> Option<(&str, &str)> {
    let (letter, below) = word.split_once('_')?;
    let mut letters = letter.chars();
    let single = letters.next().is_some_and(is_letter) && letters.next().is_none();
    Some((letter, subscript(below).filter(|_| single)?))
}

/// Returns a text as a CSV field, quoted where required (RFC 4180).
pub fn csv_field(text: &str) -> String {
    let text = inert(text.to_owned());
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}

/// First characters that make a spreadsheet read a formula, or a reader of tables a comment.
const FORMULA: [char; 5] = ['=', '+', '-', '@', '#'];

/// Prefixes a text that a spreadsheet would take for a formula with an apostrophe. Numbers are unchanged.
pub fn inert(text: String) -> String {
    if text.starts_with(FORMULA) && text.parse::<f64>().is_err() { format!("'{text}") } else { text }
}

/// Returns a text without the apostrophe of [`inert`].
pub fn plain_field(text: &str) -> &str {
    text.strip_prefix('\'').filter(|text| text.starts_with(FORMULA)).unwrap_or(text)
}

/// Maximum number of characters of a program's message in a reason.
const MAX_LETTERS: usize = 120;

/// Shortens the message of a program to one line, for reasons.
pub fn shortened(text: &str) -> String {
    cut(text.trim(), MAX_LETTERS)
}

/// Returns the text on one line of at most `most` characters, without those that would change the terminal.
pub fn cut(text: &str, most: usize) -> String {
    let clean = text.trim_end().chars().map(|c| if c.is_control() { ' ' } else { c });
    let mut short: String = clean.take(most).collect();
    if text.trim_end().chars().nth(most).is_some() {
        short.push_str("...");
    }
    short
}

/// Returns the same with every number as `#`, so that reasons that differ only in numbers are counted together.
pub fn masked(text: &str) -> String {
    let mut out = String::new();
    let mut letters = text.trim().chars().peekable();
    let mut before = ' ';
    while let Some(c) = letters.next() {
        let begins = c.is_ascii_digit() && !before.is_alphanumeric() && before != '_';
        if !begins {
            out.push(c);
            before = c;
            continue;
        }
        if out.ends_with(['-', '+']) {
            out.pop();
        }
        let mut last = c;
        while let Some(&next) = letters.peek() {
            let goes_on = next.is_ascii_digit()
                || matches!(next, '.' | 'e' | 'E')
                || (matches!(next, '-' | '+') && matches!(last, 'e' | 'E'));
            if !goes_on {
                break;
            }
            last = next;
            letters.next();
        }
        out.push('#');
        before = '#';
    }
    shortened(&out)
}

/// Formats a duration for people.
pub fn seconds(duration: std::time::Duration) -> String {
    format!("{} s", duration.as_secs_f64())
}

#[cfg(test)]
#[path = "tests/text.rs"]
mod tests;
