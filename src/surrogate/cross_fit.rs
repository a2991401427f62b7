//! Fits to all nets but one.

use rayon::prelude::*;

use super::chaos::{CrossFits, Factor, degree_at, expansions_together};
use super::expansion::Expansion;
use super::family::Family;
use super::net::Net;
use super::outputs::Scale;

/// The surrogates of all nets.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossFitted {
    /// The units of the output.
    pub(crate) scale: Scale,
    /// The functions of every factor.
    pub families: Vec<Family>,
    /// For every net the expansion fitted to the others.
    pub of_nets: Vec<Expansion>,
}

/// Maximum number of rows to which Bayesian chaos is fitted: the others correct its error.
const ROWS: usize = 1 << 11;

/// The rows of nets to which expansions are fitted.
pub(crate) struct FittedRows {
    /// The net, the run and the base point of each.
    rows: Vec<(usize, usize, usize)>,
    factors: Vec<Factor>,
}

impl FittedRows {
    /// Chooses some rows of `nets`, of factors with polynomials of `families`.
    pub fn new(nets: &[Net], families: &[Family]) -> Self {
        let rows = rows_of_nets(nets);
        let degree = degree_at(rows.len());
        let factors = families.par_iter().enumerate().map(|(factor, family)| {
            let u: Vec<f64> = rows.iter().map(|&(k, run, point)| nets[k].quantiles(run, factor)[point]).collect();
            Factor::new(family, &u, degree)
        });
        Self { factors: factors.collect(), rows }
    }

    /// Returns for every net the expansion of an output in units of `scale`, a column of `nets` for each run, fitted to
    /// the others by Bayesian chaos, with steps and kinks.
    pub fn fitted(&self, nets: &[&[Vec<f64>]], scale: Scale) -> CrossFitted {
        let fits = CrossFits::new(self.factors.clone(), self.at_rows(nets), self.parts());
        CrossFitted { scale, families: fits.families(), of_nets: fits.expansions().swap_remove(0) }
    }

    /// Returns for every net the expansion of each of `outputs` by the polynomials alone, in the same terms.
    pub fn smooth(&self, outputs: &[Vec<&[Vec<f64>]>]) -> Vec<Vec<Expansion>> {
        let outputs = outputs.par_iter().map(|nets| self.at_rows(nets)).collect();
        expansions_together(&self.factors, outputs, &self.parts())
    }

    fn at_rows(&self, nets: &[&[Vec<f64>]]) -> Vec<f64> {
        self.rows.iter().map(|&(k, run, point)| nets[k][run][point]).collect()
    }

    fn parts(&self) -> Vec<usize> {
        self.rows.iter().map(|(k, ..)| *k).collect()
    }
}

/// Returns the first rows (net, run, base point) of all nets in turn: those of A and of B, which tell most, then one of the
/// others at each point, another one at the next.
fn rows_of_nets(nets: &[Net]) -> Vec<(usize, usize, usize)> {
    let points = nets.iter().map(Net::points).max().unwrap_or(0);
    let runs = nets.iter().map(Net::runs).max().unwrap_or(0);
    let plain = (0..runs.min(2)).flat_map(|run| (0..points).map(move |point| (run, point)));
    let others = runs.saturating_sub(2);
    let swapped = (0..others).flat_map(|turn| (0..points).map(move |point| (2 + (point + turn) % others, point)));
    let rows = plain.chain(swapped).flat_map(|(run, point)| (0..nets.len()).map(move |k| (k, run, point)));
    rows.filter(|&(k, run, point)| run < nets[k].runs() && point < nets[k].points()).take(ROWS).collect()
}
