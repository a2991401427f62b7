use super::*;

#[test]
fn a_step_lies_between_the_rows_that_show_it() {
    // A step of 2 at .7 that acts in every fifth row, modelled at .72.
    let rows: Vec<Row> = (0..200)
        .map(|k| {
            let u = 0.6 + f64::from(k) * 1e-3;
            let step = if k % 5 == 0 { 2.0 } else { 0.0 };
            let left = if u > 0.7 && u < 0.72 { step } else { 0.0 };
            Row { u, left, step }
        })
        .collect();
    let (at, width) = place(&rows, 0.72, 1e-3);
    assert!((at - 0.7).abs() <= 2.5e-3 && (width - 5e-3).abs() < 1e-12, "{at} {width}");
    // A step that is at the right place already is known as well.
    let right: Vec<Row> = rows.iter().map(|row| Row { left: 0.0, ..*row }).collect();
    let (at, width) = place(&right, 0.701, 0.02);
    assert!((at - 0.7).abs() <= 5e-3 && (width - 5e-3).abs() < 1e-12, "{at} {width}");
    // Rows that all lie on one side do not say where it is.
    assert_eq!(place(&rows[..50], 0.72, 1e-3), (0.72, 1e-3));
}
