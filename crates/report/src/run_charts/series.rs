//! The indices of a series against its axis.

use apportion::result::{IndexRecord, OutputResult, SeriesRecord, StudyResult};
use apportion::uncertainty::Estimate;

use super::super::chart::{Axis, Chart, Colour, Mark, Panel, Series};
use super::super::factor_bars::{INDEX, not_drawn};
use super::super::format::{axis_unit, name};
use super::super::leading::falling;

/// Maximum number of factors with lines: those with the largest mean total index.
const LINES: usize = 8;
/// Range of an index that is drawn: intervals of values that hardly vary are long.
const DRAWN: (f64, f64) = (-0.1, 1.1);

/// A series with the results of its values.
#[derive(Clone, Copy)]
pub(crate) struct SeriesOf<'a> {
    /// The result of the run.
    pub result: &'a StudyResult,
    /// The series.
    pub series: &'a SeriesRecord,
}

impl<'a> SeriesOf<'a> {
    /// Returns its values, in order.
    pub fn values(self) -> &'a [OutputResult] {
        &self.result.outputs[self.series.places()]
    }

    /// Returns the positions of the factors by falling total index over the series, or by the sum over its values.
    fn order(self) -> Vec<usize> {
        let total = |value: &OutputResult, factor: usize| {
            value.indices.as_ref().and_then(|all| all.get(factor)).map_or(0.0, |index| index.effect.total.estimate)
        };
        let key = |factor: usize| match &self.series.indices {
            Some(indices) => indices.get(factor).map_or(0.0, |index| index.total.estimate),
            None => self.values().iter().map(|value| total(value, factor)).sum(),
        };
        falling(&(0..self.result.indexed_names().len()).map(key).collect::<Vec<f64>>())
    }
}

/// Draws total and first-order index of every factor against the axis, with their intervals as bands.
pub(crate) fn along_chart(of: SeriesOf<'_>) -> Chart {
    let (order, names) = (of.order(), of.result.indexed_names());
    let positions = &of.series.positions;
    let panel = |title: &str, read: fn(&IndexRecord) -> Estimate| {
        let marks = order.iter().take(LINES).enumerate().flat_map(|(rank, &factor)| -> [Mark; 2] {
            let series = Series::new(name(names[factor]), Colour::Series(rank));
            let index = |value: &OutputResult| value.indices.as_ref()?.get(factor).map(read);
            let drawn = |x: Option<f64>| x.map_or(f64::NAN, |x| x.clamp(DRAWN.0, DRAWN.1));
            let curve = || positions.iter().zip(of.values()).map(|(x, value)| (*x, index(value)));
            let band = curve().map(|(x, of)| {
                let interval = of.and_then(|of| of.interval);
                (x, drawn(interval.map(|i| i.low)), drawn(interval.map(|i| i.high)))
            });
            let line = curve().map(|(x, of)| (x, drawn(of.map(|of| of.estimate))));
            [series.band(band.collect()), series.line(line.collect())]
        });
        let x = Axis::new(name(&of.series.axis), axis_unit(&of.series.axis_unit));
        Panel::new(x, Axis::new(INDEX, "")).titled(title).with(marks)
    };
    let panels = [
        panel("Total indices S_T: with all interactions", |index| index.effect.total),
        panel("First-order indices S_1: alone", |index| index.effect.first_order),
    ];
    let caption =
        format!("Bands are the 95 % intervals of each value, drawn from −0.1 to 1.1.{}", not_drawn(order.len(), LINES));
    let title = format!("{}: indices along the axis of {}", of.result.study.headline(), name(&of.series.name));
    Chart::new(title, caption).panels(panels)
}
