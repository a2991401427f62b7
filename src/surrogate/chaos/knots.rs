//! Steps and kinks of single factors.

use super::linear::{Cholesky, LANES, Panels};
use super::prior::{FITTED_DEGREE, Prior};
use super::squares::Orthonormal;
use crate::surrogate::stepped::Knot;

/// Degree of the polynomials with which knots are searched: those of high degree hide them.
const DEGREE: usize = 3;

/// Maximum number of knots.
const MAX_KNOTS: usize = 8;

/// Gain in the logarithm of the evidence beyond that of the choice among so many places.
const MIN_GAIN: f64 = 2.0;

/// Rows on either side of a knot of which none is considered, and rows between two.
const APART: usize = 2;
const ROWS_BETWEEN: usize = 4;

/// Maximum number of values of all knots that are tried.
const MAX_VALUES: usize = 10_000_000;

/// Steps of the optimiser: before the first, after each, and after the last.
const FIRST_ITERATIONS: usize = 20;
const ITERATIONS: usize = 6;
const LAST_ITERATIONS: usize = 12;

/// Leading terms by which places are improved, and places tried.
const TERMS: usize = 100;
const PLACES: usize = 50;

/// Rows on either side of a knot between which it is moved.
const NEIGHBOURS: usize = 8;

/// A knot that is tried.
#[derive(Clone, Copy)]
struct Place {
    factor: usize,
    knot: Knot,
}

/// Returns the prior with knots, if there are any.
pub fn with_knots(prior: &Prior) -> Option<Prior> {
    let rows = prior.fitted_rows();
    let mut prior = prior.clone().with_degree(DEGREE);
    prior.improve(rows, FIRST_ITERATIONS);
    add_knots(&mut prior, rows);
    if prior.knots.is_empty() {
        return None;
    }
    let mut prior = prior.with_degree(FITTED_DEGREE);
    prior.improve(prior.rows.min(2 * rows), LAST_ITERATIONS);
    Some(prior)
}

/// Adds knots by the evidence of some rows, moves them to where all rows show them, and then those that appear
/// in twice as many rows: the first ones hide them.
fn add_knots(prior: &mut Prior, rows: usize) {
    add_by_evidence(prior, rows);
    let (found, more) = (prior.knots.len(), prior.rows.min(2 * rows));
    if found > 0 && more > rows {
        place_by_all_rows(prior, rows);
        prior.improve(more, LAST_ITERATIONS);
        add_by_evidence(prior, more);
        if prior.knots.len() > found && prior.rows > more {
            place_by_all_rows(prior, more);
        }
    }
}

/// Adds one at a time the knot whose own best variance raises the evidence of the first rows most.
fn add_by_evidence(prior: &mut Prior, rows: usize) {
    let places = places(prior, rows);
    if places.is_empty() {
        return;
    }
    let values: Vec<Vec<f64>> = places
        .iter()
        .map(|place| {
            let factor = &prior.basis.factors[place.factor];
            factor.at_knot(place.knot, &factor.places[..rows])
        })
        .collect();
    let columns = Panels::from_columns(rows, values.iter().map(Vec::as_slice));
    while prior.knots.len() < MAX_KNOTS {
        let Some(factor) = Cholesky::new(prior.fitted_covariance(rows)) else { break };
        let products = columns.weighted_sums(&factor.solve(&prior.y()[..rows]));
        let squares = factor.whitened_squares(&columns);
        let mut best = (1.0, 0);
        for (j, place) in places.iter().enumerate() {
            let ratio = products[j] * products[j] / squares[j];
            if ratio > best.0 && !is_near(prior, place, rows) {
                best = (ratio, j);
            }
        }
        let (ratio, j) = best;
        if 0.5 * (ratio - 1.0 - libm::log(ratio)) < MIN_GAIN + libm::log(places.len() as f64) {
            break;
        }
        let Place { factor, knot } = places[j];
        let share = libm::log((ratio - 1.0) / squares[j]) - prior.scale_of(factor);
        prior.add_knot(factor, knot, share.clamp(-10.0, 3.0));
        prior.improve(rows, ITERATIONS);
    }
}

/// Returns the middles between neighbouring values of the first `rows` rows.
fn places(prior: &Prior, rows: usize) -> Vec<Place> {
    let mut all = Vec::new();
    for (factor, of) in prior.basis.factors.iter().enumerate().filter(|(_, of)| of.may_have_knots()) {
        let middles = middles(&of.places[..rows]);
        let inner = middles.len().saturating_sub(2 * APART);
        let inner = middles.into_iter().skip(APART).take(inner);
        all.extend(inner.flat_map(|u| [false, true].map(|is_kink| Place { factor, knot: Knot { u, is_kink } })));
    }
    let every = (all.len() * rows).div_ceil(MAX_VALUES).max(1);
    all.into_iter().step_by(every).collect()
}

fn middles(u: &[f64]) -> Vec<f64> {
    let mut sorted = u.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    sorted.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0).collect()
}

/// Returns whether there are so few rows between a place and a knot of the same factor that both fit those rows only.
fn is_near(prior: &Prior, place: &Place, rows: usize) -> bool {
    let factor = &prior.basis.factors[place.factor];
    factor.knots().iter().any(|knot| {
        let (low, high) = (knot.u.min(place.knot.u), knot.u.max(place.knot.u));
        factor.places[..rows].iter().filter(|u| **u > low && **u < high).count() < ROWS_BETWEEN
    })
}

/// Moves every knot to where all rows leave least to the leading terms.
fn place_by_all_rows(prior: &mut Prior, rows: usize) {
    let all = prior.rows;
    let leading = prior.leading_terms((all / 4).min(TERMS));
    for (factor, number) in prior.knots.clone() {
        let of = &prior.basis.factors[factor];
        let (at, index) = (of.knots()[number].u, of.degree() + number + 1);
        let mut few = of.places[..rows].to_vec();
        few.sort_by(f64::total_cmp);
        let place = few.partition_point(|u| *u < at);
        let (low, high) = (few[place.saturating_sub(NEIGHBOURS)], few[(place + NEIGHBOURS - 1).min(rows - 1)]);
        let between: Vec<f64> = of.places[..all].iter().copied().filter(|u| *u >= low && *u <= high).collect();
        let ones = vec![1.0; all];
        let (mut fixed, mut moving) = (vec![ones], Vec::new());
        for (_, term) in &leading {
            if term.contains(&(factor, index)) {
                moving.push(term);
            } else {
                fixed.push(prior.basis.values(term, 0..all));
            }
        }
        let mut basis = Orthonormal::new(&Panels::from_columns(all, fixed.iter().map(Vec::as_slice)));
        let panels = fixed.len().div_ceil(LANES);
        let mut best = (f64::NEG_INFINITY, at);
        let middles = middles(&between);
        let every = middles.len().div_ceil(PLACES).max(1);
        let mut tried: Vec<f64> = middles.iter().copied().step_by(every).chain([at]).collect();
        let mut is_coarse = every > 1;
        while let Some(at) = tried.pop() {
            prior.basis.factors[factor].move_knot(number, at);
            let columns: Vec<Vec<f64>> = moving.iter().map(|term| prior.basis.values(term, 0..all)).collect();
            basis.truncate(panels);
            basis.extend(&Panels::from_columns(all, columns.iter().map(Vec::as_slice)));
            let explained = basis.scores(&prior.y()[..all])[panels * LANES..].iter().map(|s| s * s).sum::<f64>();
            if explained > best.0 {
                best = (explained, at);
            }
            if tried.is_empty() && is_coarse {
                is_coarse = false;
                let centre = middles.partition_point(|u| *u < best.1);
                tried = middles[centre.saturating_sub(every)..(centre + every).min(middles.len())].to_vec();
            }
        }
        prior.basis.factors[factor].move_knot(number, best.1);
    }
}
