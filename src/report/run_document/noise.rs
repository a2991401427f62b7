//! The noise of a stochastic model: what it is of a single run, and the indices of the mean over it.

use super::interactions::complement;
use super::tables::{FACTORS, largest};
use crate::report::document::{Cell, Column, Part, Table};
use crate::report::format::{name, percent};
use crate::report::leading::by_total;
use crate::report::result::{IndexRecord, NoiseRecord, OutputRecord, ResultFile};

/// How much of the variance of a single run no factor explains, of a stochastic model.
pub(super) fn sentence(result: &ResultFile, output: &OutputRecord) -> String {
    let Some(noise) = &output.noise else { return String::new() };
    let of =
        repetitions(result).map_or_else(|| "a single run".to_owned(), |number| format!("a value of {number} runs"));
    format!("Of the variance of {of}, {} is noise that no factor explains.", percent(noise.effect.total))
}

/// How many runs a row is made of, if it is more than one.
fn repetitions(result: &ResultFile) -> Option<u64> {
    result.study.settings.get("repetitions").and_then(serde_json::Value::as_u64)
}

/// What the noise of a stochastic model is of a single run, and which indices the mean over it has.
pub(super) fn noise(result: &ResultFile, output: &OutputRecord) -> Vec<Part> {
    let Some(noise) = &output.noise else { return Vec::new() };
    let left = if repetitions(result).is_some() {
        " The seeds of these runs are their own, and the noise is what so few leave. The mean over it is the mean, or the \
         variance, of endless many."
    } else {
        ""
    };
    let single = format!(
        "{}{left} If the factors were unknown and the noise known, {} of it would go.",
        sentence(result, output),
        percent(noise.effect.first_order)
    );
    let rest = complement(noise.effect.total);
    let exists = noise.mean_share.estimate > 0.0;
    let seen = rest.low.is_none_or(|low| low > 0.0);
    let mean = match (exists, seen) {
        (false, _) => "The runs show no variance of the mean over the noise, which hence has no indices.".to_owned(),
        (true, false) => format!(
            "The mean over the noise has {} of that variance, perhaps none: of its indices nothing is known for sure.",
            percent(rest)
        ),
        _ => format!(
            "The mean over the noise has the other {}: its indices below are of that variance alone.",
            percent(rest)
        ),
    };
    let totals = noise.of_mean.iter().any(|of_mean| of_mean.total.is_some());
    let ask = if totals {
        ""
    } else {
        " Its total indices take one more run for each factor: `mean_totals = true` in [noise]."
    };
    let meaning = "First-order indices of the factors, the total index of the noise and all indices of the mean are those of \
                   the model. Total indices of the factors and the first-order index of the noise also rest on how the \
                   program makes noise of its seed: rows that differ in a factor alone share the seed.";
    let mut parts =
        vec![Part::Text(single), Part::Text(mean + ask), Part::OnPage(vec![Part::Text(meaning.to_owned())])];
    parts.extend(exists.then(|| Part::Table(table(output, noise))));
    parts
}

/// First-order indices of the values beside the indices of the mean over the noise.
fn table(output: &OutputRecord, noise: &NoiseRecord) -> Table {
    let order = by_total(output).unwrap_or_default();
    let shown = &order[..order.len().min(FACTORS)];
    let row = |(_, index): &(usize, &IndexRecord)| -> Vec<Cell> {
        let of_mean = noise.of_mean.iter().find(|of_mean| of_mean.name == index.factor);
        vec![
            name(&index.factor).into(),
            Cell::from(Some(index.effect.first_order)),
            Cell::from(of_mean.and_then(|of_mean| of_mean.first_order)),
            Cell::from(of_mean.and_then(|of_mean| of_mean.total)),
        ]
    };
    let last = ["of the noise".into(), Cell::from(Some(noise.effect.first_order)), Cell::default(), Cell::default()];
    let last = (shown.len() == order.len()).then(|| last.to_vec());
    let caption = format!(
        "Indices of the values and of the mean over the noise, each of its own variance.{}",
        largest(shown.len(), order.len(), "factors, all in the JSON file")
    );
    let columns = Column::list(1, &["factor", "S_1 of a value", "S_1 of the mean", "S_T of the mean"]);
    Table::new(caption, columns).with_rows(shown.iter().map(row).chain(last))
}
