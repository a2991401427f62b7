//! Measures of a table and Shapley effects along random orders, with the rows that they come from.

use std::path::Path;

use apportion::given::{Column, Measure, analyse, measures};
use apportion::{AnalysisOptions, Sampler, ShapleyMethod, Study, SurrogateChoice, function_model};
use apportion_report::write_atomically;
use serde_json::{Value, json};

use super::outputs::function;
use super::table;

const NAME: &str = "ishigami";

/// A study of Ishigami's function.
fn study(sampler: Sampler, base_samples: u64) -> anyhow::Result<Study> {
    let ishigami = function(NAME);
    let inputs = ishigami.inputs().to_vec();
    let model = function_model("y", move |x: &[f64]| ishigami.value(x));
    let options = AnalysisOptions {
        shapley_method: Some(ShapleyMethod::Permutations),
        surrogate: SurrogateChoice::Off,
        ..AnalysisOptions::for_sampler(sampler)
    };
    let builder = Study::builder(NAME, model).sampler(sampler).base_samples(base_samples).replicates(1);
    let builder = inputs.into_iter().fold(builder, |builder, input| builder.factor(&input.name, input.distribution));
    Ok(builder.analysis(options).build()?)
}

/// Some rows of the design of `study`, by their numbers.
fn rows(study: &Study, numbers: impl Iterator<Item = u64>) -> Vec<Vec<f64>> {
    let ishigami = function(NAME);
    let row = |number: u64| {
        let mut u = [0.0; 3];
        study.design().point(number, &mut u);
        let x: Vec<f64> = ishigami.inputs().iter().zip(u).map(|(input, u)| input.distribution.quantile(u)).collect();
        [&x[..], &[ishigami.value(&x)]].concat()
    };
    numbers.map(row).collect()
}

fn write(folder: &Path, name: &str, rows: &[Vec<f64>]) -> anyhow::Result<()> {
    let factors = rows[0].len() - 1;
    let names = (1..=factors).map(|j| format!("x_{j}")).chain(["y".to_owned()]);
    let columns: Vec<Vec<f64>> = (0..=factors).map(|j| rows.iter().map(|row| row[j]).collect()).collect();
    let named: Vec<(String, &[f64])> = names.zip(columns.iter().map(Vec::as_slice)).collect();
    Ok(write_atomically(&folder.join(format!("{name}.csv")), table(&named).as_bytes())?)
}

/// Rows of random points and what `given-data --measures` makes of them.
fn given(folder: &Path) -> anyhow::Result<Value> {
    let study = study(Sampler::Random, 500)?;
    let per_point = study.design().rows_per_point();
    // A and B, which are independent of each other.
    let rows = rows(&study, (0..500).flat_map(|point| [point * per_point, point * per_point + 1]));
    write(folder, "given", &rows)?;
    let column = |j: usize, name: String| Column { name, values: rows.iter().map(|row| row[j]).collect() };
    let inputs: Vec<Column> = (0..3).map(|j| column(j, format!("x{}", j + 1))).collect();
    let outputs = [column(3, "y".to_owned())];
    let indices = analyse(&inputs, &outputs, 0)?;
    let measured = measures(&inputs, &outputs, &indices, 0).remove(0)?;
    let of = |measure: Measure| {
        let found = || measured.iter().filter_map(|input| input.get(measure));
        let values: Vec<f64> = found().map(|found| found.estimate.estimate).collect();
        let p: Vec<Option<f64>> = found().map(|found| found.p_value).collect();
        (measure.name().to_owned(), json!({ "values": values, "p": p }))
    };
    Ok(Value::Object(Measure::ALL.into_iter().map(of).collect()))
}

/// Base points with A, the steps of their order and B, one after the other, and the Shapley effects.
fn shapley(folder: &Path) -> anyhow::Result<Value> {
    let study = study(Sampler::Sobol, 512)?;
    let design = study.design();
    let of_point = |point: u64| {
        let steps = design.step_runs().iter().map(|run| *run as u64);
        std::iter::once(0).chain(steps).chain([1]).map(move |run| point * design.rows_per_point() + run)
    };
    let rows = rows(&study, (0..512).flat_map(of_point));
    write(folder, "shapley", &rows)?;
    let analysis = study.run()?;
    let indices = analysis.output("y")?.indices.iter().flatten();
    let effects: Vec<Option<f64>> = indices.map(|index| index.effect.shapley.map(|effect| effect.estimate)).collect();
    Ok(json!(effects))
}

/// Writes the tables and `measures.json`.
pub fn dump(folder: &Path) -> anyhow::Result<()> {
    let all = json!({ "given": given(folder)?, "shapley": shapley(folder)? });
    Ok(write_atomically(&folder.join("measures.json"), serde_json::to_string_pretty(&all)?.as_bytes())?)
}
