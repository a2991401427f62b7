//! The distribution of an output, as atoms and a density, and the distances of the distributions in classes from it.

use std::f64::consts::TAU;

use crate::given::order::{Order, Partition};
use crate::space::normal_scores;

/// Points of the grid on which densities are compared.
const GRID: usize = 100;

/// Maximum number of different values of an output that are all counted, even with few rows each.
const MAX_COUNTED_VALUES: usize = 50;
/// An output with more values has an atom at one of them if it has this many times the rows of the median value,
const ATOM_OVER_MEDIAN: usize = 10;
/// and at least one in this many of all rows.
const ROWS_PER_ATOM: usize = 100;
/// Kernels are no narrower than this, in steps of the grid: sums over it would not be integrals.
const MIN_WIDTH: f64 = 0.5;
/// Relative difference below which values count as one value within double precision.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The distribution of an output: atoms, which are single values with many rows, and the density of the rest.
pub struct OutputDistribution {
    /// For every row the index of its value, if it is an atom.
    atom_of: Vec<Option<usize>>,
    atoms: usize,
    /// Normal scores of the other rows among themselves, 0 for atoms: delta is invariant under monotone transformations
    /// of the output, and kernels need short tails.
    scores: Vec<f64>,
    /// The smallest score, and the step of the grid from there to the largest one.
    low: f64,
    step: f64,
}

impl OutputDistribution {
    pub fn new(values: &[f64]) -> Self {
        let order = Order::of_rounded(values, ROUNDING);
        let mut sizes: Vec<usize> = order.iter().map(<[usize]>::len).collect();
        sizes.sort_unstable();
        let least = (ATOM_OVER_MEDIAN * sizes[sizes.len() / 2]).max(values.len().div_ceil(ROWS_PER_ATOM));
        let (mut atom_of, mut atoms) = (vec![None; values.len()], 0);
        for rows in order.iter().filter(|rows| order.groups() <= MAX_COUNTED_VALUES || rows.len() >= least) {
            rows.iter().for_each(|&row| atom_of[row] = Some(atoms));
            atoms += 1;
        }
        let others: Vec<usize> = (0..values.len()).filter(|row| atom_of[*row].is_none()).collect();
        let mut scores = vec![0.0; values.len()];
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let other_values: Vec<f64> = others.iter().map(|&row| values[row]).collect();
        for (row, score) in others.into_iter().zip(centred_scores(&Order::from_values(&other_values))) {
            scores[row] = score;
            (low, high) = (low.min(score), high.max(score));
        }
        Self { atom_of, atoms, scores, low, step: (high - low) / (GRID - 1) as f64 }
    }

    pub fn has_atoms(&self) -> bool {
        self.atoms > 0
    }

    /// Computes half of the mean over the classes of the distance between the distribution of the outputs there and
    /// that of all: for atoms the sum of the differences of their shares, for the density the integral (Plischke et al.
    /// 2013, eq. 26), by kernels of `part` of Silverman's width. Rows are weighted. Between 0 and 1.
    pub fn delta(&self, Partition { labels, count }: &Partition, weights: &[f64], part: f64) -> f64 {
        let mut all = ClassDistribution::new(self.atoms);
        let mut classes = vec![all.clone(); *count];
        for (row, &weight) in weights.iter().enumerate() {
            all.add(self.atom_of[row], self.scores[row], weight);
            classes[labels[row]].add(self.atom_of[row], self.scores[row], weight);
        }
        for of in classes.iter_mut().chain([&mut all]) {
            let width = part * of.spread.width() / self.step;
            of.width = if width > 0.0 { width.max(MIN_WIDTH) } else { 0.0 };
        }
        for (row, &weight) in weights.iter().enumerate() {
            if weight > 0.0 && self.atom_of[row].is_none() && all.width > 0.0 {
                let place = (self.scores[row] - self.low) / self.step;
                for of in [&mut all, &mut classes[labels[row]]].into_iter().filter(|of| of.width > 0.0) {
                    add_kernel(&mut of.density, place, of.width, weight);
                }
            }
        }
        classes.iter().map(|of| of.weight * (of.distance(&all) / 2.0).min(1.0)).sum::<f64>() / all.weight
    }
}

/// The distribution of the outputs of a class, or of all.
#[derive(Clone)]
struct ClassDistribution {
    /// The weight of all rows.
    weight: f64,
    /// The weight of each atom.
    atoms: Vec<f64>,
    /// The moments of the other rows.
    spread: Spread,
    /// The width of their kernels in steps of the grid; 0 without spread.
    width: f64,
    /// Their density times its weight, the width and sqrt(2 pi).
    density: [f64; GRID],
}

impl ClassDistribution {
    fn new(atoms: usize) -> Self {
        Self { weight: 0.0, atoms: vec![0.0; atoms], spread: Spread::default(), width: 0.0, density: [0.0; GRID] }
    }

    fn add(&mut self, atom: Option<usize>, score: f64, weight: f64) {
        self.weight += weight;
        match atom {
            Some(atom) => self.atoms[atom] += weight,
            None => self.spread.add(score, weight),
        }
    }

    /// Returns the distance from the distribution of all; 0 without rows.
    fn distance(&self, all: &Self) -> f64 {
        if self.weight == 0.0 {
            return 0.0;
        }
        let atoms =
            self.atoms.iter().zip(&all.atoms).map(|(of, all_of)| (of / self.weight - all_of / all.weight).abs());
        let atoms: f64 = atoms.sum();
        if all.width == 0.0 || self.width == 0.0 {
            // A class without spread is a point, at the maximum distance from any density.
            return atoms + (all.spread.weight / all.weight + self.spread.weight / self.weight);
        }
        let (scale, all_scale) = (self.weight * self.width, all.weight * all.width);
        let gaps = all.density.iter().zip(&self.density).map(|(all, of)| (all / all_scale - of / scale).abs());
        let gaps: Vec<f64> = gaps.collect();
        atoms + (gaps.iter().sum::<f64>() - (gaps[0] + gaps[GRID - 1]) / 2.0) / TAU.sqrt()
    }
}

/// Returns the normal quantile at the middle of each row's place among all; equal rows share theirs.
fn centred_scores(order: &Order) -> Vec<f64> {
    let ranks = order.centred_ranks();
    let rows = ranks.len() as f64;
    normal_scores(&ranks.iter().map(|rank| rank / rows + 0.5).collect::<Vec<f64>>())
}

/// Adds the kernel at `place` of that `width`, both in grid steps, times its weight and sqrt(2 pi) width.
fn add_kernel(density: &mut [f64; GRID], place: f64, width: f64, weight: f64) {
    let nearest = place.round().clamp(0.0, (GRID - 1) as f64);
    let (centre, away, step) = (nearest as usize, (nearest - place) / width, 1.0 / width);
    let top = weight * libm::exp(-away * away / 2.0);
    // From point to point the kernel changes by a ratio that itself changes by this one.
    let ratio = libm::exp(-step * step);
    let [up, down] = [away, -away].map(|away| libm::exp(-(2.0 * away + step) * step / 2.0));
    let (mut height, mut change) = (top, up);
    for point in &mut density[centre..] {
        *point += height;
        height *= change;
        change *= ratio;
    }
    (height, change) = (top * down, down * ratio);
    for point in density[..centre].iter_mut().rev() {
        *point += height;
        height *= change;
        change *= ratio;
    }
}

/// Moments of the outputs of a class.
#[derive(Clone, Default)]
struct Spread {
    weight: f64,
    mean: f64,
    squares: f64,
}

impl Spread {
    pub fn add(&mut self, z: f64, weight: f64) {
        if weight > 0.0 {
            self.weight += weight;
            let before = z - self.mean;
            self.mean += before * weight / self.weight;
            self.squares += weight * before * (z - self.mean);
        }
    }

    /// Returns Silverman's (1986) width of kernels; 0 without spread.
    pub fn width(&self) -> f64 {
        if self.squares <= 0.0 || self.weight < 2.0 {
            return 0.0;
        }
        libm::pow(0.75 * self.weight, -0.2) * (self.squares / (self.weight - 1.0)).sqrt()
    }
}

#[cfg(test)]
#[path = "tests/density.rs"]
mod tests;
