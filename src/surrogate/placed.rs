//! Where steps lie, by the rows of all nets: those that a fit takes are too few to say, above all of a step that acts in
//! a part of the rows.

use rayon::prelude::*;

use super::cross_fit::CrossFitted;
use super::expansion::Expansion;
use super::family::{Family, polynomials};
use super::net::Net;
use super::stepped::Knot;
use apportion_base::sum::add_scaled;

/// Widths of a step, to either side, within which it is placed.
const RANGE: f64 = 32.0;

/// Distance in the quantile to either side of a step.
const SIDE: f64 = 1e-9;

/// Share of the largest square of the step at which a row shows it.
const SHOWN: f64 = 0.01;

/// Gain in squares by another place, in those of the noise, that is clear.
const CLEAR: f64 = 20.0;

/// The same up to which another place is likely, with a probability of 5 %.
const LIKELY: f64 = 3.84;

/// A row near a step.
struct Row {
    u: f64,
    /// What the expansion leaves of the output.
    left: f64,
    /// By how much the expansion rises there.
    step: f64,
}

/// Returns the families of `fitted` with the only step of a factor where the rows of all `nets` leave least. Several knots
/// of a factor describe one course together, in coefficients that belong to their places.
pub(crate) fn placed(nets: &[Net], fitted: &CrossFitted) -> Vec<Family> {
    let families = fitted.families.iter().enumerate().map(|(factor, family)| {
        let Family::Stepped(stepped) = family else { return family.clone() };
        let ([knot @ Knot { is_kink: false, u }], [width]) = (&stepped.knots[..], &stepped.widths[..]) else {
            return family.clone();
        };
        let (u, width) = place(&rows_near(nets, fitted, factor, *u, RANGE * width), *u, *width);
        Family::Stepped(Box::new(stepped.with_knot(Knot { u, ..*knot }, width)))
    });
    families.collect()
}

/// Returns the rows of all nets near a step of a factor at `at`.
fn rows_near(nets: &[Net], fitted: &CrossFitted, factor: usize, at: f64, range: f64) -> Vec<Row> {
    let of_nets = nets.par_iter().zip(&fitted.of_nets).map(|(net, expansion)| {
        let (mut rows, mut columns) = (Vec::new(), vec![Vec::new(); fitted.families.len()]);
        for run in 0..net.runs() {
            let of_run: Vec<&[f64]> = (0..columns.len()).map(|factor| net.quantiles(run, factor)).collect();
            for point in (0..net.points()).filter(|point| (of_run[factor][*point] - at).abs() < range) {
                rows.push((of_run[factor][point], net.outputs[run][point]));
                columns.iter_mut().zip(&of_run).for_each(|(column, of)| column.push(of[point]));
            }
        }
        let g = values(expansion, &fitted.families, &columns);
        let [below, above] = [-SIDE, SIDE].map(|side| {
            columns[factor].iter_mut().for_each(|u| *u = at + side);
            values(expansion, &fitted.families, &columns)
        });
        let rows = rows.into_iter().zip(g).zip(below.into_iter().zip(above));
        rows.map(|(((u, y), g), (below, above))| Row { u, left: y - g, step: above - below }).collect()
    });
    let mut rows: Vec<Row> = of_nets.collect::<Vec<Vec<Row>>>().into_iter().flatten().collect();
    rows.sort_by(|a, b| a.u.total_cmp(&b.u));
    rows
}

/// Returns the values of an expansion at rows with these quantiles of every factor.
fn values(expansion: &Expansion, families: &[Family], columns: &[Vec<f64>]) -> Vec<f64> {
    let degree = super::expansion::degree([expansion]);
    let columns = families.iter().zip(columns);
    let functions: Vec<Vec<Vec<f64>>> = columns.clone().map(|(family, u)| polynomials(family, u, degree)).collect();
    let mut sums = vec![0.0; columns.map(|(_, u)| u.len()).next().unwrap_or(0)];
    for (term, c) in expansion.iter() {
        let mut product = vec![1.0; sums.len()];
        for (factor, degree) in term {
            product.iter_mut().zip(&functions[*factor][degree - 1]).for_each(|(value, f)| *value *= f);
        }
        add_scaled(&mut sums, c, &product);
    }
    sums
}

/// Returns the place of a step between the two of `rows`, in rising order, that show it and leave least if it is
/// between them, and the distance of the rows between which it is likely.
fn place(rows: &[Row], at: f64, width: f64) -> (f64, f64) {
    let largest = rows.iter().map(|row| row.step * row.step).fold(0.0, f64::max);
    let shown: Vec<&Row> = rows.iter().filter(|row| row.step * row.step > SHOWN * largest).collect();
    // What the step leaves of a row above it and of one below it.
    let squares = shown.iter().map(|row| {
        let if_above = row.left + if row.u > at { 0.0 } else { -row.step };
        (if_above * if_above, (if_above + row.step).powi(2))
    });
    let squares: Vec<(f64, f64)> = squares.collect();
    let noise = squares.iter().map(|(above, below)| above.min(*below)).sum::<f64>() / squares.len().max(1) as f64;
    // What is left if so many rows are below it.
    let mut sums = vec![0.0];
    squares.iter().for_each(|(above, below)| sums.push(sums[sums.len() - 1] + below - above));
    let between = (1..shown.len()).filter(|count| shown[count - 1].u < shown[*count].u);
    let now = shown.partition_point(|row| row.u <= at);
    let Some(best) = between.clone().min_by(|a, b| sums[*a].total_cmp(&sums[*b])) else { return (at, width) };
    let count = if sums[now] - sums[best] > CLEAR * noise { best } else { now };
    if count == 0 || count == shown.len() {
        return (at, width);
    }
    let mut likely = between.filter(|other| sums[*other] <= sums[count] + LIKELY * noise);
    let first = likely.next().unwrap_or(count);
    let width_left = shown[likely.next_back().unwrap_or(first)].u - shown[first - 1].u;
    let (low, high) = (shown[count - 1].u, shown[count].u);
    // The fit has placed it too, together with the coefficients.
    let (first, last) = (low.max(at - width / 2.0), high.min(at + width / 2.0));
    let (first, last) = if first < last { (first, last) } else { (low, high) };
    (first + (last - first) / 2.0, width_left)
}

#[cfg(test)]
#[path = "tests/placed.rs"]
mod tests;
