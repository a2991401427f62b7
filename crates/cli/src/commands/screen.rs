//! `apportion screen`: which of many factors matter, for a few runs each.

use std::time::Instant;

use apportion::design::Sampler;
use apportion::result::RunFacts;
use apportion::run::threads_in_force;
use apportion::screening::{ScreeningDesign, ScreeningSettings, movers};
use apportion::study::Study;
use apportion_report::screening::{build_screening, screening_document};

use super::journal::{JournalArguments, with_journal};
use super::output::{OutputArguments, deliver};
use super::progress::Meter;
use super::{StudyArguments, Threads, say, whole_number};
use crate::failure::bad_input;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Number of trajectories; each costs (1 + factors) runs, or (1 + groups)
    #[arg(long, value_name = "R", default_value_t = 32, allow_negative_numbers = true)]
    trajectories: u64,
    /// Design of the points: radial (Campolongo et al. 2011, by the study's sampler), or trajectory (Morris 1991)
    #[arg(long, default_value = "radial", value_parser = ["radial", "trajectory"])]
    design: String,
    /// Levels of the trajectory design's grid, an even number [default: 4]
    #[arg(long, value_name = "P", value_parser = clap::value_parser!(u32).range(2..=i64::from(ScreeningSettings::MAX_LEVELS)))]
    levels: Option<u32>,
    /// Seed of the points [default: the study's]
    #[arg(long, value_name = "S", value_parser = whole_number, allow_negative_numbers = true)]
    seed: Option<u64>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    threads: Threads,
    #[command(flatten)]
    journal: JournalArguments,
}

impl Arguments {
    fn settings(&self, study: &Study) -> anyhow::Result<ScreeningSettings> {
        let in_study = study.design().settings();
        if let (Some(levels), "radial") = (self.levels, &*self.design) {
            let message = "--levels has no effect on the radial design: add --design trajectory";
            return Err(bad_input(format!("--levels {levels}: {message}")));
        }
        let design = screening_design(&self.design, self.levels, in_study.sampler);
        let seed = self.seed.unwrap_or(in_study.seed);
        Ok(ScreeningSettings { design, trajectories: self.trajectories, seed })
    }
}

/// The design of that name.
pub fn screening_design(name: &str, levels: Option<u32>, sampler: Sampler) -> ScreeningDesign {
    match name {
        "trajectory" => ScreeningDesign::Trajectory { levels: levels.unwrap_or(4) },
        _ => ScreeningDesign::Radial { sampler },
    }
}

pub fn screen(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&[])?;
    let settings = arguments.settings(&study)?;
    let stepping = movers(&study).len();
    let (in_force, _) = settings.in_force(stepping)?;
    if in_force.trajectories != settings.trajectories {
        let (requested, used) = (settings.trajectories, in_force.trajectories);
        say(&format!("note: {requested} trajectories do not make equal parts for the intervals: {used} are used"));
    }
    let model = study.model();
    let artefacts = arguments.output.prepared(&study, "-screen", Some(&arguments.journal))?;
    let journal = artefacts.journal.as_deref();
    let runs = in_force.trajectories * (stepping as u64 + 1);
    let meter = Meter::new(study.name(), runs);
    let start = Instant::now();
    let runner = study.runner().threads(arguments.threads.number()).on_progress(|progress| meter.update(progress));
    let screening = arguments.journal.keep(runner, journal).screen(settings);
    let screening = screening.map_err(|error| with_journal(error, journal))?;
    let threads = threads_in_force(arguments.threads.number());
    let facts = RunFacts { threads, wall_seconds: start.elapsed().as_secs_f64() };
    meter.finish(screening.runs, facts.wall_seconds);
    let file = build_screening(&study, model.as_ref(), &screening, facts);
    deliver(&artefacts, &screening_document(&file))
}
