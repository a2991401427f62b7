use super::*;
use apportion::afm::{FrictionLaw, LuGreParameters, Options, Parameter, Scene, critical_force};
use apportion::report::chart::png;
use apportion::study::AfmSubject;

const DIMENSIONS: [(&str, f64, f64, f64); 3] =
    [("length", 200.0, 700.0, -2.0), ("width", 5.0, 80.0, 1.0), ("thickness", 0.25, 2.5, 3.0)];

/// E x^p for x uniform on (a, b).
fn moment((a, b): (f64, f64), p: f64) -> f64 {
    let integral =
        if p == -1.0 { libm::log(b / a) } else { (libm::pow(b, p + 1.0) - libm::pow(a, p + 1.0)) / (p + 1.0) };
    integral / (b - a)
}

/// Var ln x for x uniform on (a, b), from the antiderivatives of ln x and ln^2 x.
fn log_variance((a, b): (f64, f64)) -> f64 {
    let first = |x: f64| x * libm::log(x) - x;
    let second = |x: f64| x * libm::log(x).powi(2) - 2.0 * x * libm::log(x) + 2.0 * x;
    let mean = (first(b) - first(a)) / (b - a);
    (second(b) - second(a)) / (b - a) - mean * mean
}

fn in_percent(sizes: [f64; 3]) -> [f64; 3] {
    sizes.map(|size| 100.0 * size / sizes.iter().sum::<f64>())
}

fn of(id: &str, group: &'static str, effort: Effort) -> Vec<Reading> {
    of_variant(variant(id).unwrap(), group, effort, 0).unwrap()
}

fn share(reading: &Reading, factor: &str) -> f64 {
    reading.shares.iter().find(|share| share.factor == factor).unwrap().share
}

fn find<'a>(readings: &'a [Reading], id: &str) -> &'a Reading {
    readings.iter().find(|reading| reading.id == id).unwrap()
}

#[test]
fn the_catalogue_is_in_order() {
    let mut ids: Vec<&str> = VARIANTS.iter().map(|variant| variant.id).collect();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), VARIANTS.len());
    for variant in VARIANTS {
        for group in GROUPS {
            let study = study(variant, group.key, &[]).unwrap();
            let left_out = variant.settings.len() - settings(variant, &study).len();
            // LG's modulus, where the modulus is a factor.
            assert_eq!(left_out, usize::from(variant.id == "lg-probe" && group.key != "dimensional"), "{}", variant.id);
        }
        assert!(variant.base_samples >= 1 << 10);
    }
    assert!(SMALL_SAMPLE_VARIANTS.iter().all(|id| variant(id).is_some()));
}

#[test]
fn shares_of_the_base_reading_are_those_of_a_product() {
    let readings = of("lugre", "dimensional", Effort::Full);
    let v = DIMENSIONS.map(|(_, a, b, p)| moment((a, b), 2.0 * p) / moment((a, b), p).powi(2) - 1.0);
    let all: f64 = v.iter().map(|v| 1.0 + v).product();
    let first = in_percent(v);
    let total = in_percent(v.map(|v| v * all / (1.0 + v)));
    for (effect, expected) in [("first-order", first), ("total", total)] {
        let reading = find(&readings, &format!("lugre/{effect}/critical_force"));
        for ((factor, ..), expected) in DIMENSIONS.into_iter().zip(expected) {
            // 2^15 points are good to about 0.3 points.
            assert!((share(reading, factor) - expected).abs() < 0.6, "{effect} {factor}: {}", share(reading, factor));
        }
        assert!(share(reading, "height").abs() < 1e-9);
        assert!((reading.distance - (76.0 - share(reading, "thickness")).abs()).abs() < 1e-9);
    }
    let plain = find(&readings, "lugre/plain-first-order/critical_force");
    assert!((share(plain, "thickness") - 100.0 * v[2] / (all - 1.0)).abs() < 0.6);
    let plain = find(&readings, "lugre/plain-total/critical_force");
    assert!((share(plain, "thickness") - 100.0 * v[2] * all / (1.0 + v[2]) / (all - 1.0)).abs() < 1.0);
}

#[test]
fn shares_of_the_logarithm_are_those_of_a_sum() {
    let readings = of("lugre", "dimensional", Effort::Full);
    let expected = in_percent(DIMENSIONS.map(|(_, a, b, p)| p * p * log_variance((a, b))));
    // Of a sum every measure of variance is the same; one factor at a time has no sampling error, and the viscous term of
    // 1e-14 N beside forces from 1e-9 N on moves its shares by less than 1e-3.
    let cases = [
        ("first-order", 0.1),
        ("total", 0.1),
        ("plain-first-order", 0.1),
        ("plain-total", 0.1),
        ("variance-alone", 1e-3),
    ];
    for (effect, tolerance) in cases {
        let reading = find(&readings, &format!("lugre/{effect}/log_critical_force"));
        for ((factor, ..), expected) in DIMENSIONS.into_iter().zip(expected) {
            assert!((share(reading, factor) - expected).abs() < tolerance, "{effect} {factor}");
        }
    }
}

#[test]
fn one_factor_at_a_time_is_exact() {
    let readings = of("lugre", "dimensional", Effort::Quick);
    let nominal = [225.0, 48.0, 1.0];
    let at = |place: usize, x: f64| libm::pow(x / nominal[place], DIMENSIONS[place].3);
    let variances = [0, 1, 2].map(|place| {
        let (_, a, b, p) = DIMENSIONS[place];
        (moment((a, b), 2.0 * p) - moment((a, b), p).powi(2)) / libm::pow(nominal[place], 2.0 * p)
    });
    let ranges = [0, 1, 2].map(|place| (at(place, DIMENSIONS[place].1) - at(place, DIMENSIONS[place].2)).abs());
    for (effect, expected) in [("variance-alone", in_percent(variances)), ("range-alone", in_percent(ranges))] {
        let reading = find(&readings, &format!("lugre/{effect}/critical_force"));
        for ((factor, ..), expected) in DIMENSIONS.into_iter().zip(expected) {
            // The midpoint rule of 1024 values.
            assert!((share(reading, factor) - expected).abs() < 1e-3, "{effect} {factor}");
        }
    }
}

#[test]
fn viscous_friction_and_steps_of_14_ms_make_velocity_act() {
    for reading in of("lugre-viscous", "environmental", Effort::Quick) {
        assert!((share(&reading, "velocity") - 26.0).abs() < 1.0, "{}: {}", reading.id, share(&reading, "velocity"));
        assert!((share(&reading, "elastic_modulus") - 74.0).abs() < 1.0);
        assert!(reading.distance < 1.0);
    }
    for reading in of("step-14", "environmental", Effort::Quick) {
        // 256 base points of a function with jumps: an interval of some 3.5.
        assert!((share(&reading, "velocity") - 25.0).abs() < 5.0, "{}: {}", reading.id, share(&reading, "velocity"));
    }
    for reading in of("lugre", "environmental", Effort::Quick) {
        assert!(share(&reading, "velocity").abs() < 0.01, "{}", reading.id);
    }
}

/// What the fidelities take LuGre friction to hold is what its bristles' ramp gives, frozen or of the contact.
#[test]
fn held_friction_is_that_of_lugre() {
    let study = study(variant("step-14").unwrap(), "general", &[]).unwrap();
    let afm = study.subject().downcast_ref::<AfmSubject>().expect("the nanoparticle model");
    for place in 0..8 {
        let u: Vec<f64> = (0..8).map(|factor| (0.5 + (place * 8 + factor) as f64 * 0.618_034).fract()).collect();
        let mut scene = afm.scene;
        for (factor, value) in study.space().factors().iter().zip(study.space().values_at(&u)) {
            (Parameter::from_name(&factor.name).unwrap().set)(&mut scene, factor.unit().to_si(value));
        }
        let quasi_static = Options { fidelity: apportion::afm::Fidelity::QuasiStatic, ..afm.options };
        for held in [afm.options, quasi_static] {
            let force = |options: &Options, scene: &Scene| critical_force(scene, options).unwrap().critical_force;
            let expected = force(&held, &scene);
            for lugre in [LuGreParameters::Frozen, LuGreParameters::Contact] {
                let options = Options { friction: FrictionLaw::LuGre, lugre, ..held };
                let found = force(&options, &scene);
                assert!(
                    (found / expected - 1.0).abs() < 1e-5,
                    "{lugre:?} {:?} {u:?}: {found} {expected}",
                    held.fidelity
                );
            }
        }
    }
}

#[test]
fn small_samples_scatter_about_the_shares_of_large_ones() {
    let study = study(variant("lugre").unwrap(), "dimensional", &[]).unwrap();
    let samples = small_samples::of_study(&study, "lugre", "dimensional", Effort::Quick, 2).unwrap();
    assert_eq!(samples.len(), 4 * 2 * 2 * 2);
    let exact = in_percent(DIMENSIONS.map(|(_, a, b, p)| p * p * log_variance((a, b))));
    let of = |base_samples: u64| {
        let is = |sample: &&SmallSample| {
            (sample.base_samples, sample.estimators) == (base_samples, Estimators::SaltelliJansen)
                && (sample.effect, sample.output) == (Effect::Total, AfmOutput::LogCriticalForce)
        };
        samples.iter().find(is).unwrap()
    };
    for ((factor, ..), exact) in DIMENSIONS.into_iter().zip(exact) {
        let quantiles = |n| of(n).factors.iter().find(|f| f.factor == factor).unwrap().quantiles.unwrap();
        // The 95 % of samples of 1000 reach 2 points either way: the median of 100 of them is good to 0.3.
        assert!((quantiles(1000)[2] - exact).abs() < 0.5, "{factor}: {:?}", quantiles(1000));
        assert!(quantiles(1000).is_sorted() && quantiles(100).is_sorted());
        let width = |n| quantiles(n)[4] - quantiles(n)[0];
        // The width falls as N^-1/2, here by 3.2; that of 100 repetitions is good to a fifth or so.
        assert!((2.0..5.0).contains(&(width(100) / width(1000))), "{factor}");
    }
    for sample in &samples {
        assert!(sample.within_1.count <= sample.within_3.count && sample.within_3.count <= sample.with_shares);
        let thickness = sample.factors.iter().find(|factor| factor.factor == "thickness").unwrap();
        assert_eq!(thickness.published, Some(76.0));
        assert!((0.0..=1.0).contains(&thickness.published_quantile.unwrap()));
    }
}

#[test]
fn the_interval_of_a_chance_is_where_it_is_barely_compatible() {
    for (count, all) in [(0, 100), (1, 100), (37, 1000), (999, 1000), (1000, 1000)] {
        let chance = Chance::of(count, all);
        assert!(chance.low <= chance.share && chance.share <= chance.high);
        // Wilson's bounds p solve |share - p| = z sqrt(p (1 - p)/n); 0 and 1 solve it where the share is 0 or 1.
        for p in [chance.low, chance.high] {
            let z = 1.959_963_984_540_054 * (p * (1.0 - p) / all as f64).sqrt();
            assert!(((chance.share - p).abs() - z).abs() < 1e-12, "{count} of {all}: {p}");
        }
    }
}

#[test]
fn the_same_on_any_number_of_threads() {
    let some = || &VARIANTS[..2];
    let computed = |threads| compute(some(), &["lugre"], Effort::Quick, threads, &|_, _| ()).unwrap();
    let (one, three) = (computed(1), computed(3));
    assert_eq!(one.rows, three.rows);
    assert_eq!(one.small_samples, three.small_samples);
    assert_eq!((readings_csv(&one), small_samples_csv(&one)), (readings_csv(&three), small_samples_csv(&three)));
    let json = |readings: &Readings| {
        let mut value: serde_json::Value = serde_json::from_str(&readings_json(readings)).unwrap();
        value.as_object_mut().unwrap().remove("timing").unwrap();
        value
    };
    assert_eq!(json(&one), json(&three));
    tables_and_charts(&one);
}

/// What is made of readings, whatever they are.
fn tables_and_charts(readings: &Readings) {
    // 12 readings of the base and 4 of Coulomb friction in studies of 4, 4 and 8 factors.
    assert_eq!((readings.rows.len(), readings_csv(readings).lines().count()), (3 * 16, 1 + 16 * (4 + 4 + 8)));
    assert_eq!(small_samples_csv(readings).lines().count(), 1 + 32 * (4 + 4 + 8));
    let mut lines = csv::Reader::from_reader(readings_csv(readings).into_bytes().leak() as &[u8]);
    assert!(lines.records().all(|line| line.is_ok()), "every line has the columns of the header");
    for chart in [distance_chart(readings), small_sample_chart(readings)] {
        assert!(png(&chart.svg().unwrap()).unwrap().width > 0);
    }
    let summary = [summary(readings), chances(readings)].concat().join("\n");
    for words in ["Dimensional: of 16 readings", "No reading meets all three groups", "82.5 %", "Chance, general study"]
    {
        assert!(summary.contains(words), "{words}: {summary}");
    }
}

#[test]
fn nothing_computed_is_nothing_said() {
    let none = Readings { rows: Vec::new(), small_samples: Vec::new(), threads: 1, wall_seconds: 0.0 };
    assert_eq!(readings_csv(&none).lines().count(), 1);
    assert_eq!(summary(&none).len(), 1);
    assert!(distance_chart(&none).svg().is_err(), "no rows");
}
