//! A plot with both its scales, and series in it.

use super::super::plot::Plot;
use super::super::scale::Scale;
use super::super::svg::Canvas;
use super::LineSeries;
use super::path::{closed, open, runs, thin};

/// A plot with both scales.
pub(in super::super) struct Sheet<'a> {
    pub plot: Plot,
    pub x: &'a Scale,
    pub y: &'a Scale,
}

impl Sheet<'_> {
    /// The place of a point, if it has one.
    pub fn at(&self, x: f64, y: f64) -> Option<(f64, f64)> {
        Some((self.plot.x(self.x, x)?, self.plot.y(self.y, y)?))
    }

    /// Both edges of a band at a place.
    fn edges(&self, &(x, low, high): &(f64, f64, f64)) -> Option<[(f64, f64); 2]> {
        Some([self.at(x, low)?, self.at(x, high)?])
    }

    /// Whether anything of a series is seen.
    pub fn shows(&self, series: &LineSeries) -> bool {
        series.points.iter().any(|&(x, y)| self.at(x, y).is_some())
            || series.band.iter().any(|edges| self.edges(edges).is_some())
    }

    /// Draws the band of a series.
    pub fn band(&self, canvas: &mut Canvas, series: &LineSeries) {
        for run in runs(series.band.iter().map(|edges| self.edges(edges))) {
            let lower: Vec<_> = run.iter().map(|edges| edges[0]).collect();
            let upper: Vec<_> = run.iter().map(|edges| edges[1]).collect();
            let d = closed(&thin(&lower), &thin(&upper));
            let fill = series.role.colour();
            canvas.leaf("path", &[("class", &"band"), ("d", &d), ("fill", &fill), ("fill-opacity", &"0.18")]);
        }
    }

    /// Draws line and points of a series.
    pub fn series(&self, canvas: &mut Canvas, series: &LineSeries) {
        let runs = runs(series.points.iter().map(|&(x, y)| self.at(x, y)));
        canvas.open("g", &[("class", &"series")]);
        canvas.content("title", &[], &series.name);
        for run in &runs {
            if series.stroke.line() && run.len() > 1 {
                self.line(canvas, series, &open(&thin(run)));
            }
            // A point between two gaps would be invisible as a line.
            if series.stroke.points() || run.len() == 1 {
                for &point in run {
                    canvas.point(point, series.role);
                }
            }
        }
        canvas.close("g");
    }

    fn line(&self, canvas: &mut Canvas, series: &LineSeries, d: &str) {
        let width = if series.stroke.points() { "1.4" } else { "1.8" };
        canvas.leaf(
            "path",
            &[
                ("d", &d),
                ("fill", &"none"),
                ("stroke", &series.role.colour()),
                ("stroke-width", &width),
                ("stroke-linejoin", &"round"),
                ("stroke-dasharray", &series.stroke.dash()),
            ],
        );
    }
}
