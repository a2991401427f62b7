//! Surrogates: expansions by Bayesian chaos, fitted to the runs of all nets but one.

pub(crate) mod chaos;
mod choice;
pub(crate) mod combinations;
mod cross_fit;
pub(crate) mod expansion;
pub(crate) mod extrapolation;
pub(crate) mod family;
pub(crate) mod net;
mod orthogonal;
pub(crate) mod outputs;
mod placed;
pub(crate) mod stepped;
mod terms;

pub use choice::SurrogateChoice;
pub use cross_fit::CrossFitted;
pub(crate) use cross_fit::FittedRows;
pub use expansion::Expansion;
pub use family::Family;
pub(crate) use placed::placed;
pub(crate) use terms::{Effects, is_interaction, leading_terms, touches, within};
pub use terms::{NamedTerm, SurrogateTerm, Term};

use crate::design::{Design, Sampler};
use crate::space::Space;

/// Minimum number of nets: the number of terms of a surrogate of the others is chosen by leaving out one of them.
pub(crate) const MIN_NETS: usize = 3;

/// Minimum number of base points of a net to which surrogates are fitted.
pub(crate) const MIN_POINTS: usize = 4;

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

/// Returns the polynomials to try for factors with those of `families`, in order: in the values of factors without bounds,
/// in their quantiles, and in their normal quantiles.
pub(crate) fn choices(families: &[Family]) -> Vec<Vec<Family>> {
    let mut all = vec![families.to_vec()];
    for by in [Family::Legendre, Family::Hermite] {
        let others = families.iter().map(|own| own.replaced(by.clone())).collect();
        if !all.contains(&others) {
            all.push(others);
        }
    }
    all
}

/// Returns the first base points of `design` with at most [`MAX_FITTED_ROWS`] rows: a power of two, or all.
pub(crate) fn fitted_design(design: &Design) -> Design {
    let most = MAX_FITTED_ROWS * design.points_per_replicate() / design.rows().max(1);
    if design.rows() <= MAX_FITTED_ROWS || most == 0 {
        return design.clone();
    }
    design.with_points(1 << most.ilog2()).unwrap_or_else(|_| design.clone())
}
