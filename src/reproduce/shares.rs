//! Our shares beside the published ones, as one table: for the page, for a terminal, and as CSV.

use super::{Reproduced, published};
use apportion::Estimate;
use apportion::report::csv::Field;
use apportion::report::document::{Cell, Column, Table, Value};
use apportion::report::fixed;
use apportion::report::format::words;
use apportion::result::IndexRecord;

/// The indices of a study's factors.
pub(super) fn indices(study: &Reproduced) -> &[IndexRecord] {
    study.result.outputs.first().and_then(|output| output.indices.as_deref()).unwrap_or_default()
}

/// The places of a study's factors among its [`indices`], the largest total share first.
pub(super) fn ranked(study: &Reproduced) -> Vec<usize> {
    let shares = indices(study).iter().enumerate();
    let mut ranked: Vec<(usize, f64)> =
        shares.filter_map(|(place, index)| Some((place, index.effect.share_total?))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked.into_iter().map(|(place, _)| place).collect()
}

/// Every index and share of every study with the printed percentage, printed with the largest total share of each study
/// first; in the file in the order of its factors.
pub(super) fn shares_table(studies: &[&Reproduced]) -> Table {
    let share = |share: Option<Estimate>| {
        let text = share.map_or_else(|| "–".to_owned(), |share| fixed(share.estimate, 1));
        Cell::valued(text, Value::Estimate(share))
    };
    let (mut rows, mut printed) = (Vec::new(), Vec::new());
    for study in studies {
        let ranked = ranked(study);
        let print = published(study.group.key, study.friction.key);
        printed.extend(ranked.iter().map(|place| rows.len() + place));
        for (place, IndexRecord { factor, effect }) in indices(study).iter().enumerate() {
            // Only the first row of a study names it.
            let named = |text: &str, value: &str| {
                Cell::valued(if ranked.first() == Some(&place) { text } else { "" }, value.into())
            };
            let percent = print.share(factor);
            rows.push(vec![
                named(study.group.key, study.group.key),
                named(study.friction.name, study.friction.key),
                Cell::valued(words(factor), factor.into()),
                effect.first_order.into(),
                effect.total.into(),
                share(effect.first_order_percent()),
                share(effect.total_percent()),
                Cell::valued(percent.map_or_else(String::new, |percent| percent.to_string()), percent.into()),
            ]);
        }
    }
    let caption = "First-order and total indices of every study with their 95 % intervals, their shares, and the \
                   percentages that LG prints; the CSV file has the intervals of the shares too.";
    let columns = [
        Column::text("study").named(Field::new("study")),
        Column::text("friction").named(Field::new("friction")),
        Column::text("factor").named(Field::new("factor")),
        Column::number("S_1"),
        Column::number("S_T"),
        Column::number("% of S_1").named(Field::estimate("share_first_order")),
        Column::number("% of S_T").named(Field::estimate("share_total")),
        Column::number("printed").named(Field::new("published")),
    ];
    Table { printed: Some(printed), ..Table::new(caption, columns).with_rows(rows) }
}
