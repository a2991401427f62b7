//! Outputs that are a series: one set of indices for all of its values.

use super::aggregate::{AggregateIndices, aggregate_indices};
use super::finished_run::FinishedRun;
use super::indices::named;
use super::surrogates::Corrections;
use crate::correction::SurrogateEstimates;
use crate::effect::{Effect, IndexPair};
use crate::estimate::{MomentParts, Scaling, Undefined};
use crate::model::Model;
use crate::result::{Named, SeriesRecord};
use crate::run::Totals;
use crate::study::Study;
use crate::uncertainty::Estimate;

/// Returns the results for every series of the model; `counts` holds the counts over all replicates.
pub(super) fn series(run: &FinishedRun<'_>, counts: &Totals, corrections: &Corrections) -> Vec<SeriesRecord> {
    let mut records = Vec::new();
    for series in run.model.series() {
        let all = together(run, counts, corrections, series.places(), Scaling::Plain);
        records.push(SeriesRecord {
            name: series.name.clone(),
            unit: run.model.outputs()[series.first].unit.to_string(),
            axis: series.axis.label().to_owned(),
            axis_unit: series.axis.unit().to_owned(),
            first_output: series.first,
            positions: series.axis.positions().to_vec(),
            indices: all.as_ref().ok().map(|all| together_records(run.study, all, Effect::is_factor)),
            reason: all.err(),
        });
    }
    records
}

/// Computes joint indices of the outputs at `places`, corrected by surrogates where all outputs that vary have one.
pub(super) fn together(
    run: &FinishedRun<'_>,
    counts: &Totals,
    corrections: &Corrections,
    places: impl Iterator<Item = usize> + Clone,
    scaling: Scaling,
) -> Result<AggregateIndices, Undefined> {
    if let Some(plain) = &corrections.plain {
        return plain.together(run.study, run.model, places, scaling);
    }
    let parts: Vec<Vec<&MomentParts>> = places
        .clone()
        .map(|place| run.replicates.iter().map(|totals| &totals.outputs[place].moments).collect())
        .collect();
    let plain = aggregate_indices(&parts, &run.study.layout(), scaling, run.study.analysis.intervals)?;
    let varying = places.filter(|place| counts.outputs[*place].values.range().is_some_and(|(low, high)| low < high));
    let surrogates: Option<Vec<&SurrogateEstimates>> =
        varying.map(|place| corrections.of_run.get(place)?.as_ref()).collect();
    Ok(match surrogates {
        Some(surrogates) => plain.corrected(&surrogates, scaling),
        None => plain,
    })
}

/// Returns the indices over several outputs together of the effects that are wanted.
pub(super) fn together_records(
    study: &Study,
    all: &AggregateIndices,
    is_wanted: fn(Effect) -> bool,
) -> Vec<Named<IndexPair<Estimate>>> {
    let effects = study.effects().into_iter().zip(&all.indices).filter(|(effect, _)| is_wanted(effect.effect));
    effects.map(|(effect, of)| named(study, &effect, *of)).collect()
}

/// Returns the places of the outputs that belong to no series.
pub(super) fn single_outputs(model: &dyn Model) -> Vec<usize> {
    let outputs = 0..model.outputs().len();
    outputs.filter(|place| !model.series().iter().any(|series| series.places().contains(place))).collect()
}
