//! What a cheaper model does for the indices of a dear one: errors at equal cost, bias and coverage.
//!
//! `cargo bench --bench multi_fidelity` writes `docs/accuracy/multi-fidelity.md` (some minutes on two cores);
//! `cargo bench --bench multi_fidelity -- 20` takes 20 seeds and writes nothing.
//!
//! The pairs are those of Qian et al. (2018), section 4.1, Ishigami's function with two cheaper ones, and of Xiong, Qian and Wu
//! (2013), the borehole function; and one of steps, which no polynomial explains. A run of the cheaper model counts as much as
//! the pair says. A single model gets at least as many runs as both together cost.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use apportion::Estimate;
use apportion::model::KnownAnswer;
use rayon::prelude::*;

/// Base samples of the dear model, of the cheaper model's own design, and of a single model at no less cost.
const SIZES: [(u64, u64, u64); 2] = [(16, 1 << 12, 32), (64, 1 << 14, 128)];

struct Pair {
    name: &'static str,
    study: String,
    low: String,
    /// Cost of a run of the cheaper model over that of one of the dear one.
    cost: f64,
    first: Vec<f64>,
    total: Vec<f64>,
}

fn ishigami(name: &'static str, low: &str, cost: f64) -> Pair {
    let (a, b) = (5.0, 0.1);
    let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
    let v2 = a * a / 8.0;
    let v13 = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let v = v1 + v2 + v13;
    let factors: String =
        (1..=3).map(|i| format!("[[factor]]\nname = \"x{i}\"\nmin = {}\nmax = {PI}\n", -PI)).collect();
    let high = "sin(x1) + 5*sin(x2)^2 + 0.1*x3^4*sin(x1)";
    Pair {
        name,
        study: format!("model = \"expression\"\n[outputs]\ny = \"{high}\"\n{factors}"),
        low: format!("{{ name = \"low\", outputs = {{ y = \"{low}\" }} }}"),
        cost,
        first: vec![v1 / v, v2 / v, 0.0],
        total: vec![(v1 + v13) / v, v2 / v, v13 / v],
    }
}

fn borehole() -> Pair {
    let exact = KnownAnswer::from_name("borehole").expect("a known function").default_function().exact();
    let indices = exact.indices.expect("indices");
    let low = "5*Tu*(Hu-Hl)/(ln(r/rw)*(1.5 + 2*L*Tu/(ln(r/rw)*rw^2*Kw) + Tu/Tl))";
    // The radius of influence by the mean and the standard deviation of its logarithm.
    let (mu, sigma) = (7.71, 1.0056_f64);
    let mean = (mu + sigma * sigma / 2.0_f64).exp();
    let sd = mean * (sigma * sigma).exp_m1().sqrt();
    let uniform = |name: &str, min: f64, max: f64| format!("[[factor]]\nname = \"{name}\"\nmin = {min}\nmax = {max}\n");
    let study = format!(
        "model = \"borehole\"\n[[factor]]\nname = \"rw\"\ndistribution = \"truncated-normal\"\nmean = 0.1\nsd = 0.0161812\n\
         min = 0.05\nmax = 0.15\n[[factor]]\nname = \"r\"\ndistribution = \"log-normal\"\nmean = {mean}\nsd = {sd}\n{}{}{}{}{}{}",
        uniform("Tu", 63_070.0, 115_600.0),
        uniform("Hu", 990.0, 1110.0),
        uniform("Tl", 63.1, 116.0),
        uniform("Hl", 700.0, 820.0),
        uniform("L", 1120.0, 1680.0),
        uniform("Kw", 9855.0, 12_045.0)
    );
    Pair {
        name: "borehole",
        study,
        low: format!("{{ name = \"low\", model = \"expression\", outputs = {{ y = \"{low}\" }} }}"),
        cost: 0.01,
        first: indices.first_order.clone(),
        total: indices.total.clone(),
    }
}

/// A product of steps, and the same with steps elsewhere and a slope.
fn steps() -> Pair {
    let factors: String = (1..=4).map(|i| format!("[[factor]]\nname = \"x{i}\"\nmin = 0\nmax = 1\n")).collect();
    let product = |text: &dyn Fn(usize) -> String| (1..=4).map(text).collect::<Vec<_>>().join("*");
    let high = product(&|i| format!("(1 + {} * floor(3*x{i}))", [0.8, 0.5, 0.3, 0.1][i - 1]));
    let low = product(&|i| format!("(1 + {} * floor(3*x{i}))", [0.75, 0.55, 0.3, 0.05][i - 1]));
    let parts: Vec<f64> = [0.8, 0.5, 0.3, 0.1].iter().map(|c: &f64| (2.0 / 3.0) * c * c / (1.0 + c).powi(2)).collect();
    let variance: f64 = parts.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
    Pair {
        name: "steps",
        study: format!("model = \"expression\"\n[outputs]\ny = \"{high}\"\n{factors}"),
        low: format!("{{ name = \"low\", outputs = {{ y = \"{low}\" }} }}"),
        cost: 0.01,
        first: parts.iter().map(|v| v / variance).collect(),
        total: parts.iter().map(|v| v / (1.0 + v) * (variance + 1.0) / variance).collect(),
    }
}

/// What the seeds of one setting found.
#[derive(Default)]
struct Found {
    /// Of every seed and index its error.
    errors: Vec<Vec<f64>>,
    covered: usize,
    intervals: usize,
}

impl Found {
    fn rmse(&self) -> f64 {
        let all = self.errors.iter().flatten();
        (all.clone().map(|e| e * e).sum::<f64>() / all.count() as f64).sqrt()
    }

    fn coverage(&self) -> f64 {
        self.covered as f64 / self.intervals as f64
    }

    /// The largest mean error of an index in its standard errors.
    fn bias(&self) -> f64 {
        let seeds = self.errors.len() as f64;
        let of_index = |place: usize| {
            let column = self.errors.iter().map(|errors| errors[place]);
            let mean = column.clone().sum::<f64>() / seeds;
            let variance = column.map(|e| (e - mean).powi(2)).sum::<f64>() / (seeds - 1.0);
            // Errors at the level of rounding say nothing.
            if variance.sqrt() < 1e-12 { 0.0 } else { mean.abs() / (variance / seeds).sqrt() }
        };
        (0..self.errors[0].len()).map(of_index).fold(0.0, f64::max)
    }
}

fn measured(pair: &Pair, seeds: u64, base_samples: u64, analysis: &str, low: Option<u64>) -> Found {
    let of_seed = |seed: u64| {
        let fidelity =
            low.map_or_else(String::new, |own| format!("[fidelity]\nlow = [{}]\nbase_samples = {own}\n", pair.low));
        let text = format!(
            "{}[design]\nbase_samples = {base_samples}\nseed = {seed}\n[analysis]\nsurrogate = \"{analysis}\"\n{fidelity}",
            pair.study
        );
        let study = apportion_files::parse_study(&text, Path::new("pair.toml"), &[]).expect("a study");
        let result = study.runner().threads(1).run().expect("a result");
        let indices = result.outputs[0].indices.as_ref().expect("indices");
        let first = indices.iter().map(|index| index.effect.first_order).zip(&pair.first);
        let all: Vec<(Estimate, f64)> = first
            .chain(indices.iter().map(|index| index.effect.total).zip(&pair.total))
            .map(|(estimate, truth)| (estimate, *truth))
            .collect();
        all
    };
    let all: Vec<Vec<(Estimate, f64)>> = (0..seeds).into_par_iter().map(of_seed).collect();
    let mut found = Found::default();
    for seed in all {
        for (estimate, truth) in &seed {
            if let Some(interval) = estimate.interval {
                found.intervals += 1;
                found.covered += usize::from(interval.low - 1e-12 <= *truth && *truth <= interval.high + 1e-12);
            }
        }
        found.errors.push(seed.into_iter().map(|(estimate, truth)| estimate.estimate - truth).collect());
    }
    found
}

fn main() {
    let asked: Option<u64> = std::env::args().skip(1).find_map(|argument| argument.parse().ok());
    let seeds = asked.unwrap_or(40);
    let pairs = [
        ishigami("Ishigami, low 2", "sin(x1) + 0.95*5*sin(x2)^2 + 0.1*x3^4*sin(x1)", 0.05),
        ishigami("Ishigami, low 3", "sin(x1) + 0.6*5*sin(x2)^2 + 9*0.1*x3^2*sin(x1)", 0.001),
        borehole(),
        steps(),
    ];
    let mut text = String::from(
        "| pair | cost | base samples | RMSE with the cheaper model | plain | surrogate alone | MSE, plain over cheaper model | \
         bias in standard errors | coverage |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for pair in &pairs {
        for (dear, own, single) in SIZES {
            // Own runs that cost no more than the dear ones.
            let own = own.min(((dear as f64 / pair.cost).log2().floor().exp2() as u64).max(16));
            let cost = dear as f64 * (1.0 + pair.cost) + own as f64 * pair.cost;
            let single = single.max((cost.log2().ceil()).exp2() as u64);
            let both = measured(pair, seeds, dear, "on", Some(own));
            let plain = measured(pair, seeds, single, "off", None);
            let surrogate = measured(pair, seeds, single, "on", None);
            let row = format!(
                "| {} | {} | {dear} and {own}; {single} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1} | {:.3} |",
                pair.name,
                pair.cost,
                both.rmse(),
                plain.rmse(),
                surrogate.rmse(),
                (plain.rmse() / both.rmse()).powi(2),
                both.bias(),
                both.coverage()
            );
            println!("{row}");
            let _ = writeln!(text, "{row}");
        }
    }
    if asked.is_none() {
        let page = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/accuracy/multi-fidelity.md");
        let head = include_str!("multi_fidelity.md.in").replace("SEEDS", &seeds.to_string());
        std::fs::write(page, format!("{head}\n{text}")).expect("docs/accuracy can be written");
    }
}
