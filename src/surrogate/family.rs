//! The functions of one factor, orthonormal under its distribution: polynomials, with steps and kinks if there are knots.

use super::gram::{Square, add_scaled, inverse, lower_factor};
use super::orthogonal::{OrthogonalPolynomials, Recurrence, recurred, rule};
use crate::space::Distribution;
use apportion_base::special::normal_quantile;
use apportion_base::sum::range;

/// Panels of the quadrature, each half as wide as the one before it, towards either end.
const PANELS: i32 = 50;

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
    /// Polynomials of another family together with steps and kinks, all of which count as degrees.
    Knotted(Box<Knotted>),
}

impl Family {
    /// Returns the family of a factor with this distribution.
    pub fn new(distribution: &Distribution) -> Self {
        match distribution {
            // No output is smooth in a seed: no polynomials at all.
            Distribution::Seed(_) => Self::Column(Box::default()),
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

    /// Returns its polynomials without steps and kinks.
    pub fn smooth(&self) -> &Self {
        if let Self::Knotted(knotted) = self { &knotted.base } else { self }
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
            Self::Knotted(knotted) => knotted.base.is_unbounded(),
            Self::Legendre | Self::Column(_) => false,
        }
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
            Self::Knotted(knotted) => knotted.degree(),
        }
    }
}

/// Maximum degree of any polynomial.
pub(crate) const MAX_DEGREES: usize = 30;

/// The place of a step or a kink of an output in a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// The quantile.
    pub u: f64,
    /// Width of the range of quantiles that contains it.
    pub width: f64,
    /// Whether it is a step rather than a kink.
    pub is_step: bool,
}

/// The polynomials of a factor, and steps and hinges at its knots: orthonormalised under the distribution in the order
/// x, those of the knots, x^2, ..., by quadrature.
#[derive(Debug, Clone, PartialEq)]
pub struct Knotted {
    /// The polynomials without steps and hinges.
    pub base: Family,
    pub knots: Vec<Knot>,
    /// For every knot, its polynomial of degree 1.
    edges: Vec<f64>,
    /// Row k has the coefficients of function k in 1, x, those of the knots, x^2, ..., as many as it needs.
    pub(super) rows: Vec<Vec<f64>>,
}

impl Knotted {
    /// Creates at most `degree` functions of a factor with these `knots` and the polynomials `base`.
    pub fn new(base: &Family, knots: &[Knot], degree: usize) -> Self {
        let all = Self { base: base.clone(), knots: knots.to_vec(), edges: Vec::new(), rows: Vec::new() }.moved(0.0);
        let halves = (1..=PANELS).map(|k| 0.5f64.powi(k));
        let mut ends: Vec<f64> = halves.flat_map(|h| [h, 1.0 - h]).chain(knots.iter().map(|knot| knot.u)).collect();
        ends.sort_by(f64::total_cmp);
        let (u, weights): (Vec<f64>, Vec<f64>) = ends.windows(2).flat_map(|pair| rule(pair[0], pair[1])).unzip();
        let mut columns = all.raw(polynomials(base, &u, degree), degree);
        for column in &mut columns {
            for (value, weight) in column.iter_mut().zip(&weights) {
                *value *= weight.sqrt();
            }
        }
        let mut gram = Square::zeros(columns.len());
        gram.add_products(&columns);
        Self { rows: inverse(&lower_factor(&gram)), ..all }
    }

    /// Returns the largest index of a function.
    pub fn degree(&self) -> usize {
        self.rows.len() - 1
    }

    /// Returns the same functions with the steps and hinges at knots moved by `by` of their widths: the expansion on
    /// either side of a knot.
    pub fn moved(mut self, by: f64) -> Self {
        let places: Vec<f64> = self.knots.iter().map(|knot| knot.u + by * knot.width).collect();
        self.edges = polynomials(&self.base, &places, 1).swap_remove(0);
        self
    }

    /// Returns 1, x, those of the knots, x^2, ... except the last ones, given the polynomials of degree 1, 2, ... . For
    /// a step its hinge comes second, for a kink its step.
    fn raw(&self, mut polynomials: Vec<Vec<f64>>, degree: usize) -> Vec<Vec<f64>> {
        polynomials.truncate(degree.saturating_sub(2 * self.knots.len()).max(1));
        let higher = polynomials.split_off(1);
        let x = polynomials.swap_remove(0);
        let mut columns = vec![vec![1.0; x.len()], x];
        for (edge, knot) in self.edges.iter().zip(&self.knots) {
            let x = &columns[1];
            let step: Vec<f64> = x.iter().map(|x| if x < edge { 0.0 } else { 1.0 }).collect();
            let hinge: Vec<f64> = x.iter().map(|x| if x < edge { 0.0 } else { x - edge }).collect();
            columns.extend(if knot.is_step { [step, hinge] } else { [hinge, step] });
        }
        columns.extend(higher);
        columns
    }

    /// Returns the functions 1, 2, ..., given at least as many polynomials.
    pub fn columns(&self, polynomials: Vec<Vec<f64>>, degree: usize) -> Vec<Vec<f64>> {
        let raw = self.raw(polynomials, self.degree());
        let mut columns = Vec::new();
        for row in self.rows[1..].iter().take(degree) {
            let mut column = vec![0.0; raw[0].len()];
            for (weight, raw) in row.iter().zip(&raw) {
                add_scaled(&mut column, *weight, raw);
            }
            columns.push(column);
        }
        columns
    }

    /// Returns the coefficient of one of the functions 1, x, those of the knots, x^2, ... in an expansion with
    /// `coefficients` (index, coefficient).
    pub fn raw_coefficient(&self, coefficients: &[(usize, f64)], raw: usize) -> f64 {
        coefficients.iter().map(|(k, b)| b * self.rows[*k].get(raw).unwrap_or(&0.0)).sum()
    }
}

/// Returns the orthonormal polynomials of degrees 1 to `degree` of one factor at `u`, a column for each degree: at the
/// quantiles of the factor, or at the values of a [`Family::Column`].
pub fn polynomials(family: &Family, u: &[f64], degree: usize) -> Vec<Vec<f64>> {
    match family {
        Family::Orthogonal(polynomials) => polynomials.columns(u, degree),
        Family::Knotted(knotted) => knotted.columns(polynomials(&knotted.base, u, knotted.degree()), degree),
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
        Family::Knotted(knotted) => knotted.columns(upper_polynomials(&knotted.base, v, knotted.degree()), degree),
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
