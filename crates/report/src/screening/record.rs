//! The screening file: JSON that other programs can rely on.
//!
//! Format `apportion-screening`, version 1, described key by key in `docs/reference/other-formats.md`. Later versions of the
//! program only add keys. A number that does not exist is `null`.

use apportion::design::Sampler;
use apportion::model::Model;
use apportion::result::{RunFacts, StudySetup, ValidityRecord};
use apportion::screening::ScreeningSettings;
use apportion::screening::{ScreenedOutput, Screening, ScreeningDesign};
use apportion::space::Distribution;
use apportion::study::Study;
use serde::{Deserialize, Serialize};

use crate::with_unit;

/// A screening.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScreeningFile {
    /// Always `apportion-screening`.
    pub format: String,
    /// Version of the format.
    pub version: u32,
    /// The study.
    pub study: StudySetup,
    /// The method.
    pub provenance: ScreeningProvenance,
    /// The outputs in the order of the study.
    pub outputs: Vec<ScreenedOutput>,
    /// Rows on which the model's assumptions do not hold; these rows are used too.
    pub validity: Vec<ValidityRecord>,
    /// Notes, in sentences.
    pub notes: Vec<String>,
}

/// How a screening was made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScreeningProvenance {
    /// Version of the program.
    pub apportion_version: String,
    /// `radial` or `trajectory`.
    pub design: String,
    /// Where the points of a radial design come from; `null` for trajectories.
    pub sampler: Option<String>,
    /// Levels of the grid of a trajectory design; `null` for others.
    pub levels: Option<u32>,
    /// Shortest step of a radial design, as a part of the range; `null` for others.
    pub shortest_step: Option<f64>,
    /// Trajectories r.
    pub trajectories: u64,
    /// Number of independent parts on which the intervals are based.
    pub parts: u64,
    /// Seed of the design; `null` for points from a table.
    pub seed: Option<u64>,
    /// Runs of the model, r (d + 1).
    pub model_runs: u64,
    /// Runs that failed in at least one output.
    pub failed_runs: u64,
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
    /// The method of the intervals, in words.
    pub interval: String,
    /// Rule for factors that could be fixed: the upper bound of mu* is below this part of the largest mu*.
    pub fixable_below: f64,
}

/// Builds the file of a screening of `study`, whose model is `model`.
pub fn build_screening(study: &Study, model: &dyn Model, screening: &Screening, facts: RunFacts) -> ScreeningFile {
    ScreeningFile {
        format: "apportion-screening".to_owned(),
        version: 1,
        study: study.setup(),
        provenance: provenance(screening, facts),
        outputs: screening.outputs.clone(),
        validity: ValidityRecord::of_flags(model.flags().iter().zip(screening.flags.iter().copied()), screening.runs),
        notes: notes(study),
    }
}

fn provenance(screening: &Screening, facts: RunFacts) -> ScreeningProvenance {
    let Screening { settings, parts, .. } = *screening;
    let sampler = settings.design.sampler();
    let levels = if let ScreeningDesign::Trajectory { levels } = settings.design { Some(levels) } else { None };
    let what = match sampler {
        Some(Sampler::Sobol | Sampler::LatinHypercube) => "randomisations of the design",
        _ if parts == settings.trajectories => "trajectories",
        _ => "equal parts of the trajectories",
    };
    ScreeningProvenance {
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        design: settings.design.name().to_owned(),
        sampler: sampler.map(|sampler| sampler.name().to_owned()),
        levels,
        shortest_step: sampler.map(|_| ScreeningSettings::MIN_STEP),
        trajectories: settings.trajectories,
        parts,
        seed: Some(settings.seed),
        model_runs: screening.runs,
        failed_runs: screening.failed,
        threads: facts.threads,
        wall_seconds: facts.wall_seconds,
        interval: format!("95 % t-interval (delete-one jackknife) from {parts} independent {what}"),
        fixable_below: Screening::FIXABLE,
    }
}

fn notes(study: &Study) -> Vec<String> {
    let (mut bent, mut constant) = (Vec::new(), Vec::new());
    for factor in study.space().factors() {
        match factor.distribution() {
            Distribution::Uniform(_) => (),
            Distribution::Constant(_) => {
                constant.push(format!("{} = {}", factor.name, with_unit(factor.nominal, factor.unit().symbol())));
            }
            law if law.levels().is_none() && !law.is_whole() => bent.push(format!("{} ({})", factor.name, law.name())),
            _ => (),
        }
    }
    let text = "effects are per step in probability, so sigma of factors that are not uniform includes the curvature of their \
                distribution:";
    let notes = [(text, bent), ("constant, hence without effect:", constant)].into_iter();
    let notes = notes.filter(|(_, factors)| !factors.is_empty());
    notes.map(|(text, factors)| format!("{text} {}", factors.join(", "))).collect()
}
