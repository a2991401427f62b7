//! The charts of a run as figures, numbered through.

use crate::model::MANY_OUTPUTS;
use crate::report::chart::Chart;
use crate::report::document::{Figure, Part};
use crate::report::format::the;
use crate::report::output_axis::OutputAxis;
use crate::report::result::{OutputRecord, ResultFile};
use crate::report::{
    convergence_chart, distribution_chart, file_stems, indices_chart, interactions_chart, scatter_chart, study_chart,
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

/// The charts in the order of their places above.
const KINDS: [Kind; 6] = [
    Kind { suffix: "", name: "shares", draw: study_chart, data: ".csv" },
    Kind { suffix: "-indices", name: "indices", draw: indices_chart, data: ".csv" },
    Kind { suffix: "-interactions", name: "interactions", draw: interactions_chart, data: ".csv" },
    Kind { suffix: "-scatter", name: "scatter", draw: scatter_chart, data: "" },
    Kind { suffix: "-distribution", name: "distribution", draw: distribution_chart, data: "" },
    Kind { suffix: "-convergence", name: "convergence", draw: convergence_chart, data: "-convergence.csv" },
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

/// The names of all charts of a study with these outputs.
pub(super) fn all_stems(study: &str, outputs: &[&str]) -> Vec<String> {
    if outputs.len() >= MANY_OUTPUTS {
        return overview_stems(study, OutputAxis::all(outputs).len());
    }
    chart_stems(study, outputs).into_iter().flatten().collect()
}

/// Draws the figures of one output after the other.
pub(super) struct Figures<'a> {
    pub result: &'a ResultFile,
    /// Of the charts of each output; none where these are on the page alone.
    stems: Vec<[String; KINDS.len()]>,
    /// Figures of several outputs.
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
    pub fn new(result: &'a ResultFile) -> Self {
        let outputs: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
        let is_many = outputs.len() >= MANY_OUTPUTS;
        let stems = if is_many { Vec::new() } else { chart_stems(&result.study.name, &outputs) };
        Self { result, stems, others: 0, drawn: Vec::new() }
    }

    /// A figure of several outputs, with the anchor `name` and its files called `stem`.
    pub fn add(&mut self, chart: Chart, name: &str, stem: &str) -> Part {
        self.others += 1;
        let study = &self.result.study;
        let figure = Figure::new(self.others + self.drawn.len(), chart, stem, format!("{}.csv", study.name));
        let figure = Figure { id: format!("figure-{name}"), ..figure };
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
        let all = outputs.take(self.stems.len()).flat_map(|of| (0..KINDS.len()).map(move |kind| (of, kind)));
        let others = all.filter(|(of, kind)| !self.drawn.contains(&(of.number, *kind)));
        others.map(|(of, kind)| self.figure(of, kind)).collect()
    }

    fn figure(&self, of: Numbered<'_>, kind: usize) -> Figure {
        let study = &self.result.study;
        let stem = self.stems.get(of.number - 1).map_or("", |stems| &stems[kind]);
        let Kind { name, draw, data, .. } = &KINDS[kind];
        let data = if data.is_empty() { String::new() } else { format!("{}{data}", study.name) };
        let figure = Figure::new(self.others + self.drawn.len(), draw(self.result, of.output), stem, data);
        let figure = Figure { id: format!("figure-{}-{name}", of.number), ..figure };
        match kind {
            SHARES => Figure { title: Some(format!("Shares of {}", the(&of.output.name))), ..figure },
            _ => figure.below(study.title.as_ref().unwrap_or(&study.name)),
        }
    }
}
