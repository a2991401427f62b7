//! Surrogate estimates of the outputs of a run, with low-fidelity models if there are any.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::finished_run::{FinishedRun, LowFidelityTotals, outputs_kept};
use super::output::{MAX_PICTURED, has_stages};
use super::output_indices::IntervalOptions;
use super::plain::PlainOutputs;
use super::rare_levels::rare_levels;
use super::stages::points_of_stages;
use crate::correction::SurrogateEstimates;
use crate::correction::surrogates_together;
use crate::correction::{LowFidelityOutputs, low_fidelity_estimates};
use crate::design::Design;
use crate::estimate::{MomentParts, PointOutputs};
use crate::result::RareLevel;
use crate::run::Totals;
use crate::study::{Study, SurrogateChoice};
use crate::surrogate::{CrossFitted, families};

/// Returns the options for intervals and probabilities of `study`.
pub(crate) fn interval_options(study: &Study) -> IntervalOptions<'static> {
    let (analysis, seed) = (&study.analysis, study.design.settings().seed);
    let (method, threshold, resamples) = (analysis.intervals, analysis.threshold, analysis.resamples);
    // Their own error is below 0.008, or 0.016 where there is one for each factor of very many outputs.
    let draws = if study.model().outputs().len() > MAX_PICTURED { 1024 } else { 4096 };
    IntervalOptions { method, threshold, seed, resamples, points: None, draws, unread: &[], surrogate: None }
}

/// Computes the surrogate estimates of every output of the runs of `design`, the first of `replicates`, if the study
/// requests them and the outputs have been kept: for each those with the smallest errors. `longer` is the estimates of
/// a longer run of the same points, if there was one: the same outputs are corrected, by the same surrogates.
pub(crate) fn surrogates(
    study: &Study,
    design: &Design,
    replicates: &[Totals],
    low_fidelity: &[LowFidelityTotals<'_>],
    longer: &[Option<SurrogateEstimates>],
) -> Vec<Option<SurrogateEstimates>> {
    let outputs = replicates.first().map_or(0, |totals| totals.outputs.len());
    let points = design.points_per_replicate();
    let kept: Vec<Vec<PointOutputs>> = (0..outputs).map(|number| first_points(replicates, number, points)).collect();
    if design.is_plain() || !study.uses_surrogate(design) || kept.iter().flatten().all(|outputs| outputs.points() == 0)
    {
        return vec![None; outputs];
    }
    let kept: Vec<Vec<&PointOutputs>> = kept.iter().map(|replicates| replicates.iter().collect()).collect();
    let (families, layout) = (families(&study.space), study.layout());
    // The outputs that are corrected. Polynomials continue where runs fail, but the numbers are those of the part of the
    // space where they succeed.
    let mut numbers = Vec::new();
    for (number, replicates) in kept.iter().enumerate() {
        let is_left = longer.get(number).is_some_and(Option::is_none);
        let is_on = study.analysis.surrogate == SurrogateChoice::On;
        if !is_left && (is_on || !replicates.iter().any(|outputs| outputs.has_failures())) {
            numbers.push(number);
        }
    }
    let all: Vec<Vec<&PointOutputs>> = numbers.iter().map(|&number| kept[number].clone()).collect();
    let known = numbers.iter().map(|&number| longer.get(number)?.as_ref()?.fitted.as_ref());
    let known: Vec<Option<&CrossFitted>> = known.collect();
    let misses_levels = rare_levels(&study.space, design).iter().any(RareLevel::is_missed);
    let mut best = vec![None; outputs];
    let alone = surrogates_together(design, &families, &layout, &all, &known);
    for (alone, number) in alone.into_iter().zip(numbers) {
        let mut all: Vec<SurrogateEstimates> = alone.into_iter().collect();
        for low in low_fidelity.iter().filter(|low| low.refusal(number, design).is_none()) {
            if let Some(Some(independent)) = low.outputs.get(number) {
                let shared = first_points(low.shared, number, points);
                let low = LowFidelityOutputs { name: low.name, shared: shared.iter().collect(), independent };
                all.extend(low_fidelity_estimates(design, &families, &layout, &kept[number], &low));
            }
        }
        let least = all.into_iter().min_by(|a, b| a.squared_error().total_cmp(&b.squared_error()));
        best[number] = least.map(|of| SurrogateEstimates { misses_levels, ..of });
    }
    best
}

/// Returns output number `number` at the first `points` base points of each replicate.
fn first_points(replicates: &[Totals], number: usize, points: u64) -> Vec<PointOutputs> {
    outputs_kept(replicates, number).into_iter().map(|outputs| outputs.prefix(points)).collect()
}

/// The surrogate estimates of every output, at the end and at every stage of the run.
pub(super) struct Corrections {
    pub of_run: Vec<Option<SurrogateEstimates>>,
    /// By the base points of a replicate.
    pub stages: BTreeMap<u64, Vec<Option<SurrogateEstimates>>>,
    /// The surrogates of a run of plain rows.
    pub plain: Option<Arc<PlainOutputs>>,
    /// The levels that are rare among the rows.
    pub rare: Vec<RareLevel>,
}

impl Corrections {
    pub fn new(run: &FinishedRun<'_>) -> Self {
        let FinishedRun { study, design, replicates, low_fidelity, .. } = *run;
        let known = run.surrogates.map(<[_]>::to_vec);
        let of_run = known.unwrap_or_else(|| surrogates(study, design, replicates, low_fidelity, &[]));
        let mut stages = BTreeMap::new();
        if has_stages(run) && of_run.iter().any(Option::is_some) {
            // All outputs have the same parts.
            let parts: Vec<&MomentParts> =
                replicates.iter().filter_map(|totals| Some(&totals.outputs.first()?.moments)).collect();
            for points in points_of_stages(&parts) {
                if let Ok(design) = design.with_points(points) {
                    stages.insert(points, surrogates(study, &design, replicates, low_fidelity, &of_run));
                }
            }
        }
        let plain = run.plain.cloned().or_else(|| PlainOutputs::new(study, design, replicates));
        Self { of_run, stages, plain, rare: rare_levels(&study.space, design) }
    }
}
