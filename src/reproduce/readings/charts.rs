//! The readings as charts.

use super::catalogue::{BASE, BOTH, SMALL_SAMPLES, symbol};
use super::nearest::{ALIKE, Joint, distinct, joint};
use super::{Effect, Estimators, Readings, SmallSample};
use crate::reproduce::{GROUPS, published};
use apportion::model::AfmOutput;
use apportion::report::chart::{Axis, Bar, Chart, Colour, Mark, Panel, Series, Shape, Spacing, Stroke};
use apportion::report::fixed;

/// Most readings that are drawn, the nearest ones.
const MOST: usize = 10;
/// Colours of the groups, and of the kinds of percentages.
const GROUP_COLOURS: [Colour; 3] = [Colour::Series(1), Colour::Series(4), Colour::Series(5)];

/// How far every reading is from the printed percentages: a row for each, the nearest on the mean of the groups first, a
/// bar for each group. Readings that are alike share a row.
pub fn distance_chart(readings: &Readings) -> Chart {
    let all = joint(readings).len();
    let distinct = distinct(readings);
    let drawn = &distinct[..distinct.len().min(MOST)];
    let rows = Axis::from_names("", drawn.iter().map(Joint::name).collect());
    let bars = GROUPS.iter().enumerate().flat_map(|(number, group)| {
        let series = Series::new(printed(group.key), GROUP_COLOURS[number]);
        let bar = move |(row, joint): (usize, &Joint<'_>)| {
            let to = joint.of_groups.get(number).map_or(f64::NAN, |reading| reading.distance);
            series.mark(Shape::Bar(Bar { row, to, ..Bar::default() }))
        };
        drawn.iter().enumerate().map(bar)
    });
    let notes = drawn.iter().enumerate().map(|(row, joint)| Mark::note(row, note(joint)));
    let x = Axis::new("distance to the printed percentages", "points");
    let panels = (!drawn.is_empty()).then(|| Panel::new(x, rows).with(bars).with(notes));
    Chart::new("How far each reading is from the printed percentages", caption(all, &distinct, drawn)).panels(panels)
}

/// The mean distance, and for how many others the row stands.
fn note(joint: &Joint<'_>) -> String {
    let mean = fixed(joint.mean, 1);
    let error = joint.mean_error().filter(|error| *error >= 0.05);
    let error = error.map_or_else(String::new, |error| format!(" ± {}", fixed(error, 1)));
    match joint.alike.len() {
        0 => format!("mean {mean}{error}"),
        alike => format!("mean {mean}{error}; {alike} more alike"),
    }
}

fn caption(all: usize, distinct: &[Joint<'_>], drawn: &[Joint<'_>]) -> String {
    let seen = drawn.first().map_or_else(String::new, |nearest| {
        format!(
            "The reading nearest on the mean, {}, is still {} percentage points away in one group",
            nearest.name(),
            fixed(nearest.largest(), 1)
        )
    });
    let left_out = match distinct.len() - drawn.len() {
        0 => String::new(),
        more => format!(", and {more} farther ones are in the table alone"),
    };
    format!(
        "{seen}; root mean square over the printed factors and all others together, {all} readings, of which those within \
         {ALIKE} points of each other share a row{left_out}."
    )
}

/// A group with what LG prints of it, such as `environmental: E 74, V 26 %`.
fn printed(group: &str) -> String {
    let shares = published(group, "lugre").shares.iter();
    let shares: Vec<String> = shares.map(|(factor, share)| format!("{} {share}", letter(factor))).collect();
    format!("{group}: {} %", shares.join(", "))
}

/// The symbol of a factor in the papers.
fn letter(factor: &str) -> &str {
    apportion::afm::Parameter::from_name(factor).map_or(factor, |parameter| parameter.symbol)
}

/// How the percentage of the first printed factor of each group scatters with the size of the sample, in the base
/// reading, by the estimators of Saltelli and Jansen: median and the middle 95 % of the repetitions.
pub fn small_sample_chart(readings: &Readings) -> Chart {
    let of_base = |sample: &&SmallSample| sample.variant == BASE && sample.estimators == Estimators::SaltelliJansen;
    let samples: Vec<&SmallSample> = readings.small_samples.iter().filter(of_base).collect();
    let repetitions = samples.first().map_or(0, |sample| sample.repetitions);
    let panels = GROUPS.iter().map(|group| {
        let of_group: Vec<&SmallSample> = samples.iter().copied().filter(|sample| sample.group == group.key).collect();
        panel(group.key, &of_group)
    });
    let caption = format!(
        "Medians and the middle 95 % of {repetitions} repetitions with N random base points under LuGre friction, \
         estimators of Saltelli (2010) and Jansen (1999): where the dashed line runs through a band, chance could have \
         made that one percentage; above each panel stands how often, at the size and index where it is most frequent, it \
         makes all of the group."
    );
    Chart::new("What chance makes of the percentages of small samples", caption).panels(panels)
}

fn panel(group: &str, samples: &[&SmallSample]) -> Panel {
    let x = Axis::new("base samples N", "").spaced(Spacing::Logarithmic);
    let Some((factor, value)) = published(group, "lugre").shares.first().copied() else {
        return Panel::new(x, Axis::default()).titled(group);
    };
    let kinds = [
        (Effect::FirstOrder, AfmOutput::CriticalForce),
        (Effect::Total, AfmOutput::CriticalForce),
        (Effect::FirstOrder, AfmOutput::LogCriticalForce),
    ];
    let marks = |((effect, output), colour): ((Effect, AfmOutput), Colour)| {
        let of_kind = samples.iter().filter(|sample| (sample.effect, sample.output) == (effect, output));
        let quantiles: Vec<(f64, [f64; 5])> = of_kind
            .filter_map(|sample| {
                let factor = sample.factors.iter().find(|candidate| candidate.factor == factor)?;
                Some((sample.base_samples as f64, factor.quantiles?))
            })
            .collect();
        let name = format!("{} of {}", effect.symbol(), symbol(output));
        let series = Series::new(name, colour).stroke(Stroke::SolidWithPoints);
        [
            series.band(quantiles.iter().map(|&(n, [low, _, _, _, high])| (n, low, high)).collect()),
            series.line(quantiles.iter().map(|&(n, [_, _, median, _, _])| (n, median)).collect()),
        ]
    };
    let printed = Series::new("printed", Colour::Reference).stroke(Stroke::Dashed);
    let printed = printed.line(SMALL_SAMPLES.map(|n| (n as f64, value)).to_vec());
    Panel::new(x, Axis::new(format!("share of {}", letter(factor)), "%"))
        .titled(format!("{group}: {} {value} % printed{}", letter(factor), all_met(samples)))
        .with(kinds.into_iter().zip(GROUP_COLOURS).flat_map(marks))
        .with([printed])
}

/// How often all printed percentages of the group are met to 3 points, at most, for each output.
fn all_met(samples: &[&SmallSample]) -> String {
    let most = |output: AfmOutput| {
        let of_output = samples.iter().filter(|sample| sample.output == output);
        let share = of_output.map(|sample| sample.within_3.share).max_by(f64::total_cmp)?;
        Some(format!("{} % ({})", fixed(100.0 * share, 1), symbol(output)))
    };
    let most: Vec<String> = BOTH.into_iter().filter_map(most).collect();
    if most.is_empty() { String::new() } else { format!("; all met to 3 points in at most {}", most.join(", ")) }
}
