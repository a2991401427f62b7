//! The rules for every study, built in code or read from a file.

use std::collections::BTreeSet;

use super::options::{
    FIRST_ROWS, MAX_GROWN_ROWS, MAX_OUTPUTS_OF_MEASURES, MAX_PLAIN_ROWS, MIN_PLAIN_ROWS, PLAIN_ROWS_OF_FACTOR,
    RESAMPLES, base_samples_within, rows,
};
use super::{AnalysisOptions, BuildError, LowFidelity, SurrogateChoice, Target};
use crate::design::{Design, DesignSettings, Sampler};
use crate::estimate::{Estimator, MAX_SHAPLEY_FACTORS};
use crate::model::Model;
use crate::space::{Factor, IndicesOf, Space};
use crate::uncertainty::IntervalMethod;
use apportion_base::names::{NAME_RULE, names_files, refused_name, refused_output_name, refused_title, shown};

/// Returns an error for a value that `key` cannot have.
pub(super) fn wrong<T>(key: &'static str, expected: impl Into<String>, found: impl ToString) -> Result<T, BuildError> {
    Err(BuildError::Wrong { key, expected: expected.into(), found: found.to_string() })
}

/// Checks that the name of the study is valid in file names, and that its title can be shown on pages.
pub(super) fn check_title(name: &str, title: Option<&str>) -> Result<(), BuildError> {
    if !names_files(name) {
        return wrong("name", NAME_RULE, shown(name));
    }
    match title.and_then(refused_title) {
        Some(expected) => wrong("title", expected, shown(title.unwrap_or_default())),
        None => Ok(()),
    }
}

/// Checks that outputs have distinct names, and that no two series share an output.
pub(super) fn check_outputs(model: &dyn Model) -> Result<(), BuildError> {
    let outputs = model.outputs();
    if outputs.is_empty() {
        return wrong("outputs", "one or more", "none");
    }
    for output in outputs {
        if let Some(expected) = refused_output_name(&output.name) {
            return Err(BuildError::Name { what: "output", name: output.name.to_string(), expected });
        }
    }
    let mut taken = BTreeSet::new();
    for series in model.series() {
        let (name, places, count) = (&series.name, series.places(), outputs.len());
        if places.clone().any(|place| place >= count || !taken.insert(place)) {
            let expected = format!("{count}, and those of the series `{name}` must belong to no other series");
            return wrong("outputs", expected, format!("{} to {}, counted from 0", places.start, places.end - 1));
        }
    }
    Ok(())
}

/// Checks that factors, their groups and labels have valid names, and that factors have a valid nominal value.
pub(super) fn check_factors(factors: &[Factor], model: &dyn Model) -> Result<(), BuildError> {
    let mut seen: BTreeSet<&str> = BTreeSet::new();
    if let Some(output) = model.outputs().iter().find(|output| !seen.insert(&output.name)) {
        return Err(BuildError::Repeated { what: "output", name: output.name.to_string() });
    }
    for factor in factors {
        let labels = factor.distribution().labels().unwrap_or_default();
        let names = [("factor", Some(&factor.name)), ("group", factor.group.as_ref())].into_iter();
        let names = names.filter_map(|(what, name)| Some((what, name?)));
        for (what, name) in names.chain(labels.iter().map(|label| ("label", label))) {
            if let Some(expected) = refused_name(name) {
                return Err(BuildError::Name { what, name: name.clone(), expected });
            }
        }
        if !seen.insert(&factor.name) {
            return Err(BuildError::Repeated { what: "factor or output", name: factor.name.clone() });
        }
        if !factor.nominal.is_finite() {
            return wrong("nominal", format!("a finite number, of factor `{}`", factor.name), factor.nominal);
        }
    }
    let noises = factors.iter().filter(|factor| factor.distribution().is_noise()).count();
    match noises {
        0 => Ok(()),
        1 if factors.len() > 1 => Ok(()),
        1 => wrong("noise", "used with factors", "alone"),
        _ => wrong("noise", "one seed for all random numbers of the model", format!("{noises} of them")),
    }
}

/// Returns the options, checked to be valid for points of `sampler` and the factors of `space`.
pub(super) fn checked_options(
    mut options: AnalysisOptions,
    sampler: Sampler,
    space: &Space,
    outputs: usize,
) -> Result<AnalysisOptions, BuildError> {
    let (factors, intervals) = (space.factors().len(), options.intervals);
    if !intervals.serves(sampler) {
        let serving = IntervalMethod::ALL.into_iter().filter(|method| method.serves(sampler)).map(IntervalMethod::name);
        let expected =
            format!("one of {} for points of the sampler {}", serving.collect::<Vec<_>>().join(", "), sampler.name());
        return wrong("intervals", expected, intervals.name());
    }
    for (key, value) in [("threshold", options.threshold), ("max_failed", options.max_failed)] {
        if !(0.0..=1.0).contains(&value) {
            return wrong(key, "a number from 0 to 1", value);
        }
    }
    if !RESAMPLES.contains(&options.resamples) {
        let expected = format!("a whole number from {} to {}", RESAMPLES.start(), RESAMPLES.end());
        return wrong("resamples", expected, options.resamples);
    }
    if options.surrogate == SurrogateChoice::On && intervals != IntervalMethod::Nets {
        return wrong("surrogate", "on only with intervals by nets", format!("with those by {}", intervals.name()));
    }
    if !options.measures.is_empty() && outputs > MAX_OUTPUTS_OF_MEASURES {
        let expected = format!("those of at most {MAX_OUTPUTS_OF_MEASURES} outputs");
        return wrong("measures", expected, format!("of {outputs}"));
    }
    for subset in &mut options.subsets {
        subset.sort_unstable();
        subset.dedup();
        if subset.is_empty() || subset.iter().any(|factor| *factor >= factors) {
            return wrong("subsets", "lists of factors", format!("{subset:?}"));
        }
    }
    let mut seen = BTreeSet::new();
    options.subsets.retain(|subset| seen.insert(subset.clone()));
    check_groups(&options, space)?;
    options.measures.sort_unstable();
    options.measures.dedup();
    // Every result contains the default ones.
    let mut seen = BTreeSet::from([Estimator::Default.name()]);
    options.estimators.retain(|estimator| seen.insert(estimator.name()));
    Ok(options)
}

fn check_groups(options: &AnalysisOptions, space: &Space) -> Result<(), BuildError> {
    let members = options.members(space);
    if options.indices_of == IndicesOf::Groups {
        let groups = space.groups();
        let names: BTreeSet<&str> = space.factors().iter().map(|factor| factor.name.as_str()).collect();
        let obstacle = if groups.is_empty() {
            Some("in a study without groups")
        } else if groups.iter().any(|group| names.contains(group.name.as_str())) {
            Some("where a group has the name of a factor")
        } else {
            space.noise().map(|_| "with a noise")
        };
        if let Some(obstacle) = obstacle {
            return wrong("indices_of", format!("factors {obstacle}"), "groups");
        }
    }
    if options.shapley == Some(true) && members.len() > MAX_SHAPLEY_FACTORS {
        let expected = format!(
            "false with more than {MAX_SHAPLEY_FACTORS} factors: put them into at most {MAX_SHAPLEY_FACTORS} groups, and \
             estimate the indices of groups"
        );
        return wrong("shapley", expected, format!("true with {} factors and groups", members.len()));
    }
    if options.shapley == Some(true) && space.noise().is_some() {
        return wrong("shapley", "false with a noise, which cannot have a share", "true");
    }
    Ok(())
}

/// Refuses options that need independent factors.
pub(super) fn check_dependent(
    options: &AnalysisOptions,
    space: &Space,
    low_fidelities: &[LowFidelity],
) -> Result<(), BuildError> {
    let refused = [
        ("noise", space.noise().is_some()),
        ("surrogate", options.surrogate == SurrogateChoice::On),
        ("low", !low_fidelities.is_empty()),
    ];
    match refused.into_iter().find(|(_, is_given)| *is_given) {
        Some((key, _)) if space.copula().is_some() => {
            wrong(key, "left out where factors depend on each other: it needs independent ones", "given")
        }
        _ => Ok(()),
    }
}

/// Checks that low-fidelity models have distinct names and the outputs of `model`, and no size where the accuracy
/// determines it.
pub(super) fn check_low_fidelities(
    low_fidelities: &[LowFidelity],
    model: &dyn Model,
    space: &Space,
    target: Target,
) -> Result<(), BuildError> {
    let mut names = BTreeSet::new();
    for LowFidelity { name, subject, base_samples } in low_fidelities {
        if !names.insert(name) {
            return Err(BuildError::Repeated { what: "cheaper model", name: name.clone() });
        }
        let [outputs, expected] = [&*subject.model(space), model].map(|model| {
            let names: Vec<&str> = model.outputs().iter().map(|output| &*output.name).collect();
            names.join(", ")
        });
        if outputs != expected {
            let problem = format!("its outputs are {outputs}, and must be those of the model: {expected}");
            return Err(BuildError::LowFidelity { name: name.clone(), problem });
        }
        if base_samples.is_some() && target.accuracy.is_some() {
            return wrong("base_samples", "left out with an accuracy, which chooses it", "given");
        }
    }
    Ok(())
}

/// The length of a run, given in one way: by base samples, by runs, or by an accuracy; and limits if it grows.
pub struct Length {
    pub base_samples: Option<u64>,
    pub runs: Option<u64>,
    pub target: Target,
}

impl Length {
    pub(super) fn check(&self, sampler: Sampler) -> Result<(), BuildError> {
        let Target { accuracy, max_time, max_runs, smallest_region } = self.target;
        let sizes = [
            ("accuracy", accuracy.is_some()),
            ("runs", self.runs.is_some()),
            ("base_samples", self.base_samples.is_some()),
        ];
        let mut given = sizes.into_iter().filter(|(_, is_given)| *is_given).map(|(key, _)| key);
        let (size, second) = (given.next(), given.next());
        if let Some((size, second)) = size.zip(second) {
            return wrong(second, "the only key for the length of a run", format!("together with {size}"));
        }
        let limits = [("max_runs", max_runs.is_some()), ("max_time", max_time.is_some())];
        if let Some((limit, _)) = limits.into_iter().find(|(_, is_given)| *is_given)
            && let Some(size) = size.filter(|size| *size != "accuracy")
        {
            return wrong(limit, "used with an accuracy or alone", format!("with {size}"));
        }
        if accuracy.is_none()
            && let Some(region) = smallest_region
        {
            return wrong("smallest_region", "used with `accuracy`", region);
        }
        if let Some(region) = smallest_region.filter(|region| !(*region > 0.0 && *region < 1.0)) {
            return wrong("smallest_region", "a part of a factor's range, above 0 and below 1", region);
        }
        for (key, value) in [("accuracy", accuracy), ("max_time", max_time)] {
            if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
                return wrong(key, "a finite number above 0", value);
            }
        }
        if self.target.grows() && sampler == Sampler::LatinHypercube {
            return wrong("sampler", "sobol or random for a run that grows", "a Latin hypercube");
        }
        Ok(())
    }

    /// Returns the design: with an accuracy or a number of runs the plain rows, if a surrogate of `plain` rows is where a run
    /// begins and gives all indices; or the best base samples within it.
    pub(super) fn design(
        &self,
        options: &AnalysisOptions,
        space: &Space,
        outputs: usize,
        settings: DesignSettings,
        plain: Option<u64>,
    ) -> Result<Design, BuildError> {
        let (factors, replicates) = (space.factors().len(), settings.replicates);
        let with = |base_samples| {
            let settings = DesignSettings { base_samples, ..settings.clone() };
            Design::new(settings, factors, rows(options, space))
        };
        // Errors in the rows are those of this one too.
        let smallest = with(replicates.saturating_mul(2))?;
        let each = replicates.saturating_mul(2);
        let plain = plain.filter(|_| options.takes_plain_rows(&settings, space, outputs));
        let Some(runs) = self.runs else {
            let first = plain.map(|rows| rows.max(FIRST_ROWS).next_multiple_of(each));
            let most = self.target.max_runs.unwrap_or(u64::MAX).min(MAX_GROWN_ROWS);
            return Ok(match first.filter(|rows| self.target.accuracy.is_some() && *rows <= most) {
                Some(rows) => smallest.plain(rows)?,
                None => with(self.base_samples.unwrap_or_else(|| self.target.base_samples(replicates)))?,
            });
        };
        if plain.is_some() && runs <= MAX_PLAIN_ROWS {
            let varying = factors - space.constants().len();
            let fewest = MIN_PLAIN_ROWS.max(PLAIN_ROWS_OF_FACTOR * varying as u64);
            if runs < fewest {
                let expected = format!("{fewest} or more: fewer tell only which factors have no effect (a screening)");
                return wrong("runs", expected, runs);
            }
            return Ok(smallest.plain(runs)?);
        }
        let base_samples = base_samples_within(runs, smallest.rows_per_point(), replicates).or_else(|min_runs| {
            wrong(
                "runs",
                format!("{min_runs} or more, the runs of 2 base samples in each of {replicates} replicates"),
                runs,
            )
        })?;
        Ok(with(base_samples)?)
    }
}
