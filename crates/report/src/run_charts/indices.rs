//! The indices: first order with total.

use apportion::result::{IndexRecord, OutputResult, StudyResult};

use super::super::chart::Chart;
use super::super::factor_bars::{INDEX, INDICES, MAX_BARS, both_orders, index_panel, not_drawn, pair_panel};
use super::super::format::name;
use super::super::leading::leader_of;

/// Draws the first-order and total index of every factor, as parts of the output's variance, with their intervals; the
/// largest total index on top. Of more than 20 factors, the first 20.
pub fn indices_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let indices: Vec<&IndexRecord> = output.indices.iter().flatten().collect();
    let names = indices.iter().map(|index| name(&index.factor));
    let names = names.chain(output.noise.iter().map(|noise| format!("noise ({})", name(&noise.name))));
    let effects = || indices.iter().map(|index| &index.effect).chain(output.noise.iter().map(|noise| &noise.effect));
    let (factors, first_order) = (names.collect(), effects().map(|effect| Some(effect.first_order)).collect());
    let total = effects().map(|effect| Some(effect.total)).collect();
    let keys: Vec<f64> = effects().map(|effect| effect.weight().estimate).collect();
    let panel = match indices.iter().any(|index| index.effect.dependent.is_some()) {
        true => {
            let mut series = both_orders(first_order, total);
            let names = ["S_1, first order: with dependence on others", "S_T, total: without dependence on others"];
            series.iter_mut().zip(names).for_each(|((series, _), name)| series.name = name.to_owned());
            index_panel(INDEX, factors, series, INDICES, &keys)
        }
        false => pair_panel(factors, first_order, total, &keys),
    };
    let title = format!("{}: indices of {}", result.study.headline(), name(&output.name));
    Chart::new(title, leader_of(output) + &not_drawn(indices.len(), MAX_BARS)).panels([panel])
}
