//! Bayesian chaos: a polynomial chaos expansion whose coefficients have a Gaussian prior, learnt from the rows.
//!
//! f(x) = sum over a of c_a phi_a(x), phi_a a product of orthonormal functions of single factors ([`basis`]), c_a
//! normal with a variance that decays with the number of factors and the degrees ([`prior`]). The covariance of the
//! rows needs no list of terms ([`kernel`]), so that the hyperparameters are those of largest marginal likelihood
//! ([`optimise`]). The leading terms are listed, and four [`ways`] lead to their coefficients, the last of which is
//! [least squares](squares). Held-out rows make the [`choice`] among them, and say whether [`knots`], steps and kinks of
//! single factors, or a [`product`] of functions of single factors, join. Indices are sums of squares of coefficients
//! (Sudret 2008), or corrected by rows to which [others](cross_fits) are fitted.

mod basis;
mod choice;
mod cross_fits;
mod directions;
mod kernel;
mod knots;
mod linear;
mod optimise;
mod prior;
mod product;
mod squares;
mod together;
mod ways;

pub(crate) use basis::{Basis, Factor};
pub(crate) use choice::{Chaos, folds_at};
pub(crate) use cross_fits::CrossFits;
pub(crate) use together::expansions_together;

/// Returns the largest degree of polynomials at this number of rows: smooth functions become exact as they grow.
pub(crate) fn degree_at(rows: usize) -> usize {
    (rows / 8).clamp(prior::FITTED_DEGREE, super::family::MAX_DEGREES)
}
