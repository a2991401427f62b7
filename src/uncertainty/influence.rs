//! What each part of the runs does to the estimates.

use super::net_decay::PartInfluences;
use crate::estimate::{MomentParts, Moments, merged};

/// The parts of several outputs of the same runs: for each output its replicates.
pub type Outputs<'a> = &'a [&'a [MomentParts]];

/// Quantities estimated from all parts of all replicates together, and how much each part moves them.
#[derive(Debug, Clone, PartialEq)]
pub struct Influences {
    /// The estimates.
    pub whole: Vec<f64>,
    /// For each quantity: the mean influence of the points of every part, `[replicate][part]`; not finite where leaving
    /// out a part leaves the quantity undefined.
    pub parts: Vec<PartInfluences>,
}

impl Influences {
    /// `quantities` turns the moments of every output into a list of numbers of fixed length, or `None` where they are
    /// undefined. Returns `None` if they are undefined on the whole.
    ///
    /// The influence of a part of n_p of the n points is found by leaving it out: (theta - theta_without) (n - n_p)/n_p,
    /// to first order the mean of the influence function (Hampel 1974) over its points.
    pub fn of(outputs: Outputs<'_>, quantities: &dyn Fn(&[Moments]) -> Option<Vec<f64>>) -> Option<Self> {
        let bundles = bundles(outputs);
        let sums: Vec<Vec<Moments>> =
            outputs.iter().map(|replicates| replicates.iter().map(MomentParts::whole).collect()).collect();
        let all: Vec<Moments> = sums.iter().map(|replicates| merged(replicates)).collect();
        let whole = quantities(&all)?;
        let n = points(&all);
        // What comes before each part, and (from the back) after it: two passes instead of one per part.
        let mut before = vec![vec![Moments::default(); outputs.len()]];
        for bundle in &bundles[..bundles.len().saturating_sub(1)] {
            let mut sum = before[before.len() - 1].clone();
            add(&mut sum, bundle);
            before.push(sum);
        }
        let mut after = vec![Moments::default(); outputs.len()];
        let mut columns = Vec::with_capacity(bundles.len());
        for (bundle, mut rest) in bundles.iter().zip(before).rev() {
            add(&mut rest, &after);
            columns.push(influence(&whole, quantities(&rest), (n, points(bundle))));
            let mut sum = bundle.clone();
            add(&mut sum, &after);
            after = sum;
        }
        columns.reverse();
        let parts = (0..whole.len()).map(|q| by_replicate(outputs[0], &columns, q)).collect();
        Some(Self { whole, parts })
    }
}

/// The parts of all replicates in a row, each with the moments of every output.
fn bundles(outputs: Outputs<'_>) -> Vec<Vec<Moments>> {
    let flat: Vec<Vec<&Moments>> =
        outputs.iter().map(|replicates| replicates.iter().flat_map(MomentParts::parts).collect()).collect();
    let count = flat.iter().map(Vec::len).min().unwrap_or(0);
    (0..count).map(|part| flat.iter().map(|parts| parts[part].clone()).collect()).collect()
}

fn add(sum: &mut [Moments], more: &[Moments]) {
    sum.iter_mut().zip(more).for_each(|(sum, more)| sum.merge(more));
}

/// Base points behind the moments of several outputs.
fn points(outputs: &[Moments]) -> f64 {
    outputs.iter().map(Moments::count).max().unwrap_or(0) as f64
}

fn influence(whole: &[f64], without: Option<Vec<f64>>, (n, n_p): (f64, f64)) -> Vec<f64> {
    if n_p == 0.0 {
        return vec![0.0; whole.len()];
    }
    let Some(without) = without else { return vec![f64::NAN; whole.len()] };
    whole.iter().zip(&without).map(|(theta, without)| (theta - without) * ((n - n_p) / n_p)).collect()
}

/// The influences on quantity `q`, sorted into replicates.
fn by_replicate(replicates: &[MomentParts], columns: &[Vec<f64>], q: usize) -> PartInfluences {
    let mut columns = columns.iter();
    replicates.iter().map(|r| columns.by_ref().take(r.parts().len()).map(|column| column[q]).collect()).collect()
}
