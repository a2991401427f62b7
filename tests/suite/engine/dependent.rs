//! Factors that depend on each other: indices against closed forms.

use ::apportion::{
    AnalysisOptions, CorrelationMeasure, Dependence, Distribution, EffectEstimates, Estimate, Study, function_model,
};
use statrs::distribution::{ContinuousCDF, Normal};

use crate::common::{effects, study_path};

/// Normal factors with standard deviations `sd` and correlations `r`, and the output sum b x.
pub struct Linear {
    pub b: Vec<f64>,
    pub sd: Vec<f64>,
    pub r: Vec<Vec<f64>>,
}

/// A correlation matrix from the numbers above its diagonal.
pub fn correlations(n: usize, upper: &[f64]) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![1.0; n]; n];
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
    for ((i, j), r) in pairs.zip(upper) {
        (matrix[i][j], matrix[j][i]) = (*r, *r);
    }
    matrix
}

impl Linear {
    fn covariance(&self, i: usize, j: usize) -> f64 {
        self.r[i][j] * self.sd[i] * self.sd[j]
    }

    /// Var(sum over `of` of b x | the factors `given`), by sweeping these out of the covariance matrix (Gaussian elimination).
    fn variance_given(&self, of: &[usize], given: &[usize]) -> f64 {
        let n = self.b.len();
        let mut s: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| self.covariance(i, j)).collect()).collect();
        for &k in given {
            let (row, pivot) = (s[k].clone(), s[k][k]);
            for i in (0..n).filter(|i| *i != k) {
                let factor = s[i][k] / pivot;
                (0..n).for_each(|j| s[i][j] -= factor * row[j]);
            }
            // What is known does not vary.
            (0..n).for_each(|j| {
                (s[k][j], s[j][k]) = (if j == k { pivot } else { 0.0 }, if j == k { pivot } else { 0.0 })
            });
        }
        of.iter().flat_map(|&i| of.iter().map(move |&j| (i, j))).map(|(i, j)| self.b[i] * self.b[j] * s[i][j]).sum()
    }

    pub fn all(&self) -> Vec<usize> {
        (0..self.b.len()).collect()
    }

    fn without(&self, set: &[usize]) -> Vec<usize> {
        self.all().into_iter().filter(|j| !set.contains(j)).collect()
    }

    fn variance(&self) -> f64 {
        self.variance_given(&self.all(), &[])
    }

    /// Var E(Y | X_u)/V.
    fn first_order(&self, u: &[usize]) -> f64 {
        1.0 - self.variance_given(&self.without(u), u) / self.variance()
    }

    /// E Var(Y | all but X_u)/V.
    pub fn total(&self, u: &[usize]) -> f64 {
        self.variance_given(u, &self.without(u)) / self.variance()
    }

    /// The mean of E Var(Y | all but u and i) - E Var(Y | all but u) over all orders, by brute force.
    fn shapley(&self, i: usize) -> f64 {
        let mut orders = vec![Vec::new()];
        for k in self.all() {
            orders = orders
                .into_iter()
                .flat_map(|order: Vec<usize>| {
                    (0..=order.len()).map(move |place| {
                        let mut longer = order.clone();
                        longer.insert(place, k);
                        longer
                    })
                })
                .collect();
        }
        let adds = |order: &Vec<usize>| {
            let place = order.iter().position(|k| *k == i).unwrap();
            self.total(&order[..=place]) - if place == 0 { 0.0 } else { self.total(&order[..place]) }
        };
        orders.iter().map(adds).sum::<f64>() / orders.len() as f64
    }

    fn study(&self, base_samples: u64, seed: u64) -> Study {
        let options =
            AnalysisOptions { shapley: Some(true), ..AnalysisOptions::for_sampler(::apportion::Sampler::Sobol) };
        self.study_with(base_samples, seed, options)
    }

    pub fn study_with(&self, base_samples: u64, seed: u64, options: AnalysisOptions) -> Study {
        let b = self.b.clone();
        let names: Vec<String> = self.all().into_iter().map(|j| format!("x{}", j + 1)).collect();
        let model = function_model("y", move |x: &[f64]| x.iter().zip(&b).map(|(x, b)| b * x).sum());
        let mut builder = Study::builder("linear", model).base_samples(base_samples).seed(seed);
        for (name, sd) in names.iter().zip(&self.sd) {
            builder = builder.factor(name, Distribution::normal(3.0, *sd).unwrap());
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        builder.dependence(Dependence::new(&names, self.r.clone())).analysis(options).build().unwrap()
    }
}

pub fn cases() -> [Linear; 3] {
    [
        Linear { b: vec![2.0, 1.0], sd: vec![1.0, 2.0], r: correlations(2, &[0.6]) },
        // Iooss and Prieur (2019), Int. J. Uncertain. Quantif. 9, 493-514, section 3: only two of the three are correlated.
        Linear { b: vec![1.0, 1.0, 1.0], sd: vec![1.0, 1.0, 2.0], r: correlations(3, &[0.0, 0.0, -0.8]) },
        Linear {
            b: vec![1.0, -2.0, 0.5, 0.0, 1.5],
            sd: vec![1.0, 1.0, 3.0, 1.0, 0.5],
            r: correlations(5, &[0.5, 0.0, 0.3, 0.0, 0.0, -0.4, 0.0, 0.2, 0.0, 0.6]),
        },
    ]
}

/// First order, total, first order given the others, total with the others, Shapley effect.
fn numbers(effect: &EffectEstimates) -> [Estimate; 5] {
    let dependent = effect.dependent.unwrap();
    let shapley = effect.shapley.unwrap();
    [effect.first_order, effect.total, dependent.independent_first_order, dependent.full_total, shapley]
}

fn exact(case: &Linear, i: usize) -> [f64; 5] {
    // A linear output of normal factors has no interactions: alone or not is the same within a swap.
    let (first, total) = (case.first_order(&[i]), case.total(&[i]));
    [first, total, total, first, case.shapley(i)]
}

#[test]
fn linear_outputs_of_correlated_normal_factors_have_closed_forms() {
    for case in cases() {
        let study = case.study(1 << 12, 1);
        let analysis = study.run().unwrap();
        let output = analysis.output("y").unwrap();
        let mut sum = 0.0;
        for i in case.all() {
            let effect = output.factor(&format!("x{}", i + 1)).unwrap();
            for (found, exact) in numbers(effect).iter().zip(exact(&case, i)) {
                assert!((found.estimate - exact).abs() < 6e-3, "x{}: {found:?}, {exact}", i + 1);
            }
            sum += effect.shapley.unwrap().estimate;
            assert!(effect.share_total.is_none() && effect.share_first_order.is_none());
        }
        assert!((sum - 1.0).abs() < 1e-12, "Shapley effects share out all of the variance: {sum}");
    }
}

/// Of a product of correlated factors nothing is linear; the Shapley effects by Owen and Prieur (2017), section 5, are the same for
/// both by symmetry.
#[test]
fn symmetric_models_have_symmetric_indices() {
    let pair = |r: f64| {
        let study = Study::builder("product", function_model("y", |x: &[f64]| x[0] * x[1]))
            .factor("a", Distribution::normal(0.0, 1.0).unwrap())
            .factor("b", Distribution::normal(0.0, 1.0).unwrap())
            .dependence(Dependence::pair("a", "b", r))
            .base_samples(1 << 13);
        let analysis = study.build().unwrap().run().unwrap();
        let output = analysis.output("y").unwrap();
        ["a", "b"].map(|name| numbers(output.factor(name).unwrap()).map(|estimate| estimate.estimate))
    };
    for r in [0.0, 0.5, -0.9] {
        let [a, b] = pair(r);
        // Var E(Y | a) = r^2 Var(a^2) = 2 r^2, E Var(Y | b) = (1 - r^2) E b^2, V = 1 + r^2.
        let (v, first, total) = (1.0 + r * r, 2.0 * r * r, 1.0 - r * r);
        for found in [a, b] {
            assert!((found[0] - first / v).abs() < 0.03 && (found[1] - total / v).abs() < 0.03, "{r}: {found:?}");
            assert!((found[4] - 0.5).abs() < 0.03, "{r}: {found:?}");
        }
    }
}

/// With correlations of 0 everything is as without them; an uncorrelated factor keeps its indices.
#[test]
fn independent_factors_are_a_special_case() {
    let ishigami = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
    let study = |dependence: Option<Dependence>, shapley: bool| {
        let options = AnalysisOptions {
            shapley: Some(shapley),
            surrogate: ::apportion::SurrogateChoice::Off,
            ..AnalysisOptions::for_sampler(::apportion::Sampler::Sobol)
        };
        let pi = std::f64::consts::PI;
        let mut builder =
            Study::builder("ishigami", function_model("y", ishigami)).base_samples(1 << 12).analysis(options);
        for name in ["x1", "x2", "x3"] {
            builder = builder.factor(name, Distribution::uniform(-pi, pi).unwrap());
        }
        if let Some(dependence) = dependence {
            builder = builder.dependence(dependence);
        }
        builder.build().unwrap().run().unwrap()
    };
    let plain = study(None, false);
    let zero = study(Some(Dependence::pair("x1", "x3", 0.0)), true);
    let pairs = effects(plain.output("y").unwrap());
    let zero = effects(zero.output("y").unwrap());
    for (plain, zero) in pairs.iter().zip(&zero) {
        // Their intervals depend on the other indices in the result.
        let estimates = |effect: &EffectEstimates| [effect.first_order.estimate, effect.total.estimate];
        assert_eq!(estimates(plain), estimates(zero));
        let dependent = zero.dependent.unwrap();
        assert_eq!((dependent.independent_first_order, dependent.full_total), (zero.first_order, zero.total));
    }
    // Exact Shapley effects: S1 + S13/2, S2, S13/2.
    let (s1, s2, s13) = (0.313_905, 0.442_411, 0.243_684);
    for (found, exact) in zero.iter().zip([s1 + s13 / 2.0, s2, s13 / 2.0]) {
        assert!((found.shapley.unwrap().estimate - exact).abs() < 0.01, "{:?} {exact}", found.shapley);
    }
}

/// Ishigami's function with x1 and x3 correlated (Kucherenko et al. 2012, test 3), by a midpoint rule over both normal scores.
#[test]
fn ishigami_with_correlated_factors_has_the_indices_of_quadrature() {
    let pi = std::f64::consts::PI;
    let model =
        function_model("y", |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin());
    let r: f64 = 0.7;
    let options = AnalysisOptions { shapley: Some(true), ..AnalysisOptions::for_sampler(::apportion::Sampler::Sobol) };
    let study = ["x1", "x2", "x3"]
        .iter()
        .fold(Study::builder("ishigami", model).base_samples(1 << 14).analysis(options), |builder, name| {
            builder.factor(name, Distribution::uniform(-pi, pi).unwrap())
        })
        .dependence(Dependence::pair("x1", "x3", r).measure(CorrelationMeasure::Normal))
        .build()
        .unwrap();
    let analysis = study.run().unwrap();
    let cells = 400;
    let score = |k: usize| 16.0 * (k as f64 + 0.5) / f64::from(cells as u32) - 8.0;
    let value = |z: f64| pi * (2.0 * Normal::standard().cdf(z) - 1.0);
    let nodes: Vec<(f64, f64)> = (0..cells).map(|k| (score(k), (-0.5 * score(k).powi(2)).exp())).collect();
    let sum: f64 = nodes.iter().map(|(_, weight)| weight).sum();
    let mean = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|(z, weight)| weight * f(*z)).sum::<f64>() / sum;
    // Of a function of one factor given the score of the other one.
    let given = |f: &dyn Fn(f64) -> f64, z: f64| mean(&|e| f(value(r * z + (1.0 - r * r).sqrt() * e)));
    let (sine, bend) = (|x: f64| x.sin(), |x: f64| 1.0 + 0.1 * x.powi(4));
    let of_x1 = mean(&|z| (sine(value(z)) * given(&bend, z)).powi(2));
    let of_x3 = mean(&|z| (given(&sine, z) * bend(value(z))).powi(2));
    let product = mean(&|z| given(&|x| bend(x).powi(2), z) * sine(value(z)).powi(2));
    // The mean of the product is 0, since the sine is odd.
    let (of_x2, variance) = (49.0 / 8.0, product + 49.0 / 8.0);
    let exact = [
        ("x1", of_x1, product - of_x3, 0.5 * (of_x1 + product - of_x3)),
        ("x2", of_x2, of_x2, of_x2),
        ("x3", of_x3, product - of_x1, 0.5 * (of_x3 + product - of_x1)),
    ];
    for (name, first, total, shapley) in exact {
        let effect = analysis.output("y").unwrap().factor(name).unwrap();
        let found = [effect.first_order, effect.total, effect.shapley.unwrap()];
        for (found, exact) in found.iter().zip([first, total, shapley]) {
            assert!((found.estimate - exact / variance).abs() < 5e-3, "{name}: {found:?} {}", exact / variance);
        }
    }
    let tied = analysis.output("y").unwrap().factor("x2").unwrap();
    assert_eq!(tied.total, tied.dependent.unwrap().full_total);
}

/// 95 % intervals contain the exact value in 92 to 98 % of the seeds: `cargo test --release -- --ignored intervals_of_dependent` prints the
/// table; few seeds here.
#[test]
fn intervals_of_dependent_factors_hold_the_truth() {
    let seeds: u64 = std::env::var("SEEDS").map_or(25, |seeds| seeds.parse().unwrap());
    for base_samples in [256, 1024] {
        let mut held = [0usize; 5];
        let mut all = 0usize;
        for case in cases() {
            for seed in 0..seeds {
                let analysis = case.study(base_samples, seed).run().unwrap();
                let output = analysis.output("y").unwrap();
                for i in case.all().into_iter().filter(|i| case.b[*i] != 0.0) {
                    let effect = output.factor(&format!("x{}", i + 1)).unwrap();
                    for (k, (found, exact)) in numbers(effect).iter().zip(exact(&case, i)).enumerate() {
                        let interval = found.interval.unwrap();
                        // An index that is 0 to rounding has an interval of that size.
                        held[k] += usize::from(interval.low - 1e-12 <= exact && exact <= interval.high + 1e-12);
                    }
                    all += 1;
                }
            }
        }
        let shares = held.map(|held| held as f64 / all as f64);
        println!("N = {base_samples}: {shares:.3?} of {all}");
        assert!(shares.iter().all(|share| *share > 0.88), "N = {base_samples}: {shares:.3?}");
    }
}

/// E Var(value | all but u)/V of the portfolio for each factor and for the proper subsets {1,2}, {1,3}, {2,3}, {1,2,3}, {1,4}, {2,4},
/// {1,2,4}, {3,4}, {1,3,4}, {2,3,4}, by the moments of two independent pairs of normal factors.
pub fn portfolio_costs() -> ([f64; 4], [f64; 10]) {
    const V: f64 = 3_033_600.0;
    let single = [1_492_400.0, 910_000.0, 582_400.0, 327_600.0];
    let proper = [V, 1_544_816.0, 1_492_400.0, V, 1_820_000.0, 939_484.0, V, 913_600.0, 1_823_600.0, 1_496_000.0];
    (single.map(|c| c / V), proper.map(|c| c / V))
}

/// Shapley effects of `members` from the costs of the sets of them, each a mask of its members.
pub fn shapley(members: usize, cost: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let factorial = |n: usize| (1..=n).product::<usize>() as f64;
    let effect = |member: usize| {
        let others = (0..1 << members).filter(|mask: &usize| mask >> member & 1 == 0);
        let weighted = others.map(|mask| {
            let size = mask.count_ones() as usize;
            let weight = factorial(size) * factorial(members - size - 1) / factorial(members);
            weight * (cost(mask | 1 << member) - cost(mask))
        });
        weighted.sum()
    };
    (0..members).map(effect).collect()
}

#[test]
fn the_portfolio_has_the_published_indices() {
    let study =
        apportion_files::load_study(&study_path("portfolio"), &["design.base_samples=65536".to_owned()]).unwrap();
    let analysis = study.run().unwrap();
    let output = analysis.output("value").unwrap();
    let first = [1_537_600.0 / 3_033_600.0, 1_210_000.0 / 3_033_600.0, 0.0, 0.0];
    let (total, proper) = portfolio_costs();
    // By masks: those of one factor, and the proper subsets in the order of their masks.
    let costs = [0.0, total[0], total[1], proper[0], total[2], proper[1], proper[2], proper[3], total[3]];
    let costs = [&costs[..], &proper[4..], &[1.0]].concat();
    let shapley = shapley(4, &|mask| costs[mask]);
    assert!((shapley.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    for (i, name) in ["x1", "x2", "x3", "x4"].into_iter().enumerate() {
        let effect = output.factor(name).unwrap();
        let found = [effect.first_order, effect.total, effect.shapley.unwrap()].map(|estimate| estimate.estimate);
        for (found, exact) in found.into_iter().zip([first[i], total[i], shapley[i]]) {
            assert!((found - exact).abs() < 0.01, "{name}: {found}, {exact}");
        }
    }
}
