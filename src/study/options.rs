//! What is asked of the runs of a study, and when they end.

use crate::design::{Companions, Rows, Sampler};
use crate::estimate::Estimator;
use crate::run::FailurePolicy;
use crate::space::Space;
use crate::uncertainty::IntervalMethod;

/// What is asked of the runs.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisOptions {
    /// Estimators whose indices stand beside those of the default ones.
    pub estimators: Vec<Estimator>,
    /// Whether second-order indices are estimated.
    pub second_order: bool,
    /// Sets of factors, by number, whose joint indices are asked for.
    pub subsets: Vec<Vec<usize>>,
    /// Whether indices over all outputs together are asked for.
    pub aggregate: bool,
    /// Whether a dummy factor, which does nothing, is run along: its indices are the noise of the model.
    pub dummy: bool,
    /// How intervals are found.
    pub intervals: IntervalMethod,
    /// Resamples of a bootstrap.
    pub resamples: usize,
    /// Total index above which a factor counts as one that matters.
    pub threshold: f64,
    /// What happens when a run fails.
    pub failures: FailurePolicy,
    /// Largest share of the runs that may fail before there are no indices.
    pub max_failed: f64,
}

impl AnalysisOptions {
    /// Nothing beside first-order and total indices, with the intervals that serve points of `sampler` best.
    pub fn for_sampler(sampler: Sampler) -> Self {
        Self {
            estimators: Vec::new(),
            second_order: false,
            subsets: Vec::new(),
            aggregate: false,
            dummy: false,
            intervals: IntervalMethod::default_for(sampler),
            resamples: DEFAULT_RESAMPLES,
            threshold: DEFAULT_THRESHOLD,
            failures: FailurePolicy::DropBlock,
            max_failed: DEFAULT_MAX_FAILED,
        }
    }
}

/// When a run that grows by doubling ends; one that asks for none of these has the size that the design says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stopping {
    /// Half width that the interval of every first-order and total index must reach.
    pub half_width: Option<f64>,
    /// Seconds that the run may take.
    pub budget: Option<f64>,
    /// Model runs that it may take.
    pub max_runs: Option<u64>,
}

impl Stopping {
    /// Whether the run grows.
    pub fn grows(&self) -> bool {
        *self != Self::default()
    }
}

pub(super) const DEFAULT_RESAMPLES: usize = 1000;
pub(super) const DEFAULT_THRESHOLD: f64 = 0.05;
pub(super) const DEFAULT_MAX_FAILED: f64 = 0.1;

/// The rows for what is asked: the factors, the groups, the subsets, the dummy.
pub(super) fn rows(analysis: &AnalysisOptions, space: &Space) -> Rows {
    let single = (0..space.factors().len()).map(|number| vec![number]);
    let groups = space.groups().into_iter().map(|group| group.factors);
    let dummy = analysis.dummy.then(Vec::new);
    let swaps = single.chain(groups).chain(analysis.subsets.iter().cloned()).chain(dummy).collect();
    let second_order = Companions { ba: analysis.second_order, ..Companions::NONE };
    let companions = analysis.estimators.iter().fold(second_order, |all, estimator| all.union(estimator.needs()));
    Rows { swaps, companions, second_order: analysis.second_order }
}
