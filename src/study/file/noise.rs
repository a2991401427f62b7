//! The noise of a stochastic model: `noise = "seed"`, or the table `[noise]`.
//!
//! The seed itself is a factor by now, that of the distribution `seed` ([`forms`](super::forms)).

use std::sync::Arc;

use super::context::{Context, Fault, wrong};
use super::error::Problem;
use super::sections::{At, FactorSection, StudyFile};
use crate::space::{Factor, Space};
use crate::study::Subject;
use crate::study::subject::RepeatedSubject;

/// Most repetitions of a row.
const MOST: u64 = 1000;

/// Refuses a second noise, and a noise alone.
pub(super) fn refuse(context: &Context<'_>, factors: &[Factor], sections: &[At<FactorSection>]) -> Result<(), Fault> {
    let mut noises = factors.iter().enumerate().filter(|(_, factor)| factor.distribution().is_noise());
    let Some((first, _)) = noises.next() else { return Ok(()) };
    let place = |number: usize| sections[number].get_ref().name.span();
    if let Some((second, factor)) = noises.next() {
        let right = format!(
            "`{}` is a seed already: a study has one noise, from which the model draws all that is random in it",
            factors[first].name
        );
        return Err(context.fault(place(second), Problem::Misplaced { name: factor.name.clone(), right }));
    }
    if factors.len() == 1 {
        return Err(context.fault(place(first), Problem::NoFactors));
    }
    Ok(())
}

/// The subject with as many repetitions of each row as the study asks for.
pub(super) fn repeated(
    context: &Context<'_>,
    file: &StudyFile,
    subject: Arc<dyn Subject>,
    space: &Space,
) -> Result<Arc<dyn Subject>, Fault> {
    let typed = file.noise.as_ref().and_then(|section| section.get_ref().repetitions.as_ref());
    let (Some(typed), Some(seed)) = (typed, space.noise()) else { return Ok(subject) };
    let repetitions = *typed.get_ref();
    let refused =
        |expected: &str, found: String| Err(context.fault(typed.span(), wrong("repetitions", expected, found)));
    if !(1..=MOST).contains(&repetitions) {
        return refused(&format!("a whole number from 1 to {MOST}"), repetitions.to_string());
    }
    if repetitions == 1 {
        return Ok(subject);
    }
    if subject.is_external() {
        let expected = "1 for a model outside of this program, which can give mean and variance as outputs of its own";
        return refused(expected, repetitions.to_string());
    }
    if file.fidelity.is_some() {
        return refused("1 beside [fidelity]", repetitions.to_string());
    }
    Ok(Arc::new(RepeatedSubject::new(subject, seed, repetitions as usize)))
}

/// The sets of each factor and the noise, which total indices of the mean over the noise follow from, if the study asks for
/// these.
pub(super) fn subsets_of_mean(file: &StudyFile, space: &Space) -> Vec<Vec<usize>> {
    let asked = file.noise.as_ref().and_then(|section| section.get_ref().mean_totals.as_ref());
    let (Some(true), Some(noise)) = (asked.map(|asked| *asked.get_ref()), space.noise()) else { return Vec::new() };
    let with_noise = |factor: usize| if factor < noise { vec![factor, noise] } else { vec![noise, factor] };
    (0..space.factors().len()).filter(|factor| *factor != noise).map(with_noise).collect()
}
