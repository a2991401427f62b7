//! The readings as CSV and JSON.

use serde_json::json;

use super::Readings;
use super::small_samples::QUANTILES;
use apportion::report::EstimateRecord;
use apportion::report::csv::{Csv, Field, fields};
use apportion::report::document::Value;

/// One line per group, reading and factor; the distance and the runs are those of the whole reading. Percentages and
/// distances in percent, empty where there is none.
pub fn readings_csv(readings: &Readings) -> String {
    let names = ["group", "reading", "axis", "settings", "effect", "output", "factor"];
    let more = ["published", "distance", "distance_error", "model_runs", "runs_failed"];
    let columns = fields(&names, &["share"]).into_iter().chain(fields(&more, &[]));
    let mut csv = Csv::new(columns);
    for reading in &readings.rows {
        let axis = json!(reading.axis);
        for share in &reading.shares {
            csv.row::<Value>([
                reading.group.into(),
                (&reading.id).into(),
                axis.as_str().unwrap_or_default().into(),
                reading.settings.join("; ").into(),
                reading.effect.name().into(),
                reading.output.name().into(),
                (&share.factor).into(),
                estimate(share.share, share.interval),
                share.published.into(),
                reading.distance.into(),
                reading.distance_error.into(),
                reading.runs.into(),
                reading.runs_failed.into(),
            ]);
        }
    }
    csv.text()
}

fn estimate(estimate: f64, interval: Option<(f64, f64)>) -> Value {
    EstimateRecord { estimate, low: interval.map(|i| i.0), high: interval.map(|i| i.1) }.into()
}

/// One line per sample and factor: quantiles of its percentage over the repetitions, the printed percentage, its place
/// among them, and how often all printed percentages of the group are met.
pub fn small_samples_csv(readings: &Readings) -> String {
    let names =
        ["variant", "group", "base_samples", "estimators", "effect", "output", "repetitions", "with_shares", "factor"];
    let quantiles = QUANTILES.map(|p| Field::new(format!("q{}", 100.0 * p)));
    let columns = fields(&names, &[]).into_iter().chain(quantiles);
    let mut csv = Csv::new(columns.chain(fields(&["published", "published_quantile"], &["within_1", "within_3"])));
    for sample in &readings.small_samples {
        for factor in &sample.factors {
            let mut values: Vec<Value> = vec![
                sample.variant.into(),
                sample.group.into(),
                sample.base_samples.into(),
                sample.estimators.name().into(),
                sample.effect.name().into(),
                sample.output.name().into(),
                sample.repetitions.into(),
                sample.with_shares.into(),
                (&factor.factor).into(),
            ];
            let quantile = |place: usize| Value::from(factor.quantiles.map(|quantiles| quantiles[place]));
            values.extend((0..QUANTILES.len()).map(quantile));
            values.extend([factor.published.into(), factor.published_quantile.into()]);
            for chance in [sample.within_1, sample.within_3] {
                values.push(estimate(chance.share, Some((chance.low, chance.high))));
            }
            csv.row(values);
        }
    }
    csv.text()
}

/// Everything as JSON, ending in a newline: `readings`, `small_samples`, `summary` (sentences), and `timing`, which alone
/// differs from run to run.
pub fn readings_json(readings: &Readings) -> String {
    let Readings { rows, small_samples, threads, wall_seconds } = readings;
    let value = json!({
        "format": "apportion-readings",
        "version": 1,
        "summary": super::summary(readings),
        "readings": rows,
        "small_samples": small_samples,
        "timing": { "threads": threads, "wall_seconds": wall_seconds },
    });
    format!("{value:#}\n")
}
