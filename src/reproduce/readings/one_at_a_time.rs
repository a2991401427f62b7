//! One factor at a time, the others at their nominal values.

use super::shares::printed;
use super::{Effect, ReadingsError, Share};
use apportion::estimate;
use apportion::model::{Batch, Model, RunContext};
use apportion::study::Study;
use apportion::sum::{centred_product, mean};

/// Values of a factor within its range, at the middles of as many equal parts of the probability: the variance of a
/// smooth function is then good to about 1e-6.
const VALUES: usize = 1024;

/// The ends of the unit interval, as far as distributions go: 2^-64 and 1 - 2^-53.
const ENDS: [f64; 2] = [f64::EPSILON / 4096.0, 1.0 - f64::EPSILON / 2.0];

/// The percentages of the factors of `study` in its output number `output` by variance or by range alone, and the model
/// runs that took; `None` if no factor by itself moves the output.
pub(super) fn shares(
    study: &Study,
    group: &'static str,
    output: usize,
    effect: Effect,
) -> Result<(Option<Vec<Share>>, u64), ReadingsError> {
    let model = study.model();
    let factors = study.space().factors();
    let mut sizes = Vec::with_capacity(factors.len());
    for (number, factor) in factors.iter().enumerate() {
        let values = curve(study, model.as_ref(), number).map_err(|reason| ReadingsError::NoValue {
            group,
            factor: factor.name.clone(),
            reason,
        })?;
        let y = &values[output];
        sizes.push(match effect {
            Effect::RangeAlone => {
                y.iter().copied().fold(f64::NEG_INFINITY, f64::max) - y.iter().copied().fold(f64::INFINITY, f64::min)
            }
            _ => {
                let inside = &y[..VALUES];
                let centre = (inside, mean(inside));
                centred_product(centre, centre) / VALUES as f64
            }
        });
    }
    let runs = (factors.len() * (VALUES + ENDS.len())) as u64;
    let percents = estimate::shares(&sizes);
    let with_names = |percents: Vec<f64>| {
        let share = |(factor, share): (&apportion::space::Factor, f64)| Share {
            factor: factor.name.clone(),
            share,
            interval: None,
            published: printed(group, &factor.name),
        };
        factors.iter().zip(percents).map(share).collect()
    };
    Ok((percents.map(with_names), runs))
}

/// Every output where factor `number` takes the middles of equal parts, then the ends of its range.
fn curve(study: &Study, model: &dyn Model, number: usize) -> Result<Vec<Vec<f64>>, apportion::model::RowFailure> {
    let u: Vec<f64> = (0..VALUES).map(|i| (i as f64 + 0.5) / VALUES as f64).chain(ENDS).collect();
    let columns: Vec<Vec<f64>> = study
        .space()
        .factors()
        .iter()
        .enumerate()
        .map(|(place, factor)| {
            let mut column = vec![factor.unit().to_si(factor.nominal); u.len()];
            if place == number {
                factor.fill_si(&u, &mut column);
            }
            column
        })
        .collect();
    let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let mut batch = Batch::new(model);
    batch.reset(u.len());
    model.worker(&RunContext::default()).run(&inputs, &mut batch);
    batch.settle();
    match batch.failures().first() {
        Some((_, _, reason)) => Err(reason.clone()),
        None => Ok((0..model.outputs().len()).map(|output| batch.column(output).to_vec()).collect()),
    }
}
