//! Columns of text in a table of numbers: why they are none of numbers, and what would make them so.

use std::fmt;

use crate::model::shorten::cut;

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

impl TextColumn {
    /// What kind of text it holds, as far as its example tells.
    pub fn kind(&self) -> TextKind {
        self.example.as_deref().map_or(TextKind::Text, TextKind::of)
    }

    /// What it holds: ``the column `a` holds text (red)``.
    pub(super) fn reason(&self) -> String {
        let example = self.example.as_ref().map_or_else(String::new, |cell| format!(" ({})", cut(cell, LONGEST)));
        format!("the column `{}` holds {}{example}", self.name, self.kind().what())
    }
}

impl TextKind {
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

/// Most characters of a cell in a sentence.
const LONGEST: usize = 24;

/// The warning that it was left out.
impl fmt::Display for TextColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (reason, remedy) = (self.reason(), self.kind().remedy());
        write!(f, "{reason}, and was left out: the indices are those of the other inputs alone; {remedy}")
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
