//! `model = "expression"`: formulas of the factors, one for each output, and constants.

use std::ops::Range;

use apportion::model::{Expression, ExpressionProblem, Input, Symbol};
use apportion::space::Space;
use apportion::study::did_you_mean;
use apportion_base::names::nearest;
use apportion_base::quantity::{Quantity, Unit};
use toml::Value;

use super::at::{At, Choices, ListOrTable, in_order};
use super::context::{Context, Fault, number, shown};
use super::distribution::own_inputs;
use super::error::Problem;
use super::outputs::OutputTable;
use super::sections::{ExpressionSection, FactorSection, Outputs};
use super::subjects::{ExpressionConstant, ExpressionSubject, Formula};

/// Returns the inputs of formulas: the factors of the study, each in its own unit.
pub fn inputs(context: &Context<'_>, factors: &[At<FactorSection>]) -> Result<Vec<Input>, Fault> {
    factors.iter().try_for_each(|section| refuse_name(context, "factor", &section.get_ref().name))?;
    own_inputs(context, factors)
}

fn refuse_name(context: &Context<'_>, what: &'static str, name: &At<String>) -> Result<(), Fault> {
    let reason = match name.get_ref() {
        name if !Expression::is_name(name) => "letters, digits and '_', not beginning with a digit (formulas use it)",
        name if Expression::is_reserved(name) => "not a function or number of the formula language",
        _ => return Ok(()),
    };
    let (key, found) = (format!("name of a {what}"), format!("{:?}", name.get_ref()));
    context.refuse(name, &key, reason, found)
}

/// Returns the formulas with their constants, and notes on unused names.
pub(super) fn subject(
    context: &Context<'_>,
    outputs: Option<&At<Outputs>>,
    section: Option<&At<ExpressionSection>>,
    space: &Space,
) -> Result<(ExpressionSubject, Vec<String>), Fault> {
    let missing = Problem::missing("formula", "outputs.y = \"x1 + 2*x2\", above the first table");
    let Some(outputs) = outputs else { return Err(context.fault(0..0, missing)) };
    let entries = match outputs.get_ref() {
        ListOrTable::Table(table) if !table.is_empty() => in_order(table),
        _ => return Err(context.fault(outputs.span(), missing)),
    };
    let none = Choices::new();
    let table = section.map_or(&none, |section| &section.get_ref().constants);
    let constants = constants(context, table, space)?;
    let formula = |(name, value)| formula(context, name, value, space, &constants);
    let formulas = entries.into_iter().map(formula).collect::<Result<Vec<Formula>, Fault>>()?;
    let notes = notes(&formulas, table, space);
    Ok((ExpressionSubject { formulas, constants }, notes))
}

fn constants(context: &Context<'_>, table: &Choices, space: &Space) -> Result<Vec<ExpressionConstant>, Fault> {
    let mut constants = Vec::with_capacity(table.len());
    for (name, value) in in_order(table) {
        refuse_name(context, "constant", name)?;
        if space.factors().iter().any(|factor| factor.name == *name.get_ref()) {
            let problem =
                Problem::Repeated { what: "name of a factor and of a constant", name: name.get_ref().clone() };
            return Err(context.fault(name.span(), problem));
        }
        let quantity = match value.get_ref() {
            Value::String(text) => Some(context.at(value, Quantity::parse(text))?),
            other => number(other).map(|value| Quantity { value, unit: Unit::dimensionless() }),
        };
        let key = name.get_ref();
        let Some(quantity) = quantity.filter(|quantity| quantity.to_si().is_finite()) else {
            let expected = format!("a finite number or a quantity, as in {key} = 7 or {key} = \"169 GPa\"");
            return context.refuse(value, key, &expected, value.get_ref().to_string());
        };
        constants.push(ExpressionConstant { name: key.clone(), quantity });
    }
    Ok(constants)
}

fn formula(
    context: &Context<'_>,
    name: &At<String>,
    value: &At<Value>,
    space: &Space,
    constants: &[ExpressionConstant],
) -> Result<Formula, Fault> {
    let refused = |found: &str| {
        let expected = "a formula, or { formula = \"...\", unit = \"...\" }";
        context.refuse(value, name.get_ref(), expected, found.to_owned())
    };
    let table = match value.get_ref() {
        Value::String(text) => OutputTable { formula: Some(text.clone()), ..OutputTable::default() },
        Value::Table(typed) => OutputTable::read(context, value, typed)?,
        other => return refused(&shown(other)),
    };
    let OutputTable { formula: Some(text), unit, .. } = &table else {
        return refused("a table without a formula");
    };
    if table != (OutputTable { formula: Some(text.clone()), unit: unit.clone(), ..OutputTable::default() }) {
        return refused("a table with keys for programs");
    }
    let unit = context.at(value, Unit::parse(unit.as_deref().unwrap_or("1")))?;
    let symbol = |name: &str| {
        let factor = space.factors().iter().position(|factor| factor.name == name).map(Symbol::Input);
        let constant = || constants.iter().find(|constant| constant.name == name);
        factor.or_else(|| constant().map(|constant| Symbol::Number(constant.quantity.to_si())))
    };
    let expression = Expression::parse(text, &symbol).map_err(|error| {
        let known = || space.factors().iter().map(|f| f.name.as_str()).chain(constants.iter().map(|c| c.name.as_str()));
        let functions = Expression::vocabulary();
        let (near, help) = match &error.problem {
            ExpressionProblem::UnknownName(name) => {
                let known_names = known().collect::<Vec<_>>().join(", ");
                (nearest(name, known()), Some(format!("factors and constants: {known_names}")))
            }
            ExpressionProblem::UnknownFunction(name) => {
                (nearest(name, functions.iter().copied()), Some(format!("functions: {}", functions.join(", "))))
            }
            _ => (None, None),
        };
        let span = place(context, value, text, error.place.clone());
        context.fault(span, Problem::Refused { message: format!("{error}{}", did_you_mean(&near)), help })
    })?;
    Ok(Formula { name: name.get_ref().clone(), unit, expression })
}

/// Returns the position of a part of a formula in the file: exactly, unless the text is written with escapes.
fn place(context: &Context<'_>, value: &At<Value>, formula: &str, part: Range<usize>) -> Range<usize> {
    let whole = value.span();
    match context.text.get(whole.clone()).and_then(|written| written.find(formula)) {
        Some(offset) => {
            let start = whole.start + offset;
            start + part.start..start + part.end
        }
        None => whole,
    }
}

/// Returns notes on factors and constants that no formula uses.
fn notes(formulas: &[Formula], constants: &Choices, space: &Space) -> Vec<String> {
    let unused = |number: &usize| formulas.iter().all(|formula| !formula.expression.uses(*number));
    let factors = (0..space.factors().len()).filter(unused).map(|number| &space.factors()[number].name);
    let is_used = |name: &str| {
        let words = |text: &str| text.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
        formulas.iter().any(|formula| words(formula.expression.text()))
    };
    let constants = constants.keys().map(At::get_ref).filter(|name| !is_used(name));
    let note = |(what, name): (&str, &String)| format!("{what} `{name}` is used in no formula");
    factors.map(|name| note(("factor", name))).chain(constants.map(|name| note(("constant", name)))).collect()
}
