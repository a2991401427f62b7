//! The indices themselves: first order with total, and total against first order.

use super::super::chart::{Axis, Chart, Colour, Mark, Panel, Point, Series, Shape};
use super::super::factor_bars::{INDEX, MOST, both_orders, index_panel, left_out, not_drawn, pair_panel};
use super::super::format::name;
use super::super::leading::{by_total, leader_of};
use super::super::result::{IndexRecord, OutputRecord, ResultFile};
use super::headline;

/// Points with a total index below this part of the largest are not told apart from the origin.
const VISIBLE: f64 = 0.02;

/// First-order and total index of every factor, as parts of the output's variance, with their intervals; the largest total
/// index on top. Of more than 21 factors, the first 20, and the sums of the others.
pub fn indices_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
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
            let names = ["S_1, first order: with all that it tells of others", "S_T, total: what it has on its own"];
            series.iter_mut().zip(names).for_each(|((series, _), name)| series.name = name.to_owned());
            index_panel(INDEX, factors, series, &keys)
        }
        false => pair_panel(factors, first_order, total, &keys),
    };
    let title = format!("{}: indices of {}", headline(result), name(&output.name));
    Chart::new(title, leader_of(output) + &left_out(indices.len())).panels([panel])
}

/// Every factor (at most 20, those with the largest total indices) by its first-order and its total index: on the dashed
/// line it acts alone, above it together with others.
pub fn interactions_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let title = format!("{}: what acts on {} alone, what together", headline(result), name(&output.name));
    let order = by_total(output).unwrap_or_default();
    let largest = order.first().map_or(0.0, |(_, index)| index.effect.total.estimate);
    let series = Series::new("factor, with the 95 % intervals of both indices", Colour::Series(0));
    let point = |(_, index): &(usize, &IndexRecord)| {
        let (x, y) = (index.effect.first_order, index.effect.total);
        series.mark(Shape::Point(Point {
            x: x.estimate,
            y: y.estimate,
            // At the origin points lie on one another: a label would stand for any of them.
            label: if y.estimate > VISIBLE * largest { name(&index.factor) } else { String::new() },
            x_interval: x.low.zip(x.high),
            y_interval: y.low.zip(y.high),
        }))
    };
    let x = Axis::new("first-order index S_1: what the factor does alone", "");
    let y = Axis::new("total index S_T: with all its interactions", "");
    let points = order.iter().take(MOST).map(point);
    let panel = Panel::new(x, y).with(points).with([Mark::slope(1.0, "S_T = S_1")]);
    let caption =
        "On the dashed line a factor acts alone; the farther above it, the more it acts together with others.";
    Chart::new(title, format!("{caption}{}", not_drawn(order.len(), MOST))).panels([panel])
}
