use super::*;
use crate::design::{Design, DesignError, DesignSettings, Rows, Sampler, SobolSequence};

/// Coordinates of the first 2^m points in their natural order, bits reversed.
fn coordinates(directions: &Directions, m: usize) -> Vec<u32> {
    let mut all = vec![0];
    for direction in &directions[..m] {
        let shifted: Vec<u32> = all.iter().map(|x| x ^ direction).collect();
        all.extend(shifted);
    }
    all
}

/// Sum over the dual vectors of two matrices, both of their parts nonzero, of 8^(m - k), k the sum of the leading places.
fn pair_cost([a, b]: [&Directions; 2], m: usize) -> f64 {
    let phi = |x: u32| {
        let sum: f64 = (0..x.trailing_zeros()).map(|place| 0.5 * 0.25f64.powi(place as i32 + 1)).sum();
        sum - 0.5 * 0.25f64.powi(x.trailing_zeros() as i32 + 1)
    };
    let (a, b) = (coordinates(a, m), coordinates(b, m));
    a.iter().zip(&b).map(|(a, b)| phi(*a) * phi(*b)).sum::<f64>() * 4f64.powi(m as i32)
}

#[test]
fn the_table_is_complete_and_every_matrix_is_upper_triangular() {
    assert_eq!(lines().count(), MAX_SEARCHED_FACTORS * (MAX_SEARCHED_FACTORS + 1) / 2);
    for line in lines() {
        let mut words = line.split(' ');
        let d: usize = words.next().and_then(|d| d.parse().ok()).expect("a number of factors");
        let columns = if d <= 12 { 20 } else { 16 };
        let bits: usize = columns * (columns - 1) / 2;
        assert!(words.clone().count() == 2 && words.all(|digits| digits.len() == bits.div_ceil(4)), "{line}");
    }
    for directions in (1..=MAX_SEARCHED_FACTORS).flat_map(pairs).flatten() {
        for (k, entry) in directions.iter().enumerate() {
            // A one on the diagonal and zeros below it: this is what makes each coordinate a (0, 1)-sequence.
            assert_eq!(entry.checked_ilog2(), Some(k as u32));
        }
    }
    for d in 1..=MAX_SEARCHED_FACTORS {
        let mut different = pairs(d).concat();
        different.sort_unstable();
        different.dedup();
        assert_eq!(different.len(), 2 * d, "no matrix occurs twice");
    }
}

#[test]
fn nets_of_every_coordinate_are_nested() {
    for d in [1, 2, 7, 64] {
        for directions in pairs(d).iter().flatten() {
            let all = coordinates(directions, 12);
            for m in 1..=12 {
                let mut cells: Vec<u32> = all[..1 << m].iter().map(|x| x.reverse_bits() >> (32 - m)).collect();
                cells.sort_unstable();
                assert!(cells.iter().copied().eq(0..1 << m), "d = {d}, m = {m}");
            }
        }
    }
}

#[test]
fn the_two_matrices_of_a_factor_fit_better_than_those_of_the_sobol_sequence() {
    for d in [3, 5, 10, 20, 40, 64] {
        let levels = 4..=13;
        let mean = |of: &dyn Fn(usize) -> [&'static Directions; 2], m: usize| {
            (0..d).map(|i| pair_cost(of(i), m)).sum::<f64>() / d as f64
        };
        let searched = |i: usize| [&pairs(d)[i][0], &pairs(d)[i][1]];
        let plain = |i: usize| [&directions(2 * d)[i], &directions(2 * d)[d + i]];
        let gain = |m: usize| libm::log(mean(&plain, m) / mean(&searched, m));
        let gain = libm::exp(levels.clone().map(gain).sum::<f64>() / levels.count() as f64);
        assert!(gain > if d < 5 { 1.2 } else { 2.0 }, "d = {d}: {gain}");
    }
}

#[test]
fn every_replicate_deals_whole_pairs_to_the_factors() {
    let d = 7;
    let order = |seed, replicate| -> Vec<usize> {
        let sequence = SobolSequence::pick_freeze(d, 3, seed, replicate);
        let place = |i: usize| {
            pairs(d).iter().position(|pair| {
                std::ptr::eq(sequence.directions(i), &pair[0]) && std::ptr::eq(sequence.directions(d + i), &pair[1])
            })
        };
        let mut order = Vec::new();
        for i in 0..d {
            order.push(place(i).expect("a pair of the table"));
            assert_eq!(sequence.directions(2 * d + i), &directions(3 * d)[2 * d + i]);
        }
        order
    };
    let orders: Vec<Vec<usize>> = (0..4).flat_map(|seed| [order(seed, 0), order(seed, 1)]).collect();
    for (number, order) in orders.iter().enumerate() {
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..d));
        assert!(!orders[..number].contains(order));
    }
    assert_eq!(order(3, 1), orders[7]);
}

#[test]
fn scrambled_points_keep_the_nets() {
    let d = 5;
    let sequence = SobolSequence::pick_freeze(d, 2, 9, 1);
    for dimension in 0..2 * d {
        let mut column = vec![0.0; 1 << 10];
        sequence.fill(dimension, 3 << 10, &mut column);
        let mut cells: Vec<u32> = column.iter().map(|x| (x * 1024.0) as u32).collect();
        cells.sort_unstable();
        assert!(cells.into_iter().eq(0..1024));
    }
}

#[test]
fn points_are_frozen() {
    let sequence = SobolSequence::pick_freeze(3, 2, 1, 0);
    let digits = |dimension| {
        let mut column = vec![0.0; 2];
        sequence.fill(dimension, 4094, &mut column);
        column.into_iter().map(|x| (x * (1u64 << 32) as f64) as u32).collect::<Vec<u32>>()
    };
    assert_eq!([digits(0), digits(5)], FROZEN);
}

const FROZEN: [[u32; 2]; 2] = [[592_652_277, 3_838_107_622], [3_662_391_890, 63_764_893]];

#[test]
fn more_factors_than_tables_are_refused() {
    let settings = DesignSettings { sampler: Sampler::SobolPickFreeze, ..DesignSettings::default() };
    assert!(Design::new(settings.clone(), 64, Rows::default()).is_ok());
    let error = Design::new(settings, 65, Rows::default()).unwrap_err();
    assert_eq!(error, DesignError::NoSearchedNets { factors: 65 });
    assert!(error.to_string().contains("at most 64: use the sampler \"sobol\""));
}
