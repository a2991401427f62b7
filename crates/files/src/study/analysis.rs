//! The tables `[design]`, `[analysis]` and `[noise]`: choices by name, with the rules of every study. The seed of a
//! stochastic model itself is already a factor, that of the distribution `seed`.

use std::sync::Arc;

use apportion::StudyBuilder;
use apportion::design::Sampler;
use apportion::space::Space;
use apportion::study::{AnalysisOptions, RepeatedSubject, Subject, Target};

use super::at::{At, copied};
use super::context::{Context, Fault, choice, optional_choice, unknown_name};
use super::reading::Reading;
use super::sections::StudyFile;
use super::units::seconds;

/// Applies the tables to `builder`.
pub(super) fn apply_tables(reading: &Reading, space: &Space, builder: &mut StudyBuilder) -> Result<(), Fault> {
    let Reading { context, file, .. } = reading;
    let section = &file.design;
    builder.sampler = optional_choice(context, &section.sampler, "sampler")?.unwrap_or(builder.sampler);
    builder.length.base_samples = copied(&section.base_samples);
    builder.length.runs = copied(&section.runs);
    builder.length.target = Target {
        accuracy: copied(&file.accuracy),
        max_time: section.max_time.as_ref().map(|text| seconds(context, "max_time", text)).transpose()?,
        max_runs: copied(&section.max_runs),
        smallest_region: copied(&file.smallest_region),
    };
    builder.replicates = copied(&section.replicates);
    builder.seed = copied(&section.seed).unwrap_or(builder.seed);
    builder.analysis = Some(options(reading, builder.sampler, space)?);
    Ok(())
}

fn set<T: Copy>(to: &mut T, typed: &Option<At<T>>) {
    *to = copied(typed).unwrap_or(*to);
}

fn options(reading: &Reading, sampler: Sampler, space: &Space) -> Result<AnalysisOptions, Fault> {
    let Reading { context, file, .. } = reading;
    let section = &file.analysis;
    let mut options = AnalysisOptions::for_sampler(sampler);
    set(&mut options.second_order, &section.second_order);
    set(&mut options.aggregate, &section.aggregate);
    set(&mut options.dummy, &section.dummy);
    set(&mut options.convergence, &section.convergence);
    set(&mut options.threshold, &section.threshold);
    set(&mut options.max_failed, &section.max_failed);
    options.intervals = optional_choice(context, &section.intervals, "kind of interval")?.unwrap_or(options.intervals);
    options.surrogate =
        optional_choice(context, &section.surrogate, "choice of surrogate")?.unwrap_or(options.surrogate);
    options.failures = optional_choice(context, &section.failures, "failure policy")?.unwrap_or(options.failures);
    if let Some(resamples) = &section.resamples {
        options.resamples = usize::try_from(*resamples.get_ref()).unwrap_or(usize::MAX);
    }
    for name in section.estimators.iter().flat_map(At::get_ref) {
        options.estimators.push(choice(context, name, "estimator")?);
    }
    for name in section.measures.iter().flat_map(At::get_ref) {
        options.measures.push(choice(context, name, "measure")?);
    }
    for names in section.subsets.iter().flat_map(At::get_ref).map(At::get_ref) {
        options.subsets.push(names.iter().map(|name| factor_index(context, name, space)).collect::<Result<_, _>>()?);
    }
    options.subsets.extend(subsets_of_mean(file, space));
    options.shapley = copied(&section.shapley);
    options.indices_of = optional_choice(context, &section.indices_of, "choice of indices")?.unwrap_or_default();
    Ok(options)
}

/// Returns the position of a factor by name.
pub(super) fn factor_index(context: &Context, name: &At<String>, space: &Space) -> Result<usize, Fault> {
    let names = space.factors().iter().map(|factor| factor.name.as_str());
    let index = names.clone().position(|factor| factor == name.get_ref());
    context.at(name, index.ok_or_else(|| unknown_name("factor", name.get_ref(), names)))
}

/// Maximum number of repetitions of a row.
const MAX_REPETITIONS: u64 = 1000;

/// Returns the subject with the study's number of repetitions of each row.
pub(super) fn repeated(
    Reading { context, file, .. }: &Reading,
    subject: Arc<dyn Subject>,
    space: &Space,
) -> Result<Arc<dyn Subject>, Fault> {
    let typed = file.noise.as_ref().and_then(|section| section.get_ref().repetitions.as_ref());
    let (Some(typed), Some(seed)) = (typed, space.noise()) else { return Ok(subject) };
    let repetitions = *typed.get_ref();
    let expected = match repetitions {
        1 => return Ok(subject),
        _ if !(1..=MAX_REPETITIONS).contains(&repetitions) => format!("a whole number from 1 to {MAX_REPETITIONS}"),
        _ if subject.is_external() => {
            "1 for a model outside this program, which can return mean and variance as outputs".to_owned()
        }
        _ if file.fidelity.is_some() => "1 with [fidelity]".to_owned(),
        _ => return Ok(Arc::new(RepeatedSubject { subject, seed, repetitions: repetitions as usize })),
    };
    context.refuse(typed, "repetitions", &expected, repetitions)
}

/// Returns the sets of each factor and the noise, from which total indices of the mean over the noise follow, if the
/// study requests these.
fn subsets_of_mean(file: &StudyFile, space: &Space) -> Vec<Vec<usize>> {
    let mean_totals = file.noise.as_ref().and_then(|section| copied(&section.get_ref().mean_totals));
    let (Some(true), Some(noise)) = (mean_totals, space.noise()) else { return Vec::new() };
    let factors = (0..space.factors().len()).filter(|factor| *factor != noise);
    factors.map(|factor| vec![factor.min(noise), factor.max(noise)]).collect()
}
