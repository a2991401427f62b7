//! Extraction of a number from the files of a run: by a regular expression, a column of CSV, or a JSON pointer.

use std::collections::BTreeMap;
use std::path::Path;

use apportion_base::files::read_whole;
use apportion_base::text::masked;
use regex_lite::Regex;
use serde_json::Value;

use crate::exchange::number;

/// The source of a number, and how it is extracted.
#[derive(Debug, Clone)]
pub struct Pick {
    /// The text that is read.
    pub source: Source,
    /// How the number is extracted.
    pub method: PickMethod,
}

/// The source of a number.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// Its standard output.
    Stdout,
    /// A file in its directory.
    File(String),
}

/// Which of several matches or rows is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Match {
    /// The first.
    First,
    /// The last.
    Last,
    /// The one of that number, from 0: for a value of a series.
    Number(usize),
}

impl Match {
    /// The values that a study can name, the default first.
    pub const ALL: [Self; 2] = [Self::Last, Self::First];

    /// Returns the name in study files; empty for one of a series, which has none.
    pub fn name(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Last => "last",
            Self::Number(_) => "",
        }
    }

    /// Selects the match.
    fn select<T>(self, mut all: impl Iterator<Item = T>) -> Option<T> {
        match self {
            Self::First => all.next(),
            Self::Last => all.last(),
            Self::Number(number) => all.nth(number),
        }
    }

    /// Formats it as in "its last row", "its row 12".
    fn in_words(self, what: &str) -> String {
        match self {
            Self::Number(number) => format!("{what} {}", number + 1),
            Self::First | Self::Last => format!("{} {what}", self.name()),
        }
    }
}

/// How a number is extracted from a text.
#[derive(Debug, Clone)]
pub enum PickMethod {
    /// The first group of a regular expression, or all of the match if it has none.
    Regex(Regex, Match),
    /// A column of a CSV table with a header.
    Column(String, Match),
    /// A JSON pointer (RFC 6901).
    Pointer(String),
}

/// Maximum number of bytes read from a file.
pub(super) const MAX_BYTES: u64 = 1 << 28;

impl Source {
    fn in_words(&self) -> String {
        match self {
            Self::Stdout => "the standard output".to_owned(),
            Self::File(name) => format!("`{name}`"),
        }
    }

    /// Returns the text of the source in the directory of a run.
    fn text(&self, directory: &Path) -> Result<String, String> {
        let (path, file) = match self {
            Self::Stdout => (directory.join(STDOUT), "standard output".to_owned()),
            Self::File(name) => (directory.join(name), name.clone()),
        };
        let reason = match std::fs::metadata(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(format!("the run wrote no file `{file}`"));
            }
            Err(error) => error.to_string(),
            Ok(data) if data.len() > MAX_BYTES => "it has more than 256 MiB".to_owned(),
            Ok(data) if !data.is_file() => "it is not a file".to_owned(),
            Ok(_) => match read_whole(&path) {
                Ok(bytes) => return Ok(String::from_utf8_lossy(&bytes).into_owned()),
                Err(error) => error.to_string(),
            },
        };
        Err(format!("`{file}` cannot be read: {reason}"))
    }
}

impl Pick {
    /// Returns the number of a run; `texts` caches the texts that have been read. It may be non-finite, as written.
    pub(super) fn number(&self, directory: &Path, texts: &mut Texts) -> Result<f64, String> {
        let text = texts.entry(self.source.clone()).or_insert_with(|| self.source.text(directory));
        self.method.number(text.as_deref().map_err(|reason| reason.clone())?, &self.source.in_words())
    }

    /// Returns the pick of value number `number` of a series, from 0: the match, row or list item of that number.
    #[must_use]
    pub fn of_value(&self, number: usize) -> Self {
        let method = match &self.method {
            PickMethod::Regex(regex, _) => PickMethod::Regex(regex.clone(), Match::Number(number)),
            PickMethod::Column(column, _) => PickMethod::Column(column.clone(), Match::Number(number)),
            PickMethod::Pointer(pointer) => PickMethod::Pointer(format!("{pointer}/{number}")),
        };
        Self { source: self.source.clone(), method }
    }
}

/// Name of the file in the directory of a run with the standard output of the program.
pub(super) const STDOUT: &str = "stdout.txt";

/// The texts of a run that have been read.
pub(super) type Texts = BTreeMap<Source, Result<String, String>>;

impl PickMethod {
    /// Extracts the number from `text`, which is named `of` in errors.
    ///
    /// ```
    /// use apportion_files::{Match, PickMethod};
    ///
    /// let method = PickMethod::Pointer("/result/force".to_owned());
    /// assert_eq!(method.number("{\"result\": {\"force\": 1.5}}", "it"), Ok(1.5));
    /// let method = PickMethod::Column("y".to_owned(), Match::Last);
    /// assert_eq!(method.number("t,y\n0,1\n1,2.5\n", "it"), Ok(2.5));
    /// ```
    ///
    /// # Errors
    /// A message if there is no number.
    pub fn number(&self, text: &str, of: &str) -> Result<f64, String> {
        let digits = match self {
            Self::Regex(regex, which) => {
                let groups = which.select(regex.captures_iter(text));
                match (groups.and_then(|groups| groups.get(1).or_else(|| groups.get(0))), which) {
                    (Some(part), _) => part.as_str().to_owned(),
                    (None, Match::Number(_)) => {
                        return Err(format!("{of} has no {}", which.in_words("match of the regex")));
                    }
                    (None, _) => return Err(format!("nothing in {of} matches the regex")),
                }
            }
            Self::Column(column, which) => cell(text, column, *which, of)?,
            Self::Pointer(pointer) => {
                let value: Value = serde_json::from_str(text).map_err(|_| format!("{of} is not JSON"))?;
                match value.pointer(pointer).ok_or_else(|| format!("{of} has no value at `{pointer}`"))? {
                    Value::Null => return Ok(f64::NAN),
                    Value::String(text) => text.clone(),
                    other => other.to_string(),
                }
            }
        };
        number(digits.trim()).ok_or_else(|| format!("the text found in {of} is not a number: `{}`", masked(&digits)))
    }
}

/// Returns the cell of a column in one row of a CSV table.
fn cell(text: &str, column: &str, which: Match, of: &str) -> Result<String, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).flexible(true).from_reader(text.as_bytes());
    let place = reader.headers().ok().and_then(|names| names.iter().position(|name| name == column));
    let place = place.ok_or_else(|| format!("{of} has no column `{column}`"))?;
    let row = which.select(reader.records().map_while(Result::ok));
    let row = row.ok_or_else(|| match which {
        Match::Number(_) => format!("{of} has no {}", which.in_words("row")),
        Match::First | Match::Last => format!("{of} has no row"),
    })?;
    match row.get(place) {
        Some(cell) => Ok(cell.to_owned()),
        None => Err(format!("{of} has no cell of column `{column}` in its {}", which.in_words("row"))),
    }
}
