//! `model = "expression"`: formulas of the factors, one for each output, and constants.

use std::ops::Range;
use std::sync::Arc;

use apportion::model::{Expression, ExpressionProblem, Input, Symbol};
use apportion::space::Space;
use apportion_base::names::did_you_mean;
use apportion_base::names::nearest;
use apportion_base::quantity::{Quantity, Unit};
use toml::Value;

use super::at::{At, Choices, in_order};
use super::context::{Context, Fault, number, shown};
use super::error::Problem;
use super::output_table::{OutputTable, Outputs};
use super::outputs::output_table;
use super::reading::{Configured, Reading};
use super::subjects::{ExpressionConstant, ExpressionSubject, Formula};
use super::units::factor_inputs;

/// Returns the inputs of formulas: the factors of the study, each in its own unit.
pub(super) fn inputs(reading: &Reading) -> Result<Vec<Input>, Fault> {
    for section in &reading.file.factor {
        refuse_name(&reading.context, "factor", &section.get_ref().name)?;
    }
    factor_inputs(reading)
}

fn refuse_name(context: &Context, what: &'static str, name: &At<String>) -> Result<(), Fault> {
    let reason = match name.get_ref() {
        name if !Expression::is_name(name) => "letters, digits and '_', not beginning with a digit (formulas use it)",
        name if Expression::is_reserved(name) => "not a function or number of the formula language",
        _ => return Ok(()),
    };
    context.refuse(name, &format!("name of a {what}"), reason, format!("{:?}", name.get_ref()))
}

/// Returns the formulas with their constants, and notes on unused names.
pub(super) fn subject(Reading { context, file, .. }: &Reading, space: &Space) -> Configured {
    let missing = Problem::missing("formula", "outputs.y = \"x1 + 2*x2\", above the first table");
    let Some(outputs) = &file.outputs else { return Err(context.fault(0..0, missing)) };
    let entries = match outputs.get_ref() {
        Outputs::Table(table) if !table.is_empty() => in_order(table),
        _ => return Err(context.fault(outputs.span(), missing)),
    };
    let none = Choices::new();
    let table = file.expression.as_ref().map_or(&none, |section| &section.get_ref().constants);
    let constants = constants(context, table, space)?;
    let mut formulas = Vec::with_capacity(entries.len());
    for (name, value) in entries {
        formulas.push(formula(context, name, value, space, &constants)?);
    }
    let notes = notes(&formulas, table, space);
    Ok((Arc::new(ExpressionSubject { formulas, constants }), notes))
}

fn constants(context: &Context, table: &Choices, space: &Space) -> Result<Vec<ExpressionConstant>, Fault> {
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
            return context.refuse(value, key, &expected, value.get_ref());
        };
        constants.push(ExpressionConstant { name: key.clone(), quantity });
    }
    Ok(constants)
}

fn formula(
    context: &Context,
    name: &At<String>,
    value: &At<Value>,
    space: &Space,
    constants: &[ExpressionConstant],
) -> Result<Formula, Fault> {
    let table = match value.get_ref() {
        Value::String(text) => OutputTable { formula: Some(text.clone()), ..OutputTable::default() },
        Value::Table(typed) => output_table(context, value, typed)?,
        other => return refuse_formula(context, name, value, &shown(other)),
    };
    let OutputTable { formula: Some(text), unit, .. } = &table else {
        return refuse_formula(context, name, value, "a table without a formula");
    };
    if table != (OutputTable { formula: Some(text.clone()), unit: unit.clone(), ..OutputTable::default() }) {
        return refuse_formula(context, name, value, "a table with keys for programs");
    }
    let unit = context.at(value, Unit::parse(unit.as_deref().unwrap_or("1")))?;
    let factors = space.factors().iter().enumerate().map(|(number, f)| (f.name.as_str(), Symbol::Input(number)));
    let numbers = constants.iter().map(|c| (c.name.as_str(), Symbol::Number(c.quantity.to_si())));
    let symbols: Vec<(&str, Symbol)> = factors.chain(numbers).collect();
    let expression = Expression::parse(text, &|name| Some(symbols.iter().find(|(other, _)| *other == name)?.1));
    let expression = expression.map_err(|error| {
        let (near, help) = match &error.problem {
            ExpressionProblem::UnknownName(name) => {
                let valid: Vec<&str> = symbols.iter().map(|(name, _)| *name).collect();
                (nearest(name, valid.iter().copied()), Some(format!("factors and constants: {}", valid.join(", "))))
            }
            ExpressionProblem::UnknownFunction(name) => {
                let valid = Expression::vocabulary();
                (nearest(name, valid.iter().copied()), Some(format!("functions: {}", valid.join(", "))))
            }
            _ => (None, None),
        };
        let span = place(context, value, text, error.place.clone());
        context.fault(span, Problem::Refused { message: format!("{error}{}", did_you_mean(&near)), help })
    })?;
    Ok(Formula { name: name.get_ref().clone(), unit, expression })
}

fn refuse_formula<T>(context: &Context, name: &At<String>, value: &At<Value>, found: &str) -> Result<T, Fault> {
    context.refuse(value, name.get_ref(), "a formula, or { formula = \"...\", unit = \"...\" }", found)
}

/// Returns the position of a part of a formula in the file: exactly, unless the text is written with escapes.
fn place(context: &Context, value: &At<Value>, formula: &str, part: Range<usize>) -> Range<usize> {
    let span = value.span();
    match context.text.get(span.clone()).and_then(|written| written.find(formula)) {
        Some(offset) => {
            let start = span.start + offset;
            start + part.start..start + part.end
        }
        None => span,
    }
}

/// Returns notes on factors and constants that no formula uses.
fn notes(formulas: &[Formula], constants: &Choices, space: &Space) -> Vec<String> {
    let mut notes = Vec::new();
    for (number, factor) in space.factors().iter().enumerate() {
        if formulas.iter().all(|formula| !formula.expression.uses(number)) {
            notes.push(format!("factor `{}` is used in no formula", factor.name));
        }
    }
    for name in constants.keys().map(At::get_ref) {
        if formulas.iter().all(|formula| !has_word(formula.expression.text(), name)) {
            notes.push(format!("constant `{name}` is used in no formula"));
        }
    }
    notes
}

fn has_word(text: &str, name: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name)
}
