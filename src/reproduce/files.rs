//! The files of a reproduction.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::claims::{claims_csv, claims_json};
use super::figures::ANIMATION_STEM;
use super::page::{page, reading_charts};
use super::readings::{readings_csv, readings_json, small_samples_csv};
use super::{ReproduceError, Reproduction, shares_csv};
use apportion::report::chart::png;
use apportion::report::{result_json, write_atomically};

/// Writes everything about `reproduction` into `folder` and returns the files, the page first.
///
/// Beside `index.html` stand the results of the studies, `shares.csv`, the claims and the readings as CSV and JSON, and
/// in `figures/` every figure as SVG, PNG and CSV. But for the page and the times in the results, the bytes are the same
/// for every run of the same version.
///
/// # Errors
/// [`ReproduceError`] if a chart cannot be drawn or a file cannot be written.
pub fn write_all(folder: &Path, reproduction: &Reproduction) -> Result<Vec<PathBuf>, ReproduceError> {
    let mut files = vec![("index.html".to_owned(), page(reproduction).html()?.into_bytes())];
    let mut text = |name: &str, text: String| files.push((name.to_owned(), text.into_bytes()));
    for study in &reproduction.studies {
        text(&format!("{}-{}.json", study.friction.key, study.group.key), result_json(&study.result));
    }
    if !reproduction.studies.is_empty() {
        text("shares.csv", shares_csv(&reproduction.studies));
    }
    if !reproduction.claims.is_empty() {
        text("claims.csv", claims_csv(&reproduction.claims)?);
        text("claims.json", claims_json(&reproduction.claims)?);
    }
    if let Some(readings) = &reproduction.readings {
        text("readings.csv", readings_csv(readings));
        text("readings.json", readings_json(readings));
        text("small-samples.csv", small_samples_csv(readings));
    }
    if let Some(animation) = &reproduction.animation {
        let mut file =
            |ending: &str, content: &str| text(&format!("figures/{ANIMATION_STEM}.{ending}"), content.to_owned());
        file("html", &animation.html);
        file("csv", &animation.csv);
        file("json", &animation.json);
    }
    files.extend(pictures(reproduction)?);
    std::fs::create_dir_all(folder.join("figures"))
        .map_err(|source| apportion::report::WriteError { path: folder.join("figures"), source })?;
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
    for (path, (_, bytes)) in paths.iter().zip(&files) {
        write_atomically(path, bytes)?;
    }
    Ok(paths)
}

/// Every figure as SVG, PNG and CSV.
fn pictures(reproduction: &Reproduction) -> Result<Vec<(String, Vec<u8>)>, ReproduceError> {
    let charts = reproduction.figures.iter().map(|figure| (figure.stem, &figure.chart, Some(&figure.csv)));
    let readings = reproduction.readings.iter().flat_map(|readings| reading_charts(readings));
    let readings: Vec<_> = readings.collect();
    let charts: Vec<_> = charts.chain(readings.iter().map(|(stem, chart)| (*stem, chart, None))).collect();
    let drawn: Result<Vec<_>, ReproduceError> = charts
        .into_par_iter()
        .map(|(stem, chart, csv)| {
            let svg = chart.svg()?;
            let picture = png(&svg)?.bytes;
            let mut files =
                vec![(format!("figures/{stem}.svg"), svg.into_bytes()), (format!("figures/{stem}.png"), picture)];
            files.extend(csv.map(|csv| (format!("figures/{stem}.csv"), csv.clone().into_bytes())));
            Ok(files)
        })
        .collect();
    Ok(drawn?.into_iter().flatten().collect())
}
