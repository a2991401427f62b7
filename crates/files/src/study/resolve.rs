//! Conversion of the text of a study file to [`StudyFile`], with the TOML reader's errors in the words of studies, and to
//! a study: every check of a study file, once.
//!
//! `[factors]` becomes a list of `[[factor]]`, and `noise` one more factor; every value keeps its position in the file.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use apportion::StudyBuilder;
use apportion::design::{DesignError, MAX_FACTORS};
use apportion::model::Input;
use apportion::space::{Distribution, Factor, Space};
use apportion::study::{BuildError, Study};
use apportion_base::names::file_part;
use apportion_base::quantity::Unit;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::context::{self, Context, Fault, unknown_name};
use super::distribution::{in_words_of_units, refuse_unit_of_own, unit_of_factor, with_unit};
use super::error::Problem;
use super::models::{ModelTable, Reading, TABLES, table_of};
use super::schema::study_schema;
use super::sections::{At, FactorSection, Nominal, StudyFile};
use super::synonyms::meant;
use super::{analysis, distribution};
use crate::ModelKind;

/// Returns the study of the text of `context`, and notes on keys without effect.
pub(super) fn study(context: &Context<'_>) -> Result<(Study, Vec<String>), Fault> {
    let file = study_file(context)?;
    let kind = model_kind(context, file.model.as_ref())?;
    refuse_tables_of_others(context, kind, &file)?;
    let (table, reading) = (table_of(kind), Reading { context, file: &file, kind });
    let space = space(context, &(table.inputs)(&reading)?, &file.factor)?;
    let (subject, unused) = (table.subject)(&reading, &space)?;
    let subject = analysis::repeated(context, &file, subject, &space)?;
    let stem =
        || context.path.file_stem().map_or_else(|| "study".to_owned(), |stem| file_part(&stem.to_string_lossy()));
    let name = file.name.as_ref().map(|name| name.get_ref().clone()).unwrap_or_else(stem);
    let mut builder = analysis::settled(context, &file, &space, StudyBuilder::new(&name, Arc::clone(&subject)))?;
    builder.title = file.title.as_ref().map(|title| title.get_ref().clone());
    builder.factors = space.factors().iter().cloned().map(Ok).collect();
    builder.dependences = super::dependence::dependences(context, &file, &space)?;
    builder.low_fidelities = super::fidelity::lows(context, &file, &*subject, study)?;
    let study =
        builder.checked().map_err(|error| context.fault(place(context, &file, &error), Problem::Build(error)))?;
    Ok((study, unused))
}

/// Returns the position in the file that `error` is about.
fn place(context: &Context<'_>, file: &StudyFile, error: &BuildError) -> Range<usize> {
    let keys: &[&str] = match error {
        BuildError::Wrong { key, .. } => &[key],
        BuildError::Design(DesignError::NoReplicates) => &["replicates"],
        BuildError::Design(DesignError::TooManyPairs { .. }) => &["second_order"],
        BuildError::Design(_) => &["base_samples", "runs", "replicates"],
        BuildError::Dependence(_) => &["dependence"],
        BuildError::LowFidelity { .. } | BuildError::Repeated { what: "cheaper model", .. } => &["low"],
        BuildError::Name { name, .. } | BuildError::Repeated { name, .. } => return place_of_name(context, file, name),
        _ => &[],
    };
    let Ok(root) = DeTable::parse(context.text) else { return 0..0 };
    let root = root.get_ref();
    let inner =
        ["design", "analysis", "fidelity"].into_iter().filter_map(|table| root.get(table)?.get_ref().as_table());
    let tables: Vec<_> = std::iter::once(root).chain(inner).collect();
    let found = keys.iter().find_map(|key| tables.iter().find_map(|table| table.get(*key)));
    found.map_or(0..0, toml::Spanned::span)
}

/// Returns the position of a refused name: the last one of a factor, or else the first occurrence.
fn place_of_name(context: &Context<'_>, file: &StudyFile, name: &str) -> Range<usize> {
    let names = |section: &At<FactorSection>| {
        let FactorSection { name, group, .. } = section.get_ref();
        [Some(name.clone()), group.clone()].into_iter().flatten().collect::<Vec<_>>()
    };
    let of_factor = file.factor.iter().flat_map(names).rfind(|found| found.get_ref() == name);
    // Escaped names are not found.
    let first = || context.text.find(name).map(|start| start..start + name.len());
    of_factor.map(|found| found.span()).or_else(first).unwrap_or(0..0)
}

fn model_kind(context: &Context<'_>, model: Option<&At<String>>) -> Result<ModelKind, Fault> {
    let Some(model) = model else { return Ok(ModelKind::DEFAULT) };
    ModelKind::from_name(model.get_ref()).ok_or_else(|| {
        let (all, name) = (ModelKind::all(), model.get_ref());
        let problem = match name.contains(['.', '/', '\\']) {
            true => Problem::with_help(
                format!("unknown model `{name}`: a program of your own is a `command`"),
                "write model = \"command\" and command = [\"python3\", \"my_model.py\"]",
            ),
            false => unknown_name("model", name, all.iter().map(|kind| kind.name)),
        };
        context.fault(model.span(), problem)
    })
}

/// Refuses tables of other models: `[afm]`, `[function]`, `[expression]` and `command` belong to one kind each.
fn refuse_tables_of_others(context: &Context<'_>, kind: ModelKind, file: &StudyFile) -> Result<(), Fault> {
    let foreign = |table: &&ModelTable| table.name != kind.table && (table.span)(file).is_some();
    let Some(ModelTable { name, span, .. }) = TABLES.iter().find(foreign) else { return Ok(()) };
    let owner = match *name {
        "function" => "a function that has parameters".to_owned(),
        name => format!("model = {name:?}"),
    };
    let default = if file.model.is_none() { " by default" } else { "" };
    let right = format!("[{name}] belongs to {owner}, and the model of this study is {:?}{default}", kind.name);
    let span = span(file).unwrap_or_default();
    Err(context.fault(span, Problem::misplaced(name, &right)))
}

fn space(context: &Context<'_>, inputs: &[Input], sections: &[At<FactorSection>]) -> Result<Space, Fault> {
    if sections.is_empty() {
        // All inputs with their own distributions, if they have one.
        let own = |input: &Input| Some(made(input, input.unit.clone(), input.distribution.clone()?));
        let Some(factors) = inputs.iter().map(own).collect::<Option<Result<Vec<Factor>, Problem>>>() else {
            return Err(context.fault(0..0, Problem::no_factors()));
        };
        return factors.map(Space::new).map_err(|problem| context.fault(0..0, problem));
    }
    let mut factors: Vec<Factor> = Vec::new();
    for section in sections {
        let name = &section.get_ref().name;
        let unknown = || unknown_name("factor", name.get_ref(), inputs.iter().map(|input| &*input.name));
        let input = inputs.iter().find(|input| input.name == *name.get_ref()).ok_or_else(unknown);
        factors.push(factor(context, section, context.at(name, input)?)?);
    }
    Ok(Space::new(factors))
}

/// Creates a factor with the default nominal value.
fn made(input: &Input, unit: Unit, distribution: Distribution) -> Result<Factor, Problem> {
    let nominal = default_nominal(input, &unit, &distribution);
    let made = Factor::new(&input.name, unit, distribution);
    let mut factor = made.map_err(|error| distribution::refused(&input.name, &error))?;
    factor.nominal = nominal;
    Ok(factor)
}

fn factor(context: &Context<'_>, section: &At<FactorSection>, input: &Input) -> Result<Factor, Fault> {
    let place = section.get_ref().name.span();
    let fields = section.get_ref();
    let unit = unit_of_factor(context, fields, input)?;
    let distribution = match &input.distribution {
        Some(own) if fields.distribution.is_none() && fields.keys.is_empty() => {
            refuse_unit_of_own(context, fields, &unit, input)?;
            own.clone()
        }
        _ => distribution::of_factor(context, section)?,
    };
    let in_domain = |value: f64| input.domain.is_none_or(|domain| domain.contains(unit.to_si(value)));
    let outside = |span, found: String| {
        let domain = input.domain.map_or_else(|| "a finite number".to_owned(), in_words_of_units);
        context.fault(span, Problem::new(format!("factor `{}` must be {domain}, but {found}", input.name)))
    };
    let (low, high) = distribution.support();
    let least = if distribution.is_open_below() { low.next_up() } else { low };
    for (bound, reached, key) in [(low, least, "min"), (high, high, "max")] {
        // Unbounded distributions cover all values: their rare rows outside the domain fail by name and are counted.
        if bound.is_finite() && !in_domain(reached) {
            let span = fields.place(key).unwrap_or_else(|| place.clone());
            return Err(outside(span, format!("its values reach {}", with_unit(bound, unit.symbol()))));
        }
    }
    let stated = |typed: &At<Nominal>| {
        let value = context.at(typed, distribution::nominal_value(&input.name, &distribution, typed.get_ref()))?;
        let found = || outside(typed.span(), format!("its nominal value is {}", with_unit(value, unit.symbol())));
        Some(value).filter(|value| in_domain(*value) && value.is_finite()).ok_or_else(found)
    };
    let nominal = fields.nominal.as_ref().map(stated).transpose()?;
    let mut factor = made(input, unit.clone(), distribution).map_err(|problem| context.fault(place, problem))?;
    factor.nominal = nominal.unwrap_or(factor.nominal);
    factor.group = fields.group.as_ref().map(|group| group.get_ref().clone());
    factor.determined = distribution::is_determined(fields, factor.distribution());
    Ok(factor)
}

/// Returns the model's own nominal value, or the middle of the distribution if that is not one of its values.
fn default_nominal(input: &Input, unit: &Unit, distribution: &Distribution) -> f64 {
    let (low, high) = distribution.support();
    let nominal = unit.from_si(input.unit.to_si(input.nominal));
    let fits = low <= nominal && nominal <= high && distribution::is_value(distribution, nominal);
    if fits { nominal } else { distribution.central() }
}

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

/// Converts `root`, a study file, to the form of `StudyFile`: `noise = "seed"` is `noise.name = "seed"`.
pub(super) fn normalise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    if let Some((key, _)) = root.get_key_value("factor").filter(|(_, value)| value.get_ref().is_table()) {
        let right = "factors are lines of the table `[factors]`, or tables `[[factor]]`";
        return Err(context.fault(key.span(), Problem::misplaced("factor", right)));
    }
    if let Some(noise) = root.get_mut("noise").filter(|noise| noise.get_ref().is_str()) {
        let key = Spanned::new(noise.span(), Cow::Borrowed("name"));
        let name = Spanned::new(noise.span(), noise.get_ref().clone());
        *noise.get_mut() = DeValue::Table(DeTable::from_iter([(key, name)]));
    }
    Ok(())
}

/// Joins the factors in one list, each with its name: those of `[[factor]]`, or of the lines of `[factors]` in the
/// order of the file; the seed of a stochastic model is the last one.
pub(super) fn join_factors(context: &Context<'_>, file: &mut StudyFile) -> Result<(), Fault> {
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
        let at_noise = |text: &str| At::new(noise.span(), text.to_owned());
        let name = noise.get_ref().name.clone().unwrap_or_else(|| at_noise("seed"));
        let fields = FactorSection { name, distribution: Some(at_noise("seed")), ..FactorSection::default() };
        file.factor.push(At::new(noise.span(), fields));
    }
    Ok(())
}
