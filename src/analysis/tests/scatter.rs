use super::*;
use crate::design::{DesignSettings, Rows};

#[test]
fn the_rows_are_those_of_the_design() {
    let settings = DesignSettings { base_samples: 64, replicates: 2, ..DesignSettings::default() };
    let design = Design::new(settings, 3, Rows::plain(vec![vec![0], vec![1], vec![2]])).unwrap();
    let rows = rows_of_scatter(&design);
    let mut u = vec![0.0; 3];
    for factor in 0..3 {
        let coordinates: Vec<f64> = rows.coordinates(factor).collect();
        assert_eq!(coordinates.len(), 2 * 64);
        for (number, coordinate) in coordinates.iter().enumerate() {
            design.point(number as u64 / 2 * design.rows_per_point() + number as u64 % 2, &mut u);
            assert_eq!(*coordinate, u[factor]);
        }
    }
}
