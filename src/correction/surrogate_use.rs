//! What was made of surrogates: their terms, what they explain, and whether their corrections are used.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Why corrected indices are not used.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Refusal {
    /// They contradict the plain ones of the same rows.
    Contradiction {
        /// Their distance relative to both errors.
        times: f64,
    },
    /// The claimed variance exceeds that over the rows too much.
    Growth {
        /// The variance by the surrogates over that in the rows.
        times: f64,
    },
}

/// The use of a low-fidelity model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "LowUseRecord"))]
#[non_exhaustive]
pub struct LowFidelityUse {
    /// Its name.
    pub name: String,
    /// Regression slope of the output of the expensive model on that of the low-fidelity model, by least squares.
    pub slope: f64,
    /// Share of the variance explained by the low-fidelity model alone, over runs not used to fit its slope.
    pub explained: f64,
}

/// The place of a step or a kink of an output in a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// The quantile.
    pub u: f64,
    /// Width of the range of quantiles that contains it.
    pub width: f64,
    /// Whether it is a step rather than a kink.
    pub is_step: bool,
}

/// The terms of the surrogates of every net.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenTerms {
    /// Index of the kind of polynomials.
    pub kind: usize,
    /// The knots of every factor; empty for polynomials only.
    pub knots: Vec<Vec<Knot>>,
    /// For each net the terms of the surrogate of the others: the factors in each, by index, with their degrees.
    pub of_nets: Vec<Vec<Vec<(usize, usize)>>>,
}

/// A term of a surrogate.
#[derive(Debug, Clone, PartialEq)]
pub struct SurrogateTerm {
    /// The factors in it, by index, each with its degree.
    pub factors: Vec<(usize, usize)>,
    /// Its share of the variance.
    pub share: f64,
}

impl SurrogateTerm {
    /// Returns the term with these names of factors or inputs.
    pub fn named(&self, names: &[&str]) -> NamedTerm {
        let degrees = self.factors.iter().map(|&(number, degree)| (names[number].to_owned(), degree));
        NamedTerm { degrees: degrees.collect(), share: 100.0 * self.share }
    }
}

/// A term of the surrogates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NamedTerm {
    /// The degree of its polynomial of each factor in it.
    pub degrees: BTreeMap<String, usize>,
    /// Its share of the variance, in percent.
    pub share: f64,
}

/// The use of a surrogate.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurrogateUse {
    /// Share of the variance that the surrogates explain of the runs to which they were not fitted (Q^2).
    pub explained: f64,
    /// Mean number of terms of the surrogates.
    pub term_count: f64,
    /// The terms with the largest variance, in falling order.
    pub terms: Vec<SurrogateTerm>,
    /// Whether a few rows dominate a residual that matters: intervals then include the plain ones.
    pub is_heavy_tailed: bool,
    /// Whether the first-order indices are corrected, not plain.
    pub corrects_first_order: bool,
    /// Whether the total indices are corrected.
    pub corrects_total: bool,
    /// Variance of the plain first-order indices over that of the corrected ones: without the surrogate this many times
    /// the runs would be needed, if errors fell as those of random points do. `None` if one of them is unknown.
    pub gain_first_order: Option<f64>,
    /// The same for the total indices.
    pub gain_total: Option<f64>,
    /// Whether their distance from the plain ones of the same rows is unlikely: intervals then include both.
    pub is_doubted: bool,
    /// Why neither is corrected; `None` if the errors alone decide.
    pub refusal: Option<Refusal>,
    /// The low-fidelity model used with the surrogates, if there is one.
    pub low: Option<LowFidelityUse>,
}

impl SurrogateUse {
    /// Returns whether indices are corrected, of one kind at least.
    pub fn corrects(&self) -> bool {
        self.corrects_first_order || self.corrects_total
    }
}
