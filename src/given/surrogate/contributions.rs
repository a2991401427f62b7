//! Contributions of the rows of a fold to the indices, corrected by the expansion of the other folds.
//!
//! With the terms phi_a of coefficients b_a of an expansion g not fitted to the fold, e = f - g on its rows, and r_a
//! the mean of phi_a e over them,
//!
//! - V S_s = sum over a within s of (b_a^2 + 2 b_a r_a) + V_s(e),
//! - V ST_s = sum over a that touch s of (b_a^2 + 2 b_a r_a) + VT_s(e),
//! - V = sum over a but the constant of (b_a^2 + 2 b_a r_a) + mean e^2 - (mean e)^2.
//!
//! The last summands of the first two are quadratic in e, and unknown from a table; they are between 0 and Var(e).

use std::collections::BTreeMap;

use crate::surrogate::fit::Expansion;
use crate::surrogate::net::Net;
use crate::uncertainty::in_parts;

/// A number that is a mean over rows.
#[derive(Debug, Clone)]
pub(super) struct Contribution {
    /// The contribution of each row of the fold.
    rows: Vec<f64>,
    /// The other influences of each row.
    moves: Vec<f64>,
}

impl Contribution {
    fn zeros(rows: usize) -> Self {
        Self { rows: vec![0.0; rows], moves: vec![0.0; rows] }
    }

    fn add(&mut self, more: &[f64]) {
        self.rows.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    }

    /// Adds influences that sum to 0 over all rows of the table.
    pub fn move_by(&mut self, more: &[f64]) {
        self.moves.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    }

    /// Returns these influences.
    #[cfg(test)]
    pub fn moves(&self) -> &[f64] {
        &self.moves
    }

    fn in_parts(&self) -> Folded {
        let all: Vec<f64> = self.rows.iter().zip(&self.moves).map(|(row, more)| row + more).collect();
        let parts = in_parts(&[all]).into_iter().flatten().collect();
        Folded { sum: self.rows.iter().sum(), parts }
    }
}

/// The sum of the contributions of a fold, and the mean influence of the rows of its parts.
#[derive(Debug, Clone)]
pub(super) struct Folded {
    /// The sum.
    pub sum: f64,
    /// The mean influences of the rows of each part, without subtraction of their mean.
    pub parts: Vec<f64>,
}

/// The contributions of every row of a fold, for the inputs of the expansion.
pub(super) struct Contributions {
    /// Contributions to V.
    pub variance: Contribution,
    first_order: BTreeMap<usize, Contribution>,
    total: BTreeMap<usize, Contribution>,
    left: Vec<f64>,
}

/// The same in parts.
pub(super) struct FoldSums {
    /// Rows.
    pub rows: usize,
    /// V, with the mean square of the residual.
    pub variance: Folded,
    /// V S.
    pub first_order: BTreeMap<usize, Folded>,
    /// V ST.
    pub total: BTreeMap<usize, Folded>,
    /// Sum and sum of squares of the residuals.
    pub left: (f64, f64),
}

impl Contributions {
    /// Computes them for the rows of `net`, one run of one matrix.
    pub fn new(net: &Net, expansion: &Expansion) -> Self {
        let rows = net.points();
        let mut left = net.outputs[0].clone();
        let mut values = Vec::new();
        for (term, b) in expansion.terms.iter().zip(&expansion.coefficients) {
            net.fill(term, 0, &mut values);
            left.iter_mut().zip(&values).for_each(|(e, p)| *e -= b * p);
        }
        let mut all = Self {
            variance: Contribution::zeros(rows),
            first_order: BTreeMap::new(),
            total: BTreeMap::new(),
            left: Vec::new(),
        };
        for (term, &b) in expansion.terms.iter().zip(&expansion.coefficients).filter(|(term, _)| !term.is_empty()) {
            net.fill(term, 0, &mut values);
            let of_row = |(p, e): (&f64, &f64)| b * b + 2.0 * b * p * e;
            let contributions: Vec<f64> = values.iter().zip(&left).map(of_row).collect();
            all.variance.add(&contributions);
            if let [(input, _)] = term[..] {
                all.first_order_of(input).add(&contributions);
            }
            for (input, _) in term {
                all.total_of(*input).add(&contributions);
            }
        }
        let squares: Vec<f64> = left.iter().map(|e| e * e).collect();
        all.variance.add(&squares);
        all.left = left;
        all
    }

    /// Returns the contribution to V S of an input.
    pub fn first_order_of(&mut self, input: usize) -> &mut Contribution {
        let rows = self.variance.rows.len();
        self.first_order.entry(input).or_insert_with(|| Contribution::zeros(rows))
    }

    /// Returns the contribution to V ST of an input.
    pub fn total_of(&mut self, input: usize) -> &mut Contribution {
        let rows = self.variance.rows.len();
        self.total.entry(input).or_insert_with(|| Contribution::zeros(rows))
    }

    /// Returns the sums in parts, as the intervals need them.
    pub fn in_parts(&self) -> FoldSums {
        let of =
            |list: &BTreeMap<usize, Contribution>| list.iter().map(|(input, of)| (*input, of.in_parts())).collect();
        FoldSums {
            rows: self.left.len(),
            variance: self.variance.in_parts(),
            first_order: of(&self.first_order),
            total: of(&self.total),
            left: (self.left.iter().sum(), self.left.iter().map(|e| e * e).sum()),
        }
    }
}
