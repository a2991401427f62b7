//! Surrogates: sparse polynomial chaos expansions, fitted to the runs of all nets but one.

pub(crate) mod basis;
pub(crate) mod chaos;
mod choice;
mod cross_fit;
pub(crate) mod extrapolation;
pub(crate) mod family;
pub(crate) mod fit;
pub(crate) mod gram;
mod identifiable;
pub(crate) mod net;
mod orthogonal;
pub(crate) mod outputs;
pub(crate) mod stepped;
mod terms;

pub use choice::SurrogateChoice;
pub use cross_fit::{CrossFitted, cross_fitted};
pub(crate) use cross_fit::{expansion_without, fitted_by_chaos, fitted_to_others};
pub use family::Family;
pub use fit::Expansion;
pub(crate) use terms::{Effects, is_interaction, leading_terms, touches, within};
pub use terms::{NamedTerm, SurrogateTerm};

use crate::design::{Design, Sampler};
use crate::space::Space;

/// Minimum number of nets: the number of terms of a surrogate of the others is chosen by leaving out one of them.
pub(crate) const MIN_NETS: usize = 3;

/// Minimum number of base points of a net.
const MIN_POINTS: usize = 4;

/// The same if each has plain rows, which are more informative than rows of a base point that share their columns.
const MIN_POINTS_WITH_PLAIN_ROWS: usize = 2;

/// Maximum sum of degrees of polynomials without bounds in a term. Those of high degree are large where there are hardly any
/// rows: few rows determine their coefficients, and no row shows their behaviour beyond.
pub(crate) const SAFE_UNBOUNDED_DEGREES: usize = 4;

/// The same if this reduces the residuals of the other runs clearly, as for powers and exponentials.
pub(crate) const MAX_UNBOUNDED_DEGREES: usize = 10;

/// The ratio that counts as clearly less.
const CLEARLY_LESS: f64 = 0.25;

/// Maximum number of rows of all nets together to which surrogates are fitted: more hardly change the coefficients of
/// about a hundred terms, and the residuals of an expansion are computed from all rows.
pub(crate) const MAX_FITTED_ROWS: u64 = 1 << 16;

/// Returns the polynomials of every factor of `space`.
pub(crate) fn families(space: &Space) -> Vec<Family> {
    space.factors().iter().map(|factor| Family::new(factor.distribution())).collect()
}

/// Returns whether there are enough nets, and the points are nets.
pub(crate) fn takes_surrogates(design: &Design, replicates: usize) -> bool {
    design.settings().sampler != Sampler::LatinHypercube && replicates >= MIN_NETS
}

/// Returns the minimum number of base points of a net of `design` to which surrogates are fitted.
pub(crate) fn fewest_points(design: &Design) -> usize {
    if design.plain_rows() > 0 { MIN_POINTS_WITH_PLAIN_ROWS } else { MIN_POINTS }
}

/// A set of polynomials to try.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trial {
    /// The polynomials of every factor.
    pub families: Vec<Family>,
    /// Maximum sum of degrees of polynomials without bounds in a term.
    pub unbounded_degree: usize,
    /// Maximum ratio of its residual to that of the best previous trial for which it is preferred.
    pub ratio: f64,
}

/// Returns the trials for factors with the polynomials `families`, in order.
pub(crate) fn trials(families: &[Family]) -> Vec<Trial> {
    let safe = Trial { families: families.to_vec(), unbounded_degree: SAFE_UNBOUNDED_DEGREES, ratio: 1.0 };
    if !families.iter().any(Family::is_unbounded) {
        return vec![safe];
    }
    let [bounded, scores] = [Family::Legendre, Family::Hermite]
        .map(|by| Trial { families: families.iter().map(|own| own.replaced(by.clone())).collect(), ..safe.clone() });
    let steep = Trial { unbounded_degree: MAX_UNBOUNDED_DEGREES, ratio: CLEARLY_LESS, ..scores.clone() };
    if scores == safe { vec![safe, bounded, steep] } else { vec![safe, bounded, scores, steep] }
}

/// Returns the first base points of `design` with at most [`MAX_FITTED_ROWS`] rows: a power of two, or all.
pub(crate) fn fitted_design(design: &Design) -> Design {
    let most = MAX_FITTED_ROWS * design.points_per_replicate() / design.rows().max(1);
    if design.rows() <= MAX_FITTED_ROWS || most == 0 {
        return design.clone();
    }
    design.with_points(1 << most.ilog2()).unwrap_or_else(|_| design.clone())
}
