//! Verdicts from where the parts of a claim hold, and the numbers in them.

use apportion::uncertainty::Interval;
use apportion_report::fixed;
use apportion_report::format::{self, minus, printed};

use super::verdict::Verdict;
use crate::reproduce::words::{Words, named_together};

/// The share of a box where a rule holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Share {
    pub value: f64,
    /// Its interval at the common level; `None` if the error is unknown.
    pub interval: Option<Interval>,
}

impl Share {
    /// Formats it as in `83.2 % [82.9, 83.5] of the box`; `all of the box` only if no point failed.
    pub fn words_of(&self, region: &str) -> String {
        match (self.value, self.interval) {
            (1.0, _) => format!("all of {region}"),
            (0.0, _) => format!("none of {region}"),
            (value, Some(i)) if i.high > i.low => {
                format!("{} % [{}, {}] of {region}", percent_of(value), percent_of(i.low), percent_of(i.high))
            }
            (value, _) => format!("{} % of {region}", percent_of(value)),
        }
    }
}

/// One part of a claim: whether it holds at the nominal scene, and on what share of the box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ClaimPart {
    /// The part, such as a friction model.
    pub what: String,
    pub nominal: bool,
    pub share: Share,
}

/// The verdict on a claim with its details; see [`Claim`](super::Claim).
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Answer {
    pub verdict: Verdict,
    pub range: String,
    pub words: Words,
}

impl Answer {
    /// Creates the verdict on a claim: reproduced if every part holds at the nominal scene, which is that of the papers'
    /// figures. With it comes the part of the box where it holds.
    pub fn judged(parts: &[ClaimPart], words: impl Into<Words>) -> Self {
        let verdict = Verdict::reproduced_if(parts.iter().all(|part| part.nominal));
        Self { verdict, range: over_ranges(parts), words: words.into() }
    }
}

/// Says on what share of the ranges each part holds, in one line; parts with the same share are named together.
pub(super) fn over_ranges(parts: &[ClaimPart]) -> String {
    let shares =
        named_together(parts.iter().map(|ClaimPart { what, share, .. }| (share.words_of("the box"), what.as_str())));
    match &shares[..] {
        [(words, _)] => words.clone(),
        _ => {
            shares.iter().map(|(words, parts)| format!("{}: {words}", parts.join(", "))).collect::<Vec<_>>().join("; ")
        }
    }
}

/// Formats an SI value in nano-units, with the unit: `631 nN`.
pub(super) fn nano(value: f64, unit: &str) -> String {
    number(value * 1e9, &format!("n{unit}"))
}

/// Formats a plain number to three significant digits (the scene's constants justify no more), with its unit if any; a tiny one to two as a power of ten.
pub(super) fn number(value: f64, unit: &str) -> String {
    const TINY: f64 = 1e-4;
    let is_tiny = value != 0.0 && value.abs() < TINY;
    let text = if is_tiny { minus(&format!("{value:.1e}")) } else { printed(value) };
    format!("{text} {}", format::unit(unit)).trim_end().to_owned()
}

/// Formats a share in percent without the sign, to one decimal; two if it is close to 0 or 100 but neither.
pub(super) fn percent_of(share: f64) -> String {
    let close = share > 0.0 && share < 1.0 && !(0.01..=0.99).contains(&share);
    let text = fixed(100.0 * share, if close { 2 } else { 1 });
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Formats a relative change in percent, `1.9 %`; as a power of ten if it is too small.
pub(super) fn change(relative: f64) -> String {
    let percent = 100.0 * relative;
    if percent != 0.0 && percent.abs() < 1e-3 {
        minus(&format!("{percent:.0e} %"))
    } else {
        format!("{} %", printed(percent))
    }
}

#[cfg(test)]
#[path = "tests/judge.rs"]
mod tests;
