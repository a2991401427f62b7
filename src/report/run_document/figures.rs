//! The charts of a run as figures, numbered through.

use std::ops::Range;

use crate::model::MANY_OUTPUTS;
use crate::report::chart::Chart;
use crate::report::document::{Figure, Part};
use crate::report::format::name as words;
use crate::report::output_axis::OutputAxis;
use crate::report::result::{OutputRecord, ResultFile};
use crate::report::{
    convergence_chart, distribution_chart, file_stems, indices_chart, interactions_chart, pairs_chart, scatter_chart,
    study_chart,
};

/// A chart of every output.
struct Kind {
    /// What the names of its files end in.
    suffix: &'static str,
    /// Its anchor.
    name: &'static str,
    draw: fn(&ResultFile, &OutputRecord) -> Chart,
    /// What the file with its numbers ends in.
    data: &'static str,
}

pub(super) const SHARES: usize = 0;
pub(super) const INDICES: usize = 1;
pub(super) const INTERACTIONS: usize = 2;
pub(super) const SCATTER: usize = 3;
pub(super) const DISTRIBUTION: usize = 4;
pub(super) const CONVERGENCE: usize = 5;
/// Of results with second-order indices alone.
pub(super) const PAIRS: usize = 6;

/// The charts in the order of their places above.
const KINDS: [Kind; 7] = [
    Kind { suffix: "", name: "shares", draw: study_chart, data: ".csv" },
    Kind { suffix: "-indices", name: "indices", draw: indices_chart, data: ".csv" },
    Kind { suffix: "-interactions", name: "interactions", draw: interactions_chart, data: ".csv" },
    Kind { suffix: "-scatter", name: "scatter", draw: scatter_chart, data: "" },
    Kind { suffix: "-distribution", name: "distribution", draw: distribution_chart, data: "" },
    Kind { suffix: "-convergence", name: "convergence", draw: convergence_chart, data: "-convergence.csv" },
    Kind { suffix: "-pairs", name: "pairs", draw: pairs_chart, data: "-second-order.csv" },
];

/// The names of the charts of each output.
fn chart_stems(study: &str, outputs: &[&str]) -> Vec<[String; KINDS.len()]> {
    let suffixes = KINDS.map(|kind| kind.suffix);
    let stems = file_stems(study, outputs, &suffixes);
    stems.into_iter().map(|stem| suffixes.map(|suffix| format!("{stem}{suffix}"))).collect()
}

/// The names of the charts of many outputs: of all together, then of the map of each axis.
pub(super) fn overview_stems(study: &str, axes: usize) -> Vec<String> {
    let maps = (1..=axes).map(|axis| if axes == 1 { format!("{study}-map") } else { format!("{study}-map-{axis}") });
    std::iter::once(format!("{study}-together")).chain(maps).collect()
}

/// What the names of the charts of a series end in: its indices along the axis, the shares of its variance, the indices of
/// the whole, and the map.
pub(super) const SERIES_SUFFIXES: [&str; 4] = ["-along", "-layers", "-together", "-map"];

/// Series whose charts are files; those of more are on the page alone.
const SERIES_WITH_FILES: usize = 3;

/// The names of the outputs of a study, as its files are named after them.
#[derive(Clone, Debug)]
pub struct OutputNames<'a> {
    /// Of those that belong to no series.
    pub single: Vec<&'a str>,
    /// Of the series.
    pub series: Vec<&'a str>,
}

impl<'a> OutputNames<'a> {
    /// Names of outputs in order, and of the series with the places of their values.
    pub fn new(outputs: &[&'a str], series: &[(&'a str, Range<usize>)]) -> Self {
        let is_single = |place: usize| !series.iter().any(|(_, places)| places.contains(&place));
        let single = outputs.iter().enumerate().filter(|(place, _)| is_single(*place)).map(|(_, name)| *name);
        Self { single: single.collect(), series: series.iter().map(|(name, _)| *name).collect() }
    }

    pub(super) fn of(result: &'a ResultFile) -> Self {
        let outputs: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
        let series: Vec<_> = result.series.iter().map(|series| (series.name.as_str(), series.places())).collect();
        Self::new(&outputs, &series)
    }
}

/// The names of the charts of a study.
pub(super) struct Stems {
    /// Of each output that belongs to no series, if they are few.
    single: Vec<[String; KINDS.len()]>,
    /// Of each series; empty for those without files.
    pub series: Vec<[String; SERIES_SUFFIXES.len()]>,
}

impl Stems {
    pub fn new(study: &str, names: &OutputNames<'_>) -> Self {
        let OutputNames { single, series } = names;
        let is_many = single.len() >= MANY_OUTPUTS;
        if series.is_empty() {
            return Self { single: if is_many { Vec::new() } else { chart_stems(study, single) }, series: Vec::new() };
        }
        // Charts of all of many outputs together have names like those of an only series.
        let of_single = if is_many { &["outputs"][..] } else { single };
        let all: Vec<&str> = of_single.iter().chain(series).copied().collect();
        let kinds = KINDS.map(|kind| kind.suffix);
        let stems = file_stems(study, &all, &[&kinds[..], &SERIES_SUFFIXES[..]].concat());
        let (of_outputs, of_series) = stems.split_at(of_single.len());
        let own = |(number, stem): (usize, &String)| match number {
            ..SERIES_WITH_FILES => SERIES_SUFFIXES.map(|suffix| format!("{stem}{suffix}")),
            _ => SERIES_SUFFIXES.map(|_| String::new()),
        };
        let of_outputs = of_outputs.iter().filter(|_| !is_many);
        Self {
            single: of_outputs.map(|stem| kinds.map(|suffix| format!("{stem}{suffix}"))).collect(),
            series: of_series.iter().enumerate().map(own).collect(),
        }
    }
}

/// The names of all charts of a study with these outputs; those of pairs are drawn of `second_order` indices alone.
pub(super) fn all_stems(study: &str, names: &OutputNames<'_>, second_order: bool) -> Vec<String> {
    let Stems { single, series } = Stems::new(study, names);
    let mut all: Vec<String> = series.into_iter().flatten().filter(|stem| !stem.is_empty()).collect();
    if names.single.len() >= MANY_OUTPUTS {
        all.extend(overview_stems(study, OutputAxis::all(&names.single).len()));
    }
    let kinds = if second_order { KINDS.len() } else { PAIRS };
    all.extend(single.into_iter().flat_map(|stems| stems.into_iter().take(kinds)));
    all
}

/// Draws the figures of one output after the other.
pub(super) struct Figures<'a> {
    pub result: &'a ResultFile,
    /// Of the charts of each output; none where these are on the page alone.
    stems: Vec<[String; KINDS.len()]>,
    /// What the anchors of its figures begin with.
    prefix: String,
    /// Figures of several outputs, and those before.
    others: usize,
    /// The figures so far, by output and kind.
    drawn: Vec<(usize, usize)>,
}

/// An output, and its number from 1.
#[derive(Clone, Copy)]
pub(super) struct Numbered<'a> {
    pub output: &'a OutputRecord,
    pub number: usize,
}

impl Numbered<'_> {
    /// Whether it is the first output: what holds for all is said there.
    pub fn is_first(self) -> bool {
        self.number == 1
    }
}

impl<'a> Figures<'a> {
    /// Of the outputs of `result`, behind so many figures.
    pub fn new(result: &'a ResultFile, stems: Stems, before: usize) -> Self {
        Self { result, stems: stems.single, prefix: String::new(), others: before, drawn: Vec::new() }
    }

    /// Of the values of series number `number`, from 1.
    pub fn of_series(result: &'a ResultFile, number: usize, before: usize) -> Self {
        let prefix = format!("series-{number}-");
        Self { result, stems: Vec::new(), prefix, others: before, drawn: Vec::new() }
    }

    /// Figures so far, with those before.
    pub fn count(&self) -> usize {
        self.others + self.drawn.len()
    }

    /// A figure of several outputs, with the anchor `name` and its files called `stem`.
    pub fn add(&mut self, chart: Chart, name: &str, stem: &str) -> Part {
        self.others += 1;
        let study = &self.result.study;
        let figure = Figure::new(self.others + self.drawn.len(), chart, stem, format!("{}.csv", study.name));
        let figure = Figure { id: format!("figure-{}{name}", self.prefix), ..figure };
        figure.below(study.title.as_ref().unwrap_or(&study.name)).into()
    }

    /// The figure of that kind with its number and the names of its files.
    pub fn draw(&mut self, of: Numbered<'_>, kind: usize) -> Part {
        self.drawn.push((of.number, kind));
        self.figure(of, kind).into()
    }

    /// The charts that have not been drawn, since there is nothing to be seen on them: files that say so all the same, so
    /// that those of an earlier run do not stay.
    pub fn others(&self) -> Vec<Figure> {
        let outputs =
            self.result.outputs.iter().enumerate().map(|(place, output)| Numbered { output, number: place + 1 });
        // Those without a name are no files.
        let kinds = if self.has_pairs() { KINDS.len() } else { PAIRS };
        let all = outputs.take(self.stems.len()).flat_map(|of| (0..kinds).map(move |kind| (of, kind)));
        let others = all.filter(|(of, kind)| !self.drawn.contains(&(of.number, *kind)));
        others.map(|(of, kind)| self.figure(of, kind)).collect()
    }

    /// Whether any output has second-order indices.
    fn has_pairs(&self) -> bool {
        self.result.outputs.iter().any(|output| output.second_order.is_some())
    }

    fn figure(&self, of: Numbered<'_>, kind: usize) -> Figure {
        let study = &self.result.study;
        let stem = self.stems.get(of.number - 1).map_or("", |stems| &stems[kind]);
        let Kind { name, draw, data, .. } = &KINDS[kind];
        let data = if data.is_empty() { String::new() } else { format!("{}{data}", study.name) };
        let figure = Figure::new(self.others + self.drawn.len(), draw(self.result, of.output), stem, data);
        let figure = Figure { id: format!("figure-{}{}-{name}", self.prefix, of.number), ..figure };
        match kind {
            SHARES => Figure { title: Some(format!("Shares of {}", words(&of.output.name))), ..figure },
            _ => figure.below(study.title.as_ref().unwrap_or(&study.name)),
        }
    }
}
