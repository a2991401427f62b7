//! Designs, their outputs and what every estimator makes of them, as files for other programs to check.
//!
//! `cargo run --release --example dump_design -- FOLDER` writes, for each case, the inputs at A and B and the outputs of
//! all rows (`CASE.csv`, doubles in full), the indices by every estimator (`indices.json`), and points of the Sobol'
//! sequence without scrambling (`sobol-FIRST.csv`); and tables with the measures made of them (`given.csv`, `shapley.csv`,
//! `measures.json`). `tests/peers/check.py` reads them.

#[path = "../benches/outputs/mod.rs"]
mod outputs;

#[path = "dump_design/measures.rs"]
mod measures;

use std::path::Path;

use apportion::estimate::{Moments, Workspace, second_order};
use apportion::{DesignSettings, FirstOrder, Sampler, SobolSequence, Total};
use apportion_report::{prepare_folder, write_atomically};
use outputs::{Outputs, design, function, inputs};
use serde_json::{Map, Value, json};

/// A function at the points of a design, and a constant added to its values.
struct Case {
    name: &'static str,
    function: &'static str,
    sampler: Sampler,
    base_samples: u64,
    offset: f64,
}

const CASES: [Case; 5] = [
    Case { name: "ishigami", function: "ishigami", sampler: Sampler::Sobol, base_samples: 1024, offset: 0.0 },
    Case { name: "sobol-g", function: "sobol-g", sampler: Sampler::Sobol, base_samples: 1024, offset: 0.0 },
    Case { name: "sobol-g-offset", function: "sobol-g", sampler: Sampler::Sobol, base_samples: 512, offset: 100.0 },
    Case { name: "sobol-g-random", function: "sobol-g", sampler: Sampler::Random, base_samples: 1000, offset: 0.0 },
    Case { name: "steps", function: "steps", sampler: Sampler::LatinHypercube, base_samples: 777, offset: 0.0 },
];

/// Where the plain sequence is looked at: first point, points, dimensions.
const STRETCHES: [(u64, usize, usize); 2] = [(0, 512, 400), (1_000_000, 256, 20)];

fn table(columns: &[(String, &[f64])]) -> String {
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let mut text = names.join(",") + "\n";
    for i in 0..columns[0].1.len() {
        let row: Vec<String> = columns.iter().map(|(_, column)| format!("{:e}", column[i])).collect();
        text += &(row.join(",") + "\n");
    }
    text
}

fn indices(moments: &Moments) -> Value {
    let of_swaps = |estimate: &dyn Fn(usize) -> f64| json!((0..moments.swaps()).map(estimate).collect::<Vec<_>>());
    let first: Map<_, _> =
        FirstOrder::ALL.into_iter().map(|e| (e.name().into(), of_swaps(&|j| e.estimate(moments, j)))).collect();
    let total: Map<_, _> =
        Total::ALL.into_iter().map(|e| (e.name().into(), of_swaps(&|j| e.estimate(moments, j)))).collect();
    let swaps = moments.pairs().map_or(&[][..], |pairs| pairs.swaps());
    let pairs = swaps.iter().flat_map(|&j| swaps.iter().filter(move |k| **k > j).map(move |&k| (j, k)));
    let second: Vec<_> = pairs.map(|(j, k)| json!([j, k, second_order(moments, j, k)])).collect();
    json!({ "first_order": first, "total": total, "second_order": second })
}

/// Writes the table of a case and returns its indices.
fn dump(case: &Case, folder: &Path) -> anyhow::Result<Value> {
    let Case { sampler, base_samples, .. } = *case;
    let function = function(case.function);
    let d = function.inputs().len();
    let design = design(DesignSettings { sampler, base_samples, replicates: 1, seed: 1 }, d, true);
    let mut outputs = Outputs::of(&function, &design);
    outputs.runs.iter_mut().flatten().for_each(|y| *y += case.offset);
    let (inputs, mut columns) = (inputs(&function, &design), Vec::<(String, &[f64])>::new());
    for (matrix, inputs) in ["A", "B"].iter().zip(inputs.chunks(d)) {
        columns.extend(inputs.iter().enumerate().map(|(j, column)| (format!("x_{matrix}_{}", j + 1), &column[..])));
    }
    columns.extend(["y_A", "y_B"].iter().zip(&outputs.runs).map(|(name, run)| ((*name).to_owned(), &run[..])));
    let rows = [("AB", design.ab_runs()), ("BA", design.ba_runs())];
    for (row, runs) in rows {
        columns.extend(runs.iter().enumerate().map(|(j, &run)| (format!("y_{row}_{}", j + 1), &outputs.runs[run][..])));
    }
    write_atomically(&folder.join(format!("{}.csv", case.name)), table(&columns).as_bytes())?;
    let indices = indices(&outputs.moments(0..base_samples as usize, &mut Workspace::default()));
    Ok(json!({ "function": case.function, "factors": d, "offset": case.offset, "indices": indices }))
}

fn main() -> anyhow::Result<()> {
    let Some(folder) = std::env::args_os().nth(1) else { anyhow::bail!("usage: dump_design FOLDER") };
    let folder = Path::new(&folder);
    prepare_folder(folder)?;
    let mut all = Map::new();
    for case in &CASES {
        all.insert(case.name.to_owned(), dump(case, folder)?);
    }
    write_atomically(&folder.join("indices.json"), serde_json::to_string_pretty(&all)?.as_bytes())?;
    measures::dump(folder)?;
    for (first, points, dimensions) in STRETCHES {
        let sequence = SobolSequence::plain(dimensions);
        let mut columns = vec![vec![0.0; points]; dimensions];
        columns.iter_mut().enumerate().for_each(|(dimension, column)| sequence.fill(dimension, first, column));
        let named: Vec<_> =
            columns.iter().enumerate().map(|(j, column)| (format!("u_{}", j + 1), &column[..])).collect();
        write_atomically(&folder.join(format!("sobol-{first}.csv")), table(&named).as_bytes())?;
    }
    Ok(())
}
