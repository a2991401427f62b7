//! Trajectories that another program sampled, recognised in a table in their order.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::run::Outcome;
use super::settings::{MIN_TRAJECTORIES, ScreeningDesign, ScreeningSettings};
use super::{Screening, movers, summary};
use crate::given::Column;
use crate::model::Output;
use crate::space::Distribution;
use crate::study::{ExternalSubject, Study, StudyBuilder};
use apportion_base::quantity::Unit;

/// Returns the screening that a table has: Morris trajectories, one after the other, in which each step moves one input, and
/// each moves once in most of them. Effects are per range of the values of an input, as which its factor is uniform in the study
/// called `name`. `None` for other rows.
pub fn screen_table(name: &str, inputs: &[Column], outputs: &[Column]) -> Option<(Study, Screening)> {
    let (rows, d) = (inputs.first()?.values.len(), inputs.len());
    let trajectories = rows / (d + 1);
    if d < 2 || trajectories < MIN_TRAJECTORIES as usize || !rows.is_multiple_of(d + 1) {
        return None;
    }
    let named = outputs.iter().map(|of| Output::new(of.name.clone(), Unit::dimensionless(), "read from a file"));
    let subject = ExternalSubject { outputs: named.collect(), series: Vec::new() };
    let mut builder = StudyBuilder::new(name, Arc::new(subject));
    for Column { name, values } in inputs {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let (min, max) = values.iter().fold(ends, |(min, max), x| (min.min(*x), max.max(*x)));
        builder = builder.factor(name, Distribution::uniform(min, max).ok()?);
    }
    let study = builder.build().ok()?;
    let values = outputs.iter().map(|output| output.values.clone()).collect();
    let mut outcome = Outcome { idle: vec![trajectories as u64; d], values, ..Outcome::default() };
    outcome.effects = vec![vec![0.0; trajectories * d]; outputs.len()];
    for first in (0..rows).step_by(d + 1) {
        let mut has_moved = vec![false; d];
        for row in first + 1..=first + d {
            let mut moved = (0..d).filter(|j| inputs[*j].values[row] != inputs[*j].values[row - 1]);
            let Some(j) = moved.next() else { continue };
            if moved.next().is_some() || std::mem::replace(&mut has_moved[j], true) {
                return None;
            }
            outcome.idle[j] -= 1;
            let (low, high) = study.space().factors()[j].distribution().support();
            let step = (inputs[j].values[row] - inputs[j].values[row - 1]) / (high - low);
            for (effects, output) in outcome.effects.iter_mut().zip(outputs) {
                effects[first / (d + 1) * d + j] = (output.values[row] - output.values[row - 1]) / step;
            }
        }
    }
    // Rows that merely repeat each other move little.
    if outcome.idle.iter().any(|idle| 2 * idle > trajectories as u64) {
        return None;
    }
    let levels: BTreeSet<u64> = inputs[0].values.iter().map(|value| value.to_bits()).collect();
    // Equal parts, each of one trajectory unless there are very many.
    let parts = (1..=trajectories.min(1 << 12)).rev().find(|parts| trajectories.is_multiple_of(*parts))?;
    let design = ScreeningDesign::Trajectory { levels: levels.len() as u32 };
    let settings = ScreeningSettings { design, trajectories: trajectories as u64, seed: 0 };
    let screening = summary(study.space(), &movers(&study), study.model().as_ref(), (settings, parts as u64), &outcome);
    Some((study, screening))
}
