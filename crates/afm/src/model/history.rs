//! Outputs of the nanoparticle model against time.

use std::ops::Range;

use apportion::model::{Batch, Output, OutputSeries, SeriesAxis, SeriesError};
use apportion_base::names::named;

use super::output::edge;
use crate::history::{Sample, at_times};
use crate::{Failure, Options, Scene};

named! {
/// A quantity of the push against time: the tip moves with the particle until it slips, and holds it at rest afterwards
/// (Tafazzoli and Sitti 2004), see [`crate::history`]. The slip is that of the quasi-static rung for any fidelity.
pub enum AfmHistory {
    /// F_T, the tip force.
    Force = "force_history",
    /// The travel of the particle.
    Position = "position_history",
    /// Radius of the contact between particle and substrate.
    SubstrateContact = "substrate_contact_history",
    /// Radius of the contact between tip and particle; 0 if the tip force pulls it apart.
    TipContact = "tip_contact_history",
}
}

impl AfmHistory {
    /// Returns its description as an output.
    pub fn info(self) -> Output {
        let (unit, description) = self.row();
        Output::new(self.name(), edge(unit), description)
    }

    /// Returns unit and description.
    fn row(self) -> (&'static str, &'static str) {
        match self {
            Self::Force => ("nN", "tip force F_T against time"),
            Self::Position => ("nm", "travel of the particle against time"),
            Self::SubstrateContact => ("nm", "radius of the contact with the substrate against time"),
            Self::TipContact => ("nm", "radius of the contact with the tip against time"),
        }
    }

    /// Returns the value in SI units.
    fn value(self, sample: &Sample) -> f64 {
        match self {
            Self::Force => sample.tip_force,
            Self::Position => sample.particle,
            Self::SubstrateContact => sample.substrate_contact.radius,
            Self::TipContact => sample.tip_contact.map_or(0.0, |contact| contact.radius),
        }
    }
}

/// The moments of histories: evenly spaced, the last one at the end of the duration, none at time 0.
#[derive(Debug, Clone, PartialEq)]
pub struct AfmMoments {
    duration: f64,
    axis: SeriesAxis,
}

impl AfmMoments {
    /// Creates `points` moments over `duration` (s).
    ///
    /// # Errors
    /// [`SeriesError`] unless there are 2 to 10,000 points and the duration is a positive number.
    pub fn new(duration: f64, points: usize) -> Result<Self, SeriesError> {
        let step = duration / points.max(1) as f64;
        let axis = SeriesAxis::even("time", "s", points, step, step)?;
        if step > 0.0 { Ok(Self { duration, axis }) } else { Err(SeriesError::Position { place: 0, found: step }) }
    }

    /// Returns the duration of the push (s).
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Returns the times (s), in rising order.
    pub fn times(&self) -> &[f64] {
        self.axis.positions()
    }
}

/// The histories of a model, whose values are its last outputs.
#[derive(Debug, Clone, Default)]
pub(super) struct Histories {
    which: Vec<AfmHistory>,
    times: Vec<f64>,
    series: Vec<OutputSeries>,
}

impl Histories {
    /// Creates the histories of a model with `first` other outputs.
    pub fn new(which: &[AfmHistory], moments: &AfmMoments, first: usize) -> Self {
        let times = moments.times().to_vec();
        let series = which.iter().enumerate().map(|(number, history)| OutputSeries {
            name: history.name().to_owned(),
            first: first + number * times.len(),
            axis: moments.axis.clone(),
        });
        let series = series.collect();
        Self { which: which.to_vec(), times, series }
    }

    pub fn is_empty(&self) -> bool {
        self.which.is_empty()
    }

    pub fn series(&self) -> &[OutputSeries] {
        &self.series
    }

    /// Returns their values as outputs.
    pub fn outputs(&self) -> Vec<Output> {
        let all = self.which.iter().zip(&self.series);
        all.flat_map(|(history, series)| {
            let Output { unit, .. } = history.info();
            series.outputs(&unit, history.row().1).collect::<Vec<Output>>()
        })
        .collect()
    }

    /// Returns the columns of their values.
    pub fn columns(&self) -> Range<usize> {
        let first = self.series.first().map_or(0, |series| series.first);
        first..first + self.which.len() * self.times.len()
    }

    /// Writes the values of a row.
    pub fn write(&self, scene: &Scene, options: &Options, row: usize, batch: &mut Batch) -> Result<(), Failure> {
        at_times(scene, options, &self.times, |place, sample| {
            for (history, series) in self.which.iter().zip(&self.series) {
                batch.set(row, series.first + place, history.value(sample));
            }
        })
    }
}

#[cfg(test)]
#[path = "tests/history.rs"]
mod tests;
