//! The tables `[design]`, `[analysis]` and `[noise]`: choices by name, with the rules of every study. The seed of a
//! stochastic model itself is already a factor, that of the distribution `seed`.

use std::sync::Arc;

use apportion::StudyBuilder;
use apportion::design::Sampler;
use apportion::space::Space;
use apportion::study::{AnalysisOptions, RepeatedSubject, Subject, Target};
use apportion_base::quantity::{Dimension, Quantity};

use super::context::{Context, Fault, choice, choice_if_said, unknown_name};
use super::sections::{At, NameList, StudyFile};

/// Applies the tables to `builder`.
pub(super) fn settled(
    context: &Context<'_>,
    file: &StudyFile,
    space: &Space,
    mut builder: StudyBuilder,
) -> Result<StudyBuilder, Fault> {
    let section = &file.design;
    let number = |value: &Option<At<u64>>| value.as_ref().map(|value| *value.get_ref());
    builder.sampler = choice_if_said(context, &section.sampler, "sampler")?.unwrap_or(builder.sampler);
    builder.length.base_samples = number(&section.base_samples);
    builder.length.runs = number(&section.runs);
    builder.length.target = Target {
        accuracy: file.accuracy.as_ref().map(|accuracy| *accuracy.get_ref()),
        max_time: section.max_time.as_ref().map(|text| seconds(context, "max_time", text)).transpose()?,
        max_runs: number(&section.max_runs),
    };
    builder.replicates = number(&section.replicates);
    builder.seed = number(&section.seed).unwrap_or(builder.seed);
    builder.analysis = Some(options(context, file, builder.sampler, space)?);
    Ok(builder)
}

fn options(context: &Context<'_>, file: &StudyFile, sampler: Sampler, space: &Space) -> Result<AnalysisOptions, Fault> {
    let section = &file.analysis;
    fn set<T: Copy>(to: &mut T, typed: &Option<At<T>>) {
        *to = typed.as_ref().map_or(*to, |value| *value.get_ref());
    }
    let mut options = AnalysisOptions::for_sampler(sampler);
    set(&mut options.second_order, &section.second_order);
    set(&mut options.aggregate, &section.aggregate);
    set(&mut options.dummy, &section.dummy);
    set(&mut options.convergence, &section.convergence);
    set(&mut options.threshold, &section.threshold);
    set(&mut options.max_failed, &section.max_failed);
    options.intervals = choice_if_said(context, &section.intervals, "kind of interval")?.unwrap_or(options.intervals);
    options.surrogate =
        choice_if_said(context, &section.surrogate, "choice of surrogate")?.unwrap_or(options.surrogate);
    options.failures = choice_if_said(context, &section.failures, "failure policy")?.unwrap_or(options.failures);
    if let Some(resamples) = &section.resamples {
        options.resamples = usize::try_from(*resamples.get_ref()).unwrap_or(usize::MAX);
    }
    let names = |list: &Option<NameList>| list.iter().flat_map(|list| list.get_ref().clone()).collect::<Vec<_>>();
    for name in names(&section.estimators) {
        options.estimators.push(choice(context, &name, "estimator")?);
    }
    for name in names(&section.measures) {
        options.measures.push(choice(context, &name, "measure")?);
    }
    for list in section.subsets.iter().flat_map(|lists| lists.get_ref()) {
        options.subsets.push(list.get_ref().iter().map(|name| place(context, name, space)).collect::<Result<_, _>>()?);
    }
    options.subsets.extend(super::analysis::subsets_of_mean(file, space));
    options.shapley = section.shapley.as_ref().map(|asked| *asked.get_ref());
    options.indices_of = choice_if_said(context, &section.indices_of, "choice of indices")?.unwrap_or_default();
    Ok(options)
}

/// Returns the position of a factor by name.
pub(super) fn place(context: &Context<'_>, name: &At<String>, space: &Space) -> Result<usize, Fault> {
    let known = || space.factors().iter().map(|factor| factor.name.as_str());
    let place = known().position(|factor| factor == name.get_ref());
    context.at(name, place.ok_or_else(|| unknown_name("factor", name.get_ref(), known())))
}

/// Parses a time above 0, in seconds.
pub(super) fn seconds(context: &Context<'_>, key: &str, typed: &At<String>) -> Result<f64, Fault> {
    let quantity = context.at(typed, Quantity::parse(typed.get_ref()))?;
    let seconds = quantity.to_si();
    if quantity.unit.dimension() != Dimension::TIME || !(seconds > 0.0 && seconds.is_finite()) {
        return context.refuse(typed, key, "a time above 0, as in \"30 s\"", format!("\"{}\"", typed.get_ref()));
    }
    Ok(seconds)
}

/// Maximum number of repetitions of a row.
const MAX_REPETITIONS: u64 = 1000;

/// Returns the subject with the study's number of repetitions of each row.
pub(super) fn repeated(
    context: &Context<'_>,
    file: &StudyFile,
    subject: Arc<dyn Subject>,
    space: &Space,
) -> Result<Arc<dyn Subject>, Fault> {
    let typed = file.noise.as_ref().and_then(|section| section.get_ref().repetitions.as_ref());
    let (Some(typed), Some(seed)) = (typed, space.noise()) else { return Ok(subject) };
    let repetitions = *typed.get_ref();
    let refused = |expected: &str, found: String| context.refuse(typed, "repetitions", expected, found);
    if !(1..=MAX_REPETITIONS).contains(&repetitions) {
        return refused(&format!("a whole number from 1 to {MAX_REPETITIONS}"), repetitions.to_string());
    }
    if repetitions == 1 {
        return Ok(subject);
    }
    if subject.is_external() {
        let expected = "1 for a model outside this program, which can return mean and variance as outputs";
        return refused(expected, repetitions.to_string());
    }
    if file.fidelity.is_some() {
        return refused("1 with [fidelity]", repetitions.to_string());
    }
    Ok(Arc::new(RepeatedSubject { subject, seed, repetitions: repetitions as usize }))
}

/// Returns the sets of each factor and the noise, from which total indices of the mean over the noise follow, if the
/// study requests these.
pub(super) fn subsets_of_mean(file: &StudyFile, space: &Space) -> Vec<Vec<usize>> {
    let asked = file.noise.as_ref().and_then(|section| section.get_ref().mean_totals.as_ref());
    let (Some(true), Some(noise)) = (asked.map(|asked| *asked.get_ref()), space.noise()) else { return Vec::new() };
    let with_noise = |factor: usize| if factor < noise { vec![factor, noise] } else { vec![noise, factor] };
    (0..space.factors().len()).filter(|factor| *factor != noise).map(with_noise).collect()
}
