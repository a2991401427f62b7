//! The noise of a stochastic model: `noise = "seed"`, or the table `[noise]`.
//!
//! The seed itself is already a factor, that of the distribution `seed` ([`forms`](super::forms)).

use std::sync::Arc;

use apportion::space::Space;
use apportion::study::{RepeatedSubject, Subject};

use super::context::{Context, Fault};
use super::sections::StudyFile;

/// Maximum number of repetitions of a row.
const MAX_REPETITIONS: u64 = 1000;

/// Returns the subject with the study's number of repetitions of each row.
pub(super) fn repeated(
    context: &Context<'_>,
    file: &StudyFile,
    subject: Arc<dyn Subject>,
    space: &Space,
) -> Result<Arc<dyn Subject>, Fault> {
    let typed = file.noise.as_ref().and_then(|section| section.get_ref().repetitions.as_ref());
    let (Some(typed), Some(seed)) = (typed, space.noise()) else { return Ok(subject) };
    let repetitions = *typed.get_ref();
    let refused = |expected: &str, found: String| context.refuse(typed, "repetitions", expected, found);
    if !(1..=MAX_REPETITIONS).contains(&repetitions) {
        return refused(&format!("a whole number from 1 to {MAX_REPETITIONS}"), repetitions.to_string());
    }
    if repetitions == 1 {
        return Ok(subject);
    }
    if subject.is_external() {
        let expected = "1 for a model outside this program, which can return mean and variance as outputs";
        return refused(expected, repetitions.to_string());
    }
    if file.fidelity.is_some() {
        return refused("1 with [fidelity]", repetitions.to_string());
    }
    Ok(Arc::new(RepeatedSubject { subject, seed, repetitions: repetitions as usize }))
}

/// Returns the sets of each factor and the noise, from which total indices of the mean over the noise follow, if the
/// study requests these.
pub(super) fn subsets_of_mean(file: &StudyFile, space: &Space) -> Vec<Vec<usize>> {
    let asked = file.noise.as_ref().and_then(|section| section.get_ref().mean_totals.as_ref());
    let (Some(true), Some(noise)) = (asked.map(|asked| *asked.get_ref()), space.noise()) else { return Vec::new() };
    let with_noise = |factor: usize| if factor < noise { vec![factor, noise] } else { vec![noise, factor] };
    (0..space.factors().len()).filter(|factor| *factor != noise).map(with_noise).collect()
}
