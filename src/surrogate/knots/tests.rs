use super::*;
use apportion_base::sum::product;

fn knot(u: f64, is_step: bool) -> Knot {
    Knot { u, width: 0.01, is_step }
}

#[test]
fn functions_are_orthonormal_and_hold_steps_and_hinges() {
    let knotted = Knotted::new(&Family::Legendre, &[knot(0.3, true), knot(0.8, false)], 10);
    assert_eq!(knotted.degree(), 10);
    let n = 20_000;
    let u: Vec<f64> = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).collect();
    let columns = knotted.columns(polynomials(&Family::Legendre, &u, 10), 10);
    let mean = |a: &[f64], b: &[f64]| product(a, b) / f64::from(n);
    for (j, a) in columns.iter().enumerate() {
        assert!(a.iter().sum::<f64>().abs() / f64::from(n) < 1e-3, "{j}");
        for (k, b) in columns.iter().enumerate() {
            assert!((mean(a, b) - f64::from(u8::from(j == k))).abs() < 1e-3, "{j} {k}");
        }
    }
    // A step of variance .21 has all of it in the functions, and a hinge of slope 1 too: .2^3/3 - (.2^2/2)^2.
    let step: Vec<f64> = u.iter().map(|u| f64::from(u8::from(*u > 0.3))).collect();
    let hinge: Vec<f64> = u.iter().map(|u| (u - 0.8).max(0.0)).collect();
    for (of, variance) in [(step, 0.21), (hinge, 0.008 / 3.0 - 0.0004)] {
        let explained: f64 = columns.iter().map(|column| mean(column, &of).powi(2)).sum();
        assert!((explained / variance - 1.0).abs() < 2e-3, "{explained} {variance}");
    }
}

#[test]
fn only_rows_in_which_a_step_acts_place_it() {
    // A step of height 2 at .7013 in every tenth row, of height .01 with residuals of .003 in the others.
    let rows = (0..60).map(|k| {
        let (u, step) = (0.6905 + 0.0004 * f64::from(k), if k % 10 == 0 { 4.0 } else { 1e-4 });
        Shown { u, more: if u < 0.7013 { -step } else { step }, step, noise: 1e-5 * step }
    });
    let rows: Vec<Shown> = rows.collect();
    let placed = placed_step(knot(0.7, true), &rows);
    // The neighbours that show it are .6985 and .7025.
    assert!((placed.u - 0.7005).abs() < 1e-9 && (placed.width - 0.004).abs() < 1e-9, "{placed:?}");
    // Where none shows it, it may lie anywhere within reach.
    let none = placed_step(knot(0.7, true), &[]);
    assert!((none.u - 0.7).abs() < 1e-9 && (none.width - 0.03).abs() < 1e-9, "{none:?}");
}

#[test]
fn a_small_step_next_to_a_hinge_shifts_the_kink() {
    // u - .8| minus its part in 1 and u, for a step and a hinge at .79: 2 (u - .8) beyond .8.
    let knot = Knot { u: 0.79, width: 0.02, is_step: false };
    let knotted = Knotted::new(&Family::Legendre, &[knot], 4);
    let root = 12.0f64.sqrt();
    // x = sqrt(12)(u - 1/2): the hinge has the slope 2/sqrt(12) in it, and the step -2 (.8 - .79).
    let [slope, step] = [2.0 / root, -0.02];
    // Functions 2 and 3 are the hinge and the step, each minus its part in the earlier ones.
    let third = step / knotted.rows[3][3];
    let second = (slope - third * knotted.rows[3][2]) / knotted.rows[2][2];
    let moved = knotted.placed_kink(0, &[(2, second), (3, third)]);
    assert!((moved.u - 0.8).abs() < 1e-9 && (moved.width - 0.01).abs() < 1e-9, "{moved:?}");
}
