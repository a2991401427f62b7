//! What the published percentages could mean: sentences, the chart of distances, and every reading with its numbers.

use super::cells::plain;
use super::{header, link};
use crate::reproduce::readings::{
    Chance, Reading, Readings, SmallSample, chances, distance_chart, headline, small_sample_chart, summary,
};
use crate::reproduce::{GROUPS, Reproduction, published};
use apportion::report::chart::Chart;
use apportion::report::fixed;
use apportion::report::page::{Cell, OnPhone, PageFigure, PageTable, Part, Section};

/// The charts of the readings with the stems of their files.
pub(in crate::reproduce) fn charts(readings: &Readings) -> [(&'static str, Chart); 2] {
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
        link("readings as CSV", "readings.csv"),
        link("small samples as CSV", "small-samples.csv"),
        link("both as JSON", "readings.json"),
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
    Some(super::section("readings", "What the published percentages could mean", parts))
}

fn figure(stem: &str, chart: Chart) -> Part {
    let file = |ending: &str| link(&ending.to_uppercase(), &format!("figures/{stem}.{ending}"));
    Part::Figure(Box::new(PageFigure {
        id: stem.to_owned(),
        label: String::new(),
        beside: String::new(),
        chart,
        links: ["svg", "png"].map(file).to_vec(),
    }))
}

/// The readings of one group, the nearest first, with the shares of the factors that have a printed percentage.
fn table(readings: &Readings, group: &str) -> PageTable {
    let printed = published(group, "lugre").shares;
    let mut rows: Vec<&Reading> = readings.rows.iter().filter(|reading| reading.group == group).collect();
    rows.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let share = |reading: &Reading, factor: &str| {
        let share = reading.shares.iter().find(|share| share.factor == factor);
        plain(share.map_or_else(String::new, |share| format!("{} %", fixed(share.share, 1))))
    };
    let row = |reading: &&Reading| {
        let mut cells = vec![plain(reading.statement.clone()), plain(fixed(reading.distance, 1))];
        cells.extend(printed.iter().map(|(factor, _)| share(reading, factor)));
        cells.push(plain(reading.runs.to_string()));
        cells
    };
    let factors = printed.iter().map(|(factor, value)| format!("{}, printed {value} %", factor.replace('_', " ")));
    let names = ["reading", "distance (points)"].into_iter().map(str::to_owned).chain(factors);
    PageTable {
        caption: format!("The readings of the {group} study, the nearest to the printed percentages first."),
        header: names.chain(["model runs".to_owned()]).collect(),
        numeric: (1..3 + printed.len()).collect(),
        on_phone: OnPhone::Scroll,
        rows: rows.iter().map(row).collect(),
    }
}

fn small_samples(readings: &Readings) -> PageTable {
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
        let name = factor.factor.replace('_', " ");
        let range = factor.quantiles.map_or_else(String::new, |[low, _, median, _, high]| {
            format!("{name} {} % [{}, {}]", fixed(median, 1), fixed(low, 1), fixed(high, 1))
        });
        let place = factor.published_quantile.map_or_else(String::new, |q| format!("{} %", fixed(100.0 * q, 1)));
        [plain(range), plain(place)]
    };
    let row = |sample: &SmallSample| {
        let [range, place] = leading(sample);
        vec![
            plain(sample.group),
            plain(sample.variant),
            plain(format!("{} of {}", sample.effect.symbol(), sample.output.name().replace('_', " "))),
            plain(sample.estimators.name()),
            plain(sample.base_samples.to_string()),
            range,
            place,
            plain(chance(sample.within_1)),
            plain(chance(sample.within_3)),
        ]
    };
    let repetitions = readings.small_samples.first().map_or(0, |sample| sample.repetitions);
    PageTable {
        caption: format!(
            "Shares of the leading factor in {repetitions} repetitions with N plain random base points: median and middle \
             95 %; how many of the repetitions lie below the printed percentage; and how many meet all printed \
             percentages of the study to within 1 and 3 points, with 95 % intervals."
        ),
        header: header(&[
            "study",
            "variant",
            "share of",
            "estimators",
            "N",
            "leading share",
            "below printed",
            "within 1",
            "within 3",
        ]),
        numeric: (4..9).collect(),
        on_phone: OnPhone::Scroll,
        rows: readings.small_samples.iter().map(row).collect(),
    }
}
