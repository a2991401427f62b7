use super::*;

fn value(row: usize, j: usize) -> f64 {
    ((((row * row * 7 + row * (11 + 2 * j) + j * j * 5) * 2_654_435_761) >> 13) % 3) as f64
}

/// Returns what [`check`] says of 100 rows of columns `a` to `d` of three values in pseudo-random order, and of
/// another one, `e`.
fn checked(e: impl Fn(usize, &[f64]) -> f64) -> Result<(), GivenError> {
    let rows: Vec<Vec<f64>> = (0..100).map(|row| (0..4).map(|j| value(row, j)).collect()).collect();
    let mut columns: Vec<Vec<f64>> = (0..4).map(|j| rows.iter().map(|row| row[j]).collect()).collect();
    columns.push(rows.iter().enumerate().map(|(k, row)| e(k, row)).collect());
    let orders: Vec<Order> = columns.iter().map(|column| Order::from_values(column)).collect();
    check(&["a", "b", "c", "d", "e"].into_iter().zip(&orders).collect::<Vec<_>>())
}

#[test]
fn a_function_of_two_columns_is_named_and_a_rare_value_is_none() {
    let alias = checked(|_, row| (row[0] + row[1]) % 3.0);
    assert!(matches!(alias, Err(GivenError::Alias { .. })), "{alias:?}");
    // One row in a hundred: its combination of the others may well be the only one.
    for rare in 0..100 {
        assert_eq!(checked(|k, _| f64::from(u8::from(k == rare))), Ok(()), "{rare}");
    }
}
