//! Second calculation of the critical force: by another rung of the ladder of fidelities, and of the closed form by its
//! formula in 320 bits.

use apportion::model::{Expression, Symbol};
use apportion_afm::model::AfmOutput;
use apportion_afm::{
    ContactTheory, Critical, Failure, Fidelity, FrictionLaw, Options, Parameter, Scene, critical_force,
};

use super::judge::{Reference, Unchecked};
use super::precise::reference;

/// Relative deviation below which two rungs agree.
const FLOOR: f64 = 1e-6;
/// Maximum relative deviation of a correct force: the digits that results print.
const TOLERANCE: f64 = 1e-3;
/// Maximum number of steps of an integration: some milliseconds.
const STEPS: u64 = 2000;
/// The error estimates are of first order; higher orders may add this factor.
const HIGHER_ORDER: f64 = 1.5;
/// Why two rungs may differ.
const COVERED: &str = "the error estimate exceeds 0.1 %, and is confirmed: another rung differs by less";

/// Other calculations of the outputs of an [`AfmModel`](apportion_afm::model::AfmModel).
pub struct AfmSecond {
    scene: Scene,
    options: Options,
    factors: Vec<&'static Parameter>,
    which: Vec<AfmOutput>,
    /// For each output: its formula in closed form, if there is one.
    formulas: Vec<Option<Expression>>,
}

impl AfmSecond {
    pub fn new(scene: Scene, options: Options, factors: Vec<&'static Parameter>, which: Vec<AfmOutput>) -> Self {
        let formulas = which.iter().map(|output| formula(*output, &options)).collect();
        Self { scene, options, factors, which, formulas }
    }

    /// Returns the rungs that can check the current one, the most complete one first.
    fn rungs(&self) -> &'static [Fidelity] {
        match self.options.fidelity {
            Fidelity::Dynamic => &[Fidelity::QuasiStatic],
            _ => &[Fidelity::Dynamic, Fidelity::QuasiStatic],
        }
    }

    /// Returns what the outputs are computed by.
    pub fn name(&self) -> String {
        let rungs: Vec<&str> = self.rungs().iter().map(|rung| rung.name()).collect();
        let least = if rungs.len() > 1 { ", the one with the smaller stated error" } else { "" };
        let formula = if self.formulas.iter().any(Option::is_some) { "; and by its formula in 320 bits" } else { "" };
        format!("the rung {}{least}{formula}", rungs.join(" or "))
    }

    /// Computes every output at the point `x`, for a model with these values there and this relative error.
    pub fn calculate(
        &self,
        x: &[f64],
        values: &[Option<f64>],
        error_estimate: Option<f64>,
    ) -> Vec<Result<Reference, Unchecked>> {
        let mut scene = self.scene;
        for (parameter, &value) in self.factors.iter().zip(x) {
            (parameter.set)(&mut scene, value);
        }
        // The outputs of a rung share one error estimate, which includes that of the time.
        let shared = Options { step_budget: self.options.step_budget.min(STEPS), accurate_time: true, ..self.options };
        let rungs = self.rungs().iter().map(|&fidelity| critical_force(&scene, &Options { fidelity, ..shared }));
        // The one with the smaller stated error.
        let other = rungs.reduce(|one, other| match (&one, &other) {
            (Ok(first), Ok(second)) if first.error_estimate <= second.error_estimate => one,
            (Ok(_), Err(_)) => one,
            _ => other,
        });
        let other = other.unwrap_or(Err(Failure::StepBudget));
        let inputs: Vec<f64> = Parameter::ALL.iter().map(|parameter| (parameter.get)(&scene)).collect();
        let model_error = error_estimate.unwrap_or(1.0);
        let outputs = self.which.iter().zip(&self.formulas).zip(values);
        let checked = outputs.map(|((output, formula), value)| {
            let value = value.ok_or_else(|| Unchecked::NotAvailable("the model has no value".to_owned()))?;
            match formula.as_ref().map(|formula| reference(formula, &inputs)).transpose()? {
                Some(formula) if formula.agrees(value) != Some(true) => Ok(formula),
                _ => by_rung(*output, (value, model_error), &other),
            }
        });
        checked.collect()
    }
}

/// Computes an output by another rung, for a model with this value and stated relative error.
fn by_rung(
    output: AfmOutput,
    (model_value, model_error): (f64, f64),
    other: &Result<Critical, Failure>,
) -> Result<Reference, Unchecked> {
    let other = match other {
        Ok(other) => other,
        // Nothing slips, so the value of the model is not a force, unless its error estimate claims nothing.
        Err(failure @ (Failure::ProbeTips | Failure::BeyondPullOff)) if model_error < 1.0 => {
            return Err(Unchecked::NoValue(failure.to_string()));
        }
        Err(failure) => return Err(Unchecked::NotAvailable(failure.to_string())),
    };
    let value = output.value(other).map_err(|failure| Unchecked::NotAvailable(failure.to_string()))?;
    let relative = HIGHER_ORDER * (model_error + other.error_estimate);
    let absolute = HIGHER_ORDER * (model_error * model_value.abs() + other.error_estimate * value.abs());
    let (stated, covered) = match output {
        _ if model_error >= 1.0 || other.error_estimate >= 1.0 => {
            (Some(f64::INFINITY), "the error estimate is 100 %, so nothing is claimed")
        }
        AfmOutput::CriticalForce | AfmOutput::CriticalTime => (Some(absolute), COVERED),
        AfmOutput::LogCriticalForce => (Some(relative), COVERED),
        _ => (None, "another rung differs by more than 0.1 %, and no error of this output is stated"),
    };
    Ok(Reference { value, stated, tolerance: TOLERANCE, floor: FLOOR, covered })
}

/// Returns the closed formula of an output, in the parameters by their names; `None` if there is none.
fn formula(output: AfmOutput, options: &Options) -> Option<Expression> {
    if options.fidelity != Fidelity::ClosedForm {
        return None;
    }
    // In the order of the model, so that the bound of rounding applies to the model too.
    let normal =
        "(elastic_modulus*width*thickness/(4*length*length*length)*thickness*thickness*(length*sin(preload_angle)))";
    let pull = "(3*pi*adhesion*particle_radius)";
    let (radius, pull_off) = match options.contact {
        ContactTheory::Jkr => (
            format!(
                "cbrt(particle_radius/equivalent_modulus*({normal} + {pull} + sqrt(2*{pull}*{normal} + {pull}^2)))"
            ),
            format!("(0.5*{pull})"),
        ),
        ContactTheory::Dmt => (
            format!("cbrt(particle_radius/equivalent_modulus*({normal} + 2*pi*adhesion*particle_radius))"),
            "(2*pi*adhesion*particle_radius)".to_owned(),
        ),
        ContactTheory::Hertz => (format!("cbrt(particle_radius/equivalent_modulus*{normal})"), "0".to_owned()),
        _ => return None,
    };
    let load = if options.adhesion_in_load { format!("({normal} + {pull_off})") } else { normal.to_owned() };
    let lateral = match options.friction {
        FrictionLaw::Coulomb => format!("(static_friction*{load} + shear_strength*pi*{radius}^2)"),
        FrictionLaw::HurtadoKim => {
            let size = format!("({radius}/burgers_vector)");
            let slope = "(-(log10(1290/43)/log10(8e4/28)))";
            format!(
                "(pi*{radius}^2*(2*particle_shear_modulus*substrate_shear_modulus/(particle_shear_modulus + \
                 substrate_shear_modulus))*if({size} <= 28, 1/43, if({size} < 8e4, ({size}/28)^{slope}/43, 1/1290)))"
            )
        }
        FrictionLaw::LuGre => format!(
            "({load}*(dynamic_friction + (static_friction - dynamic_friction)*exp(-(velocity/stribeck_velocity)^2)) + \
             viscous_friction*velocity)"
        ),
        _ => return None,
    };
    let text = match output {
        AfmOutput::CriticalForce => format!("hypot({lateral}, {normal})"),
        AfmOutput::LogCriticalForce => format!("ln(hypot({lateral}, {normal}))"),
        AfmOutput::NormalForce => normal.to_owned(),
        AfmOutput::LateralForce => lateral,
        AfmOutput::ForceAngle => format!("atan2({lateral}, {normal})"),
        AfmOutput::ContactRadius => radius,
        // Bristles creep: their time is not a formula of the force alone.
        AfmOutput::CriticalTime
            if options.torsion == apportion_afm::Torsion::ThinStrip && options.friction != FrictionLaw::LuGre =>
        {
            format!(
                "{lateral}*(1/(elastic_modulus*width*thickness/(4*length*length*length)*width*width) + \
             height*height/(shear_modulus*(width*(thickness*thickness*thickness)/3)/length))/velocity"
            )
        }
        AfmOutput::CriticalTime | AfmOutput::Indentation => return None,
    };
    Expression::parse(&text, &|name| Parameter::ALL.iter().position(|p| p.name == name).map(Symbol::Input)).ok()
}
