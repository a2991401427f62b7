//! Our shares beside the published ones: as a table for people, as CSV for programs.

use super::{GROUPS, Published, Reproduced, published};
use crate::report::{EffectRecord, IndexRecord, estimate, fixed, share, share_of_runs, table};

/// A published percentage counts as ours if it lies within one percentage point.
const CLOSE: f64 = 1.0;

/// A factor counts as having a share from this many percent on: less would be printed as 0 in whole percents, which is
/// how LG prints, and is hardly to be seen as a bar.
const VISIBLE: f64 = 0.5;

/// The table that `reproduce` prints: for each group of studies the shares of every factor under every friction model,
/// then the order of the factors, ours and the published one, and whether they agree.
pub fn comparison_table(studies: &[Reproduced]) -> String {
    let mut text = String::new();
    for group in GROUPS {
        text.push_str(&format!("\n{} studies ({})\n", capitalised(group.key), group.figures));
        let header = ["friction", "factor", "S1", "ST", "share S1 %", "share ST %", "published %"];
        let mut table = table(&header, &[0, 1]);
        let members = || studies.iter().filter(|study| study.group == group);
        for member in members() {
            add_rows(&mut table, member);
        }
        text.push_str(&format!("{table}\n"));
        for member in members() {
            text.push_str(&verdict(member));
        }
        text.extend(members().filter_map(outweighing));
        text.extend(members().map(validity));
        text.extend(members().flat_map(warnings));
    }
    text
}

fn add_rows(table: &mut comfy_table::Table, member: &Reproduced) {
    let print = published(member.group.key, member.friction.key);
    for (number, index) in indices(member).iter().enumerate() {
        let effect = &index.effect;
        let friction = if number == 0 { member.friction.name } else { "" };
        table.add_row([
            friction.to_owned(),
            index.factor.clone(),
            fixed(effect.first_order.estimate, 4),
            fixed(effect.total.estimate, 4),
            share(effect.share_first_order, effect.share_first_order_interval),
            share(effect.share_total, effect.share_total_interval),
            published_share(&print, index),
        ]);
    }
    for group in member.result.outputs[0].groups.iter().flatten() {
        let effect = &group.effect;
        table.add_row([
            String::new(),
            format!("group {}", group.group),
            fixed(effect.first_order.estimate, 4),
            fixed(effect.total.estimate, 4),
            share(effect.share_first_order, effect.share_first_order_interval),
            share(effect.share_total, effect.share_total_interval),
            String::new(),
        ]);
    }
}

fn indices(member: &Reproduced) -> &[IndexRecord] {
    member.result.outputs[0].indices.as_deref().unwrap_or_default()
}

/// The published share with a mark where neither of ours comes close.
fn published_share(print: &Published, index: &IndexRecord) -> String {
    let Some((_, value)) = print.shares.iter().find(|(factor, _)| *factor == index.factor) else {
        return String::new();
    };
    let far = |ours: Option<f64>| ours.is_none_or(|ours| (ours - value).abs() > CLOSE);
    match (far(index.effect.share_first_order), far(index.effect.share_total)) {
        (true, true) => format!("{value} (neither)"),
        (true, false) => format!("{value} (as ST)"),
        (false, true) => format!("{value} (as S1)"),
        (false, false) => format!("{value} (both)"),
    }
}

/// Factors with a visible total share, the largest first.
fn ranking(member: &Reproduced) -> Vec<&str> {
    let mut ranked: Vec<(&str, f64)> = indices(member)
        .iter()
        .filter_map(|index| Some((index.factor.as_str(), index.effect.share_total?)))
        .filter(|(_, share)| *share >= VISIBLE)
        .collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked.into_iter().map(|(factor, _)| factor).collect()
}

/// How our order of the factors stands to a published one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    /// The same factors in the same order.
    Same,
    /// Ours is the beginning of the published one; the factors after it have no visible share of ours.
    Beginning,
    /// Neither.
    Other,
}

fn compare_order(ours: &[&str], published: &[&str]) -> Order {
    match published.strip_prefix(ours) {
        Some([]) => Order::Same,
        Some(_) => Order::Beginning,
        None => Order::Other,
    }
}

/// What is to be said about one study: the order of its factors and its printed percentages against ours.
fn verdict(member: &Reproduced) -> String {
    let print = published(member.group.key, member.friction.key);
    let ours = ranking(member);
    let order = match compare_order(&ours, print.ranking) {
        Order::Same => "the published order of",
        Order::Beginning => "the beginning of the published order of",
        Order::Other => "NOT the published order of",
    };
    let invisible: Vec<&str> = print.ranking.iter().copied().filter(|factor| !ours.contains(factor)).collect();
    let without = match invisible[..] {
        [] => String::new(),
        _ => format!("; no total share of ours reaches {VISIBLE} % for {}", invisible.join(", ")),
    };
    format!(
        "{}: {}: {order} {} ({}){without}.\n{}",
        member.friction.name,
        ours.join(" > "),
        print.source,
        print.ranking.join(" > "),
        printed_against_ours(member, &print)
    )
}

fn printed_against_ours(member: &Reproduced, print: &Published) -> String {
    let shares: Vec<String> = indices(member)
        .iter()
        .filter_map(|index| {
            let (_, value) = print.shares.iter().find(|(factor, _)| *factor == index.factor)?;
            let EffectRecord { share_first_order, share_total, .. } = index.effect;
            Some(format!(
                "{} {value} % (ours {} and {})",
                index.factor,
                fixed(share_first_order?, 1),
                fixed(share_total?, 1)
            ))
        })
        .collect();
    match shares[..] {
        [] => String::new(),
        _ => format!("  The printed percentages against ours (share S1 and share ST): {}.\n", shares.join(", ")),
    }
}

/// Claim 20: whether the dimensions outweigh the environment, by the groups of the general study.
fn outweighing(member: &Reproduced) -> Option<String> {
    let groups = member.result.outputs[0].groups.as_ref()?;
    let total = |name: &str| groups.iter().find(|group| group.group == name).map(|group| group.effect.total);
    let (dimensional, environmental) = (total("dimensional")?, total("environmental")?);
    let outweigh = if dimensional.estimate > environmental.estimate {
        "outweigh the environment, as published"
    } else {
        "do NOT outweigh the environment, against what is published"
    };
    Some(format!(
        "{}: the dimensions {outweigh}: total indices {} against {}.\n",
        member.friction.name,
        estimate(dimensional, 4),
        estimate(environmental, 4)
    ))
}

/// What a careful reader should know of the study's result.
fn warnings(member: &Reproduced) -> Vec<String> {
    let output = &member.result.outputs[0];
    output.warnings.iter().map(|warning| format!("{}: warning: {warning}\n", member.friction.name)).collect()
}

/// On how many of the runs the model's assumptions do not hold.
fn validity(member: &Reproduced) -> String {
    let raised: Vec<String> = member
        .result
        .validity
        .iter()
        .filter(|flag| flag.runs > 0)
        .map(|flag| format!("{} on {}", flag.flag, share_of_runs(flag.share)))
        .collect();
    if raised.is_empty() {
        String::new()
    } else {
        format!("{}: validity of the runs: {}.\n", member.friction.name, raised.join(", "))
    }
}

/// The percentages of all studies as CSV, the published ones in the last column; an empty cell where there is none.
pub fn shares_csv<'a>(studies: impl IntoIterator<Item = &'a Reproduced>) -> String {
    let mut text = String::from(
        "study,friction,factor,share_first_order,share_first_order_low,share_first_order_high,\
         share_total,share_total_low,share_total_high,published\n",
    );
    for member in studies {
        let print = published(member.group.key, member.friction.key);
        for IndexRecord { factor, effect } in indices(member) {
            let EffectRecord { share_first_order_interval: first, share_total_interval: total, .. } = effect;
            let printed = print.shares.iter().find(|(name, _)| name == factor).map(|(_, share)| *share);
            let numbers = [
                effect.share_first_order,
                first.map(|i| i.low),
                first.map(|i| i.high),
                effect.share_total,
                total.map(|i| i.low),
                total.map(|i| i.high),
                printed,
            ];
            let cells = numbers.map(|number| number.map_or_else(String::new, |x| x.to_string()));
            text.push_str(&format!("{},{},{factor},{}\n", member.group.key, member.friction.key, cells.join(",")));
        }
    }
    text
}

/// With a capital at the beginning.
pub(super) fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_compared_without_mercy() {
        let published = ["thickness", "length", "width", "height"];
        assert_eq!(compare_order(&published, &published), Order::Same);
        assert_eq!(compare_order(&["thickness", "length"], &published), Order::Beginning);
        assert_eq!(compare_order(&["length", "thickness"], &published), Order::Other);
        assert_eq!(compare_order(&["thickness", "width"], &published), Order::Other);
    }
}
