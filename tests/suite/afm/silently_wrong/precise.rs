//! Evaluation of a formula in 320 bits, and its rounding error in doubles: to find where doubles are wrong.

use apportion::Expression;
use apportion::model::expression::Step;
use astro_float_num::RoundingMode::ToEven;
use astro_float_num::{BigFloat, Consts, Sign, WORD_BIT_SIZE};

use super::judge::{Reference, Unchecked};

/// Precision in bits; large compared with the 53 bits of doubles, so that cancellation of all 53 is harmless.
const BITS: usize = 320;
/// Precision of sums that cancel by design, such as exp(x) - 1.
const WIDE: usize = 2 * BITS;
/// Exponent of x below which exp(x) - 1 and ln(1 + x) equal x to all bits.
const TINY: i32 = -(BITS as i32);
/// Binary exponent above which a rounded angle has too few digits left within its turn, and one above which a power takes
/// minutes.
const MAX_EXPONENT_OF_ANGLE: i32 = BITS as i32 - 64;
const MAX_EXPONENT_OF_POWER: i32 = 40;
/// Number of evaluations in doubles, each rounded differently.
const SAMPLES: usize = 32;
/// Margin on the largest deviation of so many samples.
const MARGIN: f64 = 8.0;

/// Returns the value at one point in 320 bits and exponents of any size, as the nearest double; `None` if the formula
/// has a function that is not available there: `erf`, `gamma`, powers and angles out of reach.
///
/// # Panics
/// If an input of the formula is missing.
fn precise(formula: &Expression, x: &[f64]) -> Option<f64> {
    let constants = &mut Consts::new().ok()?;
    let mut stack: Vec<BigFloat> = Vec::new();
    for step in formula.program().steps() {
        let operands = stack.split_off(stack.len() - step.operands());
        stack.push(evaluate(*step, &operands, x, constants)?);
    }
    stack.pop().map(|value| to_f64(&value))
}

/// Returns how far rounding may move the [`value`](Expression::value) at one point: the largest deviation of
/// evaluations with steps moved to a neighbouring double at random (Vignes 1993), times a margin. Infinite if one has
/// no value.
///
/// # Panics
/// If an input of the formula is missing.
fn rounding(formula: &Expression, x: &[f64]) -> f64 {
    let columns: Vec<[f64; SAMPLES]> = x.iter().map(|x| [*x; SAMPLES]).collect();
    let inputs: Vec<&[f64]> = columns.iter().map(|column| &column[..]).collect();
    let mut values = [f64::NAN; SAMPLES];
    let mut random = 0x9E37_79B9_7F4A_7C15_u64;
    formula.program().run_with(&inputs, &mut values, |step, values| {
        if !is_rounded(step) {
            return;
        }
        for value in &mut values[1..] {
            random ^= random << 13;
            random ^= random >> 7;
            random ^= random << 17;
            *value = match random >> 62 {
                0 => value.next_up(),
                1 => value.next_down(),
                _ => *value,
            };
        }
    });
    let apart = values.iter().map(|value| (value - values[0]).abs());
    MARGIN * apart.fold(0.0, |largest, apart| if apart.is_finite() { f64::max(largest, apart) } else { f64::INFINITY })
}

/// Returns a formula at `x`, and how much rounding may move it in doubles.
pub fn reference(formula: &Expression, x: &[f64]) -> Result<Reference, Unchecked> {
    let unreached = "the formula has a function (erf, gamma, a huge angle or power) that is not computed in 320 bits";
    let value = precise(formula, x).ok_or_else(|| Unchecked::NotAvailable(unreached.to_owned()))?;
    if value.is_nan() {
        return Err(Unchecked::NotAvailable("the formula has no value in 320 bits".to_owned()));
    }
    let covered = "rounding in doubles costs the formula its digits, by cancellation or underflow";
    Ok(Reference { value, stated: Some(rounding(formula, x)), tolerance: 1e-9, floor: 1e-9, covered })
}

fn is_rounded(step: &Step) -> bool {
    match step {
        Step::Input(_) | Step::Number(_) | Step::Negate | Step::Compare(_) | Step::Select => false,
        Step::One(name, _) => !matches!(*name, "abs" | "floor" | "ceil" | "round"),
        Step::Two(name, _) => !matches!(*name, "min" | "max"),
        _ => true,
    }
}

/// Converts `value` exactly. Subnormal numbers are scaled first: `from_f64` halves them.
fn number(value: f64) -> BigFloat {
    if value.is_subnormal() {
        let mut number = BigFloat::from_f64(libm::scalbn(value, 64), BITS);
        if let Some(exponent) = number.exponent() {
            number.set_exponent(exponent - 64);
        }
        return number;
    }
    BigFloat::from_f64(value, BITS)
}

fn evaluate(step: Step, operands: &[BigFloat], x: &[f64], c: &mut Consts) -> Option<BigFloat> {
    Some(match (step, operands) {
        (Step::Input(input), _) => number(x[input]),
        (Step::Number(value), _) => number(value),
        (Step::Negate, [x]) => x.neg(),
        (Step::Power(power), [x]) => {
            let value = x.powi(power.unsigned_abs() as usize, BITS, ToEven);
            if power < 0 { value.reciprocal(BITS, ToEven) } else { value }
        }
        (Step::Add, [a, b]) => a.add(b, BITS, ToEven),
        (Step::Subtract, [a, b]) => a.sub(b, BITS, ToEven),
        (Step::Multiply, [a, b]) => a.mul(b, BITS, ToEven),
        (Step::Divide, [a, b]) => a.div(b, BITS, ToEven),
        (Step::Raise, [_, b]) if b.exponent().is_none_or(|exponent| exponent > MAX_EXPONENT_OF_POWER) => return None,
        (Step::Raise, [a, b]) => a.pow(b, BITS, ToEven, c),
        (Step::Compare(_), [a, b]) if a.is_nan() || b.is_nan() => number(f64::NAN),
        (Step::Compare(comparison), [a, b]) => number(f64::from(comparison.is_true_of(a, b))),
        (Step::Select, [condition, ..]) if condition.is_nan() => number(f64::NAN),
        (Step::Select, [condition, then, other]) => (if condition.is_zero() { other } else { then }).clone(),
        (Step::One(name, _), [x]) => of_one(name, x, c)?,
        (Step::Two(name, _), [a, b]) => of_two(name, a, b, c)?,
        _ => return None,
    })
}

fn of_one(name: &str, x: &BigFloat, c: &mut Consts) -> Option<BigFloat> {
    let is_tiny = x.exponent().is_none_or(|exponent| exponent < TINY);
    Some(match name {
        "sin" | "cos" | "tan" if x.exponent().is_some_and(|exponent| exponent > MAX_EXPONENT_OF_ANGLE) => return None,
        "sin" => x.sin(BITS, ToEven, c),
        "cos" => x.cos(BITS, ToEven, c),
        "tan" => x.tan(BITS, ToEven, c),
        "asin" => x.asin(BITS, ToEven, c),
        "acos" => x.acos(BITS, ToEven, c),
        "atan" => x.atan(BITS, ToEven, c),
        "sinh" => x.sinh(BITS, ToEven, c),
        "cosh" => x.cosh(BITS, ToEven, c),
        "tanh" => x.tanh(BITS, ToEven, c),
        "exp" => x.exp(BITS, ToEven, c),
        "expm1" | "log1p" if is_tiny && !x.is_inf() => x.clone(),
        "expm1" => x.exp(WIDE, ToEven, c).sub(&number(1.0), BITS, ToEven),
        "log1p" => x.add(&number(1.0), WIDE, ToEven).ln(BITS, ToEven, c),
        "ln" => x.ln(BITS, ToEven, c),
        "log2" => x.log2(BITS, ToEven, c),
        "log10" => x.log10(BITS, ToEven, c),
        "sqrt" => x.sqrt(BITS, ToEven),
        "cbrt" => x.cbrt(BITS, ToEven),
        "abs" => x.abs(),
        "floor" => x.floor(),
        "ceil" => x.ceil(),
        "round" if x.is_negative() => x.sub(&number(0.5), WIDE, ToEven).ceil(),
        "round" => x.add(&number(0.5), WIDE, ToEven).floor(),
        _ => return None,
    })
}

fn of_two(name: &str, a: &BigFloat, b: &BigFloat, c: &mut Consts) -> Option<BigFloat> {
    Some(match name {
        "hypot" => a.mul(a, BITS, ToEven).add(&b.mul(b, BITS, ToEven), BITS, ToEven).sqrt(BITS, ToEven),
        "min" | "max" if a.is_nan() || b.is_nan() => number(f64::NAN),
        "min" => (if a < b { a } else { b }).clone(),
        "max" => (if a > b { a } else { b }).clone(),
        "atan2" if a.is_zero() && b.is_zero() => number(0.0),
        "atan2" if b.is_positive() && !b.is_zero() => a.div(b, BITS, ToEven).atan(BITS, ToEven, c),
        // Beyond the quarters to the right: pi/2 - atan(b/a), with the sign of a.
        "atan2" if !a.is_zero() => {
            let mut quarter = c.pi(BITS, ToEven).div(&number(2.0), BITS, ToEven);
            quarter.set_sign(if a.is_negative() { Sign::Neg } else { Sign::Pos });
            quarter.sub(&b.div(a, BITS, ToEven).atan(BITS, ToEven, c), BITS, ToEven)
        }
        "atan2" => c.pi(BITS, ToEven),
        _ => return None,
    })
}

/// Returns the nearest double, to a few units in the last place for subnormal ones.
fn to_f64(x: &BigFloat) -> f64 {
    let Some((words, _, sign, exponent, _)) = x.as_raw_parts() else {
        return if x.is_inf_pos() {
            f64::INFINITY
        } else if x.is_inf_neg() {
            f64::NEG_INFINITY
        } else {
            f64::NAN
        };
    };
    let unit = libm::scalbn(1.0, -(WORD_BIT_SIZE as i32));
    let mantissa = words.iter().fold(0.0, |below, word| (*word as f64 + below) * unit);
    libm::scalbn(if sign.is_negative() { -mantissa } else { mantissa }, exponent)
}
