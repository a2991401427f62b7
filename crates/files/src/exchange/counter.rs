//! Columns that number the rows: the order in which runs were asked for, not an input.

use apportion_base::names::shown;

use super::error::{TableError, refused};
use super::rows::{ColumnKind, RowReader};

/// Names, in lower case and of letters only, of columns that number runs.
const NAMES: [&str; 12] =
    ["", "id", "index", "idx", "run", "runid", "runnumber", "case", "evalid", "jobid", "sampleid", "unnamed"];

/// Returns whether the column of that name is called like a number of runs.
pub(super) fn is_called_counter(name: &str) -> bool {
    let letters: String = name.to_lowercase().chars().filter(|c| c.is_alphabetic()).collect();
    NAMES.contains(&&*letters)
}

/// Returns for each row its place among `rows` rows, if `values` number them from 0 or from 1; some may be missing.
pub(super) fn places(values: &[f64], rows: u64) -> Option<Vec<usize>> {
    let start = if values.contains(&0.0) { 0.0 } else { 1.0 };
    let mut is_taken = vec![false; usize::try_from(rows).ok()?];
    values
        .iter()
        .map(|value| {
            let place = value - start;
            let is_new = place >= 0.0 && place.fract() == 0.0 && place < rows as f64;
            (is_new && !std::mem::replace(&mut is_taken[place as usize], true)).then_some(place as usize)
        })
        .collect()
}

/// All rows of a design from a file that numbers them.
pub(super) struct Numbered {
    /// The column with the numbers.
    pub name: String,
    /// The columns, by row of the design; NaN where a row is missing.
    pub columns: Vec<Vec<f64>>,
    /// Number of rows that are missing.
    pub missing: u64,
}

/// Reads the `wanted` columns in the order that another column gives to the rows; `None`, with nothing read, if no
/// other column is called a number of runs.
///
/// # Errors
/// [`TableError`] if the column does not number `rows` rows.
pub(super) fn read_numbered(
    reader: &mut dyn RowReader,
    wanted: &[(usize, ColumnKind)],
    rows: u64,
) -> Result<Option<Numbered>, TableError> {
    let names = reader.names().unwrap_or_default().to_vec();
    let mut others = (0..names.len()).filter(|place| wanted.iter().all(|(used, _)| used != place));
    let Some(place) = others.find(|place| is_called_counter(&names[*place])) else { return Ok(None) };
    let with_number = [wanted, &[(place, ColumnKind::numbers(&names[place]))]].concat();
    let (mut all, mut cells) = (vec![Vec::new(); with_number.len()], vec![Vec::new(); with_number.len()]);
    while reader.read(&with_number, 1 << 12, &mut cells)? > 0 {
        all.iter_mut().zip(&cells).for_each(|(all, cells)| all.extend(cells));
    }
    let numbers = all.pop().unwrap_or_default();
    let Some(places) = places(&numbers, rows) else {
        return refused(format!(
            "column {} ({}) does not number the {rows} rows of the design, from 0 or from 1, each at most once: leave it out \
             if the rows are in order, or mend it",
            place + 1,
            shown(&names[place])
        ));
    };
    let missing = rows - places.len() as u64;
    let mut columns = vec![vec![f64::NAN; rows as usize]; all.len()];
    for (column, values) in columns.iter_mut().zip(&all) {
        places.iter().zip(values).for_each(|(place, value)| column[*place] = *value);
    }
    Ok(Some(Numbered { name: names[place].clone(), columns, missing }))
}
