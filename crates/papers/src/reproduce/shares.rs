//! Our shares with the published ones: as one table, for the page, for a terminal and as CSV; and as charts.

use apportion::EffectEstimates;
use apportion::Estimate;
use apportion::result::Named;
use apportion_base::text::listed;
use apportion_report::chart::{Chart, Series};
use apportion_report::document::Table;
use apportion_report::format::{or_dash, words};
use apportion_report::{SharesSeries, fixed, shares_chart};

use super::papers::{PRINTED, published};
use super::studies::Reproduced;
use super::words::percent;

/// Returns the indices of a study's factors.
pub(super) fn indices(study: &Reproduced) -> &[Named<EffectEstimates>] {
    study.result.outputs.first().and_then(|output| output.indices.as_deref()).unwrap_or_default()
}

/// Returns the indices of a study's factors with their positions in [`indices`], the largest total share first.
pub(super) fn ranked(study: &Reproduced) -> Vec<(usize, &Named<EffectEstimates>)> {
    let shares = indices(study).iter().enumerate().filter_map(|place| Some((place.1.effect.share_total?, place)));
    let mut shares: Vec<_> = shares.filter(|(share, _)| !share.is_nan()).collect();
    shares.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    shares.into_iter().map(|(_, place)| place).collect()
}

/// Builds the table of every index and share of every study with the printed percentage, by falling total share in
/// print, and in the order of the study's factors in the file.
pub(super) fn shares_table(studies: &[&Reproduced]) -> Table {
    let (mut rows, mut printed) = (Vec::new(), Vec::new());
    for study in studies {
        let ranked = ranked(study);
        printed.extend(ranked.iter().map(|(place, _)| rows.len() + place));
        let print = published(study.group.key, study.friction.key);
        // Only the first row of a study names it.
        let first = ranked.first().map(|(place, _)| *place);
        for (place, index) in indices(study).iter().enumerate() {
            rows.push((*study, index, first == Some(place), print.share(&index.name)));
        }
    }
    let caption = "First-order and total indices of every study with their 95 % intervals, their shares, and the \
                   percentages that LG prints; the CSV file has the intervals of the shares too.";
    let table = Table::from_rows(caption, rows)
        .text("study", |(study, _, is_first, _)| if is_first { study.group.key } else { "" })
        .value("study", |(study, ..)| study.group.key)
        .text("friction", |(study, _, is_first, _)| if is_first { study.friction.name } else { "" })
        .value("friction", |(study, ..)| study.friction.key)
        .text("factor", |(_, index, ..)| words(&index.name))
        .value("factor", |(_, index, ..)| &index.name)
        .number("S_1", |(_, index, ..)| index.effect.first_order)
        .number("S_T", |(_, index, ..)| index.effect.total)
        .number("% of S_1", |(_, index, ..)| one_decimal(index.effect.first_order_percent()))
        .estimate("share_first_order", |(_, index, ..)| index.effect.first_order_percent())
        .number("% of S_T", |(_, index, ..)| one_decimal(index.effect.total_percent()))
        .estimate("share_total", |(_, index, ..)| index.effect.total_percent())
        .number("printed", |(.., percent)| percent.map_or_else(String::new, |percent| percent.to_string()))
        .value("published", |(.., percent)| percent);
    Table { printed: Some(printed), ..table.into() }
}

/// Formats a share to one decimal; a dash if it is missing.
fn one_decimal(share: Option<Estimate>) -> String {
    or_dash(share, |share| fixed(share.estimate, 1))
}

/// Draws the shares in the studies of a group under the friction models of the paper of the figure `stem`, or under
/// all, with their table as CSV; `None` if none of them was run.
pub(super) fn chart(group: &str, stem: &str, studies: &[Reproduced]) -> Option<(Chart, String)> {
    let mut members: Vec<&Reproduced> = studies.iter().filter(|study| study.group.key == group).collect();
    if let Some((paper, _)) = stem.split_once('-') {
        members.retain(|study| (paper == "lg") == (study.friction.key == PRINTED));
    }
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
    let (mut leaders, mut printed) = (Vec::new(), String::new());
    for member in members {
        let name = member.friction.name;
        if let Some((_, Named { name: factor, effect, .. })) = ranked(member).first() {
            leaders.push(format!("{} under {name} friction ({})", words(factor), percent(effect.total.estimate)));
        }
        let shares = published(group, member.friction.key).shares.iter();
        let shares: Vec<String> = shares.map(|(factor, share)| format!("{share} % for {}", words(factor))).collect();
        if !shares.is_empty() {
            printed.push_str(&format!("; printed for {name} (diamonds) are {}", listed(&shares)));
        }
    }
    match leaders.is_empty() {
        true => format!("No factor has an index{printed}."),
        false => format!("The largest total index S_T is that of {}{printed}.", listed(&leaders)),
    }
}
