//! From what was typed to what is meant: every check a study file needs, once.

use super::context::{Context, Fault, unknown_name};
use super::design::{Plan, plan};
use super::error::Problem;
use super::models::{ModelTable, Reading, TABLES, table_of};
use super::sections::{At, FactorSection, StudyFile};
use super::units::{in_words_of_units, refuse_unit_of_own, unit_of_factor, with_unit};
use super::{distribution, names, noise, nominal, read};
use crate::design::{DesignError, MAX_FACTORS};
use crate::model::{Input, ModelKind};
use crate::names::{NAME_RULE, file_part, names_files, shown};
use crate::quantity::Unit;
use crate::space::{Distribution, Factor, Space};
use crate::study::{Study, Subject};

/// The study that the text of `context` means.
pub(super) fn study(context: &Context<'_>) -> Result<Study, Fault> {
    let file = read::study_file(context)?;
    // Before anything that takes time for each of them, or for pairs.
    if file.factor.len() > MAX_FACTORS {
        let problem = DesignError::FarTooManyFactors { factors: file.factor.len() };
        return Err(context.fault(file.factor[MAX_FACTORS].span(), problem.into()));
    }
    names::refuse_names(context, &file)?;
    let kind = model_kind(context, file.model.as_ref())?;
    refuse_tables_of_others(context, kind, &file)?;
    let (table, reading) = (table_of(kind), Reading { context, file: &file, kind });
    let space = space(context, &(table.inputs)(&reading)?, &file.factor)?;
    let space = super::dependence::dependent(context, &file, space)?;
    let (subject, unused) = (table.subject)(&reading, &space)?;
    let subject = noise::repeated(context, &file, subject, &space)?;
    names::refuse_output_names(context, &*subject, &space)?;
    refuse_outputs_of_factors(context, &*subject, &space, &file.factor)?;
    let Plan { design, analysis, target, mut notes } =
        plan(context, &file, &space, subject.model(&space).outputs().len())?;
    notes.extend(unused);
    let name = name(context, file.name.as_ref())?;
    let (overrides, source, sha256) = Default::default();
    let title = file.title.as_ref().map(|title| title.get_ref().clone());
    let lows = super::fidelity::lows(context, &file, &*subject, &space, &target, study)?;
    Ok(Study { name, title, subject, space, design, analysis, target, lows, overrides, source, sha256, notes })
}

/// Factors and outputs are columns of one table, and need names of their own.
fn refuse_outputs_of_factors(
    context: &Context<'_>,
    subject: &dyn Subject,
    space: &Space,
    sections: &[At<FactorSection>],
) -> Result<(), Fault> {
    let model = subject.model(space);
    let outputs = model.outputs();
    let mut names = sections.iter().map(|section| &section.get_ref().name);
    let taken = names.find(|name| outputs.iter().any(|output| output.name == **name.get_ref()));
    taken.map_or(Ok(()), |name| {
        let problem = Problem::Repeated { what: "factor or output", name: name.get_ref().clone() };
        Err(context.fault(name.span(), problem))
    })
}

fn model_kind(context: &Context<'_>, model: Option<&At<String>>) -> Result<ModelKind, Fault> {
    let Some(model) = model else { return Ok(ModelKind::DEFAULT) };
    ModelKind::from_name(model.get_ref()).ok_or_else(|| {
        let (all, name) = (ModelKind::all(), model.get_ref());
        let problem = match name.contains(['.', '/', '\\']) {
            true => Problem::ModelFile(name.clone()),
            false => unknown_name("model", name, all.iter().map(|kind| kind.name)),
        };
        context.fault(model.span(), problem)
    })
}

fn name(context: &Context<'_>, name: Option<&At<String>>) -> Result<String, Fault> {
    let stem = || context.path.file_stem().map_or_else(|| "study".to_owned(), |s| file_part(&s.to_string_lossy()));
    let Some(name) = name else { return Ok(stem()) };
    if !names_files(name.get_ref()) {
        let problem =
            Problem::WrongType { key: "name".to_owned(), expected: NAME_RULE.to_owned(), found: shown(name.get_ref()) };
        return Err(context.fault(name.span(), problem));
    }
    Ok(name.get_ref().clone())
}

/// `[afm]`, `[function]`, `[expression]`, `[external]` and `command` belong to one kind of model each.
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
    Err(context.fault(span, Problem::Misplaced { name: (*name).to_owned(), right }))
}

fn space(context: &Context<'_>, inputs: &[Input], sections: &[At<FactorSection>]) -> Result<Space, Fault> {
    if sections.is_empty() {
        // All inputs by their own distributions, if they have one.
        let own = |input: &Input| Some(own_factor(input, input.distribution.clone()?));
        let Some(factors) = inputs.iter().map(own).collect::<Option<Result<Vec<Factor>, Problem>>>() else {
            return Err(context.fault(0..0, Problem::NoFactors));
        };
        return factors.map(Space::new).map_err(|problem| context.fault(0..0, problem));
    }
    let mut factors: Vec<Factor> = Vec::new();
    for section in sections {
        let name = &section.get_ref().name;
        let Some(input) = inputs.iter().find(|input| input.name == *name.get_ref()) else {
            let problem = unknown_name("factor", name.get_ref(), inputs.iter().map(|input| &*input.name));
            return Err(context.fault(name.span(), problem));
        };
        if factors.iter().any(|factor| factor.name == *name.get_ref()) {
            let problem = Problem::Repeated { what: "factor", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        factors.push(factor(context, section, input)?);
    }
    noise::refuse(context, &factors, sections)?;
    Ok(Space::new(factors))
}

/// A factor that varies as the model's input does by itself.
fn own_factor(input: &Input, distribution: Distribution) -> Result<Factor, Problem> {
    let nominal = default_nominal(input, &input.unit, &distribution);
    let mut factor = made(input, input.unit.clone(), distribution)?;
    factor.nominal = nominal;
    Ok(factor)
}

fn made(input: &Input, unit: Unit, distribution: Distribution) -> Result<Factor, Problem> {
    Factor::new(&input.name, unit, distribution)
        .map_err(|source| Problem::Distribution { factor: input.name.clone(), source })
}

fn factor(context: &Context<'_>, section: &At<FactorSection>, input: &Input) -> Result<Factor, Fault> {
    let place = section.get_ref().name.span();
    let fields = section.get_ref();
    let unit = unit_of_factor(context, fields, input)?;
    let distribution = match &input.distribution {
        Some(own) if distribution::is_unsaid(fields) => {
            refuse_unit_of_own(context, fields, &unit, input)?;
            own.clone()
        }
        _ => distribution::of(context, section)?,
    };
    let in_domain = |value: f64| input.domain.is_none_or(|domain| domain.contains(unit.to_si(value)));
    let outside = |span, found: String| {
        let domain = input.domain.map_or_else(|| "a finite number".to_owned(), in_words_of_units);
        context.fault(span, Problem::OutOfDomain { name: format!("factor `{}`", input.name), domain, found })
    };
    let (low, high) = distribution.support();
    let least = if distribution.is_open_below() { low.next_up() } else { low };
    for (bound, reached, field) in [(low, least, &fields.min), (high, high, &fields.max)] {
        // Unbounded distributions reach everywhere: their rare rows outside the domain fail by name and are counted.
        if bound.is_finite() && !in_domain(reached) {
            let span = field.as_ref().map_or(place.clone(), At::span);
            return Err(outside(span, format!("its values reach {}", with_unit(bound, unit.symbol()))));
        }
    }
    let nominal = match &fields.nominal {
        None => default_nominal(input, &unit, &distribution),
        Some(typed) => {
            let value = nominal::value(&input.name, &distribution, typed.get_ref())
                .map_err(|problem| context.fault(typed.span(), problem))?;
            if !in_domain(value) || !value.is_finite() {
                return Err(outside(typed.span(), format!("its nominal value is {}", with_unit(value, unit.symbol()))));
            }
            value
        }
    };
    let mut factor = made(input, unit, distribution).map_err(|problem| context.fault(place, problem))?;
    factor.nominal = nominal;
    factor.group = fields.group.as_ref().map(|group| group.get_ref().clone());
    factor.determined = distribution::is_determined(fields);
    Ok(factor)
}

/// The model's own nominal value, or the middle of the distribution where that is none of its values.
fn default_nominal(input: &Input, unit: &Unit, distribution: &Distribution) -> f64 {
    let (low, high) = distribution.support();
    let nominal = unit.from_si(input.unit.to_si(input.nominal));
    let fits = low <= nominal && nominal <= high && nominal::is_value(distribution, nominal);
    if fits { nominal } else { distribution.central() }
}
