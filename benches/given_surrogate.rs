//! Given data by surrogates: how far the indices are from the truth, and how often their intervals hold it.
//!
//! For functions with known indices, tables of random and of Sobol' points, with the distributions of the inputs known and
//! unknown: root mean square errors of first-order and total indices, of ranks and of bins beside them, the coverage of the
//! 95 % intervals, and the share of the variance that the surrogates explain. `cargo bench --bench given_surrogate -- [SEEDS]`.

#[path = "../tests/suite/engine/points.rs"]
#[expect(dead_code, reason = "shared with the tests")]
mod points;

use std::time::Instant;

use apportion::Distribution;
use apportion::given::{Column, analyse, surrogate_indices};
use apportion::model::{KnownAnswer, KnownFunction};
use points::*;

#[derive(Default)]
struct Sums {
    tables: f64,
    cases: f64,
    serving: f64,
    explained: f64,
    squares: [f64; 4],
    held: [f64; 2],
    below: [f64; 2],
    widths: [f64; 2],
    seconds: f64,
    kinds: std::collections::BTreeMap<String, usize>,
}

fn measure(function: &KnownFunction, rows: usize, sample: Sample, known: bool, seeds: u64) -> Sums {
    let exact = function.exact().indices.expect("indices");
    let list = function.inputs();
    let distributions: Vec<Distribution> = list.iter().map(|input| input.distribution.clone()).collect();
    let mut sums = Sums::default();
    for seed in 0..seeds {
        let columns = sample(list.len(), rows, seed);
        let named = |(input, u): (&apportion::model::KnownInput, &Vec<f64>)| Column {
            name: input.name.clone(),
            values: u.iter().map(|u| input.distribution.quantile(*u)).collect(),
        };
        let inputs: Vec<Column> = list.iter().zip(&columns).map(named).collect();
        let y = |row: usize| function.value(&inputs.iter().map(|input| input.values[row]).collect::<Vec<f64>>());
        let output = [Column { name: "y".to_owned(), values: (0..rows).map(y).collect() }];
        let Ok(result) = analyse(&inputs, &output, 0) else { continue };
        let start = Instant::now();
        let Ok(surrogates) = surrogate_indices(&inputs, &output, &result, known.then_some(&distributions[..])) else {
            continue;
        };
        sums.seconds += start.elapsed().as_secs_f64();
        sums.tables += 1.0;
        let of = surrogates.outputs[0].as_ref().expect("variance");
        sums.serving += f64::from(of.serves);
        sums.explained += of.unknown.max(1e-16).ln();
        *sums.kinds.entry(of.polynomials_of.clone()).or_default() += 1;
        let others = result.outputs[0].indices.as_ref().expect("variance");
        for (j, index) in of.indices.iter().enumerate() {
            sums.cases += 1.0;
            for (k, (estimate, truth)) in
                [(index.first_order, exact.first_order[j]), (index.total, exact.total[j])].into_iter().enumerate()
            {
                let interval = estimate.interval.expect("an interval");
                sums.squares[k] += (estimate.estimate - truth).powi(2);
                sums.held[k] += f64::from(interval.low <= truth && truth <= interval.high);
                sums.below[k] += f64::from(truth < interval.low);
                sums.widths[k] += (interval.high - interval.low) / 2.0;
            }
            let rank = others[j].rank.map_or(f64::NAN, |rank| rank.estimate);
            let binned = others[j].binned.estimate.estimate;
            sums.squares[2] += (rank - exact.first_order[j]).powi(2);
            sums.squares[3] += (binned - exact.first_order[j]).powi(2);
        }
    }
    sums
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let seeds: u64 = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(20);
    let names: Vec<String> = match arguments.get(1) {
        Some(names) => names.split(',').map(str::to_owned).collect(),
        None => ["ishigami", "borehole", "flood", "sobol-g", "bratley"].map(str::to_owned).to_vec(),
    };
    let all_rows: Vec<usize> = match arguments.get(2) {
        Some(rows) => rows.split(',').map(|rows| rows.parse().expect("a number")).collect(),
        None => vec![200, 1000],
    };
    println!(
        "{seeds} seeds; errors of S and ST by surrogates, of S by ranks and bins; coverage and misses below of S and ST"
    );
    for name in &names {
        let function = KnownAnswer::from_name(name).expect("a function of the list").default_function();
        for &rows in &all_rows {
            for (kind, sample) in [("random", random as Sample), ("sobol", sobol)] {
                for known in [false, true] {
                    let s = measure(&function, rows, sample, known, seeds);
                    let error = |k: usize| (s.squares[k] / s.cases).sqrt();
                    println!(
                        "{name:10} {rows:5} {kind:6} {}  error {:.1e} {:.1e}  ranks {:.0e} bins {:.0e}  coverage {:.3} {:.3} \
                         below {:.3} {:.3}  half {:.1e} {:.1e}  left {:.1e}  serves {:.2}  {:.2} s  {:?}",
                        if known { "known  " } else { "unknown" },
                        error(0),
                        error(1),
                        error(2),
                        error(3),
                        s.held[0] / s.cases,
                        s.held[1] / s.cases,
                        s.below[0] / s.cases,
                        s.below[1] / s.cases,
                        s.widths[0] / s.cases,
                        s.widths[1] / s.cases,
                        (s.explained / s.tables).exp(),
                        s.serving / s.tables,
                        s.seconds / s.tables,
                        s.kinds,
                    );
                }
            }
        }
    }
}
