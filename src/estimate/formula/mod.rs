//! The estimators' formulas on the sums of one swap, one file per family.
//!
//! In all of them n is the number of base points, sums run over the base points, m_A is the mean of y_A and so on, f0
//! the mean of y_A and y_B pooled, and V their pooled variance with the divisor 2n. AB is A with the columns of the
//! swap from B. Each formula is the published one in exact arithmetic; it is computed from centred sums.

pub mod correlation;
pub mod difference;
pub mod double;
pub mod product;
