//! Our shares beside the published ones: as a table for people, as CSV for programs.

use super::order::{Agreement, Standing, VISIBLE, order_of, outweighing};
use super::published::CLOSE;
use super::{GROUPS, Published, Reproduced, published};
use apportion::report::csv::{Csv, Field, fields};
use apportion::report::document::Value;
use apportion::report::{EffectRecord, EstimateRecord, IndexRecord, IntervalRecord, TextTable};
use apportion::report::{capitalised, fixed, give_or_take, share, share_of_runs, table};

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
        text.extend(members().filter_map(weights));
        text.extend(members().map(validity));
        text.extend(members().flat_map(warnings));
    }
    text
}

fn add_rows(table: &mut TextTable, member: &Reproduced) {
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

/// What is to be said about one study: the order of its factors and its printed percentages against ours.
fn verdict(member: &Reproduced) -> String {
    let (order, print) = order_of(member);
    let of_print = format!("{} ({})", print.source, print.ranking.join(" > "));
    let names = |pairs: Vec<(&str, &str)>, joint: &str| {
        pairs.iter().map(|(one, other)| format!("{one} {joint} {other}")).collect::<Vec<_>>().join(", ")
    };
    let stands = match order.agreement() {
        Agreement::Same => format!("the published order of {of_print}"),
        Agreement::Beginning => format!("the beginning of the published order of {of_print}"),
        Agreement::Undecided => format!(
            "not decided at this sample size whether the published order of {of_print}: the intervals of the total shares \
             leave open {}",
            names(order.pairs_that_are(Standing::Undecided), "before")
        ),
        Agreement::Other => format!("NOT the published order of {of_print}"),
    };
    let without = match order.unseen[..] {
        [] => String::new(),
        _ => format!("; no total share of ours reaches {VISIBLE} % for {}", order.unseen.join(", ")),
    };
    format!(
        "{}: {}: {stands}{without}.\n{}",
        member.friction.name,
        order.ours.join(" > "),
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
fn weights(member: &Reproduced) -> Option<String> {
    let (dimensional, environmental, standing) = outweighing(member)?;
    let totals = format!("total indices {} against {}", give_or_take(dimensional), give_or_take(environmental));
    let outweigh = match standing {
        Standing::Kept => "the dimensions outweigh the environment, as published",
        Standing::Broken => "the dimensions do NOT outweigh the environment, against what is published",
        Standing::Undecided | Standing::Unseen => {
            "not decided at this sample size whether the dimensions outweigh the environment"
        }
    };
    Some(format!("{}: {outweigh}: {totals}.\n", member.friction.name))
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
    let names = ["study", "friction", "factor"];
    let mut columns = fields(&names, &["share_first_order", "share_total"]);
    columns.push(Field::new("published"));
    let mut csv = Csv::new(columns);
    let share = |share: Option<f64>, interval: Option<IntervalRecord>| {
        let bounds =
            |estimate| EstimateRecord { estimate, low: interval.map(|i| i.low), high: interval.map(|i| i.high) };
        Value::Estimate(share.map(bounds))
    };
    for member in studies {
        let print = published(member.group.key, member.friction.key);
        for IndexRecord { factor, effect } in indices(member) {
            let printed = print.shares.iter().find(|(name, _)| name == factor).map(|(_, share)| *share);
            csv.row::<Value>([
                member.group.key.into(),
                member.friction.key.into(),
                factor.into(),
                share(effect.share_first_order, effect.share_first_order_interval),
                share(effect.share_total, effect.share_total_interval),
                printed.into(),
            ]);
        }
    }
    csv.text()
}
