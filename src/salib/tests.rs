use proptest::prelude::*;

use super::*;

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
    for layout in SalibLayout::ALL {
        // 12 base points of 4 rows are 8 of 6 rows.
        let columns = points(2, 48 / layout.rows_per_point(2), layout);
        let fits = |layout| check_points(&columns, &members, layout);
        assert_eq!(recognise(48, 2, None, Some(&fits)), Ok(layout));
        assert_eq!(recognise(48, 2, None, None), Err(LayoutError::Ambiguous { rows: 48, d: 2 }));
        assert_eq!(recognise(48, 2, Some(layout), None), Ok(layout));
    }
    assert_eq!(recognise(18, 2, None, None), Ok(SalibLayout::SecondOrder));
    assert!(matches!(recognise(7, 2, None, None), Err(LayoutError::NoMultiple { .. })));
    assert_eq!(recognise(4, 2, None, None), Err(LayoutError::OnePoint { rows: 4 }));
}

#[test]
fn shuffled_rows_are_found() {
    let members = problem(3).members;
    let mut columns = points(3, 4, SalibLayout::SecondOrder);
    columns.iter_mut().for_each(|(_, column)| column.swap(9, 13));
    let error = check_points(&columns, &members, SalibLayout::SecondOrder).unwrap_err().to_string();
    assert!(error.starts_with("row 10 should be the row AB_1 of its base point (rows 9 to 16)"), "{error}");
}

/// y = x1 + 2 x2 x3: first and second order by the formulas as SALib writes them.
#[test]
fn estimates_are_those_of_the_formulas() {
    let (d, n) = (3, 64);
    let columns = points(d, n, SalibLayout::SecondOrder);
    let y: Vec<f64> =
        (0..columns[0].1.len()).map(|row| columns[0].1[row] + 2.0 * columns[1].1[row] * columns[2].1[row]).collect();
    let indices = salib_indices(&y, d, SalibLayout::SecondOrder, 0, 0).unwrap();
    let mean = y.iter().sum::<f64>() / y.len() as f64;
    let row = |k: usize| -> Vec<f64> { y.iter().skip(k).step_by(8).map(|y| y - mean).collect() };
    let both = [row(0), row(7)].concat();
    let middle = both.iter().sum::<f64>() / both.len() as f64;
    let variance = both.iter().map(|y| (y - middle).powi(2)).sum::<f64>() / both.len() as f64;
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>() / n as f64;
    let s1 = |j: usize| (dot(&row(7), &row(1 + j)) - dot(&row(7), &row(0))) / variance;
    let closed = (dot(&row(4 + 1), &row(1 + 2)) - dot(&row(0), &row(7))) / variance;
    // Sums of 64 numbers of size 1 in another order.
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
    (0..d).for_each(|j| close(indices.indices[j].first_order.estimate, s1(j)));
    assert_eq!(indices.pairs[2].pair, (1, 2));
    close(indices.pairs[2].second_order.estimate, closed - s1(1) - s1(2));
    assert_eq!(indices.indices[0].total.interval, None);
    assert!(salib_indices(&[1.0; 16], 3, SalibLayout::SecondOrder, 0, 0).is_err());
}

#[test]
fn a_problem_says_its_groups() {
    let parse = |text: &str| SalibProblem::parse(text).map_err(|error| error.to_string());
    assert_eq!(parse(r#"{"names": ["a", "b"], "groups": null}"#).unwrap().members.len(), 2);
    assert!(
        parse(r#"{"num_vars": 3, "names": ["a", "b"]}"#).unwrap_err().contains("`num_vars` is 3, but `names` has 2")
    );
    assert!(parse(r#"{"names": ["a", "a"]}"#).unwrap_err().contains("two inputs are called `a`"));
    assert!(parse("[]").unwrap_err().starts_with("not a problem of SALib"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn an_offset_and_a_scale_change_nothing(offset in -1e6f64..1e6, exponent in -200i32..200) {
        let columns = points(2, 32, SalibLayout::FirstOrder);
        let y: Vec<f64> = columns[0].1.iter().zip(&columns[1].1).map(|(a, b)| a + a * b).collect();
        let scale = 2f64.powi(exponent);
        let other: Vec<f64> = y.iter().map(|y| (y + offset) * scale).collect();
        let of = |y: &[f64]| salib_indices(y, 2, SalibLayout::FirstOrder, 20, 1).unwrap();
        // Rounding of y + offset: 1e6 eps.
        for (a, b) in of(&y).indices.iter().zip(&of(&other).indices) {
            prop_assert!((a.first_order.estimate - b.first_order.estimate).abs() < 1e-8);
            prop_assert!((a.total.estimate - b.total.estimate).abs() < 1e-8);
            prop_assert!((a.total.interval.unwrap().high - b.total.interval.unwrap().high).abs() < 1e-8);
        }
    }
}
