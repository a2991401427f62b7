//! Columns of text in a table of numbers: why they are none of numbers, and what would make them so.

use std::fmt;

use crate::text::listed;

/// A column that is no input because its cells are no numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextColumn {
    /// Its name.
    pub name: String,
    /// Its first cell that is no number; `None` where the format says that there are none.
    pub example: Option<String>,
}

/// Why a cell is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextKind {
    /// `1,5` in place of `1.5`.
    DecimalComma,
    /// A number with something behind it, such as a unit.
    Unit,
    /// Anything else.
    Text,
}

/// A warning of columns that were left out, of one kind each: that they were, why, and what to do.
pub struct LeftOut<'a> {
    kind: TextKind,
    columns: Vec<&'a TextColumn>,
}

impl TextColumn {
    /// What kind of text it holds, as far as its example tells.
    pub fn kind(&self) -> TextKind {
        self.example.as_deref().map_or(TextKind::Text, TextKind::of)
    }
}

impl TextKind {
    const ALL: [Self; 3] = [Self::DecimalComma, Self::Unit, Self::Text];

    /// That of a cell which is no number.
    pub fn of(cell: &str) -> Self {
        let is_number = |text: &str| text.parse::<f64>().is_ok_and(f64::is_finite);
        let with_point = |text: &str| text.replacen(',', ".", 1);
        let (number, behind) = cell.split_once(' ').unwrap_or_else(|| {
            let end = cell.find(|c: char| !(c.is_ascii_digit() || "+-.,".contains(c)));
            cell.split_at(end.unwrap_or(cell.len()))
        });
        if cell.contains(',') && is_number(&with_point(cell)) {
            Self::DecimalComma
        } else if is_number(&with_point(number)) && is_unit(behind.trim()) {
            Self::Unit
        } else {
            Self::Text
        }
    }

    /// What would make numbers of such cells.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::DecimalComma => "write the numbers with a point (1.5, not 1,5)",
            Self::Unit => "leave the numbers alone in the cells, and put the unit into the name of the column",
            Self::Text => "if it is an input, write a number in the place of each of its words",
        }
    }

    fn what(self) -> &'static str {
        match self {
            Self::DecimalComma => "numbers with a decimal comma",
            Self::Unit => "numbers with their unit in the cell",
            Self::Text => "text",
        }
    }
}

/// Whether this may be a unit, such as `mm`, `%` or `kg/m3`: no date, and no word of several.
fn is_unit(text: &str) -> bool {
    let begins = text.chars().next().is_some_and(|c| c.is_alphabetic() || "%°µ".contains(c));
    begins && text.chars().count() <= 12 && !text.contains([' ', ':', '_'])
}

impl<'a> LeftOut<'a> {
    /// The columns, told apart by their kind.
    pub fn of(columns: &'a [TextColumn]) -> Vec<Self> {
        let of_kind = |kind| Self { kind, columns: columns.iter().filter(|column| column.kind() == kind).collect() };
        TextKind::ALL.into_iter().map(of_kind).filter(|left_out| !left_out.columns.is_empty()).collect()
    }

    /// What would make numbers of them.
    pub fn remedy(&self) -> &'static str {
        self.kind.remedy()
    }

    /// The columns and what they hold: ``the column `a` holds text (red)``.
    pub fn reason(&self) -> String {
        let names: Vec<String> = self.columns.iter().map(|column| format!("`{}`", column.name)).collect();
        let (columns, hold) = if names.len() == 1 { ("column", "holds") } else { ("columns", "hold") };
        let example = self.columns.iter().find_map(|column| column.example.as_ref());
        let example = example.map_or_else(String::new, |cell| {
            let short: String = cell.chars().take(LONGEST).collect();
            format!(" ({short}{})", if short.len() < cell.len() { "..." } else { "" })
        });
        format!("the {columns} {} {hold} {}{example}", listed(&names), self.kind.what())
    }
}

/// Most characters of a cell in a sentence.
const LONGEST: usize = 24;

impl fmt::Display for LeftOut<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let were = if self.columns.len() == 1 { "was" } else { "were" };
        write!(
            f,
            "{}, and {were} left out: the indices are those of the other inputs alone; {}",
            self.reason(),
            self.remedy()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_are_no_numbers_are_told_apart() {
        let kinds = [
            (TextKind::DecimalComma, &["57,37", "-0,5", "+1,5e-3", ",5"][..]),
            (TextKind::Unit, &["0.13 mm", "0,13 mm", "12%", "1e3 Pa", "20 °C", "5 kg/m3", "7mm"]),
            (TextKind::Text, &["alu", "", "2026-01-01", "12:30", "1,2,3", "r1", "a 1", "1 of 2", "3 x_y", "-", "mm 2"]),
        ];
        for (kind, cells) in kinds {
            for cell in cells {
                assert_eq!(TextKind::of(cell), kind, "{cell:?}");
            }
        }
    }
}
