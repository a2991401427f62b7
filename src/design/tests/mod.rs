use super::*;
use crate::design::Design;

fn design(sampler: Sampler) -> Design {
    let settings = DesignSettings { sampler, base_samples: 64, replicates: 4, seed: 3 };
    Design::new(settings, 3, Rows::plain(vec![vec![0], vec![1], vec![2], vec![0, 2]])).unwrap()
}

#[test]
fn swapped_rows_are_a_with_the_named_columns_of_b() {
    for sampler in Sampler::ALL {
        let design = design(sampler);
        let row = |k| {
            let mut u = [0.0; 3];
            design.point(5 * design.rows_per_point() + k, &mut u);
            u
        };
        let (a, b) = (row(0), row(1));
        assert!(a.iter().zip(b).all(|(a, b)| *a != b));
        assert_eq!(row(2), [b[0], a[1], a[2]]);
        assert_eq!(row(4), [a[0], a[1], b[2]]);
        assert_eq!(row(5), [b[0], a[1], b[2]]);
    }
}

/// The same points with rows BA of the same swaps.
fn with_ba(sampler: Sampler) -> Design {
    let plain = design(sampler);
    Design::new(plain.settings.clone(), 3, Rows { ba: true, second_order: true, ..plain.requested }).unwrap()
}

#[test]
fn rows_mix_a_and_b_and_every_run_is_where_it_is_said_to_be() {
    for sampler in Sampler::ALL {
        let design = with_ba(sampler);
        assert_eq!((design.columns(), design.paired()), (6, &[0, 1, 2][..]));
        // A, B, 4 AB; BA_3 is AB_1 and BA_1 is AB_3.
        assert_eq!(design.rows_per_point(), 2 + 4 + 2);
        let (replicate, point) = (2, 11);
        let first_row = (replicate * 16 + point) * design.rows_per_point();
        let row = |run: usize| {
            let mut u = [0.0; 3];
            design.point(first_row + run as u64, &mut u);
            u
        };
        let mut columns = vec![vec![0.0]; 6];
        design.replicate(replicate).fill(point, &mut columns);
        let [a, b] = [0, 3].map(|first| [columns[first][0], columns[first + 1][0], columns[first + 2][0]]);
        assert_eq!([row(0), row(1)], [a, b]);
        let with = |mut base: [f64; 3], swap: usize, from: [f64; 3]| {
            design.swaps()[swap].iter().for_each(|&column| base[column] = from[column]);
            base
        };
        for swap in 0..4 {
            assert_eq!(row(design.ab_runs()[swap]), with(a, swap, b));
            assert_eq!(row(design.ba_runs()[swap]), with(b, swap, a));
        }
        for (run, expected) in design.runs().iter().enumerate() {
            assert_eq!(design.locate(first_row + run as u64), (replicate, point, expected.kind));
        }
        assert!(design.runs().iter().any(|run| run.kind == RowKind::Ba(2)));
        let mut all: Vec<[f64; 3]> = (0..design.runs().len()).map(row).collect();
        all.sort_by(|x, y| x.partial_cmp(y).unwrap());
        all.dedup();
        assert_eq!(all.len() as u64, design.rows_per_point(), "no point is run twice");
    }
}

#[test]
fn second_order_indices_are_of_swaps_without_a_common_column() {
    let swaps = vec![vec![0, 1], vec![2], vec![], vec![0], vec![2], vec![1, 1]];
    let rows = Rows { swaps, ba: true, second_order: true, ..Rows::default() };
    let paired = |rows: &Rows| Design::new(DesignSettings::default(), 3, rows.clone()).map(|d| d.paired().to_vec());
    assert_eq!(paired(&rows), Ok(vec![0, 1]));
    assert_eq!(paired(&Rows { second_order: false, ..rows.clone() }), Ok(vec![]));
    let without = Rows { ba: false, ..rows };
    assert_eq!(paired(&without), Err(DesignError::SecondOrderWithoutBa));
    let all =
        |d: usize| Rows { swaps: (0..d).map(|j| vec![j]).collect(), ba: true, second_order: true, ..Rows::default() };
    assert!(Design::new(DesignSettings::default(), 256, all(256)).is_ok());
    let error = Design::new(DesignSettings::default(), 257, all(257)).unwrap_err();
    assert_eq!(error, DesignError::TooManyPairs { factors: 257 });
    assert!(error.to_string().contains("32896 pairs"));
}

#[test]
fn rows_are_counted_replicate_by_replicate() {
    let design = design(Sampler::Sobol);
    assert_eq!(design.rows(), 64 * 6);
    assert_eq!(design.locate(0), (0, 0, RowKind::A));
    assert_eq!(design.locate(6 * 16 + 1), (1, 0, RowKind::B));
    assert_eq!(design.locate(64 * 6 - 1), (3, 15, RowKind::Ab(3)));
}

#[test]
fn impossible_designs_are_refused_with_the_reason() {
    let settings = || DesignSettings { replicates: 16, ..DesignSettings::default() };
    let of = |settings, factors| Design::new(settings, factors, Rows::default()).unwrap_err();
    assert_eq!(of(settings(), 0), DesignError::NoFactors);
    assert_eq!(of(settings(), 3000), DesignError::TooManyFactors { factors: 3000 });
    assert_eq!(of(DesignSettings { replicates: 0, ..settings() }, 1), DesignError::NoReplicates);
    for base_samples in [0, 1, 31] {
        let error = of(DesignSettings { base_samples, ..settings() }, 1);
        assert_eq!(error, DesignError::TooFewSamples { base_samples, replicates: 16 });
    }
    let error = of(DesignSettings { replicates: 5000, base_samples: 1 << 20, ..settings() }, 1);
    assert_eq!(error, DesignError::TooManyReplicates { replicates: 5000 });
    // Dummies, since equal rows are run once.
    let rows = Rows::plain(vec![vec![]; 1 << 21]);
    let full =
        DesignSettings { base_samples: Design::MAX_POINTS * MAX_REPLICATES, replicates: MAX_REPLICATES, ..settings() };
    assert!(matches!(Design::new(full, 1, rows), Err(DesignError::TooManyRuns { .. })));
    let error = Design::new(settings(), 2, Rows::plain(vec![vec![2]])).unwrap_err();
    assert_eq!(error, DesignError::NoSuchColumn { column: 2, factors: 2 });
    let error = of(DesignSettings { base_samples: u64::MAX, replicates: 2, ..settings() }, 1);
    assert!(matches!(error, DesignError::TooManySamples { .. }));
}

#[test]
fn samples_are_rounded_up_to_whole_replicates() {
    let settings = DesignSettings { base_samples: 1000, replicates: 16, ..DesignSettings::default() };
    let design = Design::new(settings, 2, Rows::plain(vec![vec![0], vec![1]])).unwrap();
    assert_eq!(design.settings().base_samples, 1008);
    let plain = design.plain(100).unwrap();
    assert!(!design.balanced() && plain.balanced() && plain.rows() == 96);
}

#[test]
fn replicates_do_not_share_the_dependences_of_digits() {
    // The first digits of 16 columns are linear functions of the ten digits of a point's number: at least six sums of
    // columns are constant in every replicate. Without permutations they are the same ones in all four.
    let settings = DesignSettings { base_samples: 4096, ..DesignSettings::default() };
    let design = Design::new(settings, 8, Rows::plain(Vec::new())).unwrap();
    let digits = |replicate| -> Vec<u16> {
        let columns = design.first_points(replicate, 1024);
        let of_row = |row: usize| columns.iter().fold(0, |digits, column| 2 * digits + u16::from(column[row] < 0.5));
        (1..1024).map(|row| of_row(row) ^ of_row(0)).collect()
    };
    assert!((0..4).all(|replicate| rank(digits(replicate)) <= 10));
    assert_eq!(rank((0..4).flat_map(digits).collect()), 16);
}

/// The number of linearly independent ones among these bit vectors.
fn rank(mut vectors: Vec<u16>) -> usize {
    let mut rank = 0;
    for bit in 0..16 {
        let Some(place) = vectors.iter().position(|vector| vector >> bit & 1 == 1) else { continue };
        let pivot = vectors.swap_remove(place);
        vectors.iter_mut().filter(|vector| **vector >> bit & 1 == 1).for_each(|vector| *vector ^= pivot);
        rank += 1;
    }
    rank
}

#[test]
fn constants_have_neither_rows_nor_dimensions() {
    let swaps = |factors: [usize; 3]| [factors.map(|factor| vec![factor]).to_vec(), vec![vec![factors[0], factors[2]]]];
    for sampler in Sampler::ALL {
        let settings = DesignSettings { sampler, base_samples: 16, replicates: 2, seed: 3 };
        let rows = |swaps| Rows { ba: true, second_order: true, ..Rows::plain(swaps) };
        let fewer = Design::new(settings.clone(), 3, rows(swaps([0, 1, 2]).concat())).unwrap();
        let mut with_constants = swaps([0, 2, 4]).concat();
        with_constants.extend([vec![1], vec![1, 3], vec![0, 1]]);
        let all = Rows { constants: vec![1, 3], ..rows(with_constants) };
        let design = Design::new(settings, 5, all).unwrap();
        assert_eq!((design.rows(), design.columns()), (fewer.rows(), 10));
        // Swaps of constants are the rows A and B themselves.
        assert_eq!((&design.ab_runs()[4..], &design.ba_runs()[4..6]), (&[0, 0, design.ab_runs()[0]][..], &[1, 1][..]));
        for row in 0..design.rows() {
            let (mut u, mut expected) = ([0.0; 5], [0.0; 3]);
            design.point(row, &mut u);
            fewer.point(row, &mut expected);
            assert_eq!(u, [expected[0], 0.5, expected[1], 0.5, expected[2]]);
        }
        assert!(design.plain(16).unwrap().requested().constants == [1, 3]);
    }
}
