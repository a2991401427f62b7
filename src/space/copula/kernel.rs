//! The copula of joint measurements, by kernels around their normal scores.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::chain::{Chain, Mixture};
use super::{GaussianCopula, from_score};
use crate::special::normal_quantile;

/// Joint measurements as normal scores of their ranks, and the width of kernels that describes them best.
///
/// A kernel is a normal distribution around a measurement that is drawn towards the middle, z = sqrt(1 - h^2) z_i + h e, where e has
/// the correlations S of all measurements: the mixture then keeps these correlations (Silverman and Young 1987, Biometrika 74,
/// 469-479, the smoothed bootstrap of unchanged variance). At h = 1 it is the Gaussian copula, as h falls to 0 the measurements
/// themselves. Of the widths from 1 down that one is taken under which each measurement is likeliest given all others (Duin 1976, IEEE
/// Trans. Comput. 25, 1175-1179).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Joint {
    /// A list for each factor.
    pub scores: Arc<Vec<Vec<f64>>>,
    /// The width h of the kernels.
    pub width: f64,
    /// How much likelier a measurement is than under the Gaussian copula: the mean logarithm of the ratio of densities.
    pub gain: f64,
}

/// Widths are 2^(-k/4) for k from 0 up to this: 0.088 at least.
const WIDTHS: i32 = 14;

/// Measurements whose likelihood is asked for, of more as many spread evenly.
const LEFT_OUT: usize = 500;

impl Joint {
    /// Of these normal scores, a list for each factor, whose correlations are `correlation`.
    pub fn new(scores: Vec<Vec<f64>>, correlation: &DMatrix<f64>) -> Self {
        let (width, gain) = match GaussianCopula::new(correlation.clone()) {
            Ok(_) => best_width(&scores, correlation),
            // Refused where the copula of the study is made.
            Err(_) => (1.0, 0.0),
        };
        Self { scores: Arc::new(scores), width, gain }
    }
}

fn best_width(scores: &[Vec<f64>], correlation: &DMatrix<f64>) -> (f64, f64) {
    let order: Vec<usize> = (0..scores.len()).collect();
    let rows = scores[0].len();
    // Where kernels are round.
    let whitener = Chain::new(1.0, correlation, scores, &order);
    let points: Vec<Vec<f64>> =
        (0..rows).map(|row| whitener.whiten(&scores.iter().map(|column| column[row]).collect::<Vec<f64>>())).collect();
    let left_out: Vec<usize> = (0..rows.min(LEFT_OUT)).map(|k| k * rows / rows.min(LEFT_OUT)).collect();
    let likelihood = |width: f64| -> f64 {
        let (towards, dimensions) = ((1.0 - width * width).max(0.0).sqrt(), scores.len() as f64);
        let of_row = |&row: &usize| {
            let point = &points[row];
            // A measurement that was made twice does not speak for itself.
            let others = points.iter().filter(|other| *other != point);
            let distance = |other: &Vec<f64>| -> f64 {
                point.iter().zip(other).map(|(a, b)| (a - towards * b).powi(2)).sum::<f64>() / (2.0 * width * width)
            };
            let distances: Vec<f64> = others.map(distance).collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
            let sum: f64 = distances.iter().map(|distance| libm::exp(least - distance)).sum();
            if distances.is_empty() {
                0.0
            } else {
                libm::log(sum / distances.len() as f64) - least - dimensions * libm::log(width)
            }
        };
        left_out.iter().map(of_row).sum::<f64>() / left_out.len() as f64
    };
    let normal = likelihood(1.0);
    let mut best = (1.0, 0.0);
    for k in 1..=WIDTHS {
        let width = libm::exp2(-f64::from(k) / 4.0);
        let gain = likelihood(width) - normal;
        if gain > best.1 {
            best = (width, gain);
        }
    }
    best
}

/// The copula of some factors of a space that joint measurements have made.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct KernelCopula {
    /// In rising order.
    factors: Vec<usize>,
    width: f64,
    correlation: DMatrix<f64>,
    centres: Arc<Vec<Vec<f64>>>,
    margins: Vec<Margin>,
    /// The factors in their order.
    chain: Chain,
}

impl KernelCopula {
    /// The copula of the factors of these numbers with the measurements `joint`, whose lists are in the order of `factors`, and the
    /// positive definite correlations of their scores.
    pub fn new(factors: &[usize], joint: &Joint, correlation: &[Vec<f64>]) -> Self {
        let mut places: Vec<usize> = (0..factors.len()).collect();
        places.sort_by_key(|place| factors[*place]);
        let correlation = DMatrix::from_fn(places.len(), places.len(), |i, j| correlation[places[i]][places[j]]);
        let towards = (1.0 - joint.width * joint.width).sqrt();
        let centres: Vec<Vec<f64>> =
            places.iter().map(|place| joint.scores[*place].iter().map(|score| towards * score).collect()).collect();
        let order: Vec<usize> = (0..places.len()).collect();
        Self {
            factors: places.iter().map(|place| factors[*place]).collect(),
            width: joint.width,
            margins: centres.iter().map(|centres| Margin::new(centres, joint.width)).collect(),
            chain: Chain::new(joint.width, &correlation, &centres, &order),
            correlation,
            centres: Arc::new(centres),
        }
    }

    /// Its factors, in rising order.
    pub fn factors(&self) -> &[usize] {
        &self.factors
    }

    /// Its factors in another order, by their places among [`factors`](Self::factors).
    pub fn chain(&self, order: &[usize]) -> Chain {
        Chain::new(self.width, &self.correlation, &self.centres, order)
    }

    /// The score of the factor at `place` that has the coordinate `u`.
    pub fn score(&self, place: usize, u: f64) -> f64 {
        self.margins[place].inverse(normal_quantile(u))
    }

    /// The coordinate that has this score.
    pub fn coordinate(&self, place: usize, score: f64) -> f64 {
        from_score(self.margins[place].of(score))
    }

    /// Points with independent coordinates become dependent; the first factor keeps its own.
    pub fn correlate(&self, columns: &mut [Vec<f64>]) {
        for point in 0..columns[self.factors[0]].len() {
            let first = self.score(0, columns[self.factors[0]][point]);
            let innovations: Vec<f64> =
                self.factors[1..].iter().map(|&factor| normal_quantile(columns[factor][point])).collect();
            let e = self.chain.point(&[first], &innovations);
            for (place, &factor) in self.factors.iter().enumerate().skip(1) {
                columns[factor][point] = self.coordinate(place, self.chain.score(place, &e));
            }
        }
    }
}

/// The distribution of the scores of one factor, as normal scores: nearly a straight line. Between the points of a table it is a
/// cubic, to some 1e-9, whose inverse is exact.
#[derive(Debug, Clone, PartialEq)]
struct Margin {
    low: f64,
    step: f64,
    /// Normal scores, and their slopes per step.
    points: Vec<(f64, f64)>,
}

/// Steps of the table.
const STEPS: usize = 1024;

/// Widths beyond the outermost measurement: to 2^-64 and 1 - 2^-53.
const MARGIN: f64 = 9.5;

impl Margin {
    fn new(centres: &[f64], width: f64) -> Self {
        let low = centres.iter().copied().fold(f64::INFINITY, f64::min) - MARGIN * width;
        let high = centres.iter().copied().fold(f64::NEG_INFINITY, f64::max) + MARGIN * width;
        let mixture = Mixture { centres: centres.to_vec(), weights: &vec![1.0; centres.len()], width };
        let step = (high - low) / STEPS as f64;
        let point = |k: usize| {
            let x = low + step * k as f64;
            let score = mixture.normal_score(x);
            (score, step * mixture.slope(x, score))
        };
        Self { low, step, points: (0..=STEPS).map(point).collect() }
    }

    /// The cubic of a cell at `t` of its length.
    fn cubic(&self, cell: usize, t: f64) -> f64 {
        let ((a, slope_a), (b, slope_b)) = (self.points[cell], self.points[cell + 1]);
        let rise = b - a;
        a + t * (slope_a + t * (3.0 * rise - 2.0 * slope_a - slope_b + t * (slope_a + slope_b - 2.0 * rise)))
    }

    fn of(&self, score: f64) -> f64 {
        let place = ((score - self.low) / self.step).clamp(0.0, STEPS as f64);
        let cell = (place as usize).min(STEPS - 1);
        self.cubic(cell, place - cell as f64)
    }

    fn inverse(&self, normal_score: f64) -> f64 {
        let after = self.points.partition_point(|(score, _)| *score <= normal_score);
        let cell = after.saturating_sub(1).min(STEPS - 1);
        let ((a, slope_a), (b, slope_b)) = (self.points[cell], self.points[cell + 1]);
        let rise = b - a;
        let mut t = ((normal_score - a) / rise).clamp(0.0, 1.0);
        // Newton's steps: the cubic is nearly straight.
        for _ in 0..20 {
            let slope = slope_a
                + t * (2.0 * (3.0 * rise - 2.0 * slope_a - slope_b) + 3.0 * t * (slope_a + slope_b - 2.0 * rise));
            let next = (t - (self.cubic(cell, t) - normal_score) / slope).clamp(0.0, 1.0);
            let change = (next - t).abs();
            t = next;
            if change < 1e-13 {
                break;
            }
        }
        self.low + self.step * (cell as f64 + t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::SobolSequence;

    /// Scores of `rows` points on a ring, and their correlations.
    fn ring(rows: usize) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / rows as f64;
        let radius = |k: usize| 1.4 + 0.2 * libm::sin(7.0 * k as f64);
        let scores = vec![
            (0..rows).map(|k| radius(k) * libm::cos(angle(k))).collect(),
            (0..rows).map(|k| radius(k) * libm::sin(angle(k))).collect(),
        ];
        (scores, vec![vec![1.0, 0.0], vec![0.0, 1.0]])
    }

    fn matrix(rows: &[Vec<f64>]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j])
    }

    fn points(dimensions: usize, count: usize) -> Vec<Vec<f64>> {
        let sequence = SobolSequence::scrambled(dimensions, 5, 0);
        let mut columns = vec![vec![0.0; count]; dimensions];
        columns.iter_mut().enumerate().for_each(|(j, column)| sequence.fill(j, 0, column));
        columns
    }

    #[test]
    fn margins_stay_uniform_and_points_lie_where_the_measurements_do() {
        let (scores, correlation) = ring(300);
        let joint = Joint::new(scores, &matrix(&correlation));
        // A ring is nothing like a normal distribution.
        assert!(joint.width < 0.4 && joint.gain > 0.3, "{} {}", joint.width, joint.gain);
        let copula = KernelCopula::new(&[3, 1], &joint, &correlation);
        assert_eq!(copula.factors(), [1, 3]);
        let mut columns = points(4, 4096);
        let before = columns.clone();
        copula.correlate(&mut columns);
        assert_eq!((&columns[..3], columns[3] == before[3]), (&before[..3], false));
        for column in [&columns[1], &columns[3]] {
            let mut sorted = column.clone();
            sorted.sort_by(f64::total_cmp);
            let far = sorted.iter().enumerate().map(|(k, u)| (u - (k as f64 + 0.5) / 4096.0).abs());
            assert!(far.fold(0.0, f64::max) < 0.01);
        }
        let inside = (0..4096).filter(|&k| {
            let [x, y] = [0, 1].map(|place| copula.score(place, columns[copula.factors()[place]][k]));
            x.hypot(y) < 0.5
        });
        assert!(inside.count() < 4096 / 40);
    }

    #[test]
    fn kernels_of_full_width_are_the_gaussian_copula() {
        let correlation = vec![vec![1.0, 0.6, -0.2], vec![0.6, 1.0, 0.3], vec![-0.2, 0.3, 1.0]];
        let joint = Joint { scores: Arc::new(vec![vec![0.4; 10]; 3]), width: 1.0, gain: 0.0 };
        let kernels = KernelCopula::new(&[0, 1, 2], &joint, &correlation);
        let mut columns = points(3, 256);
        let mut expected = columns.clone();
        kernels.correlate(&mut columns);
        GaussianCopula::new(matrix(&correlation)).unwrap().correlate(&mut expected);
        for (found, expected) in columns.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }

    #[test]
    fn tables_of_margins_are_exact_enough_and_inverse() {
        let centres: Vec<f64> = (0..40).map(|k| libm::sin(f64::from(k)) * 2.0).collect();
        for width in [0.088, 0.5, 1.0] {
            let margin = Margin::new(&centres, width);
            let mixture = Mixture { centres: centres.clone(), weights: &[1.0; 40], width };
            for k in -90..=81 {
                let score = f64::from(k) / 10.0 + 0.0137;
                let x = margin.inverse(score);
                assert!((margin.of(x) - score).abs() < 1e-12 * score.abs().max(1.0), "{width} {score}");
                assert!(
                    (mixture.quantile(score) - x).abs() < 3e-7 * width,
                    "{width} {score}: {x} {}",
                    mixture.quantile(score)
                );
            }
        }
    }

    #[test]
    fn normal_measurements_ask_for_wide_kernels_and_repeated_ones_say_nothing_new() {
        let mut columns = points(2, 512);
        let correlation = matrix(&[vec![1.0, 0.5], vec![0.5, 1.0]]);
        GaussianCopula::new(correlation.clone()).unwrap().correlate(&mut columns);
        let scores: Vec<Vec<f64>> = columns.iter().map(|column| super::super::normal_scores(column)).collect();
        let joint = Joint::new(scores.clone(), &correlation);
        assert!(joint.width > 0.5 && joint.gain < 0.02, "{} {}", joint.width, joint.gain);
        let twice: Vec<Vec<f64>> = scores.iter().map(|column| [&column[..250], &column[..250]].concat()).collect();
        assert!(Joint::new(twice, &correlation).width > 0.4);
    }
}
