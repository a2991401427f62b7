//! Sobol' global sensitivity analysis: which input of a model decides its output, and by how many percent.
//!
//! A [`Study`] describes the question: a [`Model`], the [`Factor`]s that vary, the points and the [`Target`].
//! [`Study::run`] returns a [`StudyResult`]; [`Runner`] does the same with threads, progress and a journal. The steps
//! can also be called one by one: a [`Design`] generates points by row number, a [`Worker`] of the model evaluates
//! them, an [`Estimator`] computes indices from sums, and an [`IntervalMethod`] computes their confidence intervals.
//!
//! There are also indices from [`given`] data, [`screening`] and [`sweep`]s.
//!
//! # Related crates
//!
//! | crate | what it adds |
//! |---|---|
//! | `apportion-base` | what all share: names, text, physical quantities, sums |
//! | `apportion-afm` | the force with which an AFM tip pushes a nanoparticle: contact, friction, a ladder of fidelities |
//! | `apportion-files` | studies in TOML, programs in any language as models, points and outputs as tables |
//! | `apportion-report` | results as text, tables, charts and pages |
//! | `apportion-cli` | the program `apportion` |
//!
//! # An example
//!
//! The volume of a box of uncertain sides:
//!
//! ```
//! use apportion::{Distribution, Study, function_model};
//!
//! let study = Study::builder("box", function_model("volume", |x| x[0] * x[1] * x[2]))
//!     .factor("length", Distribution::normal(2.0, 0.02)?)
//!     .factor("width", Distribution::uniform(0.9, 1.1)?)
//!     .factor("height", Distribution::uniform(0.45, 0.55)?)
//!     .build()?;
//! let result = study.run()?;
//! let width = result.output("volume")?.factor("width")?;
//! // Both sides vary by a tenth: half of the variance each, but for the little that the length explains.
//! assert!((width.first_order.estimate - 0.49).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Example programs
//!
//! Each is a short program in the folder `examples` of the sources, and is run by the tests: `cargo run --release
//! --example NAME`.
//!
//! | example | what it shows |
//! |---|---|
//! | `function_model` | a Rust function as a model |
//! | `pendulum` | the same in few lines |
//! | `study_file` | a study file run from Rust, with progress |
//! | `units_and_failures` | units, several outputs, failed runs, second-order indices |
//! | `interrupted` | a journal: interrupted, resumed to the same bits, and extended |
//! | `own_program` | a program in any language as a model, called from Rust (`CommandModel`) |
//! | `three_steps` | points to a file, outputs from any source, analysed (`exchange`) |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod analysis;
mod correction;
pub mod design;
mod effect;
pub mod estimate;
pub mod given;
pub mod model;
pub mod result;
pub mod run;
mod runner;
pub mod screening;
pub mod space;
pub mod study;
mod surrogate;
pub mod sweep;
pub mod uncertainty;

pub use apportion_base::quantity::Unit;
pub use correction::LowFidelityUse;
pub use design::{Design, DesignError, DesignSettings, Rows, Sampler, SobolSequence};
pub use effect::IndexPair;
pub use estimate::{Estimator, FirstOrder, Scaling, Total, Undefined};
pub use model::{
    Batch, Counter, CounterKind, Expression, ExpressionError, ExpressionModel, Flag, FunctionModel, GiveUp,
    KnownAnswer, KnownFunction, Messages, Model, Output, OutputSeries, RepeatedModel, RowFailure, RunContext,
    SeriesAxis, SeriesError, Worker, function_model,
};
pub use result::{LookupError, OutputResult, StudyResult, Warning};
pub use run::{FailurePolicy, Progress, RemoteWorkers, RunError, Shard, ShardError};
pub use runner::{Requests, Resume, Runner, WorkerStudy};
pub use space::{CorrelationMeasure, Dependence, DependenceError, Distribution, DistributionError, Factor, Space};
pub use study::{AnalysisOptions, BuildError, Study, StudyBuilder, SurrogateChoice, Target};
pub use surrogate::NamedTerm;
pub use uncertainty::{DependentEstimates, EffectEstimates, Estimate, Interval, IntervalMethod};
