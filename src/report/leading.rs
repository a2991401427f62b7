//! Sentences about who leads: they follow the intervals, name no winner of a tie, and state no share that none can be.

use super::format::{count, index, name};
use super::listed;
use super::result::{EstimateRecord, IndexRecord, OutputRecord, PairRecord};
use crate::special::normal_quantile;
use crate::uncertainty::LEVEL;

/// From this probability on a lead is taken for one.
pub(super) const SURE: f64 = 0.95;
/// Most names in a sentence.
const NAMES: usize = 6;

/// One that may lead.
#[derive(Debug, Clone)]
pub(super) struct Contender {
    /// Its name as it stands in a sentence.
    pub label: String,
    /// First-order index, where there is one.
    pub first_order: Option<EstimateRecord>,
    /// What decides: the total index, or another measure.
    pub total: EstimateRecord,
    /// Probability that it is the largest, where it is known.
    pub probability: Option<f64>,
}

impl Contender {
    /// A factor by its indices.
    pub fn of(index: &IndexRecord) -> Self {
        Self {
            label: name(&index.factor),
            first_order: Some(index.effect.first_order),
            total: index.effect.weight(),
            probability: index.effect.probability_first,
        }
    }

    /// Whether anything is known of its error.
    pub fn has_error(&self) -> bool {
        self.probability.is_some() || self.total.low.is_some()
    }
}

/// The indices of an output with their places in the study, the largest total index first; `None` without any.
pub(super) fn by_total(output: &OutputRecord) -> Option<Vec<(usize, &IndexRecord)>> {
    let mut order: Vec<(usize, &IndexRecord)> = output.indices.as_ref()?.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.effect.weight().estimate.total_cmp(&a.1.effect.weight().estimate));
    (!order.is_empty()).then_some(order)
}

/// The numbers of those that may be the largest, the largest estimate first: one where it is sure to be (or where nothing
/// is known of the errors), all that cannot be told apart otherwise.
///
/// Those are, where probabilities are known, the largest and every one with a chance of 1 in 20 or more; otherwise the
/// largest and every one whose interval reaches its own. Whoever has a larger estimate than one of them is one too.
pub(super) fn may_lead(contenders: &[Contender]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..contenders.len()).collect();
    order.sort_by(|&a, &b| contenders[b].total.estimate.total_cmp(&contenders[a].total.estimate));
    let Some((&lead, rest)) = order.split_first() else { return order };
    let rivals = match (contenders[lead].probability, contenders[lead].total.low) {
        (Some(probability), _) if probability >= SURE => 0,
        (Some(_), _) => {
            let is_likely = |&k: &usize| contenders[k].probability.is_some_and(|chance| chance >= 1.0 - SURE);
            // Unsure, and no other likely: the next one.
            rest.iter().rposition(is_likely).map_or(1, |last| last + 1)
        }
        (None, Some(low)) => {
            let reaches = |&k: &usize| contenders[k].total.high.is_some_and(|high| high >= low);
            rest.iter().rposition(reaches).map_or(0, |last| last + 1)
        }
        (None, None) => 0,
    };
    order.truncate(1 + rivals);
    order
}

/// How many moved the output in any row: factors, and the noise. Plain total indices tell, of which surrogates know none.
pub(super) fn moving(output: &OutputRecord) -> usize {
    let plain = |place: usize| output.surrogate.as_ref()?.plain.get(place)?.total;
    let indices = output.indices.iter().flatten().enumerate();
    let moves = |(place, index): &(usize, &IndexRecord)| plain(*place).unwrap_or(index.effect.total).estimate != 0.0;
    indices.filter(moves).count() + usize::from(output.noise.is_some())
}

/// Which of these interactions are sure to exist, all of them together: of many intervals that each hold in 95 % one in forty would
/// exclude 0 from below by chance, so each is widened by Bonferroni's rule (Dunn 1961), with the quantiles of the normal distribution.
pub(super) fn surely_interact(pairs: &[PairRecord]) -> Vec<bool> {
    let quantile = |number: f64| normal_quantile(1.0 - (1.0 - LEVEL) / (2.0 * number));
    let ratio = quantile(pairs.len().max(1) as f64) / quantile(1.0);
    let is_sure = |EstimateRecord { estimate, low, .. }: EstimateRecord| {
        low.is_some_and(|low| low > 0.0 && estimate - ratio * (estimate - low) > 0.0)
    };
    pairs.iter().map(|pair| is_sure(pair.index)).collect()
}

/// `labels` with what stands behind each in brackets, the last ones counted if they are many.
pub(super) fn names(contenders: &[Contender], which: &[usize], what: &dyn Fn(&Contender) -> String) -> String {
    let mut all: Vec<String> =
        which.iter().take(NAMES).map(|&k| format!("{} ({})", contenders[k].label, what(&contenders[k]))).collect();
    if which.len() > NAMES {
        all.push(format!("{} more", which.len() - NAMES));
    }
    listed(&all)
}

/// The outputs at these places by name: neighbours as a stretch, the first ones of many.
pub(super) fn of_which(outputs: &[&str], places: &[usize]) -> String {
    if places.len() == outputs.len() && places.len() > 2 {
        return format!("all {} outputs", places.len());
    }
    // No stretch goes from one series to the next.
    let series = |name: &str| name.split_once('[').map(|(series, _)| series.to_owned());
    let mut stretches: Vec<(usize, usize)> = Vec::new();
    for &place in places {
        let follows = |last: usize| last + 1 == place && series(outputs[last]) == series(outputs[place]);
        match stretches.last_mut().filter(|(_, last)| follows(*last)) {
            Some((_, last)) => *last = place,
            None => stretches.push((place, place)),
        }
    }
    let of = |place: usize| name(outputs[place]);
    let stretch = |&(first, last): &(usize, usize)| match last - first {
        0 => vec![of(first)],
        1 => vec![of(first), of(last)],
        _ => vec![format!("{} to {}", of(first), of(last))],
    };
    let mut names: Vec<String> = stretches.iter().take(NAMES).flat_map(stretch).collect();
    if stretches.len() > NAMES {
        let more: usize = stretches[NAMES..].iter().map(|(first, last)| last - first + 1).sum();
        names.push(format!("{more} more"));
    }
    match places.len() {
        1 => names.concat(),
        several => format!("{}: {}", count(several as u64, "output", "outputs"), listed(&names)),
    }
}

/// The answers that are given, each with the places of those that have it, in the order of the first time.
pub(super) fn by_answer<T: PartialEq>(answers: impl IntoIterator<Item = T>) -> Vec<(T, Vec<usize>)> {
    let mut found: Vec<(T, Vec<usize>)> = Vec::new();
    for (place, answer) in answers.into_iter().enumerate() {
        match found.iter_mut().find(|(known, _)| *known == answer) {
            Some((_, places)) => places.push(place),
            None => found.push((answer, vec![place])),
        }
    }
    found
}

/// Which factor decides most of `output`: alone, and with all its interactions; without a full stop.
pub(super) fn decides_most(contenders: &[Contender], output: &str) -> Option<String> {
    let leaders = may_lead(contenders);
    let lead = &contenders[*leaders.first()?];
    if lead.total.estimate <= 0.0 {
        return Some(format!("No total index of {output} is above 0"));
    }
    if leaders.len() > 1 {
        let total = |contender: &Contender| index(contender.total);
        let names = names(contenders, &leaders, &total);
        return Some(format!("What decides most of {output} cannot be told apart, by S_T: {names}"));
    }
    let (label, total) = (&lead.label, index(lead.total));
    // One that alone moves the output interacts with none.
    let is_only = contenders.len() > 1 && contenders.iter().filter(|other| other.total.estimate != 0.0).count() < 2;
    Some(match lead.first_order {
        _ if is_only => format!("For {output}, {label} decides most: S_T is {total}, and no other moves it"),
        Some(first) if first.estimate <= 0.0 || first.low.is_some_and(|low| low <= 0.0) => format!(
            "For {output}, {label} decides most: with all its interactions S_T is {total}, alone it explains nothing that can \
             be told from 0"
        ),
        Some(first) if first.estimate < lead.total.estimate => format!(
            "For {output}, {label} decides most: alone S_1 is {}, with all its interactions S_T is {total}",
            index(first)
        ),
        _ => format!("For {output}, {label} decides most: S_T is {total}, and no interactions of it are seen"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(low: f64, high: f64) -> EstimateRecord {
        EstimateRecord { estimate: (low + high) / 2.0, low: Some(low), high: Some(high) }
    }

    fn contender(label: &str, first: (f64, f64), total: (f64, f64), probability: Option<f64>) -> Contender {
        let (first_order, total) = (Some(record(first.0, first.1)), record(total.0, total.1));
        Contender { label: label.to_owned(), first_order, total, probability }
    }

    #[test]
    fn a_tie_has_no_winner() {
        let tie = [
            contender("a", (0.3, 0.5), (0.4, 0.6), Some(0.45)),
            contender("b", (0.31, 0.51), (0.42, 0.6), Some(0.53)),
            contender("c", (0.0, 0.1), (0.0, 0.1), Some(0.02)),
        ];
        assert_eq!(may_lead(&tie), [1, 0]);
        let said = decides_most(&tie, "y").unwrap();
        assert_eq!(said, "What decides most of y cannot be told apart, by S_T: b (0.51 ± 0.09) and a (0.50 ± 0.10)");
        let mut unknown = tie.to_vec();
        unknown.iter_mut().for_each(|contender| contender.probability = None);
        assert_eq!(may_lead(&unknown), [1, 0]);
        unknown.iter_mut().for_each(|contender| (contender.total.low, contender.total.high) = (None, None));
        assert_eq!(may_lead(&unknown), [1]);
        assert_eq!(may_lead(&[]), [] as [usize; 0]);
        // Unsure, and no other likely: the next one.
        let unsure =
            [contender("a", (0.0, 0.1), (0.5, 0.6), Some(0.93)), contender("b", (0.0, 0.1), (0.4, 0.5), Some(0.04))];
        assert_eq!(may_lead(&unsure), [0, 1]);
    }

    #[test]
    fn nobody_outside_a_tie_has_a_larger_estimate_than_one_inside() {
        let probabilities = [Some(0.9), Some(0.01), Some(0.07), Some(0.0)];
        let contenders: Vec<Contender> = [(1.0, 2.0), (0.5, 1.5), (0.2, 0.8), (0.0, 0.1)]
            .into_iter()
            .zip(probabilities)
            .map(|(total, probability)| contender("x", (0.0, 0.1), total, probability))
            .collect();
        assert_eq!(may_lead(&contenders), [0, 1, 2]);
        // By intervals: that of the second stays below, that of the third does not.
        let mut by_interval = contenders.clone();
        by_interval.iter_mut().for_each(|contender| contender.probability = None);
        (by_interval[1].total.high, by_interval[2].total.high) = (Some(0.99), Some(1.2));
        assert_eq!(may_lead(&by_interval), [0, 1, 2]);
    }

    #[test]
    fn outputs_are_named_in_stretches() {
        let outputs = ["force", "u[0]", "u[1]", "u[2]", "v[0]", "v[1]", "y"];
        let said = |places: &[usize]| of_which(&outputs, places);
        assert_eq!(said(&[0, 1, 2, 3, 4]), "5 outputs: force, u[0] to u[2] and v[0]");
        assert_eq!((said(&[6]), said(&[0, 1, 2, 3, 4, 5, 6])), ("y".to_owned(), "all 7 outputs".to_owned()));
        let answers = by_answer(["a", "b", "a"]);
        assert_eq!(answers, [("a", vec![0, 2]), ("b", vec![1])]);
    }

    #[test]
    fn one_of_many_interactions_is_chance() {
        let pairs = |number: usize| -> Vec<PairRecord> {
            let pair = |k: usize| PairRecord {
                factors: [format!("x{k}"), "z".to_owned()],
                // Twice its half width from 0, and at 1.2 half widths.
                index: if k == 0 { record(0.01, 0.03) } else { record(0.002, 0.022) },
            };
            (0..number).map(pair).collect()
        };
        assert_eq!(surely_interact(&pairs(2)), [true, true]);
        // At 45 pairs 3.26 standard errors are wanted, at 435 there are 3.86.
        assert_eq!(surely_interact(&pairs(45))[..2], [true, false]);
        assert!(surely_interact(&pairs(435))[0]);
        let unknown = EstimateRecord { estimate: 0.5, low: None, high: None };
        assert_eq!(surely_interact(&[PairRecord { factors: Default::default(), index: unknown }]), [false]);
        let exact = PairRecord { factors: Default::default(), index: record(0.2, 0.2) };
        assert_eq!(surely_interact(&[exact]), [true]);
    }

    #[test]
    fn no_share_is_negative_and_no_total_below_its_first_order() {
        let lead = |first, total| decides_most(&[contender("a", first, total, Some(1.0))], "y").unwrap();
        assert_eq!(
            lead((-0.3, 0.05), (0.6, 0.7)),
            "For y, a decides most: with all its interactions S_T is 0.65 ± 0.05, alone it explains nothing that can be told from \
             0"
        );
        assert_eq!(
            lead((0.675, 0.695), (0.666, 0.686)),
            "For y, a decides most: S_T is 0.676 ± 0.010, and no interactions of it are seen"
        );
        assert_eq!(
            lead((0.2, 0.3), (0.5, 0.6)),
            "For y, a decides most: alone S_1 is 0.25 ± 0.05, with all its interactions S_T is 0.55 ± 0.05"
        );
        assert_eq!(lead((0.0, 0.0), (0.0, 0.0)), "No total index of y is above 0");
        let still = contender("b", (0.0, 0.0), (0.0, 0.0), Some(0.0));
        let only = [contender("a", (0.0, 0.2), (0.9, 1.1), Some(1.0)), still];
        assert_eq!(
            decides_most(&only, "y").unwrap(),
            "For y, a decides most: S_T is 1.00 ± 0.10, and no other moves it"
        );
    }
}
