//! The indices of a run of plain rows, by surrogates.

use std::sync::Arc;

use super::aggregate::AggregateIndices;
use super::finished_run::outputs_kept;
use super::output_indices::{IntervalOptions, OutputIndices, of_quantities};
use super::surrogates::interval_options;
use crate::correction::{PlainFit, PlainRows};
use crate::design::Design;
use crate::effect::{Effect, IndexPair};
use crate::estimate::{Indices, MomentParts, Scaling, Undefined, merged};
use crate::model::Model;
use crate::run::Totals;
use crate::study::Study;
use crate::surrogate::{Effects, families};
use crate::uncertainty::{Estimate, Interval, OutputMoments};

/// The surrogates of the outputs of a run of plain rows.
pub(crate) struct PlainOutputs {
    rows: PlainRows,
    /// One for each output that varies.
    fits: Vec<Result<PlainFit, Undefined>>,
    /// The variance of each output.
    variances: Vec<f64>,
}

impl PlainOutputs {
    /// Fits the outputs of the runs of `design`; `None` if it has swaps.
    pub fn new(study: &Study, design: &Design, replicates: &[Totals]) -> Option<Arc<Self>> {
        if !design.is_plain() {
            return None;
        }
        let swaps = study.effects().into_iter().map(|effect| effect.factors).collect();
        let layout = study.layout();
        let effects = Effects { swaps, pairs: if layout.second_order { layout.pair_list() } else { Vec::new() } };
        let rows = PlainRows::new(design, &families(&study.space), effects);
        let outputs = replicates.first().map_or(0, |totals| totals.outputs.len());
        let all = (0..outputs).map(|number| {
            let parts: Vec<&MomentParts> = replicates.iter().map(|totals| &totals.outputs[number].moments).collect();
            let moments = merged(&parts.iter().map(|parts| parts.sum()).collect::<Vec<_>>());
            let failed: u64 = replicates.iter().map(|totals| totals.outputs[number].runs_failed).sum();
            let (share, allowed) = (failed as f64 / design.rows() as f64, study.analysis.max_failed);
            if share > allowed {
                return (Err(Undefined::TooManyFailed { share, allowed }), 0.0);
            }
            let fit = Indices::from_moments(&moments)
                .and_then(|_| rows.fit(&outputs_kept(replicates, number)).ok_or(Undefined::ZeroVariance));
            (fit, moments.variance())
        });
        let (fits, variances) = all.unzip();
        Some(Arc::new(Self { rows, fits, variances }))
    }

    /// Returns the indices of output number `number`, and the probabilities of ranks if they are wanted.
    ///
    /// # Errors
    /// [`Undefined`] if there are none.
    pub fn indices(
        &self,
        study: &Study,
        model: &dyn Model,
        number: usize,
        ranks: bool,
    ) -> Result<OutputIndices, Undefined> {
        let fit = self.fits[number].as_ref().map_err(|undefined| *undefined)?;
        let quantities = self.rows.quantities(fit, &study.layout(), &study.unread(model, number));
        let options = interval_options(study);
        let options = IntervalOptions { draws: if ranks { options.draws } else { 0 }, ..options };
        Ok(OutputIndices { surrogate: Some(fit.surrogate_use()), ..of_quantities(quantities, None, &options) })
    }

    /// Returns the mean and variance of an output of the runs that were fitted, if it varies.
    pub(super) fn moments(&self, number: usize, replicates: &[Totals]) -> Option<OutputMoments> {
        self.rows.moments(self.fits[number].as_ref().ok()?, &outputs_kept(replicates, number))
    }

    /// Returns the share of the variance that the surrogate of an output leaves of held-out rows, if it varies.
    pub fn rest(&self, number: usize) -> Option<f64> {
        self.fits[number].as_ref().ok().map(|fit| fit.chaos.rest)
    }

    /// Returns indices over several outputs together: means weighted by their variances, with errors that may add.
    ///
    /// # Errors
    /// [`Undefined`] if an output has no indices, although it varies, or none varies.
    pub(super) fn together(
        &self,
        study: &Study,
        model: &dyn Model,
        places: impl Iterator<Item = usize>,
        scaling: Scaling,
    ) -> Result<AggregateIndices, Undefined> {
        let mut all: Vec<(f64, OutputIndices)> = Vec::new();
        for number in places {
            match self.indices(study, model, number, false) {
                Ok(indices) => {
                    let weight = if scaling == Scaling::Plain { self.variances[number] } else { 1.0 };
                    all.push((weight, indices));
                }
                Err(Undefined::ZeroVariance) => (),
                Err(undefined) => return Err(undefined),
            }
        }
        let largest = all.iter().map(|(weight, _)| *weight).fold(0.0, f64::max);
        let sum: f64 = all.iter().map(|(weight, _)| weight / largest).sum();
        let effects: Vec<Effect> =
            all.first().ok_or(Undefined::ZeroVariance)?.1.effects.iter().map(|of| of.effect).collect();
        let mean = |read: &dyn Fn(&OutputIndices) -> Estimate| {
            let (mut estimate, mut half) = (0.0, 0.0);
            for (weight, of) in &all {
                let (share, of) = (weight / largest / sum, read(of));
                estimate += share * of.estimate;
                half += share * of.interval.map_or(f64::NAN, Interval::width) / 2.0;
            }
            Estimate { estimate, interval: Interval::about(estimate, half).finite() }
        };
        let indices = (0..effects.len()).map(|at| IndexPair {
            first_order: mean(&|of| of.effects[at].estimates.first_order),
            total: mean(&|of| of.effects[at].estimates.total),
        });
        let indices = indices.collect();
        Ok(AggregateIndices { effects, indices })
    }
}
