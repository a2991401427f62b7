//! Indices from given data: exact indices, coverage of intervals, and every table that must be refused.

use apportion::design::Sampler;
use apportion::given::{Column, GivenError, GivenIndices, InputIndices, NoVariance, PointSet, analyse};
use apportion::model::{KnownAnswer, KnownFunction};
use proptest::prelude::*;

use crate::engine::points::*;

fn named(columns: Columns) -> Vec<Column> {
    columns.into_iter().enumerate().map(|(j, values)| Column { name: format!("x{}", j + 1), values }).collect()
}

fn known(name: &str) -> KnownFunction {
    KnownAnswer::from_name(name).unwrap().default_function()
}

fn first_order(name: &str) -> Vec<f64> {
    known(name).exact().indices.unwrap().first_order
}

/// The values of a known function at points of the unit cube.
fn evaluated(name: &str, columns: &Columns) -> Column {
    let function = known(name);
    let inputs = function.inputs();
    let at = |row: usize| {
        let x: Vec<f64> = inputs.iter().zip(columns).map(|(i, column)| i.distribution.quantile(column[row])).collect();
        function.value(&x)
    };
    Column { name: "y".to_owned(), values: (0..columns[0].len()).map(at).collect() }
}

fn analysed(columns: Columns, y: Column) -> Result<GivenIndices, GivenError> {
    analyse(&named(columns), &[y], 0)
}

fn points_of(columns: Columns) -> Result<PointSet, GivenError> {
    let y = Column { name: "y".to_owned(), values: columns[0].iter().map(|x| x * x).collect() };
    analysed(columns, y).map(|result| result.points)
}

fn indices(result: &GivenIndices) -> &[InputIndices] {
    result.outputs[0].indices.as_deref().unwrap()
}

/// How often the 95 % intervals of both methods hold, over `seeds` tables of `rows` rows and all inputs; the root mean
/// square errors.
fn coverage(function: &str, rows: usize, seeds: u64) -> ([f64; 2], [f64; 2]) {
    let exact = first_order(function);
    let (mut held, mut squares) = ([0.0; 2], [0.0; 2]);
    for seed in 0..seeds {
        let columns = random(exact.len(), rows, seed);
        let y = evaluated(function, &columns);
        let result = analysed(columns, y).unwrap();
        for (index, exact) in indices(&result).iter().zip(&exact) {
            let estimates = [index.rank.unwrap(), index.binned.estimate];
            for (k, estimate) in estimates.into_iter().enumerate() {
                let interval = estimate.interval.unwrap();
                held[k] += f64::from(interval.low <= *exact && *exact <= interval.high);
                squares[k] += (estimate.estimate - exact).powi(2);
            }
        }
    }
    let count = seeds as f64 * exact.len() as f64;
    (held.map(|h| h / count), squares.map(|s| (s / count).sqrt()))
}

#[test]
fn intervals_hold_as_often_as_they_say() {
    for (function, seeds) in [("ishigami", 200), ("sobol-g", 80)] {
        for rows in [200, 1000] {
            let (held, errors) = coverage(function, rows, seeds);
            // 600 or so cases: a standard deviation of 0.009 about 0.95; the intervals of inert inputs by bins are wide.
            assert!((0.92..=0.98).contains(&held[0]), "{function:?} {rows}: rank {held:?}");
            assert!((0.92..=1.0).contains(&held[1]), "{function:?} {rows}: binned {held:?}");
            // No better than chance allows, N^(-1/2), and no worse than twice that.
            assert!(errors.iter().all(|e| e * (rows as f64).sqrt() < 2.0), "{function:?} {rows}: {errors:?}");
        }
    }
}

#[test]
fn both_methods_converge_to_the_exact_indices() {
    for function in ["ishigami", "sobol-g"] {
        let exact = first_order(function);
        for sample in [random, latin] {
            let columns = sample(exact.len(), 100_000, 1);
            let y = evaluated(function, &columns);
            let result = analysed(columns, y).unwrap();
            assert_eq!(result.points, PointSet::Independent);
            for (index, exact) in indices(&result).iter().zip(&exact) {
                // Standard errors are below 0.0045 by ranks (0.96/sqrt N times the effect of the fourth moment) and 0.003
                // by bins; four of them.
                assert!((index.rank.unwrap().estimate - exact).abs() < 0.018, "{index:?}, exactly {exact}");
                assert!((index.binned.estimate.estimate - exact).abs() < 0.012, "{index:?}, exactly {exact}");
                assert!(!index.disagree());
            }
        }
    }
}

#[test]
fn one_input_that_decides_everything_has_index_one() {
    for rows in [30, 300, 3000] {
        let columns = random(1, rows, 3);
        let y = Column { name: "y".to_owned(), values: columns[0].iter().map(|x| x.exp()).collect() };
        let result = analysed(columns, y).unwrap();
        let rank = indices(&result)[0].rank.unwrap();
        let interval = rank.interval.unwrap();
        // The pair of the last and the first rank costs (e - 1)^2/2 of the variance 0.242, over N: 6.1/N, and the bound
        // includes it; the rest is the change within a step.
        assert!((rank.estimate - 1.0).abs() < 8.0 / rows as f64);
        assert!(
            interval.high > 1.0 - 20.0 / (rows as f64).powi(2) && interval.high < 1.0 + 3.0 / rows as f64,
            "{rank:?}"
        );
    }
}

#[test]
fn discrete_inputs_are_inputs() {
    // y = 2 a + b + 10 with a and b fair coins: S = 0.8 and 0.2, exactly, with the sums of squares of the table.
    let coins: Columns =
        random(2, 4000, 9).iter().map(|c| c.iter().map(|u| f64::from(u8::from(*u < 0.5))).collect()).collect();
    let y =
        Column { name: "y".to_owned(), values: (0..4000).map(|k| 2.0 * coins[0][k] + coins[1][k] + 10.0).collect() };
    let result = analysed(coins, y).unwrap();
    for (index, exact) in indices(&result).iter().zip([0.8, 0.2]) {
        // The standard error of both is 0.009 for S = 0.8 (0.4 x 0.4 ... of the coins' frequencies); four of them.
        assert!((index.rank.unwrap().estimate - exact).abs() < 0.036, "{index:?}");
        assert!((index.binned.estimate.estimate - exact).abs() < 0.036, "{index:?}");
        assert_eq!(index.binned.bins, 2);
    }
}

/// In 30 dimensions some pairs of so few Sobol' points are poor: an idle input then has part of the index of another.
#[test]
fn points_in_too_many_dimensions_are_refused_where_idle_inputs_seem_to_act() {
    let mut refused = 0;
    for seed in 0..10 {
        let x = sobol(30, 512, seed);
        let values = x[28].iter().zip(&x[29]).map(|(a, b)| if *b > 0.5 { (a - 0.5).signum() } else { 0.0 });
        let y = Column { name: "y".to_owned(), values: values.collect() };
        match analysed(x, y) {
            Err(GivenError::UnevenPoints { rows: 512, .. }) => refused += 1,
            Err(error) => panic!("seed {seed}: {error}"),
            Ok(result) => {
                let idle = &result.outputs[0].indices.as_ref().unwrap()[..28];
                assert!(idle.iter().all(|index| index.leading().estimate < 0.3), "seed {seed}: {idle:?}");
            }
        }
    }
    assert!(refused > 0);
}

#[test]
fn quasi_random_points_are_found_and_have_no_ranks() {
    let kinds: [(&str, Sample); 5] = [
        ("sobol", sobol),
        ("sobol plain", sobol_plain),
        ("halton", halton),
        ("kronecker", kronecker),
        ("lattice", lattice),
    ];
    for (name, kind) in kinds {
        for d in [2, 3, 8] {
            for n in [256, 1000, 1024, 4096] {
                for seed in 0..5 {
                    let points = points_of(kind(d, n, seed));
                    let is_found = matches!(points, Ok(PointSet::TooEven(_)) | Err(GivenError::UnevenPoints { .. }));
                    assert!(is_found, "{name}, {d} inputs, {n} rows, seed {seed}: {points:?}");
                }
            }
        }
    }
    // Rows in another order, columns on other scales.
    for seed in 0..5 {
        let mut columns = shuffled(sobol(3, 512, seed), seed);
        columns[1].iter_mut().for_each(|x| *x = -x.ln());
        assert!(matches!(points_of(columns), Ok(PointSet::TooEven(_))));
    }
    let columns = sobol(3, 1024, 0);
    let y = evaluated("ishigami", &columns);
    let result = analysed(columns, y).unwrap();
    for (index, exact) in indices(&result).iter().zip(first_order("ishigami")) {
        assert_eq!(index.rank, None);
        let binned = index.binned.estimate;
        // Means over bins of a net are exact to a few permille; 32 bins lose 1.3 % of sin^2 over two periods.
        assert!((binned.estimate - exact).abs() < 0.012, "{index:?}, exactly {exact}");
        assert_eq!(binned.interval, None);
    }
}

#[test]
fn independent_rows_are_not_refused() {
    let round = |columns: Columns, levels: f64| -> Columns {
        columns.into_iter().map(|c| c.into_iter().map(|u| (u * levels).floor()).collect()).collect()
    };
    for (d, n) in [(1, 30), (2, 30), (2, 64), (3, 100), (5, 257), (8, 64), (3, 1024)] {
        for seed in 0..150 {
            for columns in [
                random(d, n, seed),
                latin(d, n, seed),
                round(random(d, n, seed), 20.0),
                round(random(d, n, seed), 100.0),
                round(random(d, n, seed), n as f64),
            ] {
                assert_eq!(points_of(columns), Ok(PointSet::Independent), "{d} inputs, {n} rows, seed {seed}");
            }
        }
    }
    // Dependent draws of few values, and draws that are often 0 together.
    for seed in 0..20 {
        let columns = random(7, 1000, seed);
        let mixed = |j: usize| columns[j].iter().zip(&columns[6]).map(|(u, z)| (2.0 * (u + 0.7 * z)).floor()).collect();
        assert_eq!(points_of((0..6).map(mixed).collect()), Ok(PointSet::Independent), "{seed}");
        let often = |j: usize| {
            let all = columns[j].iter().zip(&columns[6]).zip(&columns[(j + 1) % 5]);
            all.map(|((u, z), v)| if *z < 0.2 || *v < 0.5 { 0.0 } else { *u }).collect()
        };
        assert_eq!(points_of((0..5).map(often).collect()), Ok(PointSet::Independent), "{seed}");
    }
    // Sorted rows, and a coarse table of coins, are still independent draws.
    let mut sorted = random(2, 300, 5);
    sorted[0].sort_by(f64::total_cmp);
    assert_eq!(points_of(sorted), Ok(PointSet::Independent));
    assert_eq!(points_of(round(random(3, 500, 5), 2.0)), Ok(PointSet::Independent));
}

#[test]
fn rows_of_designs_are_refused_by_name() {
    for d in [2, 3, 8, 20] {
        for base in [16, 64, 256] {
            for sampler in Sampler::ALL {
                let columns = saltelli(d, base, sampler, 4);
                assert_eq!(points_of(columns.clone()), Err(GivenError::PickFreeze), "{d} inputs, {base}, {sampler:?}");
                assert_eq!(points_of(shuffled(columns, 1)), Err(GivenError::PickFreeze), "{d} inputs, {base}");
            }
        }
    }
    for (d, levels) in [(2, 10), (3, 4), (5, 2)] {
        assert_eq!(points_of(grid(d, levels)), Ok(PointSet::Grid), "{d} inputs, {levels} levels");
    }
    for (d, count) in [(4, 10), (10, 20)] {
        let result = points_of(trajectories(d, count, 4, 2));
        assert!(matches!(result, Err(GivenError::OneAtATime { .. })), "{d} inputs: {result:?}");
    }
    let repeated: Columns = random(3, 50, 1).into_iter().map(|c| [c.clone(), c].concat()).collect();
    assert_eq!(points_of(repeated), Err(GivenError::RepeatedRows { repeated: 50, rows: 100 }));
}

/// Each input in turn over `count` random values, the others at 1/2; the last one of three values.
fn sweeps(d: usize, count: usize, seed: u64) -> Columns {
    let draws = &random(d, count, seed);
    let row = |j: usize, k: usize, i: usize| if i == j { draws[j][k] } else { 0.5 };
    let mut columns: Columns =
        (0..d).map(|i| (0..d).flat_map(|j| (0..count).map(move |k| row(j, k, i))).collect()).collect();
    columns[d - 1].iter_mut().for_each(|u| *u = (2.0 * *u).round());
    columns
}

/// Every combination of -1 and 1 of all inputs but the last, which is the product of the first `factors`.
fn fraction(d: usize, factors: usize) -> Columns {
    let mut columns: Columns =
        grid(d - 1, 2).into_iter().map(|c| c.into_iter().map(|u| 2.0 * u - 1.0).collect()).collect();
    let product = |row: usize| columns[..factors].iter().map(|column| column[row]).product();
    columns.push((0..1 << (d - 1)).map(product).collect());
    columns
}

/// Normal numbers of which each is `phi` times the one before, plus noise.
fn in_time(d: usize, n: usize, phi: f64, seed: u64) -> Columns {
    let noise = |uniform: &f64| (uniform - 0.5) * (12.0 * (1.0 - phi * phi)).sqrt();
    let mut columns = random(d, n, seed);
    for column in &mut columns {
        let mut x = 0.0;
        for u in column {
            x = phi * x + noise(u);
            *u = x;
        }
    }
    columns
}

#[test]
fn rows_around_a_base_point_are_refused_in_any_order() {
    let one_at_a_time = |columns: Columns| matches!(points_of(columns), Err(GivenError::OneAtATime { .. }));
    for seed in 0..20 {
        for (d, count) in [(4, 40), (6, 50), (12, 10)] {
            assert!(one_at_a_time(sweeps(d, count, seed)), "{d} inputs");
            assert!(one_at_a_time(shuffled(sweeps(d, count, seed), seed)), "{d} inputs");
        }
        // Sweeps among random rows, and trajectories of which one input has two values.
        let mixed = sweeps(8, 60, seed).into_iter().zip(random(8, 320, seed + 100)).map(|(a, b)| [a, b].concat());
        assert!(one_at_a_time(shuffled(mixed.collect(), seed)));
        let mut morris = trajectories(10, 20, 4, seed);
        morris[9].iter_mut().for_each(|level| *level = f64::from(u8::from(*level > 1.0)));
        assert!(one_at_a_time(morris.clone()) && one_at_a_time(shuffled(morris, seed)));
    }
}

#[test]
fn inputs_that_are_products_of_others_are_named() {
    for (d, factors) in [(6, 3), (7, 2), (7, 4)] {
        let columns = shuffled(fraction(d, factors), 1);
        let Err(GivenError::Alias { others, .. }) = points_of(columns.clone()) else { panic!("{d} inputs") };
        assert_eq!(others.matches('`').count(), 2 * factors, "{others}");
        assert!(points_of(columns[..d - 1].to_vec()).is_ok());
    }
}

#[test]
fn rows_that_follow_each_other_have_no_intervals() {
    for (phi, seeds) in [(0.9, 0..20), (0.98, 20..40)] {
        for seed in seeds {
            let columns = in_time(4, 1000, phi, seed);
            let y = (0..1000).map(|k| columns[0][k] + 0.5 * columns[1][k] + columns[3][k]).collect();
            let result = analysed(columns[..3].to_vec(), Column { name: "y".to_owned(), values: y }).unwrap();
            let rows = result.effective_rows.unwrap();
            assert!(rows < 3000.0 * (1.0 - phi), "{rows}");
            assert_eq!(result.points, PointSet::Independent);
            assert!(indices(&result).iter().all(|index| index.leading().interval.is_none()));
        }
    }
}

#[test]
fn a_design_that_lost_rows_is_still_known() {
    let without = |columns: Columns, lost: fn(usize) -> bool| -> Columns {
        let kept =
            |column: Vec<f64>| column.into_iter().enumerate().filter(|(k, _)| !lost(*k)).map(|(_, u)| u).collect();
        columns.into_iter().map(kept).collect()
    };
    for d in [3, 4, 8] {
        let columns = saltelli(d, 64, Sampler::Sobol, 4);
        for lost in [(|k| k % 7 == 3) as fn(usize) -> bool, |k| [7, 8, 190].contains(&k)] {
            let result = points_of(shuffled(without(columns.clone(), lost), 2));
            assert_eq!(result, Err(GivenError::PickFreeze), "{d} inputs");
        }
        let twice: Columns = columns.iter().map(|column| [column.as_slice(), &column[..100]].concat()).collect();
        assert!(matches!(points_of(twice), Err(GivenError::RepeatedRows { repeated: 100, .. })), "{d} inputs");
    }
}

#[test]
fn dependence_between_inputs_is_seen() {
    let mut columns = random(3, 500, 1);
    let independent = analysed(columns.clone(), evaluated("ishigami", &columns)).unwrap();
    let dependence = independent.dependence.unwrap();
    assert!(!dependence.correlated() && dependence.uneven.is_none(), "{dependence:?}");

    columns[2] = columns[0].iter().zip(&columns[2]).map(|(a, b)| b - 0.5 * a).collect();
    let y = evaluated("ishigami", &columns);
    let dependence = analysed(columns.clone(), y.clone()).unwrap().dependence.unwrap();
    assert!(dependence.correlated());
    assert_eq!(dependence.strongest.inputs, ("x1".to_owned(), "x3".to_owned()));
    assert!((-0.6..-0.3).contains(&dependence.strongest.spearman), "{dependence:?}");

    // A parabola has no rank correlation.
    columns[2] = columns[0].iter().map(|a| (a - 0.5).powi(2)).collect();
    let dependence = analysed(columns, y).unwrap().dependence.unwrap();
    assert!(dependence.correlated() || dependence.uneven == Some(("x1".to_owned(), "x3".to_owned())), "{dependence:?}");
}

#[test]
fn degenerate_tables_have_a_name() {
    let y = |n: usize| Column { name: "y".to_owned(), values: (0..n).map(|k| (k as f64).sin()).collect() };
    assert_eq!(analysed(random(2, 29, 1), y(29)), Err(GivenError::TooFewRows { rows: 29 }));
    assert_eq!(analyse(&[], &[y(40)], 0), Err(GivenError::Nothing { inputs: 0, outputs: 1 }));
    assert!(matches!(analysed(random(2, 40, 1), y(41)), Err(GivenError::Length { found: 41, .. })));
    let mut columns = random(2, 40, 1);
    columns[1][7] = f64::NAN;
    let error = analysed(columns, y(40)).unwrap_err();
    assert_eq!(error, GivenError::NotFinite { name: "x2".to_owned(), row: 8 });

    let constant = Column { name: "y".to_owned(), values: vec![0.1; 40] };
    let result = analysed(random(2, 40, 1), constant).unwrap();
    assert_eq!(result.outputs[0].indices, Err(NoVariance::Constant));

    let mut columns = random(2, 40, 1);
    columns[1] = vec![5.0; 40];
    let result = analysed(columns, y(40)).unwrap();
    assert_eq!(result.dependence, None);
    assert!(indices(&result)[1].constant);
    assert_eq!(indices(&result)[1].rank.unwrap().estimate, 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_finite_table_has_an_answer_or_a_refusal(
        rows in prop::collection::vec((prop::num::f64::NORMAL, 0..4i32, prop::num::f64::ANY), 30..70),
    ) {
        let a = rows.iter().map(|r| r.0).collect();
        let b = rows.iter().map(|r| f64::from(r.1)).collect();
        let values = rows.iter().map(|r| if r.2.is_finite() { r.2 } else { 0.0 }).collect();
        let y = Column { name: "y".to_owned(), values };
        if let Ok(result) = analysed(vec![a, b], y) {
            for index in result.outputs[0].indices.iter().flatten() {
                let rank = index.rank.map_or(0.0, |r| r.estimate);
                prop_assert!(rank.is_finite() && rank <= 1.0 + 1e-12, "{index:?}");
                if let Some(interval) = index.rank.and_then(|r| r.interval) {
                    prop_assert!(interval.low.is_finite() && interval.low <= interval.high);
                }
                prop_assert!(index.binned.estimate.estimate.is_finite(), "{index:?}");
            }
        }
    }
}
