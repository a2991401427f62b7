//! Our shares with the published ones: as one table, for the page, for a terminal and as CSV; and as charts.

use apportion::Estimate;
use apportion::result::IndexRecord;
use apportion_base::text::listed;
use apportion_report::chart::{Chart, Series};
use apportion_report::document::Table;
use apportion_report::format::{or_dash, words};
use apportion_report::{SharesSeries, fixed, shares_chart};

use super::document::percent;
use super::papers::PRINTED;
use super::{Reproduced, published};

/// Returns the indices of a study's factors.
pub(super) fn indices(study: &Reproduced) -> &[IndexRecord] {
    study.result.outputs.first().and_then(|output| output.indices.as_deref()).unwrap_or_default()
}

/// Returns the indices of a study's factors with their positions in [`indices`], the largest total share first.
pub(super) fn ranked(study: &Reproduced) -> Vec<(usize, &IndexRecord)> {
    let share = |index: &IndexRecord| index.effect.share_total.unwrap_or(f64::NAN);
    let mut ranked: Vec<_> = indices(study).iter().enumerate().filter(|(_, index)| !share(index).is_nan()).collect();
    ranked.sort_by(|(_, a), (_, b)| share(b).total_cmp(&share(a)));
    ranked
}

/// Builds the table of every index and share of every study with the printed percentage, by falling total share in
/// print, and in the order of the study's factors in the file.
pub(super) fn shares_table<'a>(studies: &[&'a Reproduced]) -> Table {
    let (mut rows, mut printed) = (Vec::new(), Vec::new());
    for study in studies {
        let ranked = ranked(study);
        printed.extend(ranked.iter().map(|(place, _)| rows.len() + place));
        let print = published(study.group.key, study.friction.key);
        // Only the first row of a study names it.
        let first = ranked.first().map(|(place, _)| *place);
        let row = |(place, index): (usize, &'a IndexRecord)| {
            (*study, index, first == Some(place), print.share(&index.factor))
        };
        rows.extend(indices(study).iter().enumerate().map(row));
    }
    let caption = "First-order and total indices of every study with their 95 % intervals, their shares, and the \
                   percentages that LG prints; the CSV file has the intervals of the shares too.";
    let said = |share: Option<Estimate>| or_dash(share, |share| fixed(share.estimate, 1));
    let table = Table::from_rows(caption, rows)
        .text("study", |(study, _, is_first, _)| if is_first { study.group.key } else { "" })
        .value("study", |(study, ..)| study.group.key)
        .text("friction", |(study, _, is_first, _)| if is_first { study.friction.name } else { "" })
        .value("friction", |(study, ..)| study.friction.key)
        .text("factor", |(_, index, ..)| words(&index.factor))
        .value("factor", |(_, index, ..)| &index.factor)
        .number("S_1", |(_, index, ..)| index.effect.first_order)
        .number("S_T", |(_, index, ..)| index.effect.total)
        .number("% of S_1", |(_, index, ..)| said(index.effect.first_order_percent()))
        .estimate("share_first_order", |(_, index, ..)| index.effect.first_order_percent())
        .number("% of S_T", |(_, index, ..)| said(index.effect.total_percent()))
        .estimate("share_total", |(_, index, ..)| index.effect.total_percent())
        .number("printed", |(.., percent)| percent.map_or_else(String::new, |percent| percent.to_string()))
        .value("published", |(.., percent)| percent);
    Table { printed: Some(printed), ..table.into() }
}

/// Draws the shares in the studies of a group under the friction models of the paper of the figure `stem`, or under
/// all; `None` if none of them was run.
pub(super) fn drawn(group: &str, stem: &str, studies: &[Reproduced]) -> Option<(Chart, String)> {
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
