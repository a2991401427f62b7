//! The corrected estimates of one output.

use super::error::CorrectionError;
use super::influenced::EstimateWithInfluences;
use super::surrogate_use::{LowFidelityUse, Refusal};
use crate::effect::IndexPair;
use crate::surrogate::{CrossFitted, SurrogateTerm};
use crate::uncertainty::{Estimate, Interval, Judgement, StandardError};

/// Maximum ratio of the variance of a factor claimed by surrogates to that over the rows: at most 3.2 for smooth
/// functions at 16 base samples and 1.5 at more; from 6 to many thousand if rows do not represent a factor.
const MAX_GROWTH: f64 = 4.0;

/// Share of the variance below which what surrogates leave is rounding.
const EXACT: f64 = 1e-9;

/// Surrogate estimates of an output.
#[derive(Debug, Clone, PartialEq)]
pub struct SurrogateEstimates {
    /// The indices of every effect, in the order of the layout.
    pub effects: Vec<IndexPair<EstimateWithInfluences>>,
    /// Second-order indices of the pairs of factors; empty if not requested.
    pub pairs: Vec<EstimateWithInfluences>,
    /// The mean of the output.
    pub mean: EstimateWithInfluences,
    /// Its variance.
    pub variance: EstimateWithInfluences,
    /// Share of the variance that the surrogates explain of the runs to which they were not fitted (Q^2).
    pub explained: f64,
    /// Whether a few rows dominate a residual that matters: intervals then include the plain ones.
    pub is_heavy_tailed: bool,
    /// Whether a level of a factor is rare among the rows: intervals then include the plain ones.
    pub misses_levels: bool,
    /// The largest ratio, for all factors or one that matters, of the claimed variance to that over the rows.
    pub growth: f64,
    /// The terms with the largest variance.
    pub terms: Vec<SurrogateTerm>,
    /// The surrogates, for fewer or more of the same points; `None` for outputs that share their terms.
    pub(crate) fitted: Option<CrossFitted>,
    /// Mean number of terms of the surrogates.
    pub term_count: f64,
    /// The low-fidelity model used with the surrogates, if there is one.
    pub low: Option<LowFidelityUse>,
}

/// Contributions to the squared errors of indices.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ErrorShares {
    /// By the rows of the model.
    pub model: f64,
    /// By the runs of a low-fidelity model.
    pub low_fidelity: f64,
}

/// Mean and variance of an output.
pub(crate) struct JudgedMoments {
    pub mean: Judgement,
    pub variance: Judgement,
}

impl SurrogateEstimates {
    /// Returns the sum of the squared errors of all first-order and total indices.
    pub fn squared_error(&self) -> f64 {
        let ErrorShares { model, low_fidelity } = self.squared_errors();
        model + low_fidelity
    }

    /// Returns the contributions to it.
    pub fn squared_errors(&self) -> ErrorShares {
        let first_order: Vec<&EstimateWithInfluences> = self.effects.iter().map(|of| &of.first_order).collect();
        let total: Vec<&EstimateWithInfluences> = self.effects.iter().map(|of| &of.total).collect();
        let ([all, model], [all_total, model_total]) = (squares(&first_order, false), squares(&total, true));
        let low_fidelity = (all + all_total - model - model_total).max(0.0);
        ErrorShares { model: model + model_total, low_fidelity }
    }

    /// Returns whether the surrogates equal the output at all runs to which they were not fitted, to rounding.
    pub fn is_exact(&self) -> bool {
        self.low.is_none() && 1.0 - self.explained < EXACT
    }

    /// Returns whether intervals include the plain ones, whatever the errors.
    pub fn is_uncertain(&self) -> bool {
        self.is_heavy_tailed || self.misses_levels
    }

    /// Returns the largest share of the variance that the surrogates may leave unexplained, over `points` base points.
    pub fn largest_rest(&self, points: u64) -> f64 {
        let rest = (1.0 - self.explained).clamp(EXACT, 1.0);
        rest + 4.0 * (rest / points as f64).sqrt()
    }

    /// Returns a refusal if they claim more variance than the rows show.
    pub fn refusal(&self) -> Option<Refusal> {
        (self.growth > MAX_GROWTH).then_some(Refusal::Growth { times: self.growth })
    }

    /// Returns the mean and variance with their errors.
    pub(crate) fn moments(&self) -> JudgedMoments {
        JudgedMoments { mean: judged_moment(&self.mean, false), variance: judged_moment(&self.variance, true) }
    }
}

fn judged_moment(of: &EstimateWithInfluences, skewed: bool) -> Judgement {
    // In units of the largest influence, so that squares neither underflow nor overflow.
    let influences = of.parts.iter().chain(&of.low).flatten();
    let largest = influences.fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let size = if largest > 0.0 { largest } else { 1.0 };
    let scaled = EstimateWithInfluences::linear(of.estimate / size, &[(1.0 / size, of)]);
    let Judgement { estimate, error, .. } = CorrectionError::of_moment(&scaled.parts, skewed).judgement(&scaled);
    let interval = estimate.interval.map(|i| Interval { low: i.low * size, high: i.high * size });
    let error = StandardError { error: error.error * size, ..error };
    Judgement::new(Estimate { estimate: of.estimate, interval }, error, of.parts.clone())
}

/// Returns the sum of the squared errors of indices of one kind, and the part of it by the rows of the model.
fn squares(list: &[&EstimateWithInfluences], skewed: bool) -> [f64; 2] {
    let error = CorrectionError::new(list.iter().map(|of| &of.parts), skewed);
    list.iter().fold([0.0; 2], |[all, model], of| {
        [all + error.error(of).error.powi(2), model + error.error_of_parts(&of.parts).error.powi(2)]
    })
}
