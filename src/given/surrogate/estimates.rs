//! Indices and intervals from the contributions of all folds.

use super::contributions::{FoldSums, To};
use super::{Fitted, MIN_EXPLAINED, SurrogateIndices, SurrogateOutput, leading_terms};
use crate::correction::{CorrectionError, EstimateWithInfluences};
use crate::uncertainty::{Estimate, Interval};

/// Computes the estimates of the inputs with these names from all folds.
pub(super) fn surrogate_output(fitted: &Fitted, names: &[&str]) -> SurrogateOutput {
    let Fitted { folds, expansions, beyond, polynomials_of } = fitted;
    let rows = folds.iter().map(|fold| fold.rows).sum::<usize>() as f64;
    let left_mean = folds.iter().map(|fold| fold.left.0).sum::<f64>() / rows;
    let mut variance = gathered(folds, rows, beyond.variance, To::Variance);
    variance.estimate -= left_mean * left_mean;
    if !(variance.estimate > 0.0 && variance.estimate.is_finite()) {
        // The residual is then larger than the total; the outputs have variance 1.
        variance.estimate = 1.0;
    }
    let of_first_order = |input: usize| gathered(folds, rows, beyond.first_order[input], To::FirstOrder(input));
    let of_total = |input: usize| gathered(folds, rows, beyond.total[input], To::Total(input));
    let first_order: Vec<EstimateWithInfluences> =
        (0..names.len()).map(|input| of_first_order(input).over(&variance)).collect();
    let total: Vec<EstimateWithInfluences> = (0..names.len()).map(|input| of_total(input).over(&variance)).collect();
    let left = fitted.left_square() / variance.estimate;
    let unknown = left.clamp(0.0, 1.0);
    let noise = |list: &[EstimateWithInfluences], skewed: bool| {
        CorrectionError::new(list.iter().map(|index| &index.parts), skewed)
    };
    let (of_first_order, of_total) = (noise(&first_order, false), noise(&total, true));
    let raised = |noise: CorrectionError, of: &EstimateWithInfluences| {
        let Estimate { estimate, interval } = noise.estimate(of);
        let interval = interval.map(|Interval { low, high }| Interval { low, high: high + unknown });
        Estimate { estimate, interval }
    };
    let of_input =
        |((first, all), input): ((&EstimateWithInfluences, &EstimateWithInfluences), &&str)| SurrogateIndices {
            input: (*input).to_owned(),
            first_order: raised(of_first_order, first),
            total: raised(of_total, all),
        };
    let leading = leading_terms(expansions, variance.estimate);
    let explained = 1.0 - left;
    SurrogateOutput {
        explained,
        unknown,
        serves: explained >= MIN_EXPLAINED,
        polynomials_of: (*polynomials_of).to_owned(),
        terms: expansions.iter().map(|e| e.terms.len() as f64).sum::<f64>() / expansions.len() as f64,
        leading_terms: leading.iter().map(|term| term.named(names)).collect(),
        sum_first_order: first_order.iter().map(|index| index.estimate).sum(),
        indices: first_order.iter().zip(&total).zip(names).map(of_input).collect(),
    }
}

/// Returns the mean over all rows, with the influences of the parts of every fold and the error `beyond` the rows.
fn gathered(folds: &[FoldSums], rows: f64, beyond: f64, to: To) -> EstimateWithInfluences {
    let estimate = folds.iter().filter_map(|fold| fold.sums.get(&to)).map(|fold| fold.sum).sum::<f64>() / rows;
    let parts = |fold: &FoldSums| match fold.sums.get(&to) {
        Some(folded) => folded.parts.iter().map(|x| x - estimate).collect(),
        None => vec![-estimate; fold.sums[&To::Variance].parts.len()],
    };
    EstimateWithInfluences { estimate, parts: folds.iter().map(parts).collect(), low: Vec::new(), beyond }
}
