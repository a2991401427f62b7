//! `apportion live`: live pages, which hold a study with the engine inside, compiled to WebAssembly (`web/`).

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use apportion::study::Study;
use apportion_files::{ModelKind, edited};
use apportion_report::document::{DataFile, Document, Link, Part, Section, symbols};
use apportion_report::{Subject, output_document, prepare_folder, prepare_outputs, write_atomically};
use askama::Template;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use serde_json::{Value, json};
use toml_edit::{DocumentMut, Item};

use super::output::default_folder;
use super::stop::on_signal;
use super::{DesignChanges, StudyArguments, Threads, say};
use crate::failure::bad_input;

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// The page [default: results/NAME/NAME-live.html]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    threads: Threads,
}

pub fn live(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_with(&arguments.design.overrides())?;
    let live = LiveStudy::new(&study)?;
    let name = live.study.name();
    let path = arguments.out.clone().unwrap_or_else(|| default_folder(name).join(format!("{name}-live.html")));
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        prepare_folder(folder)?;
    }
    prepare_outputs(&study.files(), std::slice::from_ref(&path), arguments.force)?;
    let page = live.page(arguments.threads.number(), on_signal())?;
    write_atomically(&path, page.as_bytes())?;
    say(&format!("wrote {}", path.display()));
    Ok(())
}

/// The engine, compiled to WebAssembly by `web/build.sh`, in gzip, and the licences of what is in it; `None` where `build.rs` did not find it.
#[cfg(page_engine)]
const ENGINE: Option<(&[u8], &str)> = Some((
    include_bytes!("../../../../assets/web/engine.wasm.gz"),
    include_str!("../../../../assets/web/LICENCES.txt"),
));
#[cfg(not(page_engine))]
const ENGINE: Option<(&[u8], &str)> = None;

/// Whether this program can write live pages.
pub const CAN_WRITE_PAGES: bool = ENGINE.is_some();

/// The studies that a page of the nanoparticle offers in addition to its own.
const PRESETS: [(&str, &str); 4] = [
    ("coulomb-dimensional", include_str!("../../../../studies/coulomb-dimensional.toml")),
    ("coulomb-environmental", include_str!("../../../../studies/coulomb-environmental.toml")),
    ("coulomb-general", include_str!("../../../../studies/coulomb-general.toml")),
    ("soft-cantilever", include_str!("../../../../studies/soft-cantilever.toml")),
];

/// Maximum number of factors: each takes two columns of Sobol' points of the 1024 that the engine has in a page.
const MAX_FACTORS: usize = 512;

/// The sections of a result that the page shows, in this order, if the result has them.
const SECTIONS: [&str; 7] = ["warnings", "indices", "shares", "series-1", "interactions", "distribution", "validity"];

#[derive(Template)]
#[template(path = "live/live.html")]
struct Page<'a> {
    page_title: &'a str,
    title: String,
    lead: Vec<String>,
    state: String,
    ranges: String,
    sections: Vec<SectionView<'a>>,
    footer: String,
    /// The studies as JSON, in a script element: without `<`.
    study: String,
    style: String,
    script: String,
    beginning: &'static str,
    worker: &'static str,
    engine: String,
    /// Without the end of the element.
    licences: &'static str,
    version: &'static str,
}

struct SectionView<'a> {
    id: &'a str,
    title: String,
    body: String,
}

impl<'a> SectionView<'a> {
    /// Renders a section of the document; `None` if there is no such section.
    fn new(document: &Document, id: &'a str) -> Option<Self> {
        let section = document.sections.iter().find(|section| section.id == id)?;
        Some(Self { id, title: symbols(&section.title), body: document.section_html(id)? })
    }
}

/// Builds the page of `study`, with its initial result computed on `threads` threads, unless `stop` is set.
///
/// # Errors
/// An error if a page cannot run the study, or its first run fails.
pub fn live_page(study: &Study, threads: usize, stop: &AtomicBool) -> anyhow::Result<String> {
    LiveStudy::new(study)?.page(threads, stop)
}

/// Adds a live `page` to a document, as the file `name` with a section that links to it.
pub fn add_live_page(document: &mut Document, name: &str, page: String) {
    const TITLE: &str = "Try your own ranges";
    let text = "How do the indices change if the factors vary less, or more? A page next to this one recomputes them while a \
                range is dragged; it contains the engine of this program and needs no network.";
    let parts = vec![Part::Text(text.to_owned()), Part::Links(vec![Link::new(TITLE, name)])];
    // Before the sections on the method.
    let is_on_method = |section: &Section| matches!(&*section.id, "cost" | "provenance");
    let place = document.sections.iter().position(is_on_method).unwrap_or(document.sections.len());
    document.sections.insert(place, Section::new(LIVE_SECTION_ID, TITLE, vec![Part::OnPage(parts)]));
    document.files.push(DataFile::new(name, page));
}

/// The anchor of the section that links to a live page.
const LIVE_SECTION_ID: &str = "try";

/// The folder of the study in a page, in which there are no files.
const NO_FOLDER: &str = "no-folder";

/// A study that a page can run: its text has all changes, and any number of base samples.
struct LiveStudy {
    study: Study,
    text: String,
}

impl LiveStudy {
    /// Creates the study of a page from any study.
    ///
    /// # Errors
    /// An error if a page cannot run the study.
    fn new(study: &Study) -> anyhow::Result<Self> {
        let name = study.name();
        let unfit = |why: &str| bad_input(format!("a page cannot run the study {name}: {why}"));
        let kind = ModelKind::from_name(study.subject().name());
        if !kind.is_some_and(is_computed_in_pages) {
            return Err(unfit("its model is neither afm nor a formula nor a known function"));
        }
        let factors = study.space().factors().len();
        if factors > MAX_FACTORS {
            return Err(unfit(&format!("it has {factors} factors, more than {MAX_FACTORS}")));
        }
        let text = without_target(edited(study.source(), study.overrides())?.parse()?);
        let path = Path::new(NO_FOLDER).join(format!("{name}.toml"));
        let study = apportion_files::parse_study(&text, &path, &[]);
        let study = study.map_err(|error| unfit(&format!("it needs other files ({error})")))?;
        Ok(Self { study, text })
    }

    /// Builds the page with the result of a first run.
    fn page(&self, threads: usize, stop: &AtomicBool) -> anyhow::Result<String> {
        let Some((engine, licences)) = ENGINE else {
            anyhow::bail!(
                "live pages need assets/web/engine.wasm.gz, which `just engine` makes: build the program with it"
            );
        };
        let study = &self.study;
        let result = study.runner().threads(threads).stop(stop).run()?;
        let document = output_document(&result, Subject::find(&result, None));
        let title = study.title().unwrap_or(study.name());
        let ranges = ranges(&document);
        let document = document.excerpt(&SECTIONS);
        let page = Page {
            page_title: title,
            title: symbols(title),
            lead: document.lead.iter().map(|text| symbols(text)).collect(),
            state: format!("{} runs of the model by the program.", result.provenance.model_runs),
            ranges,
            sections: SECTIONS.into_iter().filter_map(|id| SectionView::new(&document, id)).collect(),
            footer: symbols(&document.footer),
            // A title may contain the end of the element.
            study: json!({ "presets": self.presets()? }).to_string().replace('<', "\\u003c"),
            style: compact(concat!(
                include_str!("../../../report/templates/page/page.css"),
                include_str!("../../templates/live/live.css")
            )),
            script: compact(concat!(
                include_str!("../../templates/live/live.js"),
                include_str!("../../templates/live/controls.js"),
                include_str!("../../../report/templates/page/charts.js")
            )),
            beginning: include_str!("../../templates/live/begin.js"),
            worker: include_str!("../../templates/live/worker.js"),
            engine: BASE64_STANDARD.encode(engine),
            licences,
            version: env!("CARGO_PKG_VERSION"),
        };
        Ok(page.render()?)
    }

    /// Returns the studies that the page offers: this one, and those of the nanoparticle for one of these.
    fn presets(&self) -> anyhow::Result<Vec<Value>> {
        let (name, title) = (self.study.name(), self.study.title());
        let mut presets = vec![preset(name, title.unwrap_or(name), &self.text)];
        if self.study.subject().name() != ModelKind::AFM.name {
            return Ok(presets);
        }
        for (name, text) in PRESETS {
            let document: DocumentMut = text.parse()?;
            let other = document.get("title").and_then(Item::as_str).map(str::to_owned);
            if other.as_deref() != title {
                let text = without_target(document);
                presets.push(preset(name, other.as_deref().unwrap_or(name), &text));
            }
        }
        Ok(presets)
    }
}

fn is_computed_in_pages(kind: ModelKind) -> bool {
    kind == ModelKind::AFM || kind == ModelKind::EXPRESSION || kind.known.is_some()
}

/// Describes a study for the script of the page.
fn preset(name: &str, title: &str, text: &str) -> Value {
    json!({ "name": name, "title": title, "heading": symbols(title), "text": text })
}

/// Returns the text of a study without the keys that determine the length of a run.
fn without_target(mut study: DocumentMut) -> String {
    for key in ["accuracy", "smallest_region"] {
        study.remove(key);
    }
    if let Some(design) = study.get_mut("design").and_then(Item::as_table_like_mut) {
        for key in ["runs", "max_runs", "max_time"] {
            design.remove(key);
        }
    }
    study.to_string()
}

/// Removes indentation and comment lines from a script or a style, so that a page is below 2 MB.
fn compact(text: &str) -> String {
    let lines = text.lines().map(str::trim_start).filter(|line| !line.is_empty() && !line.starts_with("//"));
    lines.fold(String::new(), |all, line| all + line + "\n")
}

/// Builds the tables of the study, for readers without controls: on paper, and without scripts.
fn ranges(document: &Document) -> String {
    let mut document = document.clone().excerpt(&["study"]);
    for part in document.sections.iter_mut().flat_map(|section| &mut section.parts) {
        if let Part::OnPage(parts) = part {
            parts.retain(|part| matches!(part, Part::Table(_)));
        }
    }
    document.section_html("study").unwrap_or_default()
}
