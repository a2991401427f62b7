use super::*;
use crate::given::{Method, analyse};

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
    let indices = analyse(inputs, &outputs, Method::Both, seed).unwrap();
    measures(inputs, &outputs, &indices, seed).remove(0).unwrap()
}

/// SALib 1.6 (`delta.calc_delta`, `rbd_fast`), SciPy (`ks_2samp` in the same classes) and the formulas of Gretton's script, on the
/// same table: 6 classes of 120 rows, 10 of 72. Delta is that of normal scores of the output.
#[test]
fn other_programs_have_the_same_numbers() {
    #[rustfmt::skip]
    const EXPECTED: [[f64; 8]; 3] = [
        [0.9273339726067023, 0.6474552568048774, 0.5805555555555556, 0.6962962962962963, 0.6069444444444445, 0.8680555555555556,
            0.9086054136456307, 4.2108992860317647e-150],
        [0.051581326788233205, 0.07932030547915438, 0.10324074074074073, 0.12291666666666665, 0.14166666666666666,
            0.20972222222222223, 0.011029888350824737, 0.003797863611605308],
        [-0.001322287213450242, 0.050676886775974914, 0.06273148148148147, 0.10231481481481484, 0.08958333333333333,
            0.14722222222222223, 0.0017191583280597618, 0.6453763072361031],
    ];
    let inputs = uniform(720, 3, 7);
    let y = output(&inputs, |x| libm::exp(x[0]) + 4.0 * (x[1] - 0.5).powi(2) * x[0]);
    let z = centred(&y.values).unwrap();
    let job = Job::new(&z, &Measure::ALL, [0, 0]);
    for (input, expected) in inputs.iter().zip(EXPECTED) {
        let order = Order::of(&input.values);
        let found = job.plain(&Classes::new(&order, z.len()), &order.shuffled(0, 0));
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{}: {found} {expected}", input.name);
        }
        let (r2, p_value) = hsic::Outputs::new(&z, 0).unwrap().with(&input.values).unwrap();
        assert!((r2 - expected[6]).abs() < 1e-12, "{}: {r2}", input.name);
        let p_value = p_value.unwrap();
        assert!((p_value / expected[7] - 1.0).abs() < 1e-8, "{}: {p_value}", input.name);
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
    let found = measured(&inputs, output(&inputs, |x| 2.0 * x[0] + x[1]), 0);
    for (found, exact) in found.iter().zip([0.505_497_139, 0.160_393_820]) {
        let delta = found.get(Measure::Delta).estimate;
        let interval = delta.interval.unwrap();
        // Nineteen classes know the input no better than to within one of them.
        assert!((-0.03..0.01).contains(&(delta.estimate - exact)), "{delta:?} {exact}");
        assert!(interval.high - interval.low < 0.06 && interval.low < interval.high);
    }
}

#[test]
fn the_interval_of_delta_ends_at_1() {
    let inputs = uniform(500, 2, 3);
    let found = measured(&inputs, output(&inputs, |x| x[0] + 1e-6 * x[1]), 0);
    let delta = found[0].get(Measure::Delta).estimate;
    let interval = delta.interval.unwrap();
    assert!(delta.estimate > 0.7 && interval.high == 1.0, "{delta:?}");
}

#[test]
fn what_is_known_in_closed_form() {
    let x: Vec<f64> = (0..1000).map(|k| f64::from(k * 371 % 1000)).collect();
    let order = Order::of(&x);
    let (labels, count) = order.classes(10);
    for (class, distance) in distances(&order, &(labels, count), &[1.0; 1000]).iter().enumerate() {
        let (before, after) = (class as f64 / 10.0, 1.0 - (class as f64 + 1.0) / 10.0);
        assert!((distance.kolmogorov() - before.max(after)).abs() < 1e-12);
        assert!((distance.kuiper() - before - after).abs() < 1e-12);
    }
}

#[test]
fn delta_does_not_change_when_the_output_is_bent_and_holds_what_wide_kernels_do_not_see() {
    let mut inputs = uniform(1024, 3, 5);
    inputs
        .iter_mut()
        .for_each(|input| input.values.iter_mut().for_each(|u| *u = std::f64::consts::PI * (2.0 * *u - 1.0)));
    let ishigami = |x: &[f64]| libm::sin(x[0]) + 7.0 * libm::sin(x[1]).powi(2) + 0.1 * x[2].powi(4) * libm::sin(x[0]);
    let delta = |found: &InputMeasures| found.get(Measure::Delta).estimate;
    let plain: Vec<Estimate> = measured(&inputs, output(&inputs, ishigami), 1).iter().map(delta).collect();
    let bent = measured(&inputs, output(&inputs, |x| libm::exp(0.5 * ishigami(x))), 1);
    assert_eq!(plain, bent.iter().map(delta).collect::<Vec<Estimate>>());
    // By histograms of 10^6 points for each of 100 values of an input.
    for (found, exact) in plain.iter().zip([0.265, 0.425, 0.21]) {
        let interval = found.interval.unwrap();
        assert!(interval.low < exact && exact < interval.high && interval.high < exact + 0.1, "{found:?} {exact}");
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
            let [plain, scaled, bent] = [plain, scaled, bent].map(|of| of.get(measure).estimate.estimate);
            assert!((plain - scaled).abs() < 1e-9, "{measure:?}: {plain} {scaled}");
            // Kernels are of the values themselves.
            assert!(measure == Measure::Hsic || (plain - bent).abs() < 1e-12, "{measure:?}: {plain} {bent}");
        }
    }
}

#[test]
fn an_input_without_influence_is_told_from_chance_in_five_of_a_hundred_tables() {
    let mut seen = [0; 7];
    const TABLES: u64 = 100;
    for table in 0..TABLES {
        let inputs = uniform(60, 2, 1000 + table);
        let found = measured(&inputs, output(&inputs[..1], |x| x[0] * x[0]), table);
        for measure in Measure::ALL {
            seen[measure as usize] += usize::from(found[1].get(measure).p_value.unwrap() <= 0.05);
            assert!(found[0].get(measure).p_value.unwrap() < 0.01);
        }
    }
    // Of 100 tables with a chance of 0.05, more than 12 are seen once in 500 times.
    assert!(seen.iter().all(|seen| *seen <= 12), "{seen:?}");
}

#[test]
fn inputs_of_one_value_and_even_points_claim_nothing() {
    let mut inputs = uniform(64, 2, 5);
    inputs[1].values.fill(3.0);
    let found = measured(&inputs, output(&inputs, |x| x[0]), 0);
    for measure in Measure::ALL {
        let constant = found[1].get(measure);
        assert_eq!((constant.estimate.estimate, constant.p_value), (0.0, None));
    }
    let grid = |period: u32| (0..64).map(|k| f64::from(k / period % 8)).collect();
    let inputs: Vec<Column> =
        [("a", 1), ("b", 8)].map(|(name, p)| Column { name: name.into(), values: grid(p) }).into();
    let found = measured(&inputs, output(&inputs, |x| x[0] + x[1]), 0);
    assert!(found.iter().all(|of| of.values.iter().all(|of| of.p_value.is_none() && of.estimate.interval.is_none())));
}
