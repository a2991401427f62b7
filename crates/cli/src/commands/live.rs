//! `apportion live`: a study as a live page.

use std::path::PathBuf;

use apportion::result::StudyResult;
use apportion_report::document::Document;
use apportion_report::{prepare_file, prepare_folder, write_atomically};

use super::output::default_folder;
use super::stop::on_signal;
use super::{DesignChanges, StudyArguments, Threads, say};
use crate::live::{file_name, live_page, own_text, page_of_result, place_next_to};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// The page [default: results/NAME/NAME-live.html]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    threads: Threads,
}

/// The live page next to the page of a result, which links to it.
#[derive(Default, clap::Args)]
pub struct LiveArguments {
    /// Do not write the interactive page (NAME-live.html, 2 MB), which is written if a page can run the study
    #[arg(long)]
    no_live: bool,
}

impl LiveArguments {
    /// Adds the page to the `document` of `result`, if there is to be one. Without it the result is whole still.
    pub fn place_next_to(&self, document: &mut Document, result: &StudyResult) {
        if self.no_live {
            return;
        }
        match page_of_result(document, result) {
            Ok(Some(page)) => place_next_to(document, &file_name(&result.study.name), page),
            Ok(None) => (),
            Err(error) => say(&format!("note: no interactive page: {error}")),
        }
    }
}

pub fn live(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    own_text(&study)?;
    let name = study.name();
    let path = arguments.out.clone().unwrap_or_else(|| default_folder(name).join(file_name(name)));
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        prepare_folder(folder)?;
    }
    prepare_file(&path)?;
    let page = live_page(&study, arguments.threads.number(), on_signal())?;
    write_atomically(&path, page.as_bytes())?;
    say(&format!("wrote {}", path.display()));
    Ok(())
}
