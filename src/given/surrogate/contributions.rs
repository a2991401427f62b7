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

use crate::correction::in_parts;
use crate::surrogate::fit::Expansion;
use crate::surrogate::net::Net;

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

/// What rows contribute to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum To {
    /// V.
    Variance,
    /// V S of an input.
    FirstOrder(usize),
    /// V ST of an input.
    Total(usize),
}

/// The contributions of every row of a fold, for the inputs of the expansion.
pub(super) struct Contributions {
    contributions: BTreeMap<To, Contribution>,
    left: Vec<f64>,
}

/// The same in parts.
pub(super) struct FoldSums {
    /// Rows.
    pub rows: usize,
    /// Those to V with the mean square of the residual.
    pub sums: BTreeMap<To, Folded>,
    /// Sum and sum of squares of the residuals.
    pub left: (f64, f64),
}

impl Contributions {
    /// Computes them for the rows of `net`, one run of one matrix.
    pub fn new(net: &Net, expansion: &Expansion) -> Self {
        let mut left = net.outputs[0].clone();
        let mut values = Vec::new();
        for (term, b) in expansion.terms.iter().zip(&expansion.coefficients) {
            net.fill(term, 0, &mut values);
            left.iter_mut().zip(&values).for_each(|(e, p)| *e -= b * p);
        }
        let squares: Vec<f64> = left.iter().map(|e| e * e).collect();
        let mut all = Self { contributions: BTreeMap::new(), left };
        for (term, &b) in expansion.terms.iter().zip(&expansion.coefficients).filter(|(term, _)| !term.is_empty()) {
            net.fill(term, 0, &mut values);
            let of_row = |(p, e): (&f64, &f64)| b * b + 2.0 * b * p * e;
            let contributions: Vec<f64> = values.iter().zip(&all.left).map(of_row).collect();
            all.to(To::Variance).add(&contributions);
            if let [(input, _)] = term[..] {
                all.to(To::FirstOrder(input)).add(&contributions);
            }
            for (input, _) in term {
                all.to(To::Total(*input)).add(&contributions);
            }
        }
        all.to(To::Variance).add(&squares);
        all
    }

    /// Returns one of the contributions; those of an input that is in no term are 0.
    pub fn to(&mut self, to: To) -> &mut Contribution {
        let rows = self.left.len();
        self.contributions.entry(to).or_insert_with(|| Contribution::zeros(rows))
    }

    /// Returns the sums in parts, as the intervals need them.
    pub fn in_parts(&self) -> FoldSums {
        FoldSums {
            rows: self.left.len(),
            sums: self.contributions.iter().map(|(to, of)| (*to, of.in_parts())).collect(),
            left: (self.left.iter().sum(), self.left.iter().map(|e| e * e).sum()),
        }
    }
}
