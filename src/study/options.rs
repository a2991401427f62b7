//! What is estimated from the runs of a study, and when they end.

use std::ops::RangeInclusive;

use crate::design::{Design, DesignSettings, Rows, Sampler, Swap};
use crate::estimate::{Estimator, proper_subsets};
use crate::given::Measure;
use crate::result::Warning;
use crate::run::FailurePolicy;
use crate::space::{Group, IndicesOf, Space};
use crate::surrogate::{MIN_NETS, SurrogateChoice};
use crate::uncertainty::{IntervalMethod, RULE_OF_THREE};

/// What to estimate from the runs.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisOptions {
    /// Estimators to report in addition to the default ones.
    pub estimators: Vec<Estimator>,
    /// Whether second-order indices are estimated.
    pub second_order: bool,
    /// Sets of factors, by number, for which joint indices are estimated.
    pub subsets: Vec<Vec<usize>>,
    /// What has indices: the factors, or the groups in place of their factors.
    pub indices_of: IndicesOf,
    /// Whether Shapley effects are estimated, of at most eight
    /// factors or groups. `None` estimates them for up to four if factors depend on each other.
    pub shapley: Option<bool>,
    /// Other measures to report in addition to Sobol' indices, from the first
    /// 4096 rows A and B; of at most 100 outputs.
    pub measures: Vec<Measure>,
    /// Whether indices over all outputs together are estimated.
    pub aggregate: bool,
    /// Whether a dummy factor without effect is added: its indices are the noise of the model.
    pub dummy: bool,
    /// Whether the result includes the stages of the run: the indices at each half of the runs after it.
    pub convergence: bool,
    /// Whether the result includes the distributions of the outputs, and scatter plots of them over the factors.
    pub pictures: bool,
    /// The method for intervals.
    pub intervals: IntervalMethod,
    /// Whether indices are corrected by surrogates.
    pub surrogate: SurrogateChoice,
    /// Number of bootstrap resamples.
    pub resamples: usize,
    /// Total index above which a factor counts as important.
    pub threshold: f64,
    /// What happens when a run fails.
    pub failures: FailurePolicy,
    /// Largest share of the runs that may fail before there are no indices.
    pub max_failed: f64,
}

impl AnalysisOptions {
    /// Returns first-order and total indices only, with the intervals that suit points of `sampler` best.
    pub fn for_sampler(sampler: Sampler) -> Self {
        Self {
            estimators: Vec::new(),
            second_order: false,
            subsets: Vec::new(),
            indices_of: IndicesOf::default(),
            shapley: None,
            measures: Vec::new(),
            aggregate: false,
            dummy: false,
            convergence: true,
            pictures: true,
            intervals: IntervalMethod::default_for(sampler),
            surrogate: SurrogateChoice::default(),
            resamples: DEFAULT_RESAMPLES,
            threshold: DEFAULT_THRESHOLD,
            failures: FailurePolicy::DropBlock,
            max_failed: DEFAULT_MAX_FAILED,
        }
    }

    /// Returns whether there will be Shapley effects of the factors of `space`, or of their groups.
    pub fn has_shapley(&self, space: &Space) -> bool {
        match self.shapley {
            Some(shapley) => shapley,
            None => space.copula().is_some() && self.members(space).len() <= FREE_SHAPLEY_FACTORS,
        }
    }

    /// Returns what has indices.
    pub(crate) fn members(&self, space: &Space) -> Vec<Group> {
        space.members(self.indices_of)
    }

    /// Returns the groups that have indices in addition.
    pub(crate) fn further_groups(&self, space: &Space) -> Vec<Group> {
        if self.indices_of == IndicesOf::Factors { space.groups() } else { Vec::new() }
    }

    /// Returns warnings about a design and the intervals that depend on it.
    pub fn design_warnings(&self, design: &Design) -> Vec<Warning> {
        let (points, replicates) = (design.points_per_replicate(), design.settings().replicates);
        let mut warnings = Vec::new();
        if !design.balanced() {
            let more = points.next_power_of_two() * replicates;
            warnings.push(Warning::Unbalanced { points, fewer: more / 2, more });
        }
        match self.intervals {
            IntervalMethod::Replicates if replicates == 1 => warnings.push(Warning::SingleReplicate),
            IntervalMethod::Nets if replicates == 1 => warnings.push(Warning::SingleNet),
            _ => (),
        }
        warnings
    }

    /// Returns whether surrogates may correct the indices (not Shapley effects), at points of `sampler` in `replicates`
    /// replicates.
    pub(crate) fn takes_surrogates(&self, sampler: Sampler, replicates: u64, space: &Space) -> bool {
        self.has_polynomials(sampler, replicates, space) && !self.has_shapley(space)
    }

    /// Returns whether surrogates of plain rows give all indices that are requested, of so many outputs.
    pub(crate) fn takes_plain_rows(&self, settings: &DesignSettings, space: &Space, outputs: usize) -> bool {
        self.has_polynomials(settings.sampler, settings.replicates, space)
            && outputs <= MAX_PLAIN_OUTPUTS
            && self.estimators.is_empty()
            && !self.dummy
            && space.noise().is_none()
    }

    /// Returns whether there are polynomials for surrogates: they are orthogonal only for independent factors.
    fn has_polynomials(&self, sampler: Sampler, replicates: u64, space: &Space) -> bool {
        self.surrogate != SurrogateChoice::Off
            && self.intervals == IntervalMethod::Nets
            && sampler != Sampler::LatinHypercube
            && replicates >= MIN_NETS as u64
            && space.copula().is_none()
    }
}

/// Maximum number of outputs of plain rows: each is fitted alone.
const MAX_PLAIN_OUTPUTS: usize = 32;

/// Maximum number of plain rows: of more, base points with swaps correct what surrogates leave.
pub(super) const MAX_PLAIN_ROWS: u64 = 1 << 12;

/// Maximum number of plain rows to which a run grows.
pub(crate) const MAX_GROWN_ROWS: u64 = 1 << 11;

/// Minimum number of plain rows with which a run grows.
pub(super) const FIRST_ROWS: u64 = 60;

/// Minimum number of plain rows, and for each factor.
pub(super) const MIN_PLAIN_ROWS: u64 = 24;
pub(super) const PLAIN_ROWS_OF_FACTOR: u64 = 5;

/// Maximum number of rows times outputs up to which surrogates are fitted by default: all must fit into memory, and a
/// fast model could do more runs in the time of a fit.
pub(super) const MAX_AUTOMATIC_VALUES: u64 = 1 << 22;

/// The required accuracy of the indices, and the limits of a run that continues until it is reached. With limits alone
/// the run is doubled as far as they allow; with neither it has the size of its design.
///
/// ```
/// use apportion::Target;
///
/// let target = Target::accuracy(0.01).max_time(60.0);
/// assert_eq!((target.accuracy, target.max_time, target.max_runs), (Some(0.01), Some(60.0), None));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Target {
    /// Half width that the interval of every first-order and total index must reach: the run chooses the cheapest
    /// method, with or without surrogates and low-fidelity models.
    pub accuracy: Option<f64>,
    /// Maximum seconds of the run.
    pub max_time: Option<f64>,
    /// Maximum number of model runs.
    pub max_runs: Option<u64>,
    /// The smallest part of a factor's range, from 0 to 1, that must not escape: an accuracy is reached only if every
    /// factor has so many distinct values that a region of this size contains one, with 95 % probability. `None` for
    /// 0.05 where the model takes its time or is outside, and 0.001 where it does not.
    pub smallest_region: Option<f64>,
}

impl Target {
    /// Creates a target of this half width for every first-order and total index.
    pub const fn accuracy(half_width: f64) -> Self {
        Self { accuracy: Some(half_width), max_time: None, max_runs: None, smallest_region: None }
    }

    /// Excludes a doubling that would take longer than `seconds` in all.
    #[must_use]
    pub const fn max_time(self, seconds: f64) -> Self {
        Self { max_time: Some(seconds), ..self }
    }

    /// Excludes a doubling that would take more model runs.
    #[must_use]
    pub const fn max_runs(self, runs: u64) -> Self {
        Self { max_runs: Some(runs), ..self }
    }

    /// Requires distinct values of every factor in any region of this part of its range.
    #[must_use]
    pub const fn smallest_region(self, part: f64) -> Self {
        Self { smallest_region: Some(part), ..self }
    }

    /// Returns whether the run grows.
    pub fn grows(&self) -> bool {
        self.accuracy.is_some() || self.max_time.is_some() || self.max_runs.is_some()
    }

    /// Returns the number of distinct values of every factor that an accuracy needs, so that a region of the smallest size
    /// contains one with 95 % probability.
    pub(crate) fn needed_values(&self, is_slow: bool) -> u64 {
        (RULE_OF_THREE / self.region(is_slow)).ceil() as u64
    }

    /// Returns the smallest region, by default that of a model that `is_slow` or not.
    pub(crate) fn region(&self, is_slow: bool) -> f64 {
        self.smallest_region.unwrap_or(if is_slow { SLOW_REGION } else { QUICK_REGION })
    }

    /// Returns the default number of base samples with which a run with `replicates` starts.
    pub(super) fn base_samples(&self, replicates: u64) -> u64 {
        match self {
            // Trials determine the method.
            Self { accuracy: Some(_), .. } => FIRST_TRIAL_POINTS.saturating_mul(replicates),
            // A slow model may not have time for more.
            Self { max_time: Some(_), .. } => FIRST_POINTS.saturating_mul(replicates),
            target if target.grows() => FIRST_STAGE,
            _ => DesignSettings::default().base_samples,
        }
    }

    /// Halves `design` until it takes at most the maximum number of runs; returns an error with the runs of the
    /// smallest one if that takes more.
    pub(crate) fn within_max_runs(&self, mut design: Design) -> Result<Design, u64> {
        while self.max_runs.is_some_and(|most| design.rows() > most) {
            match design.with_points(design.points_per_replicate() / 2) {
                Ok(shorter) => design = shorter,
                Err(_) => return Err(design.rows()),
            }
        }
        Ok(design)
    }
}

/// Smallest region of a model that takes its time, and of one that does not.
const SLOW_REGION: f64 = 0.05;
const QUICK_REGION: f64 = 0.001;

/// Base samples with which a growing run starts.
const FIRST_STAGE: u64 = 1 << 10;

/// Base points of each replicate with which a run with a time limit starts.
const FIRST_POINTS: u64 = 8;

/// The same for a run with a target accuracy.
const FIRST_TRIAL_POINTS: u64 = 4;

/// Maximum number of dependent factors for which Shapley effects are estimated by default.
const FREE_SHAPLEY_FACTORS: usize = 4;

/// Maximum number of outputs of a study with other measures: each takes about a second.
pub(super) const MAX_OUTPUTS_OF_MEASURES: usize = 100;

pub(super) const DEFAULT_RESAMPLES: usize = 1000;

/// Allowed numbers of resamples.
pub(super) const RESAMPLES: RangeInclusive<usize> = 100..=1_000_000;
pub(super) const DEFAULT_THRESHOLD: f64 = 0.05;
pub(super) const DEFAULT_MAX_FAILED: f64 = 0.1;

/// Returns the base samples for at most `runs` runs, `runs_per_point` of each: a power of two in each of `replicates`. An
/// error with the runs of the smallest design if that takes more.
pub(super) fn base_samples_within(runs: u64, runs_per_point: u64, replicates: u64) -> Result<u64, u64> {
    let runs_of_a_point = replicates.saturating_mul(runs_per_point);
    let points = runs / runs_of_a_point.max(1);
    if points < 2 { Err(runs_of_a_point.saturating_mul(2)) } else { Ok((1 << points.ilog2()) * replicates) }
}

/// Returns the rows for the analysis: what has indices, the further groups, the subsets; for dependent factors these once more,
/// redrawn; the dummy; and the subsets that Shapley effects need.
pub(super) fn rows(analysis: &AnalysisOptions, space: &Space) -> Rows {
    let players: Vec<Swap> = analysis.members(space).into_iter().map(|member| member.factors).collect();
    let groups = analysis.further_groups(space).into_iter().map(|group| group.factors);
    let mut swaps: Vec<Swap> = players.iter().cloned().chain(groups).chain(analysis.subsets.iter().cloned()).collect();
    let mut redrawn = Vec::new();
    if space.copula().is_some() {
        redrawn.extend(swaps.len()..2 * swaps.len());
        swaps.extend_from_within(..);
    }
    swaps.extend(analysis.dummy.then(Vec::new));
    if analysis.has_shapley(space) {
        let first = swaps.len();
        for subset in proper_subsets(players.len()) {
            let mut factors: Swap = subset.into_iter().flat_map(|player| players[player].clone()).collect();
            factors.sort_unstable();
            swaps.push(factors);
        }
        redrawn.extend(first..swaps.len());
    }
    let ba = analysis.second_order || analysis.estimators.iter().any(|estimator| estimator.needs_ba());
    let (second_order, copula) = (analysis.second_order, space.copula().cloned());
    Rows { swaps, ba, second_order, copula, redrawn, constants: space.constants() }
}

#[cfg(test)]
#[path = "tests/options.rs"]
mod tests;
