//! Indices from given data by surrogates: exact answers, intervals that contain the exact indices also for rough functions, and every table
//! that must be refused.

use apportion::Distribution;
use apportion::given::{Column, NoVariance, SurrogateOutput, SurrogateRefusal, Surrogates, analyse, surrogate_indices};
use apportion::model::KnownAnswer;

use crate::engine::points::*;

fn named(columns: &Columns) -> Vec<Column> {
    let named = |(j, values): (usize, &Vec<f64>)| Column { name: format!("x{}", j + 1), values: values.clone() };
    columns.iter().enumerate().map(named).collect()
}

fn evaluated(columns: &Columns, function: impl Fn(&[f64]) -> f64) -> Column {
    let row = |k: usize| columns.iter().map(|column| column[k]).collect::<Vec<f64>>();
    Column { name: "y".to_owned(), values: (0..columns[0].len()).map(|k| function(&row(k))).collect() }
}

fn fitted(columns: &Columns, y: Column, known: Option<&[Distribution]>) -> Result<Surrogates, SurrogateRefusal> {
    let (inputs, outputs) = (named(columns), [y]);
    let indices = analyse(&inputs, &outputs, 0).unwrap();
    surrogate_indices(&inputs, &outputs, &indices, known)
}

fn output(columns: &Columns, y: Column, known: Option<&[Distribution]>) -> SurrogateOutput {
    fitted(columns, y, known).unwrap().outputs.remove(0).unwrap()
}

fn units(count: usize) -> Vec<Distribution> {
    vec![Distribution::uniform(0.0, 1.0).unwrap(); count]
}

/// Whether the intervals hold the exact indices.
#[track_caller]
fn holds(of: &SurrogateOutput, first_order: &[f64], total: &[f64]) {
    for (j, index) in of.indices.iter().enumerate() {
        for (estimate, exact) in [(index.first_order, first_order[j]), (index.total, total[j])] {
            let interval = estimate.interval.unwrap();
            assert!(interval.low <= exact && exact <= interval.high, "x{}: {estimate:?}, exactly {exact}", j + 1);
        }
    }
}

/// x1 + 2 x2 + 3 (x1 - 1/2)(x2 - 1/2): variances 1/12, 4/12 and 9/144.
fn polynomial(x: &[f64]) -> f64 {
    x[0] + 2.0 * x[1] + 3.0 * (x[0] - 0.5) * (x[1] - 0.5)
}

const POLYNOMIAL: ([f64; 3], [f64; 3]) = {
    let (one, two, both) = (1.0 / 12.0, 4.0 / 12.0, 9.0 / 144.0);
    let all = one + two + both;
    ([one / all, two / all, 0.0], [(one + both) / all, (two + both) / all, 0.0])
};

#[test]
fn a_polynomial_of_known_inputs_has_its_indices_to_rounding() {
    let columns = random(3, 200, 1);
    let of = output(&columns, evaluated(&columns, polynomial), Some(&units(3)));
    assert!(of.serves && of.unknown < 1e-15, "{}", of.unknown);
    assert_eq!(of.leading_terms[0].degrees, [("x2".to_owned(), 1)].into());
    for (j, index) in of.indices.iter().enumerate() {
        assert!((index.first_order.estimate - POLYNOMIAL.0[j]).abs() < 1e-9, "{index:?}");
        assert!((index.total.estimate - POLYNOMIAL.1[j]).abs() < 1e-9, "{index:?}");
    }
    holds(&of, &POLYNOMIAL.0, &POLYNOMIAL.1);
}

#[test]
fn of_unknown_inputs_it_is_known_as_well_as_these() {
    let columns = random(3, 400, 2);
    let of = output(&columns, evaluated(&columns, polynomial), None);
    assert!(of.serves && of.unknown < 1e-15, "{}", of.unknown);
    for (j, index) in of.indices.iter().enumerate() {
        // S of a sum errs as the variances of 400 uniform values do, by 0.9/sqrt(400) of S (1 - S) from each.
        assert!((index.first_order.estimate - POLYNOMIAL.0[j]).abs() < 0.04, "{index:?}");
        let interval = index.total.interval.unwrap();
        assert!(j == 2 || (0.02..0.12).contains(&(interval.high - interval.low)), "{interval:?}");
    }
    holds(&of, &POLYNOMIAL.0, &POLYNOMIAL.1);
}

#[test]
fn ishigami_from_a_table() {
    let function = KnownAnswer::from_name("ishigami").unwrap().default_function();
    let exact = function.exact().indices.unwrap();
    let distributions: Vec<Distribution> = function.inputs().iter().map(|input| input.distribution.clone()).collect();
    for sample in [random, sobol] {
        let columns: Columns = sample(3, 400, 3)
            .iter()
            .zip(&distributions)
            .map(|(u, distribution)| u.iter().map(|u| distribution.quantile(*u)).collect())
            .collect();
        let y = evaluated(&columns, |x| function.value(x));
        let of = output(&columns, y.clone(), Some(&distributions));
        for (j, index) in of.indices.iter().enumerate() {
            assert!((index.first_order.estimate - exact.first_order[j]).abs() < 1e-4, "{index:?}");
            assert!((index.total.estimate - exact.total[j]).abs() < 1e-4, "{index:?}");
        }
        let unknown = output(&columns, y, None);
        assert!(unknown.unknown < 1e-3, "{}", unknown.unknown);
        holds(&unknown, &exact.first_order, &exact.total);
    }
}

#[test]
fn intervals_contain_the_exact_values_of_a_rough_function() {
    let function = KnownAnswer::from_name("steps").unwrap().default_function();
    let exact = function.exact().indices.unwrap();
    let (mut held, mut all) = (0, 0);
    for seed in 0..16 {
        let columns = random(exact.total.len(), 300, seed);
        let of = output(&columns, evaluated(&columns, |x| function.value(x)), Some(&units(exact.total.len())));
        assert!((of.explained - (1.0 - of.unknown)).abs() < 1e-12 && of.serves == (of.explained >= 0.9), "{of:?}");
        for index in &of.indices {
            let interval = index.total.interval.unwrap();
            assert!(interval.high - index.total.estimate >= of.unknown);
        }
        // A step across two inputs, of which polynomials leave a part; by quadrature to 2e-4.
        let columns = random(3, 300, seed);
        let ridge = |x: &[f64]| f64::from(u8::from(x[0] + x[1] > 1.2)) + 0.3 * x[2];
        let of_ridge = output(&columns, evaluated(&columns, ridge), Some(&units(3)));
        assert!(of_ridge.unknown > 0.02 && of_ridge.unknown < 0.3, "{}", of_ridge.unknown);
        let ridge_first = [0.3031426, 0.3031426, 0.0333497];
        for (of, first, total) in [
            (&of, &exact.first_order[..], &exact.total[..]),
            (&of_ridge, &ridge_first[..], &[0.6635077, 0.6635077, 0.0333497][..]),
        ] {
            for (index, (first, total)) in of.indices.iter().zip(first.iter().zip(total)) {
                for (estimate, exact) in [(index.first_order, first), (index.total, total)] {
                    let interval = estimate.interval.unwrap();
                    held += usize::from(interval.low - 2e-4 <= *exact && *exact <= interval.high + 2e-4);
                    all += 1;
                }
            }
        }
    }
    assert!(held * 100 >= all * 95, "{held} of {all}");
}

#[test]
fn noise_is_refused() {
    let columns = random(4, 300, 5);
    let y = Column { name: "y".to_owned(), values: columns[3].clone() };
    let of = output(&columns[..3].to_vec(), y, None);
    assert!(!of.serves && of.explained < 0.1 && of.unknown > 0.9, "{}", of.explained);
    for index in &of.indices {
        assert!(index.total.interval.unwrap().high > 0.9 && index.total.estimate < 0.1, "{index:?}");
    }
}

#[test]
fn scales_and_offsets_change_nothing() {
    let columns = random(2, 120, 6);
    let function = |x: &[f64]| x[0] + (2.0 * x[1]).exp();
    let reference = output(&columns, evaluated(&columns, function), None);
    for (of_input, of_output, offset) in [(1e-300, 1e300, 0.0), (1e300, 1e-300, 0.0), (1.0, 1.0, 1e6)] {
        let scaled: Columns = columns.iter().map(|x| x.iter().map(|x| x * of_input).collect()).collect();
        let y = evaluated(&columns, |x| function(x) * of_output + offset);
        let of = output(&scaled, y, None);
        for (a, b) in of.indices.iter().zip(&reference.indices) {
            assert!((a.total.estimate - b.total.estimate).abs() < 1e-6, "{a:?} {b:?}");
        }
    }
    // Here the output has about three digits.
    let far = output(&columns, evaluated(&columns, |x| function(x) + 1e13), None);
    for (a, b) in far.indices.iter().zip(&reference.indices) {
        assert!((a.total.estimate - b.total.estimate).abs() < 1e-2, "{a:?} {b:?}");
    }
}

#[test]
fn odd_tables_have_an_answer() {
    let rows = 60;
    let base = random(3, rows, 7);
    let coins: Columns = base.iter().map(|x| x.iter().map(|x| f64::from(u8::from(*x < 0.5))).collect()).collect();
    let y = evaluated(&coins, |x| 2.0 * x[0] + x[1]);
    let of = output(&coins, y, None);
    assert!(of.explained > 1.0 - 1e-9, "{}", of.explained);
    let constant = vec![base[0].clone(), vec![3.0; rows]];
    let of = output(&constant, evaluated(&constant, |x| x[0] * x[0]), None);
    assert!(of.serves && of.indices[1].total.estimate == 0.0);
    let all_constant = vec![vec![1.0; rows], vec![2.0; rows]];
    let of = output(&all_constant, Column { name: "y".to_owned(), values: base[0].clone() }, None);
    assert!(!of.serves && of.unknown == 1.0);
    let one = vec![base[0].clone()];
    let of = output(&one, evaluated(&one, |x| x[0].sin()), None);
    assert!(of.serves && (of.indices[0].first_order.estimate - 1.0).abs() < 1e-6, "{:?}", of.indices);
    // More inputs than rows, and fewer rows than terms.
    let many = random(80, 40, 8);
    let of = output(&many, evaluated(&many, |x| x[0]), None);
    assert!(of.indices.len() == 80 && of.indices.iter().all(|index| index.total.estimate.is_finite()));
    let still = Column { name: "y".to_owned(), values: vec![4.0; rows] };
    assert_eq!(fitted(&base, still, None).unwrap().outputs, [Err(NoVariance::Constant)]);
}

#[test]
fn tables_that_do_not_fit_are_refused() {
    let mut columns = random(3, 200, 9);
    let y = evaluated(&columns, |x| x[0] + x[1]);
    assert_eq!(
        fitted(&columns, y.clone(), Some(&units(2))),
        Err(SurrogateRefusal::Distributions { distributions: 2, inputs: 3 })
    );
    let mut other = units(3);
    for wrong in [Distribution::uniform(0.0, 0.9), Distribution::uniform(-1.0, 1.0), Distribution::normal(0.5, 3.0)] {
        other[1] = wrong.unwrap();
        let refusal = fitted(&columns, y.clone(), Some(&other));
        assert_eq!(refusal, Err(SurrogateRefusal::OtherDistribution { input: "x2".to_owned() }));
    }
    columns[2] = columns[0].iter().zip(&columns[1]).map(|(a, b)| a + 0.1 * b).collect();
    let refusal = fitted(&columns, y, None).unwrap_err();
    assert_eq!(refusal, SurrogateRefusal::Dependent { inputs: ("x1".to_owned(), "x3".to_owned()) });
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let columns = random(3, 150, 10);
    let y = evaluated(&columns, |x| x[0].sin() * x[1] + x[2]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| output(&columns, y.clone(), None))
    };
    assert_eq!(on(1), on(3));
}
