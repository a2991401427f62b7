//! The readings as CSV and JSON.

use serde_json::json;

use super::Readings;
use super::small_samples::QUANTILES;

/// One line per group, reading and factor; the distance and the runs are those of the whole reading. Percentages and
/// distances in percent, empty where there is none.
pub fn readings_csv(readings: &Readings) -> String {
    let mut text = String::from(
        "group,reading,axis,settings,effect,output,factor,share,share_low,share_high,published,distance,distance_error,model_runs,runs_failed\n",
    );
    for reading in &readings.rows {
        let settings = reading.settings.join("; ");
        let axis = json!(reading.axis);
        for share in &reading.shares {
            let cells = [
                reading.group.to_owned(),
                reading.id.clone(),
                axis.as_str().unwrap_or_default().to_owned(),
                settings.clone(),
                reading.effect.name().to_owned(),
                reading.output.name().to_owned(),
                share.factor.clone(),
                share.share.to_string(),
                cell(share.interval.map(|interval| interval.0)),
                cell(share.interval.map(|interval| interval.1)),
                cell(share.published),
                reading.distance.to_string(),
                cell(reading.distance_error),
                reading.runs.to_string(),
                reading.runs_failed.to_string(),
            ];
            text.push_str(&(cells.join(",") + "\n"));
        }
    }
    text
}

/// One line per sample and factor: quantiles of its percentage over the repetitions, the printed percentage, its place
/// among them, and how often all printed percentages of the group are met.
pub fn small_samples_csv(readings: &Readings) -> String {
    let quantiles = QUANTILES.map(|p| format!("q{}", 100.0 * p)).join(",");
    let mut text = format!(
        "variant,group,base_samples,estimators,effect,output,repetitions,with_shares,factor,{quantiles},published,\
         published_quantile,within_1,within_1_low,within_1_high,within_3,within_3_low,within_3_high\n"
    );
    for sample in &readings.small_samples {
        for factor in &sample.factors {
            let mut cells = vec![
                sample.variant.to_owned(),
                sample.group.to_owned(),
                sample.base_samples.to_string(),
                sample.estimators.name().to_owned(),
                sample.effect.name().to_owned(),
                sample.output.name().to_owned(),
                sample.repetitions.to_string(),
                sample.with_shares.to_string(),
                factor.factor.clone(),
            ];
            cells.extend((0..QUANTILES.len()).map(|place| cell(factor.quantiles.map(|quantiles| quantiles[place]))));
            cells.extend([cell(factor.published), cell(factor.published_quantile)]);
            for chance in [sample.within_1, sample.within_3] {
                cells.extend([chance.share, chance.low, chance.high].map(|x| x.to_string()));
            }
            text.push_str(&(cells.join(",") + "\n"));
        }
    }
    text
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

fn cell(number: Option<f64>) -> String {
    number.map_or_else(String::new, |number| number.to_string())
}
