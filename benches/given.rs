//! Given data: do the intervals hold, is every quasi-random table found, is no independent one refused?
//!
//! Coverage of the 95 % intervals and root mean square error of both estimators, averaged over the inputs, over many
//! seeds; then the share of tables taken for quasi-random or refused, by kind of points; then the time an analysis takes.
//! `-- coverage 40` prints the table of `docs/guide/existing-runs.md` alone, of 40 seeds.

mod given_coverage;
#[path = "../tests/suite/engine/points.rs"]
mod points;

use std::time::Instant;

use apportion::design::Sampler;
use apportion::given::{Column, PointSet, analyse};
use apportion::model::KnownAnswer;
use points::*;

const SEEDS: u64 = 400;

type Function = dyn Fn(&[f64]) -> f64;

/// A function with its exact first-order indices.
struct Case {
    name: &'static str,
    exact: Vec<f64>,
    value: Box<Function>,
}

fn cases() -> Vec<Case> {
    let known = |name: &'static str| {
        let function = KnownAnswer::from_name(name).expect("a function of the list").default_function();
        let exact = function.exact().indices.expect("indices").first_order;
        let inputs = function.inputs().to_vec();
        let value = move |u: &[f64]| {
            let x: Vec<f64> = inputs.iter().zip(u).map(|(i, u)| i.distribution.quantile(*u)).collect();
            function.value(&x)
        };
        Case { name, exact, value: Box::new(value) }
    };
    let linear = Case {
        name: "linear",
        exact: [9.0, 4.0, 1.0, 0.0].map(|v| v / 14.0).to_vec(),
        value: Box::new(|u| 3.0 * u[0] + 2.0 * u[1] + u[2]),
    };
    vec![known("ishigami"), known("sobol-g"), linear]
}

fn named(columns: Columns) -> Vec<Column> {
    columns.into_iter().enumerate().map(|(j, values)| Column { name: format!("x{j}"), values }).collect()
}

fn evaluated(case: &Case, columns: &Columns) -> Column {
    let row = |k: usize| columns.iter().map(|column| column[k]).collect::<Vec<f64>>();
    Column { name: "y".to_owned(), values: (0..columns[0].len()).map(|k| (case.value)(&row(k))).collect() }
}

fn coverage(case: &Case, rows: usize, sample: Sample) {
    let (mut held, mut squares, mut widths, mut count) = ([0.0; 2], [0.0; 2], [0.0; 2], 0.0);
    for seed in 0..SEEDS {
        let columns = sample(case.exact.len(), rows, seed);
        let y = evaluated(case, &columns);
        let Ok(result) = analyse(&named(columns), &[y], 0) else { continue };
        for (index, exact) in result.outputs[0].indices.iter().flatten().zip(&case.exact) {
            count += 1.0;
            let estimates = [index.rank, Some(index.binned.estimate)];
            for (k, estimate) in estimates.into_iter().enumerate() {
                let Some((estimate, interval)) = estimate.and_then(|e| Some((e.estimate, e.interval?))) else {
                    continue;
                };
                held[k] += f64::from(interval.low <= *exact && *exact <= interval.high);
                squares[k] += (estimate - exact).powi(2);
                widths[k] += (interval.high - interval.low) / 2.0;
            }
        }
    }
    for (k, method) in ["rank", "binned"].into_iter().enumerate() {
        println!(
            "  {:9} {rows:5} {method:6}   coverage {:.3}   error {:.1e}   half width {:.1e}",
            case.name,
            held[k] / count,
            (squares[k] / count).sqrt(),
            widths[k] / count
        );
    }
}

/// Tables of a kind that are not taken for independent draws.
fn refused(tables: u64, table: impl Fn(u64) -> Columns) -> u64 {
    let independent = |seed: &u64| {
        let columns = table(*seed);
        let y = Column { name: "y".to_owned(), values: columns[0].clone() };
        analyse(&named(columns), &[y], 0).is_ok_and(|result| result.points == PointSet::Independent)
    };
    tables - (0..tables).filter(independent).count() as u64
}

fn detection() {
    println!("tables that are refused, or taken for quasi-random, of 1000 (independent kinds: of 20000):");
    let kinds: [(&str, Sample, u64); 7] = [
        ("random", random, 20_000),
        ("latin", latin, 20_000),
        ("sobol", sobol, 1000),
        ("sobol-plain", sobol_plain, 1),
        ("halton", halton, 1000),
        ("kronecker", kronecker, 1000),
        ("lattice", lattice, 1000),
    ];
    for (name, kind, tables) in kinds {
        for (d, n) in [(1, 100), (2, 32), (2, 64), (2, 100), (3, 100), (3, 256), (8, 256), (8, 1000)] {
            let in_order = refused(tables, |seed| kind(d, n, seed));
            let mixed = refused(tables.min(1000), |seed| shuffled(kind(d, n, seed), seed));
            println!(
                "  {name:12} {d} inputs {n:5} rows   {in_order:5} of {tables}   rows shuffled {mixed:5} of {}",
                tables.min(1000)
            );
        }
    }
    for levels in [4.0, 20.0, 100.0, 1000.0] {
        let rounded =
            |seed| random(3, 100, seed).into_iter().map(|c| c.iter().map(|u| (u * levels).floor()).collect()).collect();
        println!("  random, 3 inputs of {levels} levels, 100 rows   {} of 20000", refused(20_000, rounded));
    }
    println!("  trajectories, 4 inputs of 4 levels   {} of 1000", refused(1000, |seed| trajectories(4, 10, 4, seed)));
    println!("  grid, 3 inputs of 5 levels, shuffled   {} of 1000", refused(1000, |seed| shuffled(grid(3, 5), seed)));
    for d in [2, 3, 8] {
        let refused = refused(1000, |seed| shuffled(saltelli(d, 16, Sampler::Random, seed), seed));
        println!("  saltelli of 16 base points, {d} inputs   {refused} of 1000");
    }
}

fn main() {
    if std::env::args().any(|argument| argument == "coverage") {
        let seeds = std::env::args().find_map(|argument| argument.parse().ok());
        return println!("{}", given_coverage::table(seeds.unwrap_or(40)));
    }
    println!("function, rows, estimator; {SEEDS} seeds:");
    for case in cases() {
        for rows in [30, 100, 300, 1000, 10_000] {
            coverage(&case, rows, random);
        }
    }
    println!("the same on Latin hypercubes:");
    for case in cases() {
        coverage(&case, 1000, latin);
    }
    detection();
    let case = &cases()[1];
    for rows in [10_000, 100_000, 1_000_000] {
        let columns = random(8, rows, 0);
        let y = evaluated(case, &columns);
        let inputs = named(columns);
        let start = Instant::now();
        let result = analyse(&inputs, &[y], 0);
        println!(
            "8 inputs, {rows} rows: {:.3} s, {}",
            start.elapsed().as_secs_f64(),
            if result.is_ok() { "done" } else { "refused" }
        );
    }
}
