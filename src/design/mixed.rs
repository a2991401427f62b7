//! The columns of rows of dependent factors that come from no matrix alone.
//!
//! Where factors are independent, a row AB_s is A with the columns s from B. Where they depend on each other, something has to give:
//! either the factors s come from B and the others follow them, each keeping of A what the factors s do not tell of it; or the others
//! come from A, and the factors s are drawn anew given them. For a Gaussian copula both are linear in normal scores (Kucherenko,
//! Tarantola and Annoni 2012, Comput. Phys. Commun. 183, 937-946; Mara, Tarantola and Annoni 2015, Environ. Model. Softw. 72,
//! 173-183): with a difference b - a of the scores of B and A, the first is z_r = a_r + R (b_s - a_s), the second
//! z_s = b_s + R' (a_r - b_r), R and R' being the regressions. For a kernel copula what a factor has beside others is the normal score
//! of its conditional distribution function (Rosenblatt 1952), of one factor after another in the order of the study.

use std::sync::Arc;

use crate::space::{Chain, Copula, from_score};

/// A column that follows others.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MixedColumn {
    /// The factor whose column it is.
    pub factor: usize,
    source: Source,
}

#[derive(Debug, Clone, PartialEq)]
enum Source {
    /// The scores of a column of a matrix, to which is added: (coefficient, of the scores of this column, less those of that one).
    Linear { start: usize, terms: Vec<(f64, usize, usize)> },
    /// The factor at this place of a transport.
    Transport { number: usize, place: usize },
}

/// Factors of a kernel copula, some of which are given by a matrix, and the others have from another one what they have beside these.
#[derive(Debug, Clone, PartialEq)]
struct Transport {
    kernel: usize,
    /// The places of its factors, those that are given first.
    order: Vec<usize>,
    given: usize,
    /// The numbers of the first columns of the matrix that gives them, and of the other one.
    from: [usize; 2],
    chain: Chain,
}

/// The mixed columns of a design, and the copula that its matrices follow.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MixedColumns {
    copula: Arc<Copula>,
    /// The number of the first one among the columns of the base points.
    pub first: usize,
    pub columns: Vec<MixedColumn>,
    transports: Vec<Transport>,
}

impl MixedColumns {
    /// Without any column yet.
    pub fn new(copula: Arc<Copula>, first: usize) -> Self {
        Self { copula, first, columns: Vec::new(), transports: Vec::new() }
    }

    /// The columns in which a row differs from `base` with the columns `swap` of `from`, as (factor, column), in rising order;
    /// `redrawn` tells whether the factors of the swap are drawn given the others, or else the others follow them. `base` and
    /// `from` are the numbers of the first columns of the two matrices.
    pub fn of_row(&mut self, swap: &[usize], redrawn: bool, base: usize, from: usize) -> Vec<(usize, usize)> {
        let copula = Arc::clone(&self.copula);
        let gaussian = copula.gaussian();
        let (swapped, others): (Vec<usize>, Vec<usize>) = gaussian.dependent().iter().partition(|j| swap.contains(j));
        let (following, given, start, sign) =
            if redrawn { (&swapped, &others, from, -1.0) } else { (&others, &swapped, base, 1.0) };
        let mut row = Vec::new();
        for &factor in following {
            let coefficients = gaussian.regression(factor, given);
            let terms = given.iter().zip(coefficients).filter(|(_, coefficient)| *coefficient != 0.0);
            let terms: Vec<(f64, usize, usize)> =
                terms.map(|(j, coefficient)| (sign * coefficient, from + j, base + j)).collect();
            if !terms.is_empty() {
                let source = Source::Linear { start: start + factor, terms };
                row.push((factor, self.number(MixedColumn { factor, source })));
            }
        }
        for (kernel, of) in copula.kernels().iter().enumerate() {
            let is_given = |place: &usize| swap.contains(&of.factors()[*place]) != redrawn;
            let (mut order, following): (Vec<usize>, Vec<usize>) = (0..of.factors().len()).partition(is_given);
            let given = order.len();
            if given == 0 || following.is_empty() {
                continue;
            }
            order.extend(following);
            let from = if redrawn { [base, from] } else { [from, base] };
            let number = self.transport(Transport { kernel, chain: of.chain(&order), order, given, from });
            for place in given..of.factors().len() {
                let factor = of.factors()[self.transports[number].order[place]];
                let source = Source::Transport { number, place };
                row.push((factor, self.number(MixedColumn { factor, source })));
            }
        }
        row.sort_unstable();
        row
    }

    fn transport(&mut self, transport: Transport) -> usize {
        let place = self.transports.iter().position(|other| *other == transport);
        place.unwrap_or_else(|| {
            self.transports.push(transport);
            self.transports.len() - 1
        })
    }

    fn number(&mut self, column: MixedColumn) -> usize {
        let place = self.columns.iter().position(|other| *other == column);
        self.first
            + place.unwrap_or_else(|| {
                self.columns.push(column);
                self.columns.len() - 1
            })
    }

    /// Makes the columns of A and B dependent, `factors` each, and fills the mixed ones behind all others.
    pub fn fill(&self, columns: &mut [Vec<f64>], factors: usize) {
        let (own, mixed) = columns.split_at_mut(self.first.min(columns.len()));
        own.chunks_mut(factors).take(2).for_each(|matrix| self.copula.correlate(matrix));
        if mixed.is_empty() {
            return;
        }
        let scores: Vec<Vec<f64>> =
            own.chunks(factors).take(2).flat_map(|matrix| self.copula.scores(matrix)).collect();
        for (MixedColumn { source, .. }, column) in self.columns.iter().zip(&mut *mixed) {
            let Source::Linear { start, terms } = source else { continue };
            column.copy_from_slice(&scores[*start]);
            for (coefficient, plus, less) in terms {
                let difference = scores[*plus].iter().zip(&scores[*less]).map(|(plus, less)| plus - less);
                column.iter_mut().zip(difference).for_each(|(score, difference)| *score += coefficient * difference);
            }
            column.iter_mut().for_each(|score| *score = from_score(*score));
        }
        for (number, transport) in self.transports.iter().enumerate() {
            for point in 0..mixed[0].len() {
                let coordinates = transport.point(&self.copula, &scores, point);
                for (column, mixed) in self.columns.iter().zip(&mut *mixed) {
                    if let Source::Transport { number: of, place } = column.source
                        && of == number
                    {
                        mixed[point] = coordinates[place];
                    }
                }
            }
        }
    }
}

impl Transport {
    /// The coordinates of its factors at one point, in its order; those that are given have none.
    fn point(&self, copula: &Copula, scores: &[Vec<f64>], point: usize) -> Vec<f64> {
        let kernel = &copula.kernels()[self.kernel];
        let of_matrix = |first: usize| -> Vec<f64> {
            let scores = self.order.iter().map(|place| scores[first + kernel.factors()[*place]][point]);
            self.chain.whiten(&scores.collect::<Vec<f64>>())
        };
        let [given, others] = self.from.map(of_matrix);
        let e = self.chain.point(&given[..self.given], &self.chain.innovations(&others, self.given));
        let coordinate = |place: usize| match place < self.given {
            true => f64::NAN,
            false => kernel.coordinate(self.order[place], self.chain.score(place, &e)),
        };
        (0..self.order.len()).map(coordinate).collect()
    }
}
