//! `apportion report`: the page, tables and charts of a result, without running anything.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::files::read_whole;
use apportion::report::{
    ReadError, ReadProblem, ResultFile, parse_result, prepare_folder, prepare_in, summary, write_atomically,
};

use super::pictures::say_written;
use super::run::{Contents, files_of, write_selected};
use super::{Failure, print, say};

#[derive(clap::Args)]
pub struct Arguments {
    /// The result of a run (NAME.json)
    result: PathBuf,
    /// Folder for what is drawn [default: that of the result]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn report(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.result;
    let wrong = |problem: ReadProblem| ReadError { path: path.clone(), problem };
    let bytes = read_whole(path).map_err(|error| wrong(error.into()))?;
    let result = parse_result(&bytes).map_err(wrong)?;
    let beside = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = arguments.out.as_deref().unwrap_or(beside);
    let files = files_of(&contents(&result));
    // The page links to the result, so it must lie beside it: this one, word for word.
    let json = files.iter().find(|file| file.is_result()).map(|file| folder.join(&file.name));
    let copy = json.filter(|json| !same_file(json, path));
    if let Some(json) = &copy {
        refuse_another(json, &bytes)?;
    }
    prepare_folder(folder)?;
    for file in &files {
        prepare_in(folder, &file.name)?;
    }
    let mut written = write_selected(folder, &files, (&result, &|file| !file.is_result()))?;
    if let Some(json) = copy {
        write_atomically(&json, &bytes)?;
        written.push(json);
    }
    print(&summary(&result))?;
    if result.provenance.apportion_version != env!("CARGO_PKG_VERSION") {
        let version = &result.provenance.apportion_version;
        say(&format!("note: the numbers are those of apportion {version}; only the drawing is this version's"));
    }
    say_written(&written);
    Ok(())
}

fn contents(result: &ResultFile) -> Contents<'_> {
    let outputs = &result.outputs;
    Contents {
        name: &result.study.name,
        outputs: outputs.iter().map(|output| output.name.as_str()).collect(),
        second_order: outputs.iter().any(|output| output.second_order.is_some()),
        estimators: outputs.iter().any(|output| !output.estimators.is_empty()),
    }
}

fn same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Charts of one result must not come to lie beside the JSON of another.
fn refuse_another(json: &Path, bytes: &[u8]) -> Result<(), Failure> {
    match read_whole(json) {
        Ok(there) if there != bytes => {
            let message =
                "is another result, whose page and charts would be overwritten: give another folder with --out";
            Err(Failure::Input(anyhow!("{} {message}", json.display())))
        }
        _ => Ok(()),
    }
}
