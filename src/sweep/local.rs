//! Derivatives at the nominal point.

use serde::{Deserialize, Serialize};

use super::request::range;
use super::rows::Bench;
use crate::run::Halt;
use crate::space::{Distribution, Factor};

/// The step of the differences, as a part of the nominal value or of the factor's range, whichever is smaller: wide
/// enough that a model's own error of 1e-6 stays below 1e-3 of the derivative.
const STEP: f64 = 0.01;

/// How one output answers to a small change of one factor at the nominal point.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LocalSensitivity {
    /// dy/dx at the nominal point, in the output's unit per unit of the factor; `None` where there is none.
    pub derivative: Option<f64>,
    /// How far `derivative` may be off: the change that the last extrapolation made, and the rounding of the output.
    /// The truncation error is usually far smaller.
    pub derivative_error: Option<f64>,
    /// The elasticity d ln y / d ln x = (x/y) dy/dx: by so many percent y changes when x changes by 1 %. `None` where x
    /// or y is 0, and in units such as `degC`, of which 1 % has no meaning.
    pub elasticity: Option<f64>,
    /// How far `elasticity` may be off.
    pub elasticity_error: Option<f64>,
    /// Why there is no derivative, where there is none.
    pub reason: Option<String>,
}

impl LocalSensitivity {
    /// No derivative, and why.
    fn none(reason: String) -> Self {
        Self { reason: Some(reason), ..Self::default() }
    }
}

/// The local sensitivities of every output to factor number `number`.
///
/// Differences of steps h and h/2 and one Richardson extrapolation, D = (4 D(h/2) - D(h))/3: central ones, of order h^4
/// after it, or, where the range of the factor ends beside the nominal point, one-sided ones of three points into the
/// range, of order h^3.
pub(super) fn local(bench: &mut Bench<'_>, number: usize, factor: &Factor) -> Result<Vec<LocalSensitivity>, Halt> {
    let distribution = factor.distribution();
    let x = factor.nominal;
    // A factor of single values is asked at its nominal value alone.
    let is_single =
        distribution.is_whole() || distribution.levels().is_some() || matches!(distribution, Distribution::Constant(_));
    let points = (!is_single).then(|| Points::of(x, distribution));
    let values = points.as_ref().map_or_else(|| vec![x], |points| points.values.clone());
    let curves = bench.curve(number, &values, None)?;
    let of_output = |(curve, has_offset): (super::OutputCurve, bool)| {
        let Some(points) = &points else {
            let kind = distribution.name();
            return LocalSensitivity::none(format!(
                "the factor is {kind}, so that no small change of it has a meaning"
            ));
        };
        if let Some(gap) = curve.gaps.first() {
            let reason = &gap.reason;
            return LocalSensitivity::none(format!("a run at or beside the nominal point failed: {reason}"));
        }
        let y: Vec<f64> = curve.values.into_iter().flatten().collect();
        match points.derivative(&y).filter(|(derivative, _)| derivative.is_finite()) {
            None => LocalSensitivity::none("the derivative is beyond double precision".to_owned()),
            Some((derivative, error)) => {
                let has_percents = x != 0.0 && y[0] != 0.0 && !has_offset && !factor.unit().has_offset();
                let per_percent = has_percents.then(|| x / y[0]);
                LocalSensitivity {
                    derivative: Some(derivative),
                    derivative_error: Some(error),
                    elasticity: per_percent.map(|factor| factor * derivative),
                    elasticity_error: per_percent.map(|factor| factor.abs() * error),
                    reason: None,
                }
            }
        }
    };
    let offsets = bench.offsets();
    Ok(curves.into_iter().zip(offsets).map(of_output).collect())
}

/// Where the output is asked: the nominal point, then h and h/2 to both sides, or h/2, h and 2 h to one.
struct Points {
    values: Vec<f64>,
    central: bool,
}

impl Points {
    fn of(x: f64, distribution: &Distribution) -> Self {
        let (from, to) = range(distribution);
        let (low, high) = distribution.support();
        let scale = if x == 0.0 { to - from } else { (to - from).min(x.abs()) };
        let h = STEP * scale;
        let side = |sign: f64| vec![x, x + sign * h / 2.0, x + sign * h, x + sign * 2.0 * h];
        if x - h < low {
            Self { values: side(1.0), central: false }
        } else if x + h > high {
            Self { values: side(-1.0), central: false }
        } else {
            Self { values: vec![x, x - h, x + h, x - h / 2.0, x + h / 2.0], central: true }
        }
    }

    /// The derivative, and how far it may be off.
    fn derivative(&self, y: &[f64]) -> Option<(f64, f64)> {
        // By the steps that were made, not by those that were meant.
        let step = |from: usize, to: usize| self.values[to] - self.values[from];
        let (coarse, fine, shortest) = match (self.central, y) {
            (true, &[_, minus, plus, near_minus, near_plus]) => {
                ((plus - minus) / step(1, 2), (near_plus - near_minus) / step(3, 4), step(3, 4))
            }
            // (-3 y0 + 4 y1 - y2)/(2 h), as differences from y0.
            (false, &[y0, half, one, two]) => (
                (4.0 * (one - y0) - (two - y0)) / step(0, 3),
                (4.0 * (half - y0) - (one - y0)) / step(0, 2),
                step(0, 1),
            ),
            _ => return None,
        };
        let derivative = fine + (fine - coarse) / 3.0;
        let size = y.iter().fold(0.0f64, |size, y| size.max(y.abs()));
        let error = (derivative - fine).abs() + 4.0 * f64::EPSILON * size / shortest.abs();
        Some((derivative, error))
    }
}
