//! Two tables with the same rows: inputs in one file, outputs in another.

use super::{ColumnKind, RowReader};
use crate::exchange::error::{TableError, refused};
use crate::exchange::table::column_of;

/// The rows of a table of inputs with some columns of a table of outputs after them.
pub struct Joined {
    inputs: Box<dyn RowReader>,
    outputs: Box<dyn RowReader>,
    /// The columns of the outputs.
    places: Vec<usize>,
    names: Option<Vec<String>>,
}

impl Joined {
    /// Joins a table of inputs with the columns `chosen` of a table of outputs.
    ///
    /// # Errors
    /// [`TableError`] if the outputs have no such column, or the inputs have one too.
    pub fn new(inputs: Box<dyn RowReader>, outputs: Box<dyn RowReader>, chosen: &[String]) -> Result<Self, TableError> {
        if let Some(name) = chosen.iter().find(|name| inputs.names().is_some_and(|names| names.contains(name))) {
            return refused(format!("`{name}` is also a column of the inputs: rename one of them"));
        }
        let names = outputs.names().unwrap_or_default();
        let places = chosen.iter().map(|name| column_of(names, name)).collect::<Result<_, _>>()?;
        let names = inputs.names().map(|names| [names, chosen].concat());
        Ok(Self { inputs, outputs, places, names })
    }
}

impl RowReader for Joined {
    fn names(&self) -> Option<&[String]> {
        self.names.as_deref()
    }

    fn width(&self) -> usize {
        self.inputs.width() + self.places.len()
    }

    fn text_columns(&mut self) -> Result<Vec<(usize, String)>, TableError> {
        self.inputs.text_columns()
    }

    fn is_unended(&self) -> bool {
        self.inputs.is_unended() || self.outputs.is_unended()
    }

    /// The inputs among the `wanted` columns are the first of them.
    fn read(&mut self, wanted: &[(usize, ColumnKind)], rows: usize, to: &mut [Vec<f64>]) -> Result<usize, TableError> {
        let width = self.inputs.width();
        let (inputs, outputs) = wanted.split_at(wanted.iter().filter(|(place, _)| *place < width).count());
        let (to_inputs, to_outputs) = to.split_at_mut(inputs.len());
        let outputs = outputs.iter().map(|(place, kind)| (self.places[place - width], kind.clone()));
        let found = self.outputs.read(&outputs.collect::<Vec<_>>(), rows, to_outputs)?;
        let count = self.inputs.read(inputs, rows, to_inputs)?;
        if found != count {
            let which = if found < count { "fewer" } else { "more" };
            return refused(format!("the file of the outputs has {which} rows than that of the inputs"));
        }
        Ok(count)
    }
}
