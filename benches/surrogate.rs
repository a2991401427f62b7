//! What surrogates do for the indices: errors and coverage, plain and corrected, at equal runs.
//!
//! `cargo bench --bench surrogate` writes `docs/accuracy/surrogate.csv` and `docs/accuracy/surrogate.md`;
//! `cargo bench --bench surrogate -- 40 64,256 ishigami,borehole` takes 40 seeds, those sizes and functions, and writes
//! nothing.

use std::fmt::Write as _;
use std::path::Path;

use apportion::model::KnownAnswer;
use apportion::{Estimate, Study};
use rayon::prelude::*;

const SEEDS: u64 = 40;
const SIZES: [u64; 3] = [16, 64, 256];

/// Smooth functions: errors fall by orders of magnitude.
const SMOOTH: [&str; 9] =
    ["ishigami", "borehole", "wing-weight", "otl-circuit", "piston", "flood", "bratley", "sobol-levitan", PRODUCT_FORM];
/// Kinks, steps, many factors.
const ROUGH: [&str; 7] = ["sobol-g", "g-star", "steps", "minimum", "simplex", "morris", "oakley-ohagan"];
/// Rare, large outputs, and one of 0 and 1.
const SKEWED: [&str; 4] = ["sobol-g, a = 0", "log-normal product", "rare corner", "0 and 1"];
const PRODUCT_FORM: &str = "afm product form";

struct Case {
    text: String,
    first: Vec<f64>,
    total: Vec<f64>,
}

fn case(name: &str) -> Case {
    let product = |parts: &[f64]| {
        let variance: f64 = parts.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
        let first = parts.iter().map(|v| v / variance).collect();
        let total = parts.iter().map(|v| v / (1.0 + v) * (variance + 1.0) / variance).collect();
        (first, total)
    };
    let formula = |text: &str, d: usize, law: &str, (first, total): (Vec<f64>, Vec<f64>)| {
        let factors: String = (1..=d).map(|i| format!("[[factor]]\nname = \"x{i}\"\n{law}\n")).collect();
        let text = format!("model = \"expression\"\n[expression]\noutputs.y = \"{text}\"\n{factors}");
        Case { text, first, total }
    };
    let (uniform, normal) = ("min = 0\nmax = 1", "distribution = \"normal\"\nmean = 0\nsd = 1");
    match name {
        PRODUCT_FORM => {
            // F ~ w t^3/l^2 over the general study's ranges: moments of uniform factors, exactly.
            let power = |a: f64, b: f64, p: f64| (b.powf(p + 1.0) - a.powf(p + 1.0)) / ((p + 1.0) * (b - a));
            let relative = |a: f64, b: f64, p: f64| power(a, b, 2.0 * p) / power(a, b, p).powi(2) - 1.0;
            let parts = [relative(5.0, 80.0, 1.0), relative(0.25, 2.5, 3.0), relative(200.0, 700.0, -2.0), 0.0];
            let (first, total) = product(&parts);
            let ranges = [(5.0, 80.0), (0.25, 2.5), (200.0, 700.0), (0.0, 1.0)];
            let factor = |(i, (a, b)): (usize, &(f64, f64))| {
                format!("[[factor]]\nname = \"x{}\"\nmin = {a}\nmax = {b}\n", i + 1)
            };
            let factors: String = ranges.iter().enumerate().map(factor).collect();
            let text = "x1*x2^3/x3^2 + 0*x4";
            let text = format!("model = \"expression\"\n[expression]\noutputs.y = \"{text}\"\n{factors}");
            Case { text, first, total }
        }
        "sobol-g, a = 0" => {
            let text = (1..=8).map(|i| format!("abs(4*x{i}-2)")).collect::<Vec<_>>().join("*");
            formula(&text, 8, uniform, product(&[1.0 / 3.0; 8]))
        }
        "log-normal product" => formula("exp(x1+x2+x3)", 3, normal, product(&[std::f64::consts::E - 1.0; 3])),
        "rare corner" => formula("(x1*x2)^12", 2, uniform, product(&[169.0 / 25.0 - 1.0; 2])),
        "0 and 1" => {
            let first = vec![0.474_488_542_7, 0.156_466_193_3, 0.005_805_354_8];
            let total = vec![0.836_727_797_0, 0.515_094_157_6, 0.101_990_386_1];
            formula("if(0.8*x1+0.5*x2+0.1*x3 > 0.7, 1, 0)", 3, normal, (first, total))
        }
        name => {
            let exact = KnownAnswer::from_name(name).expect("a function of the list").default_function().exact();
            let indices = exact.indices.expect("indices");
            Case { text: format!("model = \"{name}\""), first: indices.first_order, total: indices.total }
        }
    }
}

/// The errors of one kind of indices over all seeds and factors.
#[derive(Default, Clone, Copy)]
struct Errors {
    square: f64,
    within: f64,
    width: f64,
    count: f64,
}

impl Errors {
    fn add(&mut self, estimates: impl Iterator<Item = (Estimate, f64)>) {
        for (Estimate { estimate, interval }, exact) in estimates {
            self.square += (estimate - exact).powi(2);
            let interval = interval.expect("an interval");
            // Exact answers are known to some 1e-9 where they come by quadrature.
            self.within += f64::from(u8::from(interval.low - 1e-8 <= exact && exact <= interval.high + 1e-8));
            self.width += interval.high - interval.low;
            self.count += 1.0;
        }
    }

    fn rmse(&self) -> f64 {
        (self.square / self.count).sqrt()
    }

    fn coverage(&self) -> f64 {
        self.within / self.count
    }

    /// Mean width over that of an interval made from the true error.
    fn relative_width(&self) -> f64 {
        self.width / self.count / (2.0 * 1.96 * self.rmse())
    }

    fn merged(self, other: Self) -> Self {
        Self {
            square: self.square + other.square,
            within: self.within + other.within,
            width: self.width + other.width,
            count: self.count + other.count,
        }
    }
}

/// First-order and total indices: corrected, plain, and of one net.
type Row = [[Errors; 2]; 3];

fn measured(case: &Case, size: u64, seeds: u64) -> (Row, f64, f64) {
    let study = |seed: u64, more: &[&str]| {
        let set = [format!("design.base_samples={size}"), format!("design.seed={seed}")];
        let overrides: Vec<String> = set.into_iter().chain(more.iter().map(|text| (*text).to_owned())).collect();
        Study::parse(&case.text, Path::new("case.toml"), &overrides).expect("a study")
    };
    let of_seed = |seed: u64| {
        let seed = 1000 + seed;
        let mut row = Row::default();
        let run = |study: &Study| study.runner().threads(1).run().expect("a result");
        let corrected = run(&study(seed, &["analysis.surrogate=\"on\""]));
        let indices = corrected.outputs[0].indices.as_ref().expect("indices");
        let exact = || case.first.iter().copied().zip(case.total.iter().copied());
        row[0][0].add(indices.factors.iter().map(|factor| factor.first_order).zip(case.first.iter().copied()));
        row[0][1].add(indices.factors.iter().map(|factor| factor.total).zip(case.total.iter().copied()));
        let mut used = (0.0, 0.0);
        if let Some(surrogate) = &indices.surrogate {
            used = (surrogate.explained, f64::from(u8::from(surrogate.corrects_first_order)));
        }
        let plain = run(&study(seed, &[]));
        let indices = plain.outputs[0].indices.as_ref().expect("indices");
        row[1][0].add(indices.factors.iter().zip(exact()).map(|(factor, exact)| (factor.first_order, exact.0)));
        row[1][1].add(indices.factors.iter().zip(exact()).map(|(factor, exact)| (factor.total, exact.1)));
        let single = run(&study(seed, &["design.replicates=1"]));
        let indices = single.outputs[0].indices.as_ref().expect("indices");
        row[2][0].add(indices.factors.iter().zip(exact()).map(|(factor, exact)| (factor.first_order, exact.0)));
        row[2][1].add(indices.factors.iter().zip(exact()).map(|(factor, exact)| (factor.total, exact.1)));
        (row, used.0, used.1)
    };
    let all: Vec<(Row, f64, f64)> = (0..seeds).into_par_iter().map(of_seed).collect();
    let n = all.len() as f64;
    let explained = all.iter().map(|(_, explained, _)| explained).sum::<f64>() / n;
    let used = all.iter().map(|(_, _, used)| used).sum::<f64>() / n;
    let row = all.into_iter().map(|(row, ..)| row).reduce(|a, b| {
        std::array::from_fn(|method| std::array::from_fn(|kind| a[method][kind].merged(b[method][kind])))
    });
    (row.expect("seeds"), explained, used)
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|text| text != "--bench").collect();
    let seeds = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(SEEDS);
    let sizes: Vec<u64> = arguments
        .get(1)
        .map_or_else(|| SIZES.to_vec(), |text| text.split(',').filter_map(|size| size.parse().ok()).collect());
    let all = [("smooth", &SMOOTH[..]), ("rough", &ROUGH[..]), ("skewed", &SKEWED[..])];
    let mut csv =
        "kind,function,base_samples,index,rmse_corrected,rmse_plain,rmse_one_net,coverage_corrected,coverage_plain,\
                   width_corrected,width_plain,explained,used\n"
            .to_owned();
    let mut gains: Vec<(&str, u64, f64, f64)> = Vec::new();
    for (kind, names) in all {
        for name in names.iter().filter(|name| arguments.get(2).is_none_or(|list| list.split(',').any(|n| n == **name)))
        {
            let case = case(name);
            for &size in &sizes {
                let (row, explained, used) = measured(&case, size, seeds);
                for (index, place) in [("S", 0), ("ST", 1)] {
                    let [corrected, plain, single] = [row[0][place], row[1][place], row[2][place]];
                    gains.push((kind, size, plain.rmse() / corrected.rmse(), single.rmse() / corrected.rmse()));
                    println!(
                        "{name:18} {size:5} {index:2} rmse {:.1e} plain {:.1e} one {:.1e} gain {:8.1} {:8.1} coverage {:.3} {:.3} \
                         width {:.2} {:.2} Q2 {explained:.4} used {used:.2}",
                        corrected.rmse(),
                        plain.rmse(),
                        single.rmse(),
                        plain.rmse() / corrected.rmse(),
                        single.rmse() / corrected.rmse(),
                        corrected.coverage(),
                        plain.coverage(),
                        corrected.relative_width(),
                        plain.relative_width(),
                    );
                    let _ = writeln!(
                        csv,
                        "{kind},\"{name}\",{size},{index},{:.3e},{:.3e},{:.3e},{:.4},{:.4},{:.3},{:.3},{explained:.5},{used:.3}",
                        corrected.rmse(),
                        plain.rmse(),
                        single.rmse(),
                        corrected.coverage(),
                        plain.coverage(),
                        corrected.relative_width(),
                        plain.relative_width(),
                    );
                }
            }
        }
    }
    let mut text = "# Indices corrected by surrogates\n\nRoot mean square errors of all first-order and total indices at equal \
                    runs: how many times smaller with `surrogate = \"on\"` than without, and than with a single Saltelli net of \
                    the same size. 40 seeds, N base samples in all; every function with its errors and the coverage of its \
                    95 % intervals is in `surrogate.csv`. Written by `cargo bench --bench surrogate`.\n\n| functions | N | gain over four plain nets: geometric mean, least | over one net |\n\
                    |---|---|---|---|\n"
        .to_owned();
    for (kind, _) in all {
        for size in &sizes {
            let of = |which: fn(&(&str, u64, f64, f64)) -> f64| -> Vec<f64> {
                gains.iter().filter(|gain| gain.0 == kind && gain.1 == *size).map(which).collect()
            };
            let told = |gains: Vec<f64>| {
                let mean = (gains.iter().map(|gain| gain.ln()).sum::<f64>() / gains.len() as f64).exp();
                let least = gains.iter().copied().fold(f64::INFINITY, f64::min);
                format!("{mean:.2}, {least:.2}")
            };
            let line = format!("| {kind} | {size} | {} | {} |", told(of(|gain| gain.2)), told(of(|gain| gain.3)));
            println!("{line}");
            text.push_str(&format!("{line}\n"));
        }
    }
    if arguments.is_empty() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/accuracy");
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join("surrogate.csv"), csv).expect("a file");
        std::fs::write(folder.join("surrogate.md"), text).expect("a file");
    }
}
