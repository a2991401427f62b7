//! A table of inputs and outputs from a CSV file, whoever made it.

use std::collections::BTreeMap;
use std::io::Read;

use thiserror::Error;

use super::points::PlainLines;
use crate::given::Column;
use crate::study::nearest;

/// What is wrong with a table.
#[derive(Debug, Error)]
pub enum TableError {
    /// There is not even a header.
    #[error("line 1: the file is empty: expected a header of column names, then one line per run")]
    Empty,
    /// A column without a name.
    #[error(
        "line 1: column {column} has no name{}",
        if *column == 1 { ": if it is the index that pandas writes, leave it out (index=False)" } else { "" }
    )]
    Nameless {
        /// Number of the column, from 1.
        column: usize,
    },
    /// Two columns of one name.
    #[error("line 1: column {column}: `{name}` is also the name of column {first}")]
    RepeatedColumn {
        /// Number of the column, from 1.
        column: usize,
        /// The name.
        name: String,
        /// Number of the first column of that name.
        first: usize,
    },
    /// An input or output that is no column.
    #[error("line 1: no column is called `{name}`{}; the columns are {known}", hint(.nearest))]
    UnknownColumn {
        /// The name asked for.
        name: String,
        /// The nearest column.
        nearest: Option<String>,
        /// All columns.
        known: String,
    },
    /// A column named twice by the user.
    #[error("`{name}` is asked for twice: each column can be one input or one output")]
    AskedTwice {
        /// The name.
        name: String,
    },
    /// All columns are outputs.
    #[error("line 1: no column is left as an input; the columns are {known}")]
    NoInputs {
        /// All columns.
        known: String,
    },
    /// An empty cell, or one that says so.
    #[error(
        "line {line}: column {column} (`{name}`): the value is missing ({found:?}); --drop-missing leaves such rows out"
    )]
    Missing {
        /// Line of the file, from 1.
        line: u64,
        /// Number of the column, from 1.
        column: usize,
        /// Its name.
        name: String,
        /// The cell.
        found: String,
    },
    /// A cell that is not a finite number.
    #[error("line {line}: column {column} (`{name}`): expected a finite number, not {found:?}{}", advice(*.chosen))]
    NotANumber {
        /// Line of the file, from 1.
        line: u64,
        /// Number of the column, from 1.
        column: usize,
        /// Its name.
        name: String,
        /// The cell.
        found: String,
        /// Whether the column was asked for by name.
        chosen: bool,
    },
    /// A line with too many or too few cells.
    #[error("line {line}: expected {expected} cells as in the header, not {found}")]
    WrongLength {
        /// Line of the file, from 1.
        line: u64,
        /// Cells in the header.
        expected: u64,
        /// Cells in this line.
        found: u64,
    },
    /// The file cannot be read, or is not text in UTF-8.
    #[error("line {line}: {source}")]
    Unreadable {
        /// Line of the file, from 1.
        line: u64,
        /// What the reader said.
        source: csv::Error,
    },
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map_or_else(String::new, |name| format!(": did you mean `{name}`?"))
}

fn advice(chosen: bool) -> &'static str {
    if chosen { "" } else { "; if the column is no input, name the inputs (--inputs)" }
}

/// What to do with rows that lack a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Missing {
    /// Refuse the table at the first one.
    #[default]
    Refuse,
    /// Leave them out, and count them.
    Drop,
}

/// Which columns of a table are used, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Selection<'a> {
    /// Names of the outputs.
    pub outputs: &'a [String],
    /// Names of the inputs; none for all columns that are no outputs.
    pub inputs: &'a [String],
    /// What to do with rows that lack a value in one of these columns.
    pub missing: Missing,
}

/// Rows that were left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DroppedRows {
    /// How many.
    pub rows: u64,
    /// Line of the first of them in the file, from 1.
    pub first_line: u64,
}

/// A table as columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The inputs, in the order asked for, or of the file.
    pub inputs: Vec<Column>,
    /// The outputs, in the order asked for.
    pub outputs: Vec<Column>,
    /// Rows left out for missing values.
    pub dropped: Option<DroppedRows>,
}

/// Reads a table: a header of names, then one line of numbers per run. Columns that are not selected may hold anything.
///
/// A byte-order mark and spaces around cells are ignored, empty lines are skipped. A value is missing if its cell is
/// empty or says `nan`, `na`, `n/a`, `null`, `none` or `-`, in capitals or not.
///
/// # Errors
/// [`TableError`] with line and column of the first fault.
pub fn read_table(reader: impl Read, selection: &Selection<'_>) -> Result<Table, TableError> {
    let mut csv = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(PlainLines::new(reader));
    let header = csv.headers().map_err(|source| wrong_record(source, 1))?;
    let names: Vec<String> = header.iter().map(|name| name.trim_start_matches('\u{feff}').trim().to_owned()).collect();
    check_header(&names)?;
    let (inputs, outputs) = places(&names, selection)?;
    let chosen: Vec<usize> = inputs.iter().chain(&outputs).copied().collect();
    let mut columns: Vec<Column> =
        chosen.iter().map(|&place| Column { name: names[place].clone(), values: Vec::new() }).collect();
    let mut dropped: Option<DroppedRows> = None;
    let mut record = csv::StringRecord::new();
    let mut row = Vec::with_capacity(chosen.len());
    loop {
        let read = csv.read_record(&mut record);
        // The reader stands at the start of the next line.
        let line = csv.position().line() - 1;
        if !read.map_err(|error| wrong_record(error, line))? {
            break;
        }
        row.clear();
        let mut complete = true;
        for &place in &chosen {
            let (column, found) = (place + 1, &record[place]);
            let name = || names[place].clone();
            match value(found) {
                Cell::Number(value) => row.push(value),
                Cell::Missing if selection.missing == Missing::Drop => complete = false,
                Cell::Missing => return Err(TableError::Missing { line, column, name: name(), found: found.into() }),
                Cell::Other => {
                    let chosen = !selection.inputs.is_empty() || outputs.contains(&place);
                    return Err(TableError::NotANumber { line, column, name: name(), found: found.into(), chosen });
                }
            }
        }
        if complete {
            columns.iter_mut().zip(&row).for_each(|(column, value)| column.values.push(*value));
        } else {
            dropped.get_or_insert(DroppedRows { rows: 0, first_line: line }).rows += 1;
        }
    }
    let outputs = columns.split_off(inputs.len());
    Ok(Table { inputs: columns, outputs, dropped })
}

fn check_header(names: &[String]) -> Result<(), TableError> {
    if names.iter().all(String::is_empty) {
        return Err(TableError::Empty);
    }
    let mut places = BTreeMap::new();
    for (place, name) in names.iter().enumerate() {
        if name.is_empty() {
            return Err(TableError::Nameless { column: place + 1 });
        }
        if let Some(first) = places.insert(name, place) {
            return Err(TableError::RepeatedColumn { column: place + 1, name: name.clone(), first: first + 1 });
        }
    }
    Ok(())
}

/// Places of the inputs and of the outputs in the header.
fn places(names: &[String], selection: &Selection<'_>) -> Result<(Vec<usize>, Vec<usize>), TableError> {
    let known = || names.join(", ");
    let place = |name: &String| {
        names.iter().position(|other| other == name).ok_or_else(|| TableError::UnknownColumn {
            name: name.clone(),
            nearest: nearest(name, names.iter().map(String::as_str)),
            known: known(),
        })
    };
    let asked: Vec<&String> = selection.outputs.iter().chain(selection.inputs).collect();
    if let Some(k) = (1..asked.len()).find(|&k| asked[..k].contains(&asked[k])) {
        return Err(TableError::AskedTwice { name: asked[k].clone() });
    }
    let outputs = selection.outputs.iter().map(place).collect::<Result<Vec<_>, _>>()?;
    let mut inputs = selection.inputs.iter().map(place).collect::<Result<Vec<_>, _>>()?;
    if inputs.is_empty() {
        inputs = (0..names.len()).filter(|place| !outputs.contains(place)).collect();
    }
    if inputs.is_empty() { Err(TableError::NoInputs { known: known() }) } else { Ok((inputs, outputs)) }
}

enum Cell {
    Number(f64),
    Missing,
    Other,
}

fn value(cell: &str) -> Cell {
    const MISSING: [&str; 8] = ["", "nan", "-nan", "na", "n/a", "null", "none", "-"];
    if MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) {
        return Cell::Missing;
    }
    cell.parse().ok().filter(|value: &f64| value.is_finite()).map_or(Cell::Other, Cell::Number)
}

fn wrong_record(source: csv::Error, line: u64) -> TableError {
    match source.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            TableError::WrongLength { line, expected: *expected_len, found: *len }
        }
        _ => TableError::Unreadable { line, source },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str, outputs: &[&str], inputs: &[&str], missing: Missing) -> Result<Table, TableError> {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let (outputs, inputs) = (owned(outputs), owned(inputs));
        read_table(text.as_bytes(), &Selection { outputs: &outputs, inputs: &inputs, missing })
    }

    #[track_caller]
    fn refused(text: &str, outputs: &[&str], inputs: &[&str], expected: &str) {
        let message = read(text, outputs, inputs, Missing::Refuse).unwrap_err().to_string();
        assert!(message.contains(expected), "no {expected:?} in {message:?}");
    }

    #[test]
    fn columns_come_in_the_order_asked_for() {
        let text = "\u{feff}a, note ,y,b\r\n1,hello,2,3\r\n\r\n-4e-3,\"x, y\",5,6";
        let table = read(text, &["y"], &["b", "a"], Missing::Refuse).unwrap();
        assert_eq!(table.inputs[0], Column { name: "b".to_owned(), values: vec![3.0, 6.0] });
        assert_eq!(table.inputs[1].values, [1.0, -4e-3]);
        assert_eq!(table.outputs[0].values, [2.0, 5.0]);
        let table = read("a,y,b\n1,2,3\n", &["y"], &[], Missing::Refuse).unwrap();
        assert_eq!((table.inputs.len(), table.inputs[1].name.as_str(), table.dropped), (2, "b", None));
    }

    #[test]
    fn faults_are_named_with_their_place() {
        refused("", &["y"], &[], "line 1: the file is empty");
        refused("\n\n", &["y"], &[], "line 1: the file is empty");
        refused("a,,y\n", &["y"], &[], "line 1: column 2 has no name");
        refused(",a,y\n", &["y"], &[], "line 1: column 1 has no name: if it is the index that pandas writes");
        refused("a,b,a\n", &["b"], &[], "line 1: column 3: `a` is also the name of column 1");
        refused(
            "a,force\n",
            &["forse"],
            &[],
            "no column is called `forse`: did you mean `force`?; the columns are a, force",
        );
        refused("a,y\n", &["y"], &["y"], "`y` is asked for twice");
        refused("y\n1\n", &["y"], &[], "no column is left as an input");
        refused(
            "a,y\n1,2\n3,nan\n",
            &["y"],
            &[],
            "line 3: column 2 (`y`): the value is missing (\"nan\"); --drop-missing",
        );
        refused("a,y\n1,2\n,2\n", &["y"], &[], "line 3: column 1 (`a`): the value is missing (\"\")");
        refused(
            "a,y\n1,2\nred,2\n",
            &["y"],
            &[],
            "line 3: column 1 (`a`): expected a finite number, not \"red\"; if the",
        );
        refused("a,y\n1,inf\n", &["y"], &["a"], "line 2: column 2 (`y`): expected a finite number, not \"inf\"");
        refused("a,y\n1,2\n3\n", &["y"], &[], "line 3: expected 2 cells as in the header, not 1");
    }

    #[test]
    fn rows_without_a_value_are_dropped_and_counted_if_asked() {
        let text = "a,y,z\n1,2,\n,2,3\n3,NaN,3\n4,5,6\n";
        let table = read(text, &["y"], &["a"], Missing::Drop).unwrap();
        assert_eq!(table.inputs[0].values, [1.0, 4.0]);
        assert_eq!(table.dropped, Some(DroppedRows { rows: 2, first_line: 3 }));
        // Text and infinities are no missing values.
        assert!(read("a,y\nred,1\n", &["y"], &[], Missing::Drop).is_err());
        assert!(read("a,y\n1,inf\n", &["y"], &[], Missing::Drop).is_err());
    }

    proptest! {
        #[test]
        fn no_file_panics(bytes in prop::collection::vec(any::<u8>(), 0..60), near in "[a,y\n\r\"0-9.e-]{0,40}") {
            let outputs = ["y".to_owned()];
            for missing in [Missing::Refuse, Missing::Drop] {
                let selection = Selection { outputs: &outputs, inputs: &[], missing };
                let _ = (read_table(&bytes[..], &selection), read_table(near.as_bytes(), &selection));
            }
        }
    }
}
