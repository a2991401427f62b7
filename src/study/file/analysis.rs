//! The `[analysis]` table, and when a run ends: what is asked of the runs beside first-order and total indices.

use super::context::{Context, Fault, choice, unknown_name, wrong};
use super::error::Problem;
use super::sections::{AnalysisSection, At, DesignSection};
use crate::design::{MAX_ORDERED_FACTORS, Sampler, has_room_for_orders};
use crate::estimate::{Estimator, MAX_SHAPLEY_FACTORS, ShapleyMethod, ShapleyPlayers};
use crate::given::Measure;
use crate::quantity::{Dimension, Quantity};
use crate::run::FailurePolicy;
use crate::space::Space;
use crate::study::options::{DEFAULT_MAX_FAILED, DEFAULT_RESAMPLES, DEFAULT_THRESHOLD, RESAMPLES, shapley_players};
use crate::study::{AnalysisOptions, SurrogateChoice, Target};
use crate::uncertainty::IntervalMethod;

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
    let shapley = shapley(context, section, space)?;
    Ok(AnalysisOptions {
        estimators: estimators(context, section)?,
        measures: measures(context, section)?,
        salib: false,
        second_order: flag(&section.second_order),
        subsets: subsets(context, section, space)?,
        shapley: shapley.asked,
        shapley_method: shapley.method,
        shapley_players: shapley.players,
        aggregate: flag(&section.aggregate),
        dummy: flag(&section.dummy),
        convergence: section.convergence.as_ref().is_none_or(|asked| *asked.get_ref()),
        intervals,
        surrogate: surrogate(context, section, intervals)?,
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

fn measures(context: &Context<'_>, section: &AnalysisSection) -> Result<Vec<Measure>, Fault> {
    let mut measures = Vec::new();
    for name in section.measures.iter().flat_map(|list| list.get_ref()) {
        let measure = choice(context, name, "measure", &Measure::ALL, Measure::name)?;
        if measures.contains(&measure) {
            let problem = Problem::Repeated { what: "measure", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        measures.push(measure);
    }
    // In the order of results.
    measures.sort_unstable();
    Ok(measures)
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

/// What is said of Shapley effects.
#[derive(Default)]
struct Shapley {
    asked: Option<bool>,
    method: Option<ShapleyMethod>,
    players: Option<ShapleyPlayers>,
}

fn shapley(context: &Context<'_>, section: &AnalysisSection, space: &Space) -> Result<Shapley, Fault> {
    let factors = space.factors().len();
    let mut shapley = Shapley { asked: section.shapley.as_ref().map(|asked| *asked.get_ref()), ..Shapley::default() };
    let refused = shapley.asked == Some(false);
    let fault = |at: &At<String>, key: &str, expected: &str, found: String| {
        Err(context.fault(at.span(), wrong(key, expected, found)))
    };
    const BESIDE_FALSE: &str = "nothing beside shapley = false";
    if let Some(name) = &section.shapley_players {
        let found = choice(context, name, "kind of players", &ShapleyPlayers::ALL, ShapleyPlayers::name)?;
        if refused {
            return fault(name, "shapley_players", BESIDE_FALSE, format!("\"{}\"", found.name()));
        }
        if found == ShapleyPlayers::Groups && space.groups().is_empty() {
            let expected = "\"groups\" where factors have some, as in group = \"load\" of a [[factor]]";
            return fault(name, "shapley_players", expected, "it in a study without groups".to_owned());
        }
        shapley.players = Some(found);
    }
    let players = shapley_players(shapley.players.unwrap_or_default(), space).len();
    let what = if shapley.players == Some(ShapleyPlayers::Groups) { "players" } else { "factors" };
    if let Some(name) = &section.shapley_method {
        let found = choice(context, name, "method for Shapley effects", &ShapleyMethod::ALL, ShapleyMethod::name)?;
        if found == ShapleyMethod::Subsets && players > MAX_SHAPLEY_FACTORS {
            let expected = format!("\"permutations\": all subsets are those of at most {MAX_SHAPLEY_FACTORS} {what}");
            return fault(name, "shapley_method", &expected, format!("\"subsets\" with {players} {what}"));
        }
        if refused {
            return fault(name, "shapley_method", BESIDE_FALSE, format!("\"{}\"", found.name()));
        }
        shapley.method = Some(found);
    }
    let asked = section.shapley.as_ref().map(|asked| (*asked.get_ref(), asked.span(), "shapley"));
    let method = section.shapley_method.as_ref().map(|name| (true, name.span(), "shapley_method"));
    let of_whom = section.shapley_players.as_ref().map(|name| (true, name.span(), "shapley_players"));
    if let Some((true, span, key)) = asked.or(method).or(of_whom) {
        if players > MAX_SHAPLEY_FACTORS && !has_room_for_orders(players, factors) {
            let fewer = match shapley.players {
                Some(ShapleyPlayers::Groups) => "fewer groups",
                _ => "groups, with shapley_players = \"groups\"",
            };
            let expected = format!(
                "no Shapley effects, which are those of at most {MAX_ORDERED_FACTORS} factors; of more factors in {fewer}"
            );
            return Err(context.fault(span, wrong(key, &expected, format!("them with {factors} factors"))));
        }
        if space.noise().is_some() {
            let expected = "no Shapley effects: the noise of a stochastic model is no factor that could have a share";
            return Err(context.fault(span, wrong(key, expected, "them".to_owned())));
        }
    }
    Ok(shapley)
}

fn surrogate(
    context: &Context<'_>,
    section: &AnalysisSection,
    intervals: IntervalMethod,
) -> Result<SurrogateChoice, Fault> {
    let Some(name) = &section.surrogate else { return Ok(SurrogateChoice::default()) };
    let choice = choice(context, name, "choice of surrogate", &SurrogateChoice::ALL, SurrogateChoice::name)?;
    if choice == SurrogateChoice::On && intervals != IntervalMethod::Nets {
        let expected = "only beside intervals = \"nets\", whose points are scrambled Sobol' points";
        let problem = wrong("surrogate", expected, format!("intervals = \"{}\"", intervals.name()));
        return Err(context.fault(name.span(), problem));
    }
    Ok(choice)
}

fn resamples(context: &Context<'_>, section: &AnalysisSection, method: IntervalMethod) -> Result<usize, Fault> {
    let Some(resamples) = &section.resamples else { return Ok(DEFAULT_RESAMPLES) };
    let found = *resamples.get_ref();
    if !usize::try_from(found).is_ok_and(|found| RESAMPLES.contains(&found)) {
        let expected = format!("a whole number from {} to {}", RESAMPLES.start(), RESAMPLES.end());
        let problem = wrong("resamples", &expected, found.to_string());
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
pub(super) fn target(context: &Context<'_>, section: &DesignSection, sampler: Sampler) -> Result<Target, Fault> {
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
    let max_runs = section.max_runs.as_ref().map(|runs| *runs.get_ref());
    Ok(Target { half_width, budget, max_runs, is_free: false })
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
