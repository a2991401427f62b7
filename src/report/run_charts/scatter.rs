//! The output over its most influential factors.

use super::super::chart::{Axis, Chart, CloudChart, CloudPanel, LineSeries, Role, Spacing, Stroke};
use super::super::format::{axis_unit, printed, the, words};
use super::super::result::{FactorRecord, OutputRecord, ResultFile};
use super::super::scatter::{ConditionalMeansRecord, ScatterRecord};
use super::categories::Categories;
use super::{friction, headline, no_indices};

/// What the line is called.
pub(super) const SLICES: &str = "mean over a slice of the factor";
/// Up to so many slices, each mean is marked by a point.
const FEW_SLICES: usize = 12;
/// Where the median lies below this part of the largest value, a linear axis would press most points into its foot.
const PRESSED: f64 = 0.02;

/// The output against each of the factors with the largest total indices (at most six): some of the model runs as dots,
/// and the mean of the output over slices of the factor, with its standard error, as a line with a band.
pub fn scatter_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let scatter = output.scatter.as_ref();
    let panels = scatter.map_or_else(Vec::new, |scatter| panels(result, output, scatter));
    let empty =
        CloudPanel { title: String::new(), x: Axis::default(), names: Vec::new(), dots: Vec::new(), lines: Vec::new() };
    Chart::Cloud(CloudChart {
        title: format!("{}: {} over its factors", headline(result), the(&output.name)),
        caption: scatter.map_or_else(|| nothing(output), |scatter| caption(result, output, scatter)),
        y: Axis {
            label: words(&output.name),
            unit: axis_unit(&output.unit),
            spacing: scatter.map_or(Spacing::Linear, spacing),
        },
        dots: "model run".to_owned(),
        role: friction(result),
        panels: if panels.is_empty() { vec![empty] } else { panels },
    })
}

/// Why there is nothing to draw: no indices, or a result of an earlier version.
fn nothing(output: &OutputRecord) -> String {
    match output.indices {
        None => no_indices(output),
        Some(_) => format!("No scatter of {}: the result holds none.", the(&output.name)),
    }
}

fn panels(result: &ResultFile, output: &OutputRecord, scatter: &ScatterRecord) -> Vec<CloudPanel> {
    let panel = |(place, name): (usize, &String)| {
        let record = result.factors.iter().find(|factor| factor.name == *name);
        let index = output.indices.iter().flatten().find(|index| index.factor == *name);
        let categories = record.and_then(Categories::of);
        let dots = scatter.points.iter().filter_map(|point| Some((*point.get(place)?, *point.last()?)));
        let means = scatter.conditional_means.iter().find(|means| means.factor == *name);
        let (dots, line) = match &categories {
            Some(categories) => (categories.strips(dots), means.map(|means| categories.levels(line(means)))),
            None => (dots.collect(), means.map(line)),
        };
        CloudPanel {
            title: index.map_or_else(String::new, |index| {
                let [first_order, total] = [index.effect.first_order, index.effect.total].map(|i| two(i.estimate));
                format!("S1 {first_order}, ST {total}")
            }),
            x: Axis {
                label: words(name),
                // Names have no unit.
                unit: record
                    .filter(|_| categories.is_none())
                    .map_or_else(String::new, |factor| axis_unit(&factor.unit)),
                spacing: record.map_or(Spacing::Linear, factor_spacing),
            },
            names: categories.map_or_else(Vec::new, |categories| categories.labels),
            dots,
            lines: line.into_iter().collect(),
        }
    };
    scatter.factors.iter().enumerate().map(panel).collect()
}

/// An index with two decimals and a true minus sign.
fn two(index: f64) -> String {
    let text = format!("{index:.2}");
    if text == "-0.00" { "0.00".to_owned() } else { text.replace('-', "\u{2212}") }
}

fn factor_spacing(factor: &FactorRecord) -> Spacing {
    match factor.distribution.get("name").and_then(serde_json::Value::as_str) {
        Some("log-uniform") => Spacing::Logarithmic,
        _ => Spacing::Linear,
    }
}

/// Logarithmic for positive values of which most would lie at the foot of a linear axis.
fn spacing(scatter: &ScatterRecord) -> Spacing {
    let mut values: Vec<f64> = scatter.points.iter().filter_map(|point| point.last().copied()).collect();
    values.sort_by(f64::total_cmp);
    let pressed = match (values.first(), values.get(values.len() / 2), values.last()) {
        (Some(least), Some(median), Some(largest)) => *least > 0.0 && *median < PRESSED * largest,
        _ => false,
    };
    if pressed { Spacing::Logarithmic } else { Spacing::Linear }
}

fn line(means: &ConditionalMeansRecord) -> LineSeries {
    let number = |value: Option<&Option<f64>>| value.copied().flatten().unwrap_or(f64::NAN);
    let at = |place: usize| (means.x[place], number(means.low.get(place)), number(means.high.get(place)));
    let few = means.x.len() <= FEW_SLICES;
    LineSeries {
        name: if few { "mean at a value of the factor" } else { SLICES }.to_owned(),
        role: Role::Reference,
        stroke: if few { Stroke::SolidWithPoints } else { Stroke::Solid },
        points: means.x.iter().enumerate().map(|(place, x)| (*x, number(means.mean.get(place)))).collect(),
        band: (0..means.x.len()).map(at).collect(),
    }
}

/// What is seen, what the marks are, and which factors are left out.
fn caption(result: &ResultFile, output: &OutputRecord, scatter: &ScatterRecord) -> String {
    let unit = axis_unit(&output.unit);
    let space = if unit.is_empty() { "" } else { " " };
    let moved = scatter.conditional_means.first().and_then(|means| {
        let known = || means.mean.iter().flatten().copied();
        let (low, high) = (known().reduce(f64::min)?, known().reduce(f64::max)?);
        Some(format!(
            "Over the range of {} the mean of {} lies between {} and {}{space}{unit}. ",
            the(&means.factor),
            the(&output.name),
            printed(low),
            printed(high)
        ))
    });
    let mut caption = moved.unwrap_or_default();
    caption.push_str(&format!(
        "Dots: {} of the model runs; line: mean over a slice of the factor, with 1.96 standard errors to both sides. The \
         more of the dots' spread the line follows, the larger is the first-order index S1.",
        scatter.points.len()
    ));
    if spacing(scatter) == Spacing::Logarithmic {
        caption.push_str(" The axis is logarithmic; most of the variance comes from the highest values.");
    }
    if result.factors.len() > scatter.factors.len() {
        caption.push_str(&format!(
            " Of {} factors, the {} with the largest total indices are drawn.",
            result.factors.len(),
            scatter.factors.len()
        ));
    }
    caption
}
