//! The critical pushing force of a nanoparticle as a model: the adapter between factors and [`crate::afm`].

#[cfg(feature = "study")]
mod second;

#[cfg(feature = "study")]
pub(crate) use second::AfmSecond;

use super::{Batch, Choice, Counter, CounterKind, Flag, Input, Model, Output, RowFailure, RunContext, Worker};
use crate::afm::{
    self, ContactTheory, Critical, Failure, Fidelity, FrictionLaw, LuGreParameters, Options, Parameter, Scene, Torsion,
    critical_force,
    force::{AT_ONCE, ClosedForms, Column, Slips},
};
use std::ops::Range;

use crate::quantity::Unit;

/// An output of the critical-force computation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AfmOutput {
    /// F_cr, the tip force at which the particle slips.
    CriticalForce,
    /// F_Y, the lateral part of it.
    LateralForce,
    /// F_Z, the normal part of it.
    NormalForce,
    /// t_cr, the time until it is reached.
    CriticalTime,
    /// ln F_cr, F_cr in newtons.
    LogCriticalForce,
    /// psi, the angle of the tip force from the vertical.
    ForceAngle,
    /// a, radius of the contact between particle and substrate.
    ContactRadius,
    /// d_s, indentation of that contact.
    Indentation,
}

impl AfmOutput {
    /// All outputs, the default one first.
    pub const ALL: [Self; 8] = [
        Self::CriticalForce,
        Self::LateralForce,
        Self::NormalForce,
        Self::CriticalTime,
        Self::LogCriticalForce,
        Self::ForceAngle,
        Self::ContactRadius,
        Self::Indentation,
    ];

    /// The name in study files and results.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// The unit in which it is reported.
    pub fn unit(self) -> Unit {
        edge(self.row().1)
    }

    /// One line for people.
    pub fn description(self) -> &'static str {
        self.row().2
    }

    /// The same for a [`Model`].
    pub fn info(self) -> Output {
        Output::new(self.name(), self.unit(), self.description())
    }

    fn row(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::CriticalForce => ("critical_force", "nN", "tip force F_cr at which the particle slips"),
            Self::LateralForce => ("lateral_force", "nN", "lateral part F_Y of the critical force"),
            Self::NormalForce => ("normal_force", "nN", "normal part F_Z of the critical force"),
            Self::CriticalTime => ("critical_time", "s", "time t_cr until the particle slips; none at velocity 0"),
            Self::LogCriticalForce => ("log_critical_force", "1", "natural logarithm of the critical force in newtons"),
            Self::ForceAngle => ("force_angle", "rad", "angle psi of the critical force from the vertical"),
            Self::ContactRadius => ("contact_radius", "nm", "radius a of the contact between particle and substrate"),
            Self::Indentation => ("indentation", "nm", "indentation d_s of the contact between particle and substrate"),
        }
    }

    /// The values of scenes solved at once in SI units, where they are at hand.
    fn column(self, slips: &Slips) -> Option<&Column> {
        match self {
            Self::CriticalForce => Some(&slips.critical_force),
            Self::LateralForce => Some(&slips.lateral_force),
            Self::NormalForce => Some(&slips.normal_force),
            Self::ContactRadius => Some(&slips.contact_radius),
            Self::CriticalTime | Self::LogCriticalForce | Self::ForceAngle | Self::Indentation => None,
        }
    }

    /// The value of scene number `i` of those solved at once.
    fn of_many(self, i: usize, forms: &ClosedForms) -> Result<f64, Failure> {
        let slips = forms.slips();
        match self {
            Self::CriticalTime => forms.critical_time(i),
            Self::LogCriticalForce => Ok(slips.critical_force[i].ln()),
            Self::ForceAngle => Ok(slips.lateral_force[i].atan2(slips.normal_force[i])),
            Self::Indentation => forms.indentation(i),
            other => Ok(other.column(slips).map_or(f64::NAN, |column| column[i])),
        }
    }

    /// The value in SI units.
    fn of(self, critical: &Critical) -> Result<f64, Failure> {
        Ok(match self {
            Self::CriticalForce => critical.critical_force,
            Self::LateralForce => critical.lateral_force,
            Self::NormalForce => critical.normal_force,
            Self::CriticalTime => critical.critical_time?,
            Self::LogCriticalForce => critical.critical_force.ln(),
            Self::ForceAngle => critical.force_angle(),
            Self::ContactRadius => critical.contact_radius,
            Self::Indentation => critical.indentation,
        })
    }
}

/// The unit in which people give a parameter of the scene.
pub fn edge_unit(parameter: &Parameter) -> Unit {
    edge(match parameter.name {
        "length" | "width" | "thickness" | "height" | "tip_base_radius" => "um",
        "particle_radius" | "tip_radius" | "burgers_vector" | "equilibrium_separation" => "nm",
        "velocity" => "nm/s",
        "stribeck_velocity" => "mm/s",
        "contact_angle" | "preload_angle" => "deg",
        "shear_strength" => "MPa",
        _ if parameter.unit == "Pa" => "GPa",
        _ => parameter.unit,
    })
}

/// The parameters of the scene as inputs of the model.
pub(super) fn afm_inputs() -> Vec<Input> {
    Parameter::ALL.iter().map(afm_input).collect()
}

fn afm_input(parameter: &Parameter) -> Input {
    let unit = edge_unit(parameter);
    Input {
        name: parameter.name.to_owned(),
        symbol: parameter.symbol.to_owned(),
        nominal: unit.from_si((parameter.get)(&Scene::default())),
        unit,
        domain: Some(parameter.domain),
        distribution: None,
        description: parameter.description.to_owned(),
    }
}

/// Every output.
pub(super) fn afm_outputs() -> Vec<Output> {
    AfmOutput::ALL.iter().map(|output| output.info()).collect()
}

/// The choices of `[afm]`.
pub(super) fn afm_choices() -> Vec<Choice> {
    fn names<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> Vec<&'static str> {
        all.iter().map(|&choice| name(choice)).collect()
    }
    vec![
        ("friction", names(FrictionLaw::ALL, FrictionLaw::name)),
        ("contact", names(ContactTheory::ALL, ContactTheory::name)),
        ("fidelity", names(Fidelity::ALL, Fidelity::name)),
        ("torsion", names(Torsion::ALL, Torsion::name)),
        ("adhesion_in_load", vec!["false", "true"]),
        ("lugre_parameters (lugre at quasi-static and above)", names(LuGreParameters::ALL, LuGreParameters::name)),
        ("tolerance (quasi-static and above)", vec!["a number, 1e-6"]),
        ("step (fixed-step)", vec!["a time, \"10 ms\""]),
        ("step_budget (marched rungs)", vec!["a whole number, 1000000"]),
    ]
}

/// A unit written in this file, all of which are known: a test goes through them.
fn edge(symbol: &str) -> Unit {
    Unit::parse(symbol).unwrap_or_else(|_| Unit::dimensionless())
}

/// Beginning of the names of counters of rows that a rung of the ladder of fidelities answered.
pub const RUNGS: &str = "rungs.";
/// Name of the counter of evaluations of the right-hand side.
pub const EVALUATIONS: &str = "evaluations";
/// Name of the counter of the largest relative error estimate of any row.
pub const LARGEST_ERROR: &str = "largest_error_estimate";

/// Rows between two looks at whether the run is to end: rows of the finest fidelity take milliseconds.
const ROWS_BETWEEN_LOOKS: usize = 16;

/// A study's version of the nanoparticle model.
#[derive(Debug, Clone)]
pub struct AfmModel {
    scene: Scene,
    options: Options,
    factors: Vec<&'static Parameter>,
    outputs: Vec<Output>,
    which: Vec<AfmOutput>,
    flags: Vec<Flag>,
    /// Rows by rung, in the order of [`Fidelity::ALL`]; then [`EVALUATIONS`] and [`LARGEST_ERROR`].
    counters: Vec<Counter>,
}

impl AfmModel {
    /// The model of `scene` under `options` whose factors are `factors`, in the order of the space.
    pub fn new(scene: Scene, options: Options, factors: Vec<&'static Parameter>, which: Vec<AfmOutput>) -> Self {
        let outputs = which.iter().map(|output| output.info()).collect();
        let flags = afm::Flag::ALL
            .iter()
            .map(|f| Flag { name: f.name().into(), description: f.description().into(), warns: false })
            .collect();
        let counter = |name: String, kind| Counter { name: name.into(), kind };
        let rungs = Fidelity::ALL.iter().map(|rung| counter(format!("{RUNGS}{}", rung.name()), CounterKind::Sum));
        let cost = [(EVALUATIONS, CounterKind::Sum), (LARGEST_ERROR, CounterKind::Maximum)];
        let counters = rungs.chain(cost.map(|(name, kind)| counter(name.to_owned(), kind))).collect();
        Self { scene, options, factors, outputs, which, flags, counters }
    }
}

impl Model for AfmModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn flags(&self) -> &[Flag] {
        &self.flags
    }

    fn counters(&self) -> &[Counter] {
        &self.counters
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        let forms = ClosedForms::new(&self.scene, &self.options, &self.factors).map(Box::new);
        let scene = self.scene;
        Box::new(AfmWorker { model: self, context, scene, forms, reasons: Vec::new(), spent: Spent::default() })
    }
}

struct AfmWorker<'a> {
    model: &'a AfmModel,
    context: &'a RunContext<'a>,
    scene: Scene,
    /// Rows in closed form are computed many at once.
    forms: Option<Box<ClosedForms>>,
    /// The failures met so far, in words: there are few, and each is put into words once.
    reasons: Vec<(Failure, RowFailure)>,
    spent: Spent,
}

/// What was spent on the rows of a batch.
#[derive(Default)]
struct Spent {
    rungs: [u64; Fidelity::ALL.len()],
    evaluations: u64,
    largest_error: f64,
}

impl Worker for AfmWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        self.spent = Spent::default();
        let step = if self.forms.is_some() { AT_ONCE } else { ROWS_BETWEEN_LOOKS };
        for first in (0..batch.rows()).step_by(step) {
            if self.context.is_stopped() {
                batch.give_up(RowFailure::interrupted());
                break;
            }
            let rows = first..batch.rows().min(first + step);
            match self.forms.take() {
                Some(forms) => self.forms = Some(self.run_at_once(forms, inputs, rows, batch)),
                None => rows.for_each(|row| self.run_row(inputs, row, batch)),
            }
        }
        let Spent { rungs, evaluations, largest_error } = &self.spent;
        for (counter, rows) in rungs.iter().chain([evaluations]).enumerate() {
            batch.count(counter, *rows as f64);
        }
        batch.count(rungs.len() + 1, *largest_error);
    }
}

impl AfmWorker<'_> {
    fn run_row(&mut self, inputs: &[&[f64]], row: usize, batch: &mut Batch) {
        for (parameter, column) in self.model.factors.iter().zip(inputs) {
            (parameter.set)(&mut self.scene, column[row]);
        }
        match critical_force(&self.scene, &self.model.options) {
            Err(failure) => batch.fail_row(row, &self.reason(failure)),
            Ok(critical) => self.write(row, &critical, batch),
        }
    }

    fn run_at_once(
        &mut self,
        mut forms: Box<ClosedForms>,
        inputs: &[&[f64]],
        rows: Range<usize>,
        batch: &mut Batch,
    ) -> Box<ClosedForms> {
        let columns = self.model.factors.iter().zip(inputs);
        let are_set = columns.fold(true, |all, (parameter, column)| all & forms.set(parameter, &column[rows.clone()]));
        forms.solve();
        if !are_set || !forms.are_ordinary(rows.len()) {
            rows.for_each(|row| self.run_row(inputs, row, batch));
            return forms;
        }
        for (column, output) in self.model.which.iter().enumerate() {
            if let Some(values) = output.column(forms.slips()) {
                batch.column_mut(column)[rows.clone()].copy_from_slice(&values[..rows.len()]);
                continue;
            }
            for (i, row) in rows.clone().enumerate() {
                match output.of_many(i, &forms) {
                    Ok(value) => batch.set(row, column, value),
                    Err(failure) => batch.fail(row, column, self.reason(failure)),
                }
            }
        }
        let slips = forms.slips();
        self.spent.rungs[Fidelity::ClosedForm as usize] += rows.len() as u64;
        self.spent.evaluations += rows.len() as u64;
        self.spent.largest_error =
            slips.error_estimate[..rows.len()].iter().fold(self.spent.largest_error, |a, b| a.max(*b));
        forms.count_flags(rows.len(), |flag, raised| batch.raise_by(flag, raised));
        forms
    }

    fn reason(&mut self, failure: Failure) -> RowFailure {
        if let Some((_, reason)) = self.reasons.iter().find(|(known, _)| *known == failure) {
            return reason.clone();
        }
        let reason = RowFailure::new(&failure.to_string());
        self.reasons.push((failure, reason.clone()));
        reason
    }

    fn write(&mut self, row: usize, critical: &Critical, batch: &mut Batch) {
        let model = self.model;
        for (column, output) in model.which.iter().enumerate() {
            match output.of(critical) {
                Ok(value) => batch.set(row, column, value),
                Err(failure) => batch.fail(row, column, self.reason(failure)),
            }
        }
        // `Fidelity::ALL` is in the order of the declaration.
        self.spent.rungs[critical.rung as usize] += 1;
        self.spent.evaluations += critical.cost.evaluations;
        self.spent.largest_error = self.spent.largest_error.max(critical.error_estimate);
        if !critical.flags.is_empty() {
            for (number, &flag) in afm::Flag::ALL.iter().enumerate() {
                if critical.flags.contains(flag) {
                    batch.raise(number);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edge_unit_is_known_and_of_the_right_kind() {
        for parameter in Parameter::ALL {
            let si = Unit::parse(parameter.unit).unwrap();
            assert!(edge_unit(parameter).compatible(&si), "{}", parameter.name);
        }
        for output in AfmOutput::ALL {
            assert!(Unit::parse(output.row().1).is_ok());
        }
    }

    /// One bad row among many: it fails with its reason, and costs the others not a bit.
    #[test]
    fn rows_are_the_same_in_any_company() {
        let outputs = AfmOutput::ALL.to_vec();
        let factors = ["length", "velocity"].map(|name| Parameter::from_name(name).unwrap());
        let model = AfmModel::new(Scene::default(), Options::default(), factors.to_vec(), outputs);
        let run = |length: &[f64], velocity: &[f64]| {
            let mut batch = Batch::new(&model);
            batch.reset(length.len());
            model.worker(&RunContext::default()).run(&[length, velocity], &mut batch);
            batch.settle();
            batch
        };
        let lengths: Vec<f64> = (0..150).map(|i| 200e-6 + 1e-6 * f64::from(i)).collect();
        let velocities: Vec<f64> = (0..150).map(|i| 1e-9 * f64::from(i)).collect();
        let mut broken = lengths.clone();
        broken[100] = -1.0;
        let (whole, other) = (run(&lengths, &velocities), run(&broken, &velocities));
        for output in 0..AfmOutput::ALL.len() {
            for row in 0..150 {
                let alone = run(&lengths[row..=row], &velocities[row..=row]);
                let same = |batch: &Batch| batch.column(output)[row].to_bits() == alone.column(output)[0].to_bits();
                assert!(same(&whole) && (row == 100 || same(&other)), "{output} {row}");
            }
        }
        assert_eq!(whole.failures().len(), 1, "the time at rest");
        assert_eq!(other.failures().len(), 1 + AfmOutput::ALL.len());
        assert_eq!((whole.flags()[3], other.flags()[3]), (150, 149));
    }

    #[test]
    fn still_substrate_fails_in_time_alone() {
        let outputs = vec![AfmOutput::CriticalForce, AfmOutput::CriticalTime];
        let velocity = Parameter::from_name("velocity").unwrap();
        let model = AfmModel::new(Scene::default(), Options::default(), vec![velocity], outputs);
        let mut batch = Batch::new(&model);
        batch.reset(2);
        model.worker(&RunContext::default()).run(&[&[100e-9, 0.0]], &mut batch);
        batch.settle();
        assert_eq!(batch.column(0)[0], batch.column(0)[1]);
        assert!(batch.column(1)[0] > 0.0);
        assert_eq!(batch.failures(), [(1, 1, RowFailure::new(&Failure::VelocityZero.to_string()))]);
    }
}
