//! The covariance of the outputs at two rows under the prior: an additive kernel of elementary symmetric polynomials
//! (Duvenaud, Nickisch and Rasmussen 2011; as an ANOVA kernel: Durrande, Ginsbourger, Roustant and Carraro 2013),
//!
//! K(x, x') = constant + sum over q of s_q e_q(B_1, ..., B_d) + noise, B_i = sum over k of v_ik p_ik(x) p_ik(x').
//!
//! Two rows cost d D operations, where a list of terms would cost as many as there are terms.

use multiversion::multiversion;
use rayon::prelude::*;

use super::linear::{
    Cholesky, HEIGHT, LANES, Lane, Panels, Symmetric, Tile, add, add_products, multiply, products, sums_of_squares,
};

/// Maximum number of factors in a term.
pub const MAX_ORDER: usize = 5;

/// Variance of the constant, in units of that of the output.
const CONSTANT: f64 = 0.25;

/// The functions of every factor at some rows.
#[derive(Debug, Clone)]
pub struct Kernel {
    /// For each factor a row for each function, a column for each row of the table.
    pub functions: Vec<Panels>,
    pub rows: usize,
}

/// The parameters of the covariance.
#[derive(Debug, Clone)]
pub struct Variances {
    /// Of each function of each factor.
    pub functions: Vec<Vec<f64>>,
    /// The weight of the products of 1, 2, ... factors.
    pub orders: Vec<f64>,
    pub noise: f64,
}

/// The derivatives of the negative logarithm of the likelihood.
pub struct Derivatives {
    pub functions: Vec<Vec<f64>>,
    pub orders: Vec<f64>,
    pub noise: f64,
}

impl Kernel {
    /// Returns the covariance of the outputs at all pairs of rows.
    pub fn covariance(&self, variances: &Variances) -> Symmetric {
        let panels = (0..self.rows.div_ceil(LANES)).into_par_iter();
        let panels = panels.map(|p| covariance_panel(&self.functions, variances, p)).collect();
        let mut all = Symmetric { size: self.rows, panels };
        all.add_to_diagonal(variances.noise);
        all
    }

    /// Computes the likelihood of independent `outputs`; `None` if the covariance is singular.
    pub fn likelihood<'a>(
        &self,
        variances: &Variances,
        outputs: impl Iterator<Item = &'a [f64]>,
    ) -> Option<Likelihood> {
        let factor = Cholesky::new(self.covariance(variances))?;
        let mut value = 0.0;
        let weights = outputs.map(|y| {
            let whitened = factor.forward(y);
            value += 0.5 * whitened.iter().map(|z| z * z).sum::<f64>() + factor.log_diagonal();
            factor.backward(whitened)
        });
        Some(Likelihood { weights: weights.collect(), value, factor })
    }
}

/// The likelihood of outputs.
pub struct Likelihood {
    factor: Cholesky,
    /// K^-1 y of each output.
    weights: Vec<Vec<f64>>,
    /// Its negative logarithm.
    pub value: f64,
}

impl Likelihood {
    /// Returns the mean square of the rows left out one by one.
    pub fn left_one_out(&self) -> f64 {
        let diagonal = self.factor.inverse_diagonal();
        let left = self.weights.iter().flat_map(|of| of.iter().zip(&diagonal).map(|(a, v)| (a / v) * (a / v)));
        left.sum::<f64>() / (diagonal.len() * self.weights.len()) as f64
    }

    /// Computes the derivatives of the negative logarithm.
    pub fn derivatives(&self, kernel: &Kernel, variances: &Variances) -> Derivatives {
        let Self { factor, weights, .. } = self;
        let inverse: Vec<Vec<Lane>> = (0..factor.panels()).into_par_iter().map(|p| factor.inverse_panel(p)).collect();
        let parts = (0..inverse.len()).into_par_iter();
        let parts: Vec<Sums> =
            parts.map(|p| derivatives_of_panel(&kernel.functions, variances, &inverse, weights, p)).collect();
        let mut sums = Sums::default();
        parts.into_iter().for_each(|part| sums.add(part));
        let trace: f64 = inverse.iter().flat_map(|panel| sums_of_squares(panel)).take(kernel.rows).sum();
        let squares: f64 = weights.iter().flatten().map(|a| a * a).sum();
        let noise = 0.5 * (weights.len() as f64 * trace - squares);
        let mut functions = sums.functions.iter().map(total);
        let functions = variances.functions.iter().map(|of| functions.by_ref().take(of.len()).collect()).collect();
        Derivatives { functions, orders: sums.orders.iter().map(total).collect(), noise }
    }
}

fn total(lane: &Lane) -> f64 {
    lane.iter().sum()
}

/// Returns the functions at the rows of a panel, each times its variance.
fn scaled(functions: &[Panels], variances: &Variances, p: usize) -> Vec<Vec<Lane>> {
    let factors = functions.iter().zip(&variances.functions);
    let of_factor = factors.map(|(functions, variances)| {
        functions.panel(p).iter().zip(variances).map(|(lane, v)| lane.map(|value| v * value)).collect()
    });
    of_factor.collect()
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn covariance_panel(functions: &[Panels], variances: &Variances, p: usize) -> Vec<Lane> {
    let scaled = scaled(functions, variances, p);
    let mut rows = Vec::with_capacity((p + 1) * LANES);
    for q in 0..=p {
        rows.extend(covariance_tile::<0>(functions, &variances.orders, &scaled, q));
        rows.extend(covariance_tile::<HEIGHT>(functions, &variances.orders, &scaled, q));
    }
    rows
}

/// Elementary symmetric polynomials of degree 0, 1, ... .
type Elementary = [Tile; MAX_ORDER + 1];

const NONE: Tile = [[0.0; LANES]; HEIGHT];
const ONE: Tile = [[1.0; LANES]; HEIGHT];
const START: Elementary = [ONE, NONE, NONE, NONE, NONE, NONE];

/// Takes in the covariance `of` a factor.
#[inline(always)]
fn extend(elementary: &mut Elementary, order: usize, of: &Tile) {
    for q in (1..=order).rev() {
        let (lower, upper) = elementary.split_at_mut(q);
        for r in 0..HEIGHT {
            add_products(&mut upper[0][r], &of[r], &lower[q - 1][r]);
        }
    }
}

#[inline(always)]
fn covariance_tile<const FIRST: usize>(functions: &[Panels], orders: &[f64], scaled: &[Vec<Lane>], q: usize) -> Tile {
    let mut elementary = START;
    for (functions, scaled) in functions.iter().zip(scaled) {
        extend(&mut elementary, orders.len(), &products::<FIRST>(functions.panel(q), scaled));
    }
    let mut sums = [[CONSTANT; LANES]; HEIGHT];
    for (weight, of) in orders.iter().zip(&elementary[1..]) {
        for r in 0..HEIGHT {
            add(&mut sums[r], *weight, &of[r]);
        }
    }
    sums
}

/// Sums over pairs of rows, in lanes.
#[derive(Default)]
struct Sums {
    functions: Vec<Lane>,
    orders: Vec<Lane>,
}

impl Sums {
    fn add(&mut self, other: Self) {
        for (sums, more) in [(&mut self.functions, other.functions), (&mut self.orders, other.orders)] {
            if sums.is_empty() {
                *sums = more;
                continue;
            }
            for (sum, more) in sums.iter_mut().zip(&more) {
                add(sum, 1.0, more);
            }
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn derivatives_of_panel(
    functions: &[Panels],
    variances: &Variances,
    inverse: &[Vec<Lane>],
    weights: &[Vec<f64>],
    p: usize,
) -> Sums {
    let scaled = scaled(functions, variances, p);
    let count = variances.functions.iter().map(Vec::len).sum();
    let mut sums = Sums { functions: vec![[0.0; LANES]; count], orders: vec![[0.0; LANES]; variances.orders.len()] };
    let mut parts = vec![NONE; functions.len()];
    let lanes = at_panel(weights, p);
    for q in 0..=p {
        let side = if q < p { 1.0 } else { 0.5 };
        let (a, b) = (&inverse[q][(p - q) * LANES..], &inverse[p][..]);
        let rows = at_panel(weights, q);
        let of = Pair { functions, orders: &variances.orders, scaled: &scaled, p, q };
        let outer = departure::<0>(&products::<0>(a, b), &rows, &lanes, side);
        of.add::<0>(&outer, &mut parts, &mut sums);
        let outer = departure::<HEIGHT>(&products::<HEIGHT>(a, b), &rows, &lanes, side);
        of.add::<HEIGHT>(&outer, &mut parts, &mut sums);
    }
    sums
}

fn at_panel(weights: &[Vec<f64>], p: usize) -> Vec<Lane> {
    let lanes = weights.iter().map(|of| std::array::from_fn(|l| of.get(p * LANES + l).copied().unwrap_or(0.0)));
    lanes.collect()
}

/// Returns `side` times the sum of K^-1 - K^-1 y y' K^-1 over the outputs, in a tile.
#[inline(always)]
fn departure<const FIRST: usize>(inverse: &Tile, rows: &[Lane], lanes: &[Lane], side: f64) -> Tile {
    let mut tile = *inverse;
    for r in 0..HEIGHT {
        multiply(&mut tile[r], &[rows.len() as f64; LANES]);
        for (rows, lanes) in rows.iter().zip(lanes) {
            add(&mut tile[r], -rows[FIRST + r], lanes);
        }
        multiply(&mut tile[r], &[side; LANES]);
    }
    tile
}

/// The rows of two panels.
struct Pair<'a> {
    functions: &'a [Panels],
    orders: &'a [f64],
    scaled: &'a [Vec<Lane>],
    p: usize,
    q: usize,
}

impl Pair<'_> {
    /// Adds the derivatives of a tile of the covariance times `outer`.
    #[inline(always)]
    fn add<const FIRST: usize>(&self, outer: &Tile, parts: &mut [Tile], sums: &mut Sums) {
        let order = self.orders.len();
        let mut elementary = START;
        for ((functions, scaled), part) in self.functions.iter().zip(self.scaled).zip(&mut *parts) {
            *part = products::<FIRST>(functions.panel(self.q), scaled);
            extend(&mut elementary, order, part);
        }
        for (sum, of) in sums.orders.iter_mut().zip(&elementary[1..]) {
            for r in 0..HEIGHT {
                add_products(sum, &outer[r], &of[r]);
            }
        }
        let mut rest = &mut sums.functions[..];
        for (functions, part) in self.functions.iter().zip(parts) {
            let slope = slope(&elementary, self.orders, part, outer);
            let (own, others) = rest.split_at_mut(functions.rows);
            rest = others;
            for (sum, (a, b)) in own.iter_mut().zip(functions.panel(self.q).iter().zip(functions.panel(self.p))) {
                let mut products = [0.0; LANES];
                for r in 0..HEIGHT {
                    add(&mut products, a[FIRST + r], &slope[r]);
                }
                add_products(sum, &products, b);
            }
        }
    }
}

/// Returns `outer` times the derivative by the covariance of one factor: e_(q-1) without it is e_(q-1) less its
/// covariance times e_(q-2) without it.
#[inline(always)]
fn slope(elementary: &Elementary, orders: &[f64], part: &Tile, outer: &Tile) -> Tile {
    let (mut without, mut slope) = (ONE, [[orders[0]; LANES]; HEIGHT]);
    for (of, weight) in elementary[1..].iter().zip(&orders[1..]) {
        for r in 0..HEIGHT {
            multiply(&mut without[r], &part[r]);
            let product = without[r];
            without[r] = of[r];
            add(&mut without[r], -1.0, &product);
            add(&mut slope[r], *weight, &without[r]);
        }
    }
    for r in 0..HEIGHT {
        multiply(&mut slope[r], &outer[r]);
    }
    slope
}

#[cfg(test)]
#[path = "tests/kernel.rs"]
mod tests;
