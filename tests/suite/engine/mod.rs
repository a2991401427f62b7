//! Designs, estimators, surrogates, intervals: numbers against exact answers, and the same bits.

pub mod accuracy;
mod analytic;
mod builder;
mod degenerate;
pub mod dependent;
mod distributions;
mod estimators;
mod factor_kinds;
mod frozen;
mod indices_of_groups;
mod intervals;
mod many_outputs;
mod metamorphic;
mod noise;
mod plain_rows;
pub mod points;
mod rare_levels;
mod remote_workers;
mod series;
mod shapley;
mod small_budgets;
mod surrogate;
mod unseen;
