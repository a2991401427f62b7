use super::*;
use crate::Warning;
use crate::given::Column;

/// Points of SALib's layout for `d` inputs, from base points that are all different.
fn points(d: usize, n: usize, layout: SalibLayout) -> Vec<(String, Vec<f64>)> {
    let value = |point: usize, column: usize| ((point * 2 * d + column) as f64 * 0.618_033_988_749).fract();
    let mut columns = vec![Vec::new(); d];
    for point in 0..n {
        let mut row = |from: &dyn Fn(usize) -> usize| {
            for (j, column) in columns.iter_mut().enumerate() {
                column.push(value(point, j + d * from(j)));
            }
        };
        row(&|_| 0);
        (0..d).for_each(|k| row(&|j| usize::from(j == k)));
        if layout == SalibLayout::SecondOrder {
            (0..d).for_each(|k| row(&|j| usize::from(j != k)));
        }
        row(&|_| 1);
    }
    columns.into_iter().enumerate().map(|(j, column)| (format!("x{}", j + 1), column)).collect()
}

fn problem(d: usize) -> SalibProblem {
    SalibProblem::of_inputs((1..=d).map(|j| format!("x{j}")).collect()).unwrap()
}

#[test]
fn both_layouts_are_recognised_by_their_points() {
    let members = problem(2).members;
    let refused = |rows| SalibLayout::recognise(rows, &members, None, None).unwrap_err().to_string();
    for layout in SalibLayout::ALL {
        // 12 base points of 4 rows are 8 of 6 rows.
        let columns = points(2, 48 / layout.rows_per_point(2), layout);
        let inputs = Some(&columns[..]);
        assert_eq!(SalibLayout::recognise(48, &members, None, inputs), Ok(layout));
        assert_eq!(SalibLayout::recognise(48, &members, Some(layout), None), Ok(layout));
    }
    assert_eq!(SalibLayout::recognise(18, &members, None, None), Ok(SalibLayout::SecondOrder));
    insta::assert_snapshot!([48, 7, 4].map(refused).join("\n"));
}

#[test]
fn shuffled_rows_are_found() {
    let mut columns = points(3, 4, SalibLayout::SecondOrder);
    columns.iter_mut().for_each(|(_, column)| column.swap(9, 13));
    let error = SalibLayout::recognise(32, &problem(3).members, None, Some(&columns)).unwrap_err();
    assert!(error.to_string().starts_with("row 10 "), "{error}");
}

/// The analysis of outputs of `d` inputs in this layout, with intervals by the delta method.
fn analysis(y: &[f64], d: usize, layout: SalibLayout) -> crate::StudyResult {
    let outputs = [Column { name: "y".to_owned(), values: y.to_vec() }];
    let (study, store) = salib_study("s", &problem(d), &outputs, layout, (0, 0)).unwrap();
    study.runner().threads(1).store(&store).run().unwrap()
}

/// y = x1 + 2 x2 x3: first and second order by the formulas as SALib writes them.
#[test]
fn estimates_are_those_of_the_formulas() {
    let (d, n) = (3, 64);
    let columns = points(d, n, SalibLayout::SecondOrder);
    let y: Vec<f64> =
        (0..columns[0].1.len()).map(|row| columns[0].1[row] + 2.0 * columns[1].1[row] * columns[2].1[row]).collect();
    let analysis = analysis(&y, d, SalibLayout::SecondOrder);
    let output = &analysis.outputs[0];
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let row = |k: usize| -> Vec<f64> { y.iter().skip(k).step_by(8).map(|y| y - mean).collect() };
    let both = [row(0), row(7)].concat();
    let middle = both.iter().sum::<f64>() / both.len() as f64;
    let variance = both.iter().map(|y| (y - middle).powi(2)).sum::<f64>() / both.len() as f64;
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / n as f64;
    let s1 = |j: usize| (dot(&row(7), &row(1 + j)) - dot(&row(7), &row(0))) / variance;
    let st = |j: usize| row(0).iter().zip(row(1 + j)).map(|(a, ab)| (a - ab).powi(2)).sum::<f64>() / (2.0 * n as f64);
    // Sums of 64 numbers of size 1 in another order.
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
    for (j, index) in output.indices.iter().flatten().enumerate() {
        close(index.effect.first_order.estimate, s1(j));
        close(index.effect.total.estimate, st(j) / variance);
    }
    for (place, (j, k)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
        let closed = (dot(&row(4 + j), &row(1 + k)) - dot(&row(0), &row(7))) / variance;
        close(output.second_order.as_ref().unwrap()[place].index.estimate, closed - s1(j) - s1(k));
    }
}

#[test]
fn a_missing_output_leaves_its_base_point_out() {
    let columns = points(2, 64, SalibLayout::FirstOrder);
    let y: Vec<f64> = columns[0].1.iter().zip(&columns[1].1).map(|(a, b)| a + a * b).collect();
    let mut missing = y.clone();
    missing[4 * 10 + 3] = f64::NAN;
    let without: Vec<f64> = [&y[..40], &y[44..]].concat();
    let [found, expected] = [missing, without].map(|y| analysis(&y, 2, SalibLayout::FirstOrder));
    assert_eq!((found.outputs[0].runs_failed, found.outputs[0].base_points_used), (1, 63));
    assert!(!found.outputs[0].warnings.is_empty());
    let total = |analysis: &crate::StudyResult| analysis.outputs[0].indices.as_ref().unwrap()[1].effect.total.estimate;
    assert!((total(&found) - total(&expected)).abs() < 1e-13);
}

#[test]
fn rows_of_another_order_are_warned_of() {
    // As good as random: splitmix64.
    let noise = |row: u64| {
        let mut z = row.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ z >> 31) as f64 / 2f64.powi(64)
    };
    let y: Vec<f64> = (1..=512 * 5).map(noise).collect();
    let warnings = &analysis(&y, 3, SalibLayout::FirstOrder).outputs[0].warnings;
    assert!(warnings.contains(&Warning::Shuffled), "{warnings:?}");
    let columns = points(3, 256, SalibLayout::FirstOrder);
    let y: Vec<f64> = columns[0].1.iter().zip(&columns[1].1).map(|(a, b)| a + b).collect();
    let warnings = &analysis(&y, 3, SalibLayout::FirstOrder).outputs[0].warnings;
    assert!(!warnings.contains(&Warning::Shuffled), "{warnings:?}");
}

#[test]
fn codes_for_missing_values_are_found() {
    let columns = points(3, 128, SalibLayout::FirstOrder);
    let mut y: Vec<f64> = columns[0].1.iter().zip(&columns[1].1).map(|(a, b)| a + b).collect();
    y.iter_mut().step_by(49).for_each(|y| *y = -9999.0);
    let found = apportion_base::quantity::Unlikely::find(&y).unwrap();
    assert_eq!((found.value, found.count, found.first), (-9999.0, 14, 0));
    let warnings = &analysis(&y, 3, SalibLayout::FirstOrder).outputs[0].warnings;
    assert!(warnings.iter().any(|warning| matches!(warning, Warning::FewRows { .. })), "{warnings:?}");
}

#[test]
fn groups_of_a_problem_are_read() {
    let parse = |text: &str| SalibProblem::parse(text).map_err(|error| error.to_string());
    assert_eq!(parse(r#"{"names": ["a", "b"], "groups": null}"#).unwrap().members.len(), 2);
    let refused = [r#"{"num_vars": 3, "names": ["a", "b"]}"#, r#"{"names": ["a", "a"]}"#, "[]"];
    insta::assert_snapshot!(refused.map(|text| parse(text).unwrap_err()).join("\n"));
}
