//! Sobol' global sensitivity analysis: which input of a model decides its output, and by how many percent.
//!
//! The flagship model answers a question of nanotechnology: of the cantilever's dimensions and the environment, which
//! factor decides the force that the tip of an atomic force microscope needs to push a nanoparticle, under each
//! friction model? The engine knows nothing of that model and serves any other.
//!
//! A [`Study`] says what is asked: a [`Model`], the [`Factor`]s that vary, the points, the [`Target`].
//! [`Study::run`] answers it with a [`StudyResult`]; [`Runner`] is the same with threads, progress and a journal. The steps
//! in between, for those who take them one by one: a [`Design`] gives its points by row number, a [`Worker`] of the model
//! evaluates them, an [`Estimator`] turns sums into indices, and an [`IntervalMethod`] says how well they are known.
//!
//! Beside Sobol' indices of a model there are [`given`] data, [`screening`], [`sweep`]s, and the points and formulas of
//! `salib`; [`mod@afm`] is the physics of the flagship model, plain functions that know nothing of the engine.
//!
//! # Features
//!
//! Without default features the crate is the engine, the physics of the nanoparticle and the known functions. `study` adds
//! study files, programs as models and `exchange`; `charts` adds `report`: results as text, CSV and SVG; `png` its charts as pictures, `pdf` as figures of papers; `page` its pages and folders of files.
//! `cli`, the default, is the program with all of them, and `mpi` the same on the ranks of an MPI job.
//!
//! # An example
//!
//! The force on cantilevers of uncertain thickness and length:
//!
//! ```
//! use apportion::Study;
//!
//! let text = r#"
//!     outputs = ["critical_force"]
//!
//!     [afm]
//!     friction = "hk"
//!
//!     [[factor]]
//!     name = "thickness"
//!     min = 0.8
//!     max = 1.2
//!     unit = "um"
//!
//!     [[factor]]
//!     name = "length"
//!     distribution = "normal"
//!     mean = 225
//!     sd = 5
//!     unit = "um"
//! "#;
//! let study = apportion_files::parse_study(text, "example.toml".as_ref(), &[])?;
//! let result = study.run()?;
//! let thickness = result.output("critical_force")?.factor("thickness")?;
//! assert!(thickness.share_total.is_some_and(|percent| percent > 90.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Programs to begin with
//!
//! Each is a short program of its own in the folder `examples` of the sources, run by the tests:
//! `cargo run --release --example NAME`.
//!
//! | example | what it shows |
//! |---|---|
//! | `function_model` | a Rust function as a model |
//! | `pendulum` | the same in few lines |
//! | `study_file` | a study file run from Rust, with progress |
//! | `units_and_failures` | units, several outputs, runs without an answer, second-order indices |
//! | `interrupted` | a journal: interrupted, gone on with to the same bits, and made longer |
//! | `own_program` | a program in any language as a model, asked from Rust (`CommandModel`) |
//! | `three_steps` | points to a file, outputs from anywhere, analysed (`exchange`) |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod analysis;
mod binary;
pub mod clock;
pub mod design;
pub mod estimate;
pub mod files;
pub mod given;
pub mod model;
pub mod names;
pub mod quantity;
pub mod result;
pub mod run;
mod runner;
pub mod salib;
pub mod screening;
pub mod space;
pub mod special;
pub mod study;
pub mod sum;
pub mod surrogate;
pub mod sweep;
pub mod text;
pub mod uncertainty;

pub use design::{Design, DesignError, DesignSettings, Rows, Sampler, SobolSequence};
pub use estimate::{CentralMoments, Estimator, FirstOrder, Scaling, ShapleyMethod, ShapleyPlayers, Total, Undefined};
pub use model::{
    Batch, Counter, CounterKind, ExactIndices, Expression, ExpressionError, ExpressionModel, Flag, FunctionModel,
    GiveUp, KnownAnswer, KnownFunction, Messages, Model, Output, OutputSeries, RepeatedModel, RowFailure, RunContext,
    SeriesAxis, SeriesError, Worker, function_model,
};
pub use quantity::{Domain, Quantity, Unit, UnitError, Unlikely};
pub use result::{LookupError, OutputResult, StudyResult, Warning};
pub use run::{FailurePolicy, Progress, RemoteWorkers, Requests, RunError, Shard, ShardError};
pub use runner::{Resume, Runner, WorkerStudy};
pub use space::{CorrelationMeasure, Dependence, DependenceError, Distribution, DistributionError, Factor, Space};
pub use study::{AnalysisOptions, BuildError, Study, StudyBuilder, SurrogateChoice, Target};
pub use uncertainty::{DependentEstimates, EffectEstimates, Estimate, Interval, IntervalMethod};
