//! The explicit pair of Dormand & Prince 1980.

use super::{Attempt, Method, Problem, State};

/// Dormand-Prince 5(4) (Hairer, Norsett & Wanner 1993, Solving Ordinary Differential Equations I, section II.5). Six
/// evaluations per step; the last is the first of the next step.
#[derive(Clone, Copy, Debug)]
pub struct DormandPrince;

const A: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const C: [f64; 6] = [0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
impl Method for DormandPrince {
    const ERROR_ORDER: i32 = 5;

    fn step<const N: usize, P: Problem<N>>(problem: &P, start: &State<N>, h: f64) -> Attempt<N> {
        let mut k = [start.rate; 7];
        let mut y = start.y;
        for stage in 0..6 {
            y = start.y;
            for (weight, slope) in A[stage].iter().zip(&k[..=stage]) {
                for i in 0..N {
                    y[i] += h * weight * slope[i];
                }
            }
            k[stage + 1] = problem.rate(start.t + C[stage] * h, &y);
        }
        let end = std::array::from_fn(|i| {
            // The bits of all results rest on this form.
            let rise = y[i] - start.y[i];
            start.y[i] + rise
        });
        let error =
            std::array::from_fn(|i| h * ERROR.iter().zip(&k).map(|(weight, slope)| weight * slope[i]).sum::<f64>());
        Attempt { end, rate: k[6], error, evaluations: 6 }
    }
}
