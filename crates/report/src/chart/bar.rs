//! Level bars.

use super::series::Series;
use super::style::drawable;
use super::text::percent;

/// A level bar. One with an end that cannot be drawn keeps its place, which says so.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bar {
    /// Its row.
    pub row: usize,
    /// Where it begins.
    pub from: f64,
    /// Where it ends: its value.
    pub to: f64,
    /// Lower and upper bound of the value.
    pub interval: Option<(f64, f64)>,
    /// The value from elsewhere, drawn as a hollow diamond.
    pub published: Option<f64>,
    /// Written after it; in the place of a bar that cannot be drawn, why.
    pub label: String,
    /// Its value in words, with its error; empty for the plain numbers.
    pub said: String,
    /// The part from a value on, which is that of another series.
    pub beyond: Option<(f64, Series)>,
}

impl Bar {
    /// A bar from 0 to a value in percent, with the value written after it; `None` keeps its place.
    pub fn percent(row: usize, value: Option<f64>, interval: Option<(f64, f64)>) -> Self {
        let label = value.map_or_else(String::new, percent);
        Self { row, to: value.unwrap_or(f64::NAN), interval, label, ..Self::default() }
    }

    /// The bar as it is drawn; `None` if it cannot be.
    pub(super) fn drawn(&self) -> Option<Self> {
        drawable(self.from).and(drawable(self.to))?;
        let interval = self.interval.and_then(|(low, high)| drawable(low).zip(drawable(high)));
        Some(Self { interval, ..self.clone() })
    }

    /// The part that is of another series, if there is something of it: from where to the end.
    pub(super) fn of_other(&self) -> Option<(f64, f64, &Series)> {
        let (split, series) = self.beyond.as_ref()?;
        let split = drawable(*split)?.clamp(self.from.min(self.to), self.from.max(self.to));
        (split != self.to).then_some((split, self.to, series))
    }

    /// The diamond, if it can be drawn.
    pub(super) fn diamond(&self) -> Option<f64> {
        self.published.and_then(drawable)
    }
}
