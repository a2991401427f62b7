use super::*;

#[test]
fn columns_come_back_cut_at_any_point() {
    let mut kept = PointOutputs::of_block(&[&[1.0, 2.0], &[10.0, 20.0]]);
    kept.append(PointOutputs::of_block(&[&[3.0, 4.0, 5.0], &[30.0, 40.0, 50.0]]));
    assert_eq!(kept.points(), 5);
    let column = |end, run: usize| kept.blocks(end).flat_map(|columns| columns[run].to_vec()).collect::<Vec<f64>>();
    assert_eq!(column(5, 0), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(column(3, 1), [10.0, 20.0, 30.0]);
    assert_eq!(column(2, 1), [10.0, 20.0]);
    assert_eq!(column(0, 1), [] as [f64; 0]);
    assert_eq!(column(u64::MAX, 1).len(), 5);
}
