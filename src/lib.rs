//! Sobol' global sensitivity analysis: which input of a model decides its output, and by how many percent.
//!
//! The flagship model answers a question of nanotechnology: of the cantilever's dimensions and the environment, which
//! factor decides the force that the tip of an atomic force microscope needs to push a nanoparticle, under each
//! friction model? The engine knows nothing of that model and serves any other.
//!
//! # The map
//!
//! The modules in the order of the data's way; each uses only those above it. [`Study::run`](study::Study::run) is the
//! whole way in one call, and [`Runner`] the same with threads, progress and a journal.
//!
//! | module | what it is for |
//! |---|---|
//! | [`files`] | files read whole, but never without end |
//! | [`sum`] | sums of fixed shape: the same bits on any number of threads |
//! | [`quantity`] | units, known at the edges only; inside everything is SI |
//! | [`space`] | factors: names, distributions, units, nominal values, groups |
//! | [`design`] | the Saltelli design as a pure function of the row number; Sobol', random and Latin hypercube points |
//! | [`afm`] | the physics of pushing a nanoparticle: plain functions, no knowledge of the engine |
//! | [`model`] | what can be studied: a shared description that lends out workers, one per thread |
//! | [`estimate`] | centred sums of constant size, and the indices read from them |
//! | [`run`] | the executor: rows from a source, through workers, to a sink; sums merged in a fixed tree; the journal |
//! | [`uncertainty`] | intervals from few nets, replicates or batches; ranks and convergence |
//! | [`given`] | first-order indices from a table that exists already |
//! | [`screening`] | elementary effects: which of many factors matter, for a few runs each |
//! | [`study`] | studies: the file as typed, and what it means |
//! | [`sweep`] | one factor at a time over its range, and the slopes at the nominal point |
//! | [`report`] | results as JSON, CSV, text and charts; files written whole or not at all |
//! | [`exchange`] | tables of points and outputs, for other programs |
//! | [`salib`] | indices of outputs at the points of SALib, by its own formulas |
//!
//! # Features
//!
//! Without default features the crate is the engine, the physics of the nanoparticle and the known functions. `study` adds
//! study files, programs as models and [`exchange`]; `parquet` its tables in Parquet; `charts` adds [`report`]: results as
//! JSON, text, CSV and SVG; `png` its charts as pictures; `page` its pages and folders of files. `cli`, the default, is the
//! program with all of them.
//!
//! # An example
//!
//! The force on cantilevers of uncertain thickness and length:
//!
//! ```
//! use apportion::study::Study;
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
//! let study = Study::parse(text, "example.toml".as_ref(), &[])?;
//! let analysis = study.run()?;
//! let thickness = analysis.output("critical_force")?.factor("thickness")?;
//! assert!(thickness.share_total.is_some_and(|percent| percent.estimate > 90.0));
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
//! | `units_and_failures` | units, several outputs, runs without an answer, second-order indices |
//! | `interrupted` | a [`journal`](run::journal): interrupted, gone on with to the same bits, and made longer |
//! | `own_program` | a program in any language as a model, asked from Rust ([`CommandModel`](model::CommandModel)) |
//! | `three_steps` | points to a file, outputs from anywhere, analysed ([`exchange`]) |

pub mod afm;
mod analysis;
mod binary;
#[cfg(feature = "study")]
mod csv_text;
pub mod design;
pub mod estimate;
#[cfg(feature = "study")]
pub mod exchange;
pub mod files;
pub mod given;
pub mod model;
mod names;
pub mod quantity;
#[cfg(feature = "charts")]
pub mod report;
pub mod run;
mod runner;
#[cfg(feature = "study")]
pub mod salib;
pub mod screening;
pub mod space;
pub mod study;
pub mod sum;
pub mod sweep;
pub mod uncertainty;
#[cfg(feature = "study")]
mod words;

pub use analysis::{
    Aggregate, Analysis, FailureCount, LookupError, MixedModels, NoIndices, OutputAnalysis, StopReason, Stopped,
};
pub use runner::{Resume, Runner};
