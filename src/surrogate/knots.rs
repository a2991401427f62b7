//! Steps and kinks of single factors.
//!
//! Polynomials approach a step or a kink slowly. If their residual is large, it is averaged in bins of the quantile of
//! each factor, and a knot is placed wherever a step and a hinge there reduce it significantly more than by chance. The
//! factor then has both among its functions, orthonormal under its distribution, and a product of steps is one term. A
//! step lies between two sampled values, a kink where the step that accompanies its hinge vanishes.

use super::basis::{Family, polynomials};
use super::gram::{Square, inverse, lower_factor};
use super::net::Net;
use super::own::rule;
use crate::correction::Knot;

/// Maximum number of knots of a factor.
const MAX_KNOTS: usize = 4;

/// Minimum and maximum number of bins, and base points for each: four values of a factor.
const BINS: (usize, usize) = (16, 256);
const POINTS_OF_BIN: usize = 2;

/// Number of bins for each polynomial with which their means are compared.
const BINS_OF_POLYNOMIAL: usize = 3;

/// Minimum F ratio of the step and the hinge of a knot, the largest over all places.
const SIGNIFICANT: f64 = 10.0;

/// Minimum distance of two knots in the quantile. Nearer ones are mostly a single one next to the edge of a bin.
const APART: f64 = 0.04;

/// Maximum move of a knot, in its widths.
pub const MAX_MOVED: f64 = 1.5;

/// Share of its own square that a column must keep in addition to others.
const INDEPENDENT: f64 = 1e-6;

/// Panels of the quadrature, each half as wide as the one before it, towards either end.
const PANELS: i32 = 50;

/// Values at every net, run and base point.
pub type Rows<'a> = &'a [Vec<Vec<f64>>];

/// The polynomials of a factor, and steps and hinges at its knots: orthonormalised under the distribution in the order
/// x, those of the knots, x^2, ..., by quadrature.
#[derive(Debug, Clone, PartialEq)]
pub struct Knotted {
    base: Family,
    knots: Vec<Knot>,
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
            column.iter_mut().zip(&weights).for_each(|(value, weight)| *value *= weight.sqrt());
        }
        let mut gram = Square::zeros(columns.len());
        gram.add_products(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>());
        Self { rows: inverse(&lower_factor(&gram)), ..all }
    }

    /// Returns the polynomials without steps and hinges.
    pub fn base(&self) -> &Family {
        &self.base
    }

    /// Returns the steps and kinks.
    pub fn knots(&self) -> &[Knot] {
        &self.knots
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
        let of_knot = |(edge, knot): (&f64, &Knot)| {
            let column = |of: fn(f64) -> f64| x.iter().map(|x| if x < edge { 0.0 } else { of(x - edge) }).collect();
            let [step, hinge]: [Vec<f64>; 2] = [column(|_| 1.0), column(|beyond| beyond)];
            if knot.is_step { [step, hinge] } else { [hinge, step] }
        };
        let knots: Vec<Vec<f64>> = self.edges.iter().zip(&self.knots).flat_map(of_knot).collect();
        [vec![1.0; x.len()], x].into_iter().chain(knots).chain(higher).collect()
    }

    /// Returns the functions 1, 2, ..., given at least as many polynomials.
    pub fn columns(&self, polynomials: Vec<Vec<f64>>, degree: usize) -> Vec<Vec<f64>> {
        let raw = self.raw(polynomials, self.degree());
        let of_row = |row: &Vec<f64>| {
            let mut column = vec![0.0; raw[0].len()];
            for (weight, raw) in row.iter().zip(&raw) {
                column.iter_mut().zip(raw).for_each(|(sum, value)| *sum += weight * value);
            }
            column
        };
        self.rows[1..].iter().take(degree).map(of_row).collect()
    }

    /// Returns the knots where a part of an expansion with `coefficients` (index, coefficient) has a kink and no step,
    /// by one Newton step: near it, s + h (x - edge) is h (x - (edge - s/h)). Its length is the new width. Steps stay.
    fn kinks(&self, coefficients: &[(usize, f64)]) -> Vec<Knot> {
        let of_knot = |(place, knot): (usize, &Knot)| {
            let part =
                |raw: usize| coefficients.iter().map(|(k, b)| b * self.rows[*k].get(raw).unwrap_or(&0.0)).sum::<f64>();
            let (slope, step) = (part(2 + 2 * place), part(3 + 2 * place));
            let near = 0.01 * knot.width;
            let x = &polynomials(&self.base, &[knot.u - near, knot.u + near], 1)[0];
            let most = MAX_MOVED * knot.width;
            let by = (-step / slope * 2.0 * near / (x[1] - x[0])).clamp(-most, most);
            if knot.is_step || !by.is_finite() { *knot } else { Knot { u: knot.u + by, width: by.abs(), ..*knot } }
        };
        self.knots.iter().enumerate().map(of_knot).collect()
    }

    /// Places the knots of `factor` by the output of `nets`, given the values of expansions with all knots `moved` to
    /// the left and to the right as far as allowed, and the `coefficients` of its own functions. For a step, the places
    /// kept are those with the least sum of squared residuals of all rows nearby: between two sampled values, whose
    /// distance is the new width.
    pub fn placed(
        &self,
        nets: &[Net],
        moved: [Rows<'_>; 2],
        factor: usize,
        coefficients: &[(usize, f64)],
    ) -> Vec<Knot> {
        let place = |knot: Knot| {
            let reach = MAX_MOVED * knot.width;
            if !knot.is_step {
                return knot;
            }
            // How much larger the residuals are with the values before the step than with those after it.
            let mut rows: Vec<(f64, f64)> = Vec::new();
            for (k, net) in nets.iter().enumerate() {
                for (run, output) in net.outputs.iter().enumerate() {
                    let near = |(_, u): &(usize, &f64)| (*u - knot.u).abs() < reach;
                    for (p, u) in net.quantiles(run, factor).iter().enumerate().filter(near) {
                        let [after, before] = moved.map(|values| (output[p] - values[k][run][p]).powi(2));
                        rows.push((*u, before - after));
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
        };
        self.kinks(coefficients).into_iter().map(place).collect()
    }
}

/// Finds the knots of `factor` in the residuals `rest` of expansions; none for seeds and factors with few levels.
pub fn knots(nets: &[Net], rest: Rows<'_>, factor: usize, family: &Family, degree: usize) -> Vec<Knot> {
    let points: usize = nets.iter().map(Net::points).sum();
    let bins = (points / POINTS_OF_BIN).next_power_of_two().clamp(BINS.0, BINS.1);
    let centres: Vec<f64> = (0..bins).map(|bin| (bin as f64 + 0.5) / bins as f64).collect();
    let degree = degree.min(bins / BINS_OF_POLYNOMIAL);
    let mut columns = polynomials(family, &centres, degree);
    let Some(x) = columns.first().cloned().filter(|x| x.is_sorted_by(|a, b| a < b)) else { return Vec::new() };
    if *family == Family::Hermite {
        // The tails of its polynomials are steep: both families work.
        columns.truncate(super::SAFE_HERMITE_DEGREES);
        columns.append(&mut polynomials(&Family::Legendre, &centres, degree));
    }
    let (mut sums, mut weights) = (vec![0.0; bins], vec![0.0; bins]);
    for (net, rest) in nets.iter().zip(rest) {
        for (run, rest) in rest.iter().enumerate() {
            for (u, e) in net.quantiles(run, factor).iter().zip(rest) {
                let bin = ((u * bins as f64) as usize).min(bins - 1);
                sums[bin] += e;
                weights[bin] += 1.0;
            }
        }
    }
    let means: Vec<f64> = sums.iter().zip(&weights).map(|(sum, weight)| sum / f64::max(*weight, 1.0)).collect();
    let mut known = Known { basis: Vec::new(), rest: means, weights };
    known.extend(vec![1.0; bins]);
    columns.into_iter().for_each(|column| known.extend(column));
    let mut found: Vec<Knot> = Vec::new();
    while found.len() < MAX_KNOTS {
        let is_free = |u: f64| found.iter().all(|knot| (knot.u - u).abs() >= APART);
        let Some((gain, t, is_step)) = known.best(&x, is_free) else { break };
        let freedom = bins as f64 - known.basis.len() as f64 - 2.0;
        let left = known.product(&known.rest, &known.rest) - gain;
        if freedom < 3.0 || gain / 2.0 < SIGNIFICANT * left / freedom {
            break;
        }
        found.push(Knot { u: t as f64 / bins as f64, width: 1.0 / bins as f64, is_step });
        let edge = (x[t] + x[t - 1]) / 2.0;
        let column = |of: &dyn Fn(usize) -> f64| (0..bins).map(of).collect::<Vec<f64>>();
        known.extend(column(&|bin| f64::from(u8::from(bin >= t))));
        known.extend(column(&|bin| (x[bin] - edge).max(0.0)));
        // It may lie anywhere in the bins next to it.
        known.extend(column(&|bin| f64::from(u8::from(bin == t - 1))));
        known.extend(column(&|bin| f64::from(u8::from(bin == t))));
    }
    found
}

/// Orthonormal columns of bins with weights, and the residuals of some means.
struct Known {
    basis: Vec<Vec<f64>>,
    rest: Vec<f64>,
    weights: Vec<f64>,
}

impl Known {
    fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        self.weights.iter().zip(a.iter().zip(b)).map(|(weight, (a, b))| weight * a * b).sum()
    }

    /// Appends the part of `column` that is orthogonal to the others, unless it vanishes.
    fn extend(&mut self, mut column: Vec<f64>) {
        let own = self.product(&column, &column);
        // Twice, because the first pass leaves rounding.
        for known in self.basis.iter().chain(&self.basis) {
            let part = self.product(known, &column);
            column.iter_mut().zip(known).for_each(|(value, known)| *value -= part * known);
        }
        let length = self.product(&column, &column);
        if length > INDEPENDENT * own {
            column.iter_mut().for_each(|value| *value /= length.sqrt());
            let part = self.product(&column, &self.rest);
            self.rest.iter_mut().zip(&column).for_each(|(value, known)| *value -= part * known);
            self.basis.push(column);
        }
    }

    /// Returns the largest reduction of the residuals by a step and a hinge in `x`, the first bin after them, and
    /// whether the step alone reduces more. Running sums from the last bin make all places as cheap as one.
    fn best(&self, x: &[f64], is_free: impl Fn(f64) -> bool) -> Option<(f64, usize, bool)> {
        let bins = x.len();
        let (mut own, mut of_rest, mut of_basis) = ([0.0; 3], [0.0; 2], vec![[0.0; 2]; self.basis.len()]);
        let mut best: Option<(f64, usize, bool)> = None;
        for t in (2..bins).rev() {
            let (weight, at) = (self.weights[t], x[t]);
            own = [own[0] + weight, own[1] + weight * at, own[2] + weight * at * at];
            let more = |sums: [f64; 2], value: f64| [sums[0] + weight * value, sums[1] + weight * at * value];
            of_rest = more(of_rest, self.rest[t]);
            of_basis.iter_mut().zip(&self.basis).for_each(|(sums, column)| *sums = more(*sums, column[t]));
            if t > bins - 2 || !is_free(t as f64 / bins as f64) {
                continue;
            }
            // Products of the step and the hinge with one another, minus their part in the basis.
            let edge = (at + x[t - 1]) / 2.0;
            let squares = [own[0], own[2] - 2.0 * edge * own[1] + edge * edge * own[0]];
            let mut left = [squares[0], squares[1], own[1] - edge * own[0]];
            for [step, with_x] in &of_basis {
                let hinge = with_x - edge * step;
                left = [left[0] - step * step, left[1] - hinge * hinge, left[2] - step * hinge];
            }
            let [step, hinge, both] = left;
            let (of_step, of_hinge) = (of_rest[0], of_rest[1] - edge * of_rest[0]);
            let determinant = step * hinge - both * both;
            if step > INDEPENDENT * squares[0]
                && hinge > INDEPENDENT * squares[1]
                && determinant > INDEPENDENT * step * hinge
            {
                let gain = of_step * of_step * hinge - 2.0 * of_step * of_hinge * both + of_hinge * of_hinge * step;
                let gain = gain / determinant;
                let is_step = of_step * of_step / step > of_hinge * of_hinge / hinge;
                best = if best.is_none_or(|best| gain > best.0) { Some((gain, t, is_step)) } else { best };
            }
        }
        best
    }
}

#[cfg(test)]
mod tests;
