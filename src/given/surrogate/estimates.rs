//! Indices and intervals from a fit.

use super::marginals::Influences;
use super::{Fitted, SurrogateIndices, SurrogateOutput, leading_terms};
use crate::uncertainty::{Estimate, Interval};

/// Quantile of the standard normal distribution for intervals of 95 %.
const NORMAL: f64 = 1.959_963_984_540_054;

/// Computes the estimates of the inputs with these names, whose distributions may be those of the columns.
pub(super) fn surrogate_output(fitted: &Fitted, names: &[&str], uses_columns: bool) -> SurrogateOutput {
    let Fitted { chaos, expansion, extrapolation, polynomials_of } = fitted;
    let influences = uses_columns.then(|| Influences::new(chaos.basis(), expansion));
    let (first_order, total) = chaos.indices();
    let half_widths = HalfWidths { fitted, influences: influences.as_ref() };
    let indices = names.iter().enumerate().map(|(input, name)| {
        let first_influences = influences.as_ref().map(|all| &all.first_order[input][..]);
        let total_influences = influences.as_ref().map(|all| &all.total[input][..]);
        SurrogateIndices {
            input: (*name).to_owned(),
            first_order: half_widths.estimate(first_order[input], first_influences, extrapolation.first_order[input]),
            total: half_widths.estimate(total[input], total_influences, extrapolation.total[input]),
        }
    });
    let explained = 1.0 - chaos.rest;
    let leading = leading_terms(std::slice::from_ref(expansion), chaos.variances.all);
    SurrogateOutput {
        explained,
        unknown: chaos.rest.clamp(0.0, 1.0),
        serves: explained >= SurrogateOutput::MIN_EXPLAINED,
        polynomials_of: (*polynomials_of).to_owned(),
        terms: chaos.terms().count() as f64,
        leading_terms: leading.iter().map(|term| term.named(names)).collect(),
        sum_first_order: first_order.iter().sum(),
        indices: indices.collect(),
    }
}

/// What intervals are made of.
struct HalfWidths<'a> {
    fitted: &'a Fitted,
    influences: Option<&'a Influences>,
}

impl HalfWidths<'_> {
    /// Returns an index with its interval, given the influences of the rows on its numerator through the
    /// distributions of the columns, and the error of it that no rows show.
    fn estimate(&self, index: f64, influences: Option<&[f64]>, beyond: f64) -> Estimate {
        let variance = self.fitted.chaos.variances.all + self.fitted.chaos.rest;
        let beyond = (beyond + index * self.fitted.extrapolation.variance) / variance;
        let squares = self.influences.zip(influences).map_or(0.0, |(all, own)| {
            let moves = own.iter().zip(&all.variance).map(|(own, all)| own - index * all);
            moves.map(|x| x * x).sum::<f64>() / (own.len() * own.len()) as f64
        });
        let half = self.fitted.chaos.half_width() + beyond + NORMAL * squares.sqrt() / variance;
        Estimate { estimate: index, interval: Some(Interval { low: index - half, high: index + half }) }
    }
}
