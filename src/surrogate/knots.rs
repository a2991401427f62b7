//! Steps and kinks of single factors.
//!
//! Polynomials approach a step or a kink slowly. If their residual is large, it is averaged in bins of the quantile of
//! each factor, and a knot is placed wherever a step and a hinge there reduce it significantly more than by chance. The
//! factor then has both among its functions, orthonormal under its distribution, and a product of steps is one term. A
//! step lies between two sampled values, a kink where the step that accompanies its hinge vanishes.

use std::ops::Range;

use super::family::{Family, Knot, Knotted, polynomials};
use super::gram::add_scaled;
use super::net::Net;
use super::outputs::OutputTable;

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

/// Share of the square of a step, the mean over the rows that show it, that a row must say to be one of them; and the
/// same in squares of their residual.
const NOT_SHOWN: f64 = 0.1;
const UNCERTAIN: f64 = 4.0;

/// Maximum move of a knot, in its widths.
pub const MAX_MOVED: f64 = 1.5;

/// Share of its square that a column must keep in addition to others.
const INDEPENDENT: f64 = 1e-6;

impl Knotted {
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
            true => {
                let reach = MAX_MOVED * knot.width;
                placed_step(*knot, &shown(knot.u - reach..knot.u + reach, nets, moved, factor))
            }
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

/// What the rows at one value of a factor say of the place of a step.
#[derive(Clone, Copy)]
struct Shown {
    u: f64,
    /// How much larger their squared residuals are with the values before the step than with those after it.
    more: f64,
    /// The square of the step.
    step: f64,
    /// The squared residuals on the better side, weighted by that of the step.
    noise: f64,
}

/// Places a step in the middle between the last of `rows` and the next one that shows it, where the sum of squared
/// residuals is least; their distance is the new width.
fn placed_step(knot: Knot, rows: &[Shown]) -> Knot {
    let reach = MAX_MOVED * knot.width;
    let [mut steps, mut squares, mut noise] = [0.0; 3];
    // At every place the sum of the rows before it.
    let mut sums = vec![0.0];
    for (number, row) in rows.iter().enumerate() {
        (steps, squares, noise) = (steps + row.step, squares + row.step * row.step, noise + row.noise);
        sums.push(sums[number] + row.more);
    }
    let best = (0..sums.len()).fold(0, |best, place| if sums[place] < sums[best] { place } else { best });
    let limit = sums[best] + f64::max((NOT_SHOWN * squares + UNCERTAIN * noise) / steps, 0.0);
    let first = (0..best).rev().take_while(|place| sums[*place] <= limit).last().unwrap_or(best);
    let last = (best + 1..sums.len()).take_while(|place| sums[*place] <= limit).last().unwrap_or(best);
    let low = if first == 0 { knot.u - reach } else { rows[first - 1].u };
    let high = rows.get(last).map_or(knot.u + reach, |row| row.u);
    Knot { u: f64::midpoint(low, high), width: high - low, ..knot }
}

/// Returns what rows with quantiles of `factor` in `range` say, by rising quantile.
fn shown(range: Range<f64>, nets: &[Net], moved: &MovedValues, factor: usize) -> Vec<Shown> {
    let mut rows: Vec<Shown> = Vec::new();
    for ((net, left), right) in nets.iter().zip(&moved.left).zip(&moved.right) {
        for (run, output) in net.outputs.iter().enumerate() {
            for (p, &u) in net.quantiles(run, factor).iter().enumerate().filter(|(_, u)| range.contains(u)) {
                let (after, before) = (left.runs[run][p], right.runs[run][p]);
                let [rest_after, rest_before] = [after, before].map(|value| (output[p] - value).powi(2));
                let step = (after - before).powi(2);
                rows.push(Shown { u, more: rest_before - rest_after, step, noise: step * rest_before.min(rest_after) });
            }
        }
    }
    rows.sort_by(|a, b| a.u.total_cmp(&b.u));
    rows.dedup_by(|next, row| {
        let is_same = next.u == row.u;
        if is_same {
            (row.more, row.step, row.noise) = (row.more + next.more, row.step + next.step, row.noise + next.noise);
        }
        is_same
    });
    rows
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
    if family.is_unbounded() {
        // The tails of its polynomials are steep: both families work.
        columns.truncate(super::SAFE_UNBOUNDED_DEGREES);
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
