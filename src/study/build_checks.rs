//! What a study that is made in code must be: the same as one in a file.

use std::collections::BTreeSet;

use super::options::RESAMPLES;
use super::{AnalysisOptions, BuildError, Target};
use crate::design::{MAX_ORDERED_FACTORS, Sampler, has_room_for_orders};
use crate::estimate::{Estimator, MAX_SHAPLEY_FACTORS, ShapleyMethod, ShapleyPlayers};
use crate::model::{Model, OutputSeries};
use crate::names::{refused_name, shown};
use crate::space::{Factor, Space};

/// Its name and that of its group can be shown, and it has somewhere to stand when it does not vary.
pub(super) fn check_factor(factor: &Factor) -> Result<(), BuildError> {
    let names = [("factor", Some(&factor.name)), ("group", factor.group.as_ref())];
    for (what, name) in names.into_iter().filter_map(|(what, name)| Some((what, name?))) {
        if let Some(expected) = refused_name(name) {
            return Err(BuildError::Words { what, name: shown(name), expected });
        }
    }
    if !factor.nominal.is_finite() {
        return Err(BuildError::Nominal { factor: factor.name.clone(), value: factor.nominal });
    }
    Ok(())
}

pub(super) fn refuse_repeated<'a>(
    what: &'static str,
    mut names: impl Iterator<Item = &'a str>,
) -> Result<(), BuildError> {
    let mut seen = BTreeSet::new();
    let repeated = names.find(|name| !seen.insert(*name));
    repeated.map_or(Ok(()), |name| Err(BuildError::Repeated { what, name: name.to_owned() }))
}

/// Every series has outputs of its own.
pub(super) fn refuse_overlap(model: &dyn Model) -> Result<(), BuildError> {
    let (outputs, mut taken) = (model.outputs().len(), BTreeSet::new());
    let is_wrong = |series: &&OutputSeries| series.places().any(|place| place >= outputs || !taken.insert(place));
    model.series().iter().find(is_wrong).map_or(Ok(()), |series| {
        let (name, places) = (series.name.clone(), series.places());
        Err(BuildError::Series { name, first: places.start, last: places.end - 1, outputs })
    })
}

/// The options as a study file could have said them.
pub(super) fn checked(
    mut options: AnalysisOptions,
    sampler: Sampler,
    space: &Space,
) -> Result<AnalysisOptions, BuildError> {
    let factors = space.factors().len();
    if !options.intervals.serves(sampler) {
        let (method, sampler) = (options.intervals.name(), sampler.name());
        return Err(BuildError::UnfitInterval { method, sampler });
    }
    for (what, value) in [("threshold", options.threshold), ("max_failed", options.max_failed)] {
        if !(0.0..=1.0).contains(&value) {
            return Err(BuildError::NotAShare { what, value });
        }
    }
    if !RESAMPLES.contains(&options.resamples) {
        return Err(BuildError::Resamples { found: options.resamples });
    }
    for subset in &mut options.subsets {
        subset.sort_unstable();
        subset.dedup();
        if subset.is_empty() || subset.iter().any(|factor| *factor >= factors) {
            return Err(BuildError::Subset { subset: subset.clone(), factors });
        }
    }
    let players = options.players(space).len();
    let (most, fits) = match options.shapley_method {
        Some(ShapleyMethod::Subsets) => (MAX_SHAPLEY_FACTORS, players <= MAX_SHAPLEY_FACTORS),
        // All subsets, of so few.
        None if players <= MAX_SHAPLEY_FACTORS => (MAX_ORDERED_FACTORS, true),
        Some(ShapleyMethod::Permutations) | None => (MAX_ORDERED_FACTORS, has_room_for_orders(players, factors)),
    };
    if options.asks_for_shapley() && !fits {
        return Err(BuildError::Shapley { factors: players, most });
    }
    if let (Some(false), Some(method)) = (options.shapley, options.shapley_method) {
        return Err(BuildError::ShapleyMethod { method: method.name() });
    }
    let groups = options.shapley_players == Some(ShapleyPlayers::Groups);
    if groups && (options.shapley == Some(false) || space.groups().is_empty()) {
        return Err(BuildError::ShapleyPlayers { wanted: options.shapley != Some(false) });
    }
    options.measures.sort_unstable();
    options.measures.dedup();
    // The default ones are in every result.
    options.estimators.retain(|estimator| *estimator != Estimator::Default);
    Ok(options)
}

/// The target as a study file could have said it.
pub(super) fn checked_target(target: Target, sampler: Sampler) -> Result<Target, BuildError> {
    if target.grows() && sampler == Sampler::LatinHypercube {
        return Err(BuildError::CannotGrow);
    }
    if target.is_free && target.half_width.is_none() {
        return Err(BuildError::NoAccuracy);
    }
    for (what, value) in [("half width of the target", target.half_width), ("budget", target.budget)] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            return Err(BuildError::NotPositive { what, value });
        }
    }
    Ok(target)
}
