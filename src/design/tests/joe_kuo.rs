use super::*;

#[test]
fn the_whole_table_is_readable_and_every_matrix_is_upper_triangular() {
    let all = directions(MAX_DIMENSIONS);
    assert_eq!(all.len(), MAX_DIMENSIONS);
    for v in all {
        for (k, entry) in v.iter().enumerate() {
            // A one on the diagonal and zeros below it make each coordinate a (0, m, 1)-net.
            assert_eq!(entry.leading_zeros() as usize, BITS - 1 - k);
        }
    }
}

#[test]
fn agrees_with_the_table_of_sobol_burley() {
    for (dimension, v) in directions(256).iter().enumerate() {
        for (k, &entry) in v.iter().enumerate().take(16) {
            let reversed = sobol_burley::parts::sobol_rev((1u32 << k).reverse_bits(), dimension as u32);
            assert_eq!(entry, reversed, "dimension {dimension}, bit {k}");
        }
    }
}
