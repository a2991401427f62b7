//! The errors of indices by surrogates from the same few rows, ours and those of other programs.
//!
//! `cargo bench --bench surrogate -- FOLDER` writes into the folder, for 17 functions of known indices, tables of 64 to 500 rows of Latin
//! hypercubes, with what `given-data` makes of them (some five minutes on two cores). `tests/peers/surrogates.py FOLDER` gives
//! the same tables to OpenTURNS, and writes `docs/accuracy/surrogate.md`.

#[path = "../tests/suite/engine/points.rs"]
#[expect(dead_code, reason = "shared with the tests")]
mod points;

use std::path::Path;
use std::time::Instant;

use apportion::Study;
use apportion::given::{Column, analyse, surrogate_indices};
use apportion::model::{Batch, KnownAnswer, RunContext};
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Value, json};

const ROWS: [usize; 4] = [64, 100, 200, 500];
const SEEDS: u64 = 4;

/// Functions of the program; Ishigami's has few terms, the others are dense.
const MODELS: [&str; 11] = [
    "borehole",
    "otl-circuit",
    "piston",
    "wing-weight",
    "flood",
    "sobol-g",
    "g-star",
    "bratley",
    "morris",
    "oakley-ohagan",
    "ishigami",
];

/// A study with its exact indices.
#[derive(Deserialize)]
struct Function {
    name: String,
    /// Whether its expansion has many terms.
    dense: bool,
    study: String,
    first_order: Vec<f64>,
    total: Vec<f64>,
}

fn functions() -> Vec<Function> {
    let known = MODELS.into_iter().map(|name| {
        let exact = KnownAnswer::from_name(name).expect("a function of the list").default_function().exact();
        let indices = exact.indices.expect("indices");
        Function {
            name: name.to_owned(),
            dense: name != "ishigami",
            study: format!("model = \"{name}\"\n"),
            first_order: indices.first_order,
            total: indices.total,
        }
    });
    let others: Vec<Function> =
        serde_json::from_str(include_str!("surrogate_functions/studies.json")).expect("a list of studies");
    known.chain(others).collect()
}

/// Returns a table of some rows, and our indices.
fn table(function: &Function, study: &Study, rows: usize, seed: u64) -> Value {
    let factors = study.space().factors();
    let columns = points::latin(factors.len(), rows, seed);
    let inputs = factors.iter().zip(&columns).map(|(factor, u)| Column {
        name: factor.name.clone(),
        values: u.iter().map(|u| factor.distribution().quantile(*u)).collect(),
    });
    let inputs: Vec<Column> = inputs.collect();
    let model = study.model();
    let mut batch = Batch::new(model.as_ref());
    batch.reset(rows);
    let values: Vec<&[f64]> = inputs.iter().map(|input| &input.values[..]).collect();
    model.worker(&RunContext::default()).run(&values, &mut batch);
    let outputs = [Column { name: "y".to_owned(), values: batch.column(0).to_vec() }];

    let distributions: Vec<_> = factors.iter().map(|factor| factor.distribution().clone()).collect();
    let start = Instant::now();
    let given = analyse(&inputs, &outputs, 0).expect("indices");
    let surrogates = surrogate_indices(&inputs, &outputs, &given, Some(&distributions)).expect("surrogates");
    let seconds = start.elapsed().as_secs_f64();
    let indices = &surrogates.outputs[0].as_ref().expect("variance").indices;
    let of = |first: bool| -> Vec<_> {
        indices.iter().map(|index| if first { index.first_order } else { index.total }).collect()
    };
    json!({
        "function": function.name, "dense": function.dense, "rows": rows, "seed": seed, "distributions": distributions,
        "first_order": function.first_order, "total": function.total, "x": values, "y": outputs[0].values,
        "ours": { "first_order": of(true), "total": of(false), "seconds": seconds },
    })
}

fn main() {
    let folder = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let folder = folder.expect("a folder for the tables: cargo bench --bench surrogate -- FOLDER");
    std::fs::create_dir_all(&folder).expect("a folder");
    for function in functions() {
        let study = apportion_files::parse_study(&function.study, Path::new("function.toml"), &[]).expect("a study");
        for rows in ROWS {
            let tables = (1..=SEEDS).into_par_iter().map(|seed| table(&function, &study, rows, seed));
            let tables: Vec<Value> = tables.collect();
            let path = Path::new(&folder).join(format!("{}-{rows}.json", function.name));
            std::fs::write(&path, serde_json::to_string(&tables).expect("JSON")).expect("a table");
            println!("{}", path.display());
        }
    }
}
