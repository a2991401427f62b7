//! The charts of shares, from the studies that were run.

use apportion::result::IndexRecord;
use apportion::text::listed;
use apportion_report::chart::Series;
use apportion_report::format::words;
use apportion_report::{SharesSeries, shares_chart};

use super::Drawn;
use crate::reproduce::document::percent;
use crate::reproduce::papers::PRINTED;
use crate::reproduce::shares::{ranked, shares_table};
use crate::reproduce::{Reproduced, published};

/// Draws the shares in the studies of a group under the friction models of the paper of the figure `stem`, or under
/// all; `None` if none of them was run.
pub(super) fn drawn(group: &str, stem: &str, studies: &[Reproduced]) -> Option<Drawn> {
    let is_shown = |friction: &str| match stem.split_once('-') {
        Some((paper, _)) => (paper == "lg") == (friction == PRINTED),
        None => true,
    };
    let is_member = |study: &&Reproduced| study.group.key == group && is_shown(study.friction.key);
    let members: Vec<&Reproduced> = studies.iter().filter(is_member).collect();
    let first = members.first()?;
    let factors: Vec<&str> = first.result.factors.iter().map(|factor| factor.name.as_str()).collect();
    let series = members.iter().map(|member| SharesSeries {
        series: Series::new(member.friction.name, member.friction.colour).stroke(member.friction.stroke),
        output: &member.result.outputs[0],
        published: published(group, member.friction.key).shares.to_vec(),
    });
    let title = format!("Which factor decides the critical force: {group} study");
    let chart = shares_chart(&title, &caption(group, &members), &factors, &series.collect::<Vec<_>>());
    Some((chart, shares_table(&members).csv()))
}

/// Says in one sentence which factor leads under each friction model, and the printed values.
fn caption(group: &str, members: &[&Reproduced]) -> String {
    let leader = |member: &&Reproduced| {
        let (_, IndexRecord { factor, effect }) = *ranked(member).first()?;
        let total = percent(effect.total.estimate);
        Some(format!("{} under {} friction ({total})", words(factor), member.friction.name))
    };
    let leaders: Vec<String> = members.iter().filter_map(leader).collect();
    let seen = match leaders.is_empty() {
        true => "No factor has an index".to_owned(),
        false => format!("The largest total index S_T is that of {}", listed(&leaders)),
    };
    let printed = |member: &&Reproduced| {
        let shares = published(group, member.friction.key).shares;
        let each: Vec<String> =
            shares.iter().map(|(factor, share)| format!("{share} % for {}", words(factor))).collect();
        (!each.is_empty()).then(|| format!("; printed for {} (diamonds) are {}", member.friction.name, listed(&each)))
    };
    format!("{seen}{}.", members.iter().filter_map(printed).collect::<String>())
}
