//! The engine for Python: what `apportion` in `python/apportion` is made of. Arrays go in and out here, and nothing else is
//! decided: names, defaults and ways to call a function are those of the package.

mod distributions;
mod document;
mod errors;
mod function;
mod points;
mod run;
mod study;

use pyo3::prelude::*;

#[pymodule]
fn _engine(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("StudyError", module.py().get_type::<errors::StudyError>())?;
    module.add("RunError", module.py().get_type::<errors::RunError>())?;
    module.add_class::<study::Study>()?;
    module.add_class::<document::Document>()?;
    module.add_class::<function::Stop>()?;
    module.add_function(wrap_pyfunction!(distributions::distributions, module)?)?;
    module.add_function(wrap_pyfunction!(points::given_data, module)?)?;
    module.add_function(wrap_pyfunction!(points::unlikely, module)?)?;
    module.add_function(wrap_pyfunction!(document::read_document, module)?)?;
    module.add_function(wrap_pyfunction!(document::in_words, module)?)?;
    Ok(())
}
