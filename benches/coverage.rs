//! How often does a 95 % interval hold, and how wide is it?
//!
//! For functions with known indices, at N = 2^8 .. 2^14 base samples, over many seeds and every index of an active factor:
//!
//! - **coverage**: the share of intervals that hold the exact index;
//! - **width**: the mean width over the ideal, 2 x 1.96 x the true standard error of the estimate from one net of the same
//!   N, where "true" is the spread over the seeds;
//! - **error**: the true standard error of the estimate over that of one net.
//!
//! `cargo bench --bench coverage` writes `docs/background/coverage.csv` and `docs/background/coverage.md`. The functions below the line were
//! not looked at when the constants of the method were chosen. `cargo bench --bench coverage -- 50` takes 50 seeds
//! and writes nothing; `-- skewed 200` measures the functions with rare, large outputs alone, and writes
//! `docs/background/coverage-skewed.csv`, of which `docs/background/coverage-skewed.md` tells.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use apportion::model::KnownAnswer;
use apportion::uncertainty::IntervalMethod;

const SEEDS: u64 = 100;
const SIZES: std::ops::RangeInclusive<u32> = 8..=14;

/// The product form of the force and the functions of the literature on which the method was developed.
const KNOWN: [&str; 11] = [
    "ishigami",
    "sobol-g",
    "g-star",
    "morris",
    "bratley",
    "oakley-ohagan",
    "linear",
    "product",
    "steps",
    "simplex",
    PRODUCT_FORM,
];
/// Functions that it had not seen.
const UNSEEN: [&str; 7] = ["flood", "borehole", "wing-weight", "otl-circuit", "piston", "sobol-levitan", "minimum"];
const PRODUCT_FORM: &str = "afm product form";

/// Outputs of rare, large values, and one of 0 and 1, on which intervals were too short: name, formula, factors, whether they
/// are normal (else uniform on 0 to 1), whether second-order indices are asked for. Product forms but for the last two.
const SKEWED: [(&str, &str, usize, bool, bool); 7] = [
    ("rare corner", "(x1*x2)^12", 2, false, false),
    ("g-star, alpha = 2", "P3*(2*x#-1)^2", 10, false, false),
    ("kucherenko 2c", "P2*x#", 10, false, false),
    ("log-normal product", "exp(x1+x2+x3)", 3, true, false),
    ("sobol-g, a = 0", "Pabs(4*x#-2)", 8, false, false),
    (THRESHOLD, "if(0.8*x1+0.5*x2+0.1*x3 > 0.7, 1, 0)", 3, true, false),
    ("0 and 1, second order", "if(0.8*x1+0.5*x2+0.1*x3 > 0.7, 1, 0)", 3, true, true),
];
const THRESHOLD: &str = "0 and 1";
const THRESHOLD_FIRST: [f64; 3] = [0.474_488_542_7, 0.156_466_193_3, 0.005_805_354_8];
const THRESHOLD_TOTAL: [f64; 3] = [0.836_727_797_0, 0.515_094_157_6, 0.101_990_386_1];
/// Sizes at which they are measured.
const SKEWED_SIZES: [u32; 3] = [8, 10, 12];

/// What is compared: a name, the sampler, the kind of interval and the number of replicates.
const METHODS: [(&str, &str, IntervalMethod, u64); 7] = [
    ("1 net", "sobol", IntervalMethod::Nets, 1),
    ("2 nets", "sobol", IntervalMethod::Nets, 2),
    ("4 nets", "sobol", IntervalMethod::Nets, 4),
    ("4 replicates", "sobol", IntervalMethod::Replicates, 4),
    ("16 replicates", "sobol", IntervalMethod::Replicates, 16),
    ("random, batches", "random", IntervalMethod::Batches, 1),
    ("latin, 16 replicates", "latin-hypercube", IntervalMethod::Replicates, 16),
];

/// The default among the methods.
const DEFAULT: usize = 2;

struct Case {
    text: String,
    first: Vec<f64>,
    total: Vec<f64>,
}

fn case(name: &str) -> Case {
    if name == PRODUCT_FORM {
        let (first, total) = product_form();
        let text =
            include_str!("../studies/coulomb-general.toml").replace("[afm]", "[afm]\nshear_strength = \"0 MPa\"");
        return Case { text, first, total };
    }
    let exact = KnownAnswer::from_name(name).expect("a function of the list").default_function().exact();
    let indices = exact.indices.expect("indices");
    Case { text: format!("model = \"{name}\""), first: indices.first_order, total: indices.total }
}

/// One of [`SKEWED`].
fn skewed_case((name, formula, d, normal, second_order): (&str, &str, usize, bool, bool)) -> Case {
    let weak = |i: usize| name.starts_with("g-star") && i > 2;
    let term = |term: &str, i: usize| {
        let term = term.replace('#', &i.to_string());
        // The weak factors of G* have a = 9.
        if weak(i) { format!("({term}+9)/10") } else { term }
    };
    let formula = match formula.strip_prefix('P') {
        Some(factor) => (1..=d).map(|i| term(factor, i)).collect::<Vec<_>>().join("*"),
        None => formula.to_owned(),
    };
    let distribution = if normal {
        "distribution = \"normal\"\nmean = 0\nsd = 1"
    } else {
        "distribution = \"uniform\"\nmin = 0\nmax = 1"
    };
    let factors: String = (1..=d).map(|i| format!("[[factor]]\nname = \"x{i}\"\n{distribution}\n")).collect();
    let text = format!(
        "model = \"expression\"\n[outputs]\ny = \"{formula}\"\n[analysis]\nsecond_order = {second_order}\n{factors}"
    );
    // Relative variance of the part of one factor: of x^12 13^2/25 - 1, of e^x e - 1, of 3 (2 x - 1)^2 4/5.
    let part = |i: usize| match name {
        "rare corner" => 169.0 / 25.0 - 1.0,
        "log-normal product" => std::f64::consts::E - 1.0,
        "g-star, alpha = 2" => 0.8 / if weak(i) { 100.0 } else { 1.0 },
        _ => 1.0 / 3.0,
    };
    if name.starts_with(THRESHOLD) {
        // By quadrature of P(x_u'c + z sqrt(0.9 - c_u^2) > 0.7)^2 over x_u, 400000 points.
        return Case { text, first: THRESHOLD_FIRST.to_vec(), total: THRESHOLD_TOTAL.to_vec() };
    }
    let parts: Vec<f64> = (1..=d).map(part).collect();
    let all: f64 = parts.iter().map(|part| 1.0 + part).product();
    let first = parts.iter().map(|part| part / (all - 1.0)).collect();
    let total = parts.iter().map(|part| part * all / (1.0 + part) / (all - 1.0)).collect();
    Case { text, first, total }
}

/// Coverage and width of the default on [`SKEWED`] as CSV.
fn skewed(seeds: u64) -> String {
    let mut csv = String::from("function,base_samples,index,coverage,above,below,worst_index,width\n");
    for function in SKEWED {
        let case = skewed_case(function);
        for m in SKEWED_SIZES {
            let ideal = spreads(&sample(&case, METHODS[0], m, seeds));
            let drawn = sample(&case, METHODS[DEFAULT], m, seeds);
            for (kind, exact) in [("S1", &case.first), ("ST", &case.total)] {
                let offset = usize::from(kind == "ST");
                let share = |k: usize, miss: &dyn Fn([f64; 3]) -> bool| {
                    drawn.rows.iter().filter(|row| miss(row[2 * k + offset])).count() as f64 / seeds as f64
                };
                let each = |miss: &dyn Fn([f64; 3], f64) -> bool| -> Vec<f64> {
                    exact.iter().enumerate().map(|(k, exact)| share(k, &|row| miss(row, *exact))).collect()
                };
                let mean = |shares: &[f64]| shares.iter().sum::<f64>() / shares.len() as f64;
                let above = each(&|[_, _, high], exact| exact > high + 1e-12 || high.is_nan());
                let below = each(&|[_, low, _], exact| exact < low - 1e-12 || low.is_nan());
                let worst = above.iter().zip(&below).map(|(a, b)| 1.0 - a - b).fold(1.0, f64::min);
                let widths = |k: usize| {
                    let width = drawn.rows.iter().map(|row| row[2 * k + offset]).map(|[_, low, high]| high - low);
                    width.sum::<f64>() / seeds as f64 / (2.0 * 1.96 * ideal[2 * k + offset])
                };
                let width = mean(&(0..exact.len()).map(widths).collect::<Vec<_>>());
                let (above, below) = (mean(&above), mean(&below));
                let (name, n, coverage) = (function.0, 1u64 << m, 1.0 - above - below);
                let _ =
                    writeln!(csv, "\"{name}\",{n},{kind},{coverage:.4},{above:.4},{below:.4},{worst:.4},{width:.3}");
                println!(
                    "{name:24} {n:6} {kind} {coverage:.3} above {above:.3} below {below:.3} ({worst:.2}) {width:.2}"
                );
            }
        }
    }
    csv
}

/// Exact indices of F = c E w t^3 L^-2 over the papers' box, in the order of the general study.
fn product_form() -> (Vec<f64>, Vec<f64>) {
    let relative_variance = |a: f64, b: f64, k: i32| {
        let moment = |k: i32| (b.powi(k + 1) - a.powi(k + 1)) / (f64::from(k + 1) * (b - a));
        moment(2 * k) / moment(k).powi(2) - 1.0
    };
    let acting = [(200.0, 700.0, -2), (5.0, 80.0, 1), (0.25, 2.5, 3)].map(|(a, b, k)| relative_variance(a, b, k));
    let [length, width, thickness] = acting;
    let v = [length, width, thickness, 0.0, 0.0, relative_variance(120.0, 200.0, 1), 0.0, 0.0];
    let all: f64 = v.iter().map(|v| 1.0 + v).product();
    (v.map(|v| v / (all - 1.0)).to_vec(), v.map(|v| v * all / (1.0 + v) / (all - 1.0)).to_vec())
}

/// Estimates and widths of every index, for every seed.
struct Sample {
    /// `[seed][index]`: estimate, lower and upper bound.
    rows: Vec<Vec<[f64; 3]>>,
}

fn sample(
    case: &Case,
    (_, sampler, method, replicates): (&str, &str, IntervalMethod, u64),
    m: u32,
    seeds: u64,
) -> Sample {
    let base_samples = 1u64 << m;
    let of_seed = |seed: u64| {
        let overrides = [
            format!("design.base_samples={base_samples}"),
            format!("design.replicates={replicates}"),
            format!("design.seed={seed}"),
            format!("design.sampler={sampler}"),
            format!("analysis.intervals={}", method.name()),
            "analysis.surrogate=\"off\"".to_owned(),
            "analysis.convergence=false".to_owned(),
        ];
        let study = apportion_files::parse_study(&case.text, "coverage.toml".as_ref(), &overrides).expect("a study");
        let result = study.run().expect("a result");
        let Some(indices) = &result.outputs[0].indices else { return Vec::new() };
        let factors = indices.iter().zip(&case.total).filter(|(_, total)| **total > 1e-12);
        let both = factors.flat_map(|(of, _)| [of.effect.first_order, of.effect.total]);
        both.map(|e| [e.estimate, e.interval.map_or(f64::NAN, |i| i.low), e.interval.map_or(f64::NAN, |i| i.high)])
            .collect()
    };
    Sample { rows: (0..seeds).map(of_seed).collect() }
}

/// Standard deviation over the seeds of every index.
fn spreads(sample: &Sample) -> Vec<f64> {
    let n = sample.rows.len() as f64;
    let of = |k: usize| {
        let mean = sample.rows.iter().map(|row| row[k][0]).sum::<f64>() / n;
        (sample.rows.iter().map(|row| (row[k][0] - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
    };
    (0..sample.rows[0].len()).map(of).collect()
}

#[derive(Debug, Clone, Copy)]
struct Cell {
    coverage: f64,
    worst: f64,
    width: f64,
    error: f64,
}

fn cell(sample: &Sample, exact: &[f64], ideal: &[f64]) -> Cell {
    let seeds = sample.rows.len() as f64;
    // Rounding: an index known exactly by symmetry.
    let holds = |[_, low, high]: [f64; 3], exact: f64| low - 1e-12 <= exact && exact <= high + 1e-12;
    let per_index: Vec<f64> = (0..exact.len())
        .map(|k| sample.rows.iter().filter(|row| holds(row[k], exact[k])).count() as f64 / seeds)
        .collect();
    let own = spreads(sample);
    let geometric = |ratio: &dyn Fn(usize) -> f64| {
        let logs: Vec<f64> = (0..exact.len()).map(ratio).filter(|r| r.is_finite() && *r > 0.0).map(f64::ln).collect();
        (logs.iter().sum::<f64>() / logs.len() as f64).exp()
    };
    let mean_width = |k: usize| sample.rows.iter().map(|row| row[k][2] - row[k][1]).sum::<f64>() / seeds;
    Cell {
        coverage: per_index.iter().sum::<f64>() / per_index.len() as f64,
        worst: per_index.iter().copied().fold(1.0, f64::min),
        width: geometric(&|k| mean_width(k) / (2.0 * 1.96 * ideal[k])),
        error: geometric(&|k| own[k] / ideal[k]),
    }
}

fn main() {
    let seeds = std::env::args().filter_map(|argument| argument.parse().ok()).next();
    let write = seeds.is_none();
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/background");
    if std::env::args().any(|argument| argument == "skewed") {
        let csv = skewed(seeds.unwrap_or(2 * SEEDS));
        std::fs::write(format!("{docs}/coverage-skewed.csv"), csv).expect("docs/ can be written");
        return;
    }
    let seeds = seeds.unwrap_or(SEEDS);
    let mut cells: BTreeMap<(usize, usize, u32), Cell> = BTreeMap::new();
    let names: Vec<&str> = KNOWN.into_iter().chain(UNSEEN).collect();
    let mut csv = String::from("function,method,base_samples,coverage,worst_index,width,error\n");
    for (f, name) in names.iter().enumerate() {
        let case = case(name);
        let exact: Vec<f64> = case
            .first
            .iter()
            .zip(&case.total)
            .filter(|(_, total)| **total > 1e-12)
            .flat_map(|(first, total)| [*first, *total])
            .collect();
        for m in SIZES {
            let one = sample(&case, METHODS[0], m, seeds);
            let ideal = spreads(&one);
            for (k, method) in METHODS.into_iter().enumerate() {
                let drawn = if k == 0 { None } else { Some(sample(&case, method, m, seeds)) };
                let cell = cell(drawn.as_ref().unwrap_or(&one), &exact, &ideal);
                let Cell { coverage, worst, width, error } = cell;
                let _ =
                    writeln!(csv, "{name},{},{},{coverage:.4},{worst:.4},{width:.3},{error:.3}", method.0, 1u64 << m);
                cells.insert((k, f, m), cell);
            }
        }
        let line: Vec<String> = SIZES
            .map(|m| {
                let Cell { coverage, worst, width, .. } = cells[&(DEFAULT, f, m)];
                format!("{coverage:.3} ({worst:.2}) {width:.2}")
            })
            .collect();
        println!("{name:18} {}", line.join("  "));
    }
    let table = tables(&names, &cells, seeds);
    println!("{table}");
    if write {
        std::fs::write(format!("{docs}/coverage.csv"), csv).expect("docs/ can be written");
        std::fs::write(format!("{docs}/coverage.md"), table).expect("docs/ can be written");
    }
}

fn tables(names: &[&str], cells: &BTreeMap<(usize, usize, u32), Cell>, seeds: u64) -> String {
    let mut text = format!(
        "# Do the intervals hold?\n\nWritten by `cargo bench --bench coverage`: {seeds} seeds, first-order and total indices of every active factor. \
         `coverage.csv` has every cell, and for each the index that is covered least.\n\n\
         Measured without surrogates, by the default formulas; coverage with surrogates is in \
         [functions that no constant was fitted to](../accuracy/functions.md).\n\n\
         **Coverage** of the nominal 95 % interval; **width** over the ideal, 2 x 1.96 x the true standard error of one net of the same \
         number of base samples N; **error**: true standard error of the estimate over that of one net. A share of {seeds} seeds has \
         a standard error of its own: {:.3} for one index, less for the mean over several.\n\nOutputs with rare, large values, on which \
         every interval is harder to get right, have [a page of their own](coverage-skewed.md), and so have [Shapley effects and measures of given data](coverage-measures.md).\n\n## All methods\n\nOver all functions and N = 2^8 .. 2^14: \
         mean, least and largest coverage of a cell (a function at an N), share of the cells within 92-98 %, geometric means of width and error.\n\n\
         | method | coverage | least | largest | within 92-98 % | width | error |\n|---|---|---|---|---|---|---|\n",
        (0.95f64 * 0.05 / seeds as f64).sqrt()
    );
    for (k, (name, ..)) in METHODS.iter().enumerate() {
        let all: Vec<&Cell> = cells.iter().filter(|((method, ..), _)| *method == k).map(|(_, cell)| cell).collect();
        let n = all.len() as f64;
        let mean = |of: fn(&Cell) -> f64| all.iter().map(|cell| of(cell)).sum::<f64>() / n;
        let least = all.iter().map(|cell| cell.coverage).fold(1.0, f64::min);
        let largest = all.iter().map(|cell| cell.coverage).fold(0.0, f64::max);
        let within = all.iter().filter(|cell| (0.92..=0.98).contains(&cell.coverage)).count() as f64 / n;
        let _ = writeln!(
            text,
            "| {name}{} | {:.3} | {least:.3} | {largest:.3} | {:.0} % | {:.2} | {:.2} |",
            if k == DEFAULT { " (default)" } else { "" },
            mean(|cell| cell.coverage),
            100.0 * within,
            mean(|cell| cell.width.ln()).exp(),
            mean(|cell| cell.error.ln()).exp()
        );
    }
    let _ = write!(
        text,
        "\n## The default, function by function\n\nCoverage / width. Functions below the line were not looked at when the constants of the method were chosen.\n\n| function |"
    );
    for m in SIZES {
        let _ = write!(text, " 2^{m} |");
    }
    let _ = writeln!(text, "\n|---|{}", "---|".repeat(SIZES.count()));
    for (f, name) in names.iter().enumerate() {
        if f == KNOWN.len() {
            let _ = writeln!(text, "| — |{}", " |".repeat(SIZES.count()));
        }
        let _ = write!(text, "| {name} |");
        for m in SIZES {
            let Cell { coverage, width, .. } = cells[&(DEFAULT, f, m)];
            let _ = write!(text, " {:.1} % / {width:.2} |", 100.0 * coverage);
        }
        text.push('\n');
    }
    text
}
