//! The charts of a run as figures of the page, numbered through.

use super::beside::{Beside, output_stem};
use crate::report::chart::{Chart, ChartError, Picture};
use crate::report::page::{PageFigure, Part};
use crate::report::result::{OutputRecord, ResultFile};
use crate::report::{convergence_chart, distribution_chart, study_chart};

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

impl Figures<'_> {
    pub fn shares(&mut self, of: Numbered<'_>) -> Result<Part, ChartError> {
        let chart = picture(study_chart(self.result, of.output)?);
        Ok(self.figure(of, "", ("shares", chart)))
    }

    pub fn convergence(&mut self, of: Numbered<'_>) -> Result<Part, ChartError> {
        let chart = picture(convergence_chart(self.result, of.output)?);
        Ok(self.figure(of, "-convergence", ("convergence", chart)))
    }

    pub fn distribution(&mut self, of: Numbered<'_>) -> Result<Part, ChartError> {
        let chart = picture(distribution_chart(self.result, of.output)?);
        Ok(self.figure(of, "-distribution", ("distribution", chart)))
    }

    fn figure(&mut self, of: Numbered<'_>, suffix: &str, (name, chart): (&str, Chart)) -> Part {
        self.count += 1;
        let stem = output_stem(self.beside.study, &of.output.name, self.result.outputs.len());
        Part::Figure(Box::new(PageFigure {
            id: format!("figure-{}-{name}", of.number),
            label: format!("Figure {}", self.count),
            beside: String::new(),
            chart,
            links: self.beside.pictures(&format!("{stem}{suffix}")),
        }))
    }
}

/// TEMPORARY until the chart functions return `Chart`.
fn picture(svg: String) -> Chart {
    let between = |a: &str, b: &str| {
        svg.split_once(a).and_then(|(_, rest)| rest.split_once(b)).map(|(t, _)| t.to_owned()).unwrap_or_default()
    };
    let title = between("<title>", "</title>");
    Chart::Picture(Picture { title, caption: String::new(), wide: svg.clone(), narrow: svg })
}
