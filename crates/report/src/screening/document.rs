//! A screening as a document.

use apportion::result::json;
use apportion::screening::{FIXABLE, ScreenedFactor, ScreenedOutput};
use apportion::text::listed;
use apportion::uncertainty::Estimate;

use super::ScreeningFile;
use super::charts::{bars, leader, scatter};
use crate::document::{Document, OutputReport, Report, Table};
use crate::format::{grouped, index, name, or_dash, short, words};
use crate::leading::NAMES;
use crate::run_document::{FACTORS, IN_CSV};
use crate::study_sections::{failures, inputs};

/// Builds the document of a screening.
pub fn screening_document(file: &ScreeningFile) -> Document {
    let outputs = file.outputs.iter().map(|output| {
        let failed = output.failures.iter().map(|f| (&*f.reason, inputs(&f.first_inputs), f.runs));
        OutputReport {
            name: &output.name,
            unit: &output.unit,
            warnings: &output.warnings,
            answer: format!("{} {}", leader(output), fixable(output)),
            parts: failures(failed).into_iter().chain([effects(output).into()]).collect(),
            charts: vec![("-bars", bars(file, output)), ("", scatter(file, output))],
        }
    });
    let provenance = &file.provenance;
    let mut rows = vec![("design", provenance.design.clone())];
    rows.extend(provenance.sampler.iter().map(|sampler| ("sampler", sampler.clone())));
    rows.extend(provenance.levels.iter().map(|levels| ("levels", levels.to_string())));
    rows.extend([
        ("trajectories", grouped(provenance.trajectories)),
        ("seed", provenance.seed.to_string()),
        ("model runs", grouped(provenance.model_runs)),
        ("runs that failed", grouped(provenance.failed_runs)),
        ("threads", provenance.threads.to_string()),
        ("time", format!("{} s", short(provenance.wall_seconds))),
        ("intervals", provenance.interval.clone()),
    ]);
    Report {
        name: format!("{}-screen", file.study.name),
        kicker: "Screening of a study",
        title: file.study.headline().to_owned(),
        outputs: outputs.collect(),
        notes: &file.notes,
        validity: &file.validity,
        failed_runs: (provenance.failed_runs, provenance.model_runs),
        study: Some(&file.study),
        version: &provenance.apportion_version,
        provenance: rows,
        json: json(file),
        ..Report::default()
    }
    .document()
}

/// Tabulates the factors of an output by rank.
fn effects(output: &ScreenedOutput) -> Table {
    let plain = |estimate: Option<Estimate>| or_dash(estimate, |estimate| short(estimate.estimate));
    let caption = format!(
        "Elementary effects on {} per full range of each factor: mean size μ* with its 95 % interval, mean μ, standard \
         deviation σ.",
        name(&output.name)
    );
    let mut ranked: Vec<usize> = (0..output.factors.len()).collect();
    ranked.sort_by_key(|&place| output.factors[place].rank);
    let reading = |factor: &ScreenedFactor| factor.reading.map(|reading| reading.words());
    let rows = Table::from_rows(caption, &output.factors)
        .file("output", |_| &output.name)
        .file("unit", |_| &output.unit)
        .text("factor", |factor| name(&factor.factor))
        .value("factor", |factor| &factor.factor)
        .file("rank", |factor| factor.rank as u64)
        .number("μ*", |factor| or_dash(factor.mu_star, index))
        .estimate("mu_star", |factor| factor.mu_star)
        .number("μ", |factor| plain(factor.mu))
        .estimate("mu", |factor| factor.mu)
        .number("σ", |factor| plain(factor.sigma))
        .estimate("sigma", |factor| factor.sigma)
        .number("σ/μ*", |factor| plain(factor.ratio))
        .estimate("ratio", |factor| factor.ratio)
        .text("reading", |factor| reading(factor).unwrap_or("–"))
        .value("reading", reading)
        .text("could be fixed", |factor| factor.could_be_fixed.map_or("–", |fixed| if fixed { "yes" } else { "no" }))
        .value("could_be_fixed", |factor| factor.could_be_fixed)
        .file("effects", |factor| factor.effects)
        .file("dropped", |factor| factor.dropped);
    rows.largest(ranked, FACTORS, IN_CSV).into()
}

/// Says which factors could be fixed, and by which rule.
fn fixable(output: &ScreenedOutput) -> String {
    let fixable = output.factors.iter().filter(|f| f.could_be_fixed == Some(true)).map(|f| words(&f.factor));
    let fixable: Vec<String> = fixable.collect();
    let names = match fixable.len() {
        0 => "none".to_owned(),
        1..=NAMES => listed(&fixable),
        many => format!("{many} of {} factors", output.factors.len()),
    };
    format!(
        "Could be fixed for {}: {names} (the upper bound of μ* below {} % of the largest μ*, by at least half of the effects).",
        name(&output.name),
        100.0 * FIXABLE
    )
}
