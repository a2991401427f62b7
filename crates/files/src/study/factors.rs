//! The factors of a study: inputs of its model, each with its unit, distribution, nominal value and group.

use apportion::model::Input;
use apportion::space::{Distribution, Factor, Space};
use apportion_base::quantity::Unit;

use super::at::At;
use super::context::{Context, Fault, unknown_name};
use super::distribution;
use super::error::Problem;
use super::sections::FactorSection;
use super::units::{in_words_of_units, with_unit, wrong_unit};

/// Returns the space of the factors: by default all inputs with their own distributions, if each has one.
pub(super) fn space(context: &Context, inputs: &[Input], sections: &[At<FactorSection>]) -> Result<Space, Fault> {
    let mut factors = Vec::new();
    if sections.is_empty() {
        for input in inputs {
            let distribution = input.distribution.clone().ok_or_else(Problem::no_factors);
            let factor = distribution.and_then(|distribution| new_factor(input, input.unit.clone(), distribution));
            factors.push(factor.map_err(|problem| context.fault(0..0, problem))?);
        }
    }
    for section in sections {
        let name = &section.get_ref().name;
        let input = inputs
            .iter()
            .find(|input| input.name == *name.get_ref())
            .ok_or_else(|| unknown_name("factor", name.get_ref(), inputs.iter().map(|input| &*input.name)));
        factors.push(factor(context, section, context.at(name, input)?)?);
    }
    Ok(Space::new(factors))
}

/// Creates a factor with the default nominal value.
fn new_factor(input: &Input, unit: Unit, distribution: Distribution) -> Result<Factor, Problem> {
    let nominal = default_nominal(input, &unit, &distribution);
    let factor = Factor::new(&input.name, unit, distribution);
    let mut factor = factor.map_err(|error| distribution::refused(&input.name, &error))?;
    factor.nominal = nominal;
    Ok(factor)
}

fn factor(context: &Context, section: &At<FactorSection>, input: &Input) -> Result<Factor, Fault> {
    let fields = section.get_ref();
    let unit = unit_of_factor(context, fields, input)?;
    let distribution = match &input.distribution {
        Some(default) if fields.distribution.is_none() && fields.keys.is_empty() => {
            refuse_other_unit(context, fields, &unit, input)?;
            default.clone()
        }
        _ => distribution::of_factor(context, section)?,
    };
    let (low, high) = distribution.support();
    let lowest = if distribution.is_open_below() { low.next_up() } else { low };
    for (bound, reached, key) in [(low, lowest, "min"), (high, high, "max")] {
        // Unbounded distributions cover all values: their rare rows outside the domain fail by name and are counted.
        if bound.is_finite() && !is_in_domain(input, &unit, reached) {
            let span = fields.place(key).unwrap_or_else(|| fields.name.span());
            let reached = format!("its values reach {}", with_unit(bound, unit.symbol()));
            return Err(context.fault(span, outside_domain(input, &reached)));
        }
    }
    let mut nominal = None;
    if let Some(typed) = &fields.nominal {
        let value = distribution::nominal_value(&input.name, &distribution, typed.get_ref());
        let value = context.at(typed, value)?;
        if !value.is_finite() || !is_in_domain(input, &unit, value) {
            let nominal = format!("its nominal value is {}", with_unit(value, unit.symbol()));
            return Err(context.fault(typed.span(), outside_domain(input, &nominal)));
        }
        nominal = Some(value);
    }
    let mut factor = context.at(&fields.name, new_factor(input, unit, distribution))?;
    factor.nominal = nominal.unwrap_or(factor.nominal);
    factor.group = fields.group.as_ref().map(|group| group.get_ref().clone());
    factor.determined = distribution::is_determined(fields, factor.distribution());
    Ok(factor)
}

/// Returns whether the model accepts `value`, in `unit`, for the input.
fn is_in_domain(input: &Input, unit: &Unit, value: f64) -> bool {
    input.domain.is_none_or(|domain| domain.contains(unit.to_si(value)))
}

fn outside_domain(input: &Input, what: &str) -> Problem {
    let domain = input.domain.map_or_else(|| "a finite number".to_owned(), in_words_of_units);
    Problem::new(format!("factor `{}` must be {domain}, but {what}", input.name))
}

/// Returns the model's nominal value, or the middle of the distribution if that is not one of its values.
fn default_nominal(input: &Input, unit: &Unit, distribution: &Distribution) -> f64 {
    let (low, high) = distribution.support();
    let nominal = unit.from_si(input.unit.to_si(input.nominal));
    let fits = low <= nominal && nominal <= high && distribution::is_value(distribution, nominal);
    if fits { nominal } else { distribution.central() }
}

/// Returns the unit of a factor, which must be of the kind that the model requires.
fn unit_of_factor(context: &Context, fields: &FactorSection, input: &Input) -> Result<Unit, Fault> {
    let (name, example) = (format!("factor `{}`", input.name), format!("unit = \"{}\"", input.unit));
    let Some(typed) = &fields.unit else {
        if input.unit.compatible(&Unit::dimensionless()) {
            return Ok(Unit::dimensionless());
        }
        return Err(context.fault(fields.name.span(), wrong_unit(&name, &input.unit, None, &example)));
    };
    if input.unit.is_label() {
        return Ok(input.unit.clone());
    }
    let unit = context.at(typed, Unit::parse(typed.get_ref()))?;
    if !unit.compatible(&input.unit) {
        return Err(context.fault(typed.span(), wrong_unit(&name, &input.unit, Some(&unit), &example)));
    }
    Ok(unit)
}

/// Refuses a unit other than that of the input for the input's default distribution.
fn refuse_other_unit(context: &Context, fields: &FactorSection, unit: &Unit, input: &Input) -> Result<(), Fault> {
    match &fields.unit {
        Some(typed) if [0.0, 1.0].iter().any(|&x| unit.to_si(x) != input.unit.to_si(x)) => {
            let (factor, unit) = (&input.name, typed.get_ref());
            let problem = format!("factor `{factor}` has the function's own distribution, which is not in `{unit}`");
            let help = "remove the unit, or give a distribution";
            Err(context.fault(typed.span(), Problem::with_help(problem, help)))
        }
        _ => Ok(()),
    }
}
