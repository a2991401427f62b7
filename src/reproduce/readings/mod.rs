//! What the published percentages could mean: our shares under every reading, and how far each is from the printed ones.
//!
//! LG prints percentages without saying of what, at what sample size, with what error. A [`Reading`] is one meaning that
//! they could have: a version of the study ([`catalogue`]), an output, and a measure of a factor's effect. All readings
//! are stated before any is computed; the [`distance()`] of each to the printed percentages is then a fact, not a fit. What
//! chance does to the percentages of small samples is told by [`SmallSample`]s.

pub mod catalogue;
mod charts;
mod distance;
mod nearest;
mod one_at_a_time;
mod shares;
mod small_samples;
mod summary;
mod tables;
#[cfg(test)]
mod tests;

use std::time::Instant;

use serde::Serialize;
use thiserror::Error;

pub use catalogue::{Axis, Effect, VARIANTS, Variant};
pub use charts::{distance_chart, small_sample_chart};
pub use distance::distance;
use distance::distance_error;
pub(in crate::reproduce) use nearest::{Joint, joint, words};
pub use small_samples::{Chance, Estimators, SmallSample};
pub use summary::{chances, headline, summary};
pub use tables::{readings_csv, readings_json, small_samples_csv};

use super::{Effort, GROUPS, STUDIES};
use apportion::design::DesignError;
use apportion::model::{AfmOutput, RowFailure};
use apportion::report::ResultFile;
use apportion::run::{RunError, threads_in_force};
use apportion::study::{Study, StudyError};
use catalogue::{SMALL_SAMPLE_VARIANTS, variant};

/// Every reading computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Readings {
    /// One entry per reading and group: the groups of a reading are neighbours, readings in the order of the catalogue.
    pub rows: Vec<Reading>,
    /// What small samples make of the base reading and of the viscous one.
    pub small_samples: Vec<SmallSample>,
    /// Threads used.
    pub threads: usize,
    /// How long it took, in seconds; all else is the same in every run.
    pub wall_seconds: f64,
}

/// The percentages of one study under one reading.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reading {
    /// Name of the reading, the same in every group: `variant/effect/output`.
    pub id: String,
    /// The reading in one sentence.
    pub statement: String,
    /// Which study.
    pub group: &'static str,
    /// What varies against the base reading.
    pub axis: Axis,
    /// The version of the study, [`Variant::id`].
    pub variant: &'static str,
    /// Changes to the LuGre study of the group, as of `--set`.
    pub settings: Vec<&'static str>,
    /// What is shared out.
    pub effect: Effect,
    /// Of which output.
    #[serde(serialize_with = "output_name")]
    pub output: AfmOutput,
    /// In the order of the study.
    pub shares: Vec<Share>,
    /// From the printed percentages, in percentage points: see [`distance()`].
    pub distance: f64,
    /// How far off the distance is at most while every share lies in its interval; `None` for shares without intervals,
    /// which are exact to less than 0.01.
    pub distance_error: Option<f64>,
    /// Model runs.
    pub runs: u64,
    /// Those without a value.
    pub runs_failed: u64,
}

/// A factor's percentage under a reading.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Share {
    /// The factor.
    pub factor: String,
    /// Its percentage.
    pub share: f64,
    /// 95 % interval, where the effect has one.
    pub interval: Option<(f64, f64)>,
    /// The printed percentage, where there is one.
    pub published: Option<f64>,
}

/// Why the readings could not be computed.
#[derive(Debug, Error)]
pub enum ReadingsError {
    /// A study of the catalogue cannot be read.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A study of the catalogue has no design.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A study cannot be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A reading has no percentages.
    #[error("the reading {reading} of the {group} study has no percentages: {reason}")]
    NoShares {
        /// The reading.
        reading: String,
        /// The study.
        group: &'static str,
        /// Why.
        reason: String,
    },
    /// The model has no value where one factor varies alone.
    #[error("the {group} study has no value where {factor} varies alone: {reason}")]
    NoValue {
        /// The study.
        group: &'static str,
        /// The factor.
        factor: String,
        /// Why.
        reason: RowFailure,
    },
}

/// Computes every reading of the catalogue for every group, then the small samples, on `threads` threads (0: one per
/// core). `on_progress` is told what is being done and which part of all, 0 to 1, is done. Apart from
/// [`Readings::threads`] and [`Readings::wall_seconds`] the result is the same for any number of threads, in any bit.
///
/// [`Effort::Quick`] takes a sixteenth of the base samples and 100 repetitions of the small samples instead of 1000.
///
/// ```no_run
/// use apportion::reproduce::Effort;
/// use apportion::reproduce::readings::{readings, summary};
///
/// let readings = readings(Effort::Quick, 0, &|what, part| eprintln!("{what}: {:.0} %", 100.0 * part))?;
/// for sentence in summary(&readings) {
///     println!("{sentence}");
/// }
/// # Ok::<(), apportion::reproduce::readings::ReadingsError>(())
/// ```
///
/// # Errors
/// [`ReadingsError`]; the catalogue being part of the program, only that of threads that cannot be started is to be
/// expected.
pub fn readings(
    effort: Effort,
    threads: usize,
    on_progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Readings, ReadingsError> {
    compute(VARIANTS, &SMALL_SAMPLE_VARIANTS, effort, threads, on_progress)
}

/// The readings of some variants, and the small samples of others.
fn compute(
    variants: &'static [Variant],
    small: &[&'static str],
    effort: Effort,
    threads: usize,
    on_progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Readings, ReadingsError> {
    let start = Instant::now();
    // The small samples take about a third of the time.
    let steps = variants.len() * 3 / 2;
    let part = |done: usize| done as f64 / steps.max(1) as f64;
    let mut rows = Vec::new();
    for (number, variant) in variants.iter().enumerate() {
        on_progress(variant.name, part(number));
        let of_groups: Vec<Vec<Reading>> =
            GROUPS.iter().map(|group| of_variant(variant, group.key, effort, threads)).collect::<Result<_, _>>()?;
        let readings = of_groups.first().map_or(0, Vec::len);
        rows.extend(
            (0..readings).flat_map(|reading| of_groups.iter().filter_map(move |rows| rows.get(reading)).cloned()),
        );
    }
    let mut small_samples = Vec::new();
    let count = small.len() * GROUPS.len();
    for (number, variant) in small.iter().filter_map(|id| variant(id)).enumerate() {
        for (group_number, group) in GROUPS.iter().enumerate() {
            let done = (number * GROUPS.len() + group_number) as f64 / count as f64;
            on_progress("small samples", part(variants.len()) + (1.0 - part(variants.len())) * done);
            let study = study(variant, group.key, &[])?;
            small_samples.extend(small_samples::of_study(&study, variant.id, group.key, effort, threads)?);
        }
    }
    on_progress("readings", 1.0);
    let wall_seconds = start.elapsed().as_secs_f64();
    Ok(Readings { rows, small_samples, threads: threads_in_force(threads), wall_seconds })
}

/// The readings of one variant of one group, in the order output, effect.
fn of_variant(
    variant: &'static Variant,
    group: &'static str,
    effort: Effort,
    threads: usize,
) -> Result<Vec<Reading>, ReadingsError> {
    let overrides = match effort {
        Effort::Full => vec![format!("design.base_samples={}", variant.base_samples)],
        // Of so few base samples surrogates would be fitted, which takes longer than the runs.
        Effort::Quick => {
            vec![format!("design.base_samples={}", variant.base_samples / 16), "analysis.surrogate=off".to_owned()]
        }
    };
    let study = study(variant, group, &overrides)?;
    let result = ResultFile::new(&study, &study.runner().threads(threads).run()?);
    let mut readings = Vec::new();
    for (number, &output) in variant.outputs.iter().enumerate() {
        for &effect in variant.effects {
            let id = format!("{}/{}/{}", variant.id, effect.name(), output.name());
            let no_shares =
                |reason: &str| ReadingsError::NoShares { reading: id.clone(), group, reason: reason.to_owned() };
            let (shares, runs, runs_failed) = match effect {
                Effect::VarianceAlone | Effect::RangeAlone => {
                    let (shares, runs) = one_at_a_time::shares(&study, group, number, effect)?;
                    (shares.ok_or_else(|| no_shares("the output does not vary"))?, runs, 0)
                }
                _ => {
                    let record = &result.outputs[number];
                    let shares = shares::of_record(record, group, effect).map_err(|reason| no_shares(&reason))?;
                    (shares, result.provenance.model_runs, record.runs_failed)
                }
            };
            readings.push(Reading {
                statement: format!("{}; {}, of {}.", variant.statement, effect.statement(), output.description()),
                id,
                group,
                axis: variant.axis,
                variant: variant.id,
                settings: settings(variant, &study),
                effect,
                output,
                distance: distance(group, shares.iter().map(|share| (share.factor.as_str(), share.share))),
                distance_error: distance_error(group, &shares),
                shares,
                runs,
                runs_failed,
            });
        }
    }
    Ok(readings)
}

/// The study of `group` in its version `variant`, with both outputs and with `changes` to it.
fn study(variant: &Variant, group: &str, changes: &[String]) -> Result<Study, ReadingsError> {
    let name = format!("lugre-{group}");
    let text = STUDIES.iter().find(|(study, _)| *study == name).map_or("", |(_, text)| text);
    let path = format!("studies/{name}.toml");
    let plain = Study::parse(text, path.as_ref(), &[])?;
    let outputs: Vec<String> = catalogue::BOTH.iter().map(|output| format!("{:?}", output.name())).collect();
    let mut overrides = vec![format!("outputs=[{}]", outputs.join(", "))];
    overrides.extend(settings(variant, &plain).into_iter().map(str::to_owned));
    overrides.extend_from_slice(changes);
    Ok(Study::parse(text, path.as_ref(), &overrides)?)
}

/// The settings of the variant but for those that fix a factor of the study.
fn settings(variant: &Variant, study: &Study) -> Vec<&'static str> {
    let is_factor = |setting: &str| {
        let name = setting.split_once('=').and_then(|(key, _)| key.trim().strip_prefix("afm."));
        study.space().factors().iter().any(|factor| Some(factor.name.as_str()) == name)
    };
    variant.settings.iter().copied().filter(|setting| !is_factor(setting)).collect()
}

fn output_name<S: serde::Serializer>(output: &AfmOutput, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(output.name())
}
