//! The critical pushing force of a nanoparticle as a model: the adapter between factors and [`critical_force`].

mod history;
mod output;

use std::ops::Range;

use apportion::model::{
    Batch, Choice, Counter, CounterKind, Flag, Input, Model, Output, OutputSeries, RowFailure, RunContext, Worker,
};
use apportion_base::quantity::Unit;
use history::Histories;
pub use history::{AfmHistory, AfmMoments};
pub use output::AfmOutput;
use output::edge;

use crate::force::{AT_ONCE, ClosedForms};
use crate::{
    ContactTheory, Critical, Failure, Fidelity, FrictionLaw, LuGreParameters, Options, Parameter, Scene, Torsion,
    critical_force,
};

/// Returns the unit for a parameter of the scene in study files and reports.
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

/// Returns the parameters of the scene as inputs of the model.
pub fn afm_inputs() -> Vec<Input> {
    let inputs = Parameter::ALL.iter().map(|parameter| {
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
    });
    inputs.collect()
}

/// Returns every output, then every history.
pub fn afm_outputs() -> Vec<Output> {
    let outputs = AfmOutput::ALL.iter().map(|output| output.info());
    outputs.chain(AfmHistory::ALL.iter().map(|history| history.info())).collect()
}

/// Returns the choices of `[afm]`.
pub fn afm_choices() -> Vec<Choice> {
    let lugre_parameters = LuGreParameters::ALL.map(LuGreParameters::name).to_vec();
    let choices = [
        ("friction", "", FrictionLaw::ALL.map(FrictionLaw::name).to_vec()),
        ("contact", "", ContactTheory::ALL.map(ContactTheory::name).to_vec()),
        ("fidelity", "", Fidelity::ALL.map(Fidelity::name).to_vec()),
        ("torsion", "", Torsion::ALL.map(Torsion::name).to_vec()),
        ("adhesion_in_load", "", vec!["false", "true"]),
        ("lugre_parameters", "lugre at quasi-static and above", lugre_parameters),
        ("tolerance", "quasi-static and above", vec!["a number, 1e-6"]),
        ("step", "fixed-step", vec!["a time, \"10 ms\""]),
        ("step_budget", "marched rungs", vec!["a whole number, 1000000"]),
        ("history", "of the outputs NAME_history", vec!["a table, { duration = \"0.4 s\", points = 40 }"]),
    ];
    choices.into_iter().map(|(key, scope, values)| Choice { key, scope, values }).collect()
}

/// Number of rows between two checks whether the run must stop: rows of the finest fidelity take milliseconds.
const ROWS_BETWEEN_LOOKS: usize = 16;

/// The nanoparticle model of a study.
#[derive(Debug, Clone)]
pub struct AfmModel {
    scene: Scene,
    options: Options,
    factors: Vec<&'static Parameter>,
    outputs: Vec<Output>,
    which: Vec<AfmOutput>,
    /// Series, whose values come after the outputs in `which`.
    histories: Histories,
    flags: Vec<Flag>,
    /// Numbers of rows by rung, in the order of [`Fidelity::ALL`]; then [`Counter::EVALUATIONS`] and [`Counter::LARGEST_ERROR`].
    counters: Vec<Counter>,
}

impl AfmModel {
    /// Creates the model of `scene` under `options` with the factors `factors`, in the order of the space. Its error
    /// estimates include the critical time if that is one of the outputs.
    pub fn new(scene: Scene, options: Options, factors: Vec<&'static Parameter>, which: Vec<AfmOutput>) -> Self {
        let accurate_time = options.accurate_time || which.contains(&AfmOutput::CriticalTime);
        let options = Options { accurate_time, ..options };
        let outputs = which.iter().map(|output| output.info()).collect();
        let flags = crate::Flag::ALL
            .iter()
            .map(|f| Flag { name: f.name().into(), description: f.description().into(), warns: false })
            .collect();
        let rungs = Fidelity::ALL.iter().map(|rung| (format!("{}{}", Counter::RUNGS, rung.name()), CounterKind::Sum));
        let cost = [
            (Counter::EVALUATIONS.to_owned(), CounterKind::Sum),
            (Counter::LARGEST_ERROR.to_owned(), CounterKind::Maximum),
        ];
        let counters = rungs.chain(cost).map(|(name, kind)| Counter { name: name.into(), kind }).collect();
        Self { scene, options, factors, outputs, which, histories: Histories::default(), flags, counters }
    }

    /// Adds to the flag of the Tabor parameter what a suitable contact theory would change at the point `nominal`.
    #[must_use]
    pub fn with_nominal(mut self, nominal: &Scene) -> Self {
        let [suited, chosen] = [ContactTheory::Auto, self.options.contact].map(|contact| {
            let options = Options { contact, fidelity: Fidelity::ClosedForm, ..self.options };
            critical_force(nominal, &options).ok().map(|critical| critical.critical_force)
        });
        let change = suited.zip(chosen).map(|(suited, chosen)| suited / chosen - 1.0);
        let flag = self.flags.iter_mut().find(|flag| flag.name == crate::Flag::TaborOutOfRange.name());
        if let (Some(change), Some(flag)) = (change.filter(|change| change.is_finite() && *change != 0.0), flag) {
            flag.description.to_mut().push_str(&format!(
                " The one that suits it (contact = \"auto\") changes the critical force at the nominal point by {:+.1} %.",
                100.0 * change
            ));
        }
        self
    }

    /// Adds these histories after the outputs, each a series of values at `moments`.
    #[must_use]
    pub fn with_histories(self, which: &[AfmHistory], moments: &AfmMoments) -> Self {
        let first = self.outputs.len();
        let histories = Histories::new(which, moments, first);
        let outputs = self.outputs.into_iter().chain(histories.outputs()).collect();
        Self { outputs, histories, ..self }
    }
}

impl Model for AfmModel {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn series(&self) -> &[OutputSeries] {
        self.histories.series()
    }

    fn flags(&self) -> &[Flag] {
        &self.flags
    }

    fn counters(&self) -> &[Counter] {
        &self.counters
    }

    /// Returns whether the equations of motion are integrated.
    fn is_slow(&self) -> bool {
        matches!(self.options.fidelity, Fidelity::Dynamic | Fidelity::FixedStep)
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        let forms = ClosedForms::new(&self.scene, &self.options, &self.factors).map(Box::new);
        let scene = self.scene;
        Box::new(AfmWorker { model: self, context, scene, forms })
    }
}

struct AfmWorker<'a> {
    model: &'a AfmModel,
    context: &'a RunContext<'a>,
    scene: Scene,
    /// Computes many rows in closed form at once.
    forms: Option<Box<ClosedForms>>,
}

impl Worker for AfmWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let is_quick = self.forms.is_some() && self.model.histories.is_empty();
        let step = if is_quick { AT_ONCE } else { ROWS_BETWEEN_LOOKS };
        for first in (0..batch.rows()).step_by(step) {
            if self.context.is_stopped() {
                batch.give_up(RowFailure::interrupted());
                break;
            }
            let rows = first..batch.rows().min(first + step);
            match self.forms.take() {
                Some(forms) => self.forms = Some(self.run_at_once(forms, inputs, rows.clone(), batch)),
                None => rows.clone().for_each(|row| self.run_row(inputs, row, batch)),
            }
            if !self.model.histories.is_empty() {
                rows.for_each(|row| self.run_histories(inputs, row, batch));
            }
        }
    }
}

impl AfmWorker<'_> {
    fn set_scene(&mut self, inputs: &[&[f64]], row: usize) {
        for (parameter, column) in self.model.factors.iter().zip(inputs) {
            (parameter.set)(&mut self.scene, column[row]);
        }
    }

    fn run_row(&mut self, inputs: &[&[f64]], row: usize, batch: &mut Batch) {
        self.set_scene(inputs, row);
        match critical_force(&self.scene, &self.model.options) {
            Err(failure) => {
                let reason = reason(failure);
                for column in 0..self.model.which.len() {
                    batch.fail(row, column, reason.clone());
                }
            }
            Ok(critical) => self.write(row, &critical, batch),
        }
    }

    fn run_histories(&mut self, inputs: &[&[f64]], row: usize, batch: &mut Batch) {
        self.set_scene(inputs, row);
        let model = self.model;
        if let Err(failure) = model.histories.write(&self.scene, &model.options, row, batch) {
            let reason = reason(failure);
            model.histories.columns().for_each(|column| batch.fail(row, column, reason.clone()));
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
                    Err(failure) => batch.fail(row, column, reason(failure)),
                }
            }
        }
        let slips = forms.slips();
        let largest_error = slips.error_estimate[..rows.len()].iter().fold(0.0_f64, |a, b| a.max(*b));
        count(batch, Fidelity::ClosedForm, rows.len() as u64, rows.len() as u64, largest_error);
        forms.count_flags(rows.len(), |flag, raised| batch.raise_by(flag, raised));
        forms
    }

    fn write(&self, row: usize, critical: &Critical, batch: &mut Batch) {
        let model = self.model;
        for (column, output) in model.which.iter().enumerate() {
            match output.value(critical) {
                Ok(value) => batch.set(row, column, value),
                Err(failure) => batch.fail(row, column, reason(failure)),
            }
        }
        count(batch, critical.rung, 1, critical.evaluations, critical.error_estimate);
        // `Flag::ALL` is in the order of the declaration.
        critical.flags.iter().for_each(|flag| batch.raise_by(flag as usize, 1));
    }
}

fn reason(failure: Failure) -> RowFailure {
    RowFailure::new(&failure.to_string())
}

/// Adds rows of one rung to the counters of the model, with all of their evaluations and their largest error.
fn count(batch: &mut Batch, rung: Fidelity, rows: u64, evaluations: u64, largest_error: f64) {
    // `Fidelity::ALL` is in the order of the declaration.
    batch.count(rung as usize, rows as f64);
    batch.count(Fidelity::ALL.len(), evaluations as f64);
    batch.count(Fidelity::ALL.len() + 1, largest_error);
}

#[cfg(test)]
#[path = "tests/model.rs"]
mod tests;
