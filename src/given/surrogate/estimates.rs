//! Indices and intervals from the contributions of all folds.

use super::contributions::{FoldSums, To};
use super::{Fitted, SurrogateIndices, SurrogateOutput, leading_terms, left_square};
use crate::correction::{CorrectionError, EstimateWithInfluences};
use crate::uncertainty::{Estimate, Interval};

/// Computes the estimates of the inputs with these names from all folds.
pub(super) fn surrogate_output(fitted: &Fitted, names: &[&str]) -> SurrogateOutput {
    let Fitted { folds, expansions, extrapolation, polynomials_of } = fitted;
    let rows = folds.iter().map(|fold| fold.rows).sum::<usize>() as f64;
    let left_mean = folds.iter().map(|fold| fold.residual).sum::<f64>() / rows;
    let mut variance = gathered(folds, rows, extrapolation.variance, To::Variance);
    variance.estimate -= left_mean * left_mean;
    if !(variance.estimate > 0.0 && variance.estimate.is_finite()) {
        // The residual is then larger than the total; the outputs have variance 1.
        variance.estimate = 1.0;
    }
    let (mut first_order, mut total) = (Vec::new(), Vec::new());
    for input in 0..names.len() {
        let of_first_order = gathered(folds, rows, extrapolation.first_order[input], To::FirstOrder(input));
        first_order.push(of_first_order.over(&variance));
        total.push(gathered(folds, rows, extrapolation.total[input], To::Total(input)).over(&variance));
    }
    let left = left_square(folds) / variance.estimate;
    let unknown = left.clamp(0.0, 1.0);
    let sum_first_order = first_order.iter().map(|index| index.estimate).sum();
    let indices = raised(&first_order, false, unknown).into_iter().zip(raised(&total, true, unknown)).zip(names);
    let indices = indices.map(|((first_order, total), name)| {
        let input = (*name).to_owned();
        SurrogateIndices { input, first_order, total }
    });
    let leading = leading_terms(expansions, variance.estimate);
    let explained = 1.0 - left;
    SurrogateOutput {
        explained,
        unknown,
        serves: explained >= SurrogateOutput::MIN_EXPLAINED,
        polynomials_of: (*polynomials_of).to_owned(),
        terms: expansions.iter().map(|e| e.terms.len() as f64).sum::<f64>() / expansions.len() as f64,
        leading_terms: leading.iter().map(|term| term.named(names)).collect(),
        sum_first_order,
        indices: indices.collect(),
    }
}

/// Returns indices of one kind with their intervals, whose upper ends are raised by what is `unknown`.
fn raised(indices: &[EstimateWithInfluences], skewed: bool, unknown: f64) -> Vec<Estimate> {
    let noise = CorrectionError::new(indices.iter().map(|index| &index.parts), skewed);
    let estimates = indices.iter().map(|index| {
        let Estimate { estimate, interval } = noise.estimate(index);
        let interval = interval.map(|Interval { low, high }| Interval { low, high: high + unknown });
        Estimate { estimate, interval }
    });
    estimates.collect()
}

/// Returns the mean over all rows, with the influences of the parts of every fold and the `extrapolation` error.
fn gathered(folds: &[FoldSums], rows: f64, extrapolation: f64, to: To) -> EstimateWithInfluences {
    let estimate = folds.iter().filter_map(|fold| fold.sums.get(&to)).map(|fold| fold.sum).sum::<f64>() / rows;
    let parts = folds.iter().map(|fold| match fold.sums.get(&to) {
        Some(folded) => folded.parts.iter().map(|x| x - estimate).collect(),
        None => vec![-estimate; fold.sums[&To::Variance].parts.len()],
    });
    EstimateWithInfluences { estimate, parts: parts.collect(), low: Vec::new(), beyond: extrapolation }
}
