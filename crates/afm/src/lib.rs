//! Physics of pushing a nanoparticle with an atomic force microscope (AFM).
//!
//! A tip on a cantilever is lowered onto a particle lying on a substrate. The substrate moves sideways, the particle
//! drags the tip along, and when the friction under the particle cannot hold it any more, it slips. The tip force at
//! that instant is the *critical force*.
//!
//! The modules, in the order of the computation:
//!
//! - [`scene`]: [`Scene`], every constant of the problem in SI; [`parameter`]: the same constants
//!   as a table with symbols, units and physical domains;
//! - [`probe`]: stiffnesses and preload of the cantilever;
//! - [`contact`]: contact radius, indentation and pull-off force of a sphere under a load, one
//!   theory per file;
//! - [`friction`]: the largest lateral force the substrate contact can hold, one law per file;
//! - [`modes`]: other motions of the particle: slip at the tip, roll, spin;
//! - [`force`]: the critical force, one fidelity per file; start with [`critical_force`];
//! - [`history`]: one scene in time, through sticking and slipping;
//! - [`ode`]: initial value problems with events, for the laws and rungs that march in time;
//! - [`flags`]: what makes a result doubtful; [`failure`]: why there is no result.
//!
//! These are plain functions on plain structs, all quantities in SI, and independent of sampling and sensitivity
//! analysis. [`model`] adapts them to a model for [`apportion`], and [`AfmSubject`] to the subject of a study.
//!
//! The papers behind the formulas, cited by author and year at each formula: Tafazzoli & Sitti 2004 (dynamics of
//! particle sliding) and the two Sobol' studies of the critical force, of the Coulomb and Hurtado-Kim models and of the
//! LuGre model. Where their printed equations disagree, the docstring says which version is used.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod cube_root;
mod root;
mod subject;

pub mod contact;
pub mod failure;
pub mod flags;
pub mod force;
pub mod friction;
pub mod history;
pub mod model;
pub mod modes;
pub mod ode;
pub mod parameter;
pub mod probe;
pub mod scene;

pub use contact::ContactTheory;
pub use failure::Failure;
pub use flags::{Flag, Flags};
pub use force::{Critical, Fidelity, Options, critical_force};
pub use friction::{FrictionLaw, LuGreParameters};
pub use model::{AfmHistory, AfmModel, AfmMoments, AfmOutput, afm_choices, afm_inputs, afm_outputs, edge_unit};
pub use parameter::Parameter;
pub use probe::Torsion;
pub use scene::Scene;
pub use subject::AfmSubject;
