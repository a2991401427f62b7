//! Arrays of points and outputs that exist already.

use apportion::given::{Column, analyse, average_replicates, measures as measured, surrogate_indices};
use apportion_base::quantity::Unlikely;
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
#[pyo3(signature = (inputs, outputs, *, measures, distributions, seed, name, sha256))]
#[expect(clippy::too_many_arguments, reason = "by name")]
pub fn given_data(
    py: Python<'_>,
    inputs: (Vec<String>, PyReadonlyArray2<'_, f64>),
    outputs: (Vec<String>, PyReadonlyArray2<'_, f64>),
    measures: bool,
    distributions: Option<&crate::study::Study>,
    seed: u64,
    name: &str,
    sha256: String,
) -> PyResult<Document> {
    let (mut inputs, mut outputs) = (columns(inputs.0, &inputs.1)?, columns(outputs.0, &outputs.1)?);
    let laws = distributions.map(|study| study.distributions_of(&inputs)).transpose()?;
    let name = name.to_owned();
    let work = move |stop: &Stop| {
        let going_on = || if stop.is_set() { Err("interrupted".to_owned()) } else { Ok(()) };
        let replicates = average_replicates(&mut inputs, &mut outputs).map_err(|error| error.to_string())?;
        let indices = analyse(&inputs, &outputs, seed).map_err(|error| error.to_string())?;
        going_on()?;
        let surrogates = surrogate_indices(&inputs, &outputs, &indices, laws.as_deref());
        going_on()?;
        let facts = GivenFacts { file: name.clone(), sha256, dropped: None, seed };
        let mut result = build_given(&indices, &surrogates, &inputs, &outputs, &facts).after(replicates.as_ref(), None);
        if measures {
            result = result.with_measures(&measured(&inputs, &outputs, &indices, seed));
        }
        going_on()?;
        Ok(Document::new(given_document(&result, &name)))
    };
    watched(py, work)?.map_err(|reason: String| input(reason))
}

/// Describes a value among outputs of a design that may mark missing ones; `independent` are those of A and B. `None` if there
/// is none.
#[pyfunction]
pub fn unlikely(y: PyReadonlyArray1<'_, f64>, independent: PyReadonlyArray1<'_, f64>) -> Option<String> {
    let y = y.as_array().to_vec();
    let unlikely = Unlikely::find(&y).or_else(|| Unlikely::find_in_rows(&independent.as_array().to_vec()))?;
    let (count, first) =
        (y.iter().filter(|y| **y == unlikely.value).count(), y.iter().position(|y| *y == unlikely.value)?);
    let of = y.iter().filter(|y| y.is_finite()).count();
    Some(Unlikely { count, first, of, ..unlikely }.in_table(first + 1))
}
