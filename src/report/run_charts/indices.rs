//! The indices themselves: first order beside total, and total against first order.

use super::super::chart::{Axis, Chart, Colour, Mark, Panel, Point, Series, Shape};
use super::super::factor_bars::{INDEX, MOST, both_orders, index_panel, left_out, not_drawn, pair_panel};
use super::super::format::{index, name};
use super::super::leading::{Contender, SURE, decides_most, may_lead, moving, names};
use super::super::result::{IndexRecord, OutputRecord, ResultFile};
use super::{headline, no_indices};
use crate::text::listed;

/// Most names in a caption.
const MOST_NAMES: usize = 6;
/// A factor acts almost alone from this part of its total index on, mostly with others below the other part.
const ALONE: f64 = 0.9;
const TOGETHER: f64 = 0.5;
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
    Chart::new(title, indices_caption(output)).panels([panel])
}

/// Every factor (at most 20, those with the largest total indices) by its first-order and its total index: on the dashed
/// line it acts alone, above it together with others.
pub fn interactions_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let title = format!("{}: what acts on {} alone, what together", headline(result), name(&output.name));
    let is_dependent = output.indices.iter().flatten().any(|index| index.effect.dependent.is_some());
    let drawn = if is_dependent { Vec::new() } else { drawn(output) };
    let largest = drawn.iter().map(|index| index.effect.total.estimate).fold(0.0, f64::max);
    let series = Series::new("factor, with the 95 % intervals of both indices", Colour::Series(0));
    let point = |index: &&IndexRecord| {
        let (x, y) = (index.effect.first_order, index.effect.total);
        series.mark(Shape::Point(Point {
            x: x.estimate,
            y: y.estimate,
            // At the origin points lie on one another: a label would stand for any of them. The caption names them.
            label: if y.estimate > VISIBLE * largest { name(&index.factor) } else { String::new() },
            x_interval: x.low.zip(x.high),
            y_interval: y.low.zip(y.high),
        }))
    };
    let x = Axis::new("first-order index S_1: what the factor does alone", "");
    let y = Axis::new("total index S_T: with all its interactions", "");
    let panel = Panel::new(x, y).with(drawn.iter().map(point)).with([Mark::slope(1.0, "S_T = S_1")]);
    let caption = match is_dependent {
        true => "Of factors that depend on each other no interactions can be told from their dependence.".to_owned(),
        false => interactions_caption(result, output),
    };
    Chart::new(title, caption).panels([panel])
}

/// The factors that are drawn.
fn drawn(output: &OutputRecord) -> Vec<&IndexRecord> {
    let mut indices: Vec<&IndexRecord> = output.indices.iter().flatten().collect();
    if indices.len() > MOST {
        indices.sort_by(|a, b| b.effect.total.estimate.total_cmp(&a.effect.total.estimate));
        indices.truncate(MOST);
    }
    indices
}

/// What is seen, and which factors are left out.
fn indices_caption(output: &OutputRecord) -> String {
    let indices = || output.indices.iter().flatten();
    let contenders: Vec<Contender> = indices().map(Contender::of).collect();
    if indices().any(|index| index.effect.dependent.is_some()) {
        return dependent_caption(&contenders, &name(&output.name)) + &left_out(indices().count());
    }
    let Some(mut caption) = decides_most(&contenders, &name(&output.name)) else { return no_indices(output) };
    // A sum below one of its parts, or one that may be 0, says nothing but that the errors are large.
    let largest = indices().map(|index| index.effect.first_order.estimate).fold(0.0, f64::max);
    let sum = output.sum_first_order.filter(|_| output.noise.is_none());
    let sum = sum.filter(|sum| sum.estimate >= largest && sum.low.is_none_or(|low| low > 0.0));
    if let Some(sum) = sum {
        caption.push_str(&format!("; the first-order indices sum to {}", index(sum)));
    }
    caption + "." + &left_out(indices().count())
}

/// Who leads among factors that depend on each other: by the share of each, of the variance or of what is left without it.
fn dependent_caption(contenders: &[Contender], output: &str) -> String {
    let value = |contender: &Contender| index(contender.total);
    match may_lead(contenders)[..] {
        [lead] => format!(
            "For {output}, {} has the largest part of the variance: {}.",
            contenders[lead].label,
            value(&contenders[lead])
        ),
        ref tied => format!("Which has the largest part cannot be told: {}.", names(contenders, tied, &value)),
    }
}

/// Which factors act alone, which together with others, in one sentence.
fn interactions_caption(result: &ResultFile, output: &OutputRecord) -> String {
    let Some(indices) = &output.indices else { return no_indices(output) };
    if moving(output) < 2 {
        return format!("No two factors act together on {}: at most one moves it.", name(&output.name));
    }
    if indices.iter().all(|index| index.effect.first_order.low.is_none()) {
        let output = name(&output.name);
        return format!(
            "Without intervals, what acts on {output} alone and what together with others is unknown.{}",
            not_drawn(indices.len(), MOST)
        );
    }
    let threshold = result.provenance.threshold;
    let mut kinds: [Vec<&str>; 4] = Default::default();
    let (mut idle, mut unsure) = (Vec::new(), Vec::new());
    for index in indices {
        let (first, all) = (index.effect.first_order, index.effect.total.estimate);
        let is_unlikely = index.effect.probability_above_threshold.is_none_or(|above| above < 1.0 - SURE);
        let is_idle = is_unlikely && index.effect.total.high.unwrap_or(all) <= threshold;
        let open =
            first.low.is_some_and(|low| low < TOGETHER * all) && first.high.is_some_and(|high| high > ALONE * all);
        match first.estimate / all {
            _ if is_idle => idle.push(index.factor.as_str()),
            _ if all <= threshold => unsure.push(index.factor.as_str()),
            _ if open => kinds[3].push(&index.factor),
            part if part >= ALONE => kinds[0].push(&index.factor),
            part if part >= TOGETHER => kinds[1].push(&index.factor),
            _ => kinds[2].push(&index.factor),
        }
    }
    let words = [
        "almost only alone",
        "partly alone, partly together with others",
        "mostly together with others",
        "alone or together with others, which the errors leave open",
    ];
    let said = kinds.iter().zip(words).filter(|(names, _)| !names.is_empty());
    let act = |(names, how): (&Vec<&str>, &str)| {
        format!("{} {} {how}", named(names), if names.len() == 1 { "acts" } else { "act" })
    };
    let mut said: Vec<String> = said.map(act).collect();
    if !unsure.is_empty() {
        let whose = if unsure.len() == 1 { "its total index is" } else { "their total indices are" };
        said.push(format!("of {} the errors leave open whether {whose} above {threshold}", named(&unsure)));
    }
    match (idle.len(), said.is_empty()) {
        (0, _) => (),
        (_, true) => said.push(format!("no factor has a total index above {threshold}")),
        (1, _) => said.push(format!("{} has a total index of at most {threshold}", named(&idle))),
        (many, _) if many > MOST_NAMES => said.push(format!("{many} others have a total index of at most {threshold}")),
        _ => said.push(format!("{} have a total index of at most {threshold}", named(&idle))),
    }
    let text = said.join("; ");
    format!("For {}, {text}.{}", name(&output.name), not_drawn(indices.len(), MOST))
}

/// Factors as words; their number, if they are many.
fn named(names: &[&str]) -> String {
    match names {
        _ if names.len() > MOST_NAMES => format!("{} factors", names.len()),
        [only] => name(only),
        _ => listed(&names.iter().map(|own| name(own)).collect::<Vec<_>>()),
    }
}
