//! The charts of a run as figures of the page, numbered through.

use super::beside::{Beside, RUN_CHARTS};
use super::words::the;
use crate::report::chart::Chart;
use crate::report::page::{PageFigure, Part};
use crate::report::result::{OutputRecord, ResultFile};
use crate::report::{
    capitalised, convergence_chart, distribution_chart, file_stems, indices_chart, interactions_chart, scatter_chart,
    study_chart,
};

/// Draws the figures of one output after the other.
pub(super) struct Figures<'a> {
    pub result: &'a ResultFile,
    pub beside: Beside<'a>,
    /// Figures so far.
    pub count: usize,
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

impl Figures<'_> {
    pub fn shares(&mut self, of: Numbered<'_>) -> Part {
        let mut chart = study_chart(self.result, of.output);
        set_title(&mut chart, format!("Shares of {}", the(&of.output.name)));
        self.figure(of, ("", ".csv"), ("shares", chart))
    }

    pub fn indices(&mut self, of: Numbered<'_>) -> Part {
        self.figure(of, ("-indices", ".csv"), ("indices", indices_chart(self.result, of.output)))
    }

    pub fn interactions(&mut self, of: Numbered<'_>) -> Part {
        self.figure(of, ("-interactions", ".csv"), ("interactions", interactions_chart(self.result, of.output)))
    }

    pub fn scatter(&mut self, of: Numbered<'_>) -> Part {
        self.figure(of, ("-scatter", ""), ("scatter", scatter_chart(self.result, of.output)))
    }

    pub fn convergence(&mut self, of: Numbered<'_>) -> Part {
        let chart = convergence_chart(self.result, of.output);
        self.figure(of, ("-convergence", "-convergence.csv"), ("convergence", chart))
    }

    pub fn distribution(&mut self, of: Numbered<'_>) -> Part {
        self.figure(of, ("-distribution", ""), ("distribution", distribution_chart(self.result, of.output)))
    }

    /// The chart called `name`, with links to its pictures, whose names end in `suffix`, and to the table `csv`.
    fn figure(&mut self, of: Numbered<'_>, (suffix, csv): (&str, &str), (name, mut chart): (&str, Chart)) -> Part {
        self.count += 1;
        let outputs: Vec<&str> = self.result.outputs.iter().map(|output| output.name.as_str()).collect();
        let stem = &file_stems(self.beside.study, &outputs, &RUN_CHARTS)[of.number - 1];
        let study = &self.result.study;
        let headline = format!("{}: ", study.title.as_ref().unwrap_or(&study.name));
        // The page has the study's title at its top.
        if let Some(title) = chart.title().strip_prefix(&headline).map(capitalised) {
            set_title(&mut chart, title);
        }
        let mut links = self.beside.pictures(&format!("{stem}{suffix}"));
        links.extend(Some(csv).filter(|csv| !csv.is_empty()).and_then(|csv| self.beside.table(csv, "CSV")));
        Part::Figure(Box::new(PageFigure {
            id: format!("figure-{}-{name}", of.number),
            label: format!("Figure {}", self.count),
            beside: String::new(),
            chart,
            links,
        }))
    }
}

fn set_title(chart: &mut Chart, title: String) {
    match chart {
        Chart::Bars(chart) => chart.title = title,
        Chart::Lines(chart) => chart.title = title,
        Chart::Scatter(chart) => chart.title = title,
        Chart::Cloud(chart) => chart.title = title,
        Chart::Ranges(chart) => chart.title = title,
        Chart::Picture(picture) => picture.title = title,
    }
}
