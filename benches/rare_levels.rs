//! What indices are worth where levels of factors are rare, tails are thin, and needles are narrow.
//!
//! `cargo bench --bench rare_levels` writes `docs/accuracy/rare-levels.md` (some minutes on two cores); with a number it takes
//! so many seeds and writes nothing, and with `indices` or `accuracy` after it one of the two tables alone.
//!
//! A run is silently wrong if an index is off by more than 0.05 and not held by its interval, and no warning is given.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use apportion::model::{Model, Output, RunContext, Worker};
use apportion::{AnalysisOptions, Distribution, Sampler, Study, StudyResult, SurrogateChoice, Target, function_model};
use rayon::prelude::*;

/// Errors below this are not silent ones.
const SMALL: f64 = 0.05;

type Function = Arc<dyn Fn(&[f64]) -> f64 + Send + Sync>;

struct Case {
    name: String,
    factors: Vec<Distribution>,
    function: Function,
    base_samples: u64,
}

fn uniform() -> Distribution {
    Distribution::uniform(0.0, 1.0).expect("bounds")
}

fn boolean(probability: f64) -> Distribution {
    Distribution::boolean(probability).expect("a probability")
}

fn discrete(values: &[f64], weights: &[f64]) -> Distribution {
    Distribution::discrete(values, Some(weights)).expect("levels")
}

fn case(
    name: &str,
    factors: Vec<Distribution>,
    base_samples: u64,
    function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
) -> Case {
    Case { name: name.to_owned(), factors, function: Arc::new(function), base_samples }
}

/// Sums and products of three rare booleans and a uniform factor.
fn random_case(number: u64, base_samples: u64) -> Case {
    let mut state = number.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        for _ in 0..4 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
        }
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let rare: Vec<Distribution> = (0..3).map(|_| boolean(0.003 * 100.0_f64.powf(next()))).collect();
    let weights: Vec<f64> = (0..5).map(|_| 2.0 * next() - 1.0).collect();
    let factors = std::iter::once(uniform()).chain(rare).collect();
    case("random functions of three booleans", factors, base_samples, move |x| {
        let sum: f64 = x.iter().zip(&weights).map(|(x, w)| x * w).sum();
        sum + weights[4] * x[0] * x[1] + x[2] * x[3]
    })
}

fn cases() -> Vec<Case> {
    let two = |p: f64| vec![uniform(), uniform(), boolean(p), boolean(p)];
    let one = |d: Distribution| vec![uniform(), uniform(), d];
    let weights = [0.499, 0.499, 0.002];
    let histogram = |edges: &[f64], weights: &[f64]| Distribution::histogram(edges, weights).expect("a histogram");
    let both = |x: &[f64]| x[0] * x[1] + x[2] + x[3];
    vec![
        case("a b + d + e, booleans of .03", two(0.03), 128, both),
        case("the same of .02", two(0.02), 512, both),
        case("the same of .02", two(0.02), 64, both),
        case("the same of .1", two(0.1), 32, both),
        case("the same of .005", two(0.005), 1024, both),
        case("the same of .2", two(0.2), 16, both),
        case("a b + d - 2 d e, booleans of .05", two(0.05), 128, |x| x[0] * x[1] + x[2] - 2.0 * x[2] * x[3]),
        case("a b + d a + e b, booleans of .03", two(0.03), 128, |x| {
            x[0] * x[1] + 3.0 * x[2] * x[0] + 3.0 * x[3] * x[1]
        }),
        case("exp(a) sin(3 b) + d, booleans of .03", two(0.03), 128, |x| x[0].exp() * (3.0 * x[1]).sin() + x[2]),
        case("|a - 1/2| b + d + e, booleans of .03", two(0.03), 128, |x| (x[0] - 0.5).abs() * x[1] + x[2] + x[3]),
        case("ten booleans of .05", vec![boolean(0.05); 10], 128, |x| x.iter().sum::<f64>()),
        case("ten booleans of .05, weighted", vec![boolean(0.05); 10], 128, |x| {
            x.iter().enumerate().map(|(i, x)| x * (i + 1) as f64).sum::<f64>()
        }),
        case("six booleans of .1", vec![boolean(0.1); 6], 64, |x| x.iter().sum::<f64>()),
        case("six booleans of .1, multiplied", vec![boolean(0.1); 6], 256, |x| {
            x.iter().map(|x| 1.0 + x).product::<f64>()
        }),
        case("a b + .5 d, d of .499 .499 .002", one(discrete(&[0.0, 1.0, 2.0], &weights)), 128, |x| {
            x[0] * x[1] + 0.5 * x[2]
        }),
        case("the same with a jump at 2", one(discrete(&[0.0, 1.0, 2.0], &weights)), 256, |x| {
            x[0] * x[1] + if x[2] > 1.5 { 3.0 } else { 0.2 * x[2] }
        }),
        case("a b + d, d of .9 .06 .04", one(discrete(&[0.0, 1.0, 2.0], &[0.9, 0.06, 0.04])), 64, |x| {
            x[0] * x[1] + x[2]
        }),
        case(
            "a b + d^2, d of .8 and ten times .02",
            one(discrete(
                &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0],
                &[0.8, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02, 0.02],
            )),
            128,
            |x| x[0] * x[1] + x[2] * x[2] / 20.0,
        ),
        case("a + b c, an idle boolean of .001", vec![uniform(), uniform(), uniform(), boolean(0.001)], 128, |x| {
            x[0] + x[1] * x[2]
        }),
        case("a b, an idle boolean of .001", one(boolean(0.001)), 128, |x| x[0] * x[1]),
        case("a b, an idle boolean of .01", one(boolean(0.01)), 60, |x| x[0] * x[1]),
        case("a b, an idle boolean of .03", one(boolean(0.03)), 32, |x| x[0] * x[1]),
        case("a b, two idle booleans of .02", two(0.02), 128, |x| x[0] * x[1]),
        case("a b, an idle boolean of .3", one(boolean(0.3)), 16, |x| x[0] * x[1]),
        case(
            "a b + min(d, 2), histogram of .999 .001",
            one(histogram(&[0.0, 1.0, 1000.0], &[0.999, 0.001])),
            128,
            |x| x[0] * x[1] + x[2].min(2.0),
        ),
        case("a b + min(d, 2), histogram of .99 .01", one(histogram(&[0.0, 1.0, 100.0], &[0.99, 0.01])), 256, |x| {
            x[0] * x[1] + x[2].min(2.0)
        }),
        case("a b + .1 d, histogram of .95 .05", one(histogram(&[0.0, 1.0, 20.0], &[0.95, 0.05])), 128, |x| {
            x[0] * x[1] + 0.1 * x[2]
        }),
        case("a b + d, histogram with a gap", one(histogram(&[0.0, 1.0, 9.0, 10.0], &[0.97, 0.0, 0.03])), 128, |x| {
            x[0] * x[1] + 0.2 * x[2]
        }),
        case("a b + d, three rare booleans", vec![uniform(), boolean(0.003), boolean(0.03), boolean(0.3)], 128, |x| {
            x[0] + 3.0 * x[1] + x[2] + 0.5 * x[3]
        }),
        case(
            "three rare booleans that interact",
            vec![uniform(), boolean(0.02), boolean(0.05), boolean(0.3)],
            256,
            |x| x[0] + 2.0 * x[1] * (1.0 + x[3]) + x[2] * (1.0 - x[0]),
        ),
        case("a and a rare d: d a^2", one(boolean(0.02)), 256, |x| x[1] * 0.2 + 4.0 * x[2] * x[0] * x[0]),
        case("a d of .97 that switches b on", one(boolean(0.97)), 128, |x| x[0] + x[2] * x[1]),
        case("counts: a b + d, Poisson of .05", one(Distribution::poisson(0.05).expect("a mean")), 128, |x| {
            x[0] * x[1] + x[2]
        }),
        case("counts: a b + d, Poisson of .5", one(Distribution::poisson(0.5).expect("a mean")), 64, |x| {
            x[0] * x[1] + 0.3 * x[2]
        }),
        case("four levels, one of .01", one(discrete(&[0.0, 1.0, 2.0, 3.0], &[0.33, 0.33, 0.33, 0.01])), 128, |x| {
            x[0] * x[1] + [0.1, 0.4, 0.2, 3.0][x[2] as usize]
        }),
        case(
            "a table of 20 values with one far off",
            one(Distribution::empirical(
                &[1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7, 2.8, 30.0],
                None,
            )
            .expect("values")),
            64,
            |x| x[0] * x[1] + 0.1 * x[2],
        ),
        case("truncated far off: a b + d^2", one(Distribution::beta(0.05, 3.0, 0.0, 1.0).expect("beta")), 128, |x| {
            x[0] * x[1] + 2.0 * x[2] * x[2]
        }),
        case("two switches, d e, of .1", two(0.1), 256, |x| x[0] * x[1] + x[2] * x[3]),
        case(
            "five booleans of .02 and a, b",
            vec![uniform(), uniform(), boolean(0.02), boolean(0.02), boolean(0.02), boolean(0.02), boolean(0.02)],
            256,
            |x| x[0] * x[1] + x[2..].iter().sum::<f64>(),
        ),
        case("a b + d, boolean of .01", one(boolean(0.01)), 512, |x| x[0] * x[1] + x[2]),
    ]
}

/// Values and weights of a rule that is exact for the functions here, or close.
fn nodes(distribution: &Distribution) -> Vec<(f64, f64)> {
    if let Some(mut levels) = distribution.levels() {
        if let Distribution::Poisson(_) = distribution {
            // All counts that occur, not the likely ones alone.
            levels = (0..40).map(|k| (f64::from(k), 0.0)).collect();
        }
        // Each comes with a quantile in its middle: their ends are found by bisection.
        let end = |value: f64, middle: f64| {
            let (mut low, mut high) = (middle, 1.0);
            for _ in 0..60 {
                let next = f64::midpoint(low, high);
                if distribution.quantile(next) > value { high = next } else { low = next }
            }
            high
        };
        let mut start = 0.0;
        let width = |(value, middle): (f64, f64)| {
            (value, end(value, middle) - std::mem::replace(&mut start, end(value, middle)))
        };
        return levels.into_iter().map(width).filter(|(_, width)| *width > 0.0).collect();
    }
    if let Distribution::Uniform(_) = distribution {
        let rule = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
            (0.906_179_845_938_664, 0.236_926_885_056_189_1),
        ];
        let of_panel = |panel: usize| {
            let both =
                rule.iter().flat_map(|(x, w)| if *x == 0.0 { vec![(0.0, *w)] } else { vec![(-x, *w), (*x, *w)] });
            both.map(move |(x, w)| ((panel as f64 + (1.0 + x) / 2.0) / 4.0, w / 8.0)).collect::<Vec<_>>()
        };
        return (0..4).flat_map(of_panel).collect();
    }
    let count = 20_000;
    (0..count)
        .map(|i| (distribution.quantile((f64::from(i) + 0.5) / f64::from(count)), 1.0 / f64::from(count)))
        .collect()
}

/// First-order and total indices on the grid of the nodes.
fn exact(case: &Case) -> Vec<[f64; 2]> {
    let grids: Vec<Vec<(f64, f64)>> = case.factors.iter().map(nodes).collect();
    let mut place = vec![0; grids.len()];
    let mut only: Vec<Vec<f64>> = grids.iter().map(|grid| vec![0.0; grid.len()]).collect();
    let size =
        |without: usize| grids.iter().enumerate().filter(|(i, _)| *i != without).map(|(_, grid)| grid.len()).product();
    let mut others: Vec<Vec<f64>> = (0..grids.len()).map(|i| vec![0.0; size(i)]).collect();
    let mut weights: Vec<Vec<f64>> = others.clone();
    let (mut mean, mut square) = (0.0, 0.0);
    loop {
        let x: Vec<f64> = place.iter().zip(&grids).map(|(&k, grid)| grid[k].0).collect();
        let w: f64 = place.iter().zip(&grids).map(|(&k, grid)| grid[k].1).product();
        let y = (case.function)(&x);
        mean += w * y;
        square += w * y * y;
        for i in 0..grids.len() {
            only[i][place[i]] += w * y / grids[i][place[i]].1;
            let mut cell = 0;
            for (j, &k) in place.iter().enumerate().filter(|(j, _)| *j != i) {
                cell = cell * grids[j].len() + k;
            }
            others[i][cell] += grids[i][place[i]].1 * y;
            weights[i][cell] = w / grids[i][place[i]].1;
        }
        let Some(next) = (0..grids.len()).rev().find(|&i| place[i] + 1 < grids[i].len()) else { break };
        place[next] += 1;
        place[next + 1..].fill(0);
    }
    let variance = square - mean * mean;
    let of_factor = |i: usize| {
        let first: f64 = grids[i].iter().zip(&only[i]).map(|((_, w), y)| w * (y - mean) * (y - mean)).sum();
        let rest: f64 = weights[i].iter().zip(&others[i]).map(|(w, y)| w * (y - mean) * (y - mean)).sum();
        [first / variance, 1.0 - rest / variance]
    };
    (0..grids.len()).map(of_factor).collect()
}

/// A model that says that it takes its time, as a program does.
struct Program<M>(M);

impl<M: Model> Model for Program<M> {
    fn outputs(&self) -> &[Output] {
        self.0.outputs()
    }

    fn concurrency(&self) -> Option<usize> {
        Some(1)
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        self.0.worker(context)
    }
}

/// How a study is run.
#[derive(Clone, Copy)]
enum Way {
    Fixed(SurrogateChoice),
    Accurate { accuracy: f64, is_program: bool },
}

fn analysis(case: &Case, seed: u64, way: Way) -> StudyResult {
    let function = Arc::clone(&case.function);
    let model = function_model("y", move |x| function(x));
    let builder = match way {
        Way::Accurate { is_program: true, .. } => Study::builder("rare levels", Program(model)),
        _ => Study::builder("rare levels", model),
    };
    let factors = case.factors.iter().enumerate();
    let builder = factors.fold(builder, |builder, (i, law)| builder.factor(&format!("x{i}"), law.clone())).seed(seed);
    let options = AnalysisOptions { convergence: false, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    let builder = match way {
        Way::Fixed(surrogate) => {
            builder.base_samples(case.base_samples).analysis(AnalysisOptions { surrogate, ..options })
        }
        Way::Accurate { accuracy, .. } => {
            builder.until(Target { max_runs: Some(1 << 20), ..Target::accuracy(accuracy) }).analysis(options)
        }
    };
    builder.build().expect("a study").runner().threads(1).run().expect("a result")
}

/// What runs of a case are worth.
#[derive(Default, Clone, Copy)]
struct Score {
    within: f64,
    count: f64,
    square: f64,
    silent: f64,
    warned: f64,
    runs: f64,
}

impl Score {
    fn of(analysis: &StudyResult, exact: &[[f64; 2]]) -> Self {
        let mut score = Self { runs: 1.0, ..Self::default() };
        let output = &analysis.outputs[0];
        let Some(indices) = &output.indices else { return score };
        let is_warned = !output.warnings.is_empty();
        let mut is_wrong = false;
        for (factor, exact) in indices.iter().map(|index| index.effect).zip(exact) {
            for (estimate, exact) in [factor.first_order, factor.total].into_iter().zip(exact) {
                let error = (estimate.estimate - exact).abs();
                let holds = estimate.interval.is_none_or(|i| i.low - 1e-4 <= *exact && *exact <= i.high + 1e-4);
                score.within += f64::from(u8::from(holds));
                score.count += 1.0;
                score.square += error * error;
                is_wrong |= !holds && error > SMALL;
            }
        }
        score.silent = f64::from(u8::from(is_wrong && !is_warned));
        score.warned = f64::from(u8::from(is_warned));
        score
    }

    fn merged(self, other: Self) -> Self {
        Self {
            within: self.within + other.within,
            count: self.count + other.count,
            square: self.square + other.square,
            silent: self.silent + other.silent,
            warned: self.warned + other.warned,
            runs: self.runs + other.runs,
        }
    }

    fn row(&self) -> String {
        format!(
            "{:.2} | {:.3} | {:.2} | {:.2}",
            self.within / self.count,
            (self.square / self.count).sqrt(),
            self.silent / self.runs,
            self.warned / self.runs
        )
    }
}

const HEAD: &str = "| inputs, output | N | coverage, rmse, silent, warned: default | | | | without surrogates | | | |\n|---|---|---|---|---|---|---|---|---|---|\n";

fn indices(seeds: u64) -> String {
    let mut text = String::from(HEAD);
    let mut whole = [Score::default(); 2];
    let mut add = |name: &str, size: u64, list: Vec<[Score; 2]>| {
        let none = [Score::default(); 2];
        let scores = list.into_iter().fold(none, |sum, of| [sum[0].merged(of[0]), sum[1].merged(of[1])]);
        whole = [whole[0].merged(scores[0]), whole[1].merged(scores[1])];
        let row = format!("| {name} | {size} | {} | {} |", scores[0].row(), scores[1].row());
        println!("{row}");
        let _ = writeln!(text, "{row}");
    };
    let both = |case: &Case, seed: u64, exact: &[[f64; 2]]| {
        [SurrogateChoice::Auto, SurrogateChoice::Off]
            .map(|choice| Score::of(&analysis(case, seed, Way::Fixed(choice)), exact))
    };
    for case in cases() {
        let exact = exact(&case);
        let list = (0..seeds).into_par_iter().map(|seed| both(&case, seed, &exact)).collect();
        add(&case.name, case.base_samples, list);
    }
    for size in [32, 128] {
        let of_number = |number: u64| {
            let case = random_case(number, size);
            both(&case, number, &exact(&case))
        };
        let list = (0..10 * seeds).into_par_iter().map(of_number).collect();
        add("random functions of three booleans", size, list);
    }
    println!("all: {} | {}", whole[0].row(), whole[1].row());
    text
}

fn accuracy(seeds: u64) -> String {
    let mut text = String::from(
        "| inputs, output | model | target met, of seeds | true | not true without a warning | runs, median |\n|---|---|---|---|---|---|\n",
    );
    let peak: [Case; 2] = [
        case("a + b and a peak of width .003", vec![uniform(), uniform()], 0, |x| {
            x[0] + x[1] + 10.0 * (-((x[0] - 0.4137) / 0.003).powi(2) / 2.0).exp()
        }),
        case("a + sin(2 pi 16 b)", vec![uniform(), uniform()], 0, |x| {
            x[0] + (32.0 * std::f64::consts::PI * x[1]).sin()
        }),
    ];
    for (case, is_smooth) in cases().into_iter().map(|case| (case, true)).chain(peak.map(|case| (case, false))) {
        let truth = if is_smooth { exact(&case) } else { fine(&case) };
        for is_program in [true, false] {
            let of_seed = |seed: u64| {
                let analysis = analysis(&case, seed, Way::Accurate { accuracy: 0.01, is_program });
                let output = &analysis.outputs[0];
                let error = output.indices.as_ref().map_or(f64::INFINITY, |indices| {
                    let of = indices.iter().map(|index| index.effect).zip(&truth);
                    of.map(|(f, e)| (f.first_order.estimate - e[0]).abs().max((f.total.estimate - e[1]).abs()))
                        .fold(0.0, f64::max)
                });
                let is_met = analysis.stopping.as_ref().is_some_and(|s| s.target_met == Some(true));
                let runs = analysis.spending.as_ref().map_or(analysis.provenance.model_runs, |spending| spending.runs);
                (is_met, error <= 0.01, output.warnings.is_empty(), runs)
            };
            let all: Vec<_> = (0..seeds).into_par_iter().map(of_seed).collect();
            let count = |of: fn(&(bool, bool, bool, u64)) -> bool| all.iter().filter(|x| of(x)).count();
            let mut runs: Vec<u64> = all.iter().map(|x| x.3).collect();
            runs.sort_unstable();
            let row = format!(
                "| {} | {} | {} | {} | {} | {} |",
                case.name,
                if is_program { "program" } else { "formula" },
                count(|x| x.0),
                count(|x| x.1),
                count(|x| x.0 && !x.1 && x.2),
                runs[runs.len() / 2]
            );
            println!("{row}");
            let _ = writeln!(text, "{row}");
        }
    }
    text
}

/// The same as `exact` of two uniform factors, on a fine grid.
fn fine(case: &Case) -> Vec<[f64; 2]> {
    let count = 4000;
    let grid: Vec<f64> = (0..count).map(|i| (f64::from(i) + 0.5) / f64::from(count)).collect();
    // Sums of functions of one factor.
    let variance = |of: &dyn Fn(f64) -> f64| {
        let y: Vec<f64> = grid.iter().map(|x| of(*x)).collect();
        let mean = y.iter().sum::<f64>() / f64::from(count);
        y.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / f64::from(count)
    };
    let parts = [variance(&|x| (case.function)(&[x, 0.1])), variance(&|x| (case.function)(&[0.1, x]))];
    parts.map(|v| [v / (parts[0] + parts[1]); 2]).to_vec()
}

fn main() {
    let asked: Option<u64> = std::env::args().skip(1).find_map(|argument| argument.parse().ok());
    let only = |what: &str| std::env::args().any(|argument| argument == what);
    let seeds = asked.unwrap_or(40);
    let first = if only("accuracy") { String::new() } else { indices(seeds) };
    let second = if only("indices") { String::new() } else { accuracy(seeds.min(20)) };
    if asked.is_none() {
        let page = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/accuracy/rare-levels.md");
        let head = include_str!("rare_levels.md.in");
        std::fs::write(page, format!("{head}\n{first}\n{second}")).expect("docs/accuracy can be written");
    }
}
