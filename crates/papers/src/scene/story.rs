//! One scene in time: its states and forces in SI.

use std::ops::Deref;

use apportion_afm::history::Sample;
use apportion_afm::{Critical, Scene};
use apportion_report::chart::Colour;
use apportion_report::format;

/// Factor from SI to nN and nm.
pub const NANO: f64 = 1e9;

/// One scene, from the start of the push through sticking and slipping.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneStory {
    /// Headline.
    pub title: String,
    /// The choices, as label and value with unit, such as ("friction", "coulomb"): the page's table of settings.
    pub setting: Vec<(String, String)>,
    /// The scene, whose lengths are drawn to scale.
    pub scene: Scene,
    /// The forces at which the particle slips.
    pub critical: Critical,
    /// The time of the slip (s).
    pub critical_time: f64,
    /// The colour of the pushing force: that of the friction law, see [`law_colour`](super::law_colour).
    pub colour: Colour,
    /// The states in the order of time, from 0 on, unevenly spaced; at the slip there are two.
    pub samples: Vec<SceneSample>,
}

/// The state at one time, with the other possible motions of the particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSample {
    /// The state. Positions are along the motion of the substrate, relative to the start.
    pub state: Sample,
    /// Whether the tip would slip on the particle (a diagnostic).
    pub tip_slip: bool,
    /// Whether the particle would roll (a diagnostic).
    pub rolling: bool,
    /// Whether the particle would spin about the vertical (a diagnostic).
    pub spin: bool,
}

impl Deref for SceneSample {
    type Target = Sample;

    fn deref(&self) -> &Sample {
        &self.state
    }
}

impl SceneSample {
    /// Returns the contact radius at the tip (m); NaN if the contact is pulled apart.
    pub fn tip_contact_radius(&self) -> f64 {
        self.tip_contact.map_or(f64::NAN, |contact| contact.radius)
    }

    /// Returns the indentation at the tip (m); NaN if the contact is pulled apart.
    pub fn tip_indentation(&self) -> f64 {
        self.tip_contact.map_or(f64::NAN, |contact| contact.indentation)
    }
}

impl SceneStory {
    /// Returns the first sample.
    pub fn start(&self) -> &SceneSample {
        &self.samples[0]
    }

    /// Returns the last sample.
    pub fn end(&self) -> &SceneSample {
        &self.samples[self.samples.len() - 1]
    }

    /// Returns the last sample that sticks: that of the slip, if the samples reach it.
    pub(super) fn held(&self) -> &SceneSample {
        self.samples.iter().rfind(|sample| sample.sticking).unwrap_or(self.start())
    }

    /// Returns the critical time if the samples reach it: otherwise it cannot be drawn.
    pub(super) fn slip(&self) -> Option<f64> {
        (self.critical_time <= self.end().time).then_some(self.critical_time)
    }

    /// States the outcome in one sentence.
    pub(super) fn outcome(&self) -> String {
        let at = format::force(self.critical.critical_force);
        let time = format::time(self.critical_time);
        match self.slip() {
            Some(_) => format!("The particle slips after {time}, at a tip force of {at}."),
            None => format!("The particle slips at {time}, outside the time shown, at a tip force of {at}."),
        }
    }
}
