//! Sparse polynomial chaos expansions: terms chosen by greedy least squares, their number by leaving out a net.

use super::basis::{Term, first_terms, neighbours};
use super::carried::Carried;
use super::gram::{Path, Square, lower_factor, solve};
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
pub const MAX_ROUNDS: usize = 3;

/// An expansion in orthonormal terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// The terms.
    pub terms: Vec<Term>,
    /// Their coefficients.
    pub coefficients: Vec<f64>,
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
    /// Computes the sums for the candidates `terms` over at most `most` rows.
    pub fn new(of: &Training<'_>, terms: &[Term], most: usize) -> Self {
        let rows = of.net.spaced_rows(most);
        let columns: Vec<Vec<f64>> = terms.iter().map(|term| of.net.at(term, &rows)).collect();
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let mut gram = Square::zeros(terms.len());
        gram.add_products(&columns);
        let of_output = |outputs: &&[Vec<f64>]| -> (Vec<f64>, f64) {
            let outputs: Vec<f64> = rows.iter().map(|&(run, point)| outputs[run][point]).collect();
            let right = columns.iter().map(|column| product(column, &outputs)).collect();
            (right, product(&outputs, &outputs))
        };
        let (right, squares) = of.outputs.iter().map(of_output).unzip();
        Self { gram, right, squares, rows: rows.len() }
    }
}

/// Returns the number of rows of each of `nets` nets by which terms are chosen.
pub fn selection_rows(nets: usize) -> usize {
    SELECTION_ROWS_OF_NET.max(SELECTION_ROWS / nets.max(1))
}

/// Returns the candidates of the first round, if `rows` rows choose among them.
pub fn first_candidates(carried: &Carried<'_>, rows: usize) -> Vec<Term> {
    let caps = carried.caps();
    carried.retain(first_terms(caps, caps.terms.min(20.max(2 * rows))))
}

/// Expansions of one output or of many, which share their terms.
pub struct Expansions {
    /// Lists of terms.
    terms: Vec<Vec<Term>>,
    /// For each output, the index of its list, and the coefficients of the first of its terms.
    of: Vec<(usize, Vec<f64>)>,
}

impl Expansions {
    /// Returns the expansion of output number `output`.
    pub fn of_output(&self, output: usize) -> Expansion {
        let (list, coefficients) = &self.of[output];
        Expansion { terms: self.terms[*list][..coefficients.len()].to_vec(), coefficients: coefficients.clone() }
    }
}

/// Fits expansions to the nets `training`; `first` holds the candidates of the first round and their sums over each of
/// these nets. Terms are chosen for all outputs together, and their number for each output, in at most `max_rounds`
/// rounds, each with the neighbours of the terms chosen by the best previous one.
pub fn fit(
    training: &[&Training<'_>],
    first: (&[Term], &[&NetSums]),
    carried: &Carried<'_>,
    max_rounds: usize,
) -> Expansions {
    let caps = carried.caps();
    let rounds = max_rounds.min(if caps.families.len() <= 10 { MAX_ROUNDS } else { 2 });
    let rows = selection_rows(training.len());
    let mut found = vec![chosen(first.0, first.1)];
    let mut candidates = first.0.to_vec();
    let mut best = 0;
    for round in 1..rounds {
        let next = carried.retain(neighbours(&found[best].terms, &found[best].weights, caps));
        if next.iter().all(|term| candidates.contains(term)) {
            break;
        }
        let sums: Vec<NetSums> = training.iter().map(|net| NetSums::new(net, &next, rows)).collect();
        found.push(chosen(&next, &sums.iter().collect::<Vec<_>>()));
        candidates = next;
        if found[round].error() < found[best].error() {
            best = round;
        }
    }
    let outputs = found[0].sizes.len();
    let error = |round: usize, output: usize| found[round].errors[output];
    let best_of = |output: usize| {
        (1..found.len()).fold(0, |best, round| if error(round, output) < error(best, output) { round } else { best })
    };
    let best: Vec<usize> = (0..outputs).map(best_of).collect();
    let mut all = Expansions { terms: Vec::new(), of: vec![(0, Vec::new()); outputs] };
    for (round, chosen) in found.iter().enumerate() {
        let members = (0..outputs).filter(|&output| best[output] == round);
        let members: Vec<(usize, usize)> = members.map(|output| (output, chosen.sizes[output])).collect();
        let most = members.iter().map(|(_, size)| *size).max().unwrap_or(0);
        let terms = chosen.terms[..most].to_vec();
        let coefficients = refitted(training, &terms, &members);
        members.iter().zip(coefficients).for_each(|((output, _), of)| all.of[*output] = (round, of));
        all.terms.push(terms);
    }
    all
}

/// Terms chosen among some candidates, in falling order of the gain over all outputs.
struct Chosen {
    terms: Vec<Term>,
    /// Root mean squares of their coefficients over the outputs.
    weights: Vec<f64>,
    /// The number of them that each output uses.
    sizes: Vec<usize>,
    /// The sum of squared residuals of each net when it is left out.
    errors: Vec<f64>,
}

impl Chosen {
    /// Returns the sum of squared residuals of all outputs.
    fn error(&self) -> f64 {
        self.errors.iter().sum()
    }
}

/// Returns the members of `list` except number `left_out`.
pub(super) fn without<T>(list: &[T], left_out: usize) -> Vec<&T> {
    list.iter().enumerate().filter(|(place, _)| *place != left_out).map(|(_, item)| item).collect()
}

/// Chooses the best terms among `candidates`.
fn chosen(candidates: &[Term], nets: &[&NetSums]) -> Chosen {
    let rows: usize = nets.iter().map(|net| net.rows).sum();
    let folds = nets.len() as f64;
    let most = (TERMS_PER_ROW * rows as f64 * (folds - 1.0) / folds) as usize;
    let most = MAX_TERMS.min(candidates.len()).min(most.max(2));
    let outputs = nets.first().map_or(0, |net| net.right.len());
    let mut errors = vec![vec![0.0; most]; outputs];
    for (left_out, net) in nets.iter().enumerate() {
        let others: Vec<&NetSums> = without(nets, left_out).into_iter().copied().collect();
        let (gram, right) = joined(&others);
        let held_out = Path::new(&gram, right, most).held_out(&net.gram, &net.right, &net.squares);
        for ((errors, held_out), square) in errors.iter_mut().zip(held_out).zip(&net.squares) {
            let last = held_out.last().copied().unwrap_or(*square);
            let of_size = held_out.into_iter().chain(std::iter::repeat(last));
            errors.iter_mut().zip(of_size).for_each(|(sum, error)| *sum += error.max(0.0));
        }
    }
    let place = |errors: &Vec<f64>| (1..most).fold(0, |best, k| if errors[k] < errors[best] { k } else { best });
    let places: Vec<usize> = errors.iter().map(place).collect();
    let (gram, right) = joined(nets);
    let path = Path::new(&gram, right, places.iter().max().map_or(0, |place| place + 1));
    let sizes: Vec<usize> = places.iter().map(|place| (place + 1).min(path.chosen.len())).collect();
    let mut squares = vec![0.0; path.chosen.len()];
    for (output, size) in sizes.iter().enumerate() {
        let coefficients = path.coefficients(output, *size);
        squares.iter_mut().zip(coefficients).for_each(|(sum, b)| *sum += b * b);
    }
    Chosen {
        terms: path.chosen.iter().map(|&column| candidates[column].clone()).collect(),
        weights: squares.iter().map(|square| (square / outputs as f64).sqrt()).collect(),
        sizes,
        errors: errors.iter().zip(&places).map(|(errors, place)| errors[*place]).collect(),
    }
}

fn joined(nets: &[&NetSums]) -> (Square, Vec<Vec<f64>>) {
    let (size, outputs) = nets.first().map_or((0, 0), |net| (net.gram.size(), net.right.len()));
    let (mut gram, mut right) = (Square::zeros(size), vec![vec![0.0; size]; outputs]);
    for net in nets {
        gram.add(&net.gram);
        for (right, more) in right.iter_mut().zip(&net.right) {
            right.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
    }
    (gram, right)
}

/// Computes the coefficients of the least-squares expansions over all rows of the nets: for each of `members` its
/// number of the first `terms`.
fn refitted(nets: &[&Training<'_>], terms: &[Term], members: &[(usize, usize)]) -> Vec<Vec<f64>> {
    let mut gram = Square::zeros(terms.len());
    let mut right = vec![vec![0.0; terms.len()]; members.len()];
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); terms.len()];
    for Training { net, outputs } in nets {
        for run in 0..net.runs() {
            columns.iter_mut().zip(terms).for_each(|(column, term)| net.fill(term, run, column));
            gram.add_products(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>());
            for (right, (output, size)) in right.iter_mut().zip(members) {
                let outputs = &outputs[*output][run];
                right.iter_mut().zip(&columns).take(*size).for_each(|(sum, column)| *sum += product(column, outputs));
            }
        }
    }
    let lower = lower_factor(&gram);
    right.iter().zip(members).map(|(right, (_, size))| solve(&lower[..*size], right)).collect()
}
