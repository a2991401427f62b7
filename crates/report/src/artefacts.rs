//! The files of a document and how they are written.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use apportion_base::digest::sha256;
use rayon::prelude::*;
use thiserror::Error;

use super::atomic_write::{WriteError, prepare_folder, write_atomically};
use super::chart::ChartWidth;
#[cfg(feature = "pdf")]
use super::chart::pdf;
#[cfg(feature = "png")]
use super::chart::png;
use super::document::{DataFile, Document};
use super::file_names::{CHARTS, ChartFormat};
use super::outputs::{FileList, Refusal, check_outputs};

/// Why the files of a document were not written.
#[derive(Debug, Error)]
pub enum ArtefactError {
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A chart cannot be drawn in a format.
    #[error("cannot draw {file}: {source}")]
    Chart {
        /// The chart.
        file: String,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A file may not be written.
    #[error("{0}")]
    Refused(#[from] Refusal),
    /// The flag to stop was set.
    #[error("interrupted while writing files: existing files are complete, others are missing")]
    Stopped,
}

/// The destination of a document's files: a folder with the page and the data files, and `charts` below it.
///
/// # Example
/// ```
/// use std::path::Path;
/// use apportion_report::{Artefacts, run_document};
/// use apportion::Study;
///
/// let study = apportion_files::parse_study(include_str!("../../../studies/ishigami.toml"), Path::new("ishigami.toml"), &[])?;
/// let result = study.run()?;
/// let folder = tempfile::tempdir()?;
/// let written = Artefacts::new(folder.path()).write(&run_document(&result))?;
/// assert_eq!(written.page, folder.path().join("ishigami.html"));
/// assert!(folder.path().join("ishigami.json").exists());
/// assert!(folder.path().join("charts/ishigami-indices.svg").exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Artefacts {
    /// The folder.
    pub folder: PathBuf,
    /// The formats of the chart files.
    pub formats: Vec<ChartFormat>,
    /// The width of the chart files.
    pub width: ChartWidth,
    /// The files that the command reads: none of them is ever written.
    pub inputs: Vec<PathBuf>,
    /// A file that the command writes before those of the document.
    pub other: Option<PathBuf>,
    /// A journal that the command reads and writes.
    pub journal: Option<PathBuf>,
    /// Whether existing files are replaced that are not unchanged files of the document.
    pub replaces: bool,
}

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The page.
    pub page: PathBuf,
    /// The data files.
    pub data: Vec<PathBuf>,
    /// The folder of the charts and the number of charts; `None` if no chart was written.
    pub charts: Option<(PathBuf, usize)>,
}

impl Artefacts {
    /// Creates the destination `folder`, with charts as SVG and PNG.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self {
            folder: folder.into(),
            formats: vec![ChartFormat::Svg, ChartFormat::Png],
            width: ChartWidth::Wide,
            inputs: Vec::new(),
            other: None,
            journal: None,
            replaces: false,
        }
    }

    /// Creates the folder and checks that the files of a document called `name` can be written to it, so that a run
    /// fails at its start and not at its end.
    ///
    /// # Errors
    /// [`ArtefactError`] with the reason.
    pub fn prepare(self, name: &str) -> Result<Self, ArtefactError> {
        prepare_folder(&self.folder)?;
        let files = USUAL_ENDINGS.iter().map(|ending| self.folder.join(format!("{name}{ending}")));
        let files = self.journal.iter().chain(&self.other).cloned().chain(files).collect();
        self.check(files, &FileList::read(&self.folder, name))?;
        Ok(self)
    }

    /// Refuses files that may not be written.
    fn check(&self, files: Vec<PathBuf>, list: &FileList) -> Result<(), Refusal> {
        let replaces = |path: &Path| self.replaces || self.journal.as_deref() == Some(path) || list.contains(path);
        check_outputs(&self.inputs, &files, &replaces)
    }

    /// Writes all files of `document`: the page last, since it links to the others.
    ///
    /// # Errors
    /// [`ArtefactError`] if a chart cannot be drawn or a file cannot be written; files already written are kept.
    pub fn write(&self, document: &Document) -> Result<Written, ArtefactError> {
        self.write_until(document, &AtomicBool::new(false))
    }

    /// Writes all files of `document` until `stop` is set.
    ///
    /// # Errors
    /// As for [`write`](Self::write), and [`ArtefactError::Stopped`].
    pub fn write_until(&self, document: &Document, stop: &AtomicBool) -> Result<Written, ArtefactError> {
        if stop.load(Ordering::SeqCst) {
            return Err(ArtefactError::Stopped);
        }
        prepare_folder(&self.folder)?;
        let figures: Vec<_> = document.figures().into_iter().filter(|figure| !figure.stem.is_empty()).collect();
        let has_charts = !figures.is_empty() && !self.formats.is_empty();
        let charts = self.folder.join(CHARTS);
        if has_charts || document.data_names().iter().any(|name| name.contains('/')) {
            prepare_folder(&charts)?;
        }
        let of_figures =
            figures.iter().flat_map(|figure| self.formats.iter().map(|format| chart_file(&figure.stem, *format)));
        let page_name = format!("{}.html", document.name);
        let data = document.data_files();
        // A copy of what is there replaces nothing.
        let existing = |file: &DataFile| std::fs::read(self.folder.join(&file.name)).unwrap_or_default();
        let of_data = data.iter().filter(|file| existing(file) != file.text.as_bytes()).map(|file| file.name.clone());
        let names = of_data.chain(of_figures).chain([page_name.clone()]);
        let files: Vec<PathBuf> = names.map(|name| self.folder.join(name)).collect();
        let list = FileList::open(&self.folder, &document.name)?;
        self.check(files, &list)?;
        let data = data.iter().map(|file| self.put(&file.name, stop, file.text.as_bytes(), &list));
        let data = data.collect::<Result<_, _>>()?;
        figures.par_iter().try_for_each(|figure| {
            if self.formats.is_empty() || stop.load(Ordering::SeqCst) {
                return Ok(());
            }
            let svg = figure.chart.svg_at(self.width);
            self.formats.iter().try_for_each(|format| {
                let file = chart_file(&figure.stem, *format);
                let picture = picture(&svg, *format)
                    .map_err(|source| ArtefactError::Chart { file: figure.stem.clone(), source })?;
                self.put(&file, stop, &picture, &list).map(drop)
            })
        })?;
        let page = document.html_in_folder(&self.formats);
        let page = self.put(&page_name, stop, page.as_bytes(), &list)?;
        Ok(Written { page, data, charts: has_charts.then_some((charts, figures.len())) })
    }

    /// Writes the file at `path` below the folder and returns its location.
    fn put(&self, path: &str, stop: &AtomicBool, bytes: &[u8], list: &FileList) -> Result<PathBuf, ArtefactError> {
        if stop.load(Ordering::SeqCst) {
            return Err(ArtefactError::Stopped);
        }
        let path = self.folder.join(path);
        list.add(&path, &sha256(bytes)).map_err(|source| WriteError { path: path.clone(), source })?;
        write_atomically(&path, bytes)?;
        Ok(path)
    }
}

/// Endings of the files that documents have, as far as these are known before a run.
const USUAL_ENDINGS: [&str; 7] =
    [".html", ".json", ".csv", "-convergence.csv", "-second-order.csv", "-measures.csv", "-estimators.csv"];

fn chart_file(stem: &str, format: ChartFormat) -> String {
    format!("{CHARTS}/{stem}.{}", format.name())
}

/// Converts a chart to a format; the error says why it cannot.
fn picture(svg: &str, format: ChartFormat) -> Result<Cow<'_, [u8]>, Box<dyn std::error::Error + Send + Sync>> {
    match format {
        ChartFormat::Svg => Ok(Cow::Borrowed(svg.as_bytes())),
        #[cfg(feature = "png")]
        ChartFormat::Png => Ok(Cow::Owned(png(svg)?)),
        #[cfg(feature = "pdf")]
        ChartFormat::Pdf => Ok(Cow::Owned(pdf(svg)?)),
        #[cfg(not(all(feature = "png", feature = "pdf")))]
        other => Err(format!("this build lacks the feature `{}`", other.name()).into()),
    }
}
