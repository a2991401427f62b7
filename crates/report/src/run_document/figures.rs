//! The charts of a run as numbered figures.

use apportion::analysis::MIN_OUTPUTS_TOGETHER;
use apportion::result::{OutputResult, StudyResult};

use crate::chart::Chart;
use crate::document::{Figure, Part};
use crate::file_stems;

/// Suffixes of the names of the files of all charts, each after a hyphen except the first.
const SUFFIXES: [&str; 8] =
    ["", "-indices", "-scatter", "-distribution", "-convergence", "-pairs", "-along", "-together"];

/// Returns the prefixes of the files of the charts: of each of the outputs of `single`, which are in no series, if they
/// are few, and of each series of `result`.
pub(super) fn stems(result: &StudyResult, single: &StudyResult) -> (Vec<String>, Vec<String>) {
    let mut names: Vec<&str> = single.outputs.iter().map(|output| output.name.as_str()).collect();
    // Charts of many outputs together have the names of a single series.
    let is_many = names.len() >= MIN_OUTPUTS_TOGETHER;
    if is_many {
        names = vec!["outputs"];
    }
    let count = names.len();
    names.extend(result.series.iter().map(|series| series.name.as_str()));
    let mut outputs = file_stems(&result.study.name, &names, &SUFFIXES);
    let series = outputs.split_off(count);
    (if is_many { Vec::new() } else { outputs }, series)
}

/// The outputs whose figures are drawn.
#[derive(Clone, Copy)]
pub(super) struct Figures<'a> {
    pub result: &'a StudyResult,
    /// File names of each output.
    pub stems: &'a [String],
    /// The number of the series whose values they are, from 1.
    pub series: Option<usize>,
    /// Whether the document is on a single output, whose topics are its sections.
    pub is_only: bool,
}

impl<'a> Figures<'a> {
    /// Returns output number `number`, from 1.
    pub fn output(&self, number: usize) -> &'a OutputResult {
        &self.result.outputs[number - 1]
    }

    /// Returns a figure of several outputs, with the anchor `name` and its files named `stem`.
    pub fn of_all(&self, chart: Chart, name: &str, stem: &str) -> Part {
        self.figure(chart, name, stem.to_owned(), ".csv")
    }

    /// Draws a figure of output number `number`: its anchor ends in `name`, the name of the file with its numbers in
    /// `data`.
    pub fn draw(&self, number: usize, name: &str, draw: fn(&StudyResult, &OutputResult) -> Chart, data: &str) -> Part {
        let suffix = SUFFIXES.into_iter().find(|suffix| suffix.strip_prefix('-') == Some(name)).unwrap_or_default();
        let stem = self.stems.get(number - 1).map_or_else(String::new, |stem| format!("{stem}{suffix}"));
        self.figure(draw(self.result, self.output(number)), &format!("{number}-{name}"), stem, data)
    }

    fn figure(&self, chart: Chart, name: &str, stem: String, data: &str) -> Part {
        let study = &self.result.study;
        let series = self.series.map_or_else(String::new, |number| format!("series-{number}-"));
        let mut figure = Figure::unnumbered(chart, stem);
        figure.id = format!("figure-{series}{name}");
        figure.title = figure.own_title(study.headline());
        if !data.is_empty() {
            figure.data = format!("{}{data}", study.name);
        }
        figure.into()
    }
}
