//! Sparse polynomial chaos expansions: few terms, chosen by greedy least squares, their number by leaving out a net.

use super::basis::{Caps, Term, first_terms, neighbours};
use super::gram::{Path, Square, solve};
use super::net::Net;
use crate::sum::product;

/// Most terms of a surrogate.
const MOST_TERMS: usize = 150;

/// Rows by which terms are chosen.
const SELECTION_ROWS: usize = 3000;

/// Fewest of them of one net.
const SELECTION_ROWS_OF_NET: usize = 64;

/// Most terms for each row that they are chosen by.
const TERMS_PER_ROW: f64 = 0.6;

/// An expansion in orthonormal terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The terms.
    pub terms: Vec<Term>,
    /// Their coefficients.
    pub coefficients: Vec<f64>,
}

/// Sums over the rows of a net by which terms are chosen.
pub struct NetSums {
    gram: Square,
    right: Vec<f64>,
    square: f64,
    rows: usize,
}

impl NetSums {
    /// For the candidates `terms`, of at most `most` rows.
    pub fn new(net: &Net, terms: &[Term], most: usize) -> Self {
        let rows = net.spaced_rows(most);
        let outputs: Vec<f64> = rows.iter().map(|&(run, point)| net.outputs[run][point]).collect();
        let columns: Vec<Vec<f64>> = terms.iter().map(|term| net.at(term, &rows)).collect();
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let mut gram = Square::zeros(terms.len());
        gram.add_products(&columns);
        let right = columns.iter().map(|column| product(column, &outputs)).collect();
        Self { gram, right, square: product(&outputs, &outputs), rows: rows.len() }
    }
}

/// Rows of each of `nets` nets by which terms are chosen.
pub fn selection_rows(nets: usize) -> usize {
    SELECTION_ROWS_OF_NET.max(SELECTION_ROWS / nets.max(1))
}

/// The candidates of the first round, if that many rows choose among them.
pub fn first_candidates(caps: Caps<'_>, rows: usize) -> Vec<Term> {
    first_terms(caps, caps.terms.min(20.max(2 * rows)))
}

/// The expansion fitted to the nets `training`; `first` holds the candidates of the first round and their sums over each of
/// these nets.
pub fn fit(training: &[&Net], first: (&[Term], &[&NetSums]), caps: Caps<'_>) -> Expansion {
    let rounds = if caps.families.len() <= 10 { 3 } else { 2 };
    let rows = selection_rows(training.len());
    let mut best = chosen(first.0, first.1);
    let mut candidates = first.0.to_vec();
    for _ in 1..rounds {
        let next = neighbours(&best.1.terms, &best.1.coefficients, caps);
        if next.iter().all(|term| candidates.contains(term)) {
            break;
        }
        let sums: Vec<NetSums> = training.iter().map(|net| NetSums::new(net, &next, rows)).collect();
        let found = chosen(&next, &sums.iter().collect::<Vec<_>>());
        candidates = next;
        if found.0 < best.0 {
            best = found;
        }
    }
    refitted(training, best.1.terms)
}

/// The best terms among `candidates` with their coefficients, and the sum of squares that they leave of each net when it is
/// left out.
fn chosen(candidates: &[Term], nets: &[&NetSums]) -> (f64, Expansion) {
    let rows: usize = nets.iter().map(|net| net.rows).sum();
    let folds = nets.len() as f64;
    let most = (TERMS_PER_ROW * rows as f64 * (folds - 1.0) / folds) as usize;
    let most = MOST_TERMS.min(candidates.len()).min(most.max(2));
    let mut errors = vec![0.0; most];
    for (left_out, net) in nets.iter().enumerate() {
        let others: Vec<&NetSums> =
            nets.iter().enumerate().filter(|(place, _)| *place != left_out).map(|(_, net)| *net).collect();
        let (gram, right) = joined(&others);
        let path = Path::new(&gram, &right, most);
        let held_out = path.held_out(&net.gram, &net.right, net.square);
        let last = held_out.last().copied().unwrap_or(net.square);
        let of_size = held_out.iter().copied().chain(std::iter::repeat(last));
        errors.iter_mut().zip(of_size).for_each(|(sum, error)| *sum += error.max(0.0));
    }
    let place = (1..most).fold(0, |best, k| if errors[k] < errors[best] { k } else { best });
    let (gram, right) = joined(nets);
    let path = Path::new(&gram, &right, place + 1);
    let terms = path.chosen.iter().map(|&column| candidates[column].clone()).collect();
    (errors[place], Expansion { terms, coefficients: path.coefficients(path.chosen.len()) })
}

fn joined(nets: &[&NetSums]) -> (Square, Vec<f64>) {
    let size = nets.first().map_or(0, |net| net.right.len());
    let (mut gram, mut right) = (Square::zeros(size), vec![0.0; size]);
    for net in nets {
        gram.add(&net.gram);
        right.iter_mut().zip(&net.right).for_each(|(sum, more)| *sum += more);
    }
    (gram, right)
}

/// The least-squares expansion in `terms` over all rows of the nets.
fn refitted(nets: &[&Net], terms: Vec<Term>) -> Expansion {
    let mut gram = Square::zeros(terms.len());
    let mut right = vec![0.0; terms.len()];
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); terms.len()];
    for net in nets {
        for (run, outputs) in net.outputs.iter().enumerate() {
            columns.iter_mut().zip(&terms).for_each(|(column, term)| net.fill(term, run, column));
            gram.add_products(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>());
            right.iter_mut().zip(&columns).for_each(|(sum, column)| *sum += product(column, outputs));
        }
    }
    let coefficients = solve(&gram, &right);
    Expansion { terms, coefficients }
}
