//! What the crates of `apportion` share: sums, special functions, names, text, physical quantities, digests.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod clock;
pub mod digest;
pub mod files;
pub mod names;
pub mod quantity;
pub mod special;
pub mod sum;
pub mod text;
