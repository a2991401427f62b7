//! Tables and charts of one command as files, named after the study.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use apportion::report::chart::png;
use apportion::report::{Drawing, listed, prepare_folder, prepare_in, write_in};

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

/// Tells which files were written: the page and the result each by name, many others by their number and folder.
pub fn say_written(files: &[PathBuf]) {
    written(files).iter().for_each(|line| say(line));
}

fn written(files: &[PathBuf]) -> Vec<String> {
    /// So many files are named one by one.
    const FEW: usize = 3;
    let has = |file: &Path, endings: &[&str]| {
        file.extension().is_some_and(|ending| endings.iter().any(|known| ending.eq_ignore_ascii_case(known)))
    };
    let (named, others): (Vec<&PathBuf>, Vec<&PathBuf>) =
        files.iter().partition(|file| files.len() <= FEW || has(file, &["html", "json"]));
    let mut lines: Vec<String> = named.iter().map(|file| format!("wrote {}", file.display())).collect();
    let folders: BTreeSet<Option<&Path>> = others.iter().map(|file| file.parent()).collect();
    for folder in folders {
        let here = || others.iter().filter(|file| file.parent() == folder);
        // A chart as SVG and as PNG is one.
        let charts: BTreeSet<_> = here().filter(|file| has(file, &["svg", "png"])).map(|f| f.file_stem()).collect();
        let tables = here().filter(|file| has(file, &["csv"])).count();
        let rest = here().filter(|file| !has(file, &["svg", "png", "csv"])).count();
        let count = |number: usize, what: &str| {
            (number > 0).then(|| format!("{number} {what}{}", if number == 1 { "" } else { "s" }))
        };
        let kinds = [count(charts.len(), "chart"), count(tables, "table"), count(rest, "file")];
        let kinds: Vec<String> = kinds.into_iter().flatten().collect();
        let folder = folder.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        lines.push(format!("wrote {} to {}", listed(&kinds), folder.display()));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_files_are_three_lines() {
        let all = |names: &[&str]| names.iter().map(|name| Path::new("out").join(name)).collect::<Vec<_>>();
        let few = written(&all(&["y.svg", "y.png"]));
        assert_eq!(few, ["wrote out/y.svg", "wrote out/y.png"]);
        let many = ["s.html", "s.json", "s.csv", "s-convergence.csv", "y.svg", "y.png", "z.svg", "z.png"];
        let many = written(&all(&many));
        assert_eq!(many, ["wrote out/s.html", "wrote out/s.json", "wrote 2 charts and 2 tables to out"]);
    }
}
