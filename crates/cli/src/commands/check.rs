//! `apportion check`: the meaning of a study, and the plan of a run: its rows, their cost, and its duration.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use apportion::design::Design;
use apportion::estimate::{FirstOrder, Total};
use apportion::model::RunContext;
use apportion::run::{FailurePolicy, MAX_STORED_BYTES, Pilot};
use apportion::space::distribution::Parameter;
use apportion::space::{Distribution, IndicesOf};
use apportion::study::{Study, Target};
use apportion_files::ModelKind;
use apportion_report::{grouped, significant, table, two_digits, with_unit};

use super::journal::journal_path;
use super::output::default_folder;
use super::stop::on_signal;
use super::{DesignChanges, StudyArguments, counted, print, say};

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

pub fn check(arguments: &Arguments) -> anyhow::Result<()> {
    let study = arguments.study.load_any(&arguments.design.overrides())?;
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(study.name()));
    let mut pilot = None;
    if !study.subject().is_external() {
        pilot = Some(Pilot::new(&study, &RunContext::new(Some(on_signal()), say))?);
    }
    print(&format!(
        "{}{}{}{}\nwill be written to {}: the page {}.html, tables, charts\n",
        subject(&study),
        factors(&study),
        plan(&study, &arguments.study.study, pilot.as_ref()),
        past_runs(&study, &folder),
        folder.display(),
        study.name()
    ))?;
    match pilot.filter(|pilot| pilot.failed == pilot.runs) {
        None => Ok(()),
        Some(Pilot { runs: number, reason, .. }) => {
            let (number, reason) = (counted(number, "run"), reason.unwrap_or_default());
            Err(anyhow!("every one of the first runs failed ({number}): {reason}"))
        }
    }
}

fn subject(study: &Study) -> String {
    let model_name = study.subject().name();
    let title = study.title().map(|title| format!(": {title}")).unwrap_or_default();
    let about = ModelKind::from_name(model_name).map(|kind| format!(": {}", kind.description)).unwrap_or_default();
    let mut text = format!("study {}{title}\nmodel {model_name}{about}\n", study.name());
    if model_name == ModelKind::COMMAND.name {
        let files = study.subject().files();
        let names = files.iter().filter_map(|file| Some(file.file_name()?.to_string_lossy()));
        let names = names.collect::<Vec<_>>().join(", ");
        let names = if names.is_empty() { "none" } else { &names };
        text.push_str(&format!("files that a journal depends on: {names}\n"));
    }
    for (name, value) in study.settings() {
        match value.as_object() {
            Some(table) => table.iter().for_each(|(key, value)| text.push_str(&format!("  {name}.{key} = {value}\n"))),
            None => text.push_str(&format!("  {name} = {}\n", shortened(&value))),
        }
    }
    let model = study.model();
    let mut outputs = Vec::new();
    for (place, output) in model.outputs().iter().enumerate() {
        match model.series().iter().find(|series| series.places().contains(&place)) {
            // A series is listed at its first value.
            Some(series) if series.first == place => {
                let (values, axis) = (series.places().len(), series.axis.label());
                outputs.push(format!("{} [{}] ({values} values along {axis})", series.name, output.unit));
            }
            Some(_) => (),
            None => outputs.push(format!("{} [{}]", output.name, output.unit)),
        }
    }
    text.push_str(&format!("outputs: {}\n", outputs.join(", ")));
    let constants = study.constants().into_iter();
    let constants: Vec<String> =
        constants.map(|(name, value, unit)| format!("{name} = {}", with_unit(value, &unit))).collect();
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
        let [low, median, high] = [0.05, 0.5, 0.95]
            .map(|u| if law.is_noise() { "-".to_owned() } else { factor.in_words(law.quantile(u), significant) });
        // The positions of categories in their list have no mean.
        let is_place = matches!(law, Distribution::Categorical(c) if law.name() == "categorical" && c.are_places());
        let [mean, sd] = [law.mean(), law.sd()]
            .map(|moment| if is_place || law.is_noise() { "-".to_owned() } else { significant(moment) });
        if let Distribution::Categorical(categories) = law {
            let shares: Vec<String> = categories
                .categories()
                .map(|(label, _, share)| format!("{label} {} %", significant(100.0 * share)))
                .collect();
            below.push_str(&format!("{}: {}\n", factor.name, shares.join(", ")));
        }
        let is_truncated = law.parameters().iter().any(|(_, value)| matches!(value, Parameter::Bounds(..)));
        if factor.determined || is_truncated {
            // With all their digits.
            let parameters = law.parameters().into_iter().filter_map(|(name, value)| match value {
                Parameter::Number(number) => Some(format!("{name} = {number}")),
                Parameter::Bounds(min, max) => Some(format!("{name} = [{min}, {max}]")),
                _ => None,
            });
            let parameters = parameters.collect::<Vec<_>>().join(", ");
            below.push_str(&format!("{}: {} with {parameters}\n", factor.name, law.name()));
        }
        table.add_row([
            factor.name.clone(),
            law.name().to_owned(),
            mean,
            sd,
            low,
            median,
            high,
            factor.in_words(factor.nominal, significant),
            factor.unit().to_string(),
            factor.group.clone().unwrap_or_default(),
        ]);
    }
    format!("{table}\n{below}")
}

/// The lines on the journal in the folder of the results.
fn past_runs(study: &Study, folder: &Path) -> String {
    let path = journal_path(folder, study.name(), None);
    let total = study.design().rows();
    let megabytes = total as f64 * study.model().outputs().len() as f64 * 8e-6;
    let (size, path_text) = (two_digits(megabytes.max(0.01)), path.display());
    let when = if study.model().is_slow() { "" } else { ", if the run takes longer than 10 s" };
    let mut text = match 1e6 * megabytes > MAX_STORED_BYTES as f64 {
        true => format!("disk: no journal, which would take about {size} MB: the run cannot be resumed\n"),
        false => format!("disk: about {size} MB for the journal {path_text}{when}\n"),
    };
    if path.exists() {
        text.push_str(&match study.runner().journal(&path).recorded_runs() {
            Ok(rows) => format!("already saved: {} of {total} runs, which are not repeated\n", rows.min(total)),
            Err(error) => format!("already saved: no usable runs: {error}\n"),
        });
    }
    text
}

/// The rows of the design, what is estimated from them, and what they cost by the first runs.
fn plan(study: &Study, file: &Path, pilot: Option<&Pilot>) -> String {
    let design = study.design();
    let settings = design.settings();
    let size = if study.target().grows() { "begins with " } else { "" };
    let base_samples = grouped(settings.base_samples);
    let replicates = counted(settings.replicates, "replicate");
    let points = match design.is_plain() {
        true => format!("{} rows, each at a point of its own, in {replicates}", grouped(design.rows())),
        false => format!("{base_samples} base samples in {replicates} of {}", design.points_per_replicate()),
    };
    let mut lines = vec![
        String::new(),
        format!("design: {} points, {size}{points}, seed {}", settings.sampler.name(), settings.seed),
    ];
    for dependence in study.space().dependences() {
        let measure = dependence.measure_in_force().name();
        lines.push(format!("dependent: {} (correlations: {measure})", dependence.factors().join(", ")));
    }
    lines.push(format!("asked: {}", estimated(study).join(", ")));
    let has_ba = design.has_ba();
    let (analysis, of) =
        (study.analysis(), [FirstOrder::default_for(has_ba).name(), Total::default_for(has_ba).name()]);
    lines.push(match design.is_plain() {
        true => {
            "estimators: a surrogate; if it explains too little, swaps of the same points measure the rest".to_owned()
        }
        false => format!("estimators: first order {}, total {}", of[0], of[1]),
    });
    lines.push(match design.is_plain() {
        true => "intervals: from rows that were left out of fits".to_owned(),
        false => format!("intervals: {}", analysis.intervals.words(settings.replicates, analysis.resamples)),
    });
    lines.push(match analysis.failures {
        FailurePolicy::Fail => "failed runs: the first one stops the run".to_owned(),
        FailurePolicy::DropBlock => {
            let share = significant(100.0 * analysis.max_failed);
            format!("failed runs: left out, up to {share} % of all runs; beyond that no indices are estimated")
        }
    });
    let runs = grouped(design.rows());
    let each = format!("{base_samples} base samples x {} = ", design.rows_per_point());
    let each = if design.is_plain() { String::new() } else { each };
    lines.extend((!design.is_plain()).then(|| format!("rows of a base sample: {}", rows(study).join(" + "))));
    lines.push(format!("cost: {size}{each}{runs} model runs, {}", time(pilot)));
    lines.extend(stopping(study));
    lines.extend(memory(study));
    if pilot.is_none_or(|pilot| pilot.seconds > SLOW_RUN * design.rows() as f64) {
        let file = file.display();
        lines.push(format!(
            "fewer runs: --runs N, or apportion screen {file} (docs/guide/which-method.md compares the methods by the number of runs)"
        ));
    }
    let warnings = pilot.into_iter().flat_map(|pilot| pilot_warnings(study, pilot));
    let warnings = warnings
        .chain(analysis.design_warnings(design).into_iter().map(|warning| warning.to_string()))
        .chain(correlated_pairs(design));
    lines.extend(warnings.map(|warning| format!("warning: {warning}")));
    lines.join("\n") + "\n"
}

/// Seconds of a run above which its number is worth a word.
const SLOW_RUN: f64 = 1e-3;

fn time(pilot: Option<&Pilot>) -> String {
    match pilot {
        None => "outside this program".to_owned(),
        Some(pilot) if pilot.failed == pilot.runs => "in an unknown time (every pilot run failed)".to_owned(),
        Some(pilot) => {
            format!("about {} on this machine (from {})", duration(pilot.seconds), counted(pilot.runs, "run"))
        }
    }
}

/// What the first runs have shown.
fn pilot_warnings(study: &Study, pilot: &Pilot) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(reason) = &pilot.reason {
        warnings.push(format!("{} of {} failed: {reason}", pilot.failed, counted(pilot.runs, "run")));
    }
    let has_noise = study.space().noise().is_some();
    if let Some(repeats) = &pilot.repeats {
        let warning = repeats.differing.iter().find_map(|differing| repeats.warning(*differing, has_noise));
        warnings.extend(warning.map(|warning| warning.to_string()));
    }
    warnings
}

/// What is estimated.
fn estimated(study: &Study) -> Vec<String> {
    let (analysis, space) = (study.analysis(), study.space());
    let of = match analysis.indices_of {
        IndicesOf::Factors => "the factors",
        IndicesOf::Groups => "the groups, and of the factors without one",
    };
    let parts = [
        Some(format!("first-order and total indices of {of}")),
        several(study.layout().effects.iter().filter(|effect| effect.is_group()).count(), "group"),
        several(analysis.subsets.len(), "subset"),
        analysis.dummy.then(|| "a dummy factor".to_owned()),
        analysis.second_order.then(|| format!("second order of {} pairs", study.layout().pair_list().len())),
        analysis.has_shapley(space).then(|| "Shapley effects".to_owned()),
        names("measures", analysis.measures.iter().map(|measure| measure.name())),
        space.noise().map(|noise| format!("the noise ({}) and the mean over it", space.factors()[noise].name)),
        (analysis.aggregate && study.model().outputs().len() > 1).then(|| "all outputs together".to_owned()),
        names("other estimators", analysis.estimators.iter().map(|estimator| estimator.name())),
        study.uses_surrogate(study.design()).then(|| "correction by surrogates".to_owned()),
        names("cheaper models", study.low_fidelities().iter().map(|low| low.name.as_str())),
    ];
    parts.into_iter().flatten().collect()
}

fn several(number: usize, what: &str) -> Option<String> {
    (number > 0).then(|| counted(number as u64, what))
}

/// Lists names after `what`; `None` without names.
fn names<'a>(what: &str, names: impl Iterator<Item = &'a str>) -> Option<String> {
    let names: Vec<&str> = names.collect();
    (!names.is_empty()).then(|| format!("{what} {}", names.join(", ")))
}

/// Which rows every base sample has.
fn rows(study: &Study) -> Vec<String> {
    let design = study.design();
    let swaps = design.swaps().len() as u64;
    let ba = if design.has_ba() { swaps } else { 0 };
    let mut rows = vec!["A and B".to_owned()];
    for (number, kind) in [(swaps, "AB"), (ba, "BA")] {
        if number > 0 {
            rows.push(format!("{} {kind}", counted(number, "row")));
        }
    }
    rows
}

/// How a growing run goes on and when it ends.
fn stopping(study: &Study) -> Option<String> {
    let Target { accuracy, max_time, max_runs, .. } = study.target();
    let ends = [
        accuracy.map(|width| format!("every first-order and total index is known to {width} (half its interval)")),
        max_time.map(|seconds| format!("twice the runs would take longer than {}", duration(seconds))),
        max_runs.map(|runs| format!("twice the runs would be more than {runs}")),
    ];
    let ends: Vec<String> = ends.into_iter().flatten().collect();
    (!ends.is_empty()).then(|| format!("growth: runs are added, and all are used, until {}", ends.join(", or ")))
}

/// The columns of a block, and outputs that are kept.
fn memory(study: &Study) -> Vec<String> {
    let (design, outputs) = (study.design(), study.model().outputs().len() as u64);
    let kilobytes = study.bytes_per_thread() as f64 / 1e3;
    let mut lines = vec![format!("memory: about {kilobytes:.0} kB per thread, for any number of samples")];
    if study.needs_outputs() {
        let bytes = design.rows() as f64 * outputs as f64 * 8.0;
        lines.push(format!("        and {:.1} MB for the outputs of all runs", bytes / 1e6));
    }
    lines
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => "0.1 s or less".to_owned(),
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.0} minutes", s / 60.0),
        s => format!("{:.1} hours", s / 3600.0),
    }
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
