//! `apportion run`: a study from file to files.

use std::path::{Path, PathBuf};

use apportion::analyse;
use apportion::report::chart::png;
use apportion::report::{
    ResultFile, indices_csv, prepare_file, prepare_folder, result_json, study_chart, summary, write_atomically,
};

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
    let model = study.model();
    let outputs: Vec<&str> = model.outputs().iter().map(|output| &*output.name).collect();
    for (name, _) in file_names(&study.name, &outputs) {
        prepare_file(&folder.join(name))?;
    }
    let meter = Meter::new(&study.name, study.design.rows());
    let result = analyse(&study, arguments.threads.number(), &|progress| meter.update(progress))?;
    meter.finish(result.provenance.model_runs, result.provenance.wall_seconds);
    let files = write_files(&folder, &result)?;
    print(&summary(&result))?;
    for file in files {
        say(&format!("wrote {}", file.display()));
    }
    Ok(())
}

/// The files a run of the study called `name` writes, with what they hold.
pub fn file_names(name: &str, outputs: &[&str]) -> Vec<(String, &'static str)> {
    let charts = outputs.iter().flat_map(|output| {
        let stem = if outputs.len() == 1 { name.to_owned() } else { format!("{name}-{output}") };
        [(format!("{stem}.svg"), "chart of the shares"), (format!("{stem}.png"), "the same as a picture")]
    });
    let tables = [
        (format!("{name}.json"), "the result, for programs"),
        (format!("{name}.csv"), "the indices, for spreadsheets"),
    ];
    tables.into_iter().chain(charts).collect()
}

fn write_files(folder: &Path, result: &ResultFile) -> Result<Vec<PathBuf>, Failure> {
    let outputs: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
    let names = file_names(&result.study.name, &outputs);
    let files: Vec<PathBuf> = names.iter().map(|(name, _)| folder.join(name)).collect();
    write_atomically(&files[0], result_json(result).as_bytes())?;
    write_atomically(&files[1], indices_csv(result).as_bytes())?;
    for (output, pair) in result.outputs.iter().zip(files[2..].chunks_exact(2)) {
        let svg = study_chart(result, output).map_err(|error| Failure::Run(error.into()))?;
        write_atomically(&pair[0], svg.as_bytes())?;
        let picture = png(&svg).map_err(|error| Failure::Run(error.into()))?;
        write_atomically(&pair[1], &picture.bytes)?;
    }
    Ok(files)
}
