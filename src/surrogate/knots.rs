//! Steps and kinks of single factors.
//!
//! Polynomials approach a step or a kink slowly. If their residual is large, it is averaged in bins of the quantile of
//! each factor, and a knot is placed wherever a step and a hinge there reduce it significantly more than by chance. The
//! factor then has both among its functions, orthonormal under its distribution, and a product of steps is one term. A
//! step lies between two sampled values, a kink where the step that accompanies its hinge vanishes.

use std::ops::Range;

use super::basis::{Family, polynomials};
use super::gram::{Square, add_scaled, inverse, lower_factor};
use super::net::Net;
use super::orthogonal::rule;
use super::outputs::OutputTable;
use super::terms::Knot;

/// Maximum number of knots of a factor.
const MAX_KNOTS: usize = 4;

/// Minimum and maximum number of bins, and base points for each: four values of a factor.
const MIN_BINS: usize = 16;
const MAX_BINS: usize = 256;
const POINTS_OF_BIN: usize = 2;

/// Number of bins for each polynomial with which their means are compared.
const BINS_OF_POLYNOMIAL: usize = 3;

/// Minimum F ratio of the step and the hinge of a knot, the largest over all places.
const SIGNIFICANT: f64 = 10.0;

/// Minimum distance of two knots in the quantile. Nearer ones are mostly a single one next to the edge of a bin.
const APART: f64 = 0.04;

/// Maximum move of a knot, in its widths.
pub const MAX_MOVED: f64 = 1.5;

/// Share of its square that a column must keep in addition to others.
const INDEPENDENT: f64 = 1e-6;

/// Panels of the quadrature, each half as wide as the one before it, towards either end.
const PANELS: i32 = 50;

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
    rows: Vec<Vec<f64>>,
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
    fn raw_coefficient(&self, coefficients: &[(usize, f64)], raw: usize) -> f64 {
        coefficients.iter().map(|(k, b)| b * self.rows[*k].get(raw).unwrap_or(&0.0)).sum()
    }

    /// Places the knots of `factor` by the output of `nets`, given the values of expansions with `moved` knots and the
    /// `coefficients` (index, coefficient) of the functions of the factor.
    pub(crate) fn placed(
        &self,
        nets: &[Net],
        moved: &MovedValues,
        factor: usize,
        coefficients: &[(usize, f64)],
    ) -> Vec<Knot> {
        let knots = self.knots.iter().enumerate().map(|(place, knot)| match knot.is_step {
            true => placed_step(*knot, nets, moved, factor),
            false => self.placed_kink(place, coefficients),
        });
        knots.collect()
    }

    /// Places a kink where a part of an expansion has no step, by one Newton step: near it, s + h (x - edge) is
    /// h (x - (edge - s/h)). Its length is the new width.
    fn placed_kink(&self, place: usize, coefficients: &[(usize, f64)]) -> Knot {
        let knot = self.knots[place];
        let slope = self.raw_coefficient(coefficients, 2 + 2 * place);
        let step = self.raw_coefficient(coefficients, 3 + 2 * place);
        let near = 0.01 * knot.width;
        let x = &polynomials(&self.base, &[knot.u - near, knot.u + near], 1)[0];
        let limit = MAX_MOVED * knot.width;
        let by = (-step / slope * 2.0 * near / (x[1] - x[0])).clamp(-limit, limit);
        if by.is_finite() { Knot { u: knot.u + by, width: by.abs(), ..knot } } else { knot }
    }
}

/// Values of expansions of all nets with all knots moved to the left and to the right as far as allowed.
pub(crate) struct MovedValues {
    pub left: Vec<OutputTable>,
    pub right: Vec<OutputTable>,
}

/// Places a step where the sum of squared residuals of all rows nearby is least: between two sampled values, whose
/// distance is the new width.
fn placed_step(knot: Knot, nets: &[Net], moved: &MovedValues, factor: usize) -> Knot {
    let reach = MAX_MOVED * knot.width;
    // How much larger the residuals are with the values before the step than with those after it.
    let mut rows: Vec<(f64, f64)> = Vec::new();
    for ((net, left), right) in nets.iter().zip(&moved.left).zip(&moved.right) {
        for (run, output) in net.outputs.iter().enumerate() {
            for (p, u) in net.quantiles(run, factor).iter().enumerate() {
                if (u - knot.u).abs() < reach {
                    let (after, before) = (output[p] - left.runs[run][p], output[p] - right.runs[run][p]);
                    rows.push((*u, before.powi(2) - after.powi(2)));
                }
            }
        }
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let ends: Vec<f64> = [knot.u - reach].into_iter().chain(rows.iter().map(|row| row.0)).collect();
    let (mut sum, mut least, mut best) = (0.0, 0.0, 0);
    for (number, (u, more)) in rows.iter().enumerate() {
        sum += more;
        if sum < least && rows.get(number + 1).is_none_or(|next| next.0 > *u) {
            (least, best) = (sum, number + 1);
        }
    }
    let next = ends.get(best + 1).copied().unwrap_or(knot.u + reach);
    Knot { u: (ends[best] + next) / 2.0, width: next - ends[best], ..knot }
}

/// Returns the knots of `factor` that the residuals `rest` of expansions show; none for seeds and factors with few
/// levels.
pub(crate) fn knots(nets: &[Net], rest: &[OutputTable], factor: usize, family: &Family, degree: usize) -> Vec<Knot> {
    let points: usize = nets.iter().map(Net::points).sum();
    let bins = (points / POINTS_OF_BIN).next_power_of_two().clamp(MIN_BINS, MAX_BINS);
    let centres: Vec<f64> = (0..bins).map(|bin| (bin as f64 + 0.5) / bins as f64).collect();
    let degree = degree.min(bins / BINS_OF_POLYNOMIAL);
    let mut columns = polynomials(family, &centres, degree);
    let Some(x) = columns.first().cloned().filter(|x| x.is_sorted_by(|a, b| a < b)) else { return Vec::new() };
    if *family == Family::Hermite {
        // The tails of its polynomials are steep: both families work.
        columns.truncate(super::SAFE_HERMITE_DEGREES);
        columns.append(&mut polynomials(&Family::Legendre, &centres, degree));
    }
    let mut residuals = BinnedResiduals::new(nets, rest, factor, bins);
    residuals.remove(vec![1.0; bins]);
    for column in columns {
        residuals.remove(column);
    }
    let mut knots: Vec<Knot> = Vec::new();
    while knots.len() < MAX_KNOTS {
        let is_free = |u: f64| knots.iter().all(|knot| (knot.u - u).abs() >= APART);
        let Some(Gain { gain, bin: t, is_step }) = residuals.best_knot(&x, is_free) else { break };
        let freedom = bins as f64 - residuals.basis.len() as f64 - 2.0;
        let left = residuals.product(&residuals.rest, &residuals.rest) - gain;
        if freedom < 3.0 || gain / 2.0 < SIGNIFICANT * left / freedom {
            break;
        }
        knots.push(Knot { u: t as f64 / bins as f64, width: 1.0 / bins as f64, is_step });
        let edge = (x[t] + x[t - 1]) / 2.0;
        residuals.remove(indicator(bins, t..bins));
        residuals.remove(x.iter().map(|x| (x - edge).max(0.0)).collect());
        // It may lie anywhere in the bins next to it.
        residuals.remove(indicator(bins, t - 1..t));
        residuals.remove(indicator(bins, t..t + 1));
    }
    knots
}

/// Returns 1 for the bins in `range`, 0 for the others.
fn indicator(bins: usize, range: Range<usize>) -> Vec<f64> {
    (0..bins).map(|bin| f64::from(u8::from(range.contains(&bin)))).collect()
}

/// Means of residuals in bins, and the columns that have been removed from them.
struct BinnedResiduals {
    /// Orthonormal columns.
    basis: Vec<Vec<f64>>,
    /// The means, orthogonal to these.
    rest: Vec<f64>,
    weights: Vec<f64>,
}

/// The gain of a knot.
struct Gain {
    /// The reduction of the residuals by a step and a hinge.
    gain: f64,
    /// The first bin after the knot.
    bin: usize,
    /// Whether the step alone reduces more than the hinge alone.
    is_step: bool,
}

impl BinnedResiduals {
    /// Averages the residuals `rest` of all nets in bins of the quantile of `factor`.
    fn new(nets: &[Net], rest: &[OutputTable], factor: usize, bins: usize) -> Self {
        let (mut sums, mut weights) = (vec![0.0; bins], vec![0.0; bins]);
        for (net, rest) in nets.iter().zip(rest) {
            for (run, rest) in rest.runs.iter().enumerate() {
                for (u, e) in net.quantiles(run, factor).iter().zip(rest) {
                    let bin = ((u * bins as f64) as usize).min(bins - 1);
                    sums[bin] += e;
                    weights[bin] += 1.0;
                }
            }
        }
        let rest = sums.iter().zip(&weights).map(|(sum, weight)| sum / f64::max(*weight, 1.0)).collect();
        Self { basis: Vec::new(), rest, weights }
    }

    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        self.weights.iter().zip(a.iter().zip(b)).map(|(weight, (a, b))| weight * a * b).sum()
    }

    /// Removes the part of `column` that is orthogonal to the removed ones, unless it vanishes.
    fn remove(&mut self, mut column: Vec<f64>) {
        let square = self.product(&column, &column);
        // Twice, because the first pass leaves rounding.
        for removed in self.basis.iter().chain(&self.basis) {
            let part = self.product(removed, &column);
            add_scaled(&mut column, -part, removed);
        }
        let length = self.product(&column, &column);
        if length > INDEPENDENT * square {
            for value in &mut column {
                *value /= length.sqrt();
            }
            let part = self.product(&column, &self.rest);
            add_scaled(&mut self.rest, -part, &column);
            self.basis.push(column);
        }
    }

    /// Returns the largest gain of a knot in `x` at a free place. Running sums from the last bin make all places as
    /// cheap as one.
    fn best_knot(&self, x: &[f64], is_free: impl Fn(f64) -> bool) -> Option<Gain> {
        let (bins, ones) = (x.len(), vec![1.0; x.len()]);
        let columns: Vec<&[f64]> =
            [&ones, x, &self.rest].into_iter().chain(self.basis.iter().map(Vec::as_slice)).collect();
        // Products of every column with the step at the bin, and with x after it.
        let (mut with_step, mut with_x) = (vec![0.0; columns.len()], vec![0.0; columns.len()]);
        let mut best: Option<Gain> = None;
        for t in (2..bins).rev() {
            let (weight, at) = (self.weights[t], x[t]);
            for (k, column) in columns.iter().enumerate() {
                with_step[k] += weight * column[t];
                with_x[k] += weight * at * column[t];
            }
            if t > bins - 2 || !is_free(t as f64 / bins as f64) {
                continue;
            }
            // Products of the step and the hinge with one another, minus their part in the basis.
            let edge = (at + x[t - 1]) / 2.0;
            let with_hinge: Vec<f64> = with_x.iter().zip(&with_step).map(|(x, step)| x - edge * step).collect();
            let step_square = with_step[0];
            let hinge_square = with_x[1] - 2.0 * edge * with_x[0] + edge * edge * with_step[0];
            let (mut step, mut hinge, mut both) = (step_square, hinge_square, with_hinge[0]);
            for (of_step, of_hinge) in with_step.iter().zip(&with_hinge).skip(3) {
                step -= of_step * of_step;
                hinge -= of_hinge * of_hinge;
                both -= of_step * of_hinge;
            }
            let (of_step, of_hinge) = (with_step[2], with_hinge[2]);
            let determinant = step * hinge - both * both;
            if step > INDEPENDENT * step_square
                && hinge > INDEPENDENT * hinge_square
                && determinant > INDEPENDENT * step * hinge
            {
                let gain = of_step * of_step * hinge - 2.0 * of_step * of_hinge * both + of_hinge * of_hinge * step;
                let gain = gain / determinant;
                if best.as_ref().is_none_or(|best| gain > best.gain) {
                    let is_step = of_step * of_step / step > of_hinge * of_hinge / hinge;
                    best = Some(Gain { gain, bin: t, is_step });
                }
            }
        }
        best
    }
}

#[cfg(test)]
mod tests;
