//! From the text of a study file to [`StudyFile`], and what the reader of TOML says in the words of studies.

use serde::Deserialize;
use toml::de::{DeTable, Deserializer};

use super::context::{Context, Fault};
use super::error::{Problem, meant};
use super::forms::normalise;
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
        _ if message.starts_with("duplicate key") && is_factor(context.text.get(span.clone())) => {
            let right = "of several factors each is a table [[factor]], with two brackets, or [factor.NAME]";
            Problem::Syntax(format!("the table [factor] stands here twice: {right}"))
        }
        _ if message.contains("unquoted key") && !is_ascii(context.text.get(span.clone())) => {
            Problem::Syntax(format!("{message}: a key of other letters stands in quotes, as in \"größe\" = 2"))
        }
        _ if message.contains("dotted key") => {
            Problem::Syntax(format!("{message}: a key that has a dot itself stands in quotes, as in \"0.5\" = 2"))
        }
        _ => Problem::Syntax(in_words(message)),
    };
    context.fault(span, problem)
}

fn is_ascii(text: Option<&str>) -> bool {
    text.is_none_or(str::is_ascii)
}

fn is_factor(key: Option<&str>) -> bool {
    matches!(key, Some("factor" | "factors"))
}

/// A key of no meaning where it stands: of another table perhaps, by our name or by another one.
fn unknown_key(name: String, expected: Vec<String>) -> Problem {
    let nearest = meant(&name, expected.iter().map(String::as_str));
    let elsewhere = || match table_of(&name) {
        Some(table) => Some(format!("it stands {table}")),
        None => {
            let ours = meant_elsewhere(&name)?;
            Some(format!("did you mean `{ours}`, which stands {}?", table_of(&ours)?))
        }
    };
    match elsewhere().filter(|_| nearest.is_none()) {
        Some(right) => Problem::Misplaced { name, right },
        None => Problem::UnknownKey { name, nearest, expected },
    }
}

/// Where a key stands in a study file, in words; `None` if there is no such key.
fn table_of(key: &str) -> Option<&'static str> {
    let tables = [
        ("", "at the top of the file, above the first table"),
        ("[design]", "in the table [design]"),
        ("[analysis]", "in the table [analysis]"),
        ("[[factor]]", "in the table [[factor]] of a factor"),
        ("[noise]", "in the table [noise]"),
        ("[command]", "in the table [command]"),
        ("[expression]", "in the table [expression]"),
    ];
    // What stands there is wrong in any case: the question is whether the key is.
    let knows = |head: &str| {
        let text = format!("{head}\n{} = 0", toml_edit::Key::new(key));
        let root = DeTable::parse(&text).map_err(|error| error.to_string());
        let read =
            root.and_then(|root| StudyFile::deserialize(Deserializer::from(root)).map_err(|error| error.to_string()));
        read.map_or_else(|message| !message.contains("unknown field"), |_| true)
    };
    tables.into_iter().find(|(head, _)| knows(head)).map(|(_, words)| words)
}

/// Our key for one of another program, whichever table it belongs to.
fn meant_elsewhere(name: &str) -> Option<String> {
    ["base_samples", "sampler", "max_runs", "second_order", "factor", "command"]
        .into_iter()
        .find(|ours| meant(name, [*ours]).is_some())
        .map(str::to_owned)
}

/// The deserialiser's message without the names of Rust types.
fn in_words(message: &str) -> String {
    const WORDS: [(&str, &str); 15] = [
        ("expected struct NoiseSection", "expected a table [noise]"),
        ("expected f64", "expected a number"),
        ("expected u64", "expected a whole number from 0 to 9223372036854775807"),
        ("expected struct DesignSection", "expected a table [design]"),
        ("expected struct AnalysisSection", "expected a table [analysis]"),
        ("expected struct TargetSection", "expected a table, as in { half_width = 0.01 }"),
        ("expected struct DependenceSection", "expected a table [[dependence]]"),
        (
            "data did not match any variant of untagged enum Correlation",
            "expected a number, or a matrix as in [[1, 0.5], [0.5, 1]]",
        ),
        ("expected struct FactorSection", "expected a table [[factor]]"),
        ("expected struct CommandSection", "expected a table [command]"),
        ("expected struct ExpressionSection", "expected a table [expression]"),
        ("expected a map", "expected a table"),
        ("expected a sequence", "expected a list in square brackets"),
        ("expected a string", "expected a text in quotes"),
        ("floating point", "the number"),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (from, to)| text.replace(from, to))
}
