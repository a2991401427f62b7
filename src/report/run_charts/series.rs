//! Charts of a series: its indices against its axis, and its variance as a stack of shares.

use super::super::chart::{Axis, Chart, Colour, Mark, Panel, Series, Shape};
use super::super::factor_bars::INDEX;
use super::super::format::{axis_unit, name};
use super::super::result::{EstimateRecord, IndexRecord, OutputRecord, ResultFile, SeriesRecord};
use super::headline;

/// Colours of factors: those that are told apart best, and no grey, which is for interactions.
const COLOURS: [usize; 8] = [0, 1, 2, 3, 4, 5, 7, 8];
/// The colour of all other factors together, and of interactions.
const OTHERS: Colour = Colour::Series(9);
const INTERACTIONS: Colour = Colour::Series(10);
/// That of the noise of a stochastic model.
const NOISE: Colour = Colour::Series(6);
/// What is drawn of an index: intervals of values that hardly vary reach far.
const DRAWN: (f64, f64) = (-0.1, 1.1);

/// A series with the results of its values.
#[derive(Clone, Copy)]
pub(in crate::report) struct SeriesOf<'a> {
    /// The result of the run.
    pub result: &'a ResultFile,
    /// The series.
    pub series: &'a SeriesRecord,
}

impl<'a> SeriesOf<'a> {
    /// Its values, in order.
    pub fn values(self) -> &'a [OutputRecord] {
        &self.result.outputs[self.series.places()]
    }

    /// The places of the factors by falling total index over the whole series, or by their mean total index where there is
    /// none.
    pub fn order(self) -> Vec<usize> {
        let mean = |factor: usize| {
            let totals = self.values().iter().filter_map(|value| value.indices.as_ref()?.get(factor));
            let (sum, count) =
                totals.fold((0.0, 0), |(sum, count), index| (sum + index.effect.total.estimate, count + 1));
            sum / f64::from(count.max(1))
        };
        let key = |factor: usize| match &self.series.indices {
            Some(indices) => indices.get(factor).map_or(0.0, |index| index.total.estimate),
            None => mean(factor),
        };
        let keys: Vec<f64> = (0..self.result.factors.len()).map(key).collect();
        let mut order: Vec<usize> = (0..keys.len()).collect();
        order.sort_by(|&a, &b| keys[b].total_cmp(&keys[a]));
        order
    }

    /// The factors that are drawn by themselves, in order, each with its colour. Few factors have theirs by their places in the
    /// study, so that they keep it from series to series.
    fn drawn(self) -> Vec<(usize, Colour)> {
        let is_few = self.result.factors.len() <= COLOURS.len();
        let colour =
            |(rank, factor): (usize, usize)| (factor, Colour::Series(COLOURS[if is_few { factor } else { rank }]));
        self.order().into_iter().take(COLOURS.len()).enumerate().map(colour).collect()
    }

    /// The axis with its unit.
    pub fn axis(self) -> Axis {
        Axis::new(name(&self.series.axis), axis_unit(&self.series.axis_unit))
    }

    fn title(self, what: &str) -> String {
        format!("{}: {what} of {}", headline(self.result), name(&self.series.name))
    }

    /// Position and index of a factor at every value; `None` where there are no indices.
    fn curve(self, factor: usize, of: fn(&IndexRecord) -> EstimateRecord) -> Vec<(f64, Option<EstimateRecord>)> {
        let index = |value: &OutputRecord| value.indices.as_ref()?.get(factor).map(of);
        self.series.positions.iter().copied().zip(self.values().iter().map(index)).collect()
    }

    /// What a caption says of factors that are not drawn by themselves.
    fn left_out(self) -> String {
        match self.result.factors.len() {
            all if all > COLOURS.len() => format!(
                " Of {all} factors, the {} with the largest total indices over the whole series have lines.",
                COLOURS.len()
            ),
            _ => String::new(),
        }
    }
}

/// Total and first-order index of every factor against the axis, with their intervals as bands.
pub(in crate::report) fn along_chart(of: SeriesOf<'_>) -> Chart {
    let factors = of.drawn();
    let mut is_cut = false;
    let mut panel = |title: &str, read: fn(&IndexRecord) -> EstimateRecord| {
        let mut marks: Vec<Mark> = Vec::new();
        for &(factor, colour) in &factors {
            let series = Series::new(name(&of.result.factors[factor].name), colour);
            let curve = of.curve(factor, read);
            let mut drawn = |x: f64| {
                is_cut |= !(DRAWN.0..=DRAWN.1).contains(&x);
                x.clamp(DRAWN.0, DRAWN.1)
            };
            let band = curve.iter().map(|&(x, index)| {
                let bounds = index.and_then(|index| index.low.zip(index.high));
                bounds.map_or((x, f64::NAN, f64::NAN), |(low, high)| (x, drawn(low), drawn(high)))
            });
            marks.push(series.band(band.collect()));
            let line = curve.iter().map(|&(x, index)| (x, index.map_or(f64::NAN, |index| drawn(index.estimate))));
            marks.push(series.line(line.collect()));
        }
        Panel::new(of.axis(), Axis::new(INDEX, "")).titled(title).with(marks)
    };
    let panels = [
        panel("Total indices S_T: with all interactions", |index| index.effect.total),
        panel("First-order indices S_1: alone", |index| index.effect.first_order),
    ];
    let cut = if is_cut { " What reaches beyond −0.1 and 1.1 is cut there." } else { "" };
    let caption = format!("Bands are the 95 % intervals of each value by itself.{cut}{}", of.left_out());
    Chart::new(of.title("indices along the axis"), caption).panels(panels)
}

/// The variance of every value as a stack: what each factor does alone, and in grey what they do together; of dependent factors their
/// Shapley effects, which are all of it.
pub(in crate::report) fn layers_chart(of: SeriesOf<'_>) -> Chart {
    let order = of.order();
    let is_dependent = !of.result.study.dependences.is_empty();
    let alone = |value: &OutputRecord, factor: usize| {
        let effect = &value.indices.as_ref()?.get(factor)?.effect;
        let part = if is_dependent { effect.shapley? } else { effect.first_order };
        // A layer has no negative thickness.
        Some(100.0 * part.estimate.max(0.0))
    };
    let mut floor: Vec<f64> = vec![0.0; of.series.positions.len()];
    let mut layer = |series: Series, thickness: &dyn Fn(&OutputRecord, f64) -> Option<f64>| {
        let all = floor.iter_mut().zip(of.values()).zip(&of.series.positions);
        let edges = all.map(|((floor, value), &x)| {
            let Some(thickness) = thickness(value, *floor) else { return (x, f64::NAN, f64::NAN) };
            let low = *floor;
            *floor += thickness;
            (x, low, *floor)
        });
        series.mark(Shape::Layer(edges.collect()))
    };
    let mut marks: Vec<Mark> = Vec::new();
    for (factor, colour) in of.drawn() {
        let series = Series::new(name(&of.result.factors[factor].name), colour);
        marks.push(layer(series, &|value, _| alone(value, factor)));
    }
    if let Some(others) = order.get(COLOURS.len()..).filter(|others| !others.is_empty()) {
        let sum = |value: &OutputRecord| others.iter().map(|&factor| alone(value, factor)).sum::<Option<f64>>();
        marks.push(layer(Series::new("all other factors", OTHERS), &|value, _| sum(value)));
    }
    if let Some(noise) = of.values().iter().find_map(|value| value.noise.as_ref()) {
        let part = |value: &OutputRecord| Some(100.0 * value.noise.as_ref()?.effect.first_order.estimate.max(0.0));
        marks.push(layer(Series::new(format!("noise ({})", name(&noise.name)), NOISE), &|value, _| part(value)));
    }
    let rest = |value: &OutputRecord, floor: f64| value.indices.as_ref().map(|_| (100.0 - floor).max(0.0));
    if !is_dependent {
        marks.push(layer(Series::new("interactions", INTERACTIONS), &rest));
    }
    let panel = Panel::new(of.axis(), Axis::new("share of the variance (%)", "")).with(marks);
    let caption = match is_dependent {
        true => {
            "Shapley effects of factors that depend on each other, if they were asked for: they share out all of the variance."
        }
        false => {
            "What each factor does alone (first-order indices, those below 0 as 0), and in grey what is left: what factors do \
                  together."
        }
    };
    Chart::new(of.title("shares of the variance"), caption).panels([panel])
}
