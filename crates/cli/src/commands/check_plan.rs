//! The plan of a run in `apportion check`: its rows, their cost, and its duration.

use std::path::Path;

use apportion::design::Design;
use apportion::estimate::{FirstOrder, Total};
use apportion::run::{BLOCK, FailurePolicy, Pilot};
use apportion::space::IndicesOf;
use apportion::study::{Study, Target};
use apportion_report::{grouped, significant};

use super::counted;

/// The rows of the design, what is asked of them, and what they cost by the first runs.
pub(super) fn plan(study: &Study, file: &Path, pilot: Option<&Pilot>) -> String {
    let design = study.design();
    let settings = design.settings();
    let size = if study.target().grows() { "begins with " } else { "" };
    let base_samples = grouped(settings.base_samples);
    let mut lines = vec![
        String::new(),
        format!(
            "design: {} points, {size}{base_samples} base samples in {} of {}, seed {}",
            settings.sampler.name(),
            counted(settings.replicates, "replicate"),
            design.points_per_replicate(),
            settings.seed
        ),
    ];
    for dependence in study.space().dependences() {
        let measure = dependence.measure_in_force().name();
        lines.push(format!("dependent: {} (correlations: {measure})", dependence.factors().join(", ")));
    }
    lines.push(format!("asked: {}", asked(study).join(", ")));
    let has_ba = design.has_ba();
    lines.push(format!(
        "estimators: first order {}, total {}",
        FirstOrder::default_for(has_ba).name(),
        Total::default_for(has_ba).name()
    ));
    let analysis = study.analysis();
    lines.push(format!("intervals: {}", analysis.intervals.words(settings.replicates, analysis.resamples)));
    lines.push(match analysis.failures {
        FailurePolicy::Fail => "failed runs: the first one stops the run".to_owned(),
        FailurePolicy::DropBlock => {
            let share = significant(100.0 * analysis.max_failed);
            format!("failed runs: left out, up to {share} % of all runs; beyond that no indices are estimated")
        }
    });
    lines.push(format!("rows of a base sample: {}", rows(study).join(" + ")));
    lines.push(format!(
        "cost: {size}{base_samples} base samples x {} = {} model runs, {}",
        design.rows_per_point(),
        grouped(design.rows()),
        time(pilot)
    ));
    lines.extend(stopping(study));
    lines.extend(memory(study));
    if pilot.is_none_or(|pilot| pilot.seconds > SLOW_RUN * design.rows() as f64) {
        let file = file.display();
        lines.push(format!(
            "fewer runs: --runs N, or apportion screen {file} (docs/which-method.md compares the methods by the number of runs)"
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
    let of_output = |differing: &u64| pilot.repeats.as_ref()?.warning(*differing, has_noise);
    warnings.extend(pilot.repeats.iter().flat_map(|repeats| &repeats.differing).find_map(of_output));
    warnings
}

/// What is estimated.
fn asked(study: &Study) -> Vec<String> {
    let (analysis, space) = (study.analysis(), study.space());
    let several = |number: usize, what: &str| (number > 0).then(|| counted(number as u64, what));
    let names = |what: &str, names: Vec<&str>| (!names.is_empty()).then(|| format!("{what} {}", names.join(", ")));
    let of = match analysis.indices_of {
        IndicesOf::Factors => "the factors",
        IndicesOf::Groups => "the groups, and of the factors without one",
    };
    let parts = [
        Some(format!("first-order and total indices of {of}")),
        several(study.layout().groups, "group"),
        several(analysis.subsets.len(), "subset"),
        analysis.dummy.then(|| "a dummy factor".to_owned()),
        analysis.second_order.then(|| format!("second order of {} pairs", study.layout().pair_list().len())),
        analysis.has_shapley(space).then(|| "Shapley effects".to_owned()),
        names("measures", analysis.measures.iter().map(|measure| measure.name()).collect()),
        space.noise().map(|noise| format!("the noise ({}) and the mean over it", space.factors()[noise].name)),
        (analysis.aggregate && study.model().outputs().len() > 1).then(|| "all outputs together".to_owned()),
        names("other estimators", analysis.estimators.iter().map(|estimator| estimator.name()).collect()),
        study.uses_surrogate(study.design()).then(|| "correction by surrogates".to_owned()),
        names("cheaper models", study.low_fidelities().iter().map(|low| low.name.as_str()).collect()),
    ];
    parts.into_iter().flatten().collect()
}

/// Which rows every base sample has.
fn rows(study: &Study) -> Vec<String> {
    let design = study.design();
    let swaps = design.swaps().len() as u64;
    let row = |number: u64, what: &str| (number > 0).then(|| format!("{} {what}", counted(number, "row")));
    let parts = [
        Some("A and B".to_owned()),
        row(swaps, "AB"),
        row(if design.has_ba() { swaps } else { 0 }, "BA"),
        row(design.plain_rows().into(), "only for surrogates"),
    ];
    parts.into_iter().flatten().collect()
}

/// How a growing run goes on and when it ends.
fn stopping(study: &Study) -> Option<String> {
    let Target { accuracy, max_time, max_runs } = study.target();
    let ends = [
        accuracy.map(|width| format!("every first-order and total index is known to {width} (half its interval)")),
        max_time.map(|seconds| format!("twice the runs would take longer than {}", duration(seconds))),
        max_runs.map(|runs| format!("twice the runs would be more than {runs}")),
    ];
    let ends: Vec<String> = ends.into_iter().flatten().collect();
    (!ends.is_empty()).then(|| format!("growth: runs are added, and all are used, until {}", ends.join(", or ")))
}

/// Columns of the factors (unit cube and SI, A and B) and of every output of every row kind; and outputs that are kept.
fn memory(study: &Study) -> Vec<String> {
    let (design, outputs) = (study.design(), study.model().outputs().len() as u64);
    let columns = 2 * design.columns() as u64 + design.rows_per_point() * (outputs + 1);
    let kilobytes = (columns * BLOCK * 8) as f64 / 1e3;
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
