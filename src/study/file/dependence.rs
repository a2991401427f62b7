//! The tables `[[dependence]]`: factors that depend on each other.

use super::context::{Context, Fault, choice, unknown_name, wrong};
use super::error::Problem;
use super::measured;
use super::sections::{At, Correlation, DependenceSection, NameList, StudyFile};
use crate::space::{CorrelationMeasure, Dependence, Space};
use crate::study::SurrogateChoice;

/// `space` with the dependences of `file`, if it has any.
pub(super) fn dependent(context: &Context<'_>, file: &StudyFile, space: Space) -> Result<Space, Fault> {
    let Some(first) = file.dependence.first() else { return Ok(space) };
    let mut dependences = Vec::new();
    for section in &file.dependence {
        dependences.push(dependence(context, section, &space)?);
        // One by one, so that a fault is told at its table.
        if let Err(source) = space.clone().with_dependences(dependences.clone()) {
            return Err(context.fault(section.get_ref().factors.span(), Problem::Dependence(source)));
        }
    }
    let accuracy =
        file.accuracy.as_ref().map(|key| ("accuracy", key.span(), "target = { half_width = ... } in [design]"));
    let low = file.fidelity.as_ref().map(|key| ("fidelity", key.span(), "the model alone"));
    if let Some((key, span, instead)) = accuracy.or(low) {
        let expected = format!(
            "{instead} where factors depend on each other: surrogates and cheaper models serve independent ones"
        );
        return Err(context.fault(span, wrong(key, &expected, format!("`{key}`"))));
    }
    if space.noise().is_some() {
        let expected = "nothing beside the noise of a stochastic model: what is known of the mean over it holds for independent factors";
        return Err(context.fault(first.span(), wrong("dependence", expected, "a dependence".to_owned())));
    }
    let surrogate = file.analysis.surrogate.as_ref();
    if let Some(asked) = surrogate.filter(|asked| asked.get_ref() == SurrogateChoice::On.name()) {
        let expected = "\"off\" where factors depend on each other: the polynomials need independent ones";
        return Err(context.fault(asked.span(), wrong("surrogate", expected, "\"on\"".to_owned())));
    }
    space.with_dependences(dependences).map_err(|source| context.fault(first.span(), Problem::Dependence(source)))
}

fn dependence(context: &Context<'_>, section: &At<DependenceSection>, space: &Space) -> Result<Dependence, Fault> {
    let DependenceSection { factors, correlation, measure, file } = section.get_ref();
    let names = factor_names(context, factors, space)?;
    let measure = match measure {
        None => CorrelationMeasure::default(),
        Some(name) => {
            choice(context, name, "measure of correlation", &CorrelationMeasure::ALL, CorrelationMeasure::name)?
        }
    };
    match (correlation, file) {
        (Some(correlation), None) => {
            let matrix = match correlation.get_ref() {
                Correlation::Matrix(matrix) => matrix.clone(),
                Correlation::Pairs(r) => {
                    let row = |i: usize| (0..names.len()).map(|j| if i == j { 1.0 } else { *r }).collect();
                    (0..names.len()).map(row).collect()
                }
            };
            Ok(Dependence::new(&names, matrix).measure(measure))
        }
        (None, Some(file)) => {
            if let Some(measure) = &section.get_ref().measure {
                let expected = "nothing beside `file`, whose correlations are those of the normal scores of its ranks";
                return Err(
                    context.fault(measure.span(), wrong("measure", expected, format!("{:?}", measure.get_ref())))
                );
            }
            let columns = factors.get_ref().iter().map(|name| Ok(measured::read(context, file, Some(name))?.0));
            let columns = columns.collect::<Result<Vec<Vec<f64>>, Fault>>()?;
            if columns.iter().any(|column| column.len() < FEWEST_MEASUREMENTS) {
                let expected = format!("a file of at least {FEWEST_MEASUREMENTS} joint measurements");
                let found = format!("{}", columns[0].len());
                return Err(context.fault(file.span(), wrong("file", &expected, found)));
            }
            Ok(Dependence::from_measurements(&names, &columns))
        }
        _ => {
            let problem = wrong(
                "dependence",
                "a table with `factors` and either `correlation`, as in correlation = 0.6, or `file`",
                if file.is_some() { "one with both".to_owned() } else { "one with neither".to_owned() },
            );
            Err(context.fault(section.span(), problem))
        }
    }
}

/// Fewer joint measurements say nothing of a correlation.
const FEWEST_MEASUREMENTS: usize = 4;

fn factor_names<'a>(context: &Context<'_>, names: &'a NameList, space: &Space) -> Result<Vec<&'a str>, Fault> {
    let known = || space.factors().iter().map(|factor| factor.name.as_str());
    let name = |name: &'a At<String>| match known().any(|factor| factor == name.get_ref()) {
        true => Ok(name.get_ref().as_str()),
        false => Err(context.fault(name.span(), unknown_name("factor", name.get_ref(), known()))),
    };
    names.get_ref().iter().map(name).collect()
}
