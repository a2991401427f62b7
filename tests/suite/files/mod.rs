//! Studies, tables, programs, journals: what is read, kept, refused.

mod changed_programs;
mod command;
mod corpus;
mod dependent_factors;
mod endless_files;
mod exchange;
mod expression;
mod factors;
mod first_attempts;
pub mod fuzz;
mod journal;
mod names;
mod nothing_is_lost;
mod nothing_is_overwritten;
mod series_files;
mod signals;
mod units;
