//! The answer in short: which factor leads in each study, how sure that is, and in what order the rest follow.

use crate::reproduce::order::VISIBLE;
use crate::reproduce::{FRICTIONS, Friction, GROUPS, Reproduced, StudyGroup};
use apportion::report::document::{Cell, Column, Mark, OnPhone, Part, Table};
use apportion::report::format::{give_or_take, words};
use apportion::report::{EffectRecord, IndexRecord, IntervalRecord, fixed, listed, share_of_runs};

/// The factors of a study, the largest total share first.
fn ranked(study: &Reproduced) -> Vec<(&IndexRecord, f64)> {
    let indices = study.result.outputs.first().and_then(|output| output.indices.as_deref()).unwrap_or_default();
    let mut ranked: Vec<(&IndexRecord, f64)> =
        indices.iter().filter_map(|index| Some((index, index.effect.share_total?))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked
}

/// `46.1 ± 0.2 %`, with a second decimal where the half width needs it; the share alone where it has no interval, or one
/// that does not reach the last digit.
pub(super) fn percent(share: Option<f64>, interval: Option<IntervalRecord>) -> String {
    const LAST_DIGIT: f64 = 0.005;
    let Some(share) = share else { return "–".to_owned() };
    let half_width = interval.map(|IntervalRecord { low, high }| (high - low) / 2.0);
    match half_width {
        None => format!("{} %", fixed(share, 1)),
        Some(half_width) if half_width < LAST_DIGIT => format!("{} %", fixed(share, 2)),
        Some(half_width) => {
            let digits = if half_width < 0.095 { 2 } else { 1 };
            format!("{} ± {} %", fixed(share, digits), fixed(half_width, digits))
        }
    }
}

/// A percentage in a column whose heading has the unit.
fn plain(percentage: String) -> Cell {
    percentage.trim_end_matches(" %").into()
}

/// How sure it is that the leader leads.
fn certainty(effect: &EffectRecord) -> String {
    match effect.probability_first {
        Some(p) if p > 0.999 => "it leads for certain (> 99.9 %)".to_owned(),
        Some(p) if p < 0.95 => {
            format!("it cannot be told apart from the next: it leads with a probability of {} %", fixed(100.0 * p, 1))
        }
        Some(p) => format!("it leads with a probability of {} %", fixed(100.0 * p, 1)),
        None => "one replicate cannot tell how sure that is".to_owned(),
    }
}

/// A row for each group of studies, a column for each friction model: the leader, its shares, how sure it is, and who
/// follows.
pub(super) fn table(studies: &[Reproduced]) -> Table {
    let cell = |group: StudyGroup, friction: Friction| {
        let study = studies.iter().find(|study| (study.group, study.friction) == (group, friction));
        study.map_or_else(|| "not run".into(), leader)
    };
    let row = |group: &StudyGroup| {
        let cells = FRICTIONS.iter().map(|friction| cell(*group, *friction));
        [Cell::marked(title(*group), Mark::Strong)].into_iter().chain(cells).collect()
    };
    let caption = "The leading factor of each study: its share of the sum of the total indices S_T and of the first-order \
                   indices S_1 with 95 % intervals, how sure it is that it leads, and the factors that follow with their \
                   total shares, if half a percent or more.";
    let frictions = FRICTIONS.iter().map(|friction| Column::text(format!("{} friction", friction.name)));
    let columns = [Column::text("")].into_iter().chain(frictions);
    Table { on_phone: OnPhone::StackLabelled, ..Table::new(caption, columns).with_rows(GROUPS.iter().map(row)) }
}

/// What varies in a group of studies.
fn title(group: StudyGroup) -> &'static str {
    match group.key {
        "dimensional" => "the cantilever's dimensions",
        "environmental" => "the environment",
        _ => "all eight factors",
    }
}

fn leader(study: &Reproduced) -> Cell {
    let ranked = ranked(study);
    let Some((first, rest)) = ranked.split_first() else { return "no indices".into() };
    let effect = &first.0.effect;
    let others = rest.iter().filter(|(_, share)| *share >= VISIBLE);
    let others: Vec<String> =
        others.map(|(index, share)| format!("{} {} %", words(&index.factor), fixed(*share, 1))).collect();
    let followed = if others.is_empty() { "nothing else".to_owned() } else { others.join(", ") };
    Cell {
        note: format!(
            "{} of S_T, {} of S_1; {}; then {followed}",
            percent(effect.share_total, effect.share_total_interval),
            percent(effect.share_first_order, effect.share_first_order_interval),
            certainty(effect)
        ),
        ..Cell::marked(words(&first.0.factor), Mark::Strong)
    }
}

/// A paragraph for the top of the page: who leads in each group of studies.
pub(super) fn paragraph(studies: &[Reproduced]) -> Option<String> {
    let sentences: Vec<String> = [2, 0, 1].iter().filter_map(|&place| sentence(studies, GROUPS[place])).collect();
    (!sentences.is_empty()).then(|| {
        format!("{}{}{}{}", sentences.join(" "), sureness(studies), interactions(studies), where_it_holds(studies))
    })
}

/// How much of the variance is interaction where all factors vary.
fn interactions(studies: &[Reproduced]) -> String {
    let general = studies.iter().filter(|study| study.group.key == "general");
    let sums = general.filter_map(|study| Some(study.result.outputs.first()?.sum_first_order?.estimate));
    let sums: Vec<f64> = sums.collect();
    let (Some(least), Some(most)) = (sums.iter().copied().reduce(f64::min), sums.iter().copied().reduce(f64::max))
    else {
        return String::new();
    };
    let percent = |sum: f64| fixed(100.0 * (1.0 - sum), 0);
    format!(
        " In the general studies the first-order indices sum to {} to {}, so {} to {} % of the variance is interaction.",
        fixed(least, 2),
        fixed(most, 2),
        percent(most),
        percent(least)
    )
}

/// On how many of the runs the model leaves its range, by the flag that is raised most.
fn where_it_holds(studies: &[Reproduced]) -> String {
    let flags = studies.iter().flat_map(|study| &study.result.validity).filter(|flag| flag.runs > 0);
    let Some(worst) = flags.max_by(|a, b| a.share.total_cmp(&b.share)) else { return String::new() };
    let shares = studies.iter().filter_map(|study| study.result.validity.iter().find(|flag| flag.flag == worst.flag));
    let least = shares.map(|flag| flag.share).fold(1.0, f64::min);
    let runs = match (fixed(100.0 * least, 0), fixed(100.0 * worst.share, 0)) {
        (least, most) if least == most => format!("{most} %"),
        (least, most) => format!("{least} to {most} %"),
    };
    format!(
        " The model does not hold everywhere: on {runs} of the runs of a study, {}",
        worst.description.replacen("The ", "the ", 1)
    )
}

/// How sure it is that the leaders lead, as far as the error of sampling goes.
fn sureness(studies: &[Reproduced]) -> String {
    let probability = |study: &Reproduced| ranked(study).first().and_then(|(index, _)| index.effect.probability_first);
    match studies.iter().map(probability).collect::<Option<Vec<f64>>>() {
        Some(all) if all.iter().all(|p| *p > 0.999) => {
            format!(" Each of these {} leads is certain to more than 99.9 %, as far as sampling goes.", all.len())
        }
        Some(all) => {
            let least = all.iter().copied().fold(1.0, f64::min);
            format!(" The least certain of these leads has a probability of {} %.", fixed(100.0 * least, 1))
        }
        None => String::new(),
    }
}

fn sentence(studies: &[Reproduced], group: StudyGroup) -> Option<String> {
    let leaders: Vec<(Friction, &IndexRecord, f64)> = studies
        .iter()
        .filter(|study| study.group == group)
        .filter_map(|study| ranked(study).first().map(|(index, share)| (study.friction, *index, *share)))
        .collect();
    let (_, first, _) = leaders.first()?;
    let among = match group.key {
        "dimensional" => "Among the dimensions alone",
        "environmental" => "Among the factors of the environment alone",
        _ => "Of all eight factors together",
    };
    let alike = leaders.iter().all(|(_, index, _)| index.factor == first.factor);
    let said: Vec<String> = leaders
        .iter()
        .map(|(friction, index, share)| match alike {
            true => format!("{} % ({})", fixed(*share, 0), friction.name),
            false => format!("{} under {} friction ({} %)", words(&index.factor), friction.name, fixed(*share, 0)),
        })
        .collect();
    Some(match alike {
        true => format!(
            "{among}, {} decides the critical force: its share of the total indices is {}.",
            words(&first.factor),
            listed(&said)
        ),
        false => format!("{among}, it is {}.", listed(&said)),
    })
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
                match place {
                    0 => Cell { note: study.friction.name.to_owned(), ..study.group.key.into() },
                    _ => Cell::default(),
                },
                words(factor).into(),
                give_or_take(effect.first_order).into(),
                give_or_take(effect.total).into(),
                plain(percent(effect.share_first_order, None)),
                plain(percent(effect.share_total, None)),
                printed.map_or_else(String::new, |(_, share)| share.to_string()).into(),
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
        let shares = places.iter().map(|&place| Cell::from(share(study, place)));
        [study.group.key.into(), study.friction.name.into()].into_iter().chain(shares).collect()
    };
    let names = places.iter().map(|&place| Column::number(flags[place].flag.replace('-', " ")));
    let means: Vec<String> = places.iter().map(|&place| flags[place].description.clone()).collect();
    let caption = format!(
        "Runs outside the range of a theory, as a share of all runs; they count all the same. {}",
        means.join(" ")
    );
    let columns = [Column::text("study"), Column::text("friction")].into_iter().chain(names);
    Some(Part::Table(Table::new(caption, columns).with_rows(studies.iter().map(row))))
}
