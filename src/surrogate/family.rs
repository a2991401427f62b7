//! The functions of one factor, orthonormal under its distribution: polynomials, and steps and hinges.

use super::orthogonal::{OrthogonalPolynomials, Recurrence, recurred};
use super::stepped::Stepped;
use crate::space::Distribution;
use apportion_base::special::normal_quantile;
use apportion_base::sum::range;

/// The polynomials of one factor.
#[derive(Debug, Clone, PartialEq)]
pub enum Family {
    /// Legendre polynomials of the quantile, scaled to the unit interval: for every distribution.
    Legendre,
    /// Hermite polynomials of the normal quantile: for normal factors.
    Hermite,
    /// Polynomials orthonormal under the distribution of the factor, in its values.
    Orthogonal(Box<OrthogonalPolynomials>),
    /// Others in place of the own polynomials of a factor without bounds.
    Replaced { own: Box<Family>, by: Box<Family> },
    /// Polynomials of the values of a column, orthonormal in the distribution of the column, at these values.
    Column(Box<Recurrence>),
    /// Polynomials of another family with steps and hinges.
    Stepped(Box<Stepped>),
}

impl Family {
    /// Returns the family of a factor with this distribution.
    pub fn new(distribution: &Distribution) -> Self {
        match distribution {
            // No output is smooth in a seed, and a constant does not vary: no polynomials at all.
            Distribution::Seed(_) | Distribution::Constant(_) => Self::Column(Box::default()),
            // Smooth in the logarithm, which is uniform.
            Distribution::Uniform(_) | Distribution::LogUniform(_) | Distribution::Empirical(_) => Self::Legendre,
            Distribution::Normal(_) => Self::Hermite,
            _ => OrthogonalPolynomials::new(distribution, MAX_DEGREES)
                .map_or(Self::Legendre, |polynomials| Self::Orthogonal(Box::new(polynomials))),
        }
    }

    /// Returns the family of a column of `values`, between -2 and 2, with no degree if they are all equal.
    pub fn of_column(values: &[f64]) -> Self {
        let weight = 1.0 / values.len() as f64;
        let nodes: Vec<(f64, f64)> = values.iter().map(|x| (*x, weight)).collect();
        let recurrence = Recurrence::new(&nodes, range(values), MAX_DEGREES);
        Self::Column(Box::new(recurrence.unwrap_or_default()))
    }

    /// Returns its polynomials without steps and hinges.
    pub fn smooth(&self) -> &Self {
        if let Self::Stepped(stepped) = self { &stepped.base } else { self }
    }

    /// Returns the polynomials in the values of the factor, in which a smooth output continues beyond all rows.
    pub fn own(&self) -> &Self {
        if let Self::Replaced { own, .. } = self.smooth() { own } else { self.smooth() }
    }

    /// Returns whether its polynomials grow without bounds.
    pub fn is_unbounded(&self) -> bool {
        match self {
            Self::Hermite => true,
            Self::Orthogonal(polynomials) => polynomials.is_unbounded(),
            Self::Replaced { by, .. } => by.is_unbounded(),
            Self::Stepped(stepped) => stepped.base.is_unbounded(),
            Self::Legendre | Self::Column(_) => false,
        }
    }

    /// Returns whether its polynomials are of counts without a bound.
    pub fn is_count(&self) -> bool {
        matches!(self.own(), Self::Orthogonal(polynomials) if polynomials.is_count())
    }

    /// Returns whether its polynomials are of few levels.
    pub fn has_levels(&self) -> bool {
        matches!(self.own(), Self::Orthogonal(polynomials) if polynomials.has_levels())
    }

    /// Returns the number of levels of a discrete factor if the polynomials are as many.
    pub fn levels(&self) -> Option<usize> {
        let Self::Orthogonal(polynomials) = self.own() else { return None };
        let levels = polynomials.levels_among(f64::INFINITY)?;
        (!polynomials.is_count() && levels == polynomials.degree() + 1).then_some(levels)
    }

    /// Returns the family with the polynomials `by` instead of its own if it is without bounds.
    pub fn replaced(&self, by: Self) -> Self {
        match self.is_unbounded() && *self != by && self.degree() > 0 {
            true => Self::Replaced { own: Box::new(self.clone()), by: Box::new(by) },
            false => self.clone(),
        }
    }

    /// Returns the largest available degree.
    pub fn degree(&self) -> usize {
        match self {
            Self::Legendre | Self::Hermite => MAX_DEGREES,
            Self::Orthogonal(polynomials) => polynomials.degree(),
            Self::Column(recurrence) => recurrence.degree(),
            Self::Replaced { by, .. } => by.degree(),
            Self::Stepped(stepped) => stepped.degree(),
        }
    }
}

/// Maximum degree of any polynomial.
pub(crate) const MAX_DEGREES: usize = 30;

/// Returns the orthonormal polynomials of degrees 1 to `degree` of one factor at `u`, a column for each degree: at the
/// quantiles of the factor, or at the values of a [`Family::Column`].
pub fn polynomials(family: &Family, u: &[f64], degree: usize) -> Vec<Vec<f64>> {
    match family {
        Family::Orthogonal(polynomials) => polynomials.columns(u, degree),
        Family::Stepped(stepped) => stepped.columns(|base, degree| polynomials(base, u, degree), u),
        Family::Column(recurrence) => recurrence.columns(u, degree),
        Family::Replaced { by, .. } => polynomials(by, u, degree),
        Family::Legendre => {
            let x: Vec<f64> = u.iter().map(|u| 2.0 * u - 1.0).collect();
            let mut columns = recurred(&x, degree, |n, x, p, q| ((2.0 * n + 1.0) * x * p - n * q) / (n + 1.0));
            for (k, column) in columns.iter_mut().enumerate() {
                let norm = (2.0 * (k + 1) as f64 + 1.0).sqrt();
                column.iter_mut().for_each(|p| *p *= norm);
            }
            columns
        }
        Family::Hermite => {
            let x: Vec<f64> = u.iter().map(|&u| normal_quantile(u)).collect();
            recurred(&x, degree, |n, x, p, q| (x * p - n.sqrt() * q) / (n + 1.0).sqrt())
        }
    }
}

/// Returns the same at the quantiles of 1 - `v`, to full precision if `v` is small.
pub fn upper_polynomials(family: &Family, v: &[f64], degree: usize) -> Vec<Vec<f64>> {
    match family {
        Family::Orthogonal(polynomials) => polynomials.upper_columns(v),
        Family::Stepped(stepped) => {
            let u: Vec<f64> = v.iter().map(|v| 1.0 - v).collect();
            stepped.columns(|base, degree| upper_polynomials(base, v, degree), &u)
        }
        Family::Replaced { by, .. } => upper_polynomials(by, v, degree),
        Family::Hermite => {
            // They are even or odd.
            let mut columns = polynomials(family, v, degree);
            columns.iter_mut().step_by(2).flatten().for_each(|value| *value = -*value);
            columns
        }
        Family::Legendre | Family::Column(_) => {
            polynomials(family, &v.iter().map(|v| 1.0 - v).collect::<Vec<f64>>(), degree)
        }
    }
}
