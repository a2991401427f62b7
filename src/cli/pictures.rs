//! Tables and charts of one command as files, named after the study.

use std::path::{Path, PathBuf};

use apportion::report::chart::png;
use apportion::report::{Drawing, prepare_folder, prepare_in, write_in};

use super::{Failure, say, stop};

/// Makes the folder and checks that each of `files` in it can be written.
pub fn prepare(folder: &Path, files: &[String]) -> Result<(), Failure> {
    prepare_folder(folder)?;
    for file in files {
        prepare_in(folder, file)?;
    }
    Ok(())
}

/// Writes tables, each with the ending of its file, and charts as SVG and PNG; gives the files in order.
pub fn write(
    folder: &Path,
    name: &str,
    (tables, charts): (&[(&str, String)], &[Drawing]),
) -> Result<Vec<PathBuf>, Failure> {
    stop::writing()?;
    let mut written = Vec::with_capacity(tables.len() + 2 * charts.len());
    let mut put = |ending: &str, bytes: &[u8]| -> Result<(), Failure> {
        stop::unless_stopped()?;
        written.push(write_in(folder, &format!("{name}{ending}"), bytes)?);
        Ok(())
    };
    for (ending, text) in tables {
        put(ending, text.as_bytes())?;
    }
    for chart in charts {
        let svg = chart.chart.svg().map_err(|error| Failure::Run(error.into()))?;
        let picture = png(&svg).map_err(|error| Failure::Run(error.into()))?;
        put(&format!("{}.svg", chart.suffix), svg.as_bytes())?;
        put(&format!("{}.png", chart.suffix), &picture.bytes)?;
    }
    Ok(written)
}

/// Tells which files were written.
pub fn say_written(files: &[PathBuf]) {
    for file in files {
        say(&format!("wrote {}", file.display()));
    }
}
