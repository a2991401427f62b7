//! A formula as steps on a stack of columns.

/// Number of rows computed at a time: a few columns of them fit in the nearest cache.
pub const TILE: usize = 256;

/// A comparison of two numbers: 1 if it holds, 0 if not, NaN if one of them is NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
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

    pub fn is_true_of<T: PartialOrd>(self, a: T, b: T) -> bool {
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
pub enum Step {
    Input(usize),
    Number(f64),
    Negate,
    /// An integer power, by multiplication.
    Power(i32),
    /// A function of one argument, with its name.
    One(&'static str, fn(f64) -> f64),
    Add,
    Subtract,
    Multiply,
    Divide,
    Raise,
    Compare(Comparison),
    /// A function of two arguments, with its name.
    Two(&'static str, fn(f64, f64) -> f64),
    Select,
}

/// The steps of a formula, in order.
#[derive(Clone, Debug, Default)]
pub struct Program {
    steps: Vec<Step>,
}

/// Columns of intermediate values, one after the other; reused from tile to tile.
#[derive(Default)]
pub struct Stack {
    columns: Vec<[f64; TILE]>,
}

impl Program {
    /// Returns whether the input with that index is in the formula.
    pub fn reads(&self, input: usize) -> bool {
        self.steps.iter().any(|step| matches!(step, Step::Input(read) if *read == input))
    }

    /// Adds a step. A step whose operands are all numbers is computed at once and becomes a number.
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

    pub fn pop(&mut self) {
        self.steps.pop();
    }

    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    pub fn uses(&self, input: usize) -> bool {
        self.steps.iter().any(|step| matches!(step, Step::Input(number) if *number == input))
    }

    /// Returns the numbers in the program, by their bits.
    pub fn numbers(&self) -> Vec<u64> {
        let numbers = self.steps.iter().filter_map(|step| match step {
            Step::Number(number) => Some(number.to_bits()),
            _ => None,
        });
        numbers.collect()
    }

    /// Computes the values of up to [`TILE`] rows, those of `inputs` from row `first` on.
    pub fn run(&self, inputs: &[&[f64]], first: usize, values: &mut [f64], stack: &mut Stack) {
        self.run_steps(inputs, first, values, stack, |_, _| ());
    }

    /// Does the same for the first rows, where `after` may change the results of every step.
    pub fn run_with(&self, inputs: &[&[f64]], values: &mut [f64], after: impl FnMut(&Step, &mut [f64])) {
        self.run_steps(inputs, 0, values, &mut Stack::default(), after);
    }

    #[inline(always)]
    fn run_steps(
        &self,
        inputs: &[&[f64]],
        first: usize,
        values: &mut [f64],
        stack: &mut Stack,
        mut after: impl FnMut(&Step, &mut [f64]),
    ) {
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
                Step::One(_, value) => top.iter_mut().for_each(|x| *x = value(*x)),
                Step::Add => with(top, &above[0], |a, b| a + b),
                Step::Subtract => with(top, &above[0], |a, b| a - b),
                Step::Multiply => with(top, &above[0], |a, b| a * b),
                Step::Divide => with(top, &above[0], |a, b| a / b),
                Step::Raise => with(top, &above[0], libm::pow),
                Step::Compare(comparison) => with(top, &above[0], |a, b| comparison.holds(a, b)),
                Step::Two(_, value) => with(top, &above[0], value),
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
            after(step, top);
        }
        if depth == 1 {
            values.copy_from_slice(&columns[0][..rows]);
        }
    }
}

fn with(top: &mut [f64], other: &[f64; TILE], function: impl Fn(f64, f64) -> f64) {
    for (a, b) in top.iter_mut().zip(other) {
        *a = function(*a, *b);
    }
}

impl Step {
    pub fn operands(self) -> usize {
        match self {
            Self::Input(_) | Self::Number(_) => 0,
            Self::Negate | Self::Power(_) | Self::One(..) => 1,
            Self::Select => 3,
            _ => 2,
        }
    }
}
