//! A Rosenbrock method for stiff problems.

use super::linear::Factors;
use super::{Attempt, Method, Problem, State};

/// RODAS4 of Hairer & Wanner 1996 (Solving Ordinary Differential Equations II, section IV.7 and VI.4): order 4(3), six
/// stages, stiffly accurate, L-stable, for ordinary and index-1 differential-algebraic problems. One Jacobian, one
/// factorisation and six evaluations per step, no iteration, so that a step cannot stall.
#[derive(Clone, Copy, Debug)]
pub struct Rodas;

const GAMMA: f64 = 0.25;
const A: [[f64; 4]; 3] = [
    [1.544, 0.0, 0.0, 0.0],
    [0.946_678_528_081_582_6, 0.255_701_169_898_328_4, 0.0, 0.0],
    [3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_998_178_1, 0.0],
];
const A5: [f64; 4] = [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895];
const C: [[f64; 5]; 5] = [
    [-5.6688, 0.0, 0.0, 0.0, 0.0],
    [-2.430_093_356_833_875, -0.206_359_915_709_191_5, 0.0, 0.0, 0.0],
    [-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16, 0.0, 0.0],
    [7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6, 0.0],
    [
        8.083_246_795_921_522,
        -7.981_132_988_064_893,
        -31.521_594_328_743_71,
        16.319_305_431_231_36,
        -6.058_818_238_834_054,
    ],
];
const TIMES: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
const TIME_RATES: [f64; 6] = [0.25, -0.1043, 0.1035, -0.036_2, 0.0, 0.0];
impl Method for Rodas {
    const ERROR_ORDER: i32 = 4;

    fn step<const N: usize, P: Problem<N>>(problem: &P, start: &State<N>, h: f64) -> Attempt<N> {
        let mass = problem.mass();
        let jacobian = problem.jacobian(start.t, &start.y);
        let time_rate = problem.time_rate(start.t, &start.y);
        let factors = Factors::new(std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { mass[i] / (h * GAMMA) } else { 0.0 } - jacobian[i][j])
        }));
        let mut k = [[0.0; N]; 6];
        let mut y = start.y;
        for stage in 0..6 {
            match stage {
                0 => {}
                1..4 => y = shifted(&start.y, &A[stage - 1], &k),
                4 => y = shifted(&start.y, &A5, &k),
                // Stiffly accurate: the last stages and the result add the newest increment.
                _ => y = std::array::from_fn(|i| y[i] + k[4][i]),
            }
            let rate = if stage == 0 { start.rate } else { problem.rate(start.t + TIMES[stage] * h, &y) };
            let coupling = if stage == 0 { [0.0; N] } else { shifted(&[0.0; N], &C[stage - 1], &k) };
            let mut b = [0.0; N];
            for i in 0..N {
                b[i] = rate[i] + mass[i] * coupling[i] / h + h * TIME_RATES[stage] * time_rate[i];
            }
            k[stage] = factors.solve(&b);
        }
        let last: [f64; N] = std::array::from_fn(|i| y[i] + k[5][i]);
        let end = std::array::from_fn(|i| {
            // The bits of all results rest on this form.
            let rise = last[i] - start.y[i];
            start.y[i] + rise
        });
        Attempt { end, rate: problem.rate(start.t + h, &last), error: k[5], evaluations: 6 }
    }
}

/// Returns `y` + sum of weights times increments.
fn shifted<const N: usize, const S: usize>(y: &[f64; N], weights: &[f64; S], k: &[[f64; N]; 6]) -> [f64; N] {
    let mut sum = *y;
    for (weight, increment) in weights.iter().zip(k) {
        for i in 0..N {
            sum[i] += weight * increment[i];
        }
    }
    sum
}
