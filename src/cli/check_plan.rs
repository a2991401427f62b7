//! What `apportion check` says of a run before it: its rows, their cost, and when it ends.

use std::path::Path;

use apportion::design::Design;
use apportion::estimate::{FirstOrder, ShapleyMethod, Total};
use apportion::report::{grouped, significant};
use apportion::run::{BLOCK, FailurePolicy, Pilot};
use apportion::study::{Study, Target};
use apportion::uncertainty::IntervalMethod;
use apportion::{Dependence, MOST_ROWS_OF_MEASURES};

/// The rows of the design, what is asked of them, and what they cost by the first runs.
pub(super) fn plan(study: &Study, file: &Path, pilot: Option<&Pilot>) -> String {
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
            let has_noise = study.space().noise().is_some();
            let of_output = |differing: &u64| pilot.repeats.as_ref()?.warning(*differing, has_noise);
            let random = pilot.repeats.iter().flat_map(|repeats| &repeats.differing).find_map(of_output);
            failures.extend(random.map(|warning| format!("warning: {warning}\n")));
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
        "\ndesign: {} points, {size}{} base samples in {} replicate{} of {}, seed {}\n{}{}{}\
         cost: {size}{} base samples x {} = {} model runs, {time}\n{stopping}",
        settings.sampler.name(),
        grouped(settings.base_samples),
        settings.replicates,
        if settings.replicates == 1 { "" } else { "s" },
        design.points_per_replicate(),
        settings.seed,
        dependent(study),
        asked(study),
        rows(study),
        grouped(settings.base_samples),
        design.rows_per_point(),
        grouped(design.rows())
    );
    text.push_str(&memory(study));
    text.push_str(&methods(study, file, pilot));
    text.push_str(&failures);
    for warning in warnings(study) {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
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

/// Which method serves at how many runs, for a model whose runs take their time; measured on independent factors
/// (`docs/small-budgets.md`).
fn methods(study: &Study, file: &Path, pilot: Option<&Pilot>) -> String {
    /// Seconds of a run below which nobody counts runs.
    const QUICK: f64 = 1e-3;
    /// Runs a factor from which surrogates of random points served on smooth functions, and on rough ones.
    const SMOOTH: u64 = 5;
    const ROUGH: u64 = 16;
    let is_quick = |pilot: &Pilot| pilot.seconds < QUICK * study.design().rows() as f64;
    let space = study.space();
    if pilot.is_some_and(is_quick) || study.design().is_dependent() || space.noise().is_some() {
        return String::new();
    }
    let (file, factors, model) = (file.display(), space.factors().len() as u64, study.model());
    let outputs: Vec<&str> = model.outputs().iter().map(|output| &*output.name).collect();
    let outputs = if outputs.len() > 3 { "NAMES".to_owned() } else { outputs.join(",") };
    let (few, many) = (SMOOTH * factors, ROUGH * (factors + 2));
    let given = format!("apportion given-data table.csv --outputs {outputs} --study {file} --surrogate");
    let [random, rough, accurate] = match study.subject().is_external() {
        true => [
            format!("apportion sample {file} --random N -o table.csv; the outputs as further columns; {given}"),
            format!("apportion sample {file} --budget-runs N; apportion analyze OUTPUTS --design FILE"),
            String::new(),
        ],
        false => [
            format!(
                "apportion sample {file} --random N -o rows.csv; apportion evaluate {file} rows.csv --with-points -o table.csv; {given}"
            ),
            format!("apportion run {file} --budget-runs N"),
            format!("  as many as it takes: apportion run {file} --accuracy 0.02\n"),
        ],
    };
    let screen = match study.subject().is_external() {
        true => String::new(),
        false => format!(
            "  fewer than {few}: which factors matter, not how much: apportion screen {file} --trajectories R, each of {} runs\n",
            factors + 1
        ),
    };
    format!(
        "which method, by the runs that there is time for (the errors of each: docs/small-budgets.md):\n{screen}  \
         from {few}: indices of smooth models: {random}\n  \
         from {many}: indices of rough models too: {rough}\n{accurate}"
    )
}

/// The factors that depend on each other, and how.
fn dependent(study: &Study) -> String {
    let line = |dependence: &Dependence| {
        let (factors, measure) = (dependence.factors().join(", "), dependence.measure_in_force().name());
        format!("dependent: {factors} by a Gaussian copula (correlations: {measure})\n")
    };
    study.space().dependences().iter().map(line).collect()
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
    parts.extend(analysis.has_shapley(study.space()).then(|| {
        let players = analysis.shapley_players.unwrap_or_default();
        format!("Shapley effects of the {}", players.name())
    }));
    if !analysis.measures.is_empty() {
        let names: Vec<&str> = analysis.measures.iter().map(|measure| measure.name()).collect();
        parts.push(format!("measures {} from the first {MOST_ROWS_OF_MEASURES} rows A and B", names.join(", ")));
    }
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
    let has_ba = study.design().has_ba();
    let (first, total) = (FirstOrder::default_for(has_ba), Total::default_for(has_ba));
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
    let has_subsets = analysis.shapley_of(study.space()) == Some(ShapleyMethod::Subsets);
    let asked = match (design.is_dependent(), has_subsets) {
        (false, false) => "one for each factor, group, subset and dummy",
        (false, true) => "one for each factor, group, subset and dummy, and the others for Shapley effects",
        (true, false) => "two for each factor, group and subset: the others follow it, or it is drawn given the others",
        (true, true) => {
            "two for each factor, group and subset: the others follow it, or it is drawn given the others; the rest for Shapley effects"
        }
    };
    let mut words = vec!["A and B".to_owned(), format!("{} AB ({asked})", rows_of(swaps))];
    if design.has_ba() {
        let estimators = analysis.estimators.iter().filter(|estimator| estimator.needs_ba());
        let askers = analysis.second_order.then_some("second order").into_iter().chain(estimators.map(|e| e.name()));
        words.push(format!("{} BA ({})", rows_of(swaps), askers.collect::<Vec<_>>().join(", ")));
    }
    let plain = design.plain_rows();
    words.extend((plain > 0).then(|| format!("{plain} plain, for surrogates alone")));
    let steps = design.step_runs().len();
    words.extend((steps > 0).then(|| {
        let players = analysis.shapley_players.unwrap_or_default().name();
        format!("{} along a random order of the {players}, for Shapley effects", rows_of(steps))
    }));
    let all = 2 + swaps as u64 * (1 + u64::from(design.has_ba())) + u64::from(plain) + steps as u64;
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

pub(super) fn runs(number: u64) -> String {
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
