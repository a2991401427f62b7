//! The charts of shares, from the studies that were run.

use apportion::result::IndexRecord;
use apportion::text::listed;
use apportion_report::chart::{Chart, Series};
use apportion_report::format::words;
use apportion_report::{SharesSeries, shares_chart};

use super::Drawn;
use crate::reproduce::document::percent;
use crate::reproduce::papers::PRINTED;
use crate::reproduce::shares::{indices, ranked, shares_table};
use crate::reproduce::{Reproduced, StudyGroup, published};

/// Draws the shares in the studies of a group under the friction models of the paper of the figure `stem`, or under
/// all; `None` if none of them was run.
pub(super) fn drawn(group: &str, stem: &str, studies: &[Reproduced]) -> Option<Drawn> {
    let is_shown = |friction: &str| match stem.split_once('-') {
        Some((paper, _)) => (paper == "lg") == (friction == PRINTED),
        None => true,
    };
    let is_member = |study: &&Reproduced| study.group.key == group && is_shown(study.friction.key);
    let members: Vec<&Reproduced> = studies.iter().filter(is_member).collect();
    let group = members.first()?.group;
    Some((group_chart(group, &members), shares_table(&members).csv()))
}

/// Draws the shares of all factors in the studies `members` of one group, side by side.
fn group_chart(group: StudyGroup, members: &[&Reproduced]) -> Chart {
    let factors: Vec<&str> =
        members.first().map_or_else(Vec::new, |m| m.result.factors.iter().map(|f| f.name.as_str()).collect());
    let series: Vec<SharesSeries<'_>> = members
        .iter()
        .map(|member| SharesSeries {
            series: Series::new(member.friction.name, member.friction.colour).stroke(member.friction.stroke),
            output: &member.result.outputs[0],
            published: published(group.key, member.friction.key).shares.to_vec(),
        })
        .collect();
    let title = format!("Which factor decides the critical force: {} study", group.key);
    shares_chart(&title, &caption(group, members), &factors, &series)
}

/// Says in one sentence which factor leads under each friction model, and the printed values.
fn caption(group: StudyGroup, members: &[&Reproduced]) -> String {
    let leader = |member: &&Reproduced| {
        let IndexRecord { factor, effect } = &indices(member)[*ranked(member).first()?];
        let total = percent(effect.total.estimate);
        Some(format!("{} under {} friction ({total})", words(factor), member.friction.name))
    };
    let leaders: Vec<String> = members.iter().filter_map(leader).collect();
    let seen = match leaders.is_empty() {
        true => "No factor has an index".to_owned(),
        false => format!("The largest total index S_T is that of {}", listed(&leaders)),
    };
    let printed = |member: &&Reproduced| {
        let shares = published(group.key, member.friction.key).shares;
        let each: Vec<String> =
            shares.iter().map(|(factor, share)| format!("{share} % for {}", words(factor))).collect();
        (!each.is_empty()).then(|| format!("; printed for {} (diamonds) are {}", member.friction.name, listed(&each)))
    };
    format!("{seen}{}.", members.iter().filter_map(printed).collect::<String>())
}
