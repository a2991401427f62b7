use super::*;

#[test]
fn values_that_are_not_finite_get_a_name_once() {
    let mut batch = Batch { columns: vec![Vec::new(); 2], ..Batch::default() };
    batch.reset(3);
    batch.column_mut(0).copy_from_slice(&[1.0, f64::INFINITY, 2.0]);
    batch.column_mut(1).copy_from_slice(&[1.0, 2.0, 3.0]);
    let reason = RowFailure::new("no motion");
    batch.fail(2, 1, reason.clone());
    batch.settle();
    assert_eq!(batch.failures(), [(0, 1, RowFailure::not_finite()), (1, 2, reason)]);
}
