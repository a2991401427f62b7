//! `apportion report`: the page, tables and charts of a result, without running anything.

use std::path::{Path, PathBuf};

use apportion::result::{ReadError, parse_result};
use apportion_base::files::read_whole;
use apportion_report::{Artefacts, Refusal, run_document};

use super::output::{ChartArguments, deliver};
use super::say;
use crate::failure::bad_input;

#[derive(clap::Args)]
pub struct Arguments {
    /// The result of a run (NAME.json)
    result: PathBuf,
    /// Folder for the page, tables and charts [default: that of the result]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    charts: ChartArguments,
}

pub fn report(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &arguments.result;
    let bytes = read_whole(path).map_err(|error| ReadError { path: path.clone(), problem: error.into() })?;
    let result = parse_result(&bytes).map_err(|problem| ReadError { path: path.clone(), problem })?;
    let folder_of_result = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = arguments.out.as_deref().unwrap_or(folder_of_result);
    let mut document = run_document(&result);
    let name = format!("{}.json", result.study.name);
    // The page links to the result, so an exact copy of it must be next to the page.
    let json = folder.join(&name);
    // Charts of one result must not be mixed with the JSON of another.
    if !arguments.charts.force && read_whole(&json).is_ok_and(|existing| existing != bytes) {
        return Err(Refusal::Exists(json).into());
    }
    let text = String::from_utf8(bytes).map_err(|_| bad_input(format!("{}: not text", path.display())))?;
    document.files.iter_mut().filter(|file| file.name == name).for_each(|file| file.text.clone_from(&text));
    if result.provenance.apportion_version != env!("CARGO_PKG_VERSION") {
        let version = &result.provenance.apportion_version;
        say(&format!("note: the numbers are from apportion {version}; only the page and charts are from this version"));
    }
    deliver(&Artefacts { inputs: vec![path.clone()], ..arguments.charts.artefacts(folder) }, &document)
}
