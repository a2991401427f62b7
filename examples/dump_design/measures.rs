//! Measures of a table and measures of derivatives, with the rows that they come from.

use std::path::Path;
use std::sync::{Arc, Mutex};

use apportion::given::{Column, Measure, analyse, measures};
use apportion::screening::{ScreenedFactor, ScreeningDesign, ScreeningJob, ScreeningSettings, screen};
use apportion::{AnalysisOptions, Estimate, Sampler, Study, SurrogateChoice, function_model};
use apportion_report::write_atomically;
use serde_json::{Map, Value, json};

use super::outputs::function;
use super::table;

const NAME: &str = "ishigami";

/// Rows, as they were run.
type Noted = Arc<Mutex<Vec<Vec<f64>>>>;

/// A study of Ishigami's function, and the rows that it runs: the values of the factors, then the output.
fn study(sampler: Sampler, base_samples: u64) -> anyhow::Result<(Study, Noted)> {
    let (ishigami, rows) = (function(NAME), Noted::default());
    let (inputs, noted) = (ishigami.inputs().to_vec(), rows.clone());
    let model = function_model("y", move |x: &[f64]| {
        let y = ishigami.value(x);
        if let Ok(mut rows) = noted.lock() {
            rows.push([x, &[y]].concat());
        }
        y
    });
    let options = AnalysisOptions { surrogate: SurrogateChoice::Off, ..AnalysisOptions::for_sampler(sampler) };
    let builder = Study::builder(NAME, model).sampler(sampler).base_samples(base_samples).replicates(1);
    let builder = inputs.into_iter().fold(builder, |builder, input| builder.factor(&input.name, input.distribution));
    Ok((builder.analysis(options).build()?, rows))
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
    let (study, _) = study(Sampler::Random, 500)?;
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

/// Base points, each followed by its steps, and the measures of the derivatives.
fn derivatives(folder: &Path) -> anyhow::Result<Value> {
    let (study, noted) = study(Sampler::Sobol, 64)?;
    let model = study.model();
    let design = ScreeningDesign::Derivative { sampler: Sampler::Sobol };
    let settings = ScreeningSettings { design, trajectories: 256, seed: 3 };
    let screening = screen(ScreeningJob { space: study.space(), model: model.as_ref(), settings }, 1, &|_| ())?;
    write(folder, "derivatives", &noted.lock().map_or_else(|_| Vec::new(), |rows| rows.clone()))?;
    let of = |measure: fn(&ScreenedFactor) -> Option<Estimate>| -> Vec<Option<f64>> {
        screening.outputs[0].factors.iter().map(|factor| measure(factor).map(|found| found.estimate)).collect()
    };
    Ok(json!({ "nu": of(|factor| factor.nu), "total_bound": of(|factor| factor.total_bound) }))
}

/// Writes the tables and `measures.json`.
pub fn dump(folder: &Path) -> anyhow::Result<()> {
    let all: Map<String, Value> =
        [("given".to_owned(), given(folder)?), ("derivatives".to_owned(), derivatives(folder)?)].into_iter().collect();
    Ok(write_atomically(&folder.join("measures.json"), serde_json::to_string_pretty(&all)?.as_bytes())?)
}
