//! The summary: which factor leads in each study, with which certainty, and the order of the rest.

use apportion::EffectEstimates;
use apportion::result::Named;
use apportion_base::text::{capitalised, listed};
use apportion_report::document::{Cell, Mark, OnPhone, Part, Table};
use apportion_report::format::{chance, words};
use apportion_report::{fixed, share_of_runs};

use crate::reproduce::order::VISIBLE;
use crate::reproduce::shares::ranked;
use crate::reproduce::studies::{FRICTIONS, GROUPS, Reproduced};
use crate::reproduce::words::{named_together, percent};

/// Returns what a factor explains alone and with its interactions.
fn explained(effect: &EffectEstimates) -> (String, String) {
    (percent(effect.first_order.estimate), percent(effect.total.estimate))
}

/// Builds the table of the leading factors, and a notice where the model does not hold.
pub(super) fn parts(studies: &[Reproduced]) -> Vec<Part> {
    let texts = where_it_holds(studies).into_iter().collect();
    vec![table(studies), Part::Notice { mark: Mark::Mixed, kind: "Model validity".to_owned(), texts }]
}

/// Builds a row for each group of studies, a column for each friction model: the leading factor, its shares, the
/// certainty, and the next factors.
fn table(studies: &[Reproduced]) -> Part {
    let caption = "The leading factor of each study: the part of the variance of the critical force that it explains alone \
                   (first-order index S_1) and with all its interactions (total index S_T), and the factors that follow \
                   with theirs.";
    let mut rows = Table::from_rows(caption, GROUPS).text("", |group| Cell::marked(group.title, Mark::Strong));
    for friction in FRICTIONS {
        rows = rows.text(format!("{} friction", friction.name), |group| {
            let study = studies.iter().find(|study| (study.group, study.friction) == (group, friction));
            study.map_or_else(|| "not run".into(), leader)
        });
    }
    Table { on_phone: OnPhone::StackLabelled, ..rows.into() }.into()
}

fn leader(study: &Reproduced) -> Cell {
    let mut ranked = ranked(study).into_iter().map(|(_, index)| index);
    let Some(Named { name: factor, effect, .. }) = ranked.next() else { return "no indices".into() };
    let others = ranked.filter(|index| index.effect.share_total.is_some_and(|share| share >= VISIBLE));
    let others: Vec<String> =
        others.map(|index| format!("{} ({})", words(&index.name), percent(index.effect.total.estimate))).collect();
    let followed = if others.is_empty() { "nothing else".to_owned() } else { others.join(", ") };
    let (alone, together) = explained(effect);
    let certainty = match effect.probability_first {
        Some(_) => format!("largest with probability {}", chance(effect.probability_first)),
        None => "one replicate gives no probability".to_owned(),
    };
    Cell {
        note: format!("{alone} alone, {together} with interactions; {certainty}; then {followed}"),
        ..Cell::marked(words(factor), Mark::Strong)
    }
}

/// Says on what share of the runs the model is outside its range, by the flag that is raised most.
fn where_it_holds(studies: &[Reproduced]) -> Option<String> {
    let flags = studies.iter().flat_map(|study| &study.result.validity).filter(|flag| flag.runs > 0);
    let worst = flags.max_by(|a, b| a.share.total_cmp(&b.share))?;
    let shares = studies.iter().filter_map(|study| study.result.validity.iter().find(|flag| flag.flag == worst.flag));
    let least = shares.map(|flag| flag.share).fold(1.0, f64::min);
    let runs = match (fixed(100.0 * least, 0), fixed(100.0 * worst.share, 0)) {
        (least, most) if least == most => format!("{most} %"),
        (least, most) => format!("{least} to {most} %"),
    };
    let what = worst.description.replacen("The ", "the ", 1);
    Some(format!("In {runs} of the runs of a study, {what}"))
}

/// Formats the result of the general study in one sentence: `Thickness explains 33 % of the variance of the critical
/// force alone and 67 % with its interactions under Coulomb friction; ...`.
pub(super) fn lead(studies: &[Reproduced]) -> Option<String> {
    let general = studies.iter().filter(|study| study.group == GROUPS[2]);
    let leaders = general.filter_map(|study| {
        let (_, Named { name: factor, effect, .. }) = *ranked(study).first()?;
        Some(((factor, explained(effect)), study.friction.name))
    });
    let mut statements = Vec::new();
    for ((factor, (alone, together)), frictions) in named_together(leaders) {
        let (factor, under) = (words(factor), listed(&frictions));
        statements.push(match statements.is_empty() {
            true => format!(
                "{factor} explains {alone} of the variance of the critical force alone and {together} with its \
                 interactions under {under} friction"
            ),
            false => format!("{factor} {alone} and {together} under {under} friction"),
        });
    }
    (!statements.is_empty()).then(|| format!("{}.", capitalised(&statements.join("; "))))
}

/// Lists the warnings of each study, a sentence each.
pub(super) fn cautions(studies: &[Reproduced]) -> Vec<String> {
    let mut cautions = Vec::new();
    for study in studies {
        for warning in study.result.outputs.iter().flat_map(|output| output.warnings.iter()) {
            cautions.push(format!("{}, {} study: {warning}.", study.friction.name, study.group.key));
        }
    }
    cautions
}

/// Tabulates the share of the runs on which each assumption of the model does not hold: a column for each flag that was
/// raised in some study, a row for each study.
pub fn validity(studies: &[Reproduced]) -> Option<Part> {
    let flags = &studies.first()?.result.validity;
    let mut places: Vec<usize> = (0..flags.len()).collect();
    places.retain(|place| studies.iter().any(|study| study.result.validity.get(*place).is_some_and(|f| f.runs > 0)));
    if places.is_empty() {
        return None;
    }
    let means: Vec<&str> = places.iter().map(|&place| flags[place].description.as_str()).collect();
    let caption = format!(
        "Runs outside the range of a theory, as a share of all runs; they are included in the indices. {}",
        means.join(" ")
    );
    let mut rows = Table::from_rows(caption, studies)
        .text("study", |study| study.group.key)
        .text("friction", |study| study.friction.name);
    for place in places {
        rows = rows.number(flags[place].flag.replace('-', " "), |study| match study.result.validity.get(place) {
            Some(flag) if flag.runs > 0 => share_of_runs(flag.share),
            _ => "none".to_owned(),
        });
    }
    Some(rows.into())
}
