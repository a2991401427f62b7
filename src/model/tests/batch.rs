use super::*;

#[test]
fn values_that_are_not_finite_get_a_name_once() {
    let mut batch = Batch { outputs: 2, ..Batch::default() };
    batch.reset(3);
    batch.column_mut(0).copy_from_slice(&[1.0, f64::INFINITY, 2.0]);
    batch.column_mut(1).copy_from_slice(&[1.0, 2.0, 3.0]);
    let reason = RowFailure::new("no motion");
    batch.fail(2, 1, reason.clone());
    batch.settle();
    assert_eq!(batch.failures(), [(0, 1, RowFailure::not_finite()), (1, 2, reason)]);
}

#[test]
fn rows_come_out_as_they_were_set() {
    let (outputs, stride) = (19, 21);
    let table: Vec<f64> = (0..3 * stride).map(|place| place as f64).collect();
    let mut batch = Batch { outputs, ..Batch::default() };
    batch.reset(5);
    batch.set_rows(1, &table[..2 * stride + outputs], stride);
    for output in 0..outputs {
        let column: Vec<f64> = (0..3).map(|row| table[row * stride + output]).collect();
        assert_eq!(batch.column(output)[1..4], column);
        assert!(batch.column(output)[0].is_nan() && batch.column(output)[4].is_nan());
    }
    let mut written = vec![-1.0; 5 * stride];
    batch.write_rows(&mut written, stride);
    assert_eq!(written[stride..stride + outputs], table[..outputs]);
    assert_eq!(written[outputs..stride], [-1.0, -1.0]);
}
