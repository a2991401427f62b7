//! Rows along random orders of the factors, used to estimate Shapley effects where there are too many subsets.
//!
//! Every base point has its own order of the players (single factors, or groups of them): a function of the seed, the
//! replicate and the number of the point. Its step k is the row A in which the first k + 1 players of that order come
//! from B (Goda 2021, Reliab. Eng. Syst. Saf. 213, 107702). For dependent factors these are drawn again given all
//! others (Song, Nelson and Staum 2016, SIAM/ASA J. Uncertain. Quantif. 4, 1060-1083). This is linear in normal scores:
//! with the correlations of the players from the last to the first as L L', and the innovations e_A = L^-1 a and e_B =
//! L^-1 b, the scores are L e, where e comes from B for the swapped players, and from A for the others, which precede
//! them.

use std::sync::Arc;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::space::{CholeskyFactor, GaussianCopula, from_score};

/// Orders have a random stream of their own, for every sampler.
const ORDER_STREAM: u64 = 1 << 60;

/// The columns of the steps of a design: those of every factor in the first step, in the second one, and so on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OrderColumns {
    /// Disjoint sets of factors that together contain all factors.
    pub players: Vec<Vec<usize>>,
    /// The index of the first of the columns among those of the base points.
    pub first: usize,
    pub factors: usize,
    pub copula: Option<Arc<GaussianCopula>>,
}

impl OrderColumns {
    /// Returns the number of rows between A and B: one less than the number of players.
    pub fn steps(&self) -> usize {
        self.players.len() - 1
    }

    /// Returns the number of columns.
    pub fn count(&self) -> usize {
        self.steps() * self.factors
    }

    /// Returns the columns of step `step`, as (factor, column).
    pub fn of_step(&self, step: usize) -> Vec<(usize, usize)> {
        (0..self.factors).map(|factor| (factor, self.first + step * self.factors + factor)).collect()
    }

    /// Fills the last columns with the steps of the base points from `first_point` on, whose orders are `orders`.
    pub fn fill(&self, orders: &Orders, first_point: u64, columns: &mut [Vec<f64>]) {
        let (own, steps) = columns.split_at_mut(self.first.min(columns.len()));
        let Some(points) = steps.first().map(Vec::len) else { return };
        let scores = |matrix: &[Vec<f64>]| self.copula.as_ref().map(|copula| copula.scores(matrix)).unwrap_or_default();
        let (a, b) = (scores(&own[..self.factors]), scores(&own[self.factors..2 * self.factors]));
        let mut stream = orders.at(first_point);
        let mut places = vec![0; self.factors];
        for point in 0..points {
            for (place, player) in stream.next_order().into_iter().enumerate() {
                self.players[player].iter().for_each(|&factor| places[factor] = place);
            }
            for (step, columns) in steps.chunks_mut(self.factors).enumerate() {
                for (factor, column) in columns.iter_mut().enumerate() {
                    let is_swapped = places[factor] <= step;
                    column[point] = own[if is_swapped { self.factors + factor } else { factor }][point];
                }
            }
            if let Some(copula) = &self.copula {
                let at_point: [Vec<f64>; 2] =
                    [&a, &b].map(|scores| copula.dependent().iter().map(|factor| scores[*factor][point]).collect());
                let redrawn = Redrawn::new(copula, &places, &at_point);
                for (step, columns) in steps.chunks_mut(self.factors).enumerate() {
                    redrawn.each(step, |factor, score| columns[factor][point] = from_score(score));
                }
            }
        }
    }
}

/// The dependent factors of one base point.
struct Redrawn {
    /// The factors of the last player first, and the position of the player in the order.
    factors: Vec<(usize, usize)>,
    lower: CholeskyFactor,
    /// The innovations of A and of B.
    innovations: [Vec<f64>; 2],
}

impl Redrawn {
    /// Prepares a base point: `places` is every factor's player's place in the order; `a`, `b` are the dependent
    /// scores.
    fn new(copula: &GaussianCopula, places: &[usize], [a, b]: &[Vec<f64>; 2]) -> Self {
        let mut numbers: Vec<usize> = (0..a.len()).collect();
        numbers.sort_by_key(|number| std::cmp::Reverse(places[copula.dependent()[*number]]));
        let factors: Vec<usize> = numbers.iter().map(|number| copula.dependent()[*number]).collect();
        let lower = CholeskyFactor::new(factors.len(), |row, column| copula.correlation(factors[row], factors[column]));
        let [a, b] =
            [a, b].map(|scores| lower.whiten(&numbers.iter().map(|number| scores[*number]).collect::<Vec<f64>>()));
        Self {
            factors: factors.into_iter().map(|factor| (factor, places[factor])).collect(),
            lower,
            innovations: [a, b],
        }
    }

    /// Calls `of_factor` with the score of every factor that is swapped in step `step` and drawn given others.
    fn each(&self, step: usize, mut of_factor: impl FnMut(usize, f64)) {
        let kept = self.factors.partition_point(|(_, place)| *place > step);
        if kept == 0 {
            // Given nothing, the scores are those of B, to the last bit.
            return;
        }
        let [a, b] = &self.innovations;
        let e = [&a[..kept], &b[kept..]].concat();
        for row in kept..self.factors.len() {
            of_factor(self.factors[row].0, self.lower.score(row, &e));
        }
    }
}

/// The orders of the players at the base points of one replicate.
#[derive(Debug, Clone)]
pub(super) struct Orders {
    stream: ChaCha8Rng,
    players: usize,
}

impl Orders {
    pub fn new(players: usize, seed: u64, replicate: u64) -> Self {
        let mut stream = ChaCha8Rng::seed_from_u64(seed);
        stream.set_stream(replicate | ORDER_STREAM);
        Self { stream, players }
    }

    /// Returns the orders from base point `first` on.
    pub fn at(&self, first: u64) -> Self {
        let mut orders = self.clone();
        orders.stream.set_word_pos(u128::from(first) * self.players as u128);
        orders
    }

    /// Returns the players in the order of the next base point (Fisher and Yates); all orders are equally likely to
    /// within 1e-8. Takes one word of the stream for each player.
    pub fn next_order(&mut self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.players).collect();
        for left in (1..=self.players).rev() {
            let place = (u64::from(self.stream.next_u32()) * left as u64) >> 32;
            order.swap(left - 1, place as usize);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::design::{Design, DesignSettings, RowKind, Rows, Sampler};
    use crate::space::normal_scores;

    fn design(sampler: Sampler, players: Vec<Vec<usize>>, copula: Option<GaussianCopula>) -> Design {
        let settings = DesignSettings { sampler, base_samples: 64, replicates: 4, seed: 3 };
        let swaps = (0..4).map(|factor| vec![factor]).collect();
        let redrawn = if copula.is_some() { (0..4).collect() } else { Vec::new() };
        Design::new(settings, 4, Rows { swaps, redrawn, players, copula: copula.map(Arc::new), ..Rows::default() })
            .unwrap()
    }

    fn single() -> Vec<Vec<usize>> {
        (0..4).map(|factor| vec![factor]).collect()
    }

    fn point(design: &Design, row: u64) -> [f64; 4] {
        let mut u = [0.0; 4];
        design.point(row, &mut u);
        u
    }

    #[test]
    fn steps_take_one_player_after_another_from_b() {
        for sampler in Sampler::ALL {
            for players in [single(), vec![vec![1, 3], vec![0], vec![2]], vec![vec![0, 1, 2, 3]]] {
                let design = design(sampler, players.clone(), None);
                let (rows, steps) = (design.rows_per_point(), design.step_runs());
                assert_eq!((rows, steps.len()), (6 + players.len() as u64 - 1, players.len() - 1));
                for base in [0, 5, 17, 63] {
                    let order = design.orders(base / 16, base % 16, 1).remove(0);
                    let (mut row, b) = (point(&design, base * rows), point(&design, base * rows + 1));
                    for (step, player) in order[..players.len() - 1].iter().enumerate() {
                        players[*player].iter().for_each(|factor| row[*factor] = b[*factor]);
                        let number = base * rows + steps[step] as u64;
                        assert_eq!(point(&design, number), row, "{sampler:?}");
                        assert_eq!(design.locate(number).2, RowKind::Step(step));
                    }
                }
            }
        }
    }

    #[test]
    fn a_player_is_drawn_given_all_that_come_after_it() {
        let mut r = DMatrix::identity(4, 4);
        for (i, j, value) in [(0, 1, 0.6), (0, 3, -0.3), (1, 3, 0.2)] {
            (r[(i, j)], r[(j, i)]) = (value, value);
        }
        let copula = GaussianCopula::new(r).unwrap();
        let design = design(Sampler::Sobol, single(), Some(copula.clone()));
        let rows = design.rows_per_point();
        for base in 0..64 {
            let order = design.orders(base / 16, base % 16, 1).remove(0);
            let row = |run: usize| point(&design, base * rows + run as u64);
            let (a, b) = (row(0), row(1));
            let close = |one: [f64; 4], other: [f64; 4]| one.iter().zip(other).all(|(x, y)| (x - y).abs() < 1e-12);
            // The first player alone is the row in which it is redrawn.
            assert!(close(row(design.step_runs()[0]), row(design.ab_runs()[order[0]])));
            // All others: drawn given the last one, z = b + r (a - b) of the last.
            let last = order[3];
            let score = |u: f64| normal_scores(&[u])[0];
            let moved = std::array::from_fn(|j| match j == last {
                true => a[j],
                false => from_score(score(b[j]) + copula.correlation(j, last) * (score(a[last]) - score(b[last]))),
            });
            assert!(close(row(design.step_runs()[2]), moved), "{base}");
        }
    }

    #[test]
    fn orders_are_all_as_likely_and_the_same_from_anywhere() {
        let orders = Orders::new(3, 1, 2);
        let mut all = orders.at(0);
        let all: Vec<Vec<usize>> = (0..6000).map(|_| all.next_order()).collect();
        let mut later = orders.at(4321);
        assert_eq!(later.next_order(), all[4321]);
        let mut kinds = std::collections::BTreeMap::new();
        all.iter().for_each(|order| *kinds.entry(order.clone()).or_insert(0) += 1);
        assert_eq!(kinds.len(), 6);
        assert!(kinds.values().all(|count| (850..1150).contains(count)), "{kinds:?}");
        let start = |seed, replicate| {
            let mut orders = Orders::new(30, seed, replicate).at(0);
            orders.next_order()
        };
        assert!(start(1, 2) != start(1, 3) && start(1, 2) != start(2, 2));
    }
}
