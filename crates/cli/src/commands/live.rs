//! `apportion live`: live pages, which hold a study with the engine inside, compiled to WebAssembly (`web/`).

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use apportion::result::StudyResult;
use apportion::study::Study;
use apportion_files::{ModelKind, edited};
use apportion_report::document::{DataFile, Document, Link, Part, Section, symbols};
use apportion_report::{TRY, one_output, prepare_file, prepare_folder, run_document, write_atomically};
use askama::Template;
use serde_json::json;
use toml_edit::DocumentMut;

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
        // No file that the study names is read: the document has a section on ranges only if the study names none.
        if self.no_live || document.sections.iter().all(|section| section.id != TRY) {
            return;
        }
        let setup = &result.study;
        let path = PathBuf::from(format!("{}.toml", setup.name));
        let study = apportion_files::parse_study(&setup.source, &path, &setup.overrides);
        let Some(text) = study.ok().and_then(|study| own_text(&study).ok()) else { return };
        let study = apportion_files::parse_study(&text, &path, &[]).map_err(Into::into);
        match study.and_then(|study| page(&study, &text, result)) {
            Ok(page) => place_next_to(document, &file_name(&setup.name), page),
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

/// The engine, compiled to WebAssembly by `web/build.sh`: gzip in base64.
const ENGINE: &str = include_str!("../../../../assets/web/engine.b64");

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
    engine: &'static str,
    version: &'static str,
}

struct SectionView<'a> {
    id: &'a str,
    title: String,
    body: String,
}

/// Builds the page of `study`, with its initial result computed on `threads` threads, unless `stop` is set.
///
/// # Errors
/// An error if a page cannot run the study, or its first run fails.
pub fn live_page(study: &Study, threads: usize, stop: &AtomicBool) -> anyhow::Result<String> {
    let text = own_text(study)?;
    let study = apportion_files::parse_study(&text, Path::new(&format!("{}.toml", study.name())), &[])?;
    let result = study.runner().threads(threads).stop(stop).run()?;
    page(&study, &text, &result)
}

/// Returns the file name of the live page of the study `name`.
pub fn file_name(name: &str) -> String {
    format!("{name}-live.html")
}

/// Adds the live `page` to a document, as the file `name` with a section that links to it; that section replaces the
/// one on how to make a live page.
pub fn place_next_to(document: &mut Document, name: &str, page: String) {
    const TITLE: &str = "Try your own ranges";
    let text = "How do the indices change if the factors vary less, or more? A page next to this one recomputes them while a \
                range is dragged; it contains the engine of this program and needs no network.";
    let parts = vec![Part::Text(text.to_owned()), Part::Links(vec![Link::new(TITLE, name)])];
    document.sections.retain(|section| section.id != TRY);
    // Before the section on how it was made.
    let place = document.sections.iter().position(|section| matches!(&*section.id, "cost" | "provenance"));
    let place = place.unwrap_or(document.sections.len());
    document.sections.insert(place, Section::new(TRY, TITLE, vec![Part::OnPage(parts)]));
    document.files.push(DataFile::new(name, page));
}

/// Returns the text of a study with all changes made, for a page: with any number of base samples, without files.
///
/// # Errors
/// An error if the study cannot be used in a page.
pub fn own_text(study: &Study) -> anyhow::Result<String> {
    let kind = ModelKind::from_name(study.subject().name());
    let computes = |kind: ModelKind| kind == ModelKind::AFM || kind == ModelKind::EXPRESSION || kind.known.is_some();
    let unfit = |why: &str| Err(bad_input(format!("a page cannot run the study {}: {why}", study.name())));
    if !kind.is_some_and(computes) {
        return unfit("its model is neither afm nor a formula nor a known function");
    }
    let factors = study.space().factors().len();
    if factors > MAX_FACTORS {
        return unfit(&format!("it has {factors} factors, more than {MAX_FACTORS}"));
    }
    let text = edited(study.source(), study.overrides())?;
    let text = without_target(&text).unwrap_or(text);
    // Without any files next to it.
    let alone = Path::new("no-such-folder-of-a-page").join(format!("{}.toml", study.name()));
    match apportion_files::parse_study(&text, &alone, &[]) {
        Ok(_) => Ok(text),
        Err(error) => unfit(&format!("it needs other files ({error})")),
    }
}

/// Removes the keys that determine the length of a run.
fn without_target(text: &str) -> Option<String> {
    let mut document: DocumentMut = text.parse().ok()?;
    document.remove("accuracy");
    if let Some(design) = document.get_mut("design").and_then(|design| design.as_table_like_mut()) {
        for key in ["runs", "max_runs", "max_time"] {
            design.remove(key);
        }
    }
    Some(document.to_string())
}

fn page(study: &Study, text: &str, result: &StudyResult) -> anyhow::Result<String> {
    // One output at a time.
    let result = one_output(result, None);
    let document = run_document(&result);
    let title = study.title().unwrap_or(study.name());
    let preset = |name: &str, title: &str, text: &str| json!({ "name": name, "title": title, "heading": symbols(title), "text": text });
    let mut presets = vec![preset(study.name(), title, text)];
    if study.subject().name() == ModelKind::AFM.name {
        for (name, other) in PRESETS {
            let Some(text) = without_target(other) else { continue };
            let other = apportion_files::parse_study(&text, Path::new("preset.toml"), &[])?;
            if other.title() != study.title() {
                presets.push(preset(name, other.title().unwrap_or(name), &text));
            }
        }
    }
    let ranges = ranges(&document);
    let document = document.excerpt(&SECTIONS);
    let section = |id| {
        let section = document.sections.iter().find(|section| section.id == id)?;
        Some(SectionView { id, title: symbols(&section.title), body: document.section_html(id)? })
    };
    let page = Page {
        page_title: title,
        title: symbols(title),
        lead: document.lead.iter().map(|text| symbols(text)).collect(),
        state: format!("{} runs of the model by the program.", result.provenance.model_runs),
        ranges,
        sections: SECTIONS.into_iter().filter_map(section).collect(),
        footer: symbols(&document.footer),
        // A title may contain the end of the element.
        study: json!({ "presets": presets }).to_string().replace('<', "\\u003c"),
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
        engine: ENGINE,
        version: env!("CARGO_PKG_VERSION"),
    };
    Ok(page.render()?)
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
