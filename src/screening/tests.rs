use crate::screening::ScreeningSettings;
use std::collections::BTreeSet;

use proptest::prelude::*;

use super::points::Trajectories;
use super::*;
use crate::design::{DesignError, Sampler};
use crate::model::{Batch, Output, RowFailure, RunContext, Worker};
use crate::space::{Distribution, Factor, IndicesOf};
use apportion_base::quantity::Unit;

/// A closure as a model of one output; a row without an answer fails.
struct Function<F> {
    outputs: [Output; 1],
    f: F,
}

fn function<F: Fn(&[f64]) -> Option<f64> + Send + Sync>(f: F) -> Function<F> {
    Function { outputs: [Output { name: "y".into(), unit: Unit::dimensionless(), description: "".into() }], f }
}

impl<F: Fn(&[f64]) -> Option<f64> + Send + Sync> Model for Function<F> {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(Calls(&self.f))
    }
}

struct Calls<'a, F>(&'a F);

impl<F: Fn(&[f64]) -> Option<f64> + Send + Sync> Worker for Calls<'_, F> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for row in 0..batch.rows() {
            let x: Vec<f64> = inputs.iter().map(|column| column[row]).collect();
            match (self.0)(&x) {
                Some(y) => batch.set(row, 0, y),
                None => batch.fail(row, 0, RowFailure::new("no answer")),
            }
        }
    }
}

fn factor(number: usize, distribution: Distribution) -> Factor {
    Factor::new(&format!("x{number}"), Unit::dimensionless(), distribution).unwrap()
}

fn space(distributions: impl IntoIterator<Item = Distribution>) -> Space {
    Space::new(distributions.into_iter().enumerate().map(|(number, law)| factor(number, law)).collect())
}

fn uniform(low: f64, high: f64) -> Distribution {
    Distribution::uniform(low, high).unwrap()
}

fn unit_cube(factors: usize) -> Space {
    space((0..factors).map(|_| uniform(0.0, 1.0)))
}

fn factors_of(space: &Space) -> Vec<Group> {
    stepping(space, space.members(IndicesOf::Factors))
}

fn settings(design: ScreeningDesign, trajectories: u64) -> ScreeningSettings {
    ScreeningSettings { design, trajectories, seed: 0 }
}

const SOBOL: ScreeningDesign = ScreeningDesign::Radial { sampler: Sampler::Sobol };
const RANDOM: ScreeningDesign = ScreeningDesign::Radial { sampler: Sampler::Random };
const LATIN: ScreeningDesign = ScreeningDesign::Radial { sampler: Sampler::LatinHypercube };
const WALK: ScreeningDesign = ScreeningDesign::Trajectory { levels: 4 };
const DESIGNS: [ScreeningDesign; 4] = [SOBOL, RANDOM, LATIN, WALK];

fn screened<F: Fn(&[f64]) -> Option<f64> + Send + Sync>(space: &Space, settings: ScreeningSettings, f: F) -> Screening {
    screen_by(&TableRun::new(&function(f), &RunContext::default(), 0), space, factors_of(space), settings).unwrap()
}

/// The measures of a factor that has them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Measures {
    mu: Estimate,
    mu_star: Estimate,
    sigma: Estimate,
    ratio: Option<Estimate>,
}

fn measures_of(factor: &ScreenedFactor) -> Option<Measures> {
    let &ScreenedFactor { mu, mu_star, sigma, ratio, .. } = factor;
    Some(Measures { mu: mu?, mu_star: mu_star?, sigma: sigma?, ratio })
}

fn measured(screening: &Screening) -> Vec<Measures> {
    screening.outputs[0].factors.iter().map(|factor| measures_of(factor).unwrap()).collect()
}

#[test]
fn a_linear_function_has_its_slopes_and_no_spread() {
    let slopes = [3.0, -2.0, 0.5, 0.0];
    let space = space([uniform(0.0, 1.0), uniform(-4.0, 6.0), uniform(1e-9, 3e-9), uniform(0.0, 1.0)]);
    for design in DESIGNS {
        let screening =
            screened(&space, settings(design, 16), |x| Some(x.iter().zip(slopes).map(|(x, c)| x * c).sum()));
        for (m, expected) in measured(&screening).iter().zip([3.0, -20.0, 1e-9, 0.0]) {
            // The output's own rounding, 20 eps, over the shortest step.
            let rounding = 20.0 * f64::EPSILON / ScreeningSettings::MIN_STEP;
            assert!((m.mu.estimate - expected).abs() <= rounding, "{design:?}: {m:?}");
            assert!((m.mu_star.estimate - expected.abs()).abs() <= rounding && m.sigma.estimate <= rounding);
        }
        assert_eq!(ranks(&screening), [2, 1, 3, 4]);
        assert_eq!(screening.outputs[0].factors[1].reading, Some(Reading::Linear));
        assert_eq!(screening.outputs[0].factors[3].reading, None);
        let fixable: Vec<_> = screening.outputs[0].factors.iter().map(|factor| factor.could_be_fixed).collect();
        // Fewer than 3 in 16 effects of the fourth factor are not 0, which is too many for it to be fixed.
        assert_eq!(fixable, [Some(false), Some(false), Some(true), Some(false)]);
        let idle = measured(&screening)[3].mu_star.interval.unwrap();
        assert!(idle.low == 0.0 && (idle.high / (RULE_OF_THREE / 16.0 * 23.0 / 3.0) - 1.0).abs() < 1e-6, "{idle:?}");
        let longer = screened(&space, settings(design, 64), |x| Some(x.iter().zip(slopes).map(|(x, c)| x * c).sum()));
        assert_eq!(longer.outputs[0].factors[3].could_be_fixed, Some(true));
    }
}

fn ranks(screening: &Screening) -> Vec<usize> {
    screening.outputs[0].factors.iter().map(|factor| factor.rank).collect()
}

#[test]
fn a_parabola_and_a_product_have_their_known_moments() {
    // x^2 on (0, 1): the effect is a + b, of mean 1 and, for independent a and b, variance 1/6. The part 2 h - h^2 of
    // the steps that are below h become steps of a half: 2 a on (0, 2) becomes 2 a +- 1/2 on (1/2, 3/2), the variance
    // of that part falls from 1/3 to 1/12, and the mean stays. On Morris's grid of 4 levels the effect is 2/3 or 4/3; in every
    // other walk, whose steps are of one level, it is 1/3, 1 or 5/3, of probabilities 3/8, 1/4, 3/8: variances 1/9 and 1/3.
    let moved = ScreeningSettings::MIN_STEP * (2.0 - ScreeningSettings::MIN_STEP);
    for (design, sigma, slack) in
        [(SOBOL, (1.0 / 6.0 - moved / 4.0).sqrt(), 0.005), (WALK, (2.0f64 / 9.0).sqrt(), 0.01)]
    {
        let screening = screened(&unit_cube(1), settings(design, 4096), |x| Some(x[0] * x[0]));
        let m = measured(&screening)[0];
        // Standard error 0.4/sqrt(4096) = 0.006 for independent points.
        assert!((m.mu.estimate - 1.0).abs() < 0.02 && m.mu.estimate == m.mu_star.estimate, "{m:?}");
        assert!((m.sigma.estimate - sigma).abs() < slack, "{m:?}");
    }
    // x y on (-1, 1)^2: the effect of x is 2 y: mean 0, mean size 1, standard deviation 2/sqrt(3).
    let space = space([uniform(-1.0, 1.0), uniform(-1.0, 1.0)]);
    for design in [SOBOL, RANDOM, LATIN] {
        for m in measured(&screened(&space, settings(design, 4096), |x| Some(x[0] * x[1]))) {
            // Standard errors 1.15/64 and 0.58/64 for independent points; three of them.
            assert!(m.mu.estimate.abs() < 0.06 && (m.mu_star.estimate - 1.0).abs() < 0.03, "{m:?}");
            assert!((m.sigma.estimate - 2.0 / 3f64.sqrt()).abs() < 0.03, "{m:?}");
            assert_eq!(Reading::from_ratio(m.ratio.unwrap().estimate), Reading::NonLinearOrInteracting);
        }
    }
}

/// The function of Morris 1991, section 4, with (-1)^i and (-1)^(i + j) where it has normal random coefficients (as in
/// the R package `sensitivity`).
fn morris_1991(x: &[f64]) -> f64 {
    let w: Vec<f64> = (1..=20)
        .map(|i| match i {
            3 | 5 | 7 => 2.0 * (1.1 * x[i - 1] / (x[i - 1] + 0.1) - 0.5),
            _ => 2.0 * (x[i - 1] - 0.5),
        })
        .collect();
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut y = 0.0;
    for i in 1..=20 {
        y += w[i - 1] * if i <= 10 { 20.0 } else { sign(i) };
        for j in i + 1..=20 {
            y += w[i - 1] * w[j - 1] * if j <= 6 { -15.0 } else { sign(i + j) };
            for l in j + 1..=5 {
                y -= 10.0 * w[i - 1] * w[j - 1] * w[l - 1];
                for s in l + 1..=4 {
                    y += 5.0 * w[i - 1] * w[j - 1] * w[l - 1] * w[s - 1];
                }
            }
        }
    }
    y
}

#[test]
fn the_picture_of_morris_1991_is_what_he_shows() {
    for design in DESIGNS {
        let screening = screened(&unit_cube(20), settings(design, 64), |x| Some(morris_1991(x)));
        assert_eq!(screening.runs, 64 * 21);
        let m = measured(&screening);
        let least = m[..10].iter().map(|m| m.mu_star.estimate).fold(f64::INFINITY, f64::min);
        let rest = m[10..].iter().map(|m| m.mu_star.estimate).fold(0.0, f64::max);
        assert!(least > 3.0 * rest, "{design:?}: {least} {rest}");
        let ratio = |j: usize| m[j - 1].ratio.unwrap().estimate;
        for j in 1..=7 {
            assert!(ratio(j) > 0.3, "{design:?}: x{j} is curved or interacts: {}", ratio(j));
        }
        // The effects of x8 to x10 are 2 (20 + sum of +-w), where only w3, w5 and w7 have a mean, and the 19 variances
        // are at most 1/3: a ratio up to 2 sqrt(19/3)/36 = 0.14. The steps of the walk on its four levels see other
        // means of w3, w5 and w7.
        let w = 2.0 * (1.1 * (1.0 - 0.1 * libm::log(11f64)) - 0.5);
        for (j, expected) in [(8, 40.0 - 6.0 * w), (9, 40.0 + 6.0 * w), (10, 40.0 - 6.0 * w)] {
            assert!(ratio(j) < 0.2, "{design:?}: x{j} is nearly linear: {}", ratio(j));
            let slack = if design == WALK { 4.0 } else { 2.0 };
            assert!((m[j - 1].mu.estimate - expected).abs() < slack, "{design:?}: x{j}: {:?}", m[j - 1].mu);
        }
    }
}

#[test]
fn steps_are_never_tiny_and_points_never_at_the_ends() {
    let space = unit_cube(7);
    for design in [SOBOL, RANDOM, LATIN] {
        let (settings, parts) = settings(design, 512).in_force(7).unwrap();
        let points = Trajectories::new(&space, factors_of(&space), &settings, parts).unwrap();
        for number in 0..512 {
            for m in points.moves(number) {
                assert!((m.u[1] - m.u[0]).abs() >= ScreeningSettings::MIN_STEP && m.step == m.u[1] - m.u[0], "{m:?}");
                assert!(m.u.iter().all(|u| *u > 0.0 && *u < 1.0));
            }
        }
    }
}

#[test]
fn a_walk_visits_all_levels_and_orders() {
    let (settings, parts) = settings(WALK, 600).in_force(3).unwrap();
    let space = unit_cube(3);
    let points = Trajectories::new(&space, factors_of(&space), &settings, parts).unwrap();
    let (mut orders, mut starts) = (BTreeSet::new(), [0; 4]);
    for number in 0..settings.trajectories {
        let moves = points.moves(number);
        orders.insert(moves.iter().map(|m| m.before).collect::<Vec<_>>());
        starts[(moves[0].u[0] * 3.0).round() as usize] += 1;
        let step = if number % 2 == 0 { 2.0 / 3.0 } else { 1.0 / 3.0 };
        assert!(moves.iter().all(|m| (m.step.abs() - step).abs() < 1e-15));
    }
    assert_eq!(orders.len(), 6);
    // A quarter of some 600 each, standard deviation 11.
    assert!(starts.iter().all(|&count| (100..220).contains(&count)), "{starts:?}");
}

#[test]
fn discrete_factors_step_by_rank_and_constants_do_not_step() {
    let two = Distribution::discrete(&[5.0, 1.0], Some(&[1.0, 99.0])).unwrap();
    let three = Distribution::discrete(&[0.0, 1.0, 2.0, 1.0, 7.0], Some(&[1.0, 1.0, 1.0, 1.0, 0.0])).unwrap();
    let space =
        space([two, three, Distribution::constant(3.0).unwrap(), Distribution::discrete(&[2.0], None).unwrap()]);
    for design in DESIGNS {
        let screening = screened(&space, settings(design, 32), |x| Some(x[0] - 3.0 * x[1] + x[2] + x[3]));
        let m = measured(&screening);
        let found: Vec<f64> = m.iter().map(|m| m.mu.estimate).collect();
        assert_eq!(found, [4.0, -6.0, 0.0], "{design:?}");
        assert!(m.iter().all(|m| m.sigma.estimate == 0.0));
        let idle: Vec<u64> = screening.outputs[0].factors.iter().map(|factor| factor.idle_steps).collect();
        assert_eq!((screening.runs, idle), (32 * 4, vec![0, 0, 32]));
    }
}

/// Of a + 2 b - c - 3 d with the group of a and c, which step at once, by different parts of their ranges in radial points.
#[test]
fn a_group_steps_at_once_and_has_the_mean_of_its_sizes() {
    let mut factors: Vec<Factor> = unit_cube(4).factors().to_vec();
    factors.iter_mut().step_by(2).for_each(|factor| factor.group = Some("g".to_owned()));
    let space = Space::new(factors);
    let movers = stepping(&space, space.members(IndicesOf::Groups));
    let model = function(|x| Some(x[0] + 2.0 * x[1] - x[2] - 3.0 * x[3]));
    for design in DESIGNS {
        let context = RunContext::default();
        let screening =
            screen_by(&TableRun::new(&model, &context, 0), &space, movers.clone(), settings(design, 4096)).unwrap();
        assert_eq!(screening.runs, 4096 * 4);
        let [group, b, d] = &screening.outputs[0].factors[..] else { panic!("three of them") };
        assert_eq!((&*group.factor, &*b.factor, &*d.factor), ("g", "x1", "x3"));
        assert!(group.mu.is_none() && group.sigma.is_none() && group.reading.is_none());
        let estimates = [b, d].map(|factor| factor.mu.unwrap().estimate);
        assert!((estimates[0] - 2.0).abs() < 1e-12 && (estimates[1] + 3.0).abs() < 1e-12);
        // Two steps of equal size in either direction: 0 or 2. Of independent steps s and t, |s - t|/sqrt((s^2 + t^2)/2).
        let mean = group.mu_star.unwrap().estimate;
        assert!((mean - if design == WALK { 1.0 } else { 1.273 }).abs() < 0.05, "{design:?}: {mean}");
    }
}

#[test]
fn an_output_of_the_period_of_the_step_is_not_fixed() {
    for levels in [4, 6, 8, 10, 20, 100] {
        let step = f64::from(levels / 2) / f64::from(levels - 1);
        let design = ScreeningDesign::Trajectory { levels };
        let space = unit_cube(2);
        let screening = screened(&space, settings(design, 32), |x| {
            Some(libm::sin(2.0 * std::f64::consts::PI * (x[0] / step + 0.1)) + x[1])
        });
        assert_eq!(screening.outputs[0].factors[0].could_be_fixed, Some(false), "{levels} levels");
    }
}

#[test]
fn levels_are_met_as_often_as_they_are_likely() {
    // Of two different levels drawn by their probabilities p, one is the third with probability p3 + p1 p3/(1 - p1) + p2 p3/(1 - p2).
    let law = Distribution::discrete(&[0.0, 1.0, 2.0], Some(&[0.499, 0.499, 0.002])).unwrap();
    let expected = 0.002 * (1.0 + 2.0 * 0.499 / 0.501);
    for design in [SOBOL, RANDOM, WALK] {
        let (settings, parts) = settings(design, 1 << 14).in_force(1).unwrap();
        let space = space([law.clone()]);
        let points = Trajectories::new(&space, factors_of(&space), &settings, parts).unwrap();
        let is_rare = |number: &u64| points.moves(*number)[0].u.iter().any(|u| *u > 0.998);
        let found = (0..settings.trajectories).filter(is_rare).count() as f64 / settings.trajectories as f64;
        // Standard error 6e-4 for independent draws.
        assert!((found - expected).abs() < 2e-3, "{design:?}: {found} for {expected}");
        let steps = (0..64).map(|number| points.moves(number)[0]);
        assert!(steps.into_iter().all(|m| m.u[0] != m.u[1] && m.step != 0.0));
    }
}

#[test]
fn unbounded_factors_stay_finite_on_a_grid() {
    let space = space([Distribution::normal(0.0, 1.0).unwrap(), Distribution::log_normal(1.0, 0.5).unwrap()]);
    for design in DESIGNS {
        let m = measured(&screened(&space, settings(design, 32), |x| Some(x[0] + x[1])));
        assert!(m.iter().all(|m| m.mu.estimate > 0.0 && m.sigma.estimate.is_finite()), "{design:?}: {m:?}");
    }
}

#[test]
fn failed_runs_drop_their_effects_and_are_counted() {
    let space = unit_cube(3);
    for design in DESIGNS {
        let settings = settings(design, 64);
        let answer = |x: &[f64]| if x[1] > 0.7 { None } else { Some(x[0] + 2.0 * x[1]) };
        let screening = screened(&space, settings, answer);
        let output = &screening.outputs[0];
        let (in_force, parts) = settings.in_force(3).unwrap();
        let points = Trajectories::new(&space, factors_of(&space), &in_force, parts).unwrap();
        let (mut failed, mut dropped) = (0, [0; 3]);
        for number in 0..in_force.trajectories {
            let moves = points.moves(number);
            let mut rows = vec![vec![0.0; 4]; 3];
            for (column, m) in rows.iter_mut().zip(&moves) {
                points.fill(m, m.u, column);
            }
            failed += rows[1].iter().filter(|&&u| u > 0.7).count() as u64;
            for (count, m) in dropped.iter_mut().zip(&moves) {
                *count += u64::from([m.before, m.after].iter().any(|&row| rows[1][row] > 0.7));
            }
        }
        assert!(failed > 0);
        assert_eq!(output.factors.iter().map(|factor| factor.dropped).collect::<Vec<_>>(), dropped);
        assert!(output.factors.iter().all(|factor| factor.effects + factor.dropped == 64));
        assert_eq!((screening.failed, output.failures.len(), output.failures[0].runs), (failed, 1, failed));
        assert!(output.failures[0].first_inputs.values().nth(1).and_then(serde_json::Value::as_f64).unwrap() > 0.7);
        for (factor, slope) in output.factors.iter().zip([1.0, 2.0, 0.0]) {
            assert!((factor.mu.unwrap().estimate - slope).abs() < 1e-13);
        }
    }
    let nothing = screened(&space, settings(SOBOL, 16), |_| None);
    for factor in &nothing.outputs[0].factors {
        assert_eq!((factor.effects, measures_of(factor), factor.could_be_fixed), (0, None, None));
    }
}

#[test]
fn no_factor_of_a_constant_output_is_kept_or_fixed() {
    for factor in &screened(&unit_cube(2), settings(SOBOL, 16), |_| Some(1e300)).outputs[0].factors {
        let m = measures_of(factor).unwrap();
        assert_eq!((m.mu_star.estimate, m.sigma.estimate, m.ratio), (0.0, 0.0, None));
        assert_eq!((factor.reading, factor.could_be_fixed), (None, None));
    }
}

#[test]
fn effects_beyond_double_precision_give_no_measures() {
    let jump = |x: &[f64]| Some(if x[0] < 0.5 { -1e308 } else { 1e308 });
    for factor in &screened(&unit_cube(2), settings(WALK, 16), jump).outputs[0].factors {
        assert!(factor.mu_star.is_none_or(|mu_star| mu_star.estimate == 0.0), "{factor:?}");
    }
}

#[test]
fn a_thousand_factors_are_screened() {
    let space = unit_cube(1000);
    for design in DESIGNS {
        let settings = settings(design, 4);
        let screening = screened(&space, settings, |x| Some(x.iter().zip(0..).map(|(x, j)| x * f64::from(j)).sum()));
        assert_eq!(screening.runs, 4 * 1001);
        for (j, factor) in screening.outputs[0].factors.iter().enumerate() {
            // The output is near 2.5e5 and known to 1e3 roundings of it, over a step of 0.02 at least.
            assert!((factor.mu_star.unwrap().estimate - j as f64).abs() < 1e-5);
            assert_eq!(factor.rank, 1000 - j);
        }
    }
}

#[test]
fn the_result_is_the_same_on_any_number_of_threads() {
    let model = function(|x| if x[0] > 0.9 { None } else { Some(morris_1991(x)) });
    let space = unit_cube(20);
    for design in DESIGNS {
        let [one, two, five] = [1, 2, 5].map(|threads| {
            let context = RunContext::default();
            screen_by(&TableRun::new(&model, &context, threads), &space, factors_of(&space), settings(design, 256))
                .unwrap()
        });
        assert!(one == two && one == five);
    }
}

#[test]
fn intervals_of_mu_star_are_honest() {
    // x y: mu* = 1 exactly, for both. A 95 % interval covers it in 380 of 400 cases, standard deviation 4.4 if they
    // were independent; the two factors are not, and 32 effects are few for Student's t.
    let space = space([uniform(-1.0, 1.0), uniform(-1.0, 1.0)]);
    for design in [SOBOL, RANDOM, LATIN] {
        let covered = (0..200)
            .flat_map(|seed| {
                let settings = ScreeningSettings { design, trajectories: 32, seed };
                measured(&screened(&space, settings, |x| Some(x[0] * x[1])))
            })
            .filter(|m| m.mu_star.interval.is_some_and(|i| i.low <= 1.0 && 1.0 <= i.high))
            .count();
        assert!((360..=396).contains(&covered), "{design:?}: {covered} of 400");
    }
}

#[test]
fn settings_are_checked_and_rounded() {
    let rounded = |design, trajectories| {
        let (settings, parts) = settings(design, trajectories).in_force(3).unwrap();
        (settings.trajectories, parts)
    };
    assert_eq!(rounded(SOBOL, 4), (4, 2));
    assert_eq!(rounded(SOBOL, 33), (40, 8));
    assert_eq!(rounded(RANDOM, 33), (33, 33));
    assert_eq!(rounded(WALK, 100), (128, 64));
    let refused = |design, trajectories, factors| settings(design, trajectories).in_force(factors).unwrap_err();
    assert!(matches!(refused(SOBOL, 3, 1), ScreeningError::TooFewTrajectories { trajectories: 3 }));
    assert!(matches!(refused(SOBOL, u64::MAX, 3), ScreeningError::TooManyRuns { factors: 3, .. }));
    for levels in [0, 1, 3, ScreeningSettings::MAX_LEVELS + 2] {
        let error = refused(ScreeningDesign::Trajectory { levels }, 8, 1);
        assert!(matches!(error, ScreeningError::Levels { levels: given } if given == levels), "{error}");
    }
    let model = function(|_| Some(0.0));
    let space = unit_cube(3000);
    let context = RunContext::default();
    let error =
        screen_by(&TableRun::new(&model, &context, 1), &space, factors_of(&space), ScreeningSettings::default())
            .unwrap_err();
    assert!(matches!(error, ScreeningError::Design(DesignError::TooManyFactors { factors: 3000 })), "{error}");
}

proptest! {
    #[test]
    fn measures_scale_with_the_output_and_forget_an_offset(
        effects in prop::collection::vec(-10.0..10.0f64, 16), exponent in -280i32..280,
    ) {
        let scale = 2f64.powi(exponent);
        let scaled: Vec<f64> = effects.iter().map(|effect| effect * scale).collect();
        let [m, s] = [&effects, &scaled].map(|effects| measures::measures(effects, 8).unwrap().map(|of| of.estimate));
        // A power of two scales every step of the sums without rounding; only sigma is computed again.
        prop_assert_eq!((s[0], s[1]), (m[0] * scale, m[1] * scale));
        prop_assert!((s[2] / (m[2] * scale) - 1.0).abs() < 1e-14);
        prop_assert!(m[0].abs() <= m[1] * (1.0 + 1e-15));
        prop_assert_eq!(s[3], m[3]);
    }
}
