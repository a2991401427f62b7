use std::f64::consts::PI;

use super::*;
use crate::design::Sampler;
use crate::model::function_model;
use crate::quantity::Unit;
use crate::screening::{ScreenedFactor, ScreeningDesign, ScreeningError, ScreeningJob, ScreeningSettings, screen};
use crate::space::{Factor, Space};

fn space(distributions: &[Distribution]) -> Space {
    let factor = |(j, distribution): (usize, &Distribution)| {
        Factor::new(&format!("x{}", j + 1), Unit::dimensionless(), distribution.clone()).unwrap()
    };
    Space::new(distributions.iter().enumerate().map(factor).collect())
}

fn screened(
    distributions: &[Distribution],
    sampler: Sampler,
    trajectories: u64,
    seed: u64,
    f: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
) -> Result<Vec<ScreenedFactor>, ScreeningError> {
    let settings = ScreeningSettings { design: ScreeningDesign::Derivative { sampler }, trajectories, seed };
    let (space, model) = (space(distributions), function_model("y", f));
    let screening = screen(ScreeningJob { space: &space, model: &model, settings }, 0, &|_| ())?;
    Ok(screening.outputs[0].factors.clone())
}

fn uniform(min: f64, max: f64) -> Distribution {
    Distribution::uniform(min, max).unwrap()
}

/// nu and the bound of every factor.
fn found(factors: &[ScreenedFactor]) -> Vec<[f64; 2]> {
    let of = |factor: &ScreenedFactor| {
        let (nu, total_bound) = (factor.nu.unwrap(), factor.total_bound);
        [nu.estimate, total_bound.map_or(f64::NAN, |bound| bound.estimate)]
    };
    factors.iter().map(of).collect()
}

fn near(found: f64, exact: f64, relative: f64) {
    assert!((found - exact).abs() <= relative * exact.abs(), "{found} is not {exact}");
}

#[test]
fn a_linear_function_has_the_squares_of_its_slopes() {
    let factors = [
        uniform(-1.0, 3.0),
        Distribution::normal(5.0, 2.0).unwrap(),
        Distribution::exponential(0.5, 1.0).unwrap(),
        Distribution::log_normal(1.0, 0.5).unwrap(),
        uniform(0.0, 1e-9),
        Distribution::constant(3.0).unwrap(),
    ];
    let slopes = [3.0, -2.0, 4.0, 1.0, 0.0, 7.0];
    let linear = move |x: &[f64]| x.iter().zip(slopes).map(|(x, c)| c * x).sum();
    for sampler in [Sampler::Sobol, Sampler::Random, Sampler::LatinHypercube] {
        let screened = screened(&factors, sampler, 4096, 1, linear).unwrap();
        let variance = 9.0 * 16.0 / 12.0 + 4.0 * 4.0 + 16.0 * 0.25 + factors[3].sd().powi(2);
        // That of the variance of 4096 points.
        let slack = if sampler == Sampler::Sobol { 0.02 } else { 0.1 };
        for (number, ([nu, bound], slope)) in found(&screened).into_iter().zip(slopes).enumerate() {
            // A constant has no measurable derivative.
            near(nu, if number == 5 { 0.0 } else { slope * slope }, 1e-6);
            match number {
                // Exactly the total index of a normal factor; 12/pi^2 of it of a uniform one, 4 times of an exponential one.
                0 => near(bound, 12.0 / PI.powi(2) * 12.0 / variance, slack),
                1 => near(bound, 16.0 / variance, slack),
                2 => near(bound, 4.0 * 4.0 / variance, slack),
                3 => assert!(bound.is_nan()),
                _ => assert_eq!(bound, 0.0),
            }
        }
        // The other measures are those of the derivative times the range.
        let measures = &screened[0];
        assert!(
            (measures.mu.unwrap().estimate - 12.0).abs() < 1e-5 && measures.sigma.unwrap().estimate < 1e-5,
            "{measures:?}"
        );
    }
}

/// Sobol' and Kucherenko (2009), Kucherenko et al. (2009): closed forms by hand.
#[test]
fn ishigami_and_sobol_g_have_their_closed_forms() {
    let ishigami = |x: &[f64]| libm::sin(x[0]) + 7.0 * libm::sin(x[1]).powi(2) + 0.1 * x[2].powi(4) * libm::sin(x[0]);
    let factors = [uniform(-PI, PI), uniform(-PI, PI), uniform(-PI, PI)];
    let exact = [0.5 * (1.0 + 0.04 * PI.powi(4) + 0.01 * PI.powi(8) / 9.0), 24.5, 0.08 * PI.powi(6) / 7.0];
    let variance = 0.5 + 49.0 / 8.0 + PI.powi(4) / 50.0 + PI.powi(8) / 1800.0;
    let screened_at = |seed| screened(&factors, Sampler::Sobol, 8192, seed, ishigami).unwrap();
    for ([nu, bound], exact) in found(&screened_at(0)).into_iter().zip(exact) {
        near(nu, exact, 0.01);
        near(bound, 4.0 * exact / variance, 0.02);
    }
    let a = [0.0, 1.0, 4.5, 9.0];
    let g = move |x: &[f64]| x.iter().zip(a).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product();
    let factors = [0.0; 4].map(|_| uniform(0.0, 1.0));
    let part = |a: f64| 1.0 + 1.0 / (3.0 * (1.0 + a) * (1.0 + a));
    let all: f64 = a.iter().map(|a| part(*a)).product();
    let screened = screened(&factors, Sampler::Sobol, 8192, 0, g).unwrap();
    for ([nu, bound], a) in found(&screened).into_iter().zip(a) {
        let exact = 16.0 / (1.0 + a).powi(2) * all / part(a);
        near(nu, exact, 0.01);
        near(bound, exact / PI.powi(2) / (all - 1.0), 0.02);
        let total = all / part(a) * (part(a) - 1.0) / (all - 1.0);
        assert!(total < bound, "{total} {bound}");
    }
}

#[test]
fn intervals_hold_the_truth() {
    // x y on (-1, 1)^2: nu = E y^2 = 1/3, V = 1/9, bound 4/pi^2 3 = 12/pi^2.
    let factors = [uniform(-1.0, 1.0), uniform(-1.0, 1.0)];
    for sampler in [Sampler::Sobol, Sampler::Random] {
        let mut held = [0; 2];
        for seed in 0..100 {
            for factor in screened(&factors, sampler, 128, seed, |x| x[0] * x[1]).unwrap() {
                let (nu, total_bound) = (factor.nu.unwrap(), factor.total_bound);
                for (held, (estimate, exact)) in
                    held.iter_mut().zip([(nu, 1.0 / 3.0), (total_bound.unwrap(), 12.0 / PI.powi(2))])
                {
                    let interval = estimate.interval.unwrap();
                    // Finite differences have a relative error of a few thousandths.
                    *held += i32::from(interval.low <= exact * 1.002 && exact * 0.998 <= interval.high);
                }
            }
        }
        assert!(held.iter().all(|held| (180..=200).contains(held)), "{sampler:?}: {held:?} of 200");
    }
}

#[test]
fn constants_of_poincare_are_those_that_are_known() {
    let constant = |distribution: Result<Distribution, _>| poincare_constant(&distribution.unwrap());
    assert_eq!(constant(Distribution::normal(1.0, 3.0)), Some(9.0));
    near(constant(Distribution::uniform(2.0, 2.0 + PI)).unwrap(), 1.0, 1e-15);
    near(constant(Distribution::triangular(0.0, 1.0, PI)).unwrap(), 1.0, 1e-15);
    near(constant(Distribution::exponential(2.0, 5.0)).unwrap(), 16.0, 1e-12);
    // Cut off far out it is normal, cut off near its mean it is almost uniform.
    assert_eq!(constant(Distribution::truncated_normal(0.0, 1.0, -9.0, 9.0)), Some(1.0));
    near(constant(Distribution::truncated_normal(0.0, 9.0, 0.0, PI)).unwrap(), 1.0, 1e-15);
    assert_eq!(constant(Distribution::log_uniform(1.0, 2.0)), None);
    // The inequality itself, of x and x^2: Var g <= C E g'^2.
    for distribution in [
        Distribution::uniform(-1.0, 2.0),
        Distribution::triangular(0.0, 0.3, 1.0),
        Distribution::normal(0.5, 1.5),
        Distribution::truncated_normal(0.0, 1.0, 0.5, 3.0),
        Distribution::exponential(1.0, 0.0),
    ] {
        let distribution = distribution.unwrap();
        let c = poincare_constant(&distribution).unwrap();
        let n = 100_000;
        let x: Vec<f64> = (0..n).map(|k| distribution.quantile((f64::from(k) + 0.5) / f64::from(n))).collect();
        let variance = |g: &[f64]| {
            let middle = mean(g);
            mean(&g.iter().map(|x| (x - middle).powi(2)).collect::<Vec<_>>())
        };
        let squares: Vec<f64> = x.iter().map(|x| x * x).collect();
        assert!(variance(&x[..]) <= c * 1.000_001, "{distribution:?}");
        assert!(variance(&squares) <= 4.0 * c * mean(&squares) * 1.000_001, "{distribution:?}");
    }
}

#[test]
fn a_step_between_the_base_points_marks_no_factor_as_fixable() {
    // x2 has a total index of 0.98, from a step that no difference of 0.001 contains.
    let step = |x: &[f64]| x[0] + 2.0 * libm::tanh(2000.0 * (x[1] - 0.3));
    let settings = ScreeningSettings {
        design: ScreeningDesign::Derivative { sampler: Sampler::Sobol },
        trajectories: 128,
        seed: 0,
    };
    let screening = |f: fn(&[f64]) -> f64| {
        let (space, model) = (space(&[uniform(0.0, 1.0), uniform(0.0, 1.0)]), function_model("y", f));
        screen(ScreeningJob { space: &space, model: &model, settings }, 0, &|_| ()).unwrap().outputs.remove(0)
    };
    let found = screening(step);
    assert_eq!(found.warnings.len(), 1, "{:?}", found.warnings);
    assert!(found.factors.iter().all(|factor| factor.could_be_fixed.is_none()));
    let smooth = screening(|x| x[0] + 1e-3 * x[1]);
    assert!(smooth.warnings.is_empty() && smooth.factors[1].could_be_fixed == Some(true));
}

#[test]
fn separate_values_have_no_derivative() {
    let factors = [uniform(0.0, 1.0), Distribution::discrete(&[1.0, 2.0], None).unwrap()];
    let error = screened(&factors, Sampler::Sobol, 16, 0, |x| x[0]).unwrap_err();
    assert!(matches!(&error, ScreeningError::Separate { factor } if factor == "x2"), "{error}");
}
