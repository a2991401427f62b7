//! Finished runs, the names of their estimates, and the inputs of their rows.

use std::sync::Arc;

use serde_json::{Map, Value};

use super::plain::PlainOutputs;

use crate::correction::{IndependentOutputs, SurrogateEstimates};
use crate::design::Design;
use crate::estimate::PointOutputs;
use crate::model::Model;
use crate::result::Warning;
use crate::run::{RowPosition, Totals};
use crate::space::Space;
use crate::study::Study;

/// A finished run of a study.
#[derive(Clone, Copy)]
pub(crate) struct FinishedRun<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its model.
    pub model: &'a dyn Model,
    /// The final design.
    pub design: &'a Design,
    /// Totals of each replicate.
    pub replicates: &'a [Totals],
    /// The runs of low-fidelity models.
    pub low_fidelity: &'a [LowFidelityTotals<'a>],
    /// The surrogate estimates of every output, if already known.
    pub surrogates: Option<&'a [Option<SurrogateEstimates>]>,
    /// The surrogates of a run of plain rows, if already known.
    pub plain: Option<&'a Arc<PlainOutputs>>,
    /// Threads that ran the model.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
}

/// The runs of a low-fidelity model.
#[derive(Clone, Copy)]
pub(crate) struct LowFidelityTotals<'a> {
    /// Its name.
    pub name: &'a str,
    /// Totals of each replicate at the rows of the expensive model.
    pub shared: &'a [Totals],
    /// A design of its own.
    pub design: &'a Design,
    /// Totals of each replicate of its own design.
    pub own: &'a [Totals],
    /// Every output at its rows.
    pub outputs: &'a [Option<IndependentOutputs>],
}

impl LowFidelityTotals<'_> {
    /// Returns why the model is not used for output number `number` of the rows of `design`, if so.
    pub fn refusal(&self, number: usize, design: &Design) -> Option<Warning> {
        let independent = self.outputs.get(number)?.as_ref()?;
        let share = independent.unmet_share(&outputs_kept(self.shared, number), design.runs().len());
        let name = self.name.to_owned();
        (share > IndependentOutputs::MAX_UNMET_SHARE).then_some(Warning::UnmetLowFidelity { name, share })
    }
}

/// Returns output number `number` of every run of each replicate.
pub(crate) fn outputs_kept(replicates: &[Totals], number: usize) -> Vec<&PointOutputs> {
    replicates.iter().map(|totals| &totals.outputs[number].point_outputs).collect()
}

/// Returns the values of the factors of `space` by name: numbers in their units, or the labels of categories.
pub(crate) fn named_inputs(space: &Space, values: &[f64]) -> Map<String, Value> {
    let named = space.factors().iter().zip(values).map(|(factor, &value)| {
        let label = factor.distribution().label(value);
        (factor.name.clone(), label.map_or_else(|| Value::from(value), Value::from))
    });
    named.collect()
}

/// Returns the values of the factors at `place` of `design`, in their units.
pub fn row_inputs(study: &Study, design: &Design, place: RowPosition) -> Vec<f64> {
    let mut u = vec![0.0; design.factors()];
    design.point(place.row(design), &mut u);
    study.space.values_at(&u)
}

impl Study {
    /// Formats the inputs of a row, such as `length = 300 um, velocity = 0 nm/s`; `place` may be outside the
    /// study's own design, which a growing run exceeds.
    pub fn inputs_in_words(&self, place: RowPosition) -> String {
        let points = place.point.checked_add(1).and_then(u64::checked_next_power_of_two);
        let longer = points.filter(|points| *points > self.design.points_per_replicate());
        let longer = longer.and_then(|points| self.design.with_points(points).ok());
        let values = row_inputs(self, longer.as_ref().unwrap_or(&self.design), place);
        let words = self.space.factors().iter().zip(values).map(|(factor, value)| {
            let unit = factor.unit().to_string();
            if unit == "1" { format!("{} = {value}", factor.name) } else { format!("{} = {value} {unit}", factor.name) }
        });
        words.collect::<Vec<_>>().join(", ")
    }
}
