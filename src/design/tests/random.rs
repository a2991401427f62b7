use super::*;

#[test]
fn any_row_is_the_row_of_the_whole_stream() {
    let points = RandomPoints::new(3, 9, 2);
    let mut whole = vec![vec![0.0; 100]; 3];
    points.fill(0, &mut whole);
    for first in [0, 1, 37, 99] {
        let mut one = vec![vec![0.0; 1]; 3];
        points.fill(first, &mut one);
        for (column, expected) in one.iter().zip(&whole) {
            assert_eq!(column[0], expected[first as usize]);
        }
    }
}
