//! The compared curves: a study's settings, each at a growing number of base samples.

use apportion::design::{DesignError, DesignSettings, Sampler};
use apportion::study::{AnalysisOptions, Rung, Study, SurrogateChoice, Target};
use apportion::uncertainty::IntervalMethod;
use apportion_base::names::named;
use serde::{Deserialize, Serialize};

/// Suffix of the names of curves with surrogates.
pub(super) const SURROGATES: &str = ", surrogates";

named! {
/// What varies along a curve.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// The fidelity of the model, with and without surrogates.
    Fidelity = "fidelity",
    /// The sampler.
    Sampler = "sampler",
}
}

/// Settings that stay the same while base samples grow.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    /// Its axis in the comparison.
    pub axis: Axis,
    /// The model.
    pub rung: Rung,
    pub sampler: Sampler,
    /// On or off.
    pub surrogate: SurrogateChoice,
}

impl Curve {
    /// Returns all curves of `study`: every rung with and without surrogates, and at the study's rung, without
    /// surrogates, the other samplers.
    pub fn all(study: &Study) -> Vec<Self> {
        let settings = study.design().settings();
        let rungs = rungs(study);
        let name = study.subject().rung_name();
        let rung = rungs.iter().find(|rung| rung.name == name).unwrap_or(&rungs[0]).clone();
        let base = Self { axis: Axis::Fidelity, rung, sampler: settings.sampler, surrogate: SurrogateChoice::Off };
        let mut curves = Vec::new();
        for rung in rungs {
            for surrogate in [SurrogateChoice::Off, SurrogateChoice::On] {
                curves.push(Self { rung: rung.clone(), surrogate, ..base.clone() });
            }
        }
        let samplers = Sampler::ALL.into_iter().filter(|sampler| *sampler != settings.sampler);
        curves.extend(samplers.map(|sampler| Self { axis: Axis::Sampler, sampler, ..base.clone() }));
        curves
    }

    /// Returns its name among the others.
    pub fn name(&self) -> String {
        let rung = &self.rung.name;
        match self.axis {
            Axis::Fidelity if self.surrogate == SurrogateChoice::On => format!("{rung}{SURROGATES}"),
            Axis::Fidelity => rung.to_owned(),
            Axis::Sampler => self.sampler.name().to_owned(),
        }
    }

    /// Returns `study` with these settings.
    pub fn study(&self, study: &Study, base_samples: u64, seed: u64) -> Result<Study, DesignError> {
        let intervals = study.analysis().intervals;
        let serves = intervals.serves(self.sampler);
        let intervals = if serves { intervals } else { IntervalMethod::default_for(self.sampler) };
        let analysis = AnalysisOptions { intervals, surrogate: self.surrogate, ..indices_only(study) };
        let replicates = match self.sampler == study.design().settings().sampler {
            true => study.design().settings().replicates,
            false => analysis.intervals.default_replicates(),
        };
        let settings = DesignSettings { sampler: self.sampler, base_samples, replicates, seed };
        let variant = study.clone().with_subject(self.rung.subject.clone()).with_target(Target::default());
        variant.without_low_fidelities().with_design(settings, analysis)
    }

    /// Returns the lines of a study with these settings.
    pub fn lines(&self, base_samples: u64) -> String {
        let mut lines = self.rung.lines.clone();
        lines.push_str(&format!("[design]\nsampler = \"{}\"\nbase_samples = {base_samples}\n", self.sampler.name()));
        lines.push_str(&format!("[analysis]\nsurrogate = \"{}\"\n", self.surrogate.name()));
        lines
    }
}

/// Returns the options of a study without what takes time and changes no first-order or total index.
pub(super) fn indices_only(study: &Study) -> AnalysisOptions {
    AnalysisOptions { estimators: Vec::new(), second_order: false, pictures: false, ..study.analysis().clone() }
}

/// Returns the rungs of the model, or the model and its low-fidelity ones, the cheapest first.
pub(super) fn rungs(study: &Study) -> Vec<Rung> {
    let ladder = study.subject().rungs();
    if !ladder.is_empty() {
        return ladder;
    }
    let cheaper = study.low_fidelities().iter().rev().map(|low| Rung {
        name: low.name.clone(),
        subject: low.subject.clone(),
        lines: format!("# the cheaper model `{}` instead of the model\n", low.name),
        is_finest: false,
    });
    let (name, subject) = (study.subject().rung_name(), study.subject().clone());
    cheaper.chain([Rung { name, subject, lines: String::new(), is_finest: true }]).collect()
}
