//! A formula as steps on a stack of columns.

use super::functions::{OfOne, OfTwo};
use crate::extended::{Bounded, Extended};

/// Rows computed at a time: a few columns of them stay in the nearest cache.
pub(super) const TILE: usize = 256;

/// A comparison of two numbers: 1 if it holds, 0 if not, NaN if one of them is NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

impl Comparison {
    fn holds(self, a: f64, b: f64) -> f64 {
        if a.is_nan() || b.is_nan() { f64::NAN } else { f64::from(self.is_true_of(a, b)) }
    }

    fn is_true_of<T: PartialOrd>(self, a: T, b: T) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessOrEqual => a <= b,
            Self::Greater => a > b,
            Self::GreaterOrEqual => a >= b,
            Self::Equal => a == b,
            Self::NotEqual => a != b,
        }
    }
}

/// One step: takes its operands from the stack and leaves its result there.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    Input(usize),
    Number(f64),
    Negate,
    /// A whole power, by multiplication.
    Power(i32),
    One(OfOne),
    Add,
    Subtract,
    Multiply,
    Divide,
    Raise,
    Compare(Comparison),
    Two(OfTwo),
    Select,
}

/// The steps of a formula, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    steps: Vec<Step>,
}

/// Columns of intermediate values, one after the other; kept from one tile to the next.
#[derive(Default)]
pub(super) struct Stack {
    columns: Vec<[f64; TILE]>,
}

impl Program {
    /// Adds a step. Steps on numbers alone are done at once: their result is a number.
    pub fn push(&mut self, step: Step) {
        self.steps.push(step);
        let operands = step.operands();
        let Some(first) = self.steps.len().checked_sub(operands + 1) else { return };
        let all_numbers = self.steps[first..first + operands].iter().all(|step| matches!(step, Step::Number(_)));
        if operands > 0 && all_numbers {
            let folded = Self { steps: self.steps.split_off(first) };
            let mut value = [f64::NAN];
            folded.run(&[], 0, &mut value, &mut Stack::default());
            self.steps.push(Step::Number(value[0]));
        }
    }

    /// The number that was pushed last, if it is one.
    pub fn last_number(&self) -> Option<f64> {
        match self.steps.last() {
            Some(Step::Number(number)) => Some(*number),
            _ => None,
        }
    }

    pub fn pop(&mut self) {
        self.steps.pop();
    }

    pub fn uses(&self, input: usize) -> bool {
        self.steps.iter().any(|step| matches!(step, Step::Input(number) if *number == input))
    }

    /// The numbers in it, by their bits.
    pub fn numbers(&self) -> Vec<u64> {
        self.steps
            .iter()
            .filter_map(|step| match step {
                Step::Number(number) => Some(number.to_bits()),
                _ => None,
            })
            .collect()
    }

    /// The values of up to [`TILE`] rows, those of `inputs` from row `first` on.
    pub fn run(&self, inputs: &[&[f64]], first: usize, values: &mut [f64], stack: &mut Stack) {
        let (columns, rows) = (&mut stack.columns, values.len());
        let mut depth = 0;
        for step in &self.steps {
            let operands = step.operands();
            let base = depth - operands;
            depth = base + 1;
            if columns.len() < depth {
                columns.push([0.0; TILE]);
            }
            let (below, above) = columns.split_at_mut(depth);
            let top = &mut below[base][..rows];
            match step {
                Step::Input(number) => top.copy_from_slice(&inputs[*number][first..first + rows]),
                Step::Number(number) => top.fill(*number),
                Step::Negate => top.iter_mut().for_each(|x| *x = -*x),
                Step::Power(2) => top.iter_mut().for_each(|x| *x *= *x),
                Step::Power(power) => top.iter_mut().for_each(|x| *x = x.powi(*power)),
                Step::One(OfOne { plain, .. }) => top.iter_mut().for_each(|x| *x = plain(*x)),
                Step::Add => with(top, &above[0], |a, b| a + b),
                Step::Subtract => with(top, &above[0], |a, b| a - b),
                Step::Multiply => with(top, &above[0], |a, b| a * b),
                Step::Divide => with(top, &above[0], |a, b| a / b),
                Step::Raise => with(top, &above[0], libm::pow),
                Step::Compare(comparison) => with(top, &above[0], |a, b| comparison.holds(a, b)),
                Step::Two(OfTwo { plain, .. }) => with(top, &above[0], plain),
                Step::Select => {
                    for ((condition, then), other) in top.iter_mut().zip(&above[0]).zip(&above[1]) {
                        *condition = match *condition {
                            c if c.is_nan() => f64::NAN,
                            0.0 => *other,
                            _ => *then,
                        };
                    }
                }
            }
        }
        if depth == 1 {
            values.copy_from_slice(&columns[0][..rows]);
        }
    }
}

impl Program {
    /// The value at one point in twice the precision of doubles, with a bound of what rounding may make of the value in
    /// doubles; `None` if a function is not to be had in that precision.
    pub fn bounded(&self, x: &[f64]) -> Option<Bounded> {
        let mut stack: Vec<Bounded> = Vec::new();
        for step in &self.steps {
            let operands = stack.split_off(stack.len() - step.operands());
            stack.push(match (step, &operands[..]) {
                (Step::Input(number), _) => x[*number].into(),
                (Step::Number(number), _) => (*number).into(),
                (Step::Negate, &[x]) => -x,
                (Step::Power(power), &[x]) => x.powi(*power),
                (Step::One(OfOne { bounded, .. }), &[x]) => (*bounded)?(x),
                (Step::Add, &[a, b]) => a + b,
                (Step::Subtract, &[a, b]) => a - b,
                (Step::Multiply, &[a, b]) => a * b,
                (Step::Divide, &[a, b]) => a / b,
                (Step::Raise, &[a, b]) => a.powf(b),
                (Step::Compare(comparison), &[a, b]) => {
                    let apart = Bounded { value: a.value - b.value, error: a.error + b.error };
                    apart.decides(comparison.is_true_of(a.value, b.value))
                }
                (Step::Two(OfTwo { bounded, .. }), &[a, b]) => bounded(a, b),
                (Step::Select, &[condition, then, other]) => {
                    let chosen = if condition.value.is_zero() { other } else { then };
                    let certain = condition.decides(true).error.is_zero();
                    if certain { chosen } else { Bounded { error: Extended::INFINITY, ..chosen } }
                }
                _ => return None,
            });
        }
        stack.pop()
    }
}

fn with(top: &mut [f64], other: &[f64; TILE], function: impl Fn(f64, f64) -> f64) {
    for (a, b) in top.iter_mut().zip(other) {
        *a = function(*a, *b);
    }
}

impl Step {
    fn operands(self) -> usize {
        match self {
            Self::Input(_) | Self::Number(_) => 0,
            Self::Negate | Self::Power(_) | Self::One(_) => 1,
            Self::Select => 3,
            _ => 2,
        }
    }
}
