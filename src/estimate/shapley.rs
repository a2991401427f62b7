//! Shapley effects: the share of the variance due to each factor, for dependent factors as well; they sum to 1. In place
//! of factors there may be groups of them: the effect of a group is the joint contribution of its factors in addition to
//! the groups before it, the value of the game between unions (Owen 1977, in Mathematical Economics and Game Theory,
//! Springer, 76-88).

/// Maximum number of factors or groups for Shapley effects from all subsets: every base point costs 2^d runs.
pub const MAX_SHAPLEY_FACTORS: usize = 8;

/// Returns the proper subsets of `factors` factors with at least two elements, in rising order of their bit mask.
pub fn proper_subsets(factors: usize) -> Vec<Vec<usize>> {
    let masks = (0..1usize << factors).filter(|mask| (2..factors as u32).contains(&mask.count_ones()));
    masks.map(|mask| (0..factors).filter(|factor| mask >> factor & 1 == 1).collect()).collect()
}

/// Computes the Shapley effects of factors from c(u) = E Var(Y | all factors but u)/Var(Y) of all subsets u: the mean,
/// over all orders of the factors, of what a factor adds to those before it (Owen 2014, SIAM/ASA J. Uncertain. Quantif.
/// 2, 245-251; Song, Nelson and Staum 2016, SIAM/ASA J. Uncertain. Quantif. 4, 1060-1083, eq. 6 and theorem 1).
/// `single` is c of each factor alone, `proper` those of [`proper_subsets`]; c is 0 for no factor and 1 for all.
pub fn shapley_effects(single: &[f64], proper: &[f64]) -> Vec<f64> {
    let factors = single.len();
    let mut costs = vec![0.0; 1 << factors];
    let mut proper = proper.iter();
    for (mask, cost) in costs.iter_mut().enumerate().skip(1) {
        *cost = match mask.count_ones() as usize {
            size if size == factors => 1.0,
            1 => single[mask.trailing_zeros() as usize],
            _ => proper.next().copied().unwrap_or(f64::NAN),
        };
    }
    // 1/d over the number of subsets of a size among the other factors.
    let mut weights = vec![1.0 / factors as f64; factors];
    for size in 1..factors {
        weights[size] = weights[size - 1] * size as f64 / (factors - size) as f64;
    }
    let mut effects = vec![0.0; factors];
    for (factor, effect) in effects.iter_mut().enumerate() {
        for mask in (0..costs.len()).filter(|mask| mask >> factor & 1 == 0) {
            *effect += weights[mask.count_ones() as usize] * (costs[mask | 1 << factor] - costs[mask]);
        }
    }
    effects
}

#[cfg(test)]
#[path = "tests/shapley.rs"]
mod tests;
