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

    fn option(self) -> &'static str {
        match self {
            Self::FirstOrder => "--first-order-only",
            Self::SecondOrder => "--second-order",
        }
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

/// Returns the layout of `rows` rows for the indices of `members`: the one `asked` for, or the only one that fits the
/// number of rows and the `inputs`, if they are known. Members have the indices of their inputs.
///
/// # Errors
/// [`SalibError`] if the rows fit none, or both.
pub fn recognise(
    rows: usize,
    members: &[(String, Vec<usize>)],
    asked: Option<SalibLayout>,
    inputs: Option<&Inputs>,
) -> Result<SalibLayout, SalibError> {
    let d = members.len();
    let candidates: Vec<SalibLayout> = asked.map_or(SalibLayout::ALL.to_vec(), |asked| vec![asked]);
    let whole = |layout: &SalibLayout| rows > 0 && rows.is_multiple_of(layout.rows_per_point(d));
    let possible: Vec<SalibLayout> = candidates.iter().copied().filter(whole).collect();
    let fits = |layout| inputs.map_or(Ok(()), |inputs| check_points(inputs, members, layout));
    let fitting: Vec<SalibLayout> = possible.iter().copied().filter(|layout| fits(*layout).is_ok()).collect();
    match (&fitting[..], possible.first()) {
        (_, None) => {
            let words = |layout: &SalibLayout| format!("{} rows each {}", layout.rows_per_point(d), layout.words());
            let expected = candidates.iter().map(words).collect::<Vec<_>>().join(", ");
            let there_are = format!("for {d} inputs or groups there are {expected}");
            Err(SalibError(format!("{rows} rows are not a whole number of base points: {there_are}")))
        }
        ([], Some(first)) => fits(*first).map(|()| *first),
        ([layout], _) if rows == layout.rows_per_point(d) => {
            Err(SalibError(format!("{rows} rows are a single base point: two or more are needed")))
        }
        ([layout], _) => Ok(*layout),
        _ => {
            let words =
                |layout: SalibLayout| format!("{} base points {}", rows / layout.rows_per_point(d), layout.words());
            let ways = SalibLayout::ALL.map(words).join(" or ");
            let options = SalibLayout::ALL.map(SalibLayout::option).join(" or ");
            Err(SalibError(format!("{rows} rows can be read in two ways: {ways}: choose one by {options}")))
        }
    }
}

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
                let (found, expected) = (column[row], column[source]);
                if !is_same(found, expected) {
                    let (row, kind, layout) = (row + 1, layout.row_name(row - first, d), layout.words());
                    return Err(SalibError(format!(
                        "row {row} should be the row {kind} of its base point, {layout}, but its `{name}` is {found} instead of \
                         {expected}: the rows are in another order, or the points are not those of SALib"
                    )));
                }
            }
        }
    }
    Ok(())
}
