//! Bars whose values are far apart as dots on a logarithmic axis.

use super::bar::Bar;
use super::model::{Body, Chart, Panel, Shape};
use super::scale::Spacing;
use super::style::drawable;
use super::text::percent;

/// Values that differ by this factor are told apart on a logarithmic axis only.
const WIDE: f64 = 100.0;
/// What is smaller than the largest value by this factor is off a logarithmic axis.
const LEAST: f64 = 1e-6;

/// Intervals are drawn to this part of the least value.
const BELOW: f64 = 0.5;

impl Chart {
    /// The chart of bars with a dot for each at its value on a logarithmic axis; `None` of another chart, or where a linear axis
    /// shows every value. A value that is not positive, or a million times smaller than the largest, is written in its row.
    pub(in crate::report) fn logarithmic(&self) -> Option<Self> {
        let Body::Panels(panels) = &self.body else { return None };
        let [panel] = &panels[..] else { return None };
        let panel = panel.logarithmic()?;
        Some(Self { body: Body::Panels(vec![panel]), ..self.clone() })
    }
}

impl Panel {
    fn logarithmic(&self) -> Option<Self> {
        let bars: Vec<&Bar> = self.bars().map(|(_, bar)| bar).collect();
        let is_plain = |bar: &&Bar| bar.from == 0.0 && bar.published.is_none();
        if self.x.spacing == Spacing::Logarithmic || bars.len() != self.marks.len() || !bars.iter().all(is_plain) {
            return None;
        }
        let values = || bars.iter().filter_map(|bar| drawable(bar.to)).filter(|value| *value > 0.0);
        let largest = values().fold(0.0, f64::max);
        let least = values().filter(|value| *value > LEAST * largest).fold(largest, f64::min);
        if largest <= 0.0 || least * WIDE > largest {
            return None;
        }
        let marks = self.bars().map(|(mark, bar)| mark.series.mark(Shape::Bar(bar.dot(least))));
        let x = self.x.clone().spaced(Spacing::Logarithmic);
        Some(Self { marks: marks.collect(), x, ..self.clone() })
    }
}

impl Bar {
    /// The bar without length on an axis whose least value is `least`; what is smaller is only written.
    fn dot(&self, least: f64) -> Self {
        let is_shown = drawable(self.to).is_some_and(|value| value >= least);
        let label = if self.label.is_empty() && self.to.is_finite() { percent(self.to) } else { self.label.clone() };
        match is_shown {
            true => {
                let interval = self.interval.map(|(low, high)| (low.max(BELOW * least), high));
                Self { from: self.to, interval, beyond: None, ..self.clone() }
            }
            false => Self { to: f64::NAN, label, beyond: None, ..self.clone() },
        }
    }
}
