//! Interactions of pairs of factors: second-order indices as a map.

use apportion::result::{OutputResult, StudyResult};
use apportion::uncertainty::Estimate;

use super::super::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};
use super::super::factor_bars::not_drawn;
use super::super::format::{index, name};
use super::super::leading::{by_total, surely_interact};
use super::map::{class, series, short};

/// Maximum number of factors: with more, the figures would not fit into the cells on a phone.
const MAX_PAIRS: usize = 15;
/// The lightest shade.
const NOTHING: &str = "below 0.01, or may be 0";

/// Draws second-order indices of all pairs of factors as shades and figures, with the first-order indices on the
/// diagonal; the factor with the largest total index is the first. Of more than 15 factors, the first 15.
pub fn pairs_chart(result: &StudyResult, output: &OutputResult) -> Chart {
    let title = format!("{}: interactions of pairs of factors, for {}", result.study.headline(), name(&output.name));
    let order = by_total(output).unwrap_or_default();
    let factors = &order[..order.len().min(MAX_PAIRS)];
    let sure = surely_interact(output.second_order.as_deref().unwrap_or_default());
    let mut tiles: Vec<(usize, Tile)> = Vec::new();
    for (row, (_, below)) in factors.iter().enumerate() {
        for (column, (_, left)) in factors.iter().enumerate().take(row + 1) {
            let (value, may_be_nothing) = match row == column {
                true => (below.effect.first_order, below.effect.first_order.interval.is_some_and(|i| i.low <= 0.0)),
                false => {
                    let Some((place, value)) = pair(output, [&below.factor, &left.factor]) else { continue };
                    (value, value.interval.is_some() && !sure[place])
                }
            };
            let class = if may_be_nothing { 0 } else { class(value.estimate) };
            tiles.push((class, Tile { row, column, letter: short(value.estimate), tip: index(value) }));
        }
    }
    // The legend is in the order of the marks.
    tiles.sort_by_key(|(class, tile)| (*class, tile.row, tile.column));
    let marks = tiles.into_iter().map(|(class, tile)| {
        let series = if class == 0 { Series::new(NOTHING, Colour::Shade(0)) } else { series(Some(class)) };
        series.mark(Shape::Tile(tile))
    });
    let names = factors.iter().zip(1..).map(|((_, index), number)| format!("{} ({number})", name(&index.factor)));
    let rows = Axis::from_names("", names.collect());
    let columns =
        Axis::from_names("the factors by their numbers", (1..=factors.len()).map(|n| n.to_string()).collect());
    let caption = format!(
        "Below the diagonal, the interaction of two factors (second-order index S_ij); on it, the effect of each alone \
         (S_i).{}",
        not_drawn(order.len(), MAX_PAIRS)
    );
    Chart::new(title, caption).panels([Panel::new(columns, rows).with(marks)])
}

/// Returns the second-order index of two factors in any order, and its position.
fn pair(output: &OutputResult, [one, other]: [&str; 2]) -> Option<(usize, Estimate)> {
    let is_theirs = |[a, b]: &[String; 2]| (a == one && b == other) || (a == other && b == one);
    let (place, pair) = output.second_order.iter().flatten().enumerate().find(|(_, pair)| is_theirs(&pair.factors))?;
    Some((place, pair.index)).filter(|(_, index)| index.estimate.is_finite())
}
