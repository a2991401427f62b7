//! The text of a chart besides title and caption: its legend, its axes, and its bars in words.

use super::bar::Bar;
use super::figure::{Entry, Key};
use super::model::{Chart, Mark, Panel, Shape};
use super::series::Stroke;
use super::text::percent;

impl Chart {
    /// Returns every series with a name once, in the order of the marks; then intervals and published values, if any.
    pub(super) fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        for Mark { series, shape } in self.marks() {
            let key = match shape {
                Shape::Line(_) => Key::Line(series.colour, series.stroke),
                Shape::Dots(_) | Shape::Point(_) => Key::Line(series.colour, Stroke::Points),
                Shape::Bar(_) | Shape::Tile(_) => Key::Swatch(series.colour, series.stroke),
                _ => continue,
            };
            let other = match shape {
                Shape::Bar(bar) => {
                    bar.of_other().map(|(.., series)| (series, Key::Swatch(series.colour, series.stroke)))
                }
                _ => None,
            };
            for (series, key) in std::iter::once((series, key)).chain(other) {
                let entry = Entry { name: series.name.clone(), key };
                if !series.name.trim().is_empty() && !entries.contains(&entry) {
                    entries.push(entry);
                }
            }
        }
        let any = |test: fn(&Shape) -> bool| self.marks().any(|mark| test(&mark.shape));
        let has_interval = |shape: &Shape| match shape {
            Shape::Bar(bar) => bar.drawn().is_some_and(|bar| bar.interval.is_some()),
            _ => false,
        };
        if any(has_interval) {
            entries.push(Entry { name: "95 % interval".to_owned(), key: Key::Whisker });
        }
        if any(|shape| matches!(shape, Shape::Bar(bar) if bar.diamond().is_some())) {
            entries.push(Entry { name: "published".to_owned(), key: Key::Diamond });
        }
        entries
    }

    /// Describes the axes of its panels; the numbers are in tables.
    pub(super) fn axes(&self) -> String {
        let panel = |panel: &Panel| {
            let title = if panel.title.trim().is_empty() { String::new() } else { format!("{}: ", panel.title.trim()) };
            let vertical = match panel.y.names.is_empty() {
                true => format!(", vertical axis {}", panel.y.title(0)),
                false => format!(", rows {}", panel.y.names.join(", ")),
            };
            format!("{title}horizontal axis {}{vertical}.", panel.x.title(0))
        };
        self.panels.iter().map(panel).collect::<Vec<_>>().join(" ")
    }

    /// Describes a drawn bar: names, value, interval, published value.
    pub(super) fn bar_in_words(&self, panel: &Panel, series: &str, bar: &Bar) -> String {
        let number = |value: f64| if bar.label.is_empty() { value.to_string() } else { percent(value) };
        let mut value = bar.said.clone();
        if value.is_empty() {
            if bar.from != 0.0 && bar.from != bar.to {
                value.push_str(&format!("{} to ", number(bar.from)));
            }
            value.push_str(&number(bar.to));
            if let Some((low, high)) = bar.interval {
                value.push_str(&format!(" ({} to {})", number(low), number(high)));
            }
        }
        let published = bar.diamond().map(|value| format!(", published {}", number(value)));
        let row = panel.y.names.get(bar.row).map_or("", String::as_str);
        format!("{row}, {series}: {value}{}", published.unwrap_or_default())
    }
}
