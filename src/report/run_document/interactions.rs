//! How much of the variance is interaction, in sentences that the intervals bear.

use crate::report::format::{index, is_above_zero, name, percent};
use crate::report::leading::{Contender, may_lead, moving, names};
use crate::report::result::{EstimateRecord, IndexRecord, OutputRecord, ResultFile};

/// A share of the variance that an interval must exclude before interactions count as absent.
const VISIBLE: f64 = 0.1;
/// Interactions up to this share of the variance are not worth a leader.
const TRACE: f64 = 1e-3;

/// How much of the variance of an output no factor, nor the noise, accounts for alone; nothing where one alone moved it.
pub(super) fn interactions(result: &ResultFile, output: &OutputRecord) -> String {
    if !result.study.dependences.is_empty() {
        return match output.indices {
            Some(_) => "Factors depend on each other, so that interactions cannot be told from their dependence.",
            None => "",
        }
        .to_owned();
    }
    let Some(sum) = output.sum_first_order.filter(|_| moving(output) > 1) else { return String::new() };
    let (indices, with) = match output.noise {
        None => ("The first-order indices", ""),
        Some(_) => {
            ("The first-order indices, that of the noise among them,", " of the factors with each other or the noise")
        }
    };
    let sum_to = format!("{indices} sum to {}", index(sum));
    let rest = complement(sum);
    match (rest.low, rest.high) {
        (Some(_), _) if is_above_zero(rest) => {
            format!("{sum_to}, so {} of the variance is interaction{with}.", percent(rest))
        }
        (_, Some(high)) if high < 0.0 => {
            format!("{sum_to}, beyond 1 by more than their error, which none can: the samples are too few.")
        }
        (Some(_), Some(high)) if high > VISIBLE => {
            format!("{sum_to}, which leaves open how much of the variance is interaction{with}.")
        }
        (Some(_), Some(_)) => format!("{sum_to}, 1 to within the error: no interactions{with} are seen."),
        _ => format!("{sum_to}; without intervals, whether there are interactions{with} is unknown."),
    }
}

/// What a part leaves of 1, with the interval that follows from its own.
pub(super) fn complement(part: EstimateRecord) -> EstimateRecord {
    EstimateRecord {
        estimate: 1.0 - part.estimate,
        low: part.high.map(|high| 1.0 - high),
        high: part.low.map(|low| 1.0 - low),
    }
}

/// Which factor acts most together with others, where that is more than a trace: one only if it can be told.
pub(super) fn leader(output: &OutputRecord) -> Option<String> {
    let gap = |index: &IndexRecord| {
        let total = index.effect.interaction?;
        Some(Contender { label: name(&index.factor), first_order: None, total, probability: None })
    };
    let gaps: Vec<Contender> = output.indices.iter().flatten().filter_map(gap).collect();
    let leaders = may_lead(&gaps);
    let is_seen = |gap: &Contender| is_above_zero(gap.total) && gap.total.low.is_some_and(|low| low > TRACE);
    if !leaders.iter().any(|&place| is_seen(&gaps[place])) {
        return None;
    }
    let size = |contender: &Contender| index(contender.total);
    Some(match &leaders[..] {
        [most] => {
            let most = &gaps[*most];
            format!("Most of all, {} acts together with others: S_T − S_1 is {}.", most.label, size(most))
        }
        tied => format!(
            "Which factor acts most together with others cannot be told, by S_T − S_1: {}.",
            names(&gaps, tied, &size)
        ),
    })
}

/// For how many of many outputs interactions are seen, and where most; nothing without intervals.
pub(super) fn of_many(outputs: &[OutputRecord]) -> Option<String> {
    let known: Vec<(EstimateRecord, &OutputRecord)> =
        outputs.iter().filter_map(|output| Some((complement(output.sum_first_order?), output))).collect();
    known.iter().find(|(rest, _)| rest.low.is_some())?;
    let seen: Vec<_> = known.iter().filter(|(rest, output)| is_above_zero(*rest) && moving(output) > 1).collect();
    let Some((most, at)) = seen.iter().max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate)) else {
        return Some("For none of them interactions are sure to be more than the error.".to_owned());
    };
    Some(format!(
        "Interactions are sure to be seen for {} of {}, most of all for {}, where the first-order indices leave {} of the \
         variance to them.",
        seen.len(),
        known.len(),
        name(&at.name),
        percent(*most)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn said(low: f64, high: f64) -> String {
        let study = crate::Study::parse("model = \"ishigami\"\n[design]\nbase_samples = 64", Path::new("i.toml"), &[]);
        let study = study.unwrap();
        let mut result = ResultFile::new(&study, &study.run().unwrap());
        let mut output = result.outputs.remove(0);
        let known = low.is_finite();
        output.sum_first_order = Some(EstimateRecord {
            estimate: if known { (low + high) / 2.0 } else { high },
            low: known.then_some(low),
            high: known.then_some(high),
        });
        interactions(&result, &output)
    }

    #[test]
    fn interactions_are_what_the_factors_alone_leave() {
        assert_eq!(
            said(0.60, 0.62),
            "The first-order indices sum to 0.610 ± 0.010, so 39.0 ± 1.0 % of the variance is interaction."
        );
        assert!(said(0.99, 1.01).contains("no interactions are seen"));
        assert!(said(1.01, 1.03).contains("beyond 1"));
        assert!(said(0.01, 1.0).contains("leaves open how much"));
        assert!(said(1e-19, 0.999).contains("leaves open how much"));
        assert_eq!(
            said(f64::NAN, 0.6),
            "The first-order indices sum to 0.6; without intervals, whether there are interactions is unknown."
        );
    }
}
