//! What a chart says of itself besides title and caption: its legend, and its data in words.

use super::bar::Bar;
use super::figure::{Entry, Key};
use super::model::{Chart, Mark, Panel, Point, Shape};
use super::text::percent;

impl Chart {
    /// Every series with a name once, in the order of the marks; then intervals and published values, if there are any.
    pub(super) fn legend(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = Vec::new();
        for Mark { series, shape } in self.marks() {
            let points = |line, points| Key::Line { colour: series.colour, dash: series.stroke.dash(), line, points };
            let key = match shape {
                Shape::Line(_) => points(series.stroke.has_line(), series.stroke.has_points()),
                Shape::Dots(_) | Shape::Point(_) => points(false, true),
                Shape::Bar(_) | Shape::Tile(_) => Key::Swatch(series.colour),
                _ => continue,
            };
            let other = match shape {
                Shape::Bar(bar) => bar.of_other().map(|(.., series)| (series, Key::Swatch(series.colour))),
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
            entries.push(Entry { name: self.published_name.clone(), key: Key::Diamond });
        }
        entries
    }

    /// What the chart shows in words: its caption, then axes, series and, where they are few, all numbers.
    pub fn description(&self) -> String {
        format!("{} {}", self.caption, self.data()).trim().to_owned()
    }

    /// Axes, series and numbers in words.
    pub(super) fn data(&self) -> String {
        self.all_panels().iter().map(|panel| self.panel_data(panel)).collect::<Vec<_>>().join(" ")
    }

    fn panel_data(&self, panel: &Panel) -> String {
        let title = panel.title.trim();
        let mut text = if title.is_empty() { String::new() } else { format!("{title}: ") };
        text.push_str(&format!("horizontal axis {}", panel.x.title(0)));
        if panel.y.names.is_empty() {
            text.push_str(&format!(", vertical axis {}", panel.y.title(0)));
        }
        if !panel.x.names.is_empty() {
            text.push_str(&format!(" (places: {})", panel.x.names.join(", ")));
        }
        for Mark { series, shape } in &panel.marks {
            let said = match shape {
                Shape::Line(_) => series.name.clone(),
                Shape::Dots(dots) => format!("{}: {} points", series.name, dots.len()),
                Shape::Point(Point { x, y, label }) => format!("{label}, {}: {x}, {y}", series.name),
                Shape::Bar(bar) => self.bar_in_words(panel, &series.name, bar),
                Shape::Rule(x, label) if !label.trim().is_empty() => {
                    let place = panel.x.names.get(*x as usize).cloned();
                    format!("{label} at {}", place.unwrap_or_else(|| x.to_string()))
                }
                _ => continue,
            };
            text.push_str(&format!("; {said}"));
        }
        for (row, name) in panel.y.names.iter().enumerate() {
            let letters: Vec<&str> =
                panel.tiles().filter(|(_, tile)| tile.row == row).map(|(_, tile)| tile.letter.as_str()).collect();
            if !letters.is_empty() {
                text.push_str(&format!("; {name}: {}", letters.join(" ")));
            }
        }
        text + "."
    }

    /// A bar in words: names, value, interval, published value.
    pub(super) fn bar_in_words(&self, panel: &Panel, series: &str, bar: &Bar) -> String {
        let number = |value: f64| if bar.label.is_empty() { value.to_string() } else { percent(value) };
        let value = match bar.drawn() {
            None if bar.label.is_empty() => "no value".to_owned(),
            None => bar.label.clone(),
            Some(_) if !bar.said.is_empty() => bar.said.clone(),
            Some(drawn) => {
                let interval = drawn.interval.map(|(low, high)| format!(" ({} to {})", number(low), number(high)));
                let from = if bar.from == 0.0 || bar.from == bar.to {
                    String::new()
                } else {
                    format!("{} to ", number(bar.from))
                };
                from + &number(bar.to) + &interval.unwrap_or_default()
            }
        };
        let published = bar.diamond().map(|value| format!(", {} {}", self.published_name, number(value)));
        format!("{}, {series}: {value}{}", name(panel, bar.row), published.unwrap_or_default())
    }
}

/// The name of a row.
fn name(panel: &Panel, row: usize) -> &str {
    panel.y.names.get(row).map_or("", String::as_str)
}
