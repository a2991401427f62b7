//! Arrays of points and outputs that exist already.

use apportion::AnalysisOptions;
use apportion::given::{Column, analyse, measures as measured, surrogate_indices};
use apportion::salib::{SalibLayout, SalibProblem, salib_study};
use apportion_report::given::{GivenFacts, build_given, given_document};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::document::Document;
use crate::errors::input;
use crate::function::Stop;
use crate::run::watched;

/// The columns of an array of (rows, columns).
pub fn columns(names: Vec<String>, values: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Column>> {
    let values = values.as_array();
    if values.ncols() != names.len() {
        return Err(input(format!("{} names for {} columns", names.len(), values.ncols())));
    }
    let column =
        |(name, column): (String, numpy::ndarray::ArrayView1<'_, f64>)| Column { name, values: column.to_vec() };
    Ok(names.into_iter().zip(values.columns()).map(column).collect())
}

/// Indices from rows that are independent draws.
#[pyfunction]
#[pyo3(signature = (inputs, outputs, *, surrogate, measures, distributions, seed, name, sha256))]
#[expect(clippy::too_many_arguments, reason = "by name")]
pub fn given_data(
    py: Python<'_>,
    inputs: (Vec<String>, PyReadonlyArray2<'_, f64>),
    outputs: (Vec<String>, PyReadonlyArray2<'_, f64>),
    surrogate: bool,
    measures: bool,
    distributions: Option<&crate::study::Study>,
    seed: u64,
    name: &str,
    sha256: String,
) -> PyResult<Document> {
    let (inputs, outputs) = (columns(inputs.0, &inputs.1)?, columns(outputs.0, &outputs.1)?);
    let laws = distributions.map(|study| study.distributions_of(&inputs)).transpose()?;
    let name = name.to_owned();
    let work = move |stop: &Stop| {
        let going_on = || if stop.is_set() { Err("interrupted".to_owned()) } else { Ok(()) };
        let indices = analyse(&inputs, &outputs, seed).map_err(|error| error.to_string())?;
        going_on()?;
        let surrogates = surrogate.then(|| surrogate_indices(&inputs, &outputs, &indices, laws.as_deref()));
        going_on()?;
        let facts = GivenFacts { file: name.clone(), sha256, dropped: None, seed };
        let mut result = build_given(&indices, surrogates.as_ref(), &inputs, &outputs, &facts);
        if measures {
            result = result.with_measures(&measured(&inputs, &outputs, &indices, seed));
        }
        going_on()?;
        Ok(Document::new(given_document(&result, &name)))
    };
    watched(py, work)?.map_err(|reason: String| input(reason))
}

/// Indices by SALib's formulas: first-order, total and second-order ones of the pairs in order, and warnings.
type SalibIndices = (Vec<f64>, Vec<f64>, Vec<f64>, Vec<String>);

/// First-order, total and second-order indices of outputs in SALib's layout, with what is to be known of them.
#[pyfunction]
#[pyo3(signature = (y, d, *, second_order))]
pub fn salib_indices(
    py: Python<'_>,
    y: PyReadonlyArray1<'_, f64>,
    d: usize,
    second_order: bool,
) -> PyResult<SalibIndices> {
    let y = y.as_array().to_vec();
    let layout = if second_order { SalibLayout::SecondOrder } else { SalibLayout::FirstOrder };
    let rows = layout.rows_per_point(d);
    if d == 0 || y.is_empty() || !y.len().is_multiple_of(rows) || y.len() < 2 * rows {
        return Err(input(format!("{} outputs: expected a multiple of {rows}, at least {}", y.len(), 2 * rows)));
    }
    let work = move |_: &Stop| -> Result<_, String> {
        let problem = SalibProblem::of_inputs((0..d).map(|j| format!("x{j}")).collect());
        let outputs = [Column { name: "y".to_owned(), values: y }];
        let unlikely = apportion::Unlikely::find(&outputs[0].values).map(|found| found.in_table(found.first + 1));
        let problem = problem.map_err(|error| error.to_string())?;
        let made = salib_study("salib", &problem, &outputs, layout, (0, 0));
        let (study, store) = made.map_err(|error| error.to_string())?;
        // Nothing but the indices is shown.
        let analysis = AnalysisOptions { convergence: false, pictures: false, ..study.analysis().clone() };
        let settings = study.design().settings().clone();
        let study = study.with_design(settings, analysis).map_err(|error| error.to_string())?;
        let result = study.runner().store(&store).run().map_err(|error| error.to_string())?;
        Ok((result, unlikely))
    };
    let (mut result, unlikely) = watched(py, work)?.map_err(input)?;
    let output = result.outputs.remove(0);
    let Some(indices) = output.indices else { return Err(input(output.reason.unwrap_or_default())) };
    Ok((
        indices.iter().map(|index| index.effect.first_order.estimate).collect(),
        indices.iter().map(|index| index.effect.total.estimate).collect(),
        output.second_order.unwrap_or_default().iter().map(|pair| pair.index.estimate).collect(),
        unlikely.into_iter().chain(output.warnings.iter().map(ToString::to_string)).collect(),
    ))
}
