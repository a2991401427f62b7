//! Which estimator is the most accurate?
//!
//! For functions with exact indices, over many scrambles of the Sobol' sequence and many random samples: the root mean
//! square error of the first-order and of the total indices, over factors and seeds, at the same number of base points
//! and with the runs of a base point beside it. "both" is the mean of Saltelli's (of Jansen's) formula on the rows AB
//! and on the rows BA, which the rows that Azzini's formulas need allow as well.

use apportion::design::{Companions, Design, DesignSettings, Rows, Sampler};
use apportion::estimate::{FirstOrder, Moments, SwapMoments, Total};
use apportion::model::{Batch, KnownAnswer, Model, Output, Worker};
use apportion::quantity::Unit;
use apportion::run::{Job, run};
use apportion::space::{Distribution, Factor, Space};

const SEEDS: u64 = 200;

/// Function G* of Saltelli et al. (2010) in six factors, delta = 0: some important factors, strong curvature.
const G_STAR: [(f64, f64); 6] = [(0.0, 1.0), (0.1, 0.5), (0.3, 2.0), (1.0, 1.0), (4.0, 0.5), (9.0, 2.0)];

fn g_star(x: &[f64]) -> f64 {
    let term =
        |(x, (a, alpha)): (&f64, (f64, f64))| ((1.0 + alpha) * (2.0 * x - 1.0).abs().powf(alpha) + a) / (1.0 + a);
    x.iter().zip(G_STAR).map(term).product()
}

fn g_star_exact() -> (Vec<f64>, Vec<f64>) {
    let v = G_STAR.map(|(a, alpha)| alpha * alpha / ((1.0 + 2.0 * alpha) * (1.0 + a) * (1.0 + a)));
    let all: f64 = v.iter().map(|v| 1.0 + v).product();
    let first = v.iter().map(|v| v / (all - 1.0)).collect();
    (first, v.iter().map(|v| v * all / (1.0 + v) / (all - 1.0)).collect())
}

struct Function {
    value: fn(&[f64]) -> f64,
    outputs: [Output; 1],
}

impl Model for Function {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(FunctionWorker(self))
    }
}

struct FunctionWorker<'a>(&'a Function);

impl Worker for FunctionWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let mut x = vec![0.0; inputs.len()];
        for row in 0..batch.rows() {
            for (x, column) in x.iter_mut().zip(inputs) {
                *x = column[row];
            }
            batch.set(row, 0, (self.0.value)(&x));
        }
    }
}

type Formula = Box<dyn Fn(&Moments, usize) -> f64>;

/// 1/(2n) sum [(y_B - f0)(y_AB - y_A) + (y_A - f0)(y_BA - y_B)]/V.
fn saltelli_both(swap: &SwapMoments) -> f64 {
    let (Some(ba), n) = (&swap.ba, swap.n()) else { return f64::NAN };
    ((swap.bd + ba.ae) / n + swap.base.half_gap() * (swap.mean_d - ba.mean_e)) / (2.0 * swap.base.variance())
}

/// 1/(4n) sum [(y_AB - y_A)^2 + (y_BA - y_B)^2]/V.
fn jansen_both(swap: &SwapMoments) -> f64 {
    let (Some(ba), n) = (&swap.ba, swap.n()) else { return f64::NAN };
    let squares = (swap.dd + ba.ee) / n + swap.mean_d * swap.mean_d + ba.mean_e * ba.mean_e;
    squares / (4.0 * swap.base.variance())
}

fn case(name: &str, value: fn(&[f64]) -> f64, space: &Space, exact: &(Vec<f64>, Vec<f64>), settings: &DesignSettings) {
    let d = space.factors().len();
    let outputs = [Output { name: "y", unit: Unit::dimensionless(), description: "" }];
    let model = Function { value, outputs };
    let mut formulas: Vec<(String, u64, bool, Formula)> = Vec::new();
    for e in FirstOrder::ALL {
        formulas.push((e.name().into(), e.runs_per_point(d as u64), true, Box::new(move |m, j| e.estimate(m, j))));
    }
    formulas.push(("both".into(), 2 + 2 * d as u64, true, Box::new(|m, j| saltelli_both(m.swap(j)))));
    for e in Total::ALL {
        formulas.push((e.name().into(), e.runs_per_point(d as u64), false, Box::new(move |m, j| e.estimate(m, j))));
    }
    formulas.push(("both".into(), 2 + 2 * d as u64, false, Box::new(|m, j| jansen_both(m.swap(j)))));
    let mut squares = vec![0.0; formulas.len()];
    for seed in 0..SEEDS {
        let companions = Companions { ba: true, bc: true, cb: true };
        let rows = Rows { swaps: (0..d).map(|j| vec![j]).collect(), companions, second_order: false };
        let design = Design::new(DesignSettings { seed, ..settings.clone() }, d, rows).expect("a design");
        let totals = run(Job { design: &design, space, model: &model }, 0, &|_| ()).expect("threads");
        let moments = totals[0].outputs[0].moments.whole();
        for ((_, _, first, formula), sum) in formulas.iter().zip(&mut squares) {
            let exact = if *first { &exact.0 } else { &exact.1 };
            *sum += (0..d).map(|j| (formula(&moments, j) - exact[j]).powi(2)).sum::<f64>();
        }
    }
    println!("{name}, {} base points, {}:", settings.base_samples, settings.sampler.name());
    for ((name, runs, first, _), sum) in formulas.iter().zip(squares) {
        let (kind, error) = (if *first { "S " } else { "ST" }, (sum / (SEEDS * d as u64) as f64).sqrt());
        println!("  {kind} {name:20} {runs:3} runs a point   error {error:.2e}");
    }
}

fn main() {
    let space = |inputs: &[(f64, f64)]| {
        let factor = |(number, (low, high)): (usize, &(f64, f64))| {
            let range = Distribution::uniform(*low, *high).expect("a range");
            Factor::new(&format!("x{number}"), Unit::dimensionless(), range).expect("a factor")
        };
        Space::new(inputs.iter().enumerate().map(factor).collect())
    };
    let of = |known: KnownAnswer| space(&known.inputs().iter().map(|i| (i.min, i.max)).collect::<Vec<_>>());
    for sampler in [Sampler::Sobol, Sampler::Random] {
        for base_samples in [1 << 10, 1 << 13] {
            let settings = DesignSettings { sampler, base_samples, replicates: 1, seed: 0 };
            let ishigami = |x: &[f64]| KnownAnswer::Ishigami.value(x);
            let known = KnownAnswer::Ishigami;
            case("Ishigami", ishigami, &of(known), &known.exact_indices(), &settings);
            let sobol_g = |x: &[f64]| KnownAnswer::SobolG.value(x);
            let known = KnownAnswer::SobolG;
            case("Sobol' G", sobol_g, &of(known), &known.exact_indices(), &settings);
            case("G*", g_star, &space(&[(0.0, 1.0); 6]), &g_star_exact(), &settings);
        }
    }
}
