use super::*;

#[test]
fn each_cell_holds_one_point_for_any_n() {
    for n in [1, 2, 3, 7, 16, 1000, 1025] {
        let mut columns = vec![vec![0.0; n]; 3];
        let points = LatinHypercube::new(3, n as u64, 4, 1);
        points.fill(0, &mut columns);
        for column in &columns {
            let mut cells: Vec<usize> = column.iter().map(|u| (u * n as f64) as usize).collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..n).collect::<Vec<_>>());
        }
    }
}

#[test]
fn blocks_are_parts_of_the_whole() {
    let points = LatinHypercube::new(2, 500, 4, 1);
    let (mut whole, mut part) = (vec![vec![0.0; 500]; 2], vec![vec![0.0; 50]; 2]);
    points.fill(0, &mut whole);
    points.fill(123, &mut part);
    assert_eq!(part[1][..], whole[1][123..173]);
}

#[test]
fn dimensions_are_uncorrelated() {
    // The standard error of a correlation of n pairs is n^-1/2; none of 45 exceeds five of them by chance.
    let n = 4096;
    let mut columns = vec![vec![0.0; n]; 10];
    LatinHypercube::new(10, n as u64, 0, 0).fill(0, &mut columns);
    for i in 0..10 {
        for j in 0..i {
            let covariance: f64 =
                columns[i].iter().zip(&columns[j]).map(|(x, y)| (x - 0.5) * (y - 0.5)).sum::<f64>() / n as f64;
            assert!((covariance * 12.0).abs() < 5.0 / (n as f64).sqrt());
        }
    }
}

#[test]
fn the_last_place_of_the_largest_hypercube_stays_below_one() {
    let (n, last) = (1u64 << 32, 1.0 - f64::EPSILON / 2.0);
    assert_eq!((n - 1) as f64 + last, n as f64, "the case is the one that rounds up");
    assert!(place(n - 1, last, n) < 1.0);
    assert!(place(0, f64::MIN_POSITIVE, n) > 0.0);
}
