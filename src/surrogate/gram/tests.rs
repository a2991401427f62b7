use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

/// Returns pseudo-random numbers between -1/2 and 1/2.
fn columns(count: usize, rows: usize) -> Vec<Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    (0..count).map(|_| (0..rows).map(|_| random.random_range(-0.5..0.5)).collect()).collect()
}

fn gram(columns: &[Vec<f64>]) -> Square {
    let mut gram = Square::zeros(columns.len());
    gram.add_products(columns);
    gram
}

#[test]
fn products_are_those_of_every_pair() {
    for (count, rows) in [(1, 1), (2, 5), (5, 1030), (6, 513)] {
        let columns = columns(count, rows);
        let gram = gram(&columns);
        for i in 0..count {
            for j in 0..count {
                let exact = product(&columns[i], &columns[j]);
                assert!((gram.at(i, j) - exact).abs() < 1e-12 * rows as f64, "{count} {rows} {i} {j}");
            }
        }
    }
}

#[test]
fn the_path_finds_the_columns_that_make_the_outputs() {
    let columns = columns(12, 300);
    let y: Vec<f64> = (0..300).map(|r| 3.0 * columns[7][r] - 0.5 * columns[2][r] + 0.01 * columns[4][r]).collect();
    let gram = gram(&columns);
    let right: Vec<f64> = columns.iter().map(|column| product(column, &y)).collect();
    let path = Path::new(&gram, vec![right.clone()], 4);
    assert_eq!(path.chosen, [0, 7, 2, 4]);
    let coefficients = path.coefficients(0, 4);
    for (solution, exact) in coefficients.iter().zip([0.0, 3.0, -0.5, 0.01]) {
        assert!((solution - exact).abs() < 1e-12, "{coefficients:?}");
    }
    let errors = path.held_out(&gram, &[right], &[product(&y, &y)]).remove(0);
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]) && errors[3].abs() < 1e-10, "{errors:?}");
    // The error of three columns, term by term.
    let b = path.coefficients(0, 3);
    let left: f64 = (0..300)
        .map(|r| (y[r] - path.chosen.iter().zip(&b).map(|(&c, b)| b * columns[c][r]).sum::<f64>()).powi(2))
        .sum();
    assert!((errors[2] - left).abs() < 1e-10, "{} {left}", errors[2]);
}

#[test]
fn outputs_choose_together_and_keep_their_own_coefficients() {
    let columns = columns(12, 300);
    let gram = gram(&columns);
    let make = |of: &dyn Fn(usize) -> f64| (0..300).map(of).collect::<Vec<f64>>();
    let outputs = [make(&|r| 3.0 * columns[7][r]), make(&|r| 2.0 * columns[2][r] - columns[7][r])];
    let right: Vec<Vec<f64>> =
        outputs.iter().map(|y| columns.iter().map(|column| product(column, y)).collect()).collect();
    let path = Path::new(&gram, right.clone(), 3);
    assert_eq!(path.chosen, [0, 7, 2]);
    for (output, exact) in [[0.0, 3.0, 0.0], [0.0, -1.0, 2.0]].iter().enumerate() {
        let solution = path.coefficients(output, 3);
        assert!(solution.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-12), "{solution:?}");
    }
    let squares: Vec<f64> = outputs.iter().map(|y| product(y, y)).collect();
    let errors = path.held_out(&gram, &right, &squares);
    assert!(errors[0][1].abs() < 1e-10 && errors[1][1] > 1.0 && errors[1][2].abs() < 1e-10, "{errors:?}");
}

#[test]
fn a_column_twice_is_chosen_once() {
    let mut columns = columns(3, 50);
    columns.push(columns[1].clone());
    let y = columns[1].clone();
    let right: Vec<f64> = columns.iter().map(|column| product(column, &y)).collect();
    assert_eq!(Path::new(&gram(&columns), vec![right], 4).chosen, [0, 1]);
}

#[test]
fn least_squares_are_solved() {
    let columns = columns(5, 40);
    let exact = [1.0, -2.0, 0.0, 4.0, 0.5];
    let y: Vec<f64> = (0..40).map(|r| (0..5).map(|c| exact[c] * columns[c][r]).sum()).collect();
    let right: Vec<f64> = columns.iter().map(|column| product(column, &y)).collect();
    for (solution, exact) in solve(&lower_factor(&gram(&columns)), &right).iter().zip(exact) {
        assert!((solution - exact).abs() < 1e-9);
    }
}
