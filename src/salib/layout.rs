//! The rows of a table made by SALib, and checks of their order.

use super::SalibError;
use apportion_base::quantity::is_same;

/// The rows of a base point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SalibLayout {
    /// A, AB_1 ... AB_d, B (`calc_second_order=False`).
    FirstOrder,
    /// A, AB_1 ... AB_d, BA_1 ... BA_d, B (`calc_second_order=True`, SALib's default).
    SecondOrder,
}

impl SalibLayout {
    /// Returns the layout of `rows` rows for the indices of `members`: the `stated` one, or the only one that fits the
    /// number of rows and the `inputs`, if these are given. Members have the indices of their inputs.
    ///
    /// # Errors
    /// [`SalibError`] if the rows fit none, or both.
    pub fn recognise(
        rows: usize,
        members: &[(String, Vec<usize>)],
        stated: Option<SalibLayout>,
        inputs: Option<&Inputs>,
    ) -> Result<SalibLayout, SalibError> {
        let d = members.len();
        let candidates = stated.map_or(SalibLayout::ALL.to_vec(), |layout| vec![layout]);
        let (mut expected, mut fitting, mut misfit) = (Vec::new(), Vec::new(), None);
        for layout in candidates {
            expected.push(format!("{} rows each {}", layout.rows_per_point(d), layout.words()));
            if rows == 0 || !rows.is_multiple_of(layout.rows_per_point(d)) {
                continue;
            }
            match inputs.map_or(Ok(()), |inputs| check_points(inputs, members, layout)) {
                Ok(()) => fitting.push(layout),
                Err(error) => misfit = misfit.or(Some(error)),
            }
        }
        match fitting[..] {
            [] => Err(misfit.unwrap_or_else(|| {
                let there_are = format!("for {d} inputs or groups there are {}", expected.join(", "));
                SalibError::Invalid(format!("{rows} rows are not a whole number of base points: {there_are}"))
            })),
            [layout] if rows == layout.rows_per_point(d) => {
                Err(SalibError::Invalid(format!("{rows} rows are a single base point: two or more are needed")))
            }
            [layout] => Ok(layout),
            _ => Err(SalibError::Ambiguous { rows, members: d }),
        }
    }

    /// Both layouts.
    pub const ALL: [Self; 2] = [Self::SecondOrder, Self::FirstOrder];

    /// Returns the number of rows of a base point, for `d` inputs or groups.
    pub fn rows_per_point(self, d: usize) -> usize {
        match self {
            Self::FirstOrder => d + 2,
            Self::SecondOrder => 2 * d + 2,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::FirstOrder => "without second order (calc_second_order=False)",
            Self::SecondOrder => "with second order (calc_second_order=True)",
        }
    }

    /// Returns the number of base points of a table, in words.
    pub(super) fn points(self, rows: usize, d: usize) -> String {
        format!("{} base points {}", rows / self.rows_per_point(d), self.words())
    }

    /// Describes row `row` of a base point.
    fn row_name(self, row: usize, d: usize) -> String {
        match row {
            0 => "A".to_owned(),
            row if row <= d => format!("AB_{row}"),
            row if row + 1 < self.rows_per_point(d) => format!("BA_{}", row - d),
            _ => "B".to_owned(),
        }
    }
}

/// Inputs by name, a column each.
pub type Inputs = [(String, Vec<f64>)];

/// Checks the layout of the points: in every base point the rows between A and B must be those of one with the inputs
/// of their member from the other.
fn check_points(inputs: &Inputs, members: &[(String, Vec<usize>)], layout: SalibLayout) -> Result<(), SalibError> {
    let (d, step) = (members.len(), layout.rows_per_point(members.len()));
    let rows = inputs.first().map_or(0, |(_, column)| column.len());
    for first in (0..rows).step_by(step) {
        let (a, b) = (first, first + step - 1);
        for row in first + 1..b {
            let number = row - first - 1;
            let (base, other) = if number < d { (a, b) } else { (b, a) };
            for (place, (name, column)) in inputs.iter().enumerate() {
                let source = if members[number % d].1.contains(&place) { other } else { base };
                let (value, expected) = (column[row], column[source]);
                if !is_same(value, expected) {
                    let (row, kind, layout) = (row + 1, layout.row_name(row - first, d), layout.words());
                    return Err(SalibError::Invalid(format!(
                        "row {row} should be the row {kind} of its base point, {layout}, but its `{name}` is {value} instead of \
                         {expected}: the rows are in another order, or the points are not those of SALib"
                    )));
                }
            }
        }
    }
    Ok(())
}
