//! Conversion of the text of a study file to [`StudyFile`], with the TOML reader's errors in the words of studies.
//!
//! `[factors]` becomes a list of `[[factor]]`, and `noise` one more factor; every value keeps its position in the file.

use apportion::design::Design;
use std::borrow::Cow;

use apportion::design::DesignError;
use apportion::study::BuildError;
use apportion_base::names::nearest;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::at::At;
use super::context::{self, Context, Fault};
use super::distribution;
use super::error::Problem;
use super::schema::study_schema;
use super::sections::{FactorSection, StudyFile};

/// Parses the text of `context`.
pub(super) fn study_file(context: &Context) -> Result<StudyFile, Fault> {
    let mut root = DeTable::parse(&context.text).map_err(|error| syntax(context, &error))?;
    normalise(context, root.get_mut())?;
    refuse_unknown_distributions(context, root.get_ref())?;
    let mut file = StudyFile::deserialize(Deserializer::from(root)).map_err(|error| syntax(context, &error))?;
    join_factors(context, &mut file)?;
    // Before any of them is processed.
    if let Some(first) = file.factor.get(Design::MAX_FACTORS) {
        let problem = BuildError::Design(DesignError::FarTooManyFactors { factors: file.factor.len() });
        return Err(context.fault(first.span(), problem.into()));
    }
    Ok(file)
}

fn syntax(context: &Context, error: &toml::de::Error) -> Fault {
    context.fault(error.span().unwrap_or(0..0), problem(error))
}

/// Converts an error of the TOML reader to the words of studies.
pub(super) fn problem(error: &toml::de::Error) -> Problem {
    let message = error.message();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match &quoted[..] {
        [name, valid @ ..] if message.starts_with("unknown field") => unknown_key(name, valid),
        _ if message.contains("unquoted key") => {
            Problem::new(format!("{message}: put a key with other letters in quotes, as in \"größe\" = 2"))
        }
        _ => Problem::new(in_words(message)),
    }
}

/// The keys of the tables of a study file: a JSON pointer into its schema, and the place of the table in words.
const TABLES: [(&str, &str); 5] = [
    ("/properties", "at the top of the file, above the first table"),
    ("/definitions/DesignSection/properties", "in the table [design]"),
    ("/definitions/AnalysisSection/properties", "in the table [analysis]"),
    ("/definitions/FactorSection/properties", "in the table of a factor"),
    ("/definitions/CommandSection/properties", "in the table [command]"),
];

/// Returns the problem of a key that its table does not have: it may belong to another one.
fn unknown_key(name: &str, valid: &[&str]) -> Problem {
    if nearest(name, valid.iter().copied()).is_none() {
        let schema = study_schema();
        for (keys, place) in TABLES {
            if schema.pointer(keys).is_some_and(|keys| keys.get(name).is_some()) {
                return Problem::misplaced(name, &format!("it belongs {place}"));
            }
        }
    }
    context::unknown_key(name, valid.iter().copied())
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

/// Converts `root`, a study file, to the form of `StudyFile`: `noise = "seed"` is `noise.name = "seed"`, and
/// `command = ["./model"]` is `command.program = ["./model"]`.
fn normalise(context: &Context, root: &mut DeTable<'_>) -> Result<(), Fault> {
    if let Some((key, _)) = root.get_key_value("factor").filter(|(_, value)| value.get_ref().is_table()) {
        let right = "factors are lines of the table `[factors]`, or tables `[[factor]]`";
        return Err(context.fault(key.span(), Problem::misplaced("factor", right)));
    }
    for (table, key) in [("noise", "name"), ("command", "program")] {
        let Some(typed) = root.get_mut(table) else { continue };
        if typed.get_ref().is_str() && table == "noise" || typed.get_ref().is_array() && table == "command" {
            let key = Spanned::new(typed.span(), Cow::Borrowed(key));
            let value = Spanned::new(typed.span(), typed.get_ref().clone());
            *typed.get_mut() = DeValue::Table(DeTable::from_iter([(key, value)]));
        }
    }
    Ok(())
}

/// Refuses an unknown distribution before its keys, which are mostly unknown too.
fn refuse_unknown_distributions(context: &Context, root: &DeTable<'_>) -> Result<(), Fault> {
    let list = root.get("factor").and_then(|list| list.get_ref().as_array()).into_iter().flatten();
    let lines = root.get("factors").and_then(|table| table.get_ref().as_table()).into_iter().flat_map(|t| t.values());
    for factor in list.chain(lines) {
        if let Some(typed) = factor.get_ref().get("distribution")
            && let Some(name) = typed.get_ref().as_str()
        {
            distribution::kind(name).map_err(|problem| context.fault(typed.span(), problem))?;
        }
    }
    Ok(())
}

/// Joins the factors in one list, each with its name: those of `[[factor]]`, or of the lines of `[factors]` in the
/// order of the file; the seed of a stochastic model is the last one.
fn join_factors(context: &Context, file: &mut StudyFile) -> Result<(), Fault> {
    if let Some(factor) = file.factor.iter().find(|factor| factor.get_ref().name.span().is_empty()) {
        return Err(context.fault(factor.span(), Problem::new("missing field `name`")));
    }
    let mut lines: Vec<_> = std::mem::take(&mut file.factors).into_iter().collect();
    lines.sort_by_key(|(name, _)| name.span().start);
    if let (Some((name, _)), false) = (lines.first(), file.factor.is_empty()) {
        let right = "factors are also listed in `[[factor]]`: keep one of the two";
        return Err(context.fault(name.span(), Problem::misplaced("factors", right)));
    }
    for (name, line) in lines {
        let span = line.span();
        let fields = line.into_inner();
        if !fields.name.span().is_empty() {
            let right = "the name of this factor is the key before its table";
            return Err(context.fault(fields.name.span(), Problem::misplaced("name", right)));
        }
        file.factor.push(At::new(span, FactorSection { name, ..fields }));
    }
    if let Some(noise) = &file.noise {
        let seed = At::new(noise.span(), "seed".to_owned());
        let name = noise.get_ref().name.clone().unwrap_or_else(|| seed.clone());
        let fields = FactorSection { name, distribution: Some(seed), ..FactorSection::default() };
        file.factor.push(At::new(noise.span(), fields));
    }
    Ok(())
}
