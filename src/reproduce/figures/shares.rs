//! The charts of shares, from the studies that were run.

use super::Drawn;
use crate::reproduce::shares::shares_table;
use crate::reproduce::{Reproduced, StudyGroup, published};
use apportion::report::chart::{Chart, Series};
use apportion::report::{SharesSeries, capitalised, listed, shares_chart};

/// The shares in the studies of a group under these friction models; nothing if none of them was run.
pub(super) fn drawn(group: &str, is_shown: fn(&str) -> bool, studies: &[Reproduced]) -> Option<Drawn> {
    let is_member = |study: &&Reproduced| study.group.key == group && is_shown(study.friction.key);
    let members: Vec<&Reproduced> = studies.iter().filter(is_member).collect();
    let group = members.first()?.group;
    Some((group_chart(group, &members), shares_table(&members).csv()))
}

/// The shares of all factors in the studies `members` of one group, side by side.
fn group_chart(group: StudyGroup, members: &[&Reproduced]) -> Chart {
    let factors: Vec<&str> =
        members.first().map_or_else(Vec::new, |m| m.result.factors.iter().map(|f| f.name.as_str()).collect());
    let series: Vec<SharesSeries<'_>> = members
        .iter()
        .map(|member| SharesSeries {
            series: Series::new(member.friction.name, member.friction.colour),
            output: &member.result.outputs[0],
            published: published(group.key, member.friction.key).shares.to_vec(),
        })
        .collect();
    let title = format!("Which factor decides the critical force: {} study", group.key);
    shares_chart(&title, &caption(group, members), &factors, &series).published_name("published (LuGre)")
}

/// The factor with the largest total index, with its shares of the first-order and of the total indices (%).
struct Leader<'a> {
    factor: &'a str,
    shares: (f64, f64),
    friction: &'static str,
}

fn leader(member: &Reproduced) -> Option<Leader<'_>> {
    let indices = member.result.outputs.first()?.indices.as_ref()?;
    let first = indices.iter().max_by(|a, b| a.effect.total.estimate.total_cmp(&b.effect.total.estimate))?;
    Some(Leader {
        factor: &first.factor,
        shares: (first.effect.share_first_order?, first.effect.share_total?),
        friction: member.friction.name,
    })
}

/// What is seen, in one sentence.
fn caption(group: StudyGroup, members: &[&Reproduced]) -> String {
    let leaders: Vec<Leader<'_>> = members.iter().filter_map(|member| leader(member)).collect();
    let shares =
        |l: &Leader<'_>| format!("{:.0} % of the first-order and {:.0} % of the total indices", l.shares.0, l.shares.1);
    let seen = match &leaders[..] {
        [] => "No factor has a share".to_owned(),
        [one] => format!("The largest share is that of {}: {}", words(one.factor), shares(one)),
        [one, rest @ ..] if rest.iter().all(|other| other.factor == one.factor) => {
            let each: Vec<String> = leaders.iter().map(|l| format!("{:.0} %, {}", l.shares.1, l.friction)).collect();
            let every = if leaders.len() > 2 { "every friction model" } else { "both friction models" };
            format!("The largest total share under {every} is that of {} ({})", words(one.factor), each.join("; "))
        }
        _ => {
            let each: Vec<String> = leaders
                .iter()
                .map(|l| format!("{} under {} ({:.0} %)", words(l.factor), l.friction, l.shares.1))
                .collect();
            capitalised(&format!("the largest total share belongs to {}", each.join(", ")))
        }
    };
    let printed = |member: &&Reproduced| {
        let shares = published(group.key, member.friction.key).shares;
        let each: Vec<String> =
            shares.iter().map(|(factor, share)| format!("{share} % for {}", words(factor))).collect();
        (!each.is_empty()).then(|| format!("; printed for {} (diamonds) are {}", member.friction.name, listed(&each)))
    };
    format!("{seen}{}.", members.iter().filter_map(printed).collect::<String>())
}

fn words(name: &str) -> String {
    name.replace('_', " ")
}
