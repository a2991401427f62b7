use super::*;
use crate::given::analyse;

/// Uniform numbers in columns, by the generator of Knuth's MMIX.
fn uniform(rows: usize, columns: usize, mut state: u64) -> Vec<Column> {
    let mut all: Vec<Column> =
        (0..columns).map(|k| Column { name: format!("x{}", k + 1), values: Vec::new() }).collect();
    for _ in 0..rows {
        for column in &mut all {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            column.values.push((state >> 11) as f64 / (1u64 << 53) as f64);
        }
    }
    all
}

fn output(inputs: &[Column], of: impl Fn(&[f64]) -> f64) -> Column {
    let row = |row: usize| of(&inputs.iter().map(|input| input.values[row]).collect::<Vec<f64>>());
    Column { name: "y".into(), values: (0..inputs[0].values.len()).map(row).collect() }
}

fn measured(inputs: &[Column], output: Column, seed: u64) -> Vec<InputMeasures> {
    let outputs = [output];
    let indices = analyse(inputs, &outputs, seed).unwrap();
    measures(inputs, &outputs, &indices, seed).remove(0).unwrap()
}

/// SALib 1.6 (`delta.calc_delta`, `rbd_fast`), SciPy (`ks_2samp` in the same classes) and the formulas of Gretton's script, on the
/// same table: 6 classes of 120 rows, 10 of 72. Delta is that of normal scores of the output.
#[test]
fn other_programs_have_the_same_numbers() {
    #[rustfmt::skip]
    const EXPECTED: [[f64; 6]; 3] = [
        [0.9273339726067023, 0.6474552568048774, 0.6069444444444445, 0.8680555555555556,
            0.9086054136456307, 4.2108992860317647e-150],
        [0.051581326788233205, 0.07932030547915438, 0.14166666666666666,
            0.20972222222222223, 0.011029888350824737, 0.003797863611605308],
        [-0.001322287213450242, 0.050676886775974914, 0.08958333333333333,
            0.14722222222222223, 0.0017191583280597618, 0.6453763072361031],
    ];
    let inputs = uniform(720, 3, 7);
    let y = output(&inputs, |x| libm::exp(x[0]) + 4.0 * (x[1] - 0.5).powi(2) * x[0]);
    let setting = Setting { seed: 0, number: 0, has_p_values: true, has_intervals: true };
    let job = Job::new(&y.values, &Measure::ALL, setting).unwrap();
    for (input, expected) in inputs.iter().zip(EXPECTED) {
        let order = Order::from_values(&input.values);
        let measures = job.plain(&order, &Classes::new(&order, 720, false), order.rows());
        for (value, expected) in measures.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-12, "{}: {value} {expected}", input.name);
        }
        let kernels = hsic::Outputs::new(&job.z, 0).unwrap().measure(&input.values).unwrap();
        let (r2, p_value) = (kernels.estimate.estimate, kernels.p_value);
        assert!((r2 - expected[4]).abs() < 1e-12, "{}: {r2}", input.name);
        let p_value = p_value.unwrap();
        assert!((p_value / expected[5] - 1.0).abs() < 1e-8, "{}: {p_value}", input.name);
    }
}

/// Half of the mean distance of the densities of N(0, s1^2 + s2^2) and N(x, s2^2) over x from N(0, s1^2), by quadrature.
#[test]
fn delta_of_a_sum_of_normals_is_that_of_the_integral() {
    let normal = statrs::distribution::Normal::standard();
    let mut inputs = uniform(6000, 2, 3);
    for input in &mut inputs {
        input.values.iter_mut().for_each(|u| *u = statrs::distribution::ContinuousCDF::inverse_cdf(&normal, *u));
    }
    let measures = measured(&inputs, output(&inputs, |x| 2.0 * x[0] + x[1]), 0);
    for (value, exact) in measures.iter().zip([0.505_497_139, 0.160_393_820]) {
        let delta = value.get(Measure::Delta).unwrap().estimate;
        let interval = delta.interval.unwrap();
        assert!((delta.estimate - exact).abs() < 0.01, "{delta:?} {exact}");
        assert!(interval.high - interval.low < 0.09 && interval.low < exact && exact < interval.high);
    }
}

#[test]
fn the_interval_of_delta_ends_at_1() {
    let inputs = uniform(500, 2, 3);
    let measures = measured(&inputs, output(&inputs, |x| x[0] + 1e-6 * x[1]), 0);
    let delta = measures[0].get(Measure::Delta).unwrap().estimate;
    let interval = delta.interval.unwrap();
    assert!(delta.estimate > 0.7 && interval.high > 0.95 && interval.high <= 1.0, "{delta:?}");
}

#[test]
fn delta_does_not_change_when_the_output_is_bent_and_holds_what_wide_kernels_do_not_see() {
    let mut inputs = uniform(1024, 3, 5);
    inputs
        .iter_mut()
        .for_each(|input| input.values.iter_mut().for_each(|u| *u = std::f64::consts::PI * (2.0 * *u - 1.0)));
    let ishigami = |x: &[f64]| libm::sin(x[0]) + 7.0 * libm::sin(x[1]).powi(2) + 0.1 * x[2].powi(4) * libm::sin(x[0]);
    let delta = |value: &InputMeasures| value.get(Measure::Delta).unwrap().estimate;
    let plain: Vec<Estimate> = measured(&inputs, output(&inputs, ishigami), 1).iter().map(delta).collect();
    let bent = measured(&inputs, output(&inputs, |x| libm::exp(0.5 * ishigami(x))), 1);
    assert_eq!(plain, bent.iter().map(delta).collect::<Vec<Estimate>>());
    // By histograms of 10^6 points for each of 100 values of an input.
    for (value, exact) in plain.iter().zip([0.265, 0.425, 0.21]) {
        let interval = value.interval.unwrap();
        assert!((value.estimate - exact).abs() < 0.05, "{value:?} {exact}");
        assert!(interval.low < exact && exact < interval.high && interval.high < exact + 0.2, "{value:?} {exact}");
    }
}

#[test]
fn neither_scale_nor_offset_of_the_output_nor_a_growing_function_of_the_input_count() {
    let inputs = uniform(300, 2, 11);
    let of = |x: &[f64]| x[0] + 0.3 * x[1];
    let plain = measured(&inputs, output(&inputs, of), 1);
    let scaled = measured(&inputs, output(&inputs, |x| 1e280 * of(x) - 3e280), 1);
    let mut bent = inputs.clone();
    bent[0].values.iter_mut().for_each(|x| *x = x.powi(3));
    let bent = measured(&bent, output(&inputs, of), 1);
    for measure in Measure::ALL {
        for ((plain, scaled), bent) in plain.iter().zip(&scaled).zip(&bent) {
            let [plain, scaled, bent] = [plain, scaled, bent].map(|of| of.get(measure).unwrap().estimate.estimate);
            assert!((plain - scaled).abs() < 1e-9, "{measure:?}: {plain} {scaled}");
            // Kernels are of the values themselves.
            assert!(measure == Measure::Hsic || (plain - bent).abs() < 1e-12, "{measure:?}: {plain} {bent}");
        }
    }
}

#[test]
fn an_input_without_influence_is_significant_in_five_of_a_hundred_tables() {
    let mut seen = [0; Measure::ALL.len()];
    const TABLES: u64 = 100;
    for table in 0..TABLES {
        let inputs = uniform(60, 2, 1000 + table);
        let measures = measured(&inputs, output(&inputs[..1], |x| x[0] * x[0]), table);
        for measure in Measure::ALL {
            seen[measure as usize] += usize::from(measures[1].get(measure).unwrap().p_value.unwrap() <= 0.05);
            assert!(measures[0].get(measure).unwrap().p_value.unwrap() < 0.01);
        }
    }
    // Of 100 tables with a chance of 0.05, more than 12 are seen once in 500 times.
    assert!(seen.iter().all(|seen| *seen <= 12), "{seen:?}");
}

#[test]
fn constant_inputs_and_even_points_have_no_p_values() {
    let mut inputs = uniform(64, 2, 5);
    inputs[1].values.fill(3.0);
    let measures = measured(&inputs, output(&inputs, |x| x[0]), 0);
    for constant in measures[1].measures.values() {
        assert_eq!((constant.estimate.estimate, constant.p_value), (0.0, None));
    }
    let grid = |period: u32| (0..64).map(|k| f64::from(k / period % 8)).collect();
    let inputs: Vec<Column> =
        [("a", 1), ("b", 8)].map(|(name, p)| Column { name: name.into(), values: grid(p) }).into();
    let measures = measured(&inputs, output(&inputs, |x| x[0] + x[1]), 0);
    assert!(
        measures.iter().all(|of| of.measures.values().all(|of| of.p_value.is_none() && of.estimate.interval.is_none()))
    );
}

/// The exact delta of each input is half of the sum of the differences of shares, and of the integral where there is a density.
#[test]
fn delta_of_outputs_with_values_that_many_rows_share() {
    type Case = (&'static str, fn(&[f64]) -> f64, [f64; 2]);
    let cases: [Case; 8] = [
        // For an input that determines the output, classes resolve only a part: not compared.
        ("a switch over a density", |x| if x[0] < 0.5 { 0.0 } else { x[1] }, [0.5, f64::NAN]),
        ("a switch over two values", |x| if x[0] < 0.5 { 0.0 } else { (2.0 * x[1]).floor() }, [0.25, 0.25]),
        ("two values", |x| f64::from(x[0] < 0.5), [0.5, 0.0]),
        ("two values of a sum", |x| f64::from(x[0] + x[1] > 1.0), [0.25, 0.25]),
        ("a rare density", |x| if x[0] > 0.95 { 100.0 * x[1] } else { 0.0 }, [0.095, 0.05]),
        ("ten values", |x| (10.0 * x[0]).floor(), [0.9, 0.0]),
        ("counts", |x| (5.0 * x[0]).floor() + (3.0 * x[1]).floor(), [0.506_667, 0.177_778]),
        ("zero-inflated", |x| (x[0] + x[1] - 1.0).max(0.0), [0.291_667, 0.291_667]),
    ];
    for (name, of, exact) in cases {
        for rows in [300, 2000] {
            let inputs = uniform(rows, 3, 17);
            let measures = measured(&inputs, output(&inputs, of), 1);
            for (value, exact) in measures.iter().zip([exact[0], exact[1], 0.0]) {
                let delta = value.get(Measure::Delta).unwrap().estimate;
                let interval = delta.interval.unwrap();
                let room = if rows == 300 { 0.17 } else { 0.085 };
                assert!(
                    exact.is_nan() || (delta.estimate - exact).abs() < room,
                    "{name}, {rows} rows: {delta:?}, not {exact}"
                );
                assert!(
                    0.0 <= interval.low && interval.low <= delta.estimate && interval.high <= 1.0,
                    "{name}: {delta:?}"
                );
                assert!(exact.is_nan() || exact <= interval.high + 0.05, "{name}, {rows} rows: {delta:?}, not {exact}");
            }
        }
    }
}

#[test]
fn a_huge_value_leaves_ranks_as_they_are() {
    let inputs = uniform(400, 2, 5);
    let mut y = output(&inputs, |x| x[0] + 0.3 * x[1]);
    y.values[7] = 3.0;
    let plain = measured(&inputs, y.clone(), 1);
    y.values[7] = 1e20;
    let huge = measured(&inputs, y, 1);
    for measure in [Measure::Delta, Measure::PawnMedian, Measure::PawnMax] {
        for (plain, huge) in plain.iter().zip(&huge) {
            assert_eq!(plain.get(measure), huge.get(measure));
        }
    }
}

#[test]
fn the_spectrum_does_not_depend_on_the_order_of_rows() {
    let mut inputs = uniform(500, 2, 5);
    inputs[0].values.iter_mut().for_each(|x| *x = (4.0 * *x).floor());
    let y = output(&inputs, |x| x[0] * x[1]);
    let turn = |column: &Column| {
        let mut turned = column.clone();
        turned.values.rotate_left(123);
        turned.values.reverse();
        turned
    };
    let plain = measured(&inputs, y.clone(), 1);
    let turned = measured(&inputs.iter().map(turn).collect::<Vec<Column>>(), turn(&y), 1);
    for (plain, turned) in plain.iter().zip(&turned) {
        let [plain, turned] = [plain, turned].map(|of| of.get(Measure::Fourier).unwrap().estimate.estimate);
        assert!((plain - turned).abs() < 1e-12, "{plain} {turned}");
    }
}

/// Two modes, a centred product (the density of w = |2a - 1| |2b - 1| is -ln w, and 1/v below v = |2a - 1| where that is
/// known), and discrete inputs with gaps between the values of their product.
#[test]
fn the_interval_of_delta_contains_what_kernels_miss() {
    type Case = (&'static str, fn(&[f64]) -> f64, [f64; 3]);
    let cases: [Case; 4] = [
        ("two modes", |x| if x[0] > 0.5 { 10.0 + x[1] } else { x[1] }, [0.5, 1.0, 0.0]),
        ("unequal modes", |x| if x[0] > 0.7 { 2.0 + x[1] } else { x[1] }, [0.42, 1.0, 0.0]),
        ("a centred product", |x| (x[0] - 0.5) * (x[1] - 0.5), [0.3985, 0.3985, 0.0]),
        ("discrete", |x| (5.0 * x[0]).floor() * (3.0 * x[1]).floor() + 0.5 * x[2], [0.48, 4.0 / 9.0, 1.0]),
    ];
    for (name, of, exact) in cases {
        let mut held = [0; 3];
        for table in 0..8 {
            let inputs = uniform(400, 3, 31 * table + 5);
            let measures = measured(&inputs, output(&inputs, of), 1);
            for ((held, value), exact) in held.iter_mut().zip(&measures).zip(exact) {
                let interval = value.get(Measure::Delta).unwrap().estimate.interval.unwrap();
                *held += usize::from(interval.low <= exact && exact <= interval.high);
            }
        }
        assert!(held.iter().all(|held| *held >= 7), "{name}: {held:?} of 8");
    }
}
