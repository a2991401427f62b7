//! Sparse polynomial chaos expansions: terms chosen by greedy least squares, their number by leaving out a net.

use super::basis::{Term, neighbours};
use super::gram::{Path, Square, add_scaled, lower_factor, solve};
use super::identifiable::IdentifiableTerms;
use super::net::Net;
use apportion_base::sum::product;

/// Maximum number of terms of a surrogate.
const MAX_TERMS: usize = 150;

/// Number of rows by which terms are chosen.
const SELECTION_ROWS: usize = 3000;

/// Minimum number of these rows from one net.
const SELECTION_ROWS_OF_NET: usize = 64;

/// Maximum number of terms for each row by which they are chosen.
const TERMS_PER_ROW: f64 = 0.6;

/// Maximum number of rounds in which terms are chosen, with few factors.
const MAX_ROUNDS: usize = 3;

/// An expansion in orthonormal terms.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Expansion {
    /// The terms.
    pub terms: Vec<Term>,
    /// Their coefficients.
    pub coefficients: Vec<f64>,
}

impl Expansion {
    /// Iterates over the terms and their coefficients.
    pub fn iter(&self) -> impl Iterator<Item = (&Term, f64)> {
        self.terms.iter().zip(self.coefficients.iter().copied())
    }

    /// Iterates over the terms that are not constant, and their coefficients.
    pub fn varying(&self) -> impl Iterator<Item = (&Term, f64)> {
        self.iter().filter(|(term, _)| !term.is_empty())
    }
}

/// The runs of a net to which surrogates are fitted: those of one output, or of many at the same rows.
pub struct Training<'a> {
    net: &'a Net,
    /// For each output, the outputs of every run.
    outputs: Vec<&'a [Vec<f64>]>,
}

impl<'a> Training<'a> {
    /// Uses the output of `net`.
    pub fn new(net: &'a Net) -> Self {
        Self::of_outputs(net, vec![&net.outputs])
    }

    /// Uses other `outputs` at the rows of `net`: for each of them those of every run.
    pub fn of_outputs(net: &'a Net, outputs: Vec<&'a [Vec<f64>]>) -> Self {
        Self { net, outputs }
    }
}

/// Sums over the rows of a net by which terms are chosen.
pub struct NetSums {
    gram: Square,
    /// For each output its products with the terms, and its sum of squares.
    right: Vec<Vec<f64>>,
    squares: Vec<f64>,
    rows: usize,
}

impl NetSums {
    /// Computes the sums for the candidates `terms` over at most `max_rows` rows.
    pub fn new(of: &Training<'_>, terms: &[Term], max_rows: usize) -> Self {
        let rows = of.net.spaced_rows(max_rows);
        let columns: Vec<Vec<f64>> = terms.iter().map(|term| of.net.at(term, &rows)).collect();
        let mut gram = Square::zeros(terms.len());
        gram.add_products(&columns);
        let (mut right, mut squares) = (Vec::new(), Vec::new());
        for outputs in &of.outputs {
            let outputs: Vec<f64> = rows.iter().map(|&(run, point)| outputs[run][point]).collect();
            right.push(columns.iter().map(|column| product(column, &outputs)).collect());
            squares.push(product(&outputs, &outputs));
        }
        Self { gram, right, squares, rows: rows.len() }
    }
}

/// Returns the number of rows of each of `nets` nets by which terms are chosen.
pub fn selection_rows(nets: usize) -> usize {
    SELECTION_ROWS_OF_NET.max(SELECTION_ROWS / nets.max(1))
}

/// Fits an expansion for each output to the nets `training`, at first in the terms `candidates` with their sums over
/// each of these nets. Terms are chosen for all outputs together, and their number for each output, in some
/// rounds, each with the neighbours of the terms chosen by the best previous one.
pub fn fit(
    training: &[&Training<'_>],
    candidates: &[Term],
    sums: &[&NetSums],
    identifiable: &IdentifiableTerms<'_>,
) -> Vec<Expansion> {
    let caps = identifiable.caps;
    let max_rounds = if caps.families.len() <= 10 { MAX_ROUNDS } else { 2 };
    let rows = selection_rows(training.len());
    let mut rounds = vec![Selection::new(candidates, sums)];
    let mut candidates = candidates.to_vec();
    let mut best = 0;
    for round in 1..max_rounds {
        let next = identifiable.retain(neighbours(&rounds[best].terms, &rounds[best].weights, caps));
        if next.iter().all(|term| candidates.contains(term)) {
            break;
        }
        let sums: Vec<NetSums> = training.iter().map(|net| NetSums::new(net, &next, rows)).collect();
        rounds.push(Selection::new(&next, &sums.iter().collect::<Vec<_>>()));
        candidates = next;
        if rounds[round].error() < rounds[best].error() {
            best = round;
        }
    }
    let mut members = vec![Vec::new(); rounds.len()];
    for output in 0..rounds[0].sizes.len() {
        members[first_smallest(rounds.iter().map(|round| round.errors[output]))].push(output);
    }
    let mut expansions = vec![Expansion::default(); rounds[0].sizes.len()];
    for (round, members) in rounds.iter().zip(members) {
        for (output, expansion) in members.iter().zip(round.refitted(training, &members)) {
            expansions[*output] = expansion;
        }
    }
    expansions
}

/// Returns the index of the smallest number, the first one of equals.
fn first_smallest(numbers: impl Iterator<Item = f64>) -> usize {
    numbers.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(place, _)| place)
}

/// Returns the members of `list` except number `left_out`.
pub(crate) fn without<T>(list: &[T], left_out: usize) -> Vec<&T> {
    list.iter().enumerate().filter(|(place, _)| *place != left_out).map(|(_, item)| item).collect()
}

/// Terms chosen among some candidates, in falling order of the gain over all outputs.
struct Selection {
    terms: Vec<Term>,
    /// Root mean squares of their coefficients over the outputs.
    weights: Vec<f64>,
    /// The number of them that each output uses.
    sizes: Vec<usize>,
    /// The sum of squared residuals of each net when it is left out.
    errors: Vec<f64>,
}

impl Selection {
    /// Chooses the best terms among `candidates`.
    fn new(candidates: &[Term], nets: &[&NetSums]) -> Self {
        let errors = held_out_errors(candidates, nets);
        let best: Vec<usize> = errors.iter().map(|errors| first_smallest(errors.iter().copied())).collect();
        let (gram, right) = joined(nets);
        let path = Path::new(&gram, right, best.iter().max().map_or(0, |best| best + 1));
        let sizes: Vec<usize> = best.iter().map(|best| (best + 1).min(path.chosen.len())).collect();
        let mut squares = vec![0.0; path.chosen.len()];
        for (output, size) in sizes.iter().enumerate() {
            for (sum, b) in squares.iter_mut().zip(path.coefficients(output, *size)) {
                *sum += b * b;
            }
        }
        Self {
            terms: path.chosen.iter().map(|&column| candidates[column].clone()).collect(),
            weights: squares.iter().map(|square| (square / errors.len() as f64).sqrt()).collect(),
            sizes,
            errors: errors.iter().zip(best).map(|(errors, best)| errors[best]).collect(),
        }
    }

    /// Returns the sum of squared residuals of all outputs.
    fn error(&self) -> f64 {
        self.errors.iter().sum()
    }

    /// Returns the least-squares expansions of the outputs `members` over all rows of the nets.
    fn refitted(&self, nets: &[&Training<'_>], members: &[usize]) -> Vec<Expansion> {
        let sizes: Vec<usize> = members.iter().map(|&output| self.sizes[output]).collect();
        let terms = &self.terms[..sizes.iter().copied().max().unwrap_or(0)];
        let mut gram = Square::zeros(terms.len());
        let mut right = vec![vec![0.0; terms.len()]; members.len()];
        let mut columns: Vec<Vec<f64>> = vec![Vec::new(); terms.len()];
        for Training { net, outputs } in nets {
            for run in 0..net.runs() {
                for (column, term) in columns.iter_mut().zip(terms) {
                    net.fill(term, run, column);
                }
                gram.add_products(&columns);
                for ((right, size), output) in right.iter_mut().zip(&sizes).zip(members) {
                    let outputs = &outputs[*output][run];
                    for (sum, column) in right.iter_mut().zip(&columns).take(*size) {
                        *sum += product(column, outputs);
                    }
                }
            }
        }
        let lower = lower_factor(&gram);
        let expansions = right.iter().zip(sizes).map(|(right, size)| Expansion {
            terms: terms[..size].to_vec(),
            coefficients: solve(&lower[..size], right),
        });
        expansions.collect()
    }
}

/// Returns for each output the sums of squared residuals of all nets, each left out, by 1, 2, ... terms.
fn held_out_errors(candidates: &[Term], nets: &[&NetSums]) -> Vec<Vec<f64>> {
    let rows: usize = nets.iter().map(|net| net.rows).sum();
    let folds = nets.len() as f64;
    let max_terms = (TERMS_PER_ROW * rows as f64 * (folds - 1.0) / folds) as usize;
    let max_terms = MAX_TERMS.min(candidates.len()).min(max_terms.max(2));
    let mut errors = vec![vec![0.0; max_terms]; nets.first().map_or(0, |net| net.right.len())];
    for (left_out, net) in nets.iter().enumerate() {
        let others: Vec<&NetSums> = without(nets, left_out).into_iter().copied().collect();
        let (gram, right) = joined(&others);
        let held_out = Path::new(&gram, right, max_terms).held_out(&net.gram, &net.right, &net.squares);
        for ((errors, held_out), square) in errors.iter_mut().zip(held_out).zip(&net.squares) {
            let last = held_out.last().copied().unwrap_or(*square);
            for (sum, error) in errors.iter_mut().zip(held_out.into_iter().chain(std::iter::repeat(last))) {
                *sum += error.max(0.0);
            }
        }
    }
    errors
}

fn joined(nets: &[&NetSums]) -> (Square, Vec<Vec<f64>>) {
    let (size, outputs) = nets.first().map_or((0, 0), |net| (net.gram.size, net.right.len()));
    let (mut gram, mut right) = (Square::zeros(size), vec![vec![0.0; size]; outputs]);
    for net in nets {
        gram.add(&net.gram);
        for (right, more) in right.iter_mut().zip(&net.right) {
            add_scaled(right, 1.0, more);
        }
    }
    (gram, right)
}

/// Returns the values of `expansion` at every run and point of `net`, and the residuals of the outputs.
pub(crate) fn values_and_rest(net: &Net, expansion: &Expansion) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let mut values = Vec::new();
    let mut surrogate = vec![vec![0.0; net.points()]; net.runs()];
    for (run, sums) in surrogate.iter_mut().enumerate() {
        for (term, b) in expansion.terms.iter().zip(&expansion.coefficients) {
            net.fill(term, run, &mut values);
            add_scaled(sums, *b, &values);
        }
    }
    let pairs = net.outputs.iter().zip(&surrogate);
    let e = pairs.map(|(f, g)| f.iter().zip(g).map(|(f, g)| f - g).collect()).collect();
    (surrogate, e)
}
