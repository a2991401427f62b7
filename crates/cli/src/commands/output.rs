//! The files of a command: formats, writing and listing.

use std::path::{Path, PathBuf};

use apportion::Study;
use apportion_report::chart::{ChartWidth, PaperWidth};
use apportion_report::document::Document;
use apportion_report::{Artefacts, ChartFormat};

use super::journal::JournalArguments;
use super::stop::on_signal;
use super::{counted, print, say};

#[derive(clap::Args)]
pub struct ChartArguments {
    /// Formats of the charts in the folder `charts`, separated by commas: svg, png, pdf; or none. The page contains its own charts
    #[arg(long, value_name = "FORMATS", default_value = "svg,png", value_delimiter = ',', value_parser = chart_format)]
    charts: Vec<Option<ChartFormat>>,
    /// Width of the charts in the folder `charts` for print, such as 88mm or 180mm: without title and caption, which belong into the
    /// text of a paper; letters of 7 to 9 pt, PNG with 600 dpi, PDF in this size [default: a page column, with title and caption]
    #[arg(long, value_name = "WIDTH")]
    chart_width: Option<PaperWidth>,
    /// Overwrite files that are not unchanged results of an earlier command of the same kind
    #[arg(long)]
    pub force: bool,
}

/// Where the files of a command go, and its charts.
#[derive(clap::Args)]
pub struct OutputArguments {
    /// Folder for the results [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    charts: ChartArguments,
}

impl OutputArguments {
    /// The folder for what is called `name`.
    pub fn folder(&self, name: &str) -> PathBuf {
        self.out.clone().unwrap_or_else(|| default_folder(name))
    }

    /// The files of a document about what is called `name`, made from `inputs`.
    pub fn artefacts(&self, name: &str, inputs: Vec<PathBuf>) -> Artefacts {
        Artefacts { inputs, ..self.charts.artefacts(self.folder(name)) }
    }

    /// The files of the document `NAME` + `ending` about `study`: they can be written, so that a run fails at its start
    /// and not at its end. With `journal`, one of this name is among them.
    pub fn prepared(
        &self,
        study: &Study,
        ending: &str,
        journal: Option<&JournalArguments>,
    ) -> anyhow::Result<Artefacts> {
        let name = format!("{}{ending}", study.name());
        let journal = journal.and_then(|journal| journal.path(&self.folder(study.name()), &name, None));
        Ok(Artefacts { journal, ..self.artefacts(study.name(), study.files()) }.prepare(&name)?)
    }
}

fn chart_format(name: &str) -> Result<Option<ChartFormat>, String> {
    let format = ChartFormat::ALL.into_iter().find(|format| format.name() == name.trim());
    match format {
        None if name != "none" => Err("expected svg, png and pdf, separated by commas, or none".to_owned()),
        format => Ok(format),
    }
}

impl ChartArguments {
    /// The files of a document in `folder`.
    pub fn artefacts(&self, folder: impl Into<PathBuf>) -> Artefacts {
        let width = self.chart_width.map_or(ChartWidth::Wide, ChartWidth::Paper);
        let formats: Vec<ChartFormat> = self.charts.iter().flatten().copied().collect();
        Artefacts { formats, width, replaces: self.force, ..Artefacts::new(folder) }
    }
}

/// The folder for results of the study called `name`.
pub fn default_folder(name: &str) -> PathBuf {
    Path::new("results").join(name)
}

/// The name of a table's results: that of its file without the ending.
pub fn stem(table: &Path) -> String {
    table.file_stem().map_or_else(|| "table".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Writes the files of `document`, prints it as text, and says where the files are.
pub fn deliver(artefacts: &Artefacts, document: &Document) -> anyhow::Result<()> {
    let written = artefacts.write_until(document, on_signal())?;
    print(&document.text())?;
    // A page to try other ranges in, and not an animation.
    let (live, data): (Vec<&PathBuf>, Vec<&PathBuf>) =
        written.data.iter().partition(|path| path.to_string_lossy().ends_with("live.html"));
    let names = live.iter().filter_map(|path| path.file_name()).map(|name| name.to_string_lossy());
    let live: String = names.map(|name| format!(", and the interactive page {name}")).collect();
    say(&format!("wrote {}{live}", written.page.display()));
    let (json, others): (Vec<&PathBuf>, Vec<&PathBuf>) =
        data.into_iter().partition(|path| path.extension().is_some_and(|ending| ending == "json"));
    match (&json[..], others.len()) {
        ([], 0) => (),
        ([], tables) => say(&format!("wrote {} next to it", counted(tables as u64, "table"))),
        ([json], 0) => say(&format!("wrote {}", json.display())),
        ([json], tables) => {
            say(&format!("wrote {} and {} next to it", json.display(), counted(tables as u64, "table")))
        }
        (several, tables) => say(&format!("wrote {} next to it", counted((several.len() + tables) as u64, "file"))),
    }
    if let Some((folder, charts)) = &written.charts {
        say(&format!("wrote {} to {}", counted(*charts as u64, "chart"), folder.display()));
    }
    Ok(())
}
