//! Grouped bars with intervals and published values: shares of variance by factor.

mod draw;
pub(super) mod labels;
mod layout;
mod narrow;

use super::ChartError;
use super::figure::{Entry, Figure, Key, Words};
use super::style::{ChartWidth, Medium, Role, drawable};
use super::text::percent;
use layout::Layout;

/// A figure of grouped bars: one group per category, one bar per series, panels that share one scale.
///
/// Panels stand side by side where their bars leave room for value labels, else one above the other;
/// the figure grows wider only when bars would be thinner than a few pixels. On a phone a panel whose bars would be too
/// thin is broken into several, one above the other.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupedBars {
    /// Headline.
    pub title: String,
    /// One sentence under the figure.
    pub caption: String,
    /// Title of the vertical axis with its unit, such as "Share of variance (%)".
    pub y_label: String,
    /// Name of the intervals in the legend, such as "95 % interval".
    pub interval_label: String,
    /// Name of the published values in the legend.
    pub published_label: String,
    /// At least one.
    pub panels: Vec<Panel>,
}

/// One plot of a [`GroupedBars`] figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Headline of the panel.
    pub title: String,
    /// Names of the groups along the horizontal axis, such as factors.
    pub categories: Vec<String>,
    /// The bars, in their order within each group.
    pub series: Vec<Series>,
}

/// One bar per category, all of one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Which colour.
    pub role: Role,
    /// One entry per category; `None`, and a value that is not finite, is marked as missing.
    pub values: Vec<Option<Bar>>,
    /// Values from elsewhere, drawn as hollow diamonds: one entry per category, or empty for none.
    pub published: Vec<Option<f64>>,
}

/// A value with its interval, both in the unit of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Height of the bar; may be negative.
    pub value: f64,
    /// Lower and upper bound; an interval with a bound that is not finite is not drawn.
    pub interval: Option<(f64, f64)>,
}

impl Bar {
    /// The bar if its value can be drawn, without an interval that cannot.
    fn drawable(self) -> Option<Self> {
        drawable(self.value)?;
        let interval = self.interval.filter(|&(low, high)| drawable(low).and(drawable(high)).is_some());
        Some(Self { interval, ..self })
    }

    /// Value and interval in words.
    fn words(self) -> String {
        match self.interval {
            Some((low, high)) => format!("{} ({} to {})", percent(self.value), percent(low), percent(high)),
            None => percent(self.value),
        }
    }
}

impl Series {
    fn bar(&self, category: usize) -> Option<Bar> {
        self.values.get(category).copied().flatten().and_then(Bar::drawable)
    }

    fn published(&self, category: usize) -> Option<f64> {
        self.published.get(category).copied().flatten().and_then(drawable)
    }
}

impl Panel {
    /// All bars as (category, series), in the order they stand.
    fn slots(&self) -> impl Iterator<Item = (usize, &Series)> {
        (0..self.categories.len()).flat_map(|category| self.series.iter().map(move |series| (category, series)))
    }
}

impl GroupedBars {
    /// Draws the figure as an SVG document, the same bytes for the same figure.
    ///
    /// # Errors
    /// [`ChartError::NoPanels`] without panels, [`ChartError::Length`] if a series has not one value (and
    /// not one or no published value) per category.
    ///
    /// # Example
    /// ```
    /// use apportion::report::chart::{Bar, GroupedBars, Panel, Role, Series, png};
    ///
    /// let figure = GroupedBars {
    ///     title: "Critical force".into(),
    ///     caption: "Shares of the variance of the critical force.".into(),
    ///     y_label: "Share of variance (%)".into(),
    ///     interval_label: "95 % interval".into(),
    ///     published_label: "published".into(),
    ///     panels: vec![Panel {
    ///         title: "First order".into(),
    ///         categories: vec!["thickness".into(), "length".into()],
    ///         series: vec![Series {
    ///             name: "Coulomb".into(),
    ///             role: Role::Coulomb,
    ///             values: vec![Some(Bar { value: 61.0, interval: Some((59.5, 62.5)) }), None],
    ///             published: vec![Some(60.0), Some(40.0)],
    ///         }],
    ///     }],
    /// };
    /// let svg = figure.svg()?;
    /// assert!(svg.starts_with("<svg"));
    /// assert_eq!(png(&svg)?.width, 1440);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn svg(&self) -> Result<String, ChartError> {
        self.svg_at(ChartWidth::Wide)
    }

    /// The figure as an SVG document for `width`.
    ///
    /// # Errors
    /// As [`svg`](Self::svg).
    pub fn svg_at(&self, width: ChartWidth) -> Result<String, ChartError> {
        self.drawn(width.into())
    }

    pub(super) fn drawn(&self, medium: Medium) -> Result<String, ChartError> {
        self.check()?;
        match medium.width {
            ChartWidth::Wide => Ok(self.figure(self, medium)),
            ChartWidth::Narrow => Ok(self.figure(&narrow::in_rows(self), medium)),
        }
    }

    /// The figure with its own words and the panels of `laid_out`.
    fn figure(&self, laid_out: &Self, medium: Medium) -> String {
        let layout = Layout::of(laid_out, medium.width);
        let words = Words { title: &self.title, caption: &self.caption };
        let mut figure = Figure::begin_grown((medium, layout.width), words, &self.legend());
        let bottom = draw::panels(&mut figure, laid_out, &layout);
        figure.finish(bottom, &self.description())
    }

    fn check(&self) -> Result<(), ChartError> {
        if self.panels.is_empty() {
            return Err(ChartError::NoPanels { chart: self.title.clone() });
        }
        for panel in &self.panels {
            let expected = panel.categories.len();
            for series in &panel.series {
                let published = series.published.len();
                let wrong = [(series.values.len(), "values"), (published, "published values")]
                    .into_iter()
                    .find(|&(found, what)| found != expected && (found > 0 || what == "values"));
                if let Some((found, what)) = wrong {
                    let (panel, series) = (panel.title.clone(), series.name.clone());
                    return Err(ChartError::Length { panel, series, what, expected, found });
                }
            }
        }
        Ok(())
    }

    /// Every series once, then the marks that occur.
    fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            let entry = Entry { name: series.name.clone(), key: Key::Swatch(series.role) };
            if !entries.contains(&entry) {
                entries.push(entry);
            }
        }
        let any = |test: fn((usize, &Series)) -> bool| self.panels.iter().any(|panel| panel.slots().any(test));
        if any(|(category, series)| series.bar(category).is_some_and(|bar| bar.interval.is_some())) {
            entries.push(Entry { name: self.interval_label.clone(), key: Key::Whisker });
        }
        if any(|(category, series)| series.published(category).is_some()) {
            entries.push(Entry { name: self.published_label.clone(), key: Key::Diamond });
        }
        if any(|(category, series)| series.bar(category).is_none()) {
            entries.push(Entry { name: "no value".to_owned(), key: Key::Cross });
        }
        entries
    }

    /// All numbers in words.
    pub(super) fn description(&self) -> String {
        let mut words = format!("{}.", self.y_label);
        for panel in &self.panels {
            words.push_str(&format!(" {}:", panel.title));
            for (category, series) in panel.slots() {
                words.push_str(&format!(" {};", self.slot_words(&panel.categories[category], (category, series))));
            }
        }
        words
    }

    /// A bar in words: names, value, interval, published value.
    fn slot_words(&self, name: &str, (category, series): (usize, &Series)) -> String {
        let value = series.bar(category).map_or_else(|| "no value".to_owned(), Bar::words);
        let mut words = format!("{name}, {}: {value}", series.name);
        if let Some(published) = series.published(category) {
            words.push_str(&format!(", {} {}", self.published_label, percent(published)));
        }
        words
    }
}

#[cfg(test)]
mod tests;
