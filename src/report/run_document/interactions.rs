//! How much of the variance is interaction, in sentences that the intervals bear.

use crate::report::format::{index, name, percent};
use crate::report::result::{EstimateRecord, OutputRecord, ResultFile};

/// A share of the variance that an interval must exclude before interactions count as absent.
const VISIBLE: f64 = 0.1;

/// How much of the variance of an output no factor, nor the noise, accounts for alone; nothing of a single factor.
pub(super) fn interactions(result: &ResultFile, output: &OutputRecord) -> String {
    if !result.study.dependences.is_empty() {
        return match output.indices {
            Some(_) => "Factors depend on each other, so that interactions cannot be told from their dependence.",
            None => "",
        }
        .to_owned();
    }
    let alone = output.indices.as_ref().is_none_or(|indices| indices.len() < 2) && output.noise.is_none();
    let Some(sum) = output.sum_first_order.filter(|_| !alone) else { return String::new() };
    let (indices, with) = match output.noise {
        None => ("The first-order indices", ""),
        Some(_) => {
            ("The first-order indices, that of the noise among them,", " of the factors with each other or the noise")
        }
    };
    let sum_to = format!("{indices} sum to {}", index(sum));
    let rest = rest(sum);
    match (rest.low, rest.high) {
        (Some(low), _) if low > 0.0 => format!("{sum_to}, so {} of the variance is interaction{with}.", percent(rest)),
        (_, Some(high)) if high < 0.0 => {
            format!("{sum_to}, beyond 1 by more than their error, which none can: the samples are too few.")
        }
        (Some(_), Some(high)) if high > VISIBLE => {
            format!("{sum_to}, which leaves open how much of the variance is interaction{with}.")
        }
        (Some(_), Some(_)) => format!("{sum_to}, 1 to within the error: no interactions{with} are seen."),
        _ if rest.estimate <= 0.0 => {
            format!("{sum_to}: no interactions{with} are seen, but without intervals, how sure that is, is unknown.")
        }
        _ => format!(
            "{sum_to}, so some {} of the variance is interaction{with}; without intervals, how sure that is, is unknown.",
            percent(rest)
        ),
    }
}

/// What the first-order indices leave of 1.
fn rest(sum: EstimateRecord) -> EstimateRecord {
    EstimateRecord {
        estimate: 1.0 - sum.estimate,
        low: sum.high.map(|high| 1.0 - high),
        high: sum.low.map(|low| 1.0 - low),
    }
}

/// Between which bounds the interactions of many outputs lie, and where there are most.
pub(super) fn of_many(outputs: &[OutputRecord]) -> Option<String> {
    let known: Vec<(EstimateRecord, &OutputRecord)> =
        outputs.iter().filter_map(|output| Some((rest(output.sum_first_order?), output))).collect();
    let (most, at) = known.iter().max_by(|a, b| a.0.estimate.total_cmp(&b.0.estimate))?;
    let seen = known.iter().filter(|(rest, _)| rest.low.is_some_and(|low| low > 0.0)).count();
    Some(match (seen, most.low) {
        (0, Some(_)) => "For none of them interactions are sure to be more than the error.".to_owned(),
        _ => format!(
            "Interactions are sure to be seen for {seen} of {}, most of all for {}, where the first-order indices leave {} of \
             the variance to them.",
            known.len(),
            name(&at.name),
            percent(*most)
        ),
    })
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
        assert!(said(f64::NAN, 0.6).contains("some 40 % of the variance"));
        assert!(said(f64::NAN, 1.127).contains("sum to 1.13: no interactions are seen"));
    }
}
