//! Outputs that are a series: one set of indices for all of its values.

use super::finished_run::FinishedRun;
use crate::estimate::{MomentParts, Scaling, Undefined};
use crate::model::{Model, OutputSeries};
use crate::run::Totals;
use crate::uncertainty::{AggregateIndices, SurrogateEstimates, aggregate_indices};

/// What a run has found about a series of outputs, beside the results of every value.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SeriesAnalysis {
    /// The series.
    pub series: OutputSeries,
    /// Indices over all values together, which each value enters by its variance (Gamboa et al. 2014), of the factors, and
    /// then of the other swaps.
    pub aggregate: Result<AggregateIndices, Undefined>,
}

/// What the run says of every series of its model; `whole` holds the counts over all replicates, `surrogates` what these make of
/// every output.
pub(super) fn series(
    run: &FinishedRun<'_>,
    whole: &Totals,
    surrogates: &[Option<SurrogateEstimates>],
) -> Vec<SeriesAnalysis> {
    let of_series = |series: &OutputSeries| {
        let plain = together(run.replicates, series.places(), Scaling::Plain, run);
        let varies = |place: &usize| whole.outputs[*place].values.range().is_some_and(|(low, high)| low < high);
        let corrected: Option<Vec<&SurrogateEstimates>> =
            series.places().filter(varies).map(|place| surrogates.get(place)?.as_ref()).collect();
        SeriesAnalysis {
            series: series.clone(),
            aggregate: match corrected {
                Some(corrected) => plain.map(|plain| plain.corrected(&corrected)),
                None => plain,
            },
        }
    };
    run.model.series().iter().map(of_series).collect()
}

/// Indices over the outputs at `places` together.
pub(super) fn together(
    replicates: &[Totals],
    places: impl Iterator<Item = usize>,
    scaling: Scaling,
    run: &FinishedRun<'_>,
) -> Result<AggregateIndices, Undefined> {
    let of_output = |place: usize| replicates.iter().map(|totals| &totals.outputs[place].moments).collect();
    let parts: Vec<Vec<&MomentParts>> = places.map(of_output).collect();
    let parts: Vec<&[&MomentParts]> = parts.iter().map(Vec::as_slice).collect();
    let indices = aggregate_indices(&parts, scaling, run.study.analysis.intervals);
    indices.map(|indices| indices.of_effects(&run.study.layout()))
}

/// Places of the outputs that belong to no series.
pub(super) fn single_outputs(model: &dyn Model) -> Vec<usize> {
    let single = |place: &usize| !model.series().iter().any(|series| series.places().contains(place));
    (0..model.outputs().len()).filter(single).collect()
}
