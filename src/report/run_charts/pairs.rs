//! What factors do two by two: second-order indices as a map.

use super::super::chart::{Axis, Chart, Colour, Panel, Series, Shape, Tile};
use super::super::factor_bars::not_drawn;
use super::super::format::{index, name, percent};
use super::super::leading::{Contender, may_lead, names, surely_interact};
use super::super::result::{EstimateRecord, IndexRecord, OutputRecord, PairRecord, ResultFile};
use super::map::{class, series, short};
use super::{headline, no_indices};

/// Most factors: of more, the figures would not fit into the cells of a phone.
const MOST: usize = 15;
/// The lightest shade.
const NOTHING: &str = "below 0.01, or may be 0";

/// Second-order indices of every two factors as shades and figures, with the first-order indices on the diagonal; the factor with
/// the largest total index is the first. Of more than 15 factors, the first 15; the last ones that show nothing are left out.
pub fn pairs_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let title = format!("{}: what acts on {} two by two", headline(result), name(&output.name));
    let mut factors: Vec<&IndexRecord> = output.indices.iter().flatten().collect();
    let all = factors.len();
    factors.sort_by(|a, b| b.effect.weight().estimate.total_cmp(&a.effect.weight().estimate));
    factors.truncate(MOST);
    let mut tiles: Vec<(usize, Tile)> = Vec::new();
    let (mut shown, drawn) = (2.min(factors.len()), factors.len());
    let sure = surely_interact(output.second_order.as_deref().unwrap_or_default());
    for (row, below) in factors.iter().enumerate() {
        for (column, left) in factors.iter().enumerate().take(row + 1) {
            let (value, may_be_nothing) = match row == column {
                true => (below.effect.first_order, below.effect.first_order.low.is_some_and(|low| low <= 0.0)),
                false => {
                    let Some((place, value)) = pair(output, [&below.factor, &left.factor]) else { continue };
                    (value, value.low.is_some() && !sure[place])
                }
            };
            let class = if may_be_nothing { 0 } else { class(value.estimate) };
            if class > 0 {
                shown = shown.max(row + 1);
            }
            tiles.push((class, Tile { row, column, letter: short(value.estimate), tip: index(value) }));
        }
    }
    factors.truncate(shown);
    tiles.retain(|(_, tile)| tile.row < shown);
    // The legend is in the order of the marks.
    tiles.sort_by_key(|(class, tile)| (*class, tile.row, tile.column));
    let marks = tiles.into_iter().map(|(class, tile)| {
        let series = if class == 0 { Series::new(NOTHING, Colour::Shade(0)) } else { series(Some(class)) };
        series.mark(Shape::Tile(tile))
    });
    let marks: Vec<_> = marks.collect();
    let names = factors.iter().zip(1..).map(|(index, number)| format!("{} ({number})", name(&index.factor)));
    let rows = Axis::from_names("", names.collect());
    let columns =
        Axis::from_names("the factors by their numbers", (1..=factors.len()).map(|n| n.to_string()).collect());
    let panel = Panel::new(columns, rows).with(marks);
    Chart::new(title, caption(output, all, drawn - shown)).panels([panel])
}

/// The second-order index of two factors in any order, and its place.
fn pair(output: &OutputRecord, [one, other]: [&str; 2]) -> Option<(usize, EstimateRecord)> {
    let is_theirs = |[a, b]: &[String; 2]| (a == one && b == other) || (a == other && b == one);
    let (place, pair) = output.second_order.iter().flatten().enumerate().find(|(_, pair)| is_theirs(&pair.factors))?;
    Some((place, pair.index)).filter(|(_, index)| index.estimate.is_finite())
}

/// Which two factors act together most, if any are sure to, and which of all are not drawn since there are many, or since they
/// show nothing.
fn caption(output: &OutputRecord, all: usize, idle: usize) -> String {
    let Some(pairs) = &output.second_order else {
        return match output.indices {
            Some(_) => format!("No second-order indices of {}: the study does not ask for them.", name(&output.name)),
            None => no_indices(output),
        };
    };
    let meaning = "Below the diagonal, what two factors do together beyond what each does alone (S_ij); on it, what each does \
                   alone (S_i).";
    let sure = pairs.iter().zip(surely_interact(pairs)).filter_map(|(pair, is_sure)| is_sure.then_some(pair));
    let contender = |pair: &PairRecord| Contender {
        label: pair.factors.each_ref().map(|factor| name(factor)).join(" and "),
        first_order: None,
        total: pair.index,
        probability: None,
    };
    let sure: Vec<Contender> = sure.map(contender).collect();
    let part = |contender: &Contender| percent(contender.total);
    let has_intervals = pairs.iter().any(|pair| pair.index.low.is_some());
    let seen = match &may_lead(&sure)[..] {
        [most] => format!("The largest interaction of two is that of {}: {}.", sure[*most].label, part(&sure[*most])),
        tied @ [_, ..] => {
            format!("Which two factors interact most cannot be told: {}.", names(&sure, tied, &part))
        }
        [] if has_intervals => {
            let of_all = if pairs.len() > 1 { ", widened for all pairs at once" } else { "" };
            format!("No two factors are sure to act together: 0 is within the interval of every pair{of_all}.")
        }
        [] => "Without intervals, how sure the interactions are is unknown.".to_owned(),
    };
    let of = match (all > MOST, idle) {
        (true, 1) => "one of these",
        (true, _) => "of these",
        (false, 1) => "factor",
        (false, _) => "factors",
    };
    let left_out = match idle {
        0 => not_drawn(all, MOST),
        _ => {
            let many = match all > MOST {
                true => format!(" Of {all} factors, the {MOST} with the largest total indices are told of."),
                false => String::new(),
            };
            let which = if idle == 1 { format!("The last {of} is") } else { format!("The last {idle} {of} are") };
            format!("{many} {which} not drawn: every cell there is {NOTHING}.")
        }
    };
    format!("{seen} {meaning}{left_out}")
}
