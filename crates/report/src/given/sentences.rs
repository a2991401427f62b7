//! The sentences of a result from given data.

use apportion::given::{Column, GivenIndices, OutputIndices, PointSet, Replicates, SurrogateOutput};
use apportion::result::{OutputDistribution, Warning};
use apportion_base::quantity::Unlikely;
use apportion_base::text::listed;

use super::{GivenOutputRecord, SurrogateResult};
use crate::format::fixed;

pub(super) fn estimators(indices: &GivenIndices, surrogates: &SurrogateResult) -> Vec<String> {
    let rank = "rank: Gamboa, Gremaud, Klein and Lagnoux 2022, averaged over the orders of ties".to_owned();
    let bins = indices.bins();
    let binned = match indices.points {
        PointSet::Independent => {
            format!("binned: variance of lines in {bins} bins of equal probability, less that of noise")
        }
        _ => format!("binned: variance of lines in {bins} bins of equal probability"),
    };
    let ranked = indices.points == PointSet::Independent;
    let surrogate = surrogates.as_ref().ok().map(|all| {
        let polynomials = if all.given_distributions { "the given distributions" } else { "the columns\' distributions" };
        format!(
            "surrogate: polynomial chaos expansion (Sudret 2008), orthonormal in {polynomials}, with a prior learnt from the \
             rows; how its coefficients are computed, and what it leaves, by {} parts of the rows, each left out once",
            all.folds
        )
    });
    let list = [ranked.then_some(rank), Some(binned), surrogate];
    list.into_iter().flatten().collect()
}

pub(super) fn interval(indices: &GivenIndices, by_surrogate: bool) -> Option<String> {
    let mut parts = Vec::new();
    if indices.points == PointSet::Independent && indices.effective_rows.is_none() {
        parts.push("95 %, asymptotic, for independent rows");
    }
    if by_surrogate {
        parts.push(
            "by the surrogate: 95 %, from what it leaves of rows that were left out of fits, and how much the fits differ",
        );
    }
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// Returns the notes that hold for all indices from given data.
pub(super) fn notes(by_surrogate: bool) -> Vec<String> {
    let orders = if by_surrogate {
        "by ranks and bins, given data yield first-order indices only; those by the surrogate, with the total indices, lack a \
         part of the variance that the rows cannot assign to inputs (noise, inputs that are not in the table, fine \
         structure): all of it may belong to any input, so the intervals include it"
    } else {
        "given data yield first-order indices only: no total index, and no interactions; if the sum of the indices is below 1, the \
         rest may be interactions, noise, or inputs that are not in the table"
    };
    [
        orders,
        "if inputs depend on each other, S_j is the share of the variance that knowing input j alone removes: it contains \
         effects of inputs correlated with it, and the sum may exceed 1",
        "the indices describe the distribution of the inputs in the table; they do not apply to values outside it",
    ]
    .map(str::to_owned)
    .to_vec()
}

/// Returns the warnings on the table.
pub(super) fn warnings(
    indices: &GivenIndices,
    surrogates: &SurrogateResult,
    dropped: Option<(u64, u64)>,
) -> Vec<String> {
    let mut warnings = Vec::new();
    match surrogates {
        Err(refusal) => warnings.push(format!("no indices by a surrogate: {refusal}")),
        Ok(all) if all.rows < indices.rows => warnings.push(format!(
            "the table is large: the surrogate is fitted to {} of its {} rows, drawn at random",
            all.rows, indices.rows
        )),
        Ok(_) => {}
    }
    if let Some((rows, line)) = dropped {
        let were = if rows == 1 { "row was" } else { "rows were" };
        warnings.push(format!(
            "{rows} {were} left out for missing values (the first on line {line}); if runs fail in a part of the space, the \
             indices hold only for the rest of it"
        ));
    }
    if let Some(reason) = indices.points.reason() {
        warnings.push(format!(
            "no estimate by ranks, which does not converge here, and no intervals: {reason}. In many dimensions the estimates by bins may take an input for a combination of others"
        ));
    }
    if let Some(rows) = indices.effective_rows {
        warnings.push(format!(
            "the rows follow each other in time: an input and an output go on from row to row, so that the {} rows are worth \
             about {rows:.0} independent ones; there are no intervals",
            indices.rows
        ));
    }
    if let Some(dependence) = &indices.dependence {
        let (a, b) = &dependence.strongest.inputs;
        let meaning = "first-order indices then contain effects of both";
        if dependence.correlated() {
            let spearman = dependence.strongest.spearman;
            warnings
                .push(format!("the inputs `{a}` and `{b}` are correlated (rank correlation {spearman:.2}); {meaning}"));
        }
        if let Some((a, b)) = &dependence.uneven {
            warnings.push(format!("the inputs `{a}` and `{b}` depend on each other, though not by rank; {meaning}"));
        }
    }
    warnings
}

pub(super) fn output_warnings(output: &OutputIndices, surrogate: Option<&SurrogateOutput>) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(surrogate) = surrogate.filter(|surrogate| !surrogate.serves) {
        warnings.push(format!(
            "the surrogate is not used: it explains only {} of the variance of rows that it was not fitted to, and {} are \
             needed. The first-order indices are those by ranks or bins; there are no total indices",
            percent(surrogate.explained.max(0.0)),
            percent(SurrogateOutput::MIN_EXPLAINED)
        ));
    }
    if let Some(surrogate) = surrogate.filter(|of| of.serves && of.sum_first_order < 0.01 && of.indices.len() > 1) {
        warnings.push(format!(
            "by the surrogate no input has an effect of its own, and all of the variance ({} of it explained) is due to \
             interactions: this is rare; check how the rows were chosen",
            percent(surrogate.explained)
        ));
    }
    let all = output.indices.as_deref().unwrap_or_default();
    let leading = all.iter().map(|index| index.leading());
    let sum: f64 = leading.clone().map(|of| of.estimate).sum();
    let error =
        leading.map(|of| of.interval.map_or(0.0, |interval| interval.width() / 2.0).powi(2)).sum::<f64>().sqrt();
    if sum > 1.05 + 1.5 * error {
        warnings.push(format!(
            "the first-order indices sum to {sum:.2}, which independent inputs cannot: the rows were not drawn at random, or \
             the inputs depend on each other; the indices are too large"
        ));
    }
    for index in output.indices.iter().flatten() {
        if index.constant {
            warnings.push(format!("the input `{}` has one value only: its index is 0 by definition", index.input));
        }
        if index.disagree() {
            warnings.push(format!(
                "for `{}` ranks and bins disagree beyond their intervals: the dependence may be too fine for the bins, or the \
                 rows not independent",
                index.input
            ));
        }
    }
    warnings
}

/// Returns a warning if few rows carry the variance of an output.
pub(super) fn few_rows(of: &OutputDistribution) -> Option<String> {
    let Warning::FewRows { rows, values, kurtosis } = Warning::few_rows(of.count, of.excess_kurtosis?)? else {
        return None;
    };
    Some(format!(
        "few rows determine the variance, as if {rows:.0} of the {values} did (excess kurtosis {kurtosis:.0}): look at these rows \
         (runs that diverged?); more of their kind may be missing, and intervals may be too short; the logarithm of the \
         output may work better"
    ))
}

/// Returns the warnings of values that may mark failed runs: neighbouring columns with the same one share a sentence.
pub(super) fn codes(columns: &[Column]) -> Vec<String> {
    let found: Vec<(&Column, Unlikely)> =
        columns.iter().filter_map(|column| Some((column, Unlikely::find_in_rows(&column.values)?))).collect();
    let groups = found.chunk_by(|(_, a), (_, b)| (a.value, a.count, a.first) == (b.value, b.count, b.first));
    let mut sentences = Vec::new();
    for group in groups {
        let names: Vec<String> = group.iter().map(|(column, _)| column.name.clone()).collect();
        let (text, value) = (group[0].1.in_table(group[0].1.first + 1), group[0].1.value);
        sentences.push(format!("{}: {text} (--missing-value={value:?}, NaN in Python)", listed(&names)));
    }
    sentences
}

/// Describes replicates that were averaged.
pub(super) fn replicates(of: &Replicates, outputs: &[GivenOutputRecord]) -> String {
    let scatter = of
        .scatter
        .iter()
        .zip(outputs)
        .map(|(share, output)| format!("{} of the variance of {}", percent(*share), output.name));
    format!(
        "rows that differ only in `{}` are replicates and were averaged, which leaves {} rows: the indices are those of the mean. \
         Before, the scatter of replicates was {}",
        of.seed,
        of.rows,
        listed(&scatter.collect::<Vec<_>>())
    )
}

/// Formats a share in percent.
pub(super) fn percent(share: f64) -> String {
    if share > 0.0 && share < 0.01 { "less than 1 %".to_owned() } else { format!("{} %", fixed(100.0 * share, 0)) }
}

/// Share of the variance below which a share is not reported.
pub(super) const VISIBLE: f64 = 5e-4;

/// Describes the surrogate of an output that is used.
pub(super) fn of_surrogate(explained: f64, unknown: f64, terms: f64, polynomials_of: &str) -> String {
    let left = match unknown >= VISIBLE {
        true => format!(
            " The rest, {} %, is not assigned to inputs: an index may be larger than its estimate by this amount, and the upper ends \
             of the intervals include it.",
            fixed(100.0 * unknown, 1)
        ),
        false => String::new(),
    };
    format!(
        "The surrogate, of {} terms in polynomials of {polynomials_of}, explains {} % of the variance of rows that it was not \
         fitted to.{left}",
        fixed(terms, 0),
        if explained > 0.999 { "more than 99.9".to_owned() } else { fixed(100.0 * explained, 1) },
    )
}
