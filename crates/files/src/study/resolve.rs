//! Conversion of a typed study file to a study: every check of a study file, once.

use std::ops::Range;
use std::sync::Arc;

use apportion::StudyBuilder;
use apportion::design::DesignError;
use apportion::model::Input;
use apportion::names::file_part;
use apportion::quantity::Unit;
use apportion::space::{Distribution, Factor, Space};
use apportion::study::{BuildError, Study};
use toml::de::DeTable;

use super::context::{Context, Fault, unknown_name};
use super::error::Problem;
use super::models::{ModelTable, Reading, TABLES, table_of};
use super::sections::{At, FactorSection, Nominal, StudyFile};
use super::units::{in_words_of_units, refuse_unit_of_own, unit_of_factor, with_unit};
use super::{analysis, distribution, read};
use crate::ModelKind;

/// Returns the study of the text of `context`, and notes on keys without effect.
pub(super) fn study(context: &Context<'_>) -> Result<(Study, Vec<String>), Fault> {
    let file = read::study_file(context)?;
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
    builder.lows = super::fidelity::lows(context, &file, &*subject, study)?;
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
