//! Comparison of our order of the factors with the published one, as far as our intervals decide it.

use apportion::Estimate;
use apportion::uncertainty::Interval;

use super::papers::published;
use super::shares::indices;
use super::studies::Reproduced;

/// Share in percent from which on a factor counts: less would be printed as 0 in whole percents, as in LG, and is
/// hardly visible as a bar.
pub(super) const VISIBLE: f64 = 0.5;

/// A factor with its share in percent.
type FactorShare<'a> = (&'a str, Estimate);

/// Returns the interval of a share; the full range if its error is unknown.
fn bounds(share: Estimate) -> Interval {
    share.interval.unwrap_or(Interval { low: f64::NEG_INFINITY, high: f64::INFINITY })
}

/// Returns whether no share in the interval would be visible.
fn is_unseen(share: Estimate) -> bool {
    bounds(share).high < VISIBLE
}

/// What our shares say of an order of two factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OrderCheck {
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
fn check_order(first: Estimate, second: Estimate) -> OrderCheck {
    if is_unseen(first) && is_unseen(second) {
        return OrderCheck::Unseen;
    }
    let (one, other) = (bounds(first), bounds(second));
    if one.low > other.high && one.low >= VISIBLE {
        OrderCheck::Kept
    } else if other.low > one.high && other.low >= VISIBLE {
        OrderCheck::Broken
    } else {
        OrderCheck::Undecided
    }
}

/// The comparison of our order with a published one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OrderVerdict<'a> {
    /// Our factors that may have a visible share, the largest share first.
    pub ours: Vec<&'a str>,
    /// Each neighbouring pair of the published order.
    pub pairs: Vec<(&'a str, &'a str, OrderCheck)>,
    /// Factors with a visible share that are not in the published order.
    pub intruders: Vec<&'a str>,
    /// Published factors without a visible share of ours.
    pub unseen: Vec<&'a str>,
}

/// Compares the shares with the published order, whose factors are among them.
fn order_verdict<'a>(mut shares: Vec<FactorShare<'a>>, published: &[&str]) -> OrderVerdict<'a> {
    shares.sort_by(|(_, a), (_, b)| b.estimate.total_cmp(&a.estimate));
    let ranked = published.iter().filter_map(|name| shares.iter().find(|(factor, _)| factor == name));
    let ranked: Vec<FactorShare<'a>> = ranked.copied().collect();
    let visible = shares.iter().filter(|(_, share)| bounds(*share).low >= VISIBLE).map(|(factor, _)| *factor);
    OrderVerdict {
        ours: shares.iter().filter(|(_, share)| !is_unseen(*share)).map(|(factor, _)| *factor).collect(),
        pairs: ranked.windows(2).map(|pair| (pair[0].0, pair[1].0, check_order(pair[0].1, pair[1].1))).collect(),
        intruders: visible.filter(|factor| !published.contains(factor)).collect(),
        unseen: ranked.iter().filter(|(_, share)| is_unseen(*share)).map(|(factor, _)| *factor).collect(),
    }
}

impl OrderVerdict<'_> {
    /// Returns whether every factor is before the next, up to a rest without visible shares if `allows_unseen`, and no
    /// other factor has a visible share.
    pub fn is_kept(&self, allows_unseen: bool) -> bool {
        let mut checks = self.pairs.iter().map(|(.., check)| *check);
        self.intruders.is_empty()
            && checks.all(|check| check == OrderCheck::Kept || allows_unseen && check == OrderCheck::Unseen)
    }

    /// Lists the pairs with this standing, as in `length before width`.
    pub fn pairs_that_are(&self, wanted: OrderCheck) -> Vec<String> {
        let pairs = self.pairs.iter().filter(|(.., check)| *check == wanted);
        pairs.map(|(one, other, _)| format!("{one} before {other}")).collect()
    }
}

/// Compares the order of a study's factors by total shares with the published one.
pub(super) fn order_of(member: &Reproduced) -> OrderVerdict<'_> {
    let shares = indices(member).iter().filter_map(|index| Some((&*index.name, index.effect.total_percent()?)));
    order_verdict(shares.collect(), published(member.group.key, member.friction.key).ranking)
}

/// Returns the total indices of the dimensional and the environmental factors of a general study, and whether the first
/// one is larger; `None` without groups.
pub(super) fn outweighing(member: &Reproduced) -> Option<(Estimate, Estimate, OrderCheck)> {
    let groups = member.result.outputs.first()?.groups.as_ref()?;
    let [dimensional, environmental] = ["dimensional", "environmental"]
        .map(|name| groups.iter().find(|group| group.name == name).map(|group| group.effect.total));
    let (dimensional, environmental) = (dimensional?, environmental?);
    Some((dimensional, environmental, check_order(in_percent(dimensional), in_percent(environmental))))
}

fn in_percent(index: Estimate) -> Estimate {
    Estimate {
        estimate: 100.0 * index.estimate,
        interval: index.interval.map(|i| Interval { low: 100.0 * i.low, high: 100.0 * i.high }),
    }
}
