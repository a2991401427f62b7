//! Our shares beside the published ones: as a table for people, as CSV for programs.

use super::{GROUPS, Published, Reproduced, published};
use crate::report::{EffectRecord, IndexRecord, share, table};

/// A difference between our share and a published one that rounding to whole percents cannot explain.
const CLOSE: f64 = 1.0;

/// A factor counts as having a share if it is above this many percent: the papers' bars show no less.
const VISIBLE: f64 = 0.05;

/// The table that `reproduce` prints: for each group of studies the shares of every factor under every friction model,
/// then the order of the factors, ours and the published one, and whether they agree.
pub fn comparison_table(studies: &[Reproduced]) -> String {
    let mut text = String::new();
    for group in GROUPS {
        text.push_str(&format!("\n{} studies ({})\n", capitalised(group.key), group.figures));
        let mut table = table(&["friction", "factor", "share S1 %", "share ST %", "published %", "first order"]);
        let members = || studies.iter().filter(|study| study.group == group);
        for member in members() {
            add_rows(&mut table, member);
        }
        text.push_str(&format!("{table}\n"));
        for member in members() {
            text.push_str(&verdict(member));
        }
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
            share(effect.share_first_order, effect.share_first_order_interval),
            share(effect.share_total, effect.share_total_interval),
            published_share(&print, index),
            format!("{:.4}", effect.first_order.estimate),
        ]);
    }
    for group in member.result.outputs[0].groups.iter().flatten() {
        let EffectRecord { first_order, total, .. } = group.effect;
        table.add_row([
            String::new(),
            format!("group {}", group.group),
            share(group.effect.share_first_order, group.effect.share_first_order_interval),
            share(group.effect.share_total, group.effect.share_total_interval),
            String::new(),
            format!("{:.4} closed, {:.4} total", first_order.estimate, total.estimate),
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

/// Whether the published order is ours. Published factors without a visible share of ours may only stand at the end,
/// where the papers' bars have no visible height either.
fn same_order(ours: &[&str], published: &[&str]) -> bool {
    let common: Vec<&str> = published.iter().copied().filter(|factor| ours.contains(factor)).collect();
    published.starts_with(&common) && ours.starts_with(&common)
}

fn verdict(member: &Reproduced) -> String {
    let print = published(member.group.key, member.friction.key);
    let ours = ranking(member);
    let agrees = if same_order(&ours, print.ranking) { "the same order as" } else { "NOT the order of" };
    let invisible: Vec<&str> = print.ranking.iter().copied().filter(|factor| !ours.contains(factor)).collect();
    let without = match invisible[..] {
        [] => String::new(),
        _ => format!("; no share of ours reaches {VISIBLE} % for {}", invisible.join(", ")),
    };
    let shares: Vec<String> = indices(member)
        .iter()
        .filter_map(|index| {
            let (_, value) = print.shares.iter().find(|(factor, _)| *factor == index.factor)?;
            let EffectRecord { share_first_order, share_total, .. } = index.effect;
            Some(format!("{} {value} % (ours {:.1} / {:.1})", index.factor, share_first_order?, share_total?))
        })
        .collect();
    let shares = if shares.is_empty() {
        String::new()
    } else {
        format!("\n    printed against ours (S1 / ST): {}", shares.join(", "))
    };
    format!(
        "  {}: {}: {agrees} {} ({}){without}{shares}\n",
        member.friction.name,
        ours.join(" > "),
        print.source,
        print.ranking.join(" > ")
    )
}

/// The percentages of all studies as CSV, the published ones in the last column; an empty cell where there is none.
pub fn shares_csv(studies: &[Reproduced]) -> String {
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

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_agree_up_to_factors_without_a_share() {
        let published = ["thickness", "length", "width", "height"];
        assert!(same_order(&["thickness", "length", "width"], &published));
        assert!(same_order(&["thickness", "length", "width", "height"], &published));
        assert!(!same_order(&["length", "thickness", "width"], &published));
        assert!(!same_order(&["elastic_modulus", "adhesion"], &["elastic_modulus", "velocity", "adhesion"]));
        assert!(!same_order(&["equivalent_modulus", "elastic_modulus"], &["elastic_modulus", "velocity"]));
        assert!(same_order(&["elastic_modulus"], &["elastic_modulus", "velocity", "adhesion"]));
    }
}
