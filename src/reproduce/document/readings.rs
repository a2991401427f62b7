//! What the published percentages could mean: sentences, the chart of distances, and every reading with its numbers.

use crate::reproduce::readings::{
    Chance, Reading, Readings, SmallSample, chances, distance_chart, headline, small_sample_chart, summary,
};
use crate::reproduce::{GROUPS, Reproduction, published};
use apportion::report::chart::Chart;
use apportion::report::document::{Cell, Column, Figure, Link, Part, Section, Table};
use apportion::report::fixed;
use apportion::report::format::words;

/// The charts of the readings with the stems of their files.
fn charts(readings: &Readings) -> [(&'static str, Chart); 2] {
    [("readings-distances", distance_chart(readings)), ("readings-small-samples", small_sample_chart(readings))]
}

/// What the top of the page says of the published percentages.
pub(super) fn paragraph(reproduction: &Reproduction) -> Option<String> {
    Some(headline(reproduction.readings.as_ref()?).join(" "))
}

pub(super) fn section(reproduction: &Reproduction) -> Option<Section> {
    let readings = reproduction.readings.as_ref()?;
    let mut parts = vec![Part::Text(
        "LG prints percentages without saying of what. Below stands every meaning that we could think of, stated before \
         it was computed, with its distance to what is printed: the root mean square, in percentage points, over the \
         factors with a printed percentage and all others taken together. Nothing was tuned."
            .to_owned(),
    )];
    parts.push(Part::List(summary(readings)));
    parts.extend(charts(readings).into_iter().map(|(stem, chart)| figure(stem, chart)));
    parts.push(Part::Links(vec![
        Link::new("readings as CSV", "readings.csv"),
        Link::new("small samples as CSV", "small-samples.csv"),
        Link::new("both as JSON", "readings.json"),
    ]));
    for group in GROUPS {
        parts.push(Part::Details {
            summary: format!("Every reading of the {} study", group.key),
            parts: vec![Part::Table(table(readings, group.key))],
        });
    }
    parts.push(Part::Details {
        summary: "Every small sample, and how probable the printed percentages are in it".to_owned(),
        parts: vec![Part::List(chances(readings)), Part::Table(small_samples(readings))],
    });
    Some(Section::new("readings", "What the published percentages could mean", parts))
}

fn figure(stem: &str, chart: Chart) -> Part {
    Part::Figure(Box::new(Figure {
        id: stem.to_owned(),
        label: String::new(),
        title: None,
        beside: String::new(),
        chart,
        stem: stem.to_owned(),
        data: String::new(),
    }))
}

/// The readings of one group, the nearest first, with the shares of the factors that have a printed percentage.
fn table(readings: &Readings, group: &str) -> Table {
    let printed = published(group, "lugre").shares;
    let mut rows: Vec<&Reading> = readings.rows.iter().filter(|reading| reading.group == group).collect();
    rows.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let share = |reading: &Reading, factor: &str| {
        let share = reading.shares.iter().find(|share| share.factor == factor);
        share.map_or_else(String::new, |share| format!("{} %", fixed(share.share, 1)))
    };
    let row = |reading: &&Reading| {
        let mut cells = vec![Cell::from(&reading.statement), fixed(reading.distance, 1).into()];
        cells.extend(printed.iter().map(|(factor, _)| Cell::from(share(reading, factor))));
        cells.push(reading.runs.to_string().into());
        cells
    };
    let factors = printed.iter().map(|(factor, value)| format!("{}, printed {value} %", words(factor)));
    let numbers = ["distance (points)".to_owned()].into_iter().chain(factors).chain(["model runs".to_owned()]);
    let columns = [Column::text("reading")].into_iter().chain(numbers.map(Column::number));
    let caption = format!("The readings of the {group} study, the nearest to the printed percentages first.");
    Table::new(caption, columns).with_rows(rows.iter().map(row))
}

fn small_samples(readings: &Readings) -> Table {
    let chance = |chance: Chance| {
        let Chance { share, low, high, .. } = chance;
        format!("{} % [{}, {}]", fixed(100.0 * share, 1), fixed(100.0 * low, 1), fixed(100.0 * high, 1))
    };
    let leading = |sample: &SmallSample| -> [Cell; 2] {
        let first = sample
            .factors
            .iter()
            .filter(|factor| factor.published.is_some())
            .max_by(|a, b| a.published.unwrap_or_default().total_cmp(&b.published.unwrap_or_default()));
        let Some(factor) = first else { return [Cell::default(), Cell::default()] };
        let name = words(&factor.factor);
        let range = factor.quantiles.map_or_else(String::new, |[low, _, median, _, high]| {
            format!("{name} {} % [{}, {}]", fixed(median, 1), fixed(low, 1), fixed(high, 1))
        });
        let place = factor.published_quantile.map_or_else(String::new, |q| format!("{} %", fixed(100.0 * q, 1)));
        [range.into(), place.into()]
    };
    let row = |sample: &SmallSample| {
        let [range, place] = leading(sample);
        vec![
            sample.group.into(),
            sample.variant.into(),
            format!("{} of {}", sample.effect.symbol(), words(sample.output.name())).into(),
            sample.estimators.name().into(),
            sample.base_samples.to_string().into(),
            range,
            place,
            chance(sample.within_1).into(),
            chance(sample.within_3).into(),
        ]
    };
    let repetitions = readings.small_samples.first().map_or(0, |sample| sample.repetitions);
    let caption = format!(
        "Shares of the leading factor in {repetitions} repetitions with N plain random base points: median and middle \
         95 %; how many of the repetitions lie below the printed percentage; and how many meet all printed \
         percentages of the study to within 1 and 3 points, with 95 % intervals."
    );
    let columns = Column::list(
        4,
        &["study", "variant", "share of", "estimators", "N", "leading share", "below printed", "within 1", "within 3"],
    );
    Table::new(caption, columns).with_rows(readings.small_samples.iter().map(row))
}
