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
    prepare_results(&study, &folder)?;
    let meter = Meter::new(&study.name, study.design.rows());
    let result = analyse(&study, arguments.threads.number(), &|progress| meter.update(progress))
        .map_err(|error| with_inputs(&study, error))?;
    meter.finish(result.provenance.model_runs, result.provenance.wall_seconds);
    report_result(&study, &folder, &result)
}

/// Writes the files of `result`, prints its summary, and fails if outputs have no indices because runs failed.
pub fn report_result(study: &Study, folder: &Path, result: &ResultFile) -> Result<(), Failure> {
    let written = write_files(folder, &files(study), result)?;
    print(&summary(result))?;
    for file in written {
        say(&format!("wrote {}", file.display()));
    }
    let lost: Vec<&str> =
        result.outputs.iter().filter(|output| lost(study, output)).map(|output| output.name.as_str()).collect();
    if lost.is_empty() {
        return Ok(());
    }
    Err(Failure::Run(anyhow!(
        "no indices of {}: too many runs failed (the result says which and why)",
        lost.join(", ")
    )))
}

/// Makes sure that the files of a result can be written.
pub fn prepare_results(study: &Study, folder: &Path) -> Result<(), Failure> {
    prepare_folder(folder)?;
    for file in files(study) {
        prepare_file(&folder.join(file.name))?;
    }
    Ok(())
}

/// Whether an output has no indices because runs failed, and not because it does not vary.
fn lost(study: &Study, output: &OutputRecord) -> bool {
    let share = output.runs_failed as f64 / (output.runs_ok + output.runs_failed) as f64;
    let too_many = share > study.analysis.max_failed || output.base_points_used < 2;
    output.indices.is_none() && output.runs_failed > 0 && too_many
}

/// A row that failed is of use to the user by its inputs.
pub fn with_inputs(study: &Study, error: RunError) -> Failure {
    match &error {
        RunError::RowFailed { row, .. } => {
            Failure::Run(anyhow!("{error}\nthe run's inputs: {}", inputs_in_words(study, *row)))
        }
        _ => error.into(),
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

impl ResultFileName {
    /// Whether it is the result itself, from which all others can be drawn.
    pub fn is_result(&self) -> bool {
        matches!(self.kind, Kind::Result)
    }
}

enum Kind {
    /// The result itself.
    Result,
    Text(fn(&ResultFile) -> String),
    /// The page, which links to the other files.
    Page,
    /// The chart of the output of that number, as SVG.
    Svg(Draw, usize),
    /// The same as PNG.
    Png(Draw, usize),
}

type Draw = fn(&ResultFile, &OutputRecord) -> Chart;

/// What decides which files there are.
pub struct Contents<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Names of the outputs.
    pub outputs: Vec<&'a str>,
    /// Whether there are second-order indices.
    pub second_order: bool,
    /// Whether there are indices by other estimators.
    pub estimators: bool,
}

/// The files that a run of `study` writes.
pub fn files(study: &Study) -> Vec<ResultFileName> {
    let model = study.model();
    files_of(&Contents {
        name: &study.name,
        outputs: model.outputs().iter().map(|output| &*output.name).collect(),
        second_order: study.analysis.second_order,
        estimators: !study.analysis.estimators.is_empty(),
    })
}

/// The files of a result with these contents.
pub fn files_of(contents: &Contents<'_>) -> Vec<ResultFileName> {
    let Contents { name: study, outputs, .. } = contents;
    let file = |name: String, content, kind| ResultFileName { name, content, kind };
    let mut files = vec![
        file(format!("{study}.html"), "the result as a page, to read", Kind::Page),
        file(format!("{study}.json"), "the result, for programs", Kind::Result),
    ];
    let mut table =
        |suffix: &str, content, text| files.push(file(format!("{study}{suffix}"), content, Kind::Text(text)));
    table(".csv", "the indices, for spreadsheets", indices_csv);
    if contents.second_order {
        table("-second-order.csv", "the second-order indices of all pairs", second_order_csv);
    }
    if contents.estimators {
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
    for (number, output) in outputs.iter().enumerate() {
        let stem = output_stem(study, output, outputs.len());
        for (suffix, content, draw) in charts {
            files.push(file(format!("{stem}{suffix}.svg"), content, Kind::Svg(draw, number)));
            files.push(file(format!("{stem}{suffix}.png"), "the same as a picture", Kind::Png(draw, number)));
        }
    }
    files
}

/// Writes `files` of `result` to `folder`; the page links to all of them.
pub fn write_files(folder: &Path, files: &[ResultFileName], result: &ResultFile) -> Result<Vec<PathBuf>, Failure> {
    write_selected(folder, files, (result, &|_| true))
}

/// Writes those of `files` that are `wanted`; the page links to all of them.
pub fn write_selected(
    folder: &Path,
    files: &[ResultFileName],
    (result, wanted): (&ResultFile, &dyn Fn(&ResultFileName) -> bool),
) -> Result<Vec<PathBuf>, Failure> {
    let drawn = |draw: Draw, number: usize| {
        draw(result, &result.outputs[number]).svg().map_err(|error| Failure::Run(error.into()))
    };
    let others = files.iter().filter(|file| !matches!(file.kind, Kind::Page)).map(|file| file.name.clone());
    let others: Vec<String> = others.collect();
    let mut written = Vec::with_capacity(files.len());
    for file in files.iter().filter(|file| wanted(file)) {
        let bytes = match file.kind {
            Kind::Page => run_page(result, &others).html().map_err(|error| Failure::Run(error.into()))?.into_bytes(),
            Kind::Result => result_json(result).into_bytes(),
            Kind::Text(text) => text(result).into_bytes(),
            Kind::Svg(draw, number) => drawn(draw, number)?.into_bytes(),
            Kind::Png(draw, number) => png(&drawn(draw, number)?).map_err(|error| Failure::Run(error.into()))?.bytes,
        };
        let path = folder.join(&file.name);
        write_atomically(&path, &bytes)?;
        written.push(path);
    }
    Ok(written)
}
