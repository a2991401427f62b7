//! Output values that may be codes or errors.

use crate::design::Design;
use crate::model::Output;
use crate::result::Warning;
use crate::run::{RowBlock, Store};
use crate::study::Study;
use apportion_base::quantity::Unlikely;

impl Study {
    /// Returns for each output the unlikely value among those in `store`, if there is one.
    pub fn unlikely_outputs(&self, store: &Store) -> Vec<Option<Unlikely>> {
        let design = &self.design;
        let rows = design.points_per_replicate() * design.rows_per_point();
        let blocks: Vec<RowBlock> =
            (0..design.settings().replicates).filter_map(|replicate| store.block(replicate, 0..rows)).collect();
        let model = self.model();
        let outputs = model.outputs();
        let mut unlikely = Vec::with_capacity(outputs.len());
        for (number, output) in outputs.iter().enumerate() {
            let values = blocks.iter().flat_map(|block| block.values.iter().skip(number).step_by(outputs.len()));
            unlikely.push(Unlikely::find(&values.map(|si| output.unit.from_si(*si)).collect::<Vec<f64>>()));
        }
        unlikely
    }
}

/// Returns a warning of the unlikely value among the `samples` of an output: the first rows A and B of each replicate;
/// `sorted` has the finite ones in rising order.
pub(super) fn of_samples(design: &Design, output: &Output, samples: &[&Vec<f64>], sorted: &[f64]) -> Option<Warning> {
    let sorted: Vec<f64> = sorted.iter().map(|si| output.unit.from_si(*si)).collect();
    let values = samples.iter().copied().flatten().map(|si| output.unit.from_si(*si));
    let unlikely = Unlikely::find_in_sorted_rows(&sorted, &|value| values.clone().position(|other| other == value))?;
    let (mut place, mut replicate) = (unlikely.first, 0);
    while place >= samples[replicate].len() {
        place -= samples[replicate].len();
        replicate += 1;
    }
    let point = replicate as u64 * design.points_per_replicate() + place as u64 / 2;
    let first = (point * design.rows_per_point()) as usize + place % 2;
    Some(Warning::UnlikelyValue(Unlikely { first, ..unlikely }))
}
