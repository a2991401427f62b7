//! The noise of a stochastic model: its share in a single run, and the indices of the mean over it.

use apportion::result::{IndexRecord, NoiseRecord, OutputResult};

use super::shared::complement;
use super::tables::FACTORS;
use crate::document::{Part, Table};
use crate::format::{name, percent};
use crate::leading::by_total;

/// States the share of the variance of a stochastic model's output that no factor explains.
pub(super) fn sentence(output: &OutputResult) -> Option<String> {
    let total = output.noise.as_ref()?.effect.total;
    Some(format!("Of the variance, {} is noise that no factor explains.", percent(total)))
}

/// Describes the noise of a stochastic model, and the indices of the mean over it.
pub(super) fn noise(output: &OutputResult) -> Vec<Part> {
    let Some(noise) = &output.noise else { return Vec::new() };
    let mut text = sentence(output).unwrap_or_default();
    if noise.mean_share.estimate > 0.0 {
        let rest = percent(complement(noise.effect.total));
        text.push_str(&format!(" The mean over the noise has {rest}: its indices refer to that variance only."));
    }
    if noise.of_mean.iter().all(|of_mean| of_mean.total.is_none()) {
        text.push_str(" Its total indices need one more run for each factor: `mean_totals = true` in [noise].");
    }
    let table = (noise.mean_share.estimate > 0.0).then(|| table(output, noise).into());
    [Part::Text(text)].into_iter().chain(table).collect()
}

/// Tabulates the first-order indices of the values next to the indices of the mean over the noise.
fn table(output: &OutputResult, noise: &NoiseRecord) -> Table {
    let order = by_total(output).unwrap_or_default();
    let of_mean = |index: &IndexRecord| noise.of_mean.iter().find(|of_mean| of_mean.name == index.factor);
    Table::from_rows("Indices of the values and of the mean over the noise, each of its own variance.", order)
        .text("factor", |(_, index)| name(&index.factor))
        .number("S_1 of a value", |(_, index)| index.effect.first_order)
        .number("S_1 of the mean", |(_, index)| of_mean(index).and_then(|of_mean| of_mean.first_order))
        .number("S_T of the mean", |(_, index)| of_mean(index).and_then(|of_mean| of_mean.total))
        .first(FACTORS, "factors, all in the JSON file")
        .into()
}
