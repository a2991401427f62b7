//! From what holds where to a verdict, and to words.

use super::Verdict;
use super::numbers::percent_of;
use apportion::uncertainty::Interval;

/// From this share of the box on a rule holds everywhere: what is left is a corner that no chart of the papers shows.
const EVERYWHERE: f64 = 0.999;

/// Up to this share of the box a rule holds nowhere.
const NOWHERE: f64 = 1.0 - EVERYWHERE;

/// The share of a box where a rule holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Share {
    pub value: f64,
    /// At the level of every interval; `None` where nothing is known of the error.
    pub interval: Option<Interval>,
    /// Points asked.
    pub points: u64,
}

impl Share {
    pub fn everywhere(&self) -> bool {
        self.value >= EVERYWHERE
    }

    pub fn nowhere(&self) -> bool {
        self.value <= NOWHERE
    }

    /// As in `83.2 % [82.9, 83.5] of the box`; `all of the box` only where no point failed.
    pub fn words(&self) -> String {
        self.words_of("the box")
    }

    /// The same of something else than `the box`.
    pub fn words_of(&self, whole: &str) -> String {
        match (self.value, self.interval) {
            (1.0, _) => format!("all of {whole} ({} points)", self.points),
            (0.0, _) => format!("none of {whole} ({} points)", self.points),
            (value, Some(i)) if i.high > i.low => {
                format!("{} % [{}, {}] of {whole}", percent_of(value), percent_of(i.low), percent_of(i.high))
            }
            (value, _) => format!("{} % of {whole}", percent_of(value)),
        }
    }
}

/// One part of a claim: whether it holds at the nominal scene, and on how much of the box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Holding {
    /// What part, such as a friction model.
    pub what: String,
    pub nominal: bool,
    pub share: Share,
}

impl Holding {
    fn fully(&self) -> bool {
        self.nominal && self.share.everywhere()
    }

    /// As in `Hurtado-Kim at the nominal scene and on 83.2 % [82.9, 83.5] of the box`.
    fn words(&self) -> String {
        let Self { what, nominal, share } = self;
        match (nominal, share.nowhere()) {
            (true, _) if share.everywhere() => format!("{what} everywhere"),
            (true, _) => format!("{what} at the nominal scene and on {}", share.words()),
            (false, true) => format!("{what} nowhere"),
            (false, false) => format!("{what} not at the nominal scene, on {}", share.words()),
        }
    }
}

/// The verdict on a claim whose parts hold as given: all of them at the nominal scene and everywhere in the box, none of
/// them anywhere, or something between.
pub(super) fn judge(holdings: &[Holding]) -> Verdict {
    if holdings.iter().all(Holding::fully) {
        Verdict::Reproduced
    } else if holdings.iter().all(|holding| !holding.nominal && holding.share.nowhere()) {
        Verdict::NotReproduced
    } else {
        Verdict::Partly { range: in_words(holdings) }
    }
}

/// The verdict on a claim about the nominal scene alone.
pub(super) fn judge_at_nominal(holdings: &[Holding]) -> Verdict {
    match holdings.iter().filter(|holding| holding.nominal).count() {
        0 => Verdict::NotReproduced,
        n if n == holdings.len() => Verdict::Reproduced,
        _ => Verdict::Partly { range: in_words(holdings) },
    }
}

/// Where each part holds, in one line.
pub(super) fn in_words(holdings: &[Holding]) -> String {
    holdings.iter().map(Holding::words).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holding(nominal: bool, value: f64) -> Holding {
        let interval = Some(Interval { low: value - 0.001, high: value + 0.001 });
        Holding { what: "Coulomb".into(), nominal, share: Share { value, interval, points: 1024 } }
    }

    #[test]
    fn a_claim_holds_everywhere_or_in_part_or_nowhere() {
        assert_eq!(judge(&[holding(true, 1.0), holding(true, 0.9995)]), Verdict::Reproduced);
        assert_eq!(judge(&[holding(false, 0.0), holding(false, 0.0005)]), Verdict::NotReproduced);
        let Verdict::Partly { range } = judge(&[holding(true, 1.0), holding(true, 0.5)]) else { panic!() };
        assert_eq!(range, "Coulomb everywhere; Coulomb at the nominal scene and on 50 % [49.9, 50.1] of the box");
        let Verdict::Partly { range } = judge(&[holding(false, 0.2), holding(false, 0.0)]) else { panic!() };
        assert!(range.starts_with("Coulomb not at the nominal scene, on 20 %") && range.ends_with("Coulomb nowhere"));
        // Everywhere in the box but not at the nominal scene is no reproduction of a chart drawn there.
        assert!(matches!(judge(&[holding(false, 1.0)]), Verdict::Partly { .. }));
    }
}
