//! Outputs that are series: their length and the positions of their values.

use apportion::model::{SeriesAxis, SeriesError};
use apportion::names::{SHORT_TEXT, is_short_text};

use super::context::wrong;
use super::error::Problem;
use super::outputs::OutputTable;

/// Returns the axis of the output `key` from its `table`; `None` if it is not a series.
pub(super) fn axis(key: &str, table: &OutputTable) -> Result<Option<SeriesAxis>, Problem> {
    let OutputTable { length, axis, axis_unit, positions, .. } = table;
    let texts = [("axis", axis), ("axis_unit", axis_unit)];
    let said = texts.map(|(name, text)| (name, text.is_some()));
    let said = [("length", length.is_some()), ("positions", positions.is_some())].into_iter().chain(said);
    let Some((first, _)) = said.into_iter().find(|(_, said)| *said) else { return Ok(None) };
    let is_wrong = |(_, text): &(&str, &Option<String>)| text.as_ref().is_some_and(|text| !is_short_text(text));
    if let Some((name, Some(text))) = texts.into_iter().find(is_wrong) {
        return Err(wrong(&format!("{key}.{name}"), SHORT_TEXT, format!("{text:?}")));
    }
    let (label, unit) = (axis.as_deref().unwrap_or("index"), axis_unit.as_deref().unwrap_or_default());
    let length = length.map(|length| usize::try_from(length).unwrap_or(usize::MAX));
    let refused = |error: SeriesError| {
        let (name, expected, found) = match error {
            SeriesError::Length { found } => ("length", "2 to 10000 values", found.to_string()),
            SeriesError::Position { place, found } => {
                ("positions", "finite numbers in rising order", format!("{found} at place {place}"))
            }
        };
        wrong(&format!("{key}.{name}"), expected, found)
    };
    let axis = match (positions.clone(), length) {
        (None, Some(length)) => SeriesAxis::even(label, unit, length, 0.0, 1.0),
        (Some(pair), Some(length)) if pair.len() == 2 => SeriesAxis::even(label, unit, length, pair[0], pair[1]),
        (Some(list), length) if list.len() != 2 && length.is_none_or(|length| length == list.len()) => {
            SeriesAxis::new(label, unit, list)
        }
        (Some(list), Some(length)) => {
            let expected = format!("a list of {length} numbers, or of two: the first position and the step");
            return Err(wrong(&format!("{key}.positions"), &expected, format!("a list of {}", list.len())));
        }
        (_, None) => {
            let found = format!("`{first}` without one");
            return Err(wrong(&format!("{key}.length"), "the number of values, as in length = 365", found));
        }
    };
    axis.map(Some).map_err(refused)
}
