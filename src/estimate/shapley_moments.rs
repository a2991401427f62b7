//! Sums for Shapley effects estimated along random orders of the factors.

use crate::design::Design;

/// Sums of what every player adds to those before it in the order of a base point, over the base points at which all
/// the required rows have an output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ShapleyMoments {
    /// Number of base points.
    pub n: u64,
    /// The sum of each player.
    pub sums: Vec<f64>,
}

impl ShapleyMoments {
    /// Sums the columns of [`contributions`], one for each player.
    pub(super) fn from_contributions(contributions: &[&[f64]]) -> Self {
        let points = contributions.first().map_or(0, |column| column.len());
        let mut moments = Self { n: 0, sums: vec![0.0; contributions.len()] };
        for point in (0..points).filter(|point| contributions[0][*point].is_finite()) {
            moments.n += 1;
            moments.sums.iter_mut().zip(contributions).for_each(|(sum, column)| *sum += column[point]);
        }
        moments
    }

    /// Adds other base points.
    pub(super) fn merge(&mut self, other: &Self) {
        self.n += other.n;
        self.sums.iter_mut().zip(&other.sums).for_each(|(mine, theirs)| *mine += theirs);
    }

    /// Returns the Shapley effects of the players, which sum to 1: their sums over that of all. NaN if nothing varies.
    pub fn effects(&self) -> Vec<f64> {
        let all: f64 = self.sums.iter().sum();
        let share = |sum: &f64| if all > 0.0 { sum / all } else { f64::NAN };
        self.sums.iter().map(share).collect()
    }
}

/// Computes what every player adds at the base points of `replicate` from number `first` on, with the outputs `runs`: a
/// column for each player; not finite where a required row has failed. Empty without rows along random orders.
///
/// With y_k the output after k players of the order, y_0 of A and y_d of B, c = E Var(Y | all that are not swapped) of
/// k players is estimated by (y_k - y_0)^2/2 (Jansen 1999; Goda 2021, Reliab. Eng. Syst. Saf. 213, 107702, algorithm
/// 1), so that player k adds (y_k - y_(k-1)) (y_k + y_(k-1) - 2 y_0)/2. For independent factors the same rows are a
/// walk from B to A in the reverse order; the mean of both is (y_k - y_(k-1)) (y_d - y_0)/2, of about half the
/// variance. The sum over the players is (y_d - y_0)^2/2 in both.
pub fn contributions(design: &Design, replicate: u64, first: u64, runs: &[&[f64]]) -> Vec<Vec<f64>> {
    let players = design.asked().players.len();
    let [a, b, ..] = runs else { return Vec::new() };
    if players == 0 {
        return Vec::new();
    }
    let points = a.len();
    let mut columns = vec![vec![0.0; points]; players];
    for (point, order) in design.orders(replicate, first, points).into_iter().enumerate() {
        let (start, end) = (a[point], b[point]);
        let steps = design.step_runs().iter().map(|run| runs[*run][point]);
        let mut before = start;
        let mut is_whole = start.is_finite();
        for (player, after) in order.into_iter().zip(steps.chain([end])) {
            is_whole &= after.is_finite();
            let other = if design.is_dependent() { (after - start) + (before - start) } else { end - start };
            columns[player][point] = (after - before) * other / 2.0;
            before = after;
        }
        if !is_whole {
            columns.iter_mut().for_each(|column| column[point] = f64::NAN);
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{DesignSettings, Rows};

    #[test]
    fn contributions_of_players_are_those_of_the_steps_and_sum_to_the_total() {
        let settings = DesignSettings { base_samples: 8, replicates: 2, ..DesignSettings::default() };
        let players = (0..3).map(|factor| vec![factor]).collect();
        let design = Design::new(settings, 3, Rows { players, ..Rows::default() }).unwrap();
        assert_eq!(design.step_runs(), [2, 3]);
        // A, B and two steps, at two base points; a step is missing at the second.
        let runs: [&[f64]; 4] = [&[1.0, 1.0], &[7.0, 7.0], &[2.0, 2.0], &[5.0, f64::NAN]];
        let added = contributions(&design, 1, 2, &runs);
        let order = design.orders(1, 2, 1).remove(0);
        let of_first: Vec<f64> = order.iter().map(|player| added[*player][0]).collect();
        assert_eq!(of_first, [3.0, 9.0, 6.0], "half of 6 times the steps of 1, 3 and 2");
        assert!(added.iter().all(|column| column[1].is_nan()));
        let columns: Vec<&[f64]> = added.iter().map(Vec::as_slice).collect();
        let mut moments = ShapleyMoments::from_contributions(&columns);
        moments.merge(&moments.clone());
        assert_eq!((moments.n, moments.sums.iter().sum::<f64>()), (2, 36.0));
        assert_eq!(moments.effects()[order[1]], 0.5);
        assert!(ShapleyMoments { n: 1, sums: vec![0.0; 2] }.effects()[0].is_nan());
    }
}
