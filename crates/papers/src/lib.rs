//! The papers on pushed nanoparticles: their figures and claims reproduced, and scenes in time.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod reproduce;
pub mod scene;
