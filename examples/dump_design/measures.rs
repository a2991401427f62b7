//! Measures of a table, with its rows.

use std::path::Path;

use apportion::Sampler;
use apportion::design::{Design, DesignSettings, Rows};
use apportion::given::{Column, Measure, analyse, measures};
use apportion_report::write_atomically;
use serde_json::{Map, Value, json};

use super::outputs::function;
use super::table;

/// Writes `given.csv`, rows of Ishigami's function at random points, and `measures.json`, what `given-data --measures` makes of them.
pub fn dump(folder: &Path) -> anyhow::Result<()> {
    let ishigami = function("ishigami");
    let settings =
        DesignSettings { sampler: Sampler::Random, base_samples: 500, replicates: 1, ..DesignSettings::default() };
    let design = Design::new(settings, 3, Rows::default())?;
    // A and B, which are independent of each other.
    let row = |number: u64| {
        let mut u = [0.0; 3];
        design.point(number, &mut u);
        let x: Vec<f64> = ishigami.inputs().iter().zip(u).map(|(input, u)| input.distribution.quantile(u)).collect();
        [&x[..], &[ishigami.value(&x)]].concat()
    };
    let rows: Vec<Vec<f64>> = (0..design.rows()).map(row).collect();
    let columns = ["x_1", "x_2", "x_3", "y"].into_iter().enumerate();
    let columns: Vec<Column> = columns
        .map(|(j, name)| Column { name: name.to_owned(), values: rows.iter().map(|row| row[j]).collect() })
        .collect();
    let named: Vec<(String, &[f64])> = columns.iter().map(|column| (column.name.clone(), &column.values[..])).collect();
    write_atomically(&folder.join("given.csv"), table(&named).as_bytes())?;
    let (inputs, outputs) = columns.split_at(3);
    let measured = measures(inputs, outputs, &analyse(inputs, outputs, 0)?, 0).remove(0)?;
    let of = |measure: Measure| {
        let found = || measured.iter().filter_map(|input| input.get(measure));
        let values: Vec<f64> = found().map(|found| found.estimate.estimate).collect();
        let p: Vec<Option<f64>> = found().map(|found| found.p_value).collect();
        (measure.name().to_owned(), json!({ "values": values, "p": p }))
    };
    let all: Map<String, Value> = Measure::ALL.into_iter().map(of).collect();
    Ok(write_atomically(
        &folder.join("measures.json"),
        serde_json::to_string_pretty(&json!({ "given": all }))?.as_bytes(),
    )?)
}
