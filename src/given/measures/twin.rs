//! A twin of an input and an output: made to look like them, and of a delta that is known, so that it shows by how much an estimate
//! of delta is off.
//!
//! Estimates from kernels in classes are too small where the output goes on changing with the input inside a class and where
//! kernels are wide, and too large where rows are few. Resampling rows shows only the last of these. In each class of the input the
//! twin is a straight line of the output against the rank of the input, with the residuals there, each with a kernel around it: a
//! smoothed bootstrap (Efron 1979, Ann. Stat. 7, 1-26) of a model with a density for every value of the input.

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::density::{Spread, add_kernel};

/// Points of the grid that its densities are compared on.
const GRID: usize = 200;
/// How far the grid reaches beyond the outputs, in parts of their range.
const BEYOND: f64 = 0.5;
/// Values of the input in each class at which its density is looked at.
const NODES: usize = 4;
/// Fewest rows of a class that a line with residuals is made of.
const FEWEST_ROWS: usize = 4;

/// The twin.
pub struct Twin<'a> {
    /// The class of every row.
    labels: &'a [usize],
    classes: Vec<Line>,
    range: (f64, f64),
}

/// The output in one class of the input.
struct Line {
    mean: f64,
    slope: f64,
    /// Ranks of the input less their mean, in rising order.
    ranks: Vec<f64>,
    residuals: Vec<f64>,
    /// Of the kernel around a residual.
    width: f64,
}

impl Line {
    /// The line through these rows (rank, output); `None` if they are too few, or leave nothing.
    fn new(mut rows: Vec<(f64, f64)>) -> Option<Self> {
        if rows.len() < FEWEST_ROWS {
            return None;
        }
        rows.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = rows.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| rows.iter().map(of).sum::<f64>() / count;
        let (centre, mean) = (mean(|row| row.0), mean(|row| row.1));
        let ranks: Vec<f64> = rows.iter().map(|row| row.0 - centre).collect();
        let squares: f64 = ranks.iter().map(|rank| rank * rank).sum();
        let products: f64 = ranks.iter().zip(&rows).map(|(rank, row)| rank * (row.1 - mean)).sum();
        let fitted = if squares > 0.0 { products / squares } else { 0.0 };
        let residual = |slope: f64| ranks.iter().zip(&rows).map(move |(rank, row)| row.1 - mean - slope * rank);
        // A slope is drawn towards 0 by as much as it is noise.
        let noise = residual(fitted).map(|r| r * r).sum::<f64>() / (count - 2.0) / squares;
        let slope = if fitted * fitted > noise { fitted * (1.0 - noise / (fitted * fitted)) } else { 0.0 };
        let residuals: Vec<f64> = residual(slope).collect();
        let mut spread = Spread::default();
        residuals.iter().for_each(|residual| spread.add(*residual, 1.0));
        let width = spread.width();
        (width > 0.0).then_some(Self { mean, slope, ranks, residuals, width })
    }

    fn at(&self, rank: f64) -> f64 {
        self.mean + self.slope * rank
    }
}

impl<'a> Twin<'a> {
    /// That of outputs `z` whose rows have these ranks of the input and are in these classes; `None` where the output of a class
    /// has no spread, or too few rows.
    pub fn new(z: &[f64], ranks: &[f64], (labels, count): &'a (Vec<usize>, usize)) -> Option<Self> {
        let mut rows = vec![Vec::new(); *count];
        labels.iter().zip(ranks.iter().zip(z)).for_each(|(&label, (rank, z))| rows[label].push((*rank, *z)));
        let classes = rows.into_iter().map(Line::new).collect::<Option<Vec<Line>>>()?;
        let (low, high) =
            z.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(*z), high.max(*z)));
        Some(Self { labels, classes, range: (low, high) })
    }

    /// Its delta: half of the mean distance between its density where the input is known, and overall.
    pub fn delta(&self) -> f64 {
        let (low, high) = self.range;
        let beyond = BEYOND * (high - low);
        let (low, step) = (low - beyond, (high - low + 2.0 * beyond) / (GRID - 1) as f64);
        let mut all = [0.0; GRID];
        let mut nodes: Vec<(f64, [f64; GRID])> = Vec::with_capacity(NODES * self.classes.len());
        for line in &self.classes {
            let (width, rows) = (line.width / step, line.residuals.len());
            // The densities of a class have an integral of 1 in all.
            let weight = 1.0 / (rows as f64 * width * std::f64::consts::TAU.sqrt());
            for node in 0..NODES {
                let fitted = line.at(line.ranks[(2 * node + 1) * rows / (2 * NODES)]);
                let mut density = [0.0; GRID];
                for residual in &line.residuals {
                    add_kernel(&mut density, (fitted + residual - low) / step, width, weight);
                }
                let share = rows as f64 / (self.labels.len() * NODES) as f64;
                all.iter_mut().zip(&density).for_each(|(all, own)| *all += share * own);
                nodes.push((share, density));
            }
        }
        let gap = |own: &[f64; GRID]| all.iter().zip(own).map(|(all, own)| (all - own).abs()).sum::<f64>();
        nodes.iter().map(|(share, density)| share * gap(density)).sum::<f64>() / 2.0
    }

    /// Outputs of as many rows in the same classes.
    pub fn outputs(&self, random: &mut impl RngExt) -> Vec<f64> {
        let row = |label: &usize| {
            let line = &self.classes[*label];
            let [rank, residual] = [&line.ranks, &line.residuals]
                .map(|values| values[random.random_range(0..values.len() as u64) as usize]);
            let normal: f64 = StandardNormal.sample(&mut *random);
            line.at(rank) + residual + line.width * normal
        };
        self.labels.iter().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::given::order::Order;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    /// y = x + e of uniform x and normal e of a hundredth of its range: nearly a function, of which classes see little. By the exact
    /// density of the sum, delta is 0.9401.
    #[test]
    fn its_delta_goes_on_inside_a_class() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let x: Vec<f64> = (0..4000).map(|k| (f64::from(k) + 0.5) / 4000.0).collect();
        let e = |random: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(random) };
        let z: Vec<f64> = x.iter().map(|x| x + 0.01 * e(&mut random)).collect();
        let order = Order::of(&x);
        let classes = order.classes(8);
        let twin = Twin::new(&z, &order.centred_ranks(), &classes).unwrap();
        let found = twin.delta();
        assert!((found - 0.9401).abs() < 0.012, "{found}");
        let outputs = twin.outputs(&mut random);
        let gap = outputs.iter().zip(&z).map(|(twin, z)| (twin - z).abs()).sum::<f64>() / 4000.0;
        assert!(gap < 1.0 / 8.0, "outputs lie in the class of their row: {gap}");
    }

    #[test]
    fn an_input_that_does_nothing_has_a_small_delta_and_points_have_no_twin() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let x: Vec<f64> = (0..4000).map(f64::from).collect();
        let z: Vec<f64> = x.iter().map(|_| StandardNormal.sample(&mut random)).collect();
        let order = Order::of(&x);
        let classes = order.classes(8);
        let found = Twin::new(&z, &order.centred_ranks(), &classes).unwrap().delta();
        assert!(found < 0.06, "{found}");
        let steps: Vec<f64> = classes.0.iter().map(|label| *label as f64).collect();
        assert!(Twin::new(&steps, &order.centred_ranks(), &classes).is_none());
        // Of an input with a value for each class there is no line.
        let input = Order::of(&steps);
        assert!(Twin::new(&z, &input.centred_ranks(), &classes).unwrap().delta() < 0.06);
    }
}
