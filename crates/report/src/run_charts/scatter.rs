//! The values of an output: against its most influential factors, which may be categories, and their distribution.

use apportion::result::{
    FactorDistribution, FactorRecord, OutputDistribution, OutputResult, ScatterRecord, StudyResult,
};
use serde_json::Value;

use crate::chart::{Axis, Chart, Colour, Mark, Panel, Series, Shape, Spacing, Stroke};
use crate::factor_bars::not_drawn;
use crate::format::{axis_unit, fixed, grouped, minus, name, short_among, significant, words};
use crate::leading::no_indices;
use crate::output_view::effects;

/// Part of the largest value below which the median makes a linear axis unreadable: most points would be at its foot.
const PRESSED: f64 = 0.02;

/// Draws the output against each of the factors with the largest total indices (at most six): some model runs as dots,
/// and the mean of the output over slices of the factor, with its standard error, as a line with a band.
pub fn scatter_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let scatter = output.scatter.as_ref();
    let y = Axis::new(words(&output.name), axis_unit(&output.unit)).spaced(scatter.map_or(Spacing::Linear, spacing));
    let mut panels = Vec::new();
    if let Some(scatter) = scatter {
        for place in 0..scatter.factors.len() {
            panels.push(scatter_panel(result, output, scatter, place, y.clone()));
        }
    }
    if panels.is_empty() {
        panels.push(Panel::new(Axis::default(), y));
    }
    let title = format!("{}: values of {} over its factors", result.study.headline(), name(&output.name));
    let caption = scatter.map_or_else(|| no_indices(output), |scatter| caption(result, scatter));
    Chart::new(title, caption).side_by_side().panels(panels)
}

/// Draws the output against the factor at `place` of its scatter record.
fn scatter_panel(result: &StudyResult, output: &OutputResult, scatter: &ScatterRecord, place: usize, y: Axis) -> Panel {
    let name = &scatter.factors[place];
    let record = result.factors.iter().find(|factor| factor.name == *name);
    let title = effects(output).find(|(factor, _)| factor == name).map_or_else(String::new, |(_, effect)| {
        let [first_order, total] = [effect.first_order, effect.total].map(|index| minus(&fixed(index.estimate, 2)));
        format!("S_1 {first_order}, S_T {total}")
    });
    let categories = record.and_then(Categories::new);
    let (x, stroke) = match &categories {
        // Names have no unit, and nothing is drawn between two of them.
        Some(categories) => (Axis::from_names(words(name), categories.labels.clone()), Stroke::Points),
        None => {
            let unit = record.map_or_else(String::new, |factor| axis_unit(&factor.unit));
            (Axis::new(words(name), unit).spaced(record.map_or(Spacing::Linear, factor_spacing)), Stroke::Solid)
        }
    };
    let mut dots = Vec::new();
    for point in &scatter.points {
        dots.extend(point.get(place).zip(point.last()).map(|(x, y)| (place_on_axis(&categories, *x), *y)));
    }
    let mut panel = Panel::new(x, y).titled(title);
    panel = panel.with([Series::new("model run", Colour::Series(0)).mark(Shape::Dots(dots))]);
    if let Some(means) = scatter.conditional_means.iter().find(|means| means.factor == *name) {
        let (mut band, mut line) = (Vec::new(), Vec::new());
        for (k, x) in means.x.iter().enumerate() {
            let x = place_on_axis(&categories, *x);
            let [low, mean, high] =
                [&means.low, &means.mean, &means.high].map(|list| list.get(k).copied().flatten().unwrap_or(f64::NAN));
            band.push((x, low, high));
            line.push((x, mean));
        }
        let series = Series::new("mean over a slice of the factor", Colour::Reference).stroke(stroke);
        panel = panel.with([series.band(band), series.line(line)]);
    }
    panel
}

/// Returns the position of a value on the axis of its factor.
fn place_on_axis(categories: &Option<Categories>, x: f64) -> f64 {
    categories.as_ref().map_or(x, |categories| categories.place(x))
}

fn factor_spacing(factor: &FactorRecord) -> Spacing {
    match factor.distribution.name.as_str() {
        "log-uniform" => Spacing::Logarithmic,
        _ => Spacing::Linear,
    }
}

/// Returns a logarithmic spacing for positive values of which most would be at the foot of a linear axis.
fn spacing(scatter: &ScatterRecord) -> Spacing {
    let mut values: Vec<f64> = scatter.points.iter().filter_map(|point| point.last().copied()).collect();
    values.sort_by(f64::total_cmp);
    let pressed = match (values.first(), values.get(values.len() / 2), values.last()) {
        (Some(least), Some(median), Some(largest)) => *least > 0.0 && *median < PRESSED * largest,
        _ => false,
    };
    if pressed { Spacing::Logarithmic } else { Spacing::Linear }
}

/// Describes the marks, and names the factors that are not drawn.
fn caption(result: &StudyResult, scatter: &ScatterRecord) -> String {
    format!(
        "Dots: {} of the model runs; line: mean over a slice of the factor, with 1.96 standard errors on both sides. The more \
         the line varies compared with the dots, the larger the first-order index S_1.{}",
        scatter.points.len(),
        not_drawn(result.factors.len(), scatter.factors.len())
    )
}

/// Maximum number of categories with labels; more are drawn by number, since their labels would be only a letter long.
const MAX_CATEGORIES: usize = 12;

/// The labels of a factor, and the numbers that represent them in the result.
pub(super) struct Categories {
    /// In the order of the study.
    pub labels: Vec<String>,
    values: Vec<f64>,
}

impl Categories {
    /// Returns the categories of a factor that has few.
    pub fn new(factor: &FactorRecord) -> Option<Self> {
        let FactorDistribution { name, parameters } = &factor.distribution;
        let (labels, values): (Vec<String>, Vec<f64>) = match name.as_str() {
            "boolean" => (vec!["false".to_owned(), "true".to_owned()], vec![0.0, 1.0]),
            "categorical" => {
                let labels = parameters.get("labels")?.as_array()?.iter();
                let values = parameters.get("values")?.as_array()?.iter();
                (
                    labels.map(|label| label.as_str().map(str::to_owned)).collect::<Option<_>>()?,
                    values.map(Value::as_f64).collect::<Option<_>>()?,
                )
            }
            _ => return None,
        };
        let few = (1..=MAX_CATEGORIES).contains(&labels.len()) && labels.len() == values.len();
        few.then_some(Self { labels, values })
    }

    /// Returns the position of a value; NaN for one that is not a category.
    pub fn place(&self, value: f64) -> f64 {
        self.values.iter().position(|other| *other == value).map_or(f64::NAN, |place| place as f64)
    }
}

/// Draws the distribution of an output; without values, the reason.
pub fn distribution_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let title = format!("{}: distribution of {}", result.study.headline(), name(&output.name));
    let output_words = words(&output.name);
    if let Some(distribution) = &output.distribution {
        // With the mean of the values, not that of the page, which surrogates may have corrected.
        let mut chart = histogram_chart(distribution, &title, &output_words);
        if distribution.count < distribution.values {
            chart.caption.push_str(&format!(" They were kept of all {}.", grouped(distribution.values)));
        }
        return chart;
    }
    let beyond = || "its values are beyond double precision in this unit".to_owned();
    let reason = output.reason.map_or_else(beyond, |reason| reason.to_string());
    let panel = Panel::new(Axis::new(output_words, ""), Axis::new("probability density", ""));
    Chart::new(title, format!("No distribution of {}: {reason}.", name(&output.name))).panels([panel])
}

/// Draws the distribution of an output: the histogram as an area of steps, and marks at the mean and at the 2.5, 50 and
/// 97.5 % quantiles. A constant output has only its mark.
fn histogram_chart(distribution: &OutputDistribution, title: &str, output: &str) -> Chart {
    let symbol = &axis_unit(distribution.unit.symbol());
    let per_unit = match symbol.as_str() {
        "" => String::new(),
        simple if simple.chars().all(char::is_alphabetic) => format!("1/{simple}"),
        product => format!("1/({product})"),
    };
    let panel = Panel::new(Axis::new(output, symbol.as_str()), Axis::new("probability density", per_unit));
    Chart::new(title, histogram_caption(distribution, output, symbol)).panels([panel.with(marks(distribution))])
}

fn marks(distribution: &OutputDistribution) -> Vec<Mark> {
    let mean = distribution.mean;
    let Some(histogram) = &distribution.histogram else {
        let series = Series::new("all values", Colour::Series(0)).stroke(Stroke::Points);
        return vec![series.line(vec![(mean, 0.0)]), Mark::rule(mean, format!("all values {}", significant(mean)))];
    };
    // Both upper corners of every bin over its lower ones.
    let mut steps = Vec::new();
    for (ends, &count) in histogram.edges.windows(2).zip(&histogram.counts) {
        let height = count as f64 / distribution.count as f64 / (ends[1] - ends[0]);
        steps.extend([(ends[0], 0.0, height), (ends[1], 0.0, height)]);
    }
    let mut marks = vec![Series::new("histogram", Colour::Series(0)).band(steps)];
    let (low, high) = distribution.central().unzip();
    let places = [(low, "2.5 %"), (distribution.quantile(50.0), "median"), (Some(mean), "mean"), (high, "97.5 %")];
    for (place, name) in places {
        // Marks outside the histogram would compress it.
        if let (Some(x), [first, .., last]) = (place, &histogram.edges[..])
            && (first..=last).contains(&&x)
        {
            marks.push(Mark::rule(x, format!("{name} {}", short(x, distribution))));
        }
    }
    marks
}

/// Formats with the digits that distinguish the values, and a true minus sign.
fn short(x: f64, distribution: &OutputDistribution) -> String {
    minus(&short_among(x, distribution.spread()))
}

/// Describes the chart in one sentence.
fn histogram_caption(distribution: &OutputDistribution, output: &str, symbol: &str) -> String {
    let unit = if symbol.is_empty() { String::new() } else { format!(" {symbol}") };
    let n = distribution.count;
    let output = name(output);
    let Some(histogram) = &distribution.histogram else {
        return format!("All {n} values of {output} are {}{unit}.", significant(distribution.mean));
    };
    let (whose, (low, high)) = match distribution.central() {
        Some(ends) => (format!("95 % of the {n} values"), ends),
        None => (format!("The {n} values"), (distribution.min, distribution.max)),
    };
    let mut caption = format!(
        "{whose} of {output} lie between {} and {}{unit}, their mean is {}{unit}",
        short(low, distribution),
        short(high, distribution),
        short(distribution.mean, distribution)
    );
    let beyond = histogram.below + histogram.above;
    if beyond > 0 {
        let extremes = (short(distribution.min, distribution), short(distribution.max, distribution));
        let values = if beyond == 1 { "value lies" } else { "values lie" };
        caption.push_str(&format!(
            "; {beyond} {values} outside the picture (smallest {}, largest {}{unit})",
            extremes.0, extremes.1
        ));
    }
    caption + "."
}
