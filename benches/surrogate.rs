//! What surrogates do for the indices: errors and coverage, plain and corrected, at equal runs.
//!
//! `cargo bench --bench surrogate` measures all of it and writes `docs/accuracy/surrogate.csv` and
//! `docs/accuracy/surrogate.md` (some fifty minutes on two cores). `cargo bench --bench surrogate -- 40 64,256
//! ishigami,borehole` takes 40 seeds, those sizes and functions, and writes nothing; with `write` as a fourth argument their
//! rows take the place of those in the table, function by function, and the others stay (`all` stands for every function);
//! `cargo bench --bench surrogate -- draw` measures nothing, and writes the page and its chart from the table.
//!
//! The plain indices are today's default ones without surrogates. Those of before are of four nets by the formulas of Saltelli
//! (2010) and Jansen, those of one net are what other programs do, and those of a split design have the same number of runs.

mod surrogate_charts;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use apportion::model::KnownAnswer;
use apportion::{Estimate, OutputResult};
use rayon::prelude::*;

/// Base samples in all.
const SIZES: [u64; 5] = [16, 64, 256, 1024, 4096];
const SEEDS: u64 = 200;

/// Base samples up to which split designs of as many runs are measured.
const MOST_SPLIT: u64 = 64;

/// Smooth functions: errors fall by orders of magnitude.
const SMOOTH: [&str; 9] =
    ["ishigami", "borehole", "wing-weight", "otl-circuit", "piston", "flood", "bratley", "sobol-levitan", PRODUCT_FORM];
/// Kinks, steps, many factors.
const ROUGH: [&str; 12] = [
    "kinks",
    "sum of kinks",
    "floors",
    "switch",
    "normal kink",
    "sobol-g",
    "g-star",
    "steps",
    "minimum",
    "simplex",
    "morris",
    "oakley-ohagan",
];
/// Rare, large outputs, and one of 0 and 1.
const SKEWED: [&str; 4] = ["sobol-g, a = 0", "log-normal product", "rare corner", "0 and 1"];
const KINDS: [(&str, &[&str]); 3] = [("smooth", &SMOOTH), ("rough", &ROUGH), ("skewed", &SKEWED)];
const PRODUCT_FORM: &str = "afm product form";

/// Functions with steps and kinks, with the gains of first-order and total indices over one net by polynomials alone at 1024.
const POLYNOMIALS_ALONE: &[(&str, &str)] = &[
    ("kinks", "9.8, 7.6"),
    ("sum of kinks", "6.9, 5.8"),
    ("normal kink", "-"),
    ("sobol-g", "6.0, 6.1"),
    ("g-star", "4.3, 6.3"),
    ("floors", "2.9, 2.5"),
    ("switch", "2.4, 1.4"),
    ("steps", "3.1, 3.1"),
    ("minimum", "10.6, 7.2"),
    ("simplex", "3.3, 2.4"),
    ("0 and 1", "3.1, 2.0"),
];

const TRIED: &str = "
Served: where polynomials leave more than 1e-4 of the variance, what they leave is averaged in bins of every factor. A step and a hinge
that take significantly more of it than chance would (F ratio 10) join the functions of the factor, at most at four places, orthonormal under its distribution; all terms are then chosen anew, \
and again with every step between the two values drawn where the residuals of the rows near it say, and every kink where the \
step beside its hinge vanishes. This takes the place of the polynomials only if it leaves less than .9 of what they leave. Where it is not taken, all bits are those of polynomials. \
 A fit with knots takes 1.7 to 2.9 times as long, and one of an output without them up to 1.4 times (a few tens of milliseconds at N = 1024).

- A step on a grid of bins alone: the rest falls 20 times, errors only 2 times, since what is left lies in strips that no net resolves. The refined place gives the rest.
- No term for the place of a knot in the interval: coverage .4 to .7 where the fit is exact. It counts as uniform over its width.
- Fewer polynomials beside the bins (degree 6): fewer kinks found, errors up to twice as large. Knots nearer than .04: mostly one that lies beside the edge of a bin.
- The fitted profile of a factor as its first function, so that products are one term: 1.5 times smaller errors for g-star, the others level or worse.
- Choosing terms from all candidates again after the places are refined: level, at twice the time.
- Kinks and steps along no axis (minimum, simplex, 0 and 1) are not met by any of this, nor those with few runs (N = 64): there polynomials remain. Steps gain 5 to 30 times over one net from N = 256 on, kinks 10 to 1000 times.
";

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
        let text = format!("model = \"expression\"\n[outputs]\ny = \"{text}\"\n{factors}");
        Case { text, first, total }
    };
    // Mean and variance of |x - t|.
    let distance = |t: f64| {
        let mean = (t * t + (1.0 - t).powi(2)) / 2.0;
        [mean, (t.powi(3) + (1.0 - t).powi(3)) / 3.0 - mean * mean]
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
            let text = format!("model = \"expression\"\n[outputs]\ny = \"{text}\"\n{factors}");
            Case { text, first, total }
        }
        "kinks" => {
            let text = "(.2+abs(x1-.3))*(.2+abs(x2-.55))*(.2+abs(x3-.72))*(.2+abs(x4-.13))";
            let part = |t: f64| distance(t)[1] / (0.2 + distance(t)[0]).powi(2);
            formula(text, 4, uniform, product(&[0.3, 0.55, 0.72, 0.13].map(part)))
        }
        "sum of kinks" => {
            let parts = [distance(0.3)[1], 0.25 * distance(0.61)[1], 0.01 / 48.0, 0.01 / 48.0];
            let both = [0.0, 0.0, 0.01 / 144.0, 0.01 / 144.0];
            let variance = parts.iter().sum::<f64>() + both[2];
            let first = parts.iter().map(|v| v / variance).collect();
            let total = parts.iter().zip(both).map(|(v, b)| (v + b) / variance).collect();
            formula("abs(x1-.3)+.5*abs(x2-.61)+.1*x3*x4", 4, uniform, (first, total))
        }
        "floors" => formula("floor(5*x1)*(1+x2)*(1+floor(4*x3))", 3, uniform, product(&[0.5, 1.0 / 27.0, 0.2])),
        "switch" => {
            // b (3 x2 - x2^2) + x2^2 + x3 with b = 0 or 1, 1 of the probability .63: a product and a sum of polynomials.
            let (p, of_square): (f64, fn(f64, f64) -> f64) =
                (0.63, |a, b| a * a / 12.0 + b * b * 4.0 / 45.0 + a * b / 6.0);
            let parts = [p * (1.0 - p) * (7.0f64 / 6.0).powi(2), of_square(3.0 * p, 1.0 - p), 1.0 / 12.0];
            let both = [1.0, 1.0, 0.0].map(|has| has * p * (1.0 - p) * of_square(3.0, -1.0));
            let variance = parts.iter().sum::<f64>() + both[0];
            let first = parts.iter().map(|v| v / variance).collect();
            let total = parts.iter().zip(both).map(|(v, b)| (v + b) / variance).collect();
            formula("if(x1>.37,3*x2,x2^2)+x3", 3, uniform, (first, total))
        }
        "normal kink" => formula("(1+max(x1-.5,0))*(2+x2)", 2, normal, product(&[0.118_849_801_240_673_3, 0.25])),
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
    intervals: f64,
    count: f64,
}

impl Errors {
    fn add(&mut self, estimates: impl Iterator<Item = (Estimate, f64)>) {
        for (Estimate { estimate, interval }, exact) in estimates {
            self.square += (estimate - exact).powi(2);
            self.count += 1.0;
            // Few rows of rare outputs may have none.
            if let Some(interval) = interval {
                // Exact answers are known to some 1e-9 where they come by quadrature.
                self.within += f64::from(u8::from(interval.low - 1e-8 <= exact && exact <= interval.high + 1e-8));
                self.width += interval.high - interval.low;
                self.intervals += 1.0;
            }
        }
    }

    fn rmse(&self) -> f64 {
        (self.square / self.count).sqrt()
    }

    fn coverage(&self) -> f64 {
        self.within / self.intervals
    }

    /// Mean width over that of an interval made from the true error.
    fn relative_width(&self) -> f64 {
        self.width / self.intervals / (2.0 * 1.96 * self.rmse())
    }

    fn merged(self, other: Self) -> Self {
        Self {
            square: self.square + other.square,
            within: self.within + other.within,
            width: self.width + other.width,
            intervals: self.intervals + other.intervals,
            count: self.count + other.count,
        }
    }
}

/// The columns of the table.
const METHODS: [&str; 5] = ["corrected", "split", "plain", "before", "one_net"];

/// First-order and total indices by every method.
type Row = [[Errors; 2]; METHODS.len()];

fn measured(case: &Case, size: u64, seeds: u64) -> (Row, f64, f64) {
    let run = |seed: u64, more: &[&str]| {
        let seed = format!("design.seed={}", 1000 + seed);
        let overrides = more.iter().copied().chain([&seed[..], "analysis.convergence=false"]);
        let overrides: Vec<String> = overrides.map(str::to_owned).collect();
        let study = apportion_files::parse_study(&case.text, Path::new("case.toml"), &overrides).expect("a study");
        let result = study.runner().threads(1).run().expect("a result");
        // Of rare events all rows of a few may be alike.
        result.outputs[0].indices.is_some().then(|| result.outputs[0].clone())
    };
    let base_samples = format!("design.base_samples={size}");
    let budget = format!("design.runs={}", size * (2 + case.first.len() as u64));
    let (off, others) = ("analysis.surrogate=\"off\"", "analysis.estimators=[\"saltelli-2010\", \"jansen\"]");
    let of_seed = |seed: u64| {
        let mut row = Row::default();
        let mut add = |method: usize, of: &dyn Fn(usize) -> [Estimate; 2]| {
            let factors = 0..case.first.len();
            row[method][0].add(factors.clone().map(|k| (of(k)[0], case.first[k])));
            row[method][1].add(factors.map(|k| (of(k)[1], case.total[k])));
        };
        let default = |output: &OutputResult, k: usize| {
            let effect = output.indices.as_ref().expect("indices")[k].effect;
            [effect.first_order, effect.total]
        };
        // By the formulas of Saltelli and of Jansen.
        let before = |output: &OutputResult, k: usize| {
            let by = |estimator: usize| &output.estimators[estimator].indices[k];
            [by(0).effect.first_order, by(1).effect.total].map(|estimate| estimate.expect("an estimate"))
        };
        let mut used = (0.0, 0.0);
        if let Some(corrected) = run(seed, &[&base_samples, "analysis.surrogate=\"on\""]) {
            add(0, &|k| default(&corrected, k));
            if let Some(surrogate) = corrected.surrogate {
                used = (surrogate.explained, f64::from(u8::from(surrogate.corrects_first_order)));
            }
        }
        if let Some(split) = (size <= MOST_SPLIT).then(|| run(seed, &[&budget])).flatten() {
            add(1, &|k| default(&split, k));
        }
        if let Some(plain) = run(seed, &[&base_samples, off, others]) {
            add(2, &|k| default(&plain, k));
            add(3, &|k| before(&plain, k));
        }
        if let Some(single) = run(seed, &[&base_samples, "design.replicates=1", others]) {
            add(4, &|k| before(&single, k));
        }
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

/// One row of the table: a function, a size and a kind of index, by every method.
struct Cell {
    kind: String,
    function: String,
    size: u64,
    seeds: u64,
    index: String,
    rmse: [f64; METHODS.len()],
    coverage: [f64; METHODS.len()],
    width: [f64; METHODS.len()],
    explained: f64,
    used: f64,
}

impl Cell {
    fn header() -> String {
        let columns = |what: &str| METHODS.map(|method| format!("{what}_{method}")).join(",");
        let [rmse, coverage, width] = ["rmse", "coverage", "width"].map(columns);
        format!("kind,function,base_samples,seeds,index,{rmse},{coverage},{width},explained,used\n")
    }

    fn to_line(&self) -> String {
        let Self { kind, function, size, seeds, index, explained, used, .. } = self;
        let rmse = self.rmse.map(|value| format!("{value:.3e}")).join(",");
        let coverage = self.coverage.map(|value| format!("{value:.4}")).join(",");
        let width = self.width.map(|value| format!("{value:.3}")).join(",");
        format!("{kind},\"{function}\",{size},{seeds},{index},{rmse},{coverage},{width},{explained:.5},{used:.3}\n")
    }

    fn from_record(record: &csv::StringRecord) -> Self {
        let number = |place: usize| record[place].parse::<f64>().expect("a number");
        let methods = |place: usize| std::array::from_fn(|method| number(5 + place * METHODS.len() + method));
        let last = 5 + 3 * METHODS.len();
        Self {
            kind: record[0].to_owned(),
            function: record[1].to_owned(),
            size: number(2) as u64,
            seeds: number(3) as u64,
            index: record[4].to_owned(),
            rmse: methods(0),
            coverage: methods(1),
            width: methods(2),
            explained: number(last),
            used: number(last + 1),
        }
    }
}

/// The rows of the table as it was written before; none if it is not there.
fn written_before(path: &Path) -> Vec<Cell> {
    let Ok(mut reader) = csv::Reader::from_path(path) else { return Vec::new() };
    reader.records().map(|record| Cell::from_record(&record.expect("a row"))).collect()
}

/// First-order and total indices of one function at one size.
fn measured_cells(kind: &str, function: &str, size: u64, seeds: u64) -> [Cell; 2] {
    let (row, explained, used) = measured(&case(function), size, seeds);
    [("S", 0), ("ST", 1)].map(|(index, place)| {
        let of = row.map(|errors| errors[place]);
        Cell {
            kind: kind.to_owned(),
            function: function.to_owned(),
            size,
            seeds,
            index: index.to_owned(),
            rmse: of.map(|errors| errors.rmse()),
            coverage: of.map(|errors| errors.coverage()),
            width: of.map(|errors| errors.relative_width()),
            explained,
            used,
        }
    })
}

/// Geometric mean and least of some gains.
fn mean_and_least(gains: &[f64]) -> String {
    if gains.iter().any(|gain| !gain.is_finite()) || gains.is_empty() {
        return "-".to_owned();
    }
    let mean = (gains.iter().map(|gain| gain.ln()).sum::<f64>() / gains.len() as f64).exp();
    let least = gains.iter().copied().fold(f64::INFINITY, f64::min);
    format!("{mean:.2}, {least:.2}")
}

/// How many coverages are below .92, from .92 to .98, and above.
fn counts(coverages: &[f64]) -> String {
    let count = |fits: fn(f64) -> bool| coverages.iter().filter(|coverage| fits(**coverage)).count().to_string();
    [count(|c| c < 0.92), count(|c| (0.92..=0.98).contains(&c)), count(|c| c > 0.98)].join(", ")
}

/// Gains by kind of function and size, and coverages by size.
fn summary(cells: &[Cell]) -> String {
    let mut text = "# Indices corrected by surrogates\n\nRoot mean square errors of all first-order and total indices at equal \
                    runs, N base samples in all: how many times smaller with surrogates than those of the default of before \
                    (four nets, formulas of Saltelli 2010 and Jansen 1999), and than those of a single Saltelli net by the \
                    same formulas, as other programs do it; and how many times smaller again with a split design \
                    (`runs`) of as many runs. Every function with its errors, and the coverage and relative width of \
                    its 95 % intervals, is in [surrogate.csv](surrogate.csv) (`plain`: today's default without surrogates). Written by \
                    `cargo bench --bench surrogate`.\n\n\
                    | functions | N | seeds | gain over the default of before: geometric mean, least | over one net | of a split design |\n\
                    |---|---|---|---|---|---|\n"
        .to_owned();
    let sizes: BTreeSet<u64> = cells.iter().map(|cell| cell.size).collect();
    for (kind, functions) in KINDS {
        for &size in &sizes {
            let here = || cells.iter().filter(|cell| cell.kind == kind && cell.size == size);
            let Some(seeds) = here().map(|cell| cell.seeds).min() else { continue };
            let gains = |of: fn(&[f64; METHODS.len()]) -> f64| {
                mean_and_least(&here().map(|cell| of(&cell.rmse)).collect::<Vec<_>>())
            };
            let [before, one, split] =
                [gains(|rmse| rmse[3] / rmse[0]), gains(|rmse| rmse[4] / rmse[0]), gains(|rmse| rmse[0] / rmse[1])];
            // Two kinds of indices each.
            let (measured, all) = (here().count() / 2, functions.len());
            let part = if measured < all { format!(" ({measured} of {all})") } else { String::new() };
            let _ = writeln!(text, "| {kind}{part} | {size} | {seeds} | {before} | {one} | {split} |");
        }
    }
    text.push_str(
        "\nCoverage of the 95 % intervals: cells (function and kind of index) below .92, from .92 to .98, and above; with \
         surrogates, and without. Beyond that range intervals with surrogates are mostly too careful; the last column \
         counts the cells whose intervals are more than 1.5 times as wide, in the mean, as intervals made from the true \
         error.\n\n| N | with | without | wider than 1.5 |\n|---|---|---|---|\n",
    );
    for size in sizes {
        let here = || cells.iter().filter(|cell| cell.size == size);
        let coverages = |method: usize| counts(&here().map(|cell| cell.coverage[method]).collect::<Vec<_>>());
        let wide = here().filter(|cell| cell.width[0] > 1.5).count();
        let _ = writeln!(text, "| {size} | {} | {} | {wide} |", coverages(0), coverages(2));
    }
    let below = |cell: &&Cell| cell.coverage[0] < 0.92;
    let named = |cell: &Cell| {
        let Cell { function, index, size, coverage, .. } = cell;
        format!("{function}, {index} at {size} ({:.2})", coverage[0])
    };
    let missed: Vec<String> = cells.iter().filter(below).map(named).collect();
    let _ = writeln!(text, "\nBelow .92 with surrogates are: {}.", missed.join("; "));
    text.push_str(
        "\nA split design may lose against plain indices of as many runs, where most of the variance is left to its few base \
         samples (`rmse_split` against `rmse_plain` in the table).\n",
    );
    text.push_str("\n![Errors with surrogates, and without](surrogate.svg)\n");
    text.push_str(&rough_functions(cells));
    text
}

/// What steps and kinks among the polynomials gain, and what else was tried.
fn rough_functions(cells: &[Cell]) -> String {
    let sizes = &SIZES[1..];
    let mut text = "\n## Rough functions: what was tried\n\nHow many times smaller errors are than those of one net of as many runs, \
                    first-order and total indices; and the same at N = 1024 with polynomials alone (20 seeds).\n\n"
        .to_owned();
    let columns: String = sizes.iter().map(|size| format!(" N = {size} |")).collect();
    let _ = writeln!(text, "| function |{columns} polynomials |\n|---|{}", "---|".repeat(sizes.len() + 1));
    for (function, alone) in POLYNOMIALS_ALONE {
        let gain = |size: u64, index: &str| {
            let cell = |cell: &&Cell| cell.function == *function && cell.size == size && cell.index == index;
            cells.iter().find(cell).map_or_else(|| "-".to_owned(), |cell| format!("{:.2}", cell.rmse[4] / cell.rmse[0]))
        };
        let gains: String = sizes.iter().map(|&size| format!(" {}, {} |", gain(size, "S"), gain(size, "ST"))).collect();
        let _ = writeln!(text, "| {function} |{gains} {alone} |");
    }
    text.push_str(TRIED);
    text
}

/// Writes the table, the page and its chart.
fn write(folder: &Path, cells: &[Cell]) {
    std::fs::create_dir_all(folder).expect("a folder");
    let lines: String = cells.iter().map(Cell::to_line).collect();
    let texts = [("surrogate.csv", Cell::header() + &lines), ("surrogate.md", summary(cells))];
    let texts = texts.into_iter().map(|(name, text)| (name, text.into_bytes()));
    for (name, bytes) in texts.chain([surrogate_charts::file(cells)]) {
        std::fs::write(folder.join(name), bytes).expect("a file");
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|text| text != "--bench").collect();
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/accuracy");
    let table = folder.join("surrogate.csv");
    if arguments.first().is_some_and(|word| word == "draw") {
        write(&folder, &written_before(&table));
        return;
    }
    let seeds: Option<u64> = arguments.first().and_then(|text| text.parse().ok());
    let sizes: Vec<(u64, u64)> = match arguments.get(1) {
        None => SIZES.iter().map(|size| (*size, seeds.unwrap_or(SEEDS))).collect(),
        Some(list) => list.split(',').map(|size| (size.parse().expect("a size"), seeds.unwrap_or(40))).collect(),
    };
    let is_asked = |name: &str| {
        arguments.get(2).is_none_or(|list| list == "all" || list == name || list.split(',').any(|n| n == name))
    };
    let writes = arguments.is_empty() || arguments.get(3).is_some_and(|word| word == "write");
    let mut cells = if arguments.len() == 4 { written_before(&table) } else { Vec::new() };
    let order: Vec<&str> = KINDS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
    for (kind, name) in KINDS.iter().flat_map(|(kind, names)| names.iter().map(move |name| (kind, name))) {
        for &size in sizes.iter().filter(|_| is_asked(name)) {
            cells.retain(|cell| !(cell.function == *name && cell.size == size.0));
            for cell in measured_cells(kind, name, size.0, size.1) {
                print!("{}", cell.to_line());
                cells.push(cell);
            }
        }
        if writes {
            let place = |cell: &Cell| (order.iter().position(|name| **name == cell.function), cell.size);
            cells.sort_by_key(place);
            write(&folder, &cells);
        }
    }
    println!("{}", summary(&cells));
}
