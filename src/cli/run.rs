//! `apportion run`: a study from file to files.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::analyse;
use apportion::report::chart::{Chart, png};
use apportion::report::{
    OutputRecord, ResultFile, convergence_chart, convergence_csv, distribution_chart, estimators_csv, indices_chart,
    indices_csv, inputs_in_words, interactions_chart, output_stem, prepare_file, prepare_folder, result_json, run_page,
    scatter_chart, second_order_csv, study_chart, summary, write_atomically,
};
use apportion::run::RunError;
use apportion::study::Study;

use super::progress::Meter;
use super::{DesignChanges, Failure, StudyArguments, Threads, print, say};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// Folder for the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    threads: Threads,
}

/// The folder for results of the study called `name`.
pub fn default_folder(name: &str) -> PathBuf {
    Path::new("results").join(name)
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&study.name));
    prepare_folder(&folder)?;
    for file in files(&study) {
        prepare_file(&folder.join(file.name))?;
    }
    let meter = Meter::new(&study.name, study.design.rows());
    let result = analyse(&study, arguments.threads.number(), &|progress| meter.update(progress))
        .map_err(|error| with_inputs(&study, error))?;
    meter.finish(result.provenance.model_runs, result.provenance.wall_seconds);
    let written = write_files(&folder, &study, &result)?;
    print(&summary(&result))?;
    for file in written {
        say(&format!("wrote {}", file.display()));
    }
    let lost: Vec<&str> =
        result.outputs.iter().filter(|output| lost(&study, output)).map(|output| output.name.as_str()).collect();
    if lost.is_empty() {
        return Ok(());
    }
    Err(Failure::Run(anyhow!(
        "no indices of {}: too many runs failed (the result says which and why)",
        lost.join(", ")
    )))
}

/// Whether an output has no indices because runs failed, and not because it does not vary.
fn lost(study: &Study, output: &OutputRecord) -> bool {
    let share = output.runs_failed as f64 / (output.runs_ok + output.runs_failed) as f64;
    let too_many = share > study.analysis.max_failed || output.base_points_used < 2;
    output.indices.is_none() && output.runs_failed > 0 && too_many
}

/// A row that failed is of use to the user by its inputs.
fn with_inputs(study: &Study, error: RunError) -> Failure {
    match &error {
        RunError::RowFailed { row, .. } => {
            Failure::Run(anyhow!("{error}\nthe run's inputs: {}", inputs_in_words(study, *row)))
        }
        RunError::Threads { .. } | RunError::TooManyOutputs { .. } => error.into(),
    }
}

/// A file that a run writes.
pub struct ResultFileName {
    /// Its name in the folder of results.
    pub name: String,
    /// What it holds, in words.
    pub content: &'static str,
    kind: Kind,
}

enum Kind {
    Text(fn(&ResultFile) -> String),
    /// The page, which links to the other files.
    Page,
    /// The chart of the output of that number, as SVG.
    Svg(Draw, usize),
    /// The same as PNG.
    Png(Draw, usize),
}

type Draw = fn(&ResultFile, &OutputRecord) -> Chart;

/// The files that a run of `study` writes.
pub fn files(study: &Study) -> Vec<ResultFileName> {
    let page = format!("{}.html", study.name);
    let mut files = vec![ResultFileName { name: page, content: "the result as a page, to read", kind: Kind::Page }];
    let mut table = |suffix: &str, content, text| {
        let name = format!("{}{suffix}", study.name);
        files.push(ResultFileName { name, content, kind: Kind::Text(text) });
    };
    table(".json", "the result, for programs", result_json);
    table(".csv", "the indices, for spreadsheets", indices_csv);
    if study.analysis.second_order {
        table("-second-order.csv", "the second-order indices of all pairs", second_order_csv);
    }
    if !study.analysis.estimators.is_empty() {
        table("-estimators.csv", "the indices by the other estimators", estimators_csv);
    }
    table("-convergence.csv", "the indices at every stage of the run", convergence_csv);
    let charts: [(&str, &str, Draw); 6] = [
        ("", "chart of the shares", study_chart),
        ("-indices", "chart of the first-order and total indices", indices_chart),
        ("-interactions", "chart of first-order against total indices", interactions_chart),
        ("-scatter", "chart of the output against its factors", scatter_chart),
        ("-distribution", "chart of the output's distribution", distribution_chart),
        ("-convergence", "chart of how the indices settled", convergence_chart),
    ];
    let model = study.model();
    for (number, output) in model.outputs().iter().enumerate() {
        let stem = output_stem(&study.name, &output.name, model.outputs().len());
        for (suffix, content, draw) in charts {
            let name = format!("{stem}{suffix}.svg");
            files.push(ResultFileName { name, content, kind: Kind::Svg(draw, number) });
            let name = format!("{stem}{suffix}.png");
            files.push(ResultFileName { name, content: "the same as a picture", kind: Kind::Png(draw, number) });
        }
    }
    files
}

fn write_files(folder: &Path, study: &Study, result: &ResultFile) -> Result<Vec<PathBuf>, Failure> {
    let drawn = |draw: Draw, number: usize| {
        draw(result, &result.outputs[number]).svg().map_err(|error| Failure::Run(error.into()))
    };
    let files = files(study);
    let others = files.iter().filter(|file| !matches!(file.kind, Kind::Page)).map(|file| file.name.clone());
    let others: Vec<String> = others.collect();
    let mut written = Vec::with_capacity(files.len());
    for file in files {
        let bytes = match file.kind {
            Kind::Page => run_page(result, &others).html().map_err(|error| Failure::Run(error.into()))?.into_bytes(),
            Kind::Text(text) => text(result).into_bytes(),
            Kind::Svg(draw, number) => drawn(draw, number)?.into_bytes(),
            Kind::Png(draw, number) => png(&drawn(draw, number)?).map_err(|error| Failure::Run(error.into()))?.bytes,
        };
        let path = folder.join(file.name);
        write_atomically(&path, &bytes)?;
        written.push(path);
    }
    Ok(written)
}
