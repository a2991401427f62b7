//! The trajectories of a screening, each a pure function of its number.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::settings::{ScreeningDesign, ScreeningError, ScreeningSettings};
use crate::design::{BasePoints, Design, DesignSettings, Rows, Sampler};
use crate::space::{Distribution, Factor, Group, Space};

/// End of the grid on a side on which the factor's distribution is unbounded: this quantile, or 1 minus it.
const TAIL: f64 = 1e-3;

/// The move of one factor in one trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Move {
    /// Its coordinate in the unit cube before and after its step; 0 and 1 are the ends of a bounded range.
    pub u: [f64; 2],
    /// The step as a signed part of its range.
    pub step: f64,
    /// The row of the trajectory before the step.
    pub before: usize,
    /// The row after it; 0 for a constant, which does not step.
    pub after: usize,
}

/// Generates the trajectories.
pub(super) struct Trajectories {
    shape: Shape,
    seed: u64,
    /// What steps: factors, or groups of which all factors step at once.
    pub movers: Vec<Group>,
    /// For each factor, its possible positions, and the number of its mover; `None` for a constant.
    grids: Vec<(Grid, Option<usize>)>,
}

enum Shape {
    /// The base points of each randomisation, with the number of points in each.
    Star {
        points: Vec<BasePoints>,
        each: u64,
    },
    Walk,
}

/// The possible positions of a factor.
enum Grid {
    /// Anywhere in the unit interval.
    Continuous,
    /// On a grid of coordinates of equal distance.
    Levels(Vec<f64>),
    /// At the levels of a discrete factor, each as often as its probability, at equal distances in the effects.
    Discrete(Vec<Level>),
    /// Anywhere, for seeds: these have no distance, and every step counts as one.
    Seeds,
}

/// One value of a discrete factor, with its part of the unit interval.
struct Level {
    low: f64,
    middle: f64,
}

impl Level {
    fn width(&self) -> f64 {
        2.0 * (self.middle - self.low)
    }
}

impl Trajectories {
    /// Prepares the trajectories of `movers`, with `settings`, which are rounded, for intervals from `parts` parts.
    pub fn new(
        space: &Space,
        movers: Vec<Group>,
        settings: &ScreeningSettings,
        parts: u64,
    ) -> Result<Self, ScreeningError> {
        let ScreeningSettings { design, trajectories, seed } = *settings;
        let shape = match design {
            ScreeningDesign::Radial { sampler } => {
                let replicates = if sampler == Sampler::Random { 1 } else { parts };
                let settings = DesignSettings { sampler, base_samples: trajectories, replicates, seed };
                let design = Design::new(settings, space.factors().len(), Rows::default())?;
                let points = (0..replicates).map(|replicate| design.replicate(replicate)).collect();
                Shape::Star { points, each: trajectories / replicates }
            }
            ScreeningDesign::Trajectory { .. } => Shape::Walk,
        };
        let mut grids = Vec::with_capacity(space.factors().len());
        for (number, factor) in space.factors().iter().enumerate() {
            let mover = movers.iter().position(|mover| mover.factors.contains(&number));
            grids.push((Grid::new(factor, design), mover));
        }
        Ok(Self { shape, seed, movers, grids })
    }

    /// Returns the number of rows of a trajectory.
    pub fn rows(&self) -> usize {
        self.movers.len() + 1
    }

    /// Returns the moves of all factors in trajectory `number`.
    pub fn moves(&self, number: u64) -> Vec<Move> {
        match &self.shape {
            Shape::Star { points, each } => self.star(&points[(number / each) as usize], number % each),
            Shape::Walk => self.walk(number),
        }
    }

    /// Sets the coordinates of factor `j` in all rows of a trajectory, from its two values.
    pub fn fill(&self, factor: &Move, values: [f64; 2], column: &mut [f64]) {
        let after = factor.after;
        match self.shape {
            Shape::Star { .. } => {
                column.fill(values[0]);
                column[after] = values[1];
            }
            Shape::Walk => {
                column[..after].fill(values[0]);
                column[after..].fill(values[1]);
            }
        }
    }

    /// Returns a column of SI values for each factor, with the rows of these trajectories, and adds to `idle` the number of
    /// the steps of each mover that do not change a value.
    pub fn columns(&self, factors: &[Factor], moves: &[Vec<Move>], idle: &mut [u64]) -> Vec<Vec<f64>> {
        let rows = self.rows();
        let mut columns = vec![vec![0.0; rows * moves.len()]; factors.len()];
        let mut changes = vec![false; moves.len() * self.movers.len()];
        for (j, (column, factor)) in columns.iter_mut().zip(factors).enumerate() {
            for (number, (moves, column)) in moves.iter().zip(column.chunks_exact_mut(rows)).enumerate() {
                let values = values_at(factor, &moves[j].u);
                if let Some(mover) = self.grids[j].1 {
                    changes[number * self.movers.len() + mover] |= values[0] != values[1];
                }
                self.fill(&moves[j], values, column);
            }
        }
        for changes in changes.chunks_exact(self.movers.len().max(1)) {
            for (idle, changes) in idle.iter_mut().zip(changes) {
                *idle += u64::from(!changes);
            }
        }
        columns
    }

    /// Generates the moves of a star. Base point and auxiliary point are the two halves of one point. In an unscrambled
    /// sequence the halves begin with equal coordinates, which Campolongo et al. avoid by taking b from a later point;
    /// here every coordinate has its own scramble, so that b_j is independent of a_j.
    fn star(&self, points: &BasePoints, index: u64) -> Vec<Move> {
        let factors = self.grids.len();
        let mut columns = vec![vec![0.0]; 2 * factors];
        points.fill(index, &mut columns);
        let mut moves = Vec::with_capacity(factors);
        for (j, (grid, mover)) in self.grids.iter().enumerate() {
            let (a, b) = (columns[j][0], columns[factors + j][0]);
            let (u, step) = match grid {
                Grid::Continuous => {
                    let b = if (b - a).abs() < ScreeningSettings::MIN_STEP { half_way_round(b) } else { b };
                    ([a, b], b - a)
                }
                Grid::Seeds => ([a, b], 1.0),
                Grid::Discrete(levels) => two_levels(levels, a, b),
                // Only walks have grids.
                Grid::Levels(levels) => between(levels, 0, levels.len() - 1),
            };
            moves.push(Move { u, step, before: 0, after: mover.map_or(0, |mover| mover + 1) });
        }
        moves
    }

    /// Generates one of Morris's walks. All levels of a grid are equally likely to be the first, as are all orders of
    /// the movers. Every other walk has steps of a third of the grid: to Morris's step, half the grid, an output of
    /// that period is constant.
    fn walk(&self, number: u64) -> Vec<Move> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(number);
        let mut position: Vec<usize> = (0..self.movers.len()).collect();
        for last in (1..position.len()).rev() {
            position.swap(last, rng.random_range(0..=last));
        }
        let mut moves = Vec::with_capacity(self.grids.len());
        for (grid, mover) in &self.grids {
            let (u, step) = match grid {
                // A factor that cannot move: its coordinate is irrelevant.
                Grid::Continuous => ([0.5, 0.5], 1.0),
                Grid::Seeds => {
                    ([0; 2].map(|_| rng.random_range(Distribution::SMALLEST_U..=Distribution::LARGEST_U)), 1.0)
                }
                Grid::Discrete(levels) => two_levels(levels, rng.random(), rng.random()),
                Grid::Levels(levels) => {
                    let count = levels.len();
                    let stride = if number.is_multiple_of(2) { count / 2 } else { (count / 3).max(1) };
                    let from = rng.random_range(0..count);
                    // If both directions are possible, either.
                    let up = from + stride < count && (from < stride || rng.random_bool(0.5));
                    between(levels, from, if up { from + stride } else { from - stride })
                }
            };
            let before = mover.map_or(0, |mover| position[mover]);
            moves.push(Move { u, step, before, after: before + usize::from(mover.is_some()) });
        }
        moves
    }
}

/// Returns the SI values at two coordinates. Quantiles are for the open interval: its ends are those of the range.
fn values_at(factor: &Factor, u: &[f64; 2]) -> [f64; 2] {
    let mut values = [0.0; 2];
    factor.fill_si(u, &mut values);
    let (low, high) = factor.distribution().support();
    for (value, u) in values.iter_mut().zip(u) {
        match u {
            0.0 => *value = factor.unit().to_si(low),
            1.0 => *value = factor.unit().to_si(high),
            _ => (),
        }
    }
    values
}

/// Returns the coordinates of two levels, and the step between them as a part of the range.
fn between(levels: &[f64], from: usize, to: usize) -> ([f64; 2], f64) {
    ([levels[from], levels[to]], (to as f64 - from as f64) / (levels.len() - 1) as f64)
}

/// Returns two different levels, drawn by their probabilities: at the quantile `a`, and at `b` among the others.
fn two_levels(levels: &[Level], a: f64, b: f64) -> ([f64; 2], f64) {
    let from = level_at(levels, a);
    let Level { low, .. } = levels[from];
    let rest = b * (1.0 - levels[from].width());
    let mut to = level_at(levels, if rest < low { rest } else { rest + levels[from].width() });
    // Rounding may lead back to the start or the end of the first level.
    if to == from {
        to = if from + 1 < levels.len() { from + 1 } else { from - 1 };
    }
    let step = (to as f64 - from as f64) / (levels.len() - 1) as f64;
    ([levels[from].middle, levels[to].middle], step)
}

/// Returns the index of the level whose part of the unit interval contains `u`.
fn level_at(levels: &[Level], u: f64) -> usize {
    levels.partition_point(|level| level.low <= u).saturating_sub(1)
}

/// Returns the coordinate half a range further on, modulo 1.
fn half_way_round(u: f64) -> f64 {
    (if u < 0.5 { u + 0.5 } else { u - 0.5 }).clamp(Distribution::SMALLEST_U, Distribution::LARGEST_U)
}

impl Grid {
    fn new(factor: &Factor, design: ScreeningDesign) -> Self {
        if factor.distribution().is_noise() {
            return Self::Seeds;
        }
        if let Some(values) = factor.distribution().levels() {
            let mut low = 0.0;
            let mut levels = Vec::with_capacity(values.len());
            for (_, middle) in values {
                let level = Level { low, middle };
                // Each ends as far above its middle as it begins below.
                low += level.width();
                levels.push(level);
            }
            return if levels.len() < 2 { Self::Continuous } else { Self::Discrete(levels) };
        }
        match (factor.distribution(), design) {
            (Distribution::Constant(_), _) | (_, ScreeningDesign::Radial { .. }) => Self::Continuous,
            (distribution, ScreeningDesign::Trajectory { levels }) => {
                let (low, high) = distribution.support();
                let from = if low.is_finite() { 0.0 } else { TAIL };
                let to = if high.is_finite() { 1.0 } else { 1.0 - TAIL };
                let parts = (0..levels).map(|k| f64::from(k) / f64::from(levels - 1));
                Self::Levels(parts.map(|part| from * (1.0 - part) + to * part).collect())
            }
        }
    }
}
