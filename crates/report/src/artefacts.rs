//! The files of a document and how they are written.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use thiserror::Error;

use super::atomic_write::{WriteError, prepare_folder, write_atomically};
use super::chart::ChartWidth;
#[cfg(feature = "pdf")]
use super::chart::pdf;
#[cfg(feature = "png")]
use super::chart::png;
use super::document::Document;
use super::file_names::{CHARTS, ChartFormat};

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
    /// A file would replace one that must be kept.
    #[error("{path}: this is the input file; choose another folder", path = path.display())]
    Input {
        /// The file.
        path: PathBuf,
    },
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
    folder: PathBuf,
    formats: Vec<ChartFormat>,
    width: ChartWidth,
    input: Option<PathBuf>,
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
            input: None,
        }
    }

    /// Sets the formats of the chart files; an empty list means no charts.
    pub fn with_charts(self, formats: &[ChartFormat]) -> Self {
        Self { formats: formats.to_vec(), ..self }
    }

    /// Sets the width of the chart files; the charts on the page do not change.
    pub fn with_width(self, width: ChartWidth) -> Self {
        Self { width, ..self }
    }

    /// Sets the input file, which is never overwritten.
    pub fn next_to_input(self, input: impl Into<PathBuf>) -> Self {
        Self { input: Some(input.into()), ..self }
    }

    /// Creates the folder and checks that it can be written to, so that a run fails at its start and not at its end.
    ///
    /// # Errors
    /// [`WriteError`] with the reason.
    pub fn prepare(&self) -> Result<(), WriteError> {
        prepare_folder(&self.folder)
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
        self.prepare()?;
        let figures: Vec<_> = document.figures().into_iter().filter(|figure| !figure.stem.is_empty()).collect();
        let has_charts = !figures.is_empty() && !self.formats.is_empty();
        let charts = self.folder.join(CHARTS);
        if has_charts || document.data_names().iter().any(|name| name.contains('/')) {
            prepare_folder(&charts)?;
        }
        let data = document.data_files();
        let data = data.iter().map(|file| self.put(&file.name, stop, file.text.as_bytes()));
        let data = data.collect::<Result<_, _>>()?;
        figures.par_iter().try_for_each(|figure| {
            if self.formats.is_empty() || stop.load(Ordering::SeqCst) {
                return Ok(());
            }
            let svg = figure.chart.svg_at(self.width);
            self.formats.iter().try_for_each(|format| {
                let file = format!("{CHARTS}/{}.{}", figure.stem, format.name());
                let picture = picture(&svg, *format)
                    .map_err(|source| ArtefactError::Chart { file: figure.stem.clone(), source })?;
                self.put(&file, stop, &picture).map(drop)
            })
        })?;
        let page = document.html_in_folder(&self.formats);
        let page = self.put(&format!("{}.html", document.name), stop, page.as_bytes())?;
        Ok(Written { page, data, charts: has_charts.then_some((charts, figures.len())) })
    }

    /// Writes the file at `path` below the folder and returns its location.
    fn put(&self, path: &str, stop: &AtomicBool, bytes: &[u8]) -> Result<PathBuf, ArtefactError> {
        if stop.load(Ordering::SeqCst) {
            return Err(ArtefactError::Stopped);
        }
        let path = self.folder.join(path);
        let input = self.input.as_ref().and_then(|input| std::fs::canonicalize(input).ok());
        if input.is_some() && input == std::fs::canonicalize(&path).ok() {
            return Err(ArtefactError::Input { path });
        }
        write_atomically(&path, bytes)?;
        Ok(path)
    }
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
