//! Typed parts of a result in words, and as lines of a study.

use apportion::Scaling;
use apportion::result::StudyResult;

/// Says how outputs are weighted against each other.
pub(crate) fn weighting(scaling: Scaling) -> &'static str {
    match scaling {
        Scaling::Plain => "each output counts by its variance (Gamboa et al. 2014)",
        Scaling::Standardised => "each output is divided by its standard deviation first, since their units differ",
    }
}

/// Returns the lines of a study that repeat a run with an accuracy, to the bit, in place of `accuracy`.
pub fn lines_to_repeat(result: &StudyResult) -> Option<String> {
    let (provenance, spending) = (&result.provenance, result.spending.as_ref()?);
    let mut lines = match provenance.plain_rows {
        0 => format!("[design]\nbase_samples = {}\n", provenance.base_samples),
        _ => format!("[design]\nruns = {}\n", provenance.model_runs),
    };
    lines.push_str(&format!("[analysis]\nsurrogate = \"{}\"\n", spending.surrogate.name()));
    if let [low] = &result.low_fidelity[..] {
        lines.push_str("[fidelity]\n");
        lines.push_str(&match spending.stated_low_fidelity {
            0 => format!("low = [\"{}\"]\n", low.name),
            1 => String::new(),
            _ => format!("# keep only `{}` in `low`\n", low.name),
        });
        lines.push_str(&format!("base_samples = {}\n", low.own_base_samples));
    }
    Some(lines)
}
