//! Horizontal bars.

use super::series::Series;
use super::style::drawable;
use super::text::percent;

/// A horizontal bar. If an end cannot be drawn, the bar keeps its row, with a text instead.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bar {
    /// Its row.
    pub row: usize,
    /// Its start.
    pub from: f64,
    /// Its end, the value.
    pub to: f64,
    /// Lower and upper bound of the value.
    pub interval: Option<(f64, f64)>,
    /// A published value, drawn as a hollow diamond.
    pub published: Option<f64>,
    /// Text after it; in place of a bar that cannot be drawn, the reason.
    pub label: String,
    /// Its value in words with its error; empty for plain numbers.
    pub said: String,
    /// The value from which the bar has the colour of another series.
    pub beyond: Option<(f64, Series)>,
}

impl Bar {
    /// Creates a bar from 0 to a value in percent, with the value written after it; `None` keeps the row.
    pub fn percent(row: usize, value: Option<f64>, interval: Option<(f64, f64)>) -> Self {
        let label = value.map_or_else(String::new, percent);
        Self { row, to: value.unwrap_or(f64::NAN), interval, label, ..Self::default() }
    }

    /// Returns the bar as drawn; `None` if it cannot be drawn.
    pub(super) fn drawn(&self) -> Option<Self> {
        drawable(self.from).and(drawable(self.to))?;
        let interval = self.interval.and_then(|(low, high)| drawable(low).zip(drawable(high)));
        Some(Self { interval, ..self.clone() })
    }

    /// Returns the non-empty part that belongs to another series: its start and the end.
    pub(super) fn of_other(&self) -> Option<(f64, f64, &Series)> {
        let (split, series) = self.beyond.as_ref()?;
        let split = drawable(*split)?.clamp(self.from.min(self.to), self.from.max(self.to));
        (split != self.to).then_some((split, self.to, series))
    }

    /// Returns the diamond, if it can be drawn.
    pub(super) fn diamond(&self) -> Option<f64> {
        self.published.and_then(drawable)
    }
}
