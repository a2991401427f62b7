//! Factors that depend on each other as joint measurements do, by kernels: indices against quadrature, and through the program.

use crate::common::{Folder, apportion, stderr, succeed, text};
use crate::dependent::Linear;
use ::apportion::{AnalysisOptions, Dependence, Distribution, Estimate, Sampler, ShapleyMethod, Study, function_model};
use statrs::distribution::{ContinuousCDF, Normal};

/// Joint measurements of two quantities whose cloud is bent, with noise.
fn bent(rows: usize) -> Vec<Vec<f64>> {
    let noise = |k: usize, step: f64| (k as f64 * step).fract() - 0.5;
    let first = |k: usize| 2.0 * (k as f64 + 0.5) / rows as f64 - 1.0;
    vec![
        (0..rows).map(|k| first(k) + 0.3 * noise(k, 0.754_877_666)).collect(),
        (0..rows).map(|k| first(k) * first(k) + 0.4 * first(k) + 0.3 * noise(k, 0.569_840_291)).collect(),
    ]
}

fn standard() -> Normal {
    Normal::standard()
}

/// Phi^-1(rank/(n + 1)), of values without ties.
fn scores(column: &[f64]) -> Vec<f64> {
    let rank = |x: &f64| column.iter().filter(|y| *y <= x).count() as f64;
    column.iter().map(|x| standard().inverse_cdf(rank(x) / (column.len() + 1) as f64)).collect()
}

/// The numbers of two standard normal factors with this copula, by a grid over both scores and nothing that the engine has.
struct Grid {
    /// The probability of each cell, and the values of both factors there.
    cells: Vec<Vec<f64>>,
    values: [Vec<f64>; 2],
}

const CELLS: usize = 500;

impl Grid {
    fn new(columns: &[Vec<f64>], width: f64) -> Self {
        let scores = [scores(&columns[0]), scores(&columns[1])];
        let n = scores[0].len() as f64;
        let product = |i: usize, j: usize| scores[i].iter().zip(&scores[j]).map(|(a, b)| a * b).sum::<f64>();
        let r = product(0, 1) / (product(0, 0) * product(1, 1)).sqrt();
        let towards = (1.0 - width * width).sqrt();
        let place = |k: usize| 12.0 * (k as f64 + 0.5) / CELLS as f64 - 6.0;
        let value = |j: usize, k: usize| {
            let below = |score: &f64| standard().cdf((place(k) - towards * score) / width);
            standard().inverse_cdf((scores[j].iter().map(below).sum::<f64>() / n).clamp(1e-15, 1.0 - 1e-15))
        };
        let values = [0, 1].map(|j| (0..CELLS).map(|k| value(j, k)).collect::<Vec<f64>>());
        let mut cells = vec![vec![0.0; CELLS]; CELLS];
        for (a, b) in scores[0].iter().zip(&scores[1]) {
            for (i, row) in cells.iter_mut().enumerate() {
                let x = (place(i) - towards * a) / width;
                if x.abs() > 9.0 {
                    continue;
                }
                for (j, cell) in row.iter_mut().enumerate() {
                    let y = (place(j) - towards * b) / width;
                    *cell += (-(x * x - 2.0 * r * x * y + y * y) / (2.0 * (1.0 - r * r))).exp();
                }
            }
        }
        let sum: f64 = cells.iter().flatten().sum();
        cells.iter_mut().flatten().for_each(|cell| *cell /= sum);
        Self { cells, values }
    }

    /// Of the output f, for each factor: first order, total, first order given the other, total with the other, Shapley effect.
    fn numbers(&self, f: impl Fn(f64, f64) -> f64) -> [[f64; 5]; 2] {
        let value = |j: usize, k: usize| self.values[j][k];
        let of = |i: usize, j: usize| f(value(0, i), value(1, j));
        let moment = |g: &dyn Fn(f64) -> f64| -> f64 {
            (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))).map(|(i, j)| self.cells[i][j] * g(of(i, j))).sum()
        };
        let mean = moment(&|y| y);
        let variance = moment(&|y| (y - mean) * (y - mean));
        [0, 1].map(|factor| {
            // The probability and the output at the place `own` of the factor and `other` of the other one.
            let weight = |own: usize, other: usize| self.cells[[own, other][factor]][[own, other][1 - factor]];
            let output = |own: f64, other: usize| match factor {
                0 => f(own, value(1, other)),
                _ => f(value(0, other), own),
            };
            let explained = |of_line: &dyn Fn(usize) -> (f64, f64)| -> f64 {
                let lines = (0..CELLS).map(of_line).filter(|(weight, _)| *weight > 1e-300);
                lines.map(|(weight, sum)| weight * (sum / weight - mean).powi(2)).sum::<f64>() / variance
            };
            let line = |weight_of: &dyn Fn(usize) -> f64, y: &dyn Fn(usize) -> f64| {
                (0..CELLS).fold((0.0, 0.0), |(sum, moment), l| (sum + weight_of(l), moment + weight_of(l) * y(l)))
            };
            let first = explained(&|k| line(&|l| weight(k, l), &|l| output(value(factor, k), l)));
            let other = explained(&|k| line(&|l| weight(l, k), &|l| output(value(factor, l), k)));
            // What the factor has beside the other one: the place in its distribution given that one, here at its middle.
            let levels = 400;
            let (mut alone, mut with) = (0.0, 0.0);
            for level in 0..levels {
                let v = (level as f64 + 0.5) / levels as f64;
                // The mean of the output where this one has that level given the other one, and the other way round.
                let at_level =
                    |weight: &dyn Fn(usize, usize) -> f64, y: &dyn Fn(f64, usize) -> f64, values: &[f64]| -> f64 {
                        let line = |l: usize| {
                            let sum: f64 = (0..CELLS).map(|k| weight(k, l)).sum();
                            if sum < 1e-13 {
                                return 0.0;
                            }
                            let mut below = 0.0;
                            for k in 0..CELLS {
                                let next = below + weight(k, l) / sum;
                                if next >= v {
                                    // Inside this cell, whose ends lie between its value and those of its neighbours.
                                    let ends = [k.saturating_sub(1), k, (k + 1).min(CELLS - 1)].map(|k| values[k]);
                                    let (low, high) = ((ends[0] + ends[1]) / 2.0, (ends[1] + ends[2]) / 2.0);
                                    return sum * y(low + (high - low) * (v - below) / (next - below), l);
                                }
                                below = next;
                            }
                            sum * y(values[CELLS - 1], l)
                        };
                        (0..CELLS).map(line).sum::<f64>()
                    };
                let own_level = at_level(&weight, &output, &self.values[factor]);
                let of_other = |other: f64, own: usize| match factor {
                    0 => f(value(0, own), other),
                    _ => f(other, value(1, own)),
                };
                let other_level = at_level(&|k, l| weight(l, k), &of_other, &self.values[1 - factor]);
                alone += (own_level - mean).powi(2) / f64::from(levels) / variance;
                with += (other_level - mean).powi(2) / f64::from(levels) / variance;
            }
            let total = 1.0 - other;
            [first, total, alone, 1.0 - with, 0.5 * (first + total)]
        })
    }
}

fn study(columns: &[Vec<f64>], base_samples: u64, seed: u64, f: fn(f64, f64) -> f64, method: ShapleyMethod) -> Study {
    let normal = Distribution::normal(0.0, 1.0).unwrap();
    let options = AnalysisOptions {
        shapley: Some(true),
        shapley_method: Some(method),
        ..AnalysisOptions::for_sampler(Sampler::Sobol)
    };
    Study::builder("bent", function_model("y", move |x: &[f64]| f(x[0], x[1])))
        .factor("a", normal.clone())
        .factor("b", normal)
        .dependence(Dependence::kernels(&["a", "b"], columns))
        .analysis(options)
        .base_samples(base_samples)
        .seed(seed)
        .build()
        .unwrap()
}

fn found(study: &Study) -> [[Estimate; 5]; 2] {
    let analysis = study.run().unwrap();
    ["a", "b"].map(|name| {
        let effect = analysis.output("y").unwrap().factor(name).unwrap();
        let dependent = effect.dependent.unwrap();
        let shapley = effect.shapley.unwrap();
        [effect.first_order, effect.total, dependent.independent_first_order, dependent.full_total, shapley]
    })
}

/// An output that is neither linear nor additive.
fn output(a: f64, b: f64) -> f64 {
    a + 0.5 * b * b + a * b
}

#[test]
fn indices_are_those_of_quadrature() {
    let columns = bent(40);
    let width = Dependence::kernels(&["a", "b"], &columns).kernel_width().unwrap();
    assert!(width < 0.6, "{width}");
    let exact = Grid::new(&columns, width).numbers(output);
    for method in [ShapleyMethod::Subsets, ShapleyMethod::Permutations] {
        let found = found(&study(&columns, 1 << 12, 3, output, method));
        for (found, exact) in found.iter().flatten().zip(exact.iter().flatten()) {
            // Those of random orders err like random points.
            let half_width = found.interval.map_or(0.0, |interval| (interval.high - interval.low) / 2.0);
            assert!((found.estimate - exact).abs() < 0.005 + 1.5 * half_width, "{method:?}: {found:?}, {exact}");
            assert!(half_width < 0.06, "{found:?}");
        }
    }
}

/// Set SEEDS=200 for the table of the documentation.
#[test]
fn intervals_hold_the_truth() {
    let seeds = std::env::var("SEEDS").map_or(30, |seeds| seeds.parse().unwrap());
    let columns = bent(40);
    let width = Dependence::kernels(&["a", "b"], &columns).kernel_width().unwrap();
    let exact = Grid::new(&columns, width).numbers(output);
    for base_samples in [256, 1024] {
        let mut held = [0; 5];
        for seed in 0..seeds {
            let found = found(&study(&columns, base_samples, seed, output, ShapleyMethod::Subsets));
            for (found, exact) in found.iter().zip(&exact) {
                for (k, (found, exact)) in found.iter().zip(exact).enumerate() {
                    let interval = found.interval.unwrap();
                    held[k] += u64::from(interval.low <= *exact && *exact <= interval.high);
                }
            }
        }
        let shares = held.map(|held| held as f64 / (2 * seeds) as f64);
        println!("{base_samples}: {shares:.3?}");
        assert!(shares.iter().sum::<f64>() / 5.0 > 0.87, "{base_samples}: {shares:?}");
    }
}

/// Normal measurements ask for kernels that are nearly the Gaussian copula.
#[test]
fn normal_measurements_give_nearly_the_closed_forms() {
    let case = Linear { b: vec![2.0, 1.0], sd: vec![1.0, 2.0], r: vec![vec![1.0, 0.6], vec![0.6, 1.0]] };
    let (first, second): (Vec<f64>, Vec<f64>) = (0..1000)
        .map(|k| {
            let [u, v] =
                [0.754_877_666, 0.569_840_291].map(|step| standard().inverse_cdf((0.5 + f64::from(k) * step).fract()));
            (u, 0.6 * u + 0.8 * v)
        })
        .unzip();
    let model = function_model("y", |x: &[f64]| 2.0 * x[0] + x[1]);
    let study = Study::builder("linear", model)
        .factor("a", Distribution::normal(3.0, 1.0).unwrap())
        .factor("b", Distribution::normal(3.0, 2.0).unwrap())
        .dependence(Dependence::kernels(&["a", "b"], &[first, second]))
        .base_samples(1 << 10)
        .build()
        .unwrap();
    let analysis = study.run().unwrap();
    for (i, name) in ["a", "b"].iter().enumerate() {
        let effect = analysis.output("y").unwrap().factor(name).unwrap();
        assert!((effect.total.estimate - case.total(&[i])).abs() < 0.03, "{name}: {effect:?}");
    }
}

/// Three factors of a table, two of which are tied to each other, beside two that a correlation ties: each block is as if alone.
#[test]
fn kernels_and_correlations_stand_side_by_side() {
    let mut columns = bent(100);
    columns.push((0..100).map(|k| columns[0][k] + (k * 37 % 100) as f64 / 50.0).collect());
    assert!(Dependence::kernels(&["a", "b", "c"], &columns).kernel_width().unwrap() < 0.7);
    let uniform = || Distribution::uniform(-1.0, 1.0).unwrap();
    let study = |shapley_method: Option<ShapleyMethod>| {
        let model = function_model("y", |x: &[f64]| x[0] + 2.0 * x[1] * x[2] + x[3] - x[4]);
        let options =
            AnalysisOptions { shapley: Some(true), shapley_method, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
        ["c", "p", "a", "q", "b"]
            .iter()
            .fold(Study::builder("both", model), |builder, name| builder.factor(name, uniform()))
            .dependence(Dependence::kernels(&["a", "b", "c"], &columns))
            .dependence(Dependence::pair("p", "q", 0.5))
            .analysis(options)
            .base_samples(1 << 12)
            .build()
            .unwrap()
    };
    let effects = |study: &Study| {
        let analysis = study.run().unwrap();
        let of = |name: &&str| analysis.output("y").unwrap().factor(name).unwrap().shapley.unwrap();
        ["a", "b", "c", "p", "q"].iter().map(of).collect::<Vec<Estimate>>()
    };
    let (subsets, orders) = (study(None), study(Some(ShapleyMethod::Permutations)));
    for (a, b) in effects(&subsets).iter().zip(effects(&orders)) {
        assert!((a.estimate - b.estimate).abs() < 0.05, "{a:?} {b:?}");
    }
    assert!((effects(&subsets).iter().map(|effect| effect.estimate).sum::<f64>() - 1.0).abs() < 1e-12);
}

#[test]
fn the_program_takes_a_copula_from_a_table() {
    let folder = Folder::new();
    let columns = bent(60);
    let rows: String = columns[0].iter().zip(&columns[1]).map(|(a, b)| format!("{a},{b}\n")).collect();
    folder.with("joint.csv", format!("a,b\n{rows}"));
    let study = |dependence: &str| {
        let factors = "[factor.a]\nmin = 0\nmax = 1\n[factor.b]\nmin = 0\nmax = 1\n";
        format!(
            "name = \"bent\"\nmodel = \"expression\"\noutputs.y = \"a + b^2\"\ndesign.base_samples = 256\n{factors}\
             [[dependence]]\nfactors = [\"a\", \"b\"]\n{dependence}\n"
        )
    };
    let path = folder.with("study.toml", study("file = \"joint.csv\"\ncopula = \"kernel\""));
    let out = folder.path("out");
    let told = succeed(&["run", text(&path), "--out", text(&out)]);
    assert!(told.contains("Shapley effect") && !told.contains("too few samples"), "{told}");
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("bent.json")).unwrap()).unwrap();
    let kernels = &json["study"]["dependences"][0]["kernels"];
    assert_eq!(kernels["measurements"], 60);
    assert!(
        kernels["width"].as_f64().unwrap() < 0.6 && kernels["log_likelihood_gain"].as_f64().unwrap() > 0.05,
        "{kernels}"
    );
    let page = std::fs::read_to_string(out.join("bent.html")).unwrap();
    assert!(page.contains("Factors that depend on each other. a and b: by kernels of width 0."), "the caption");
    // No page of its own without the table.
    assert!(page.contains("around 60 joint measurements") && !page.contains("Try your own ranges"));
    // The same bits on another number of threads, and from a result that is read again.
    let again = folder.path("again");
    succeed(&["run", text(&path), "--threads", "1", "--out", text(&again)]);
    let outputs = |folder: &std::path::Path| {
        let json: serde_json::Value =
            serde_json::from_slice(&std::fs::read(folder.join("bent.json")).unwrap()).unwrap();
        json["outputs"].clone()
    };
    assert_eq!(outputs(&out), outputs(&again));
    // The measurements in the study file are those of a file.
    let rows: Vec<String> = columns[0].iter().zip(&columns[1]).map(|(a, b)| format!("[{a}, {b}]")).collect();
    let inside =
        folder.with("inside.toml", study(&format!("measurements = [{}]\ncopula = \"kernel\"", rows.join(", "))));
    let own = folder.path("own");
    succeed(&["run", text(&inside), "--out", text(&own)]);
    assert_eq!(outputs(&out), outputs(&own));
    let told = succeed(&["check", text(&inside)]);
    assert!(told.contains("dependent: a, b by kernels of width 0."), "{told}");
    // The Gaussian copula of the same table is another study.
    let gaussian = folder.with("gaussian.toml", study("file = \"joint.csv\""));
    let other = folder.path("other");
    succeed(&["run", text(&gaussian), "--out", text(&other)]);
    assert_ne!(outputs(&out), outputs(&other));
    let points = folder.path("points.csv");
    succeed(&["sample", text(&path), "--random", "5", "--output", text(&points)]);
    assert_eq!(std::fs::read_to_string(points).unwrap().lines().count(), 6);
    for (dependence, expected) in [
        ("correlation = 0.5\ncopula = \"kernel\"", "`file`"),
        ("file = \"joint.csv\"\ncopula = \"vine\"", "kernel"),
        (
            "file = \"joint.csv\"\ncopula = \"kernel\"\n[[dependence]]\nfactors = [\"b\", \"a\"]\ncorrelation = 0.1",
            "in no other dependence",
        ),
        ("file = \"short.csv\"\ncopula = \"kernel\"", "10 to 4096"),
        ("measurements = [[1, 2], [3]]", "for each of `factors`"),
        ("measurements = [[1, 2], [3, 1]]", "at least 4 joint measurements"),
        ("measurements = [[1, 2]]\nfile = \"short.csv\"", "either `file`"),
        ("file = \"short.csv\"\ncorrelation = 0.5", "one of `correlation`"),
        ("file = \"line.csv\"\ncopula = \"kernel\"", "have the same order"),
        ("file = \"still.csv\"\ncopula = \"kernel\"", "of `b` are all the same"),
    ] {
        folder.with("short.csv", "a,b\n1,2\n2,1\n3,4\n5,3\n4,4\n");
        folder.with("still.csv", "a,b\n".to_owned() + &(0..20).map(|k| format!("{k},1\n")).collect::<String>());
        folder.with("line.csv", "a,b\n".to_owned() + &(0..20).map(|k| format!("{k},{}\n", 3 * k)).collect::<String>());
        let path = folder.with("wrong.toml", study(dependence));
        let output = apportion(&["check", text(&path)]);
        assert_eq!(output.status.code(), Some(2), "{dependence}");
        assert!(stderr(&output).contains(expected), "{dependence}: {}", stderr(&output));
    }
}
