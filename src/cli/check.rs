//! `apportion check`: what a study means and what it will cost, without running it.

use std::path::PathBuf;
use std::time::Instant;

use apportion::design::{Design, DesignSettings};
use apportion::report::{significant, table, with_unit};
use apportion::run::{BLOCK, Job, run};
use apportion::study::Study;

use super::run::{default_folder, file_names};
use super::{DesignChanges, Failure, StudyArguments, print};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// Folder for the results of a run [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn check(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&study.name));
    let mut text = subject(&study);
    text.push_str(&factors(&study));
    text.push_str(&design(&study)?);
    let model = study.model();
    let outputs: Vec<&str> = model.outputs().iter().map(|output| &*output.name).collect();
    text.push_str(&format!("\nwill be written to {}:\n", folder.display()));
    for (name, content) in file_names(&study.name, &outputs) {
        text.push_str(&format!("  {name}  {content}\n"));
    }
    print(&text)
}

fn subject(study: &Study) -> String {
    let mut text = format!("study {}", study.name);
    if let Some(title) = &study.title {
        text.push_str(&format!(": {title}"));
    }
    text.push_str(&format!("\nmodel {}: {}\n", study.subject.kind().name(), study.subject.kind().description()));
    for (name, value) in study.settings() {
        text.push_str(&format!("  {name} = {}\n", shortened(&value)));
    }
    let model = study.model();
    let outputs: Vec<String> = model.outputs().iter().map(|o| format!("{} [{}]", o.name, o.unit)).collect();
    text.push_str(&format!("outputs: {}\n", outputs.join(", ")));
    let constants: Vec<String> = study
        .constants()
        .into_iter()
        .map(|(name, value, unit)| format!("{name} = {}", with_unit(value, &unit)))
        .collect();
    if !constants.is_empty() {
        text.push_str(&format!("fixed: {}\n", constants.join(", ")));
    }
    text.push('\n');
    text
}

/// A value as it is written in a study file, a long list by its beginning and its length.
fn shortened(value: &serde_json::Value) -> String {
    const SHOWN: usize = 12;
    match value.as_array() {
        Some(list) if list.len() > SHOWN => {
            let entries: Vec<String> = list.iter().take(SHOWN).map(ToString::to_string).collect();
            format!("[{}, ... {} in all]", entries.join(", "), list.len())
        }
        _ => value.to_string(),
    }
}

fn factors(study: &Study) -> String {
    let mut table = table(
        &["factor", "distribution", "mean", "sd", "5 %", "median", "95 %", "nominal", "unit", "group"],
        &[0, 1, 8, 9],
    );
    for factor in study.space.factors() {
        let law = factor.distribution();
        let quantile = |u| significant(law.quantile(u));
        table.add_row([
            factor.name.clone(),
            law.name().to_owned(),
            significant(law.mean()),
            significant(law.sd()),
            quantile(0.05),
            quantile(0.5),
            quantile(0.95),
            significant(factor.nominal),
            factor.unit().to_string(),
            factor.group.clone().unwrap_or_default(),
        ]);
    }
    format!("{table}\n")
}

fn design(study: &Study) -> Result<String, Failure> {
    let design = &study.design;
    let settings = design.settings();
    let groups = study.space.groups().len();
    let mut text = format!(
        "\ndesign: {} points, {} base samples in {} replicates of {}, seed {}\n\
         cost: {} base samples x (2 + {} factors{}) = {} model runs",
        settings.sampler.name(),
        settings.base_samples,
        settings.replicates,
        design.points_per_replicate(),
        settings.seed,
        settings.base_samples,
        design.factors(),
        if groups > 0 { format!(" + {groups} groups") } else { String::new() },
        design.rows(),
    );
    let pilot = pilot(study)?;
    text.push_str(&format!(", about {} on this machine (by {} runs of it)\n", duration(pilot.seconds), pilot.runs));
    text.push_str(&format!(
        "memory: about {:.0} kB a thread for the columns of a block, whatever the number of samples\n",
        kilobytes_per_thread(study)
    ));
    if !design.balanced() {
        text.push_str(
            "warning: the points of a replicate are not a power of two: Sobol' points lose much of their accuracy\n",
        );
    }
    if settings.replicates == 1 {
        text.push_str("warning: a single replicate says nothing about its error: there will be no intervals\n");
    }
    Ok(text)
}

/// A few runs of the study's model, and how long the whole design would take by them.
struct Pilot {
    runs: u64,
    seconds: f64,
}

/// Runs ever larger first parts of the design until they take long enough to be measured, or are all of it.
fn pilot(study: &Study) -> Result<Pilot, Failure> {
    const ENOUGH: f64 = 0.1;
    let model = study.model();
    let mut points = 2;
    loop {
        let settings = DesignSettings { base_samples: points, replicates: 1, ..study.design.settings().clone() };
        let design = Design::new(settings, study.design.factors(), study.design.asked().clone())
            .map_err(|error| Failure::Input(error.into()))?;
        let start = Instant::now();
        run(Job { design: &design, space: &study.space, model: model.as_ref() }, 0, &|_| ())?;
        let seconds = start.elapsed().as_secs_f64();
        if seconds >= ENOUGH || points >= study.design.settings().base_samples {
            let share = study.design.rows() as f64 / design.rows() as f64;
            return Ok(Pilot { runs: design.rows(), seconds: seconds * share });
        }
        points *= 4;
    }
}

/// Columns of the factors (unit cube and SI, A and B) and of every output of every row kind.
fn kilobytes_per_thread(study: &Study) -> f64 {
    let outputs = study.model().outputs().len() as u64;
    let columns = 4 * study.design.factors() as u64 + study.design.rows_per_point() * (outputs + 1);
    (columns * BLOCK * 8) as f64 / 1e3
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => "0.1 s or less".to_owned(),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.1} hours", s / 3600.0),
    }
}
