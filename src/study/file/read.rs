//! From the text of a study file to [`StudyFile`], and what the reader of TOML says in the words of studies.

use serde::Deserialize;
use toml::de::{DeTable, Deserializer};

use super::context::{Context, Fault};
use super::error::{Problem, meant};
use super::forms::normalise;
use super::schema::study_schema;
use super::sections::StudyFile;

/// What stands in the text of `context`.
pub(super) fn study_file(context: &Context<'_>) -> Result<StudyFile, Fault> {
    let mut root = DeTable::parse(context.text).map_err(|error| syntax(context, &error))?;
    normalise(context, root.get_mut())?;
    StudyFile::deserialize(Deserializer::from(root)).map_err(|error| syntax(context, &error))
}

fn syntax(context: &Context<'_>, error: &toml::de::Error) -> Fault {
    let message = error.message();
    let span = error.span().unwrap_or(0..0);
    let mut quoted = message.split('`').skip(1).step_by(2).map(str::to_owned);
    let problem = match quoted.next() {
        Some(name) if message.starts_with("unknown field") => unknown_key(name, quoted.collect()),
        _ if message.contains("unquoted key") => {
            Problem::Syntax(format!("{message}: a key of other letters stands in quotes, as in \"größe\" = 2"))
        }
        _ => Problem::Syntax(in_words(message)),
    };
    context.fault(span, problem)
}

/// A key of no meaning where it stands: of another table perhaps, by our name or by another one.
fn unknown_key(name: String, expected: Vec<String>) -> Problem {
    let nearest = meant(&name, expected.iter().map(String::as_str));
    if nearest.is_none() {
        let tables = keys_of_tables();
        let all = || tables.iter().flat_map(|(_, keys)| keys.iter().map(String::as_str));
        let home = |key: &str| tables.iter().find(|(_, keys)| keys.iter().any(|known| known == key));
        if let Some(((place, _), ours)) = meant(&name, all()).and_then(|ours| Some((home(&ours)?, ours))) {
            let right = match ours == name {
                true => format!("it stands {place}"),
                false => format!("did you mean `{ours}`, which stands {place}?"),
            };
            return Problem::Misplaced { name, right };
        }
    }
    Problem::UnknownKey { name, nearest, expected }
}

/// Where keys stand in a study file, in words, and the keys, by the schema.
fn keys_of_tables() -> [(&'static str, Vec<String>); 5] {
    let schema = study_schema();
    let keys = |table: &serde_json::Value| {
        table["properties"].as_object().map(|keys| keys.keys().cloned().collect()).unwrap_or_default()
    };
    let of = |table: &str| keys(&schema["definitions"][table]);
    [
        ("at the top of the file, above the first table", keys(&schema)),
        ("in the table [design]", of("DesignSection")),
        ("in the table [analysis]", of("AnalysisSection")),
        ("in the table of a factor", of("FactorSection")),
        ("in the table [command]", of("CommandSection")),
    ]
}

/// The deserialiser's message with the names that people have for its types.
fn in_words(message: &str) -> String {
    const WORDS: [(&str, &str); 5] = [
        ("expected f64", "expected a number"),
        ("expected u64", "expected a whole number from 0 to 9223372036854775807"),
        ("expected a map", "expected a table"),
        ("expected a sequence", "expected a list in square brackets"),
        ("expected a string", "expected a text in quotes"),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (from, to)| text.replace(from, to))
}
