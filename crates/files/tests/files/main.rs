//! What this crate reads and writes, by its public names; whole studies, and the messages on them, are tests of the program
//! (`tests/suite`).

mod answers;
mod overrides;
mod picks;
mod rows;
