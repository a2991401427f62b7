//! Untrusted input of the program, as targets of fuzzing: each accepts any bytes and must end, without a panic, and
//! have its properties. The fuzzers in `fuzz/` and the tests in `corpus.rs` run the same targets.

mod answers;
mod expression;
mod journal;
mod mutation;
mod result;
mod rows;
mod study;
mod tables;

pub use mutation::{Dictionary, Random, mutated, mutated_bytes};

/// One input of the program.
pub struct Target {
    /// Its name: that of its fuzzer, and of its folder in `fuzz/corpus`.
    pub name: &'static str,
    /// Processes the bytes as the program would.
    pub run: fn(&[u8]),
    /// The words of its language, in the format of libFuzzer.
    pub dictionary: &'static str,
}

/// All targets.
pub const TARGETS: [Target; 7] = [
    Target { name: "answers", run: answers::run, dictionary: include_str!("answers.dict") },
    Target { name: "expression", run: expression::run, dictionary: include_str!("expression.dict") },
    Target { name: "journal", run: journal::run, dictionary: "" },
    Target { name: "result", run: result::run, dictionary: include_str!("result.dict") },
    Target { name: "rows", run: rows::run, dictionary: include_str!("rows.dict") },
    Target { name: "study", run: study::run, dictionary: include_str!("study.dict") },
    Target { name: "tables", run: tables::run, dictionary: include_str!("tables.dict") },
];

/// The target of that name.
pub fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|target| target.name == name).unwrap_or_else(|| panic!("no target is called {name}"))
}
