//! Comparison of our order of the factors with the published one, as far as our intervals decide it.

use apportion::Estimate;
use apportion::result::IndexRecord;
use apportion::uncertainty::Interval;

use super::shares::indices;
use super::{Reproduced, published};

/// Share in percent from which on a factor counts: less would be printed as 0 in whole percents, as in LG, and is
/// hardly visible as a bar.
pub(super) const VISIBLE: f64 = 0.5;

/// A factor with its share in percent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FactorShare<'a> {
    pub factor: &'a str,
    pub share: Estimate,
}

/// Returns the interval of a share; the whole range if its error is unknown.
fn bounds(share: Estimate) -> Interval {
    share.interval.unwrap_or(Interval { low: f64::NEG_INFINITY, high: f64::INFINITY })
}

/// Returns whether no share in the interval would be visible.
fn unseen(share: Estimate) -> bool {
    bounds(share).high < VISIBLE
}

/// What our shares say of an order of two factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Standing {
    /// Confirmed: the intervals do not overlap.
    Kept,
    /// Reversed: the intervals do not overlap either.
    Broken,
    /// The intervals overlap, or do not decide whether a share is visible.
    Undecided,
    /// Neither share is visible.
    Unseen,
}

/// Compares our shares with the order of `first` before `second`.
pub(super) fn standing(first: Estimate, second: Estimate) -> Standing {
    if unseen(first) && unseen(second) {
        return Standing::Unseen;
    }
    let (one, other) = (bounds(first), bounds(second));
    if one.low > other.high && one.low >= VISIBLE {
        Standing::Kept
    } else if other.low > one.high && other.low >= VISIBLE {
        Standing::Broken
    } else {
        Standing::Undecided
    }
}

/// The agreement of our order with the published one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Agreement {
    /// Every factor is before the next.
    Same,
    /// Every factor is before the next, up to a rest without visible shares.
    Beginning,
    /// Not decided by this sample: no pair is reversed, but some intervals overlap.
    Undecided,
    /// Some pair is reversed, or a factor that is not in the published order has a visible share.
    Other,
}

/// The comparison of our order with a published one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OrderVerdict<'a> {
    /// Our factors that may have a visible share, the largest share first.
    pub ours: Vec<&'a str>,
    /// Each neighbouring pair of the published order.
    pub pairs: Vec<(&'a str, &'a str, Standing)>,
    /// Factors with a visible share that are not in the published order.
    pub intruders: Vec<&'a str>,
    /// Published factors without a visible share of ours.
    pub unseen: Vec<&'a str>,
}

/// Compares the shares with the published order, whose factors are among them.
pub(super) fn order_verdict<'a>(shares: &[FactorShare<'a>], published: &[&str]) -> OrderVerdict<'a> {
    let mut ranked: Vec<&FactorShare<'a>> = shares.iter().filter(|one| !unseen(one.share)).collect();
    ranked.sort_by(|a, b| b.share.estimate.total_cmp(&a.share.estimate));
    let known: Vec<&FactorShare<'a>> =
        published.iter().filter_map(|name| shares.iter().find(|share| share.factor == *name)).collect();
    let pair = |pair: &[&FactorShare<'a>]| (pair[0].factor, pair[1].factor, standing(pair[0].share, pair[1].share));
    let stranger = |one: &&&FactorShare<'a>| bounds(one.share).low >= VISIBLE && !published.contains(&one.factor);
    OrderVerdict {
        ours: ranked.iter().map(|share| share.factor).collect(),
        pairs: known.windows(2).map(pair).collect(),
        intruders: ranked.iter().filter(stranger).map(|share| share.factor).collect(),
        unseen: known.iter().filter(|one| unseen(one.share)).map(|share| share.factor).collect(),
    }
}

impl<'a> OrderVerdict<'a> {
    pub fn agreement(&self) -> Agreement {
        let any = |wanted: Standing| self.pairs.iter().any(|(.., standing)| *standing == wanted);
        if any(Standing::Broken) || !self.intruders.is_empty() {
            Agreement::Other
        } else if any(Standing::Undecided) {
            Agreement::Undecided
        } else if any(Standing::Unseen) {
            Agreement::Beginning
        } else {
            Agreement::Same
        }
    }

    /// Returns the pairs with this standing, as in `length and width`.
    pub fn pairs_that_are(&self, wanted: Standing) -> Vec<(&'a str, &'a str)> {
        self.pairs.iter().filter(|(.., standing)| *standing == wanted).map(|&(one, other, _)| (one, other)).collect()
    }
}

/// Compares the order of a study's factors by total shares with the published one.
pub(super) fn order_of<'a>(member: &'a Reproduced) -> OrderVerdict<'a> {
    let share =
        |index: &'a IndexRecord| Some(FactorShare { factor: &index.factor, share: index.effect.total_percent()? });
    let shares: Vec<FactorShare<'a>> = indices(member).iter().filter_map(share).collect();
    order_verdict(&shares, published(member.group.key, member.friction.key).ranking)
}

/// Returns the total indices of the dimensional and the environmental factors of a general study, and whether the first
/// one is larger; `None` without groups.
pub(super) fn outweighing(member: &Reproduced) -> Option<(Estimate, Estimate, Standing)> {
    let groups = member.result.outputs.first()?.groups.as_ref()?;
    let total = |name: &str| groups.iter().find(|group| group.group == name).map(|group| group.effect.total);
    let (dimensional, environmental) = (total("dimensional")?, total("environmental")?);
    let percent = |index: Estimate| Estimate {
        estimate: 100.0 * index.estimate,
        interval: index.interval.map(|i| Interval { low: 100.0 * i.low, high: 100.0 * i.high }),
    };
    Some((dimensional, environmental, standing(percent(dimensional), percent(environmental))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(factor: &str, share: f64, half_width: f64) -> FactorShare<'_> {
        let interval = Some(Interval { low: share - half_width, high: share + half_width });
        FactorShare { factor, share: Estimate { estimate: share, interval } }
    }

    const PUBLISHED: [&str; 4] = ["thickness", "length", "width", "height"];

    fn agreement(shares: &[FactorShare<'_>]) -> Agreement {
        order_verdict(shares, &PUBLISHED).agreement()
    }

    #[test]
    fn an_order_holds_if_neighbours_differ() {
        let shares = [share("length", 34.0, 1.0), share("width", 19.0, 1.0), share("thickness", 47.0, 1.0)];
        let with = |height| [&shares[..], &[height]].concat();
        assert_eq!(agreement(&with(share("height", 3.0, 1.0))), Agreement::Same);
        assert_eq!(agreement(&with(share("height", 0.0, 0.0))), Agreement::Same, "nothing is less than something");
        assert_eq!(agreement(&with(share("height", 25.0, 1.0))), Agreement::Other);
        let verdict = order_verdict(&with(share("height", 0.0, 0.0)), &PUBLISHED);
        assert_eq!((verdict.ours, verdict.unseen), (vec!["thickness", "length", "width"], vec!["height"]));
    }

    /// With few points the intervals of length and thickness overlap: that decides nothing.
    #[test]
    fn overlapping_neighbours_are_undecided() {
        let shares = [
            share("length", 42.3, 3.9),
            share("width", 17.5, 3.4),
            share("thickness", 38.4, 3.9),
            share("height", 0.0, 0.0),
        ];
        let verdict = order_verdict(&shares, &PUBLISHED);
        assert_eq!(verdict.agreement(), Agreement::Undecided);
        assert_eq!(verdict.pairs_that_are(Standing::Undecided), [("thickness", "length")]);
        let unknown = shares.map(|one| FactorShare { share: Estimate { interval: None, ..one.share }, ..one });
        assert_eq!(agreement(&unknown), Agreement::Undecided);
    }

    #[test]
    fn invisible_shares_have_no_order_and_unpublished_ones_must_be_invisible() {
        let tail = [share("thickness", 99.0, 0.5), share("length", 0.1, 0.01), share("width", 0.3, 0.01)];
        let verdict = order_verdict(&tail, &PUBLISHED[..3]);
        assert_eq!((verdict.agreement(), verdict.unseen), (Agreement::Beginning, vec!["length", "width"]));
        let stranger = [share("thickness", 60.0, 1.0), share("length", 10.0, 1.0), share("velocity", 30.0, 1.0)];
        assert_eq!(order_verdict(&stranger, &PUBLISHED[..2]).agreement(), Agreement::Other);
        let faint = [share("thickness", 60.0, 1.0), share("length", 39.0, 1.0), share("velocity", 1.0, 0.8)];
        assert_eq!(order_verdict(&faint, &PUBLISHED[..2]).agreement(), Agreement::Same);
        // It is unknown whether a share is visible.
        assert_eq!(standing(share("a", 0.0, 0.0).share, share("b", 0.5, 0.2).share), Standing::Undecided);
    }
}
