//! Properties of the sequence: published points, nets, no correlation of dimensions.

mod convergence;

use super::*;
use crate::design::MAX_DIMENSIONS;

fn points(sequence: &SobolSequence, first: u64, n: usize) -> Vec<Vec<f64>> {
    let dimensions = sequence.directions.len();
    let mut columns = vec![vec![0.0; n]; dimensions];
    for (dimension, column) in columns.iter_mut().enumerate() {
        sequence.fill(dimension, first, column);
    }
    columns
}

#[test]
fn unscrambled_points_are_the_published_ones() {
    // The first points of the example of Joe and Kuo's program, which SciPy's unscrambled sequence repeats.
    let expected = [
        [0.0, 0.5, 0.75, 0.25, 0.375, 0.875, 0.625, 0.125, 0.1875, 0.6875],
        [0.0, 0.5, 0.25, 0.75, 0.375, 0.875, 0.125, 0.625, 0.3125, 0.8125],
        [0.0, 0.5, 0.25, 0.75, 0.625, 0.125, 0.875, 0.375, 0.9375, 0.4375],
    ];
    for (column, expected) in points(&SobolSequence::plain(3), 0, 10).iter().zip(expected) {
        for (x, e) in column.iter().zip(expected) {
            assert_eq!(*x, e + 0.5 * CELL);
        }
    }
}

#[test]
fn unscrambled_points_of_high_dimensions_are_those_of_scipy() {
    // scipy.stats.qmc.Sobol(1000, scramble=False, bits=32).random(2048), SciPy 1.17.
    let columns = points(&SobolSequence::plain(1000), 0, 2048);
    let frozen = [
        (5, 99, 0.375),
        (777, 1, 0.9365234375),
        (777, 99, 0.5107421875),
        (777, 999, 0.3837890625),
        (2047, 99, 0.86083984375),
        (2047, 998, 0.13330078125),
        (2047, 999, 0.44873046875),
    ];
    for (index, dimension, expected) in frozen {
        assert_eq!(columns[dimension][index], expected + 0.5 * CELL);
    }
}

#[test]
fn any_index_gives_the_point_of_the_running_sequence() {
    let sequence = SobolSequence::scrambled(5, 7, 3);
    let whole = points(&sequence, 0, 1000);
    for first in [0, 1, 2, 255, 256, 511, 998] {
        for (column, expected) in points(&sequence, first, 2).iter().zip(&whole) {
            assert_eq!(column[..], expected[first as usize..first as usize + 2]);
        }
    }
}

#[test]
fn no_repetition_past_two_to_the_sixteen() {
    // The reference library's own sampler drops the index's high bits; ours must not.
    let sequence = SobolSequence::scrambled(2, 1, 0);
    let mut seen: Vec<u64> = points(&sequence, (1 << 16) - 512, 1024)[1].iter().map(|x| x.to_bits()).collect();
    seen.extend(points(&sequence, (1 << 32) - 1024, 1024)[1].iter().map(|x| x.to_bits()));
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 2048);
}

#[test]
fn every_elementary_interval_of_a_scrambled_net_holds_one_point() {
    // Dimensions 1 and 2 of the sequence form a (0, m, 2)-net in base 2, scrambled or not.
    for m in 1..=10 {
        let n = 1usize << m;
        let columns = points(&SobolSequence::scrambled(2, 11, m), 5 * n as u64, n);
        for split in 0..=m {
            let (nx, ny) = (1usize << split, 1usize << (m - split));
            let mut counts = vec![0; n];
            for (x, y) in columns[0].iter().zip(&columns[1]) {
                counts[(x * nx as f64) as usize * ny + (y * ny as f64) as usize] += 1;
            }
            assert!(counts.iter().all(|&c| c == 1), "m = {m}, split = {split}");
        }
    }
}

#[test]
fn points_lie_strictly_inside_the_unit_interval() {
    for replicate in 0..64 {
        for column in points(&SobolSequence::scrambled(4, 0, replicate), 0, 4096) {
            assert!(column.iter().all(|&x| x > 0.0 && x < 1.0));
        }
    }
    assert_eq!((f64::from(u32::MAX) + 0.5) * CELL, 1.0 - CELL / 2.0);
}

#[test]
fn unscrambled_points_of_the_last_dimensions_are_those_of_scipy() {
    // scipy.stats.qmc.Sobol(4096, scramble=False, bits=32).random(2048), SciPy 1.17.
    let sequence = SobolSequence::plain(4096);
    let frozen = [
        (3, 1023, 0.25),
        (100, 1024, 0.0703125),
        (777, 2047, 0.2060546875),
        (1500, 2048, 0.09423828125),
        (2047, 3000, 0.30810546875),
        (1023, 4094, 0.0439453125),
        (2047, 4095, 0.82080078125),
        (5, 4095, 0.875),
    ];
    for (index, dimension, expected) in frozen {
        let mut point = [0.0];
        sequence.fill(dimension, index, &mut point);
        assert_eq!(point[0], expected + 0.5 * CELL);
    }
}

/// Quality parameter t of the (t, m, s)-net that some dimensions of the sequence form: the smallest t for which the
/// leading k_1, ..., k_s rows of the generator matrices are independent whenever k_1 + ... + k_s = m - t (Niederreiter
/// 1987).
fn net_parameter(dimensions: &[usize], m: usize) -> usize {
    let all = directions(MAX_DIMENSIONS);
    // Row k of a matrix as a mask of its first m columns.
    let row = |dimension: usize, k: usize| (0..m).fold(0u32, |mask, j| mask | (all[dimension][j] >> k & 1) << j);
    let independent = |depths: &[usize]| {
        let mut basis: Vec<u32> = Vec::new();
        depths.iter().zip(dimensions).flat_map(|(&depth, &d)| (0..depth).map(move |k| (d, k))).all(|(d, k)| {
            let rest = basis.iter().fold(row(d, k), |rest, b| rest.min(rest ^ b));
            basis.push(rest);
            rest != 0
        })
    };
    (0..=m).find(|t| splits(m - t, dimensions.len()).iter().all(|depths| independent(depths))).unwrap_or(m)
}

/// All ways to write `sum` as an ordered sum of `parts` numbers from 0.
fn splits(sum: usize, parts: usize) -> Vec<Vec<usize>> {
    if parts == 1 {
        return vec![vec![sum]];
    }
    let with =
        |first: usize| splits(sum - first, parts - 1).into_iter().map(move |rest| [&[first], &rest[..]].concat());
    (0..=sum).flat_map(with).collect()
}

/// Whether every elementary interval of volume 2^(t - m) holds 2^t of the 2^m points.
fn is_net(columns: &[Vec<f64>], m: usize, t: usize) -> bool {
    splits(m - t, columns.len()).into_iter().all(|depths| {
        let mut counts = vec![0; 1 << (m - t)];
        for i in 0..1 << m {
            let place = columns
                .iter()
                .zip(&depths)
                .fold(0, |place, (column, &depth)| (place << depth) + (column[i] * (1u64 << depth) as f64) as usize);
            counts[place] += 1;
        }
        counts.iter().all(|&count| count == 1 << t)
    })
}

#[test]
fn scrambled_pairs_and_triples_are_the_nets_their_matrices_promise() {
    // Neighbours, the same factor in A and B of a design of d = 3, 64, 1000 and 2048, and high dimensions among each other.
    let sets: [&[usize]; 16] = [
        &[0, 1],
        &[1, 2],
        &[0, 3],
        &[5, 8],
        &[0, 64],
        &[31, 95],
        &[254, 255],
        &[499, 1499],
        &[1022, 1023],
        &[2046, 4094],
        &[4094, 4095],
        &[0, 1, 2],
        &[0, 3, 6],
        &[7, 70, 700],
        &[1000, 2000, 3000],
        &[4093, 4094, 4095],
    ];
    for (number, set) in sets.into_iter().enumerate() {
        for m in 1..=10 {
            let t = net_parameter(set, m);
            // Sobol's conditions: the first dimensions by theory, 0 for the first two and 1 at most for the first three.
            assert!(number != 0 || t == 0, "{set:?}: t = {t}");
            assert!(number != 11 || t <= 1, "{set:?}: t = {t}");
            let sequence = SobolSequence::scrambled(MAX_DIMENSIONS, 23, number as u64);
            let (n, first) = (1usize << m, 3u64 << m);
            let columns: Vec<Vec<f64>> = set
                .iter()
                .map(|&dimension| {
                    let mut column = vec![0.0; n];
                    sequence.fill(dimension, first, &mut column);
                    column
                })
                .collect();
            assert!(is_net(&columns, m, t), "{set:?}, m = {m}, t = {t}");
        }
    }
}

#[test]
fn every_dimension_is_stratified_and_stays_inside() {
    let m = 8;
    let sequence = SobolSequence::scrambled(MAX_DIMENSIONS, 3, 1);
    let mut column = vec![0.0; 1 << m];
    for dimension in 0..MAX_DIMENSIONS {
        sequence.fill(dimension, 7 << m, &mut column);
        assert!(column.iter().all(|&x| x > 0.0 && x < 1.0));
        assert!(is_net(std::slice::from_ref(&column), m, 0), "dimension {dimension}");
    }
}

#[test]
fn ends_of_the_interval_are_never_reached() {
    // The digits 0 and 2^32 - 1 are the closest: half a cell from the end.
    for digits in [0u32, u32::MAX] {
        let x = (f64::from(digits) + 0.5) * CELL;
        assert!(x > 0.0 && x < 1.0 && x.max(1.0 - x) == 1.0 - CELL / 2.0);
    }
    // In an unscrambled sequence both occur: index 0, and the point whose digits are all 1.
    let plain = SobolSequence::plain(1);
    let ones = (0..BITS).fold(0u64, |index, bit| index | u64::from(bit % 2 == 1) << bit);
    let (mut first, mut last) = ([0.5], [0.5]);
    plain.fill(0, 0, &mut first);
    plain.fill(0, ones, &mut last);
    assert_eq!((first[0], last[0]), (CELL / 2.0, 1.0 - CELL / 2.0));
}

/// Correlation of two columns of values uniform on (0, 1), by their exact mean and variance.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    12.0 * a.iter().zip(b).map(|(a, b)| (a - 0.5) * (b - 0.5)).sum::<f64>() / a.len() as f64
}

fn column(sequence: &SobolSequence, dimension: usize, n: usize) -> Vec<f64> {
    let mut column = vec![0.0; n];
    sequence.fill(dimension, 0, &mut column);
    column
}

/// The strongest correlation left where the leading digits of two dimensions are independent as long as there are no more
/// than four of them together: 0.75 / 2^3, and some rounding of finer digits.
const WEAK: f64 = 0.1;

#[test]
fn low_dimensions_are_not_correlated() {
    // Every pair within A, within B and across, of designs of 30 and of 50 factors.
    for (m, dimensions) in [(10, 60), (12, 100)] {
        for replicate in 0..4 {
            let sequence = SobolSequence::scrambled(dimensions, 41, replicate);
            let n = 1usize << m;
            let columns: Vec<_> = (0..dimensions).map(|dimension| column(&sequence, dimension, n)).collect();
            let (mut squares, mut pairs) = (0.0, 0);
            for (i, a) in columns.iter().enumerate() {
                for (j, b) in columns.iter().enumerate().skip(i + 1) {
                    let r = correlation(a, b);
                    assert!(r.abs() < WEAK, "2^{m} points, dimensions {i} and {j}: {r}");
                    squares += r * r;
                    pairs += 1;
                }
            }
            // Together far closer to 0 than the squares 1/N of random points.
            assert!(squares / f64::from(pairs) < 0.25 / n as f64, "2^{m} points: {squares}");
        }
    }
}

#[test]
fn a_factor_is_not_correlated_with_itself_across_a_and_b() {
    for d in (1..=100).step_by(3) {
        let sequence = SobolSequence::scrambled(2 * d, 7, 1);
        for j in 0..d {
            let r = correlation(&column(&sequence, j, 1 << 12), &column(&sequence, d + j, 1 << 12));
            assert!(r.abs() < WEAK, "factor {j} of {d}: {r}");
        }
    }
}

#[test]
fn dimensions_that_share_digits_are_correlated_until_their_next_column() {
    // The first digit of a dimension's first 2^m points is one of 2^(m-1) functions of the index, so that among more
    // dimensions two must share it, for any direction numbers; likewise for the second digit of one and the first of
    // another, which dimensions 7 and 3808 share up to 2^12 points: t is m - 2 there. Their next columns differ.
    assert_eq!([8, 10, 12, 14, 16].map(|m| net_parameter(&[6, 3807], m)), [6, 8, 10, 4, 3]);
    let sequence = |replicate| SobolSequence::scrambled(3808, 41, replicate);
    let at = |replicate, m: u32| {
        let sequence = sequence(replicate);
        correlation(&column(&sequence, 6, 1 << m), &column(&sequence, 3807, 1 << m))
    };
    // The scramble flips the second digit in both halves alike, or in one alone: 0.375, -0.375 or 0, of mean 0.
    let found: Vec<f64> = (0..64).map(|replicate| at(replicate, 12)).collect();
    assert!(found.iter().all(|r| r.abs() < 0.02 || (r.abs() - 0.375).abs() < 0.02), "{found:?}");
    assert!(found.iter().any(|r| *r > 0.3) && found.iter().any(|r| *r < -0.3));
    // 64 values of standard deviation 0.27: four standard errors.
    assert!(found.iter().sum::<f64>().abs() < 8.5);
    assert!((0..8).all(|replicate| at(replicate, 16).abs() < 0.02));
}
