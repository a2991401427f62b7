//! Parameters of functions, such as the `a` of Sobol' G.

use std::fmt;

use thiserror::Error;

/// Maximum number of inputs of a function whose number of inputs can be chosen.
pub const MAX_INPUTS: usize = 4096;

/// A parameter that a function takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ParameterInfo {
    /// The key in `[function]`.
    pub name: &'static str,
    /// Its meaning, and its allowed values.
    pub description: &'static str,
}

/// The number of inputs, for functions that take lists.
pub(super) const DIMENSION: ParameterInfo =
    ParameterInfo { name: "dimension", description: "number of inputs, if no list gives it" };

/// A parameter's value.
#[derive(Debug, Clone, PartialEq)]
pub enum ParameterValue {
    /// One number, for all inputs alike if the parameter has one per input.
    Number(f64),
    /// One number per input.
    List(Vec<f64>),
}

/// As TOML.
impl fmt::Display for ParameterValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::List(list) => {
                let entries: Vec<String> = list.iter().map(f64::to_string).collect();
                write!(f, "[{}]", entries.join(", "))
            }
        }
    }
}

/// Why a function cannot be built: an unknown parameter, or an invalid value.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{problem}")]
pub struct ParameterError {
    /// The parameter.
    pub parameter: String,
    /// What is wrong, and what is allowed.
    pub problem: String,
}

impl ParameterError {
    /// Returns the error for an unknown parameter.
    pub fn unknown(parameter: &str) -> Self {
        Self { parameter: parameter.to_owned(), problem: format!("the function has no parameter `{parameter}`") }
    }

    /// Returns the error for a value outside the range of the parameter, described by `must`.
    pub(super) fn out_of_range(parameter: &str, value: f64, must: &str) -> Self {
        refused(parameter, format!("must be {must}, not {value}"))
    }
}

fn refused(parameter: &str, problem: String) -> ParameterError {
    ParameterError { parameter: parameter.to_owned(), problem: format!("`{parameter}` {problem}") }
}

/// A range of values, with its description.
pub(super) type Range = (fn(f64) -> bool, &'static str);

pub(super) const FINITE: Range = (f64::is_finite, "a finite number");
pub(super) const NOT_NEGATIVE: Range = (|x| (0.0..f64::INFINITY).contains(&x), "0 or greater");
pub(super) const POSITIVE: Range = (|x| x > 0.0 && x < f64::INFINITY, "greater than 0");
pub(super) const PORTION: Range = (|x| (0.0..=1.0).contains(&x), "between 0 and 1");
const INPUTS: Range = (|x| (1.0..=MAX_INPUTS as f64).contains(&x) && x.fract() == 0.0, "a whole number from 1 to 4096");

/// A parameter with one number per input: its name, its default for the first inputs (the last entry also applies to
/// all that follow), and its range.
pub(super) type PerInput<'a> = (&'static str, &'a [f64], Range);

/// The given parameters, read by the functions.
pub(super) struct ParameterReader<'a> {
    given: &'a [(String, ParameterValue)],
    /// Those read so far, given or default.
    pub in_force: Vec<(&'static str, ParameterValue)>,
}

impl<'a> ParameterReader<'a> {
    pub(super) fn new(parameters: &'a [(String, ParameterValue)]) -> Self {
        Self { given: parameters, in_force: Vec::new() }
    }

    fn get(&self, name: &str) -> Option<&ParameterValue> {
        self.given.iter().find(|(given, _)| given == name).map(|(_, value)| value)
    }

    fn one_number(&self, parameter: &'static str, default: f64, range: Range) -> Result<f64, ParameterError> {
        match self.get(parameter) {
            None => Ok(default),
            Some(ParameterValue::Number(value)) => within(parameter, *value, range),
            Some(ParameterValue::List(_)) => Err(refused(parameter, "must be one number, not a list".to_owned())),
        }
    }

    /// Reads one number.
    pub(super) fn number(
        &mut self,
        parameter: &'static str,
        default: f64,
        range: Range,
    ) -> Result<f64, ParameterError> {
        let value = self.one_number(parameter, default, range)?;
        self.in_force.push((parameter, ParameterValue::Number(value)));
        Ok(value)
    }

    /// Reads only the parameter `dimension`.
    pub(super) fn dimension(&mut self, default: usize, range: Range) -> Result<usize, ParameterError> {
        let value = within("dimension", self.number("dimension", default as f64, range)?, INPUTS)?;
        // An integer up to 4096.
        Ok(value as usize)
    }

    /// Reads numbers per input, all of one length: `dimension`, else that of the first list, else of the default.
    pub(super) fn per_input<const N: usize>(
        &mut self,
        all: [PerInput<'_>; N],
    ) -> Result<[Vec<f64>; N], ParameterError> {
        let listed = all.iter().find_map(|(name, ..)| match self.get(name) {
            Some(ParameterValue::List(list)) => Some((*name, list.len())),
            _ => None,
        });
        let inputs = match (self.get("dimension"), listed) {
            (None, Some((_, entries))) if (1..=MAX_INPUTS).contains(&entries) => entries,
            (None, Some((parameter, entries))) => {
                return Err(refused(parameter, format!("has {entries} entries, but must have 1 to {MAX_INPUTS}")));
            }
            _ => self.one_number("dimension", all[0].1.len() as f64, INPUTS)? as usize,
        };
        let mut columns = [const { Vec::new() }; N];
        for (column, (parameter, default, range)) in columns.iter_mut().zip(all) {
            *column = match self.get(parameter) {
                None => (0..inputs).map(|i| default[i.min(default.len() - 1)]).collect(),
                Some(ParameterValue::Number(value)) => vec![within(parameter, *value, range)?; inputs],
                Some(ParameterValue::List(list)) if list.len() != inputs => {
                    let entries = list.len();
                    return Err(refused(
                        parameter,
                        format!("has {entries} entries, but the function has {inputs} inputs"),
                    ));
                }
                Some(ParameterValue::List(list)) => {
                    list.iter().map(|&value| within(parameter, value, range)).collect::<Result<_, _>>()?
                }
            };
            self.in_force.push((parameter, ParameterValue::List(column.clone())));
        }
        Ok(columns)
    }
}

fn within(parameter: &'static str, value: f64, (contains, must): Range) -> Result<f64, ParameterError> {
    if contains(value) { Ok(value) } else { Err(ParameterError::out_of_range(parameter, value, must)) }
}
