//! The distribution of an output: its histogram.

use apportion::result::{OutputDistribution, OutputResult, StudyResult};

use crate::chart::{Axis, Chart, Colour, Mark, Panel, Series, Stroke};
use crate::format::{axis_unit, grouped, minus, name, short_among, significant, words};

/// Draws the distribution of an output; without values, the reason.
pub fn distribution_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let title = format!("{}: distribution of {}", result.study.headline(), name(&output.name));
    let output_words = words(&output.name);
    if let Some(distribution) = &output.distribution {
        // With the mean of the values, not that of the page, which surrogates may have corrected.
        let sample = &distribution.sample;
        let mut chart = histogram_chart(sample, &title, &output_words);
        if sample.count < distribution.values {
            chart.caption.push_str(&format!(" They were kept of all {}.", grouped(distribution.values)));
        }
        return chart;
    }
    let reason = output.reason.as_deref().unwrap_or("its values are beyond double precision in this unit");
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
    Chart::new(title, caption(distribution, output, symbol)).panels([panel.with(marks(distribution))])
}

fn marks(distribution: &OutputDistribution) -> Vec<Mark> {
    let mean = distribution.mean;
    let Some(histogram) = &distribution.histogram else {
        let series = Series::new("all values", Colour::Series(0)).stroke(Stroke::Points);
        return vec![series.line(vec![(mean, 0.0)]), Mark::rule(mean, format!("all values {}", significant(mean)))];
    };
    // Both upper corners of every bin over its lower ones.
    let corners = |(ends, &count): (&[f64], &u64)| {
        let height = count as f64 / distribution.count as f64 / (ends[1] - ends[0]);
        [(ends[0], 0.0, height), (ends[1], 0.0, height)]
    };
    let steps = histogram.edges.windows(2).zip(&histogram.counts).flat_map(corners).collect();
    let (low, high) = distribution.central().unzip();
    let places = [(low, "2.5 %"), (distribution.quantile(50.0), "median"), (Some(mean), "mean"), (high, "97.5 %")];
    // Marks outside the histogram would compress it.
    let ends = histogram.edges.first().zip(histogram.edges.last());
    let rule = |(x, name): (Option<f64>, &str)| {
        let x = x.filter(|x| ends.is_some_and(|(low, high)| (low..=high).contains(&x)))?;
        Some(Mark::rule(x, format!("{name} {}", short(x, distribution))))
    };
    let histogram = Series::new("histogram", Colour::Series(0)).band(steps);
    std::iter::once(histogram).chain(places.into_iter().filter_map(rule)).collect()
}

/// Formats with the digits that distinguish the values, and a true minus sign.
fn short(x: f64, distribution: &OutputDistribution) -> String {
    minus(&short_among(x, distribution.spread()))
}

/// Describes the chart in one sentence.
fn caption(distribution: &OutputDistribution, output: &str, symbol: &str) -> String {
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
