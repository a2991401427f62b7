//! A screening as JSON, CSV, text and charts.

mod charts;
mod record;

pub use charts::{screening_charts, screening_suffixes};
pub use record::{
    FactorScreeningRecord, OutputScreeningRecord, ScreeningFailureRecord, ScreeningFile, ScreeningProvenance,
    build_screening,
};

use super::asked::{cell, csv_text, json, short, validity_lines, words};
use super::result::EstimateRecord;
use super::table;

/// The screening as JSON text, ending in a newline.
pub fn screening_json(file: &ScreeningFile) -> String {
    json(file)
}

/// The screening as CSV: one line per output and factor; an empty cell where there is no number.
pub fn screening_csv(file: &ScreeningFile) -> String {
    let header = "output,unit,factor,rank,mu_star,mu_star_low,mu_star_high,mu,mu_low,mu_high,sigma,sigma_low,sigma_high,\
                  ratio,ratio_low,ratio_high,reading,could_be_fixed,effects,dropped";
    let header = header.split(',').map(str::to_owned).collect();
    let row = |output: &OutputScreeningRecord, factor: &FactorScreeningRecord| {
        let mut row = vec![output.name.clone(), output.unit.clone(), factor.factor.clone(), factor.rank.to_string()];
        for estimate in [factor.mu_star, factor.mu, factor.sigma, factor.ratio] {
            row.push(cell(estimate.map(|e| e.estimate)));
            row.push(cell(estimate.and_then(|e| e.low)));
            row.push(cell(estimate.and_then(|e| e.high)));
        }
        row.push(factor.reading.map_or_else(String::new, |reading| reading.words().to_owned()));
        row.push(factor.could_be_fixed.map_or_else(String::new, |fixed| fixed.to_string()));
        row.extend([factor.effects.to_string(), factor.dropped.to_string()]);
        row
    };
    let rows = file.outputs.iter().flat_map(|output| output.factors.iter().map(move |factor| row(output, factor)));
    csv_text(std::iter::once(header).chain(rows))
}

/// The screening as text: for every output a table of its factors by rank, and what to note.
pub fn screening_summary(file: &ScreeningFile) -> String {
    let mut text = String::new();
    for output in &file.outputs {
        text.push_str(&format!("{} [{}], effects per full range of each factor\n", output.name, output.unit));
        let mut table = table(&["factor", "mu*", "mu", "sigma", "sigma/mu*", "reading", "could be fixed"], &[0, 5, 6]);
        let mut ranked: Vec<&FactorScreeningRecord> = output.factors.iter().collect();
        ranked.sort_by_key(|factor| factor.rank);
        for factor in ranked {
            let plain = |estimate: Option<EstimateRecord>| {
                estimate.map_or_else(|| "-".to_owned(), |estimate| short(estimate.estimate))
            };
            table.add_row([
                factor.factor.clone(),
                factor.mu_star.map_or_else(|| "-".to_owned(), with_interval),
                plain(factor.mu),
                plain(factor.sigma),
                plain(factor.ratio),
                factor.reading.map_or("-", |reading| reading.words()).to_owned(),
                factor.could_be_fixed.map_or("-", |fixed| if fixed { "yes" } else { "no" }).to_owned(),
            ]);
        }
        text.push_str(&format!("{table}\n"));
        for warning in &output.warnings {
            text.push_str(&format!("warning: {warning}\n"));
        }
        for failure in &output.failures {
            let first: Vec<String> = failure.first_inputs.iter().map(|(name, x)| format!("{name} = {x}")).collect();
            let ScreeningFailureRecord { reason, runs, .. } = failure;
            text.push_str(&format!("failed: {runs} runs: {reason} (first at {})\n", first.join(", ")));
        }
        text.push_str(&format!("{}\n", fixable_words(output)));
    }
    for note in &file.notes {
        text.push_str(&format!("note: {note}\n"));
    }
    text + &validity_lines(&file.validity)
}

/// `40.12 [38.9, 41.3]`, or the estimate alone where there is no interval.
fn with_interval(record: EstimateRecord) -> String {
    match (record.low, record.high) {
        (Some(low), Some(high)) => format!("{} [{}, {}]", short(record.estimate), short(low), short(high)),
        _ => short(record.estimate),
    }
}

/// Which factors could be fixed, and by which rule.
fn fixable_words(output: &OutputScreeningRecord) -> String {
    let fixable: Vec<String> =
        output.factors.iter().filter(|f| f.could_be_fixed == Some(true)).map(|f| words(&f.factor)).collect();
    let rule = format!(
        "the upper bound of mu* below {} % of the largest mu*, by at least half of the effects",
        100.0 * crate::screening::FIXABLE
    );
    if output.factors.iter().all(|factor| factor.could_be_fixed.is_none()) {
        return format!("no factor has any effect on {} here: nothing to rank", words(&output.name));
    }
    match &fixable[..] {
        [] => format!("no factor could be fixed ({rule})"),
        names => format!("could be fixed for {}: {} ({rule})", words(&output.name), names.join(", ")),
    }
}
