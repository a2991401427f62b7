//! What the published percentages could mean: sentences, the chart of distances, and every reading with its numbers.

use crate::reproduce::readings::{
    Chance, Effect, Joint, Readings, SmallSample, VARIANTS, chances, distance_chart, headline, joint,
    small_sample_chart, summary, words,
};
use crate::reproduce::{GROUPS, Reproduction};
use apportion::report::chart::Chart;
use apportion::report::document::{Cell, Column, Figure, Part, Section, Table};
use apportion::report::fixed;
use apportion::report::format::words as spelled;

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
    let [distances, small] = charts(readings).map(|(stem, chart)| figure(stem, chart));
    parts.push(distances);
    parts.push(Part::Details {
        summary: format!("All {} readings", joint(readings).len()),
        parts: vec![Part::OnScreen {
            instead: "The table of all readings is on the screen and in readings.csv.".to_owned(),
            parts: vec![Part::Table(table(readings)), meanings()],
        }],
    });
    parts.push(Part::Details {
        summary: "Small samples, and how probable the printed percentages are in them".to_owned(),
        parts: vec![
            small,
            Part::List(chances(readings)),
            Part::OnScreen {
                instead: "The table of all small samples is on the screen and in small-samples.csv.".to_owned(),
                parts: vec![Part::Table(small_samples(readings))],
            },
        ],
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

/// Every reading in a row, the nearest on the mean of the groups first.
fn table(readings: &Readings) -> Table {
    let mut rows = joint(readings);
    rows.sort_by(|a, b| a.mean.total_cmp(&b.mean));
    let row = |joint: &Joint<'_>| -> Vec<Cell> {
        let names = joint.of_groups.first().map_or([""; 3], |reading| words(reading)).map(Cell::from);
        let distances = joint.of_groups.iter().map(|reading| reading.distance).chain([joint.mean]);
        names.into_iter().chain(distances.map(|distance| fixed(distance, 1).into())).collect()
    };
    let names = ["friction", "output", "measure"].map(Column::text).into_iter();
    let distances = GROUPS.iter().map(|group| group.key).chain(["mean"]).map(Column::number);
    let caption = "Every reading with its distance to the printed percentages in each study, in percentage points, the \
                   nearest on the mean first.";
    Table::new(caption, names.chain(distances)).with_rows(rows.iter().map(row))
}

/// What stands in the columns of frictions and of measures.
fn meanings() -> Part {
    let frictions = VARIANTS.iter().map(|variant| format!("{}: {}.", variant.name, variant.statement));
    let measures = Effect::ALL.iter().map(|effect| format!("{}: {}.", effect.symbol(), effect.statement()));
    Part::List(frictions.chain(measures).collect())
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
        let name = spelled(&factor.factor);
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
            format!("{} of {}", sample.effect.symbol(), spelled(sample.output.name())).into(),
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
