//! Dependence between the inputs of a table.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

use super::evenness::{GRIDS, deviation};
use super::order::Order;

/// The dependence between the inputs of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Dependence {
    /// The pair with the largest absolute rank correlation.
    #[serde(flatten)]
    pub strongest: PairDependence,
    /// The level that independent inputs exceed in one table of a thousand, for any number of inputs.
    pub noise: f64,
    /// A pair whose joint counts are too uneven for independence, though its rank correlation may be small; only
    /// computed if the correlation is not clear.
    pub uneven: Option<(String, String)>,
}

/// A pair of inputs with its rank correlation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PairDependence {
    /// The names.
    pub inputs: (String, String),
    /// Spearman's rank correlation, -1 to 1, with mean ranks for ties.
    pub spearman: f64,
}

impl Dependence {
    /// Correlations below this have no visible effect on indices, even if significant in a long table.
    const NEGLIGIBLE: f64 = 0.05;

    /// Returns whether the largest rank correlation is clearly not zero.
    pub fn correlated(&self) -> bool {
        self.strongest.spearman.abs() > self.noise.max(Self::NEGLIGIBLE)
    }

    /// Returns a pair that clearly depends on each other, by rank or in another way.
    pub fn dependent(&self) -> Option<&(String, String)> {
        if self.correlated() { Some(&self.strongest.inputs) } else { self.uneven.as_ref() }
    }
}

/// Computes the dependence between `inputs`, all of which vary; `None` if there are fewer than two.
pub(super) fn between(inputs: &[(&str, &Order)], rows: usize) -> Option<Dependence> {
    let ranks: Vec<Vec<f64>> = inputs.iter().map(|(_, order)| normalised(order.centred_ranks())).collect();
    let mut strongest: Option<(usize, usize, f64)> = None;
    for j in 1..ranks.len() {
        for i in 0..j {
            let spearman: f64 = ranks[i].iter().zip(&ranks[j]).map(|(a, b)| a * b).sum();
            if strongest.is_none_or(|(.., largest)| spearman.abs() > largest.abs()) {
                strongest = Some((i, j, spearman));
            }
        }
    }
    let (i, j, spearman) = strongest?;
    let pairs = (ranks.len() * (ranks.len() - 1) / 2) as f64;
    let quantile = Normal::standard().inverse_cdf(1.0 - 0.5e-3 / pairs);
    let noise = (quantile / (rows as f64 - 1.0).sqrt()).min(1.0);
    let strongest = PairDependence { inputs: names(inputs, (i, j)), spearman };
    let mut dependence = Dependence { strongest, noise, uneven: None };
    if !dependence.correlated() {
        dependence.uneven = uneven_pair(inputs, rows).map(|pair| names(inputs, pair));
    }
    Some(dependence)
}

fn names(inputs: &[(&str, &Order)], (i, j): (usize, usize)) -> (String, String) {
    (inputs[i].0.to_owned(), inputs[j].0.to_owned())
}

fn normalised(mut ranks: Vec<f64>) -> Vec<f64> {
    let length = ranks.iter().map(|r| r * r).sum::<f64>().sqrt();
    ranks.iter_mut().for_each(|r| *r /= length);
    ranks
}

/// Returns the pair whose counts in a coarse grid deviate most from independence, if by more than chance.
fn uneven_pair(inputs: &[(&str, &Order)], rows: usize) -> Option<(usize, usize)> {
    /// Quantile of a standard normal number; the probability is about 2e-9 by chance.
    const CLEAR: f64 = 6.0;
    // At least five rows a cell, as Pearson's test requires.
    let grid = *GRIDS.iter().rev().find(|&&grid| grid * grid * 5 <= rows)?;
    let classes: Vec<_> = inputs.iter().map(|(_, order)| order.classes(grid)).collect();
    let pairs = (1..inputs.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    let deviations = pairs.filter_map(|(i, j)| Some((deviation(&classes[i], &classes[j])?.normal(), (i, j))));
    deviations.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(deviation, _)| *deviation > CLEAR).map(|(_, pair)| pair)
}
