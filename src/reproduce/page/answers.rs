//! The answer in short: which factor leads in each study, how sure that is, and in what order the rest follow.

use super::cells::{plain, strong};
use crate::report::page::{Cell, PageTable, Part};
use crate::report::{EffectRecord, IndexRecord, IntervalRecord, fixed, share_of_runs};
use crate::reproduce::{FRICTIONS, Friction, GROUPS, Reproduced, StudyGroup};

/// A factor with a smaller total share is not named in an order: in whole percents, as the papers print, it would be 0.
const VISIBLE: f64 = 0.5;

/// The factors of a study, the largest total share first.
fn ranked(study: &Reproduced) -> Vec<(&IndexRecord, f64)> {
    let indices = study.result.outputs.first().and_then(|output| output.indices.as_deref()).unwrap_or_default();
    let mut ranked: Vec<(&IndexRecord, f64)> =
        indices.iter().filter_map(|index| Some((index, index.effect.share_total?))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked
}

fn words(factor: &str) -> String {
    factor.replace('_', " ")
}

/// `47.0 ± 0.2 %`; the share alone where it has no interval.
pub(super) fn percent(share: Option<f64>, interval: Option<IntervalRecord>) -> String {
    match (share, interval) {
        (None, _) => "–".to_owned(),
        (Some(share), None) => format!("{} %", fixed(share, 1)),
        (Some(share), Some(IntervalRecord { low, high })) => {
            format!("{} ± {} %", fixed(share, 1), at_least_a_tenth((high - low) / 2.0))
        }
    }
}

/// A half width that would be printed as 0.0 is not 0.
fn at_least_a_tenth(half_width: f64) -> String {
    if half_width > 0.0 && half_width < 0.1 { "<0.1".to_owned() } else { fixed(half_width, 1) }
}

/// How sure it is that the leader leads.
fn certainty(effect: &EffectRecord) -> String {
    match effect.probability_first {
        Some(p) if p > 0.999 => "certain (> 99.9 %)".to_owned(),
        Some(p) => format!("{} %", fixed(100.0 * p, 1)),
        None => "–".to_owned(),
    }
}

/// One row for each study: the leader with its shares, how sure it is that it leads, and the order of the others.
pub(super) fn table(studies: &[Reproduced]) -> Vec<Vec<Cell>> {
    let rows = studies.iter().map(|study| {
        let ranked = ranked(study);
        let Some((leader, _)) = ranked.first() else {
            return vec![plain(study.group.key), plain(study.friction.name), plain("no indices")];
        };
        let effect = &leader.effect;
        let order: Vec<String> =
            ranked.iter().filter(|(_, share)| *share >= VISIBLE).map(|(index, _)| words(&index.factor)).collect();
        vec![
            plain(study.group.key),
            plain(study.friction.name),
            strong(&words(&leader.factor)),
            plain(percent(effect.share_total, effect.share_total_interval)),
            plain(percent(effect.share_first_order, effect.share_first_order_interval)),
            plain(certainty(effect)),
            plain(order.join(" > ")),
        ]
    });
    rows.collect()
}

/// Sentences for the top of the page: who leads in each group of studies, and how much of it is beyond doubt.
pub(super) fn sentences(studies: &[Reproduced]) -> Vec<String> {
    GROUPS.iter().filter_map(|group| sentence(studies, *group)).collect()
}

fn sentence(studies: &[Reproduced], group: StudyGroup) -> Option<String> {
    let members: Vec<&Reproduced> = studies.iter().filter(|study| study.group == group).collect();
    let leaders: Vec<(Friction, &IndexRecord, f64)> = members
        .iter()
        .filter_map(|study| ranked(study).first().map(|(index, share)| (study.friction, *index, *share)))
        .collect();
    let (_, first, _) = leaders.first()?;
    let among = match group.key {
        "dimensional" => "Among the cantilever's dimensions",
        "environmental" => "Among the factors of the environment",
        _ => "Among all eight factors together",
    };
    let sure = leaders.iter().all(|(_, index, _)| index.effect.probability_first.is_some_and(|p| p > 0.999));
    let sure = if sure { "; that they lead is beyond doubt in this model" } else { "" };
    let alike = leaders.len() == FRICTIONS.len() && leaders.iter().all(|(_, index, _)| index.factor == first.factor);
    let said: Vec<String> = leaders
        .iter()
        .map(|(friction, index, share)| match alike {
            true => format!("{} % under {}", fixed(*share, 0), friction.name),
            false => format!("the {} ({} %) under {}", words(&index.factor), fixed(*share, 0), friction.name),
        })
        .collect();
    Some(match alike {
        true => {
            let sure = if sure.is_empty() { "" } else { "; that it leads is beyond doubt in this model" };
            format!(
                "{among}, the {} decides the critical force, with {} of the sum of total indices{sure}.",
                words(&first.factor),
                listed(&said)
            )
        }
        false => format!("{among}, the largest share of the sum of total indices belongs to {}{sure}.", listed(&said)),
    })
}

/// `a`, `a and b`, `a, b and c`.
pub(super) fn listed(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

/// Every share of every study beside the published one, for the table of all shares.
pub(super) fn all_shares(studies: &[Reproduced]) -> Vec<Vec<Cell>> {
    let mut rows = Vec::new();
    for study in studies {
        let print = crate::reproduce::published(study.group.key, study.friction.key);
        for (place, (index, _)) in ranked(study).into_iter().enumerate() {
            let IndexRecord { factor, effect } = index;
            let printed = print.shares.iter().find(|(name, _)| name == factor);
            rows.push(vec![
                plain(if place == 0 { study.group.key } else { "" }),
                plain(if place == 0 { study.friction.name } else { "" }),
                plain(words(factor)),
                plain(crate::report::estimate(effect.first_order, 4)),
                plain(crate::report::estimate(effect.total, 4)),
                plain(percent(effect.share_first_order, effect.share_first_order_interval)),
                plain(percent(effect.share_total, effect.share_total_interval)),
                plain(printed.map_or_else(String::new, |(_, share)| format!("{share} %"))),
            ]);
        }
    }
    rows
}

/// What a careful reader should know of each study, a sentence each.
pub(super) fn cautions(studies: &[Reproduced]) -> Vec<String> {
    let said = |study: &Reproduced| -> Vec<String> {
        let warnings = study.result.outputs.iter().flat_map(|output| &output.warnings);
        warnings.map(|warning| format!("{}, {} study: {warning}.", study.friction.name, study.group.key)).collect()
    };
    studies.iter().flat_map(said).collect()
}

/// On which share of the runs each assumption of the model does not hold: a column for each flag that was raised
/// anywhere, a row for each study.
pub(super) fn validity(studies: &[Reproduced]) -> Option<Part> {
    let flags = &studies.first()?.result.validity;
    let raised =
        |place: &usize| studies.iter().any(|study| study.result.validity.get(*place).is_some_and(|f| f.runs > 0));
    let places: Vec<usize> = (0..flags.len()).filter(raised).collect();
    if places.is_empty() {
        return None;
    }
    let share = |study: &Reproduced, place: usize| match study.result.validity.get(place) {
        Some(flag) if flag.runs > 0 => share_of_runs(flag.share),
        _ => "none".to_owned(),
    };
    let row = |study: &Reproduced| {
        let shares = places.iter().map(|&place| plain(share(study, place)));
        [plain(study.group.key), plain(study.friction.name)].into_iter().chain(shares).collect()
    };
    let names = places.iter().map(|&place| flags[place].flag.replace('-', " "));
    let means: Vec<String> = places.iter().map(|&place| flags[place].description.clone()).collect();
    Some(Part::Table(PageTable {
        caption: format!(
            "Runs outside the range of a theory, as a share of all runs; they count all the same. {}",
            means.join(" ")
        ),
        header: ["study".to_owned(), "friction".to_owned()].into_iter().chain(names).collect(),
        numeric: (2..2 + places.len()).collect(),
        sentences: false,
        rows: studies.iter().map(row).collect(),
    }))
}
