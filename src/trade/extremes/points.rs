//! The points at which the model is evaluated: at the bounds of the factors and past them.

use rand::SeedableRng;
use rand::distr::{Distribution as _, Open01};
use rand_chacha::ChaCha8Rng;

use super::map::{Grid, Kind};
use crate::space::{Factor, LARGEST_U, SMALLEST_U, Space};

/// Powers of ten past a bound.
const POWERS: [i32; 9] = [0, 1, 2, 3, 6, 12, 30, 100, 300];
/// Below a lower bound above zero there are also the least number, zero, and what lies beyond.
const BELOW_ALL: [&str; 3] = ["least", "0", "< 0"];
/// Powers of ten for several factors at once.
const TOGETHER: [i32; 6] = [1, 2, 3, 6, 12, 30];
/// Corners that the other factors stand at while one goes past its bounds, beside the nominal point.
const COMPANIONS: usize = 2;
/// Most factors whose corners can be counted.
const MOST_COUNTED: usize = 30;

/// A point of the map.
pub(super) struct Point {
    pub kind: Kind,
    /// Its cell as (grid, row, column): grid 0 is below the bounds, grid 1 above.
    pub cell: Option<(usize, usize, usize)>,
    /// The SI values of the factors.
    pub x: Vec<f64>,
    /// What is special about it.
    pub place: String,
}

/// Where a factor can go, in SI units.
struct Reach {
    low: f64,
    high: f64,
    nominal: f64,
    /// Whether it can go past its bounds: a category cannot.
    leaves: bool,
}

impl Reach {
    /// Bounds are those of the distribution, or the outermost values that a design can have.
    fn of(factor: &Factor) -> Self {
        let mut outermost = [0.0; 2];
        factor.fill_si(&[SMALLEST_U, LARGEST_U], &mut outermost);
        let (low, high) = factor.distribution().support();
        let si = |bound: f64, outermost: f64| if bound.is_finite() { factor.unit().to_si(bound) } else { outermost };
        Self {
            low: si(low, outermost[0]),
            high: si(high, outermost[1]),
            nominal: factor.unit().to_si(factor.nominal),
            leaves: factor.distribution().labels().is_none(),
        }
    }

    /// 10^k past the upper bound.
    fn above(&self, power: i32) -> f64 {
        let factor = 10_f64.powi(power);
        match power {
            0 => self.high,
            _ if self.high > 0.0 => self.high * factor,
            _ => self.high + (self.high - self.low).max(1.0) * factor,
        }
    }

    /// 10^k past the lower bound: towards zero from above it, and away from it below.
    fn below(&self, power: i32) -> f64 {
        let factor = 10_f64.powi(power);
        match power {
            0 => self.low,
            _ if self.low > 0.0 => self.low / factor,
            _ if self.low < 0.0 => self.low * factor,
            _ => -self.high.abs().max(f64::MIN_POSITIVE) * factor,
        }
    }

    /// The columns of the grid below, from the bound on.
    fn all_below(&self) -> Vec<Option<f64>> {
        let powers = POWERS.map(|power| Some(self.below(power)));
        let least = f64::from_bits(1);
        let negative = (self.low >= 0.0).then_some(-self.high.abs());
        powers.into_iter().chain([Some(least), Some(0.0), negative]).collect()
    }

    fn all_above(&self) -> Vec<Option<f64>> {
        POWERS.map(|power| Some(self.above(power))).to_vec()
    }
}

/// The grids of the points below and above the bounds.
pub(super) fn grids(space: &Space) -> [Grid; 2] {
    let rows: Vec<String> = space.factors().iter().map(|factor| factor.name.replace('_', " ")).collect();
    let powers: Vec<String> = POWERS.iter().map(ToString::to_string).collect();
    let below = powers.iter().cloned().chain(BELOW_ALL.map(str::to_owned)).collect();
    [
        Grid::new("-below", "Below the lower bounds", "powers of ten below the lower bound", rows.clone(), below),
        Grid::new("-above", "Above the upper bounds", "powers of ten above the upper bound", rows, powers),
    ]
}

/// Numbers chosen at random.
struct Dice(ChaCha8Rng);

impl Dice {
    fn below(&mut self, most: usize) -> usize {
        let u: f64 = Open01.sample(&mut self.0);
        (u * most as f64) as usize
    }
}

/// About `count` points of `space`, and all steps of every factor past its bounds; those chosen at random by `seed`.
pub(super) fn points(space: &Space, count: u64, seed: u64) -> Vec<Point> {
    let reaches: Vec<Reach> = space.factors().iter().map(Reach::of).collect();
    let names: Vec<&str> = space.factors().iter().map(|factor| factor.name.as_str()).collect();
    let mut points = Points { reaches, names, dice: Dice(ChaCha8Rng::seed_from_u64(seed)), points: Vec::new() };
    let quota = (count / 5).max(1) as usize;
    points.corners(quota);
    points.edges(quota);
    points.sides();
    points.beyond(2 * quota);
    points.together(quota);
    points.points
}

struct Points<'a> {
    reaches: Vec<Reach>,
    names: Vec<&'a str>,
    dice: Dice,
    points: Vec<Point>,
}

impl Points<'_> {
    fn push(&mut self, kind: Kind, x: Vec<f64>, place: impl Into<String>) {
        self.points.push(Point { kind, cell: None, x, place: place.into() });
    }

    fn nominal(&self) -> Vec<f64> {
        self.reaches.iter().map(|reach| reach.nominal).collect()
    }

    /// The corner at which the factors with a 1 are at their upper bounds.
    fn corner(&self, is_high: impl Fn(usize) -> bool) -> Vec<f64> {
        let bound = |(number, reach): (usize, &Reach)| if is_high(number) { reach.high } else { reach.low };
        self.reaches.iter().enumerate().map(bound).collect()
    }

    fn any_corner(&mut self) -> Vec<f64> {
        let bits: Vec<bool> = self.reaches.iter().map(|_| self.dice.below(2) == 1).collect();
        self.corner(|number| bits[number])
    }

    /// All corners, or as many of them; the lowest and the highest in any case.
    fn corners(&mut self, most: usize) {
        let factors = self.reaches.len();
        if factors <= MOST_COUNTED && 1 << factors <= most {
            for number in 0..1_usize << factors {
                self.push(Kind::Corners, self.corner(|factor| number >> factor & 1 == 1), "a corner");
            }
            return;
        }
        self.push(Kind::Corners, self.corner(|_| false), "all at the lower bound");
        self.push(Kind::Corners, self.corner(|_| true), "all at the upper bound");
        for _ in 2..most {
            let x = self.any_corner();
            self.push(Kind::Corners, x, "a corner");
        }
    }

    /// Points at a quarter, half and three quarters of edges.
    fn edges(&mut self, most: usize) {
        for _ in 0..most {
            let mut x = self.any_corner();
            let factor = self.dice.below(x.len());
            let part = 0.25 * (1 + self.dice.below(3)) as f64;
            let Reach { low, high, leaves, .. } = self.reaches[factor];
            if leaves {
                x[factor] = low + part * (high - low);
            }
            self.push(Kind::Edges, x, format!("an edge along {}", self.names[factor]));
        }
    }

    fn sides(&mut self) {
        for factor in 0..self.reaches.len() {
            let Reach { low, high, .. } = self.reaches[factor];
            for (bound, which) in [(low, "lower"), (high, "upper")] {
                let mut x = self.nominal();
                x[factor] = bound;
                self.push(Kind::Sides, x, format!("{} at its {which} bound", self.names[factor]));
            }
        }
    }

    /// Every factor by powers of ten past its bounds, the others at the nominal point and, as far as there are `most`
    /// points, at some corners.
    fn beyond(&mut self, most: usize) {
        let steps = self.reaches.len() * (2 * POWERS.len() + BELOW_ALL.len());
        let companions = (most / steps.max(1)).clamp(1, 1 + COMPANIONS);
        for factor in 0..self.reaches.len() {
            if !self.reaches[factor].leaves {
                continue;
            }
            let sides = [self.reaches[factor].all_below(), self.reaches[factor].all_above()];
            for companion in 0..companions {
                let others = if companion == 0 { self.nominal() } else { self.any_corner() };
                for (grid, values) in sides.iter().enumerate() {
                    for (column, value) in values.iter().enumerate() {
                        let Some(value) = value.filter(|value| value.is_finite()) else { continue };
                        let mut x = others.clone();
                        x[factor] = value;
                        let place = self.place(factor, grid, column);
                        let cell = Some((grid, factor, column));
                        self.points.push(Point { kind: Kind::Beyond, cell, x, place });
                    }
                }
            }
        }
    }

    fn place(&self, factor: usize, grid: usize, column: usize) -> String {
        let name = self.names[factor];
        match (grid, POWERS.get(column)) {
            (0, Some(power)) => format!("{name} 10^{power} below its lower bound"),
            (_, Some(power)) => format!("{name} 10^{power} above its upper bound"),
            (_, None) => format!("{name} at {}", ["the least number", "0", "a negative number"][column - POWERS.len()]),
        }
    }

    /// Every factor at random past one of its bounds, or within them.
    fn together(&mut self, most: usize) {
        for _ in 0..most {
            let mut x = self.any_corner();
            let mut moved = 0;
            for (factor, x) in x.iter_mut().enumerate() {
                let (power, side) = (TOGETHER[self.dice.below(TOGETHER.len())], self.dice.below(4));
                let reach = &self.reaches[factor];
                let value = if side == 0 { reach.below(power) } else { reach.above(power) };
                // Below a bound of zero there is mostly nothing.
                let allowed = reach.leaves && value.is_finite() && (side == 1 || side == 0 && reach.low != 0.0);
                if allowed {
                    *x = value;
                    moved += 1;
                }
            }
            self.push(Kind::Together, x, format!("{moved} factors past their bounds"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Unit;
    use crate::space::Distribution;

    fn space() -> Space {
        let factor = |name: &str, min, max| {
            Factor::new(name, Unit::parse("um").unwrap(), Distribution::uniform(min, max).unwrap()).unwrap()
        };
        Space::new(vec![factor("a", 1.0, 2.0), factor("b", 0.0, 5.0), factor("c", -1.0, 1.0)])
    }

    #[test]
    fn bounds_and_what_lies_past_them_are_in_the_units_of_the_factors() {
        let space = space();
        let points = points(&space, 500, 0);
        let of = |kind| points.iter().filter(move |point| point.kind == kind);
        assert_eq!((of(Kind::Corners).count(), of(Kind::Edges).count(), of(Kind::Sides).count()), (8, 100, 6));
        let at = |grid, row, column| {
            of(Kind::Beyond).find(|point| point.cell == Some((grid, row, column))).map(|point| point.x[row])
        };
        assert_eq!(at(1, 0, 0), Some(2e-6));
        assert!((at(1, 0, 4).unwrap() / 2.0 - 1.0).abs() < 1e-12);
        assert!((at(0, 0, 4).unwrap() / 1e-12 - 1.0).abs() < 1e-12);
        assert_eq!((at(0, 0, 9), at(0, 0, 10), at(0, 0, 11)), (Some(f64::from_bits(1)), Some(0.0), Some(-2e-6)));
        // Below 0 there are negative numbers, and below a negative bound there is no further sign to try.
        assert!(at(0, 1, 1).unwrap() < 0.0 && at(0, 2, 1).unwrap() < -9e-6);
        assert_eq!(at(0, 2, 11), None);
        assert!(points.iter().all(|point| point.x.iter().all(|x| x.is_finite())));
    }

    #[test]
    fn many_corners_are_chosen_by_the_seed() {
        let factor = |number: usize| {
            let one = Unit::dimensionless();
            Factor::new(&format!("x{number}"), one, Distribution::uniform(0.0, 1.0).unwrap()).unwrap()
        };
        let space = Space::new((0..40).map(factor).collect());
        let corners = |seed| -> Vec<Vec<f64>> {
            let points = points(&space, 100, seed).into_iter();
            points.filter(|point| point.kind == Kind::Corners).map(|point| point.x).collect()
        };
        assert_eq!((corners(1).len(), corners(1) == corners(1), corners(1) == corners(2)), (20, true, false));
        assert_eq!(corners(1)[..2], [vec![0.0; 40], vec![1.0; 40]]);
    }
}
