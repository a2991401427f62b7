//! `apportion check`: what a study means and what it will cost, without running it.

use std::path::PathBuf;

use anyhow::anyhow;
use apportion::design::{Companions, Design};
use apportion::estimate::{FirstOrder, Total};
use apportion::model::{ModelKind, Output, RunContext};
use apportion::report::{significant, table, with_unit};
use apportion::run::{BLOCK, FailurePolicy, Job, Pilot};
use apportion::space::distribution::Parameter;
use apportion::space::{Distribution, Factor};
use apportion::study::{Study, Target};
use apportion::uncertainty::IntervalMethod;

use super::output::default_folder;
use super::past_runs::past_runs;
use super::run::file_names;
use super::stop::on_signal;
use super::{DesignChanges, Failure, StudyArguments, print, say, say_notes};

#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    #[command(flatten)]
    design: DesignChanges,
    /// Folder for the results of a run [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn check(arguments: &Arguments) -> Result<(), Failure> {
    let study = arguments.study.load_any(&arguments.design.overrides())?;
    say_notes(&study);
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(study.name()));
    let pilot = if study.subject().is_external() { None } else { Some(pilot(&study)?) };
    let mut text = subject(&study);
    text.push_str(&factors(&study));
    text.push_str(&design(&study, pilot.as_ref()));
    text.push_str(&past_runs(&study, &folder)?);
    text.push_str(&format!("\nwill be written to {}:\n", folder.display()));
    text.push_str(&files(&study));
    print(&text)?;
    match pilot.filter(|pilot| pilot.failed == pilot.runs) {
        None => Ok(()),
        Some(Pilot { runs: number, reason, .. }) => {
            let (number, reason) = (runs(number), reason.unwrap_or_default());
            Err(Failure::Run(anyhow!("every one of the first runs failed ({number}): {reason}")))
        }
    }
}

fn pilot(study: &Study) -> Result<Pilot, Failure> {
    let model = study.model();
    let context = RunContext::new(Some(on_signal()), say);
    Ok(Pilot::new(Job { design: study.design(), space: study.space(), model: model.as_ref() }, &context)?)
}

/// The files of a run with what they hold.
fn files(study: &Study) -> String {
    const CONTENTS: [(&str, &str); 5] = [
        ("-second-order.csv", "the second-order indices of all pairs"),
        ("-estimators.csv", "the indices by the other estimators"),
        ("-convergence.csv", "the indices at every stage of the run"),
        (".json", "the result, for programs"),
        (".csv", "the indices, for spreadsheets"),
    ];
    let names = file_names(study);
    let mut text = format!("  {}  the result as a page, to read\n", names.page());
    for file in &names.data {
        let ending = file.strip_prefix(study.name()).unwrap_or(file);
        let content = CONTENTS.iter().find(|(known, _)| *known == ending).map_or("", |(_, content)| *content);
        text.push_str(&format!("  {file}  {content}\n"));
    }
    names.charts.iter().for_each(|chart| text.push_str(&format!("  charts/{chart}.svg, .png\n")));
    text
}

fn subject(study: &Study) -> String {
    let mut text = format!("study {}", study.name());
    if let Some(title) = &study.title() {
        text.push_str(&format!(": {title}"));
    }
    let about =
        ModelKind::from_name(study.subject().name()).map_or_else(String::new, |kind| format!(": {}", kind.description));
    text.push_str(&format!("\nmodel {}{about}\n", study.subject().name()));
    for (name, value) in study.settings() {
        match value.as_object() {
            Some(table) => table.iter().for_each(|(key, value)| text.push_str(&format!("  {name}.{key} = {value}\n"))),
            None => text.push_str(&format!("  {name} = {}\n", shortened(&value))),
        }
    }
    let model = study.model();
    // A series stands where its first value does.
    let output = |(place, output): (usize, &Output)| {
        let series = model.series().iter().find(|series| series.places().contains(&place));
        match series {
            Some(series) if series.first == place => {
                let (values, axis) = (series.places().len(), series.axis.label());
                Some(format!("{} [{}] ({values} values along {axis})", series.name, output.unit))
            }
            Some(_) => None,
            None => Some(format!("{} [{}]", output.name, output.unit)),
        }
    };
    let outputs: Vec<String> = model.outputs().iter().enumerate().filter_map(output).collect();
    text.push_str(&format!("outputs: {}\n", outputs.join(", ")));
    let constants: Vec<String> = study
        .constants()
        .into_iter()
        .map(|(name, value, unit)| format!("{name} = {}", with_unit(value, &unit)))
        .collect();
    if !constants.is_empty() {
        text.push_str(&format!("fixed: {}\n", constants.join(", ")));
    }
    text.push('\n');
    text
}

/// A value as it is written in a study file, a long list by its beginning and its length.
fn shortened(value: &serde_json::Value) -> String {
    const SHOWN: usize = 12;
    match value.as_array() {
        Some(list) if list.len() > SHOWN => {
            let entries: Vec<String> = list.iter().take(SHOWN).map(ToString::to_string).collect();
            format!("[{}, ... {} in all]", entries.join(", "), list.len())
        }
        _ => value.to_string(),
    }
}

fn factors(study: &Study) -> String {
    let mut table = table(
        &["factor", "distribution", "mean", "sd", "5 %", "median", "95 %", "nominal", "unit", "group"],
        &[0, 1, 8, 9],
    );
    let mut below = String::new();
    for factor in study.space().factors() {
        let law = factor.distribution();
        let quantile = |u| if law.is_noise() { "-".to_owned() } else { factor.in_words(law.quantile(u), significant) };
        // The places of categories in their list have no mean.
        let is_place = matches!(law, Distribution::Categorical(c) if law.name() == "categorical" && c.are_places());
        let moment = |value| if is_place || law.is_noise() { "-".to_owned() } else { significant(value) };
        if let Distribution::Categorical(categories) = law {
            let shares: Vec<String> = categories
                .categories()
                .map(|(label, _, share)| format!("{label} {} %", significant(100.0 * share)))
                .collect();
            below.push_str(&format!("{}: {}\n", factor.name, shares.join(", ")));
        }
        let is_truncated = law.parameters().iter().any(|(_, value)| matches!(value, Parameter::Bounds(..)));
        if factor.determined || is_truncated {
            below.push_str(&format!("{}: {} with {}\n", factor.name, law.name(), parameters(factor)));
        }
        table.add_row([
            factor.name.clone(),
            law.name().to_owned(),
            moment(law.mean()),
            moment(law.sd()),
            quantile(0.05),
            quantile(0.5),
            quantile(0.95),
            factor.in_words(factor.nominal, significant),
            factor.unit().to_string(),
            factor.group.clone().unwrap_or_default(),
        ]);
    }
    format!("{table}\n{below}")
}

/// The parameters of a factor's distribution with all their digits.
fn parameters(factor: &Factor) -> String {
    let parameters = factor.distribution().parameters();
    let words = parameters.iter().filter_map(|(name, value)| match value {
        Parameter::Number(number) => Some(format!("{name} = {number}")),
        Parameter::Bounds(min, max) => Some(format!("{name} = [{min}, {max}]")),
        _ => None,
    });
    words.collect::<Vec<_>>().join(", ")
}

fn design(study: &Study, pilot: Option<&Pilot>) -> String {
    let design = study.design();
    let settings = design.settings();
    let stopping = stopping(study);
    let size = if study.target().grows() { "begins with " } else { "" };
    let mut failures = String::new();
    let time = match pilot {
        None => "outside of this program".to_owned(),
        Some(pilot) => {
            if let Some(reason) = &pilot.reason {
                failures = format!("warning: {} of {} failed: {reason}\n", pilot.failed, runs(pilot.runs));
            }
            if pilot.is_out_of_step {
                failures.push_str(
                    "warning: the program is out of step: it printed more or fewer answers than it had rows; a run will ask \
                     every row by a process of its own, and take much longer\n",
                );
            }
            failures.push_str(random(study, pilot));
            match pilot.failed == pilot.runs {
                true => "in a time that cannot be told".to_owned(),
                false => format!(
                    "about {} on this machine (by {} of it{})",
                    duration(pilot.seconds),
                    runs(pilot.runs),
                    start(pilot)
                ),
            }
        }
    };
    let mut text = format!(
        "\ndesign: {} points, {size}{} base samples in {} replicate{} of {}, seed {}\n{}{}\
         cost: {size}{} base samples x {} = {} model runs, {time}\n{stopping}",
        settings.sampler.name(),
        settings.base_samples,
        settings.replicates,
        if settings.replicates == 1 { "" } else { "s" },
        design.points_per_replicate(),
        settings.seed,
        asked(study),
        rows(study),
        settings.base_samples,
        design.rows_per_point(),
        design.rows()
    );
    text.push_str(&memory(study));
    text.push_str(&failures);
    for warning in warnings(study) {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
}

/// What to do where the same row has two answers.
fn random(study: &Study, pilot: &Pilot) -> &'static str {
    match (pilot.is_random, study.space().noise()) {
        (false, _) => "",
        (true, None) => {
            "warning: the same row had two different answers: the program is random; give it a seed with every row by `noise = \
             \"seed\"` (docs/stochastic-models.md)\n"
        }
        (true, Some(_)) => {
            "warning: the same row with the same seed had two different answers: the program draws random numbers without its \
             seed, and a resumed run is not repeatable\n"
        }
    }
}

/// What the start of the program takes, where it is worth a word.
fn start(pilot: &Pilot) -> String {
    const LEAST: f64 = 0.1;
    if pilot.startup < LEAST {
        String::new()
    } else {
        format!("; {} of that to start the program", duration(pilot.startup))
    }
}

/// What is estimated, and what the intervals are.
fn asked(study: &Study) -> String {
    let analysis = study.analysis();
    let counted =
        |n: usize, what: &str| (n > 0).then(|| if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") });
    let mut parts = vec!["first-order and total indices of the factors".to_owned()];
    parts.extend(counted(study.space().groups().len(), "group"));
    parts.extend(counted(analysis.subsets.len(), "subset"));
    parts.extend(analysis.dummy.then(|| "a dummy factor".to_owned()));
    parts.extend(analysis.second_order.then(|| format!("second order of {} pairs", study.layout().pair_list().len())));
    parts.extend(analysis.has_shapley(study.space()).then(|| "Shapley effects of the factors".to_owned()));
    if let Some(noise) = study.space().noise() {
        parts.push(format!("the noise ({}) and the mean over it", study.space().factors()[noise].name));
    }
    if analysis.aggregate && study.model().outputs().len() > 1 {
        parts.push("all outputs together".to_owned());
    }
    if !analysis.estimators.is_empty() {
        let names: Vec<&str> = analysis.estimators.iter().map(|estimator| estimator.name()).collect();
        parts.push(format!("other estimators {}", names.join(", ")));
    }
    if study.uses_surrogate(study.design()) {
        parts.push("correction by surrogates".to_owned());
    }
    let lows: Vec<&str> = study.low_fidelities().iter().map(|low| low.name.as_str()).collect();
    if !lows.is_empty() {
        parts.push(format!("cheaper models {}", lows.join(", ")));
    }
    let companions = study.design().companions();
    let (first, total) = (FirstOrder::of_rows(companions), Total::of_rows(companions));
    let none = "none: a single replicate says nothing about its error".to_owned();
    let intervals = if alone(study) {
        none
    } else {
        analysis.intervals.words(study.design().settings().replicates, analysis.resamples)
    };
    format!(
        "asked: {}\nestimators: first order {}, total {}\nintervals: {intervals}\n\
         failed runs: {}\n",
        parts.join(", "),
        first.name(),
        total.name(),
        match analysis.failures {
            FailurePolicy::Fail => "the first one ends the run".to_owned(),
            FailurePolicy::DropBlock => format!(
                "left out, up to {} % of all; beyond that there are no indices",
                significant(100.0 * analysis.max_failed)
            ),
        }
    )
}

/// Which rows every base sample has, and why.
fn rows(study: &Study) -> String {
    let (design, analysis) = (study.design(), study.analysis());
    let swaps = design.swaps().len();
    let Companions { ba, bc, cb } = design.companions();
    let asked = match (design.is_dependent(), analysis.has_shapley(study.space())) {
        (false, false) => "one for each factor, group, subset and dummy",
        (false, true) => "one for each factor, group, subset and dummy, and the others for Shapley effects",
        (true, false) => "two for each factor, group and subset: the others follow it, or it is drawn given the others",
        (true, true) => {
            "two for each factor, group and subset: the others follow it, or it is drawn given the others; the rest for Shapley effects"
        }
    };
    let mut words = vec!["A and B".to_owned(), format!("{} AB ({asked})", rows_of(swaps))];
    let askers = |needs: fn(Companions) -> bool| {
        let pairs =
            (analysis.second_order && needs(Companions { ba: true, ..Companions::NONE })).then_some("second order");
        let estimators = analysis.estimators.iter().filter(|estimator| needs(estimator.needs()));
        pairs.into_iter().chain(estimators.map(|estimator| estimator.name())).collect::<Vec<_>>().join(", ")
    };
    words.extend(ba.then(|| format!("{} BA ({})", rows_of(swaps), askers(|rows| rows.ba))));
    words.extend(bc.then(|| format!("{} BC ({})", rows_of(swaps), askers(|rows| rows.bc))));
    words.extend(cb.then(|| format!("{} CB ({})", rows_of(swaps), askers(|rows| rows.cb))));
    let plain = design.plain_rows();
    words.extend((plain > 0).then(|| format!("{plain} plain, for surrogates alone")));
    let all = 2 + swaps as u64 * (1 + design.companions().count()) + u64::from(plain);
    let saved = all - design.rows_per_point();
    let once = if saved > 0 {
        format!("; {saved} of them the same point as another, which is run once")
    } else {
        String::new()
    };
    format!("rows of a base sample: {}{once}\n", words.join(" + "))
}

fn rows_of(swaps: usize) -> String {
    if swaps == 1 { "1 row".to_owned() } else { format!("{swaps} rows") }
}

fn runs(number: u64) -> String {
    if number == 1 { "1 run".to_owned() } else { format!("{number} runs") }
}

/// How a growing run goes on and when it ends.
fn stopping(study: &Study) -> String {
    let Target { half_width, budget, max_runs, is_free } = study.target();
    let ends = [
        half_width.map(|width| format!("every first-order and total index is known to {width} (half its interval)")),
        budget.map(|seconds| format!("twice the runs would take longer than {}", duration(seconds))),
        max_runs.map(|runs| format!("twice the runs would be more than {runs}")),
    ];
    let ends: Vec<String> = ends.into_iter().flatten().collect();
    if ends.is_empty() {
        return String::new();
    }
    if is_free {
        return format!(
            "accuracy: trials decide base samples, plain rows, surrogates and cheaper models; runs are added until {}\n",
            ends.join(", or ")
        );
    }
    format!("growth: the runs are doubled, none of them lost, until {}\n", ends.join(", or "))
}

fn memory(study: &Study) -> String {
    let kilobytes = kilobytes_per_thread(study);
    let mut text = format!(
        "memory: about {kilobytes:.0} kB a thread for the columns of a block, whatever the number of samples\n"
    );
    if study.needs_outputs() {
        let bytes = study.design().rows() as f64 * study.model().outputs().len() as f64 * 8.0;
        let (intervals, surrogate) = (study.analysis().intervals, study.analysis().surrogate);
        let needed = match intervals.keeps_outputs() {
            true => format!("intervals = \"{}\" need", intervals.name()),
            false if !study.uses_surrogate(study.design()) => "the main directions of a series need".to_owned(),
            false => format!("surrogate = \"{}\" needs", surrogate.name()),
        };
        text.push_str(&format!("        and {:.1} MB for the outputs of all runs, which {needed}\n", bytes / 1e6));
    }
    text
}

/// A single replicate, and intervals that need several.
fn alone(study: &Study) -> bool {
    study.design().settings().replicates == 1 && study.analysis().intervals == IntervalMethod::Replicates
}

fn warnings(study: &Study) -> Vec<String> {
    let design = study.design();
    let mut warnings = Vec::new();
    if !design.balanced() {
        warnings.push(
            "the points of a replicate are not a power of two: Sobol' points lose much of their accuracy".to_owned(),
        );
    }
    if alone(study) {
        warnings.push("a single replicate says nothing about its error: there will be no intervals".to_owned());
    } else if design.settings().replicates == 1 && study.analysis().intervals == IntervalMethod::Nets {
        warnings.push(
            "a single net cannot tell whether it is a lucky one: intervals will rest on how its parts differ; 4 replicates are safer"
                .to_owned(),
        );
    }
    warnings.extend(correlated_pairs(design));
    warnings
}

/// Sobol' points of many factors have pairs of dimensions that are correlated until there are points enough
/// (see `SobolSequence`).
fn correlated_pairs(design: &Design) -> Option<String> {
    /// More factors than the first number need as many points a replicate as the second.
    const NEEDED: [(usize, u64); 3] = [(100, 1 << 14), (50, 1 << 12), (30, 1 << 11)];
    let points = design.points_per_replicate();
    let (_, needed) = *NEEDED.iter().find(|(factors, _)| design.factors() > *factors)?;
    (design.settings().sampler.is_digital() && points < needed).then(|| {
        format!(
            "{} factors at {points} points a replicate: some pairs of dimensions of Sobol' points are still correlated, \
             which widens the errors; use {needed} points a replicate or more",
            design.factors()
        )
    })
}

/// Columns of the factors (unit cube and SI, A and B) and of every output of every row kind.
fn kilobytes_per_thread(study: &Study) -> f64 {
    let outputs = study.model().outputs().len() as u64;
    let columns = 2 * study.design().columns() as u64 + study.design().rows_per_point() * (outputs + 1);
    (columns * BLOCK * 8) as f64 / 1e3
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => "0.1 s or less".to_owned(),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.1} hours", s / 3600.0),
    }
}
