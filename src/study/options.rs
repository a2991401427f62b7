//! The `[analysis]` table, and when a run ends: what is asked of the runs beside first-order and total indices.

use super::error::{Problem, nearest};
use super::file::{AnalysisSection, At, DesignSection};
use super::resolve::{Context, Fault, unknown_name};
use crate::design::Sampler;
use crate::estimate::Estimator;
use crate::quantity::{Dimension, Quantity};
use crate::run::FailurePolicy;
use crate::space::Space;
use crate::uncertainty::IntervalMethod;

/// What is asked of the runs.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisOptions {
    /// Estimators whose indices stand beside those of the default ones.
    pub estimators: Vec<Estimator>,
    /// Whether second-order indices are estimated.
    pub second_order: bool,
    /// Sets of factors, by number, whose joint indices are asked for.
    pub subsets: Vec<Vec<usize>>,
    /// Whether indices over all outputs together are asked for.
    pub aggregate: bool,
    /// Whether a dummy factor, which does nothing, is run along: its indices are the noise of the model.
    pub dummy: bool,
    /// How intervals are found.
    pub intervals: IntervalMethod,
    /// Resamples of a bootstrap.
    pub resamples: usize,
    /// Total index above which a factor counts as one that matters.
    pub threshold: f64,
    /// What happens when a run fails.
    pub failures: FailurePolicy,
    /// Largest share of the runs that may fail before there are no indices.
    pub max_failed: f64,
}

impl AnalysisOptions {
    /// Nothing beside first-order and total indices, with the intervals that serve points of `sampler` best.
    pub fn for_sampler(sampler: Sampler) -> Self {
        Self {
            estimators: Vec::new(),
            second_order: false,
            subsets: Vec::new(),
            aggregate: false,
            dummy: false,
            intervals: IntervalMethod::default_for(sampler),
            resamples: DEFAULT_RESAMPLES,
            threshold: DEFAULT_THRESHOLD,
            failures: FailurePolicy::DropBlock,
            max_failed: DEFAULT_MAX_FAILED,
        }
    }
}

/// When a run that grows by doubling ends; one that asks for none of these has the size that the design says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stopping {
    /// Half width that the interval of every first-order and total index must reach.
    pub half_width: Option<f64>,
    /// Seconds that the run may take.
    pub budget: Option<f64>,
    /// Model runs that it may take.
    pub max_runs: Option<u64>,
}

impl Stopping {
    /// Whether the run grows.
    pub fn grows(&self) -> bool {
        *self != Self::default()
    }
}

const DEFAULT_RESAMPLES: usize = 1000;
const DEFAULT_THRESHOLD: f64 = 0.05;
const DEFAULT_MAX_FAILED: f64 = 0.1;

/// Reads the `[analysis]` table.
pub(super) fn analysis(
    context: &Context<'_>,
    section: &AnalysisSection,
    sampler: Sampler,
    space: &Space,
) -> Result<AnalysisOptions, Fault> {
    let flag = |value: &Option<At<bool>>| value.as_ref().is_some_and(|value| *value.get_ref());
    let intervals = intervals(context, section, sampler)?;
    let failures = match &section.failures {
        None => FailurePolicy::DropBlock,
        Some(name) => choice(context, name, "failure policy", &FailurePolicy::ALL, FailurePolicy::name)?,
    };
    Ok(AnalysisOptions {
        estimators: estimators(context, section)?,
        second_order: flag(&section.second_order),
        subsets: subsets(context, section, space)?,
        aggregate: flag(&section.aggregate),
        dummy: flag(&section.dummy),
        intervals,
        resamples: resamples(context, section, intervals)?,
        threshold: between(context, "threshold", section.threshold.as_ref(), DEFAULT_THRESHOLD)?,
        failures,
        max_failed: between(context, "max_failed", section.max_failed.as_ref(), DEFAULT_MAX_FAILED)?,
    })
}

fn intervals(context: &Context<'_>, section: &AnalysisSection, sampler: Sampler) -> Result<IntervalMethod, Fault> {
    let Some(name) = &section.intervals else { return Ok(IntervalMethod::default_for(sampler)) };
    let method = choice(context, name, "kind of interval", &IntervalMethod::ALL, IntervalMethod::name)?;
    if method.serves(sampler) {
        return Ok(method);
    }
    let serving = IntervalMethod::ALL.into_iter().filter(|method| method.serves(sampler)).map(IntervalMethod::name);
    let problem = Problem::UnfitInterval {
        method: method.name(),
        sampler: sampler.name(),
        serving: serving.collect::<Vec<_>>().join(", "),
    };
    Err(context.fault(name.span(), problem))
}

fn estimators(context: &Context<'_>, section: &AnalysisSection) -> Result<Vec<Estimator>, Fault> {
    let mut estimators = Vec::new();
    for name in section.estimators.iter().flat_map(|list| list.get_ref()) {
        let estimator = choice(context, name, "estimator", &Estimator::ALL, Estimator::name)?;
        if estimators.contains(&estimator) {
            let problem = Problem::Repeated { what: "estimator", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        estimators.push(estimator);
    }
    // The default ones are in every result.
    estimators.retain(|estimator| *estimator != Estimator::Default);
    Ok(estimators)
}

fn subsets(context: &Context<'_>, section: &AnalysisSection, space: &Space) -> Result<Vec<Vec<usize>>, Fault> {
    let factors = space.factors();
    let mut subsets = Vec::new();
    for list in section.subsets.iter().flat_map(|lists| lists.get_ref()) {
        let mut numbers = Vec::new();
        for name in list.get_ref() {
            let Some(number) = factors.iter().position(|factor| factor.name == *name.get_ref()) else {
                let problem = unknown_name("factor", name.get_ref(), factors.iter().map(|factor| factor.name.as_str()));
                return Err(context.fault(name.span(), problem));
            };
            if numbers.contains(&number) {
                let problem = Problem::Repeated { what: "factor", name: name.get_ref().clone() };
                return Err(context.fault(name.span(), problem));
            }
            numbers.push(number);
        }
        if numbers.is_empty() {
            let problem =
                wrong("subsets", "lists of factor names, as in [[\"x1\", \"x3\"]]", "an empty list".to_owned());
            return Err(context.fault(list.span(), problem));
        }
        numbers.sort_unstable();
        if subsets.contains(&numbers) {
            let names: Vec<&str> = list.get_ref().iter().map(|name| name.get_ref().as_str()).collect();
            let problem = Problem::Repeated { what: "subset", name: names.join(", ") };
            return Err(context.fault(list.span(), problem));
        }
        subsets.push(numbers);
    }
    Ok(subsets)
}

fn resamples(context: &Context<'_>, section: &AnalysisSection, method: IntervalMethod) -> Result<usize, Fault> {
    const LEAST: u64 = 100;
    const MOST: u64 = 1_000_000;
    let Some(resamples) = &section.resamples else { return Ok(DEFAULT_RESAMPLES) };
    let found = *resamples.get_ref();
    if !(LEAST..=MOST).contains(&found) {
        let problem = wrong("resamples", "a whole number from 100 to 1000000", found.to_string());
        return Err(context.fault(resamples.span(), problem));
    }
    if !matches!(method, IntervalMethod::Percentile | IntervalMethod::Bca) {
        let expected = "only beside intervals = \"percentile\" or \"bca\"";
        return Err(
            context.fault(resamples.span(), wrong("resamples", expected, format!("intervals = \"{}\"", method.name())))
        );
    }
    Ok(found as usize)
}

/// Reads the keys of `[design]` that say when a growing run ends.
pub(super) fn stopping(context: &Context<'_>, section: &DesignSection, sampler: Sampler) -> Result<Stopping, Fault> {
    let half_width = match section.target.as_ref().map(At::get_ref) {
        None => None,
        Some(target) => {
            let width = &target.half_width;
            let fits = *width.get_ref() > 0.0 && width.get_ref().is_finite();
            let problem = || wrong("half_width", "a number above 0, as in 0.01", width.get_ref().to_string());
            Some(if fits { *width.get_ref() } else { return Err(context.fault(width.span(), problem())) })
        }
    };
    let spans = [
        section.target.as_ref().map(At::span),
        section.budget.as_ref().map(At::span),
        section.max_runs.as_ref().map(At::span),
    ];
    if let (Sampler::LatinHypercube, Some(span)) = (sampler, spans.into_iter().flatten().next()) {
        return Err(context.fault(span, Problem::CannotGrow));
    }
    let budget = match &section.budget {
        None => None,
        Some(text) => Some(seconds("budget", text.get_ref()).map_err(|problem| context.fault(text.span(), problem))?),
    };
    Ok(Stopping { half_width, budget, max_runs: section.max_runs.as_ref().map(|runs| *runs.get_ref()) })
}

/// A time above 0, in seconds.
pub(super) fn seconds(key: &str, text: &str) -> Result<f64, Problem> {
    let quantity = Quantity::parse(text)?;
    let seconds = quantity.to_si();
    if quantity.unit.dimension() != Dimension::TIME || !(seconds > 0.0 && seconds.is_finite()) {
        return Err(wrong(key, "a time above 0, as in \"30 s\"", format!("\"{text}\"")));
    }
    Ok(seconds)
}

fn between(context: &Context<'_>, key: &str, value: Option<&At<f64>>, default: f64) -> Result<f64, Fault> {
    match value {
        None => Ok(default),
        Some(value) if (0.0..=1.0).contains(value.get_ref()) => Ok(*value.get_ref()),
        Some(value) => {
            Err(context.fault(value.span(), wrong(key, "a number from 0 to 1", value.get_ref().to_string())))
        }
    }
}

pub(super) fn choice<T: Copy>(
    context: &Context<'_>,
    typed: &At<String>,
    what: &'static str,
    all: &[T],
    name: fn(T) -> &'static str,
) -> Result<T, Fault> {
    let found = all.iter().copied().find(|&choice| name(choice) == typed.get_ref());
    found.ok_or_else(|| {
        let names = || all.iter().map(|&choice| name(choice));
        let problem = Problem::UnknownName {
            what,
            name: typed.get_ref().clone(),
            nearest: nearest(typed.get_ref(), names()),
            expected: names().map(str::to_owned).collect(),
        };
        context.fault(typed.span(), problem)
    })
}

pub(super) fn wrong(key: &str, expected: &str, found: String) -> Problem {
    Problem::WrongType { key: key.to_owned(), expected: expected.to_owned(), found }
}
