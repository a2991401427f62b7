//! What can be wrong with a study that is made in code.

use thiserror::Error;

use super::options::{MOST_OUTPUTS_OF_MEASURES, RESAMPLES};
use crate::design::DesignError;
use crate::estimate::MAX_SHAPLEY_FACTORS;
use crate::space::{DependenceError, DistributionError};

/// Why a study cannot be built.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum BuildError {
    /// The name cannot name files.
    #[error("the name {0:?} of the study: expected {NAME}", NAME = crate::names::NAME_RULE)]
    Name(String),
    /// A name or title that no table or file has room for, or with marks in it that are not seen.
    #[error("{what} {name}: expected {expected}")]
    Words {
        /// What it is of.
        what: &'static str,
        /// The name or title, or its beginning.
        name: String,
        /// What would be right.
        expected: String,
    },
    /// The model has no outputs.
    #[error("the model has no outputs")]
    NoOutputs,
    /// A series of outputs that are not there, or that belong to another one.
    #[error(
        "series `{name}` has outputs {first} to {last}, counted from 0: expected some of the model's {outputs}, of no other series"
    )]
    Series {
        /// Its name.
        name: String,
        /// Place of its first value.
        first: usize,
        /// Place of its last value.
        last: usize,
        /// Outputs of the model.
        outputs: usize,
    },
    /// A name twice.
    #[error("{what} `{name}` is there twice")]
    Repeated {
        /// What the name is of.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A factor cannot be converted to SI units.
    #[error("factor `{factor}`: {source}")]
    Factor {
        /// Its name.
        factor: String,
        /// Why.
        source: DistributionError,
    },
    /// There is no such design.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// Intervals of a kind that does not hold for these points.
    #[error("intervals \"{method}\" do not hold for points of the sampler \"{sampler}\"")]
    UnfitInterval {
        /// The kind of interval.
        method: &'static str,
        /// The sampler.
        sampler: &'static str,
    },
    /// A subset names no factors, or one that is not there.
    #[error("subset {subset:?}: expected numbers of factors, counted from 0, of which there are {factors}")]
    Subset {
        /// The subset.
        subset: Vec<usize>,
        /// The number of factors.
        factors: usize,
    },
    /// Factors that cannot depend on each other as stated.
    #[error(transparent)]
    Dependence(#[from] DependenceError),
    /// Something that needs independent factors.
    #[error("{what}: not where factors depend on each other, or share the variance with a noise")]
    Dependent {
        /// What.
        what: &'static str,
    },
    /// Shapley effects of too many factors, or groups.
    #[error(
        "Shapley effects of {factors} players: at most {most}, {}",
        if *most == MAX_SHAPLEY_FACTORS { "each base sample taking 2^d runs; by random permutations there may be more" } else {
            "each base sample taking a run for each"
        }
    )]
    Shapley {
        /// The number of players.
        factors: usize,
        /// Most that the method serves.
        most: usize,
    },
    /// A method for Shapley effects that are not wanted.
    #[error("shapley_method = \"{method}\" beside shapley = false: leave out one of them")]
    ShapleyMethod {
        /// Its name.
        method: &'static str,
    },
    /// Shapley effects of groups that are not there, or not wanted.
    #[error(
        "shapley_players = \"groups\" {}",
        if *wanted { "without a group: give factors one" } else { "beside shapley = false: leave out one of them" }
    )]
    ShapleyPlayers {
        /// Whether there are to be Shapley effects.
        wanted: bool,
    },
    /// Other measures of too many outputs.
    #[error("measures of {outputs} outputs: at most {MOST_OUTPUTS_OF_MEASURES}, each of which takes a second or so")]
    Measures {
        /// The number of outputs.
        outputs: usize,
    },
    /// A bootstrap of too few resamples, or too many.
    #[error("resamples = {found}: expected a whole number from {} to {}", RESAMPLES.start(), RESAMPLES.end())]
    Resamples {
        /// How many were asked for.
        found: usize,
    },
    /// A factor that has nowhere to stand when it does not vary.
    #[error("factor {factor}: its nominal value is {value}: expected a finite number")]
    Nominal {
        /// The factor.
        factor: String,
        /// The value.
        value: f64,
    },
    /// A run that chooses its design by itself, without an accuracy that it is to reach.
    #[error("a target that is free needs a half width: make it by Target::accuracy")]
    NoAccuracy,
    /// A target that no run can reach.
    #[error("{what} = {value}: expected a finite number above 0")]
    NotPositive {
        /// What of the target.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A target for points that cannot be added to.
    #[error(
        "a run goes on until a target by adding points, and a Latin hypercube has none to add: take another sampler"
    )]
    CannotGrow,
    /// Fewer runs than the smallest design takes.
    #[error("max_runs of the target: expected {least} or more, which 2 base points in each replicate take")]
    MaxRuns {
        /// Runs of the smallest design.
        least: u64,
    },
    /// A share or threshold that is none.
    #[error("{what} = {value}: expected a number from 0 to 1")]
    NotAShare {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A cheaper model that cannot stand in.
    #[error("low fidelity `{name}`: {problem}")]
    LowFidelity {
        /// Its name.
        name: String,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// A model of other outputs than those of the study that it is put into.
    #[error("the outputs of the model are {found}, and must be those of the study: {expected}")]
    OtherOutputs {
        /// Those of the model, with their units.
        found: String,
        /// Those of the study.
        expected: String,
    },
    /// A budget of runs beside something else that decides the size of the design.
    #[error("budget_runs beside {other}: expected it alone, as it decides the size of the design")]
    BudgetRunsBeside {
        /// What else.
        other: &'static str,
    },
    /// A budget of fewer runs than the smallest split design takes.
    #[error("budget_runs: expected {least} or more, which 2 base points in each replicate take")]
    BudgetRuns {
        /// Runs of the smallest design.
        least: u64,
    },
    /// Plain rows where no surrogate would learn from them.
    #[error("plain rows serve surrogates alone, and there are none with {why}")]
    PlainRows {
        /// The option that stands against them.
        why: String,
    },
}
