//! The points at which the model is evaluated: at the bounds of the factors and past them.

use apportion::Distribution;
use apportion::space::{Factor, Space};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::map::Kind;

/// Powers of ten past a bound.
const POWERS: [i32; 9] = [0, 1, 2, 3, 6, 12, 30, 100, 300];
/// Number of additional values below a lower bound: the smallest positive number, zero, and, if the bound is not
/// negative, minus the upper bound.
const SPECIAL: usize = 3;
/// Powers of ten for several factors at once.
const TOGETHER: [i32; 6] = [1, 2, 3, 6, 12, 30];
/// Number of corners for the other factors while one goes past its bounds, in addition to the nominal point.
const COMPANIONS: usize = 2;

/// A point of the map.
pub struct Point {
    pub kind: Kind,
    /// The SI values of the factors.
    pub x: Vec<f64>,
    /// Its place, in words.
    pub place: String,
}

/// The possible values of a factor, in SI units.
struct Reach {
    name: String,
    low: f64,
    high: f64,
    nominal: f64,
    /// Whether it can exceed its bounds: a category cannot.
    leaves: bool,
}

impl Reach {
    /// Takes the bounds of the distribution, or the outermost values of a design.
    fn new(factor: &Factor) -> Self {
        let mut outermost = [0.0; 2];
        factor.fill_si(&[Distribution::SMALLEST_U, Distribution::LARGEST_U], &mut outermost);
        let (low, high) = factor.distribution().support();
        let [low, high] = [(low, outermost[0]), (high, outermost[1])]
            .map(|(bound, outermost)| if bound.is_finite() { factor.unit().to_si(bound) } else { outermost });
        Self {
            name: factor.name.clone(),
            low,
            high,
            nominal: factor.unit().to_si(factor.nominal),
            leaves: factor.distribution().labels().is_none(),
        }
    }

    /// Returns the value 10^power past the upper bound.
    fn above(&self, power: i32) -> f64 {
        let factor = 10_f64.powi(power);
        match power {
            0 => self.high,
            _ if self.high > 0.0 => self.high * factor,
            _ => self.high + (self.high - self.low).max(1.0) * factor,
        }
    }

    /// Returns the value 10^power past the lower bound: towards zero if it is positive, away from zero if it is not.
    fn below(&self, power: i32) -> f64 {
        let factor = 10_f64.powi(power);
        match power {
            0 => self.low,
            _ if self.low > 0.0 => self.low / factor,
            _ if self.low < 0.0 => self.low * factor,
            _ => -self.high.abs().max(f64::MIN_POSITIVE) * factor,
        }
    }

    /// Returns the values below (0) or above (1) the bounds; NaN for a missing one.
    fn steps(&self, side: usize) -> Vec<f64> {
        if side == 1 {
            return POWERS.map(|power| self.above(power)).to_vec();
        }
        let negative = if self.low >= 0.0 { -self.high.abs() } else { f64::NAN };
        POWERS.into_iter().map(|power| self.below(power)).chain([f64::from_bits(1), 0.0, negative]).collect()
    }
}

/// Returns all steps of every factor past its bounds, even if these are many, and about `count` points in all; random
/// ones by `seed`.
pub fn points(space: &Space, count: u64, seed: u64) -> Vec<Point> {
    let reaches: Vec<Reach> = space.factors().iter().map(Reach::new).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut points = Vec::new();
    let quarter = (count / 4).max(2) as usize;
    corners(&reaches, quarter, &mut rng, &mut points);
    beyond(&reaches, 2 * quarter, &mut rng, &mut points);
    together(&reaches, quarter, &mut rng, &mut points);
    points
}

/// Returns the corner at which the factors selected by `is_high` are at their upper bounds.
fn corner(reaches: &[Reach], mut is_high: impl FnMut(usize) -> bool) -> Vec<f64> {
    let reaches = reaches.iter().enumerate();
    reaches.map(|(number, reach)| if is_high(number) { reach.high } else { reach.low }).collect()
}

/// Adds all corners, or `max` of them, the lowest and the highest included.
fn corners(reaches: &[Reach], max: usize, rng: &mut ChaCha8Rng, points: &mut Vec<Point>) {
    let all = 1_usize.checked_shl(reaches.len() as u32).filter(|all| *all <= max);
    for number in 0..all.unwrap_or(max) {
        let x = match (all, number) {
            (Some(_), _) => corner(reaches, |factor| number >> factor & 1 == 1),
            (None, 0 | 1) => corner(reaches, |_| number == 1),
            _ => corner(reaches, |_| rng.random()),
        };
        points.push(Point { kind: Kind::Corners, x, place: "a corner".to_owned() });
    }
}

/// Adds every factor from its bounds on, the others at the nominal point and, as far as `max` allows, at corners.
fn beyond(reaches: &[Reach], max: usize, rng: &mut ChaCha8Rng, points: &mut Vec<Point>) {
    let steps = reaches.len() * (2 * POWERS.len() + SPECIAL);
    let companions = (max / steps.max(1)).clamp(1, 1 + COMPANIONS);
    for (row, reach) in reaches.iter().enumerate().filter(|(_, reach)| reach.leaves) {
        for companion in 0..companions {
            let others = match companion {
                0 => reaches.iter().map(|reach| reach.nominal).collect(),
                _ => corner(reaches, |_| rng.random()),
            };
            for (number, side) in ["below its lower", "above its upper"].into_iter().enumerate() {
                let finite = reach.steps(number).into_iter().enumerate().filter(|(_, value)| value.is_finite());
                for (column, value) in finite {
                    let mut x = others.clone();
                    x[row] = value;
                    let place = match POWERS.get(column) {
                        Some(power) => format!("{} 10^{power} {side} bound", reach.name),
                        None => format!("{} at {value:e} in SI units", reach.name),
                    };
                    points.push(Point { kind: Kind::Beyond, x, place });
                }
            }
        }
    }
}

/// Adds points with every factor at random past one of its bounds, or at one of them.
fn together(reaches: &[Reach], max: usize, rng: &mut ChaCha8Rng, points: &mut Vec<Point>) {
    for _ in 0..max {
        let mut x = corner(reaches, |_| rng.random());
        let mut moved = 0;
        for (x, reach) in x.iter_mut().zip(reaches) {
            let power = TOGETHER[rng.random_range(0..TOGETHER.len())];
            let value = match rng.random_range(0..4) {
                // Below a bound of zero most models have no value.
                0 if reach.low != 0.0 => reach.below(power),
                1 => reach.above(power),
                _ => continue,
            };
            if reach.leaves && value.is_finite() {
                *x = value;
                moved += 1;
            }
        }
        points.push(Point { kind: Kind::Together, x, place: format!("{moved} factors past their bounds") });
    }
}
