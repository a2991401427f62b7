//! Conversion of the text of a study file to [`StudyFile`], with the TOML reader's errors in the words of studies.

use apportion::design::{DesignError, MAX_FACTORS};
use apportion::study::BuildError;
use serde::Deserialize;
use toml::de::{DeTable, Deserializer};

use super::context::{self, Context, Fault};
use super::error::{Problem, meant};
use super::forms::{join_factors, normalise};
use super::schema::study_schema;
use super::sections::StudyFile;

/// Parses the text of `context`.
pub(super) fn study_file(context: &Context<'_>) -> Result<StudyFile, Fault> {
    let mut root = DeTable::parse(context.text).map_err(|error| syntax(context, &error))?;
    normalise(context, root.get_mut())?;
    let mut file = StudyFile::deserialize(Deserializer::from(root)).map_err(|error| syntax(context, &error))?;
    join_factors(context, &mut file)?;
    // Before any of them is processed.
    if let Some(first) = file.factor.get(MAX_FACTORS) {
        let problem = BuildError::Design(DesignError::FarTooManyFactors { factors: file.factor.len() });
        return Err(context.fault(first.span(), problem.into()));
    }
    Ok(file)
}

fn syntax(context: &Context<'_>, error: &toml::de::Error) -> Fault {
    context.fault(error.span().unwrap_or(0..0), problem(error))
}

/// Converts an error of the TOML reader to the words of studies.
pub(super) fn problem(error: &toml::de::Error) -> Problem {
    let message = error.message();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match &quoted[..] {
        [name, expected @ ..] if message.starts_with("unknown field") => unknown_key(name, expected),
        _ if message.contains("unquoted key") => {
            Problem::new(format!("{message}: put a key with other letters in quotes, as in \"größe\" = 2"))
        }
        _ => Problem::new(in_words(message)),
    }
}

/// Returns the problem of a key that its table does not have: it may belong to another one.
fn unknown_key(name: &str, expected: &[&str]) -> Problem {
    let other = keys_of_tables().into_iter().find(|(_, keys)| keys.iter().any(|key| key == name));
    match other.filter(|_| meant(name, expected.iter().copied()).is_none()) {
        Some((place, _)) => Problem::misplaced(name, &format!("it belongs {place}")),
        None => context::unknown_key(name, expected.iter().copied()),
    }
}

/// Lists the tables of a study file, in words, with their keys, from the schema.
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

/// Replaces the type names in the deserialiser's message by common ones.
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
