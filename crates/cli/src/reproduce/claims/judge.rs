//! Verdicts from where the parts of a claim hold.

use apportion::uncertainty::Interval;

use super::Verdict;
use super::numbers::percent_of;
use crate::reproduce::named_together;
use crate::reproduce::papers::Words;

/// The share of a box where a rule holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Share {
    pub value: f64,
    /// Its interval at the common level; `None` if the error is unknown.
    pub interval: Option<Interval>,
}

impl Share {
    /// Formats it as in `83.2 % [82.9, 83.5] of the box`; `all of the box` only if no point failed.
    pub fn words_of(&self, whole: &str) -> String {
        match (self.value, self.interval) {
            (1.0, _) => format!("all of {whole}"),
            (0.0, _) => format!("none of {whole}"),
            (value, Some(i)) if i.high > i.low => {
                format!("{} % [{}, {}] of {whole}", percent_of(value), percent_of(i.low), percent_of(i.high))
            }
            (value, _) => format!("{} % of {whole}", percent_of(value)),
        }
    }
}

/// One part of a claim: whether it holds at the nominal scene, and on what share of the box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Holding {
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
    /// Creates the verdict on a claim decided at the scene of the paper, with the part of the box where it holds.
    pub fn judged(holdings: &[Holding], words: impl Into<Words>) -> Self {
        Self { verdict: judge(holdings), range: over_ranges(holdings), words: words.into() }
    }
}

/// Returns the verdict on a claim as in its paper: reproduced if every part holds at the nominal scene, which is that
/// of the papers' figures.
pub(super) fn judge(holdings: &[Holding]) -> Verdict {
    Verdict::reproduced_if(holdings.iter().all(|holding| holding.nominal))
}

/// Says on what share of the whole ranges each part holds, in one line; parts with the same share are named together.
pub(super) fn over_ranges(holdings: &[Holding]) -> String {
    let shares =
        named_together(holdings.iter().map(|Holding { what, share, .. }| (share.words_of("the box"), what.as_str())));
    match &shares[..] {
        [(words, _)] => words.clone(),
        _ => {
            shares.iter().map(|(words, parts)| format!("{}: {words}", parts.join(", "))).collect::<Vec<_>>().join("; ")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holding(what: &str, nominal: bool, value: f64) -> Holding {
        let interval = Some(Interval { low: value - 0.001, high: value + 0.001 });
        Holding { what: what.into(), nominal, share: Share { value, interval } }
    }

    #[test]
    fn verdicts_use_the_scene_of_the_paper_and_ranges_the_box() {
        let holdings = [holding("Coulomb", true, 1.0), holding("LuGre", true, 0.5)];
        assert_eq!(judge(&holdings), Verdict::Reproduced);
        assert_eq!(over_ranges(&holdings), "Coulomb: all of the box; LuGre: 50 % [49.9, 50.1] of the box");
        // Everywhere in the box but not at the nominal scene does not reproduce a chart drawn there.
        assert_eq!(judge(&[holding("Coulomb", false, 1.0)]), Verdict::NotReproduced);
    }
}
