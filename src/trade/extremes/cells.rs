//! The cells of the model: its outputs at extreme inputs.

use std::sync::OnceLock;

use super::ExtremesJob;
use super::judge::judge;
use super::map::{Collector, Example, Finding};
use super::points::{Point, grids, points};
use crate::model::{Answered, Batch, GiveUp, LARGEST_ERROR, Model, RowFailure, RunContext, Unchecked, Worker};
use crate::run::{RunError, run_each_in};
use crate::space::Space;

/// Evaluates the model at the extremes of its inputs; returns what it was checked by, and the number of points.
pub(super) fn explore(
    job: &ExtremesJob<'_>,
    context: &RunContext<'_>,
    map: &mut Collector,
) -> Result<(Result<String, String>, u64), RunError> {
    let study = job.study;
    let factors = study.space().factors().iter().cloned();
    let space = Space::new(factors.chain(study.subject().further_inputs(study.space())).collect());
    let model = study.subject().model(&space);
    let second = study.subject().second_calculation(&space);
    let points = points(&space, job.settings.points, job.settings.seed);
    let gave_up = OnceLock::new();
    for grid in grids(&space) {
        map.grid(grid);
    }
    let nothing = |why: &&str| vec![Err(Unchecked::NotAvailable((*why).to_owned())); model.outputs().len()];
    let found = run_each_in(
        model.as_ref(),
        job.threads,
        context,
        points.len() as u64,
        |worker, number| {
            let x = &points[number as usize].x;
            let Evaluated { values, flags, error_estimate, given_up } = Evaluated::new(model.as_ref(), worker, x);
            if let Some(reason) = given_up {
                // Neither can it at any other point.
                let _ = gave_up.set(reason);
                context.end();
            }
            let answer =
                Answered { values: values.iter().map(|value| value.as_ref().ok().copied()).collect(), error_estimate };
            let references = second.as_ref().map_or_else(nothing, |second| second.calculate(x, &answer));
            let judged = values.into_iter().zip(&references);
            judged.map(|(value, reference)| judge(value, &flags, reference)).collect::<Vec<Finding>>()
        },
        job.on_progress,
    )?;
    if let Some(reason) = gave_up.into_inner() {
        return Err(RunError::GaveUp(reason));
    }
    for (point, findings) in points.iter().zip(found) {
        for (output, finding) in model.outputs().iter().zip(findings) {
            let in_unit = |value: Option<f64>| value.map(|value| output.unit.from_si(value));
            let finding = Finding { value: in_unit(finding.value), reference: in_unit(finding.reference), ..finding };
            map.note(point.kind, point.cell, finding, || example(&space, point, &output.name));
        }
    }
    let name = second.map(|second| second.name()).map_err(str::to_owned);
    Ok((name, points.len() as u64))
}

/// What has come of one row.
struct Evaluated<'m> {
    /// The outputs, or why there are none.
    values: Vec<Result<f64, RowFailure>>,
    /// The flags that it raised.
    flags: Vec<&'m str>,
    /// The relative error that the model estimates, if it counts one.
    error_estimate: Option<f64>,
    given_up: Option<GiveUp>,
}

impl<'m> Evaluated<'m> {
    fn new(model: &'m dyn Model, worker: &mut dyn Worker, x: &[f64]) -> Self {
        let mut batch = Batch::new(model);
        batch.reset(1);
        let inputs: Vec<&[f64]> = x.iter().map(std::slice::from_ref).collect();
        worker.run(&inputs, &mut batch);
        batch.settle();
        let of_output = |output: usize| match batch.failures().iter().find(|(failed, ..)| *failed == output) {
            Some((.., why)) => Err(why.clone()),
            None => Ok(batch.column(output)[0]),
        };
        let raised = model.flags().iter().zip(batch.flags()).filter(|(_, raised)| **raised > 0);
        let error = model.counters().iter().position(|counter| counter.name == LARGEST_ERROR);
        Self {
            values: (0..model.outputs().len()).map(of_output).collect(),
            flags: raised.map(|(flag, _)| &*flag.name).collect(),
            error_estimate: error.and_then(|number| batch.counts().values().nth(number)),
            given_up: batch.given_up().cloned(),
        }
    }
}

fn example(space: &Space, point: &Point, output: &str) -> Example {
    let inputs = space.factors().iter().zip(&point.x);
    Example {
        place: point.place.clone(),
        inputs: inputs.map(|(factor, &x)| (factor.name.clone(), factor.unit().from_si(x))).collect(),
        output: output.to_owned(),
        ..Example::default()
    }
}
