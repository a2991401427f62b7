//! The judgement of the numbers of a model at the extremes of its inputs, by a second calculation.

use std::any::Any;
use std::cmp::Reverse;

use apportion::Distribution;
use apportion::Study;
use apportion::model::{Batch, Counter, Model, RowFailure, RunContext, Worker};
use apportion::space::{Factor, Space};
use apportion::study::Subject;
use apportion_afm::{AfmSubject, Parameter};
use apportion_base::quantity::Unit;
use apportion_files::ExpressionSubject;
use serde_json::{Map, Value};

use super::afm_second::AfmSecond;
use super::map::{Extremes, Kind, Outcome, Reason, Reasons, Tally};
use super::points::points;
use super::precise::reference;

/// The map of the extremes of a study at about `count` points, random ones by `seed`; or why the model gave up. All
/// steps of every factor past its bounds are included, even if there are more.
pub fn extremes(study: &Study, count: u64, seed: u64) -> Result<Extremes, String> {
    let context = RunContext::new(None, |_| ());
    let factors = study.space().factors().iter().cloned();
    let space = Space::new(factors.chain(further_inputs(study)).collect());
    let model = study.subject().model(&space);
    let second = second_calculation(&**study.subject(), &space);
    let mut worker = model.worker(&context);
    let mut map = Extremes {
        second_calculation: second.as_ref().ok().map(|second| second.name.clone()),
        counts: Tally::default(),
        kinds: Kind::ALL.map(|kind| (kind, Tally::default())).to_vec(),
        reasons: Vec::new(),
    };
    let mut reasons = Reasons::new();
    for point in points(&space, count, seed) {
        let inputs = space.factors().iter().zip(&point.x);
        let inputs: Map<String, Value> =
            inputs.map(|(factor, &x)| (factor.name.clone(), factor.unit().from_si(x).into())).collect();
        let findings = evaluate(model.as_ref(), &mut *worker, &point.x, &second)?;
        for (output, finding) in model.outputs().iter().zip(findings) {
            let reference = finding.reference.filter(|value| value.is_finite());
            let [value, reference] = [finding.value, reference].map(|value| Some(output.unit.from_si(value?)));
            let reason = Reason {
                kind: point.kind,
                outcome: finding.outcome,
                reason: finding.reason,
                count: 0,
                place: point.place.clone(),
                inputs: inputs.clone(),
                output: output.name.to_string(),
                value,
                reference,
            };
            map.add(reason, &mut reasons);
        }
    }
    map.reasons = reasons.into_values().collect();
    map.reasons.sort_by_key(|reason| (reason.outcome != Outcome::Wrong, reason.kind, Reverse(reason.count)));
    Ok(map)
}

/// Velocity and adhesion of the nanoparticle, which may be zero, where they are not factors.
fn further_inputs(study: &Study) -> Vec<Factor> {
    let subject: &dyn Any = &**study.subject();
    let Some(afm) = subject.downcast_ref::<AfmSubject>() else { return Vec::new() };
    let is_factor = |name: &str| study.space().factors().iter().any(|factor| factor.name == name);
    let further = [("velocity", "nm/s"), ("adhesion", "mJ/m^2")].into_iter().filter(|(name, _)| !is_factor(name));
    let constants = further.map(|(name, unit)| {
        let (parameter, unit) = (Parameter::from_name(name).unwrap(), Unit::parse(unit).unwrap());
        let value = Distribution::constant(unit.from_si((parameter.get)(&afm.scene))).unwrap();
        Factor::new(name, unit, value).unwrap()
    });
    constants.collect()
}

/// The outcome of an output at a point; its numbers in SI units.
struct Finding {
    outcome: Outcome,
    /// Empty for a number that is right.
    reason: String,
    value: Option<f64>,
    reference: Option<f64>,
}

impl Finding {
    fn new(outcome: Outcome, reason: impl Into<String>) -> Self {
        Self { outcome, reason: reason.into(), value: None, reference: None }
    }
}

/// Returns the outcome of every output at the point `x`, or why the model gave up.
fn evaluate(
    model: &dyn Model,
    worker: &mut dyn Worker,
    x: &[f64],
    second: &Result<SecondCalculation, &'static str>,
) -> Result<Vec<Finding>, String> {
    let mut batch = Batch::new(model);
    batch.reset(1);
    let inputs: Vec<&[f64]> = x.iter().map(std::slice::from_ref).collect();
    worker.run(&inputs, &mut batch);
    batch.settle();
    if let Some(give_up) = batch.given_up() {
        return Err(give_up.to_string());
    }
    let outputs = 0..model.outputs().len();
    let values = outputs.clone().map(|output| match batch.failures().iter().find(|(failed, ..)| *failed == output) {
        Some((.., why)) => Err(why.clone()),
        None => Ok(batch.column(output)[0]),
    });
    let values: Vec<Result<f64, RowFailure>> = values.collect();
    let raised = model.flags().iter().zip(batch.flags()).filter(|(_, raised)| **raised > 0);
    let flags: Vec<&str> = raised.map(|(flag, _)| &*flag.name).collect();
    let counter = model.counters().iter().position(|counter| counter.name == Counter::LARGEST_ERROR);
    let error_estimate = counter.and_then(|number| batch.counts().values().nth(number));
    let answered: Vec<Option<f64>> = values.iter().map(|value| value.as_ref().ok().copied()).collect();
    let references = match second {
        Ok(second) => (second.calculate)(x, (&answered, error_estimate)),
        Err(why) => outputs.map(|_| Err(Unchecked::NotAvailable((*why).to_owned()))).collect(),
    };
    let judged = values.into_iter().zip(&references).map(|(value, reference)| judge(value, &flags, reference));
    Ok(judged.collect())
}

/// Judges an output with a `value` or a reason why it has none, the `flags` that the model raised, and a second
/// calculation.
fn judge(value: Result<f64, RowFailure>, flags: &[&str], second: &Result<Reference, Unchecked>) -> Finding {
    let value = match value {
        Ok(value) => value,
        Err(failure) => return Finding::new(Outcome::Refused, failure.to_string()),
    };
    let flagged = (!flags.is_empty()).then(|| format!("flags of the model: {}", flags.join(", ")));
    let finding = match second {
        Err(Unchecked::NotAvailable(why)) => {
            Finding::new(Outcome::Flagged, flagged.unwrap_or_else(|| format!("not checked: {why}")))
        }
        Err(Unchecked::NoValue(why)) => Finding::new(Outcome::Wrong, format!("a number where none exists: {why}")),
        Ok(reference) => match (reference.agrees(value), flagged) {
            (Some(true), None) => Finding::new(Outcome::Right, ""),
            (Some(true), Some(flags)) => Finding::new(Outcome::FlaggedConfirmed, flags),
            (Some(false), flags) => {
                Finding::new(Outcome::Flagged, flags.unwrap_or_else(|| reference.covered.to_owned()))
            }
            (None, _) => Finding::new(Outcome::Wrong, "the second calculation differs by more than the stated error"),
        },
    };
    Finding { value: Some(value), reference: second.as_ref().ok().map(|reference| reference.value), ..finding }
}

/// Another way to compute the outputs of a model.
pub struct SecondCalculation {
    /// Its name, in a few words.
    pub name: String,
    /// Computes every output at a point, the SI values of the factors in the order of the space, to compare with the
    /// model's outputs there: in SI units, `None` for a missing one, and the relative error that it estimates for them.
    pub calculate: Box<Calculate>,
}

type Calculate = dyn Fn(&[f64], (&[Option<f64>], Option<f64>)) -> Vec<Result<Reference, Unchecked>> + Send + Sync;

/// An output by a second calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// The value in SI units; infinite beyond the range of doubles.
    pub value: f64,
    /// Possible distance of the model's value from it by the stated errors of both calculations; infinite if they claim
    /// nothing, `None` if no error is stated for this output.
    pub stated: Option<f64>,
    /// Maximum relative deviation of a value that is right.
    pub tolerance: f64,
    /// Relative deviation that is never wrong for any stated error: that of the arithmetic, or of a solver.
    pub floor: f64,
    /// Why a value may deviate by more; a sentence without a full stop.
    pub covered: &'static str,
}

impl Reference {
    /// Returns whether `value` is right; `None` if it deviates by more than is stated.
    pub fn agrees(&self, value: f64) -> Option<bool> {
        // Subnormal numbers have no relative precision.
        let underflow = 2.0 * f64::MIN_POSITIVE * f64::EPSILON;
        let apart = if value == self.value { 0.0 } else { (value - self.value).abs() };
        let [is_at_floor, is_right] = [self.floor, self.tolerance]
            .map(|relative| apart <= underflow || apart.is_finite() && apart <= relative * self.value.abs());
        (is_at_floor || self.stated.is_none_or(|stated| apart <= stated)).then_some(is_right)
    }
}

/// Why an output cannot be checked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unchecked {
    /// The second calculation failed; a sentence without a full stop.
    NotAvailable(String),
    /// The second calculation says that there is no value, with the reason.
    NoValue(String),
}

/// The outputs of a study's model on the factors of `space` by another way.
///
/// # Errors
/// Why there is none, in a few words.
fn second_calculation(subject: &dyn Subject, space: &Space) -> Result<SecondCalculation, &'static str> {
    let subject: &dyn Any = subject;
    if let Some(formulas) = subject.downcast_ref::<ExpressionSubject>() {
        let formulas = formulas.formulas.clone();
        return Ok(SecondCalculation {
            name: "the formula in 320 bits".to_owned(),
            calculate: Box::new(move |x, _| formulas.iter().map(|formula| reference(&formula.expression, x)).collect()),
        });
    }
    let afm = subject.downcast_ref::<AfmSubject>().ok_or("there is no second calculation of this model")?;
    if !afm.histories.is_empty() {
        return Err("there is no second calculation of a history");
    }
    let factors = space.factors().iter().filter_map(|factor| Parameter::from_name(&factor.name)).collect();
    let afm = AfmSecond::new(afm.scene, afm.options, factors, afm.outputs.clone());
    let name = afm.name();
    Ok(SecondCalculation { name, calculate: Box::new(move |x, (values, error)| afm.calculate(x, values, error)) })
}
