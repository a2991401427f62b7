//! Indices and intervals from a fit.

use super::marginals::Influences;
use super::{SurrogateIndices, SurrogateOutput};
use crate::correction::{Judged, PlainFit};
use crate::surrogate::{Effects, leading_terms};
use crate::uncertainty::{Estimate, Interval, NORMAL_QUANTILE};

/// Computes the estimates of the inputs with these names, whose distributions may be those of the columns; the fit is by
/// `polynomials_of` them.
pub(super) fn surrogate_output(
    fit: &PlainFit,
    effects: &Effects,
    polynomials_of: &str,
    names: &[&str],
    uses_columns: bool,
) -> SurrogateOutput {
    let PlainFit { chaos, expansion, .. } = fit;
    let influences = uses_columns.then(|| Influences::new(chaos.basis(), expansion));
    let judged = Judged::new(fit, effects);
    let (mut first_order, mut total) = (judged.first_order(), judged.total());
    // Those of a product are integrals.
    for (input, of) in first_order.iter_mut().enumerate() {
        of.variance = chaos.variances.first_order[input];
        of.of_parts =
            chaos.variances_of_parts().map(|of| of.first_order[input] / of.all.max(f64::MIN_POSITIVE)).collect();
    }
    for (input, of) in total.iter_mut().enumerate() {
        of.variance = chaos.variances.total[input];
        of.of_parts = chaos.variances_of_parts().map(|of| of.total[input] / of.all.max(f64::MIN_POSITIVE)).collect();
    }
    let [of_first, of_total] = [first_order, total].map(|kind| judged.judge(&kind));
    let whole = chaos.variances.all + chaos.rest;
    let all = names.iter().zip(of_first).zip(of_total).enumerate();
    let indices: Vec<SurrogateIndices> = all
        .map(|(input, ((name, first_order), total))| {
            let [first_order, total] = [first_order, total].map(|of| of.estimate);
            SurrogateIndices {
                input: (*name).to_owned(),
                first_order: influences
                    .as_ref()
                    .map_or(first_order, |all| widened(first_order, all, &all.first_order[input], whole)),
                total: influences.as_ref().map_or(total, |all| widened(total, all, &all.total[input], whole)),
            }
        })
        .collect();
    let explained = 1.0 - chaos.rest;
    let leading = leading_terms(std::slice::from_ref(expansion), chaos.variances.all);
    SurrogateOutput {
        explained,
        unknown: chaos.rest.clamp(0.0, 1.0),
        serves: explained >= SurrogateOutput::MIN_EXPLAINED,
        polynomials_of: polynomials_of.to_owned(),
        terms: chaos.terms().count() as f64,
        leading_terms: leading.iter().map(|term| term.named(names)).collect(),
        sum_first_order: indices.iter().map(|of| of.first_order.estimate).sum(),
        indices,
    }
}

/// Adds the error of an index by the distributions of the columns, through which the rows move its part of the `whole`
/// variance by `own`.
fn widened(Estimate { estimate, interval }: Estimate, all: &Influences, own: &[f64], whole: f64) -> Estimate {
    let moves = own.iter().zip(&all.variance).map(|(own, all)| own - estimate * all);
    let squares = moves.map(|x| x * x).sum::<f64>() / all.variance.len().pow(2) as f64;
    let more = NORMAL_QUANTILE * squares.sqrt() / whole;
    Estimate { estimate, interval: interval.map(|of| Interval { low: of.low - more, high: of.high + more }) }
}
