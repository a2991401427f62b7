//! Indices and intervals from a fit.

use super::marginals::Influences;
use super::{SurrogateIndices, SurrogateOutput};
use crate::correction::{HeldOut, PlainFit};
use crate::surrogate::leading_terms;
use crate::uncertainty::{Estimate, Interval, NORMAL_QUANTILE};

/// Computes the estimates of the inputs with these names, whose distributions may be those of the columns; the fit is by
/// `polynomials_of` them.
pub(super) fn surrogate_output(
    fit: &PlainFit,
    polynomials_of: &str,
    names: &[&str],
    uses_columns: bool,
) -> SurrogateOutput {
    let PlainFit { chaos, expansion, extrapolation } = fit;
    let influences = uses_columns.then(|| Influences::new(chaos.basis(), expansion));
    let (first_order, total) = chaos.indices();
    let judged = Judged { fit, held_out: HeldOut::new(chaos), influences };
    let of_first = judged.kind(&first_order, &extrapolation.first_order, true);
    let of_total = judged.kind(&total, &extrapolation.total, false);
    let indices = names.iter().zip(of_first).zip(of_total).map(|((name, first_order), total)| SurrogateIndices {
        input: (*name).to_owned(),
        first_order,
        total,
    });
    let explained = 1.0 - chaos.rest;
    let leading = leading_terms(std::slice::from_ref(expansion), chaos.variances.all);
    SurrogateOutput {
        explained,
        unknown: chaos.rest.clamp(0.0, 1.0),
        serves: explained >= SurrogateOutput::MIN_EXPLAINED,
        polynomials_of: polynomials_of.to_owned(),
        terms: chaos.terms().count() as f64,
        leading_terms: leading.iter().map(|term| term.named(names)).collect(),
        sum_first_order: first_order.iter().sum(),
        indices: indices.collect(),
    }
}

/// What intervals are made of.
struct Judged<'a> {
    fit: &'a PlainFit,
    held_out: HeldOut<'a>,
    /// Those of the rows through the distributions of the columns.
    influences: Option<Influences>,
}

impl Judged<'_> {
    /// Returns the first-order or the total `indices` with their intervals; `beyond` are the errors of their numerators
    /// that no rows show.
    fn kind(&self, indices: &[f64], beyond: &[f64], is_first: bool) -> Vec<Estimate> {
        let chaos = &self.fit.chaos;
        let spreads = indices.iter().enumerate().map(|(input, index)| {
            let is_in = |set: &Vec<usize>| set.contains(&input) && !(is_first && set.len() > 1);
            let weights: Vec<f64> = chaos.sets().iter().map(|set| f64::from(u8::from(is_in(set)))).collect();
            let of_parts = chaos.variances_of_parts().map(|of| {
                let own = if is_first { of.first_order[input] } else { of.total[input] };
                own / of.all.max(f64::MIN_POSITIVE)
            });
            self.held_out.spread(&weights, *index, &of_parts.collect::<Vec<f64>>())
        });
        let half_widths = self.held_out.half_widths(&spreads.collect::<Vec<_>>());
        let all = indices.iter().zip(half_widths).zip(beyond).enumerate();
        all.map(|(input, ((&estimate, half), beyond))| {
            let own = self.influences.as_ref().map(|all| (all, if is_first { &all.first_order } else { &all.total }));
            let squares = own.map_or(0.0, |(all, own)| {
                let moves = own[input].iter().zip(&all.variance).map(|(own, all)| own - estimate * all);
                moves.map(|x| x * x).sum::<f64>() / all.variance.len().pow(2) as f64
            });
            let by_columns = NORMAL_QUANTILE * squares.sqrt() / (chaos.variances.all + chaos.rest);
            let half = half + self.fit.beyond(estimate, *beyond) + by_columns;
            Estimate { estimate, interval: Some(Interval::about(estimate, half)) }
        })
        .collect()
    }
}
