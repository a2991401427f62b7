//! The charts of a run as numbered figures.

use apportion::model::MIN_OUTPUTS_TOGETHER;
use apportion::result::{OutputResult, StudyResult};

use crate::chart::Chart;
use crate::document::{Figure, Part};
use crate::{
    convergence_chart, distribution_chart, file_stems, indices_chart, pairs_chart, scatter_chart, shapley_chart,
};

/// A chart of an output.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    /// Suffix of the names of its files.
    suffix: &'static str,
    /// Its anchor.
    name: &'static str,
    draw: fn(&StudyResult, &OutputResult) -> Chart,
    /// Suffix of the file with its numbers.
    data: &'static str,
}

pub(super) const SHARES: Kind = Kind { suffix: "", name: "shares", draw: shapley_chart, data: ".csv" };
pub(super) const INDICES: Kind = Kind { suffix: "-indices", name: "indices", draw: indices_chart, data: ".csv" };
pub(super) const SCATTER: Kind = Kind { suffix: "-scatter", name: "scatter", draw: scatter_chart, data: "" };
pub(super) const DISTRIBUTION: Kind =
    Kind { suffix: "-distribution", name: "distribution", draw: distribution_chart, data: "" };
pub(super) const CONVERGENCE: Kind =
    Kind { suffix: "-convergence", name: "convergence", draw: convergence_chart, data: "-convergence.csv" };
pub(super) const PAIRS: Kind = Kind { suffix: "-pairs", name: "pairs", draw: pairs_chart, data: "-second-order.csv" };

/// Suffixes of the charts of a series: its indices along the axis, and those of the whole.
pub(super) const SERIES_SUFFIXES: [&str; 2] = ["-along", "-together"];

/// Prefixes of the files of the charts.
pub(super) struct Stems {
    /// Of each output that is in no series, if they are few.
    pub single: Vec<String>,
    /// Of each series, with its suffixes.
    pub series: Vec<[String; SERIES_SUFFIXES.len()]>,
}

impl Stems {
    pub fn new(result: &StudyResult) -> Self {
        let is_single = |place: usize| !result.series.iter().any(|series| series.places().contains(&place));
        let single = result.outputs.iter().enumerate().filter(|(place, _)| is_single(*place));
        let mut names: Vec<&str> = single.map(|(_, output)| output.name.as_str()).collect();
        // Charts of many outputs together have the names of a single series.
        let is_many = names.len() >= MIN_OUTPUTS_TOGETHER;
        if is_many {
            names = vec!["outputs"];
        }
        let count = names.len();
        names.extend(result.series.iter().map(|series| series.name.as_str()));
        let kinds = [SHARES, INDICES, SCATTER, DISTRIBUTION, CONVERGENCE, PAIRS].map(|kind| kind.suffix);
        let mut single = file_stems(&result.study.name, &names, &[&kinds[..], &SERIES_SUFFIXES[..]].concat());
        let series = single.split_off(count);
        let series = series.iter().map(|stem| SERIES_SUFFIXES.map(|suffix| format!("{stem}{suffix}")));
        Self { single: if is_many { Vec::new() } else { single }, series: series.collect() }
    }
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

/// An output, and its number from 1.
#[derive(Clone, Copy)]
pub(super) struct Numbered<'a> {
    pub output: &'a OutputResult,
    pub number: usize,
}

impl Numbered<'_> {
    /// Returns whether it is the first output, where statements on all outputs are made.
    pub fn is_first(self) -> bool {
        self.number == 1
    }
}

impl Figures<'_> {
    /// Returns a figure of several outputs, with the anchor `name` and its files named `stem`.
    pub fn of_all(&self, chart: Chart, name: &str, stem: &str) -> Part {
        self.figure(chart, name, stem.to_owned(), ".csv")
    }

    /// Draws the figure of that kind of an output.
    pub fn draw(&self, of: Numbered<'_>, Kind { suffix, name, draw, data }: Kind) -> Part {
        let stem = self.stems.get(of.number - 1).map_or_else(String::new, |stem| format!("{stem}{suffix}"));
        self.figure(draw(self.result, of.output), &format!("{}-{name}", of.number), stem, data)
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
