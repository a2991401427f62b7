//! Draws the panels of grouped bars.

use super::super::figure::Figure;
use super::super::marks::DIAMOND;
use super::super::plot::{Plot, axis_title};
use super::super::style::{INK, TICK, VALUE};
use super::super::svg::{Anchor, Canvas, Px, Text};
use super::super::text::{percent, wrap};
use super::labels::{Area, Wanted, place};
use super::layout::{Layout, Names};
use super::{Bar, GroupedBars, Panel, Series};

/// Gap between a panel and its title, px.
const TITLE_RISE: f64 = 8.0;

/// A bar with its place, px.
struct Slot<'a> {
    series: &'a Series,
    category: usize,
    left: f64,
    width: f64,
    bar: Option<Bar>,
    published: Option<f64>,
}

impl Slot<'_> {
    fn at(&self, part: f64) -> f64 {
        self.left + part * self.width
    }

    /// Whether the published value has another mark beside it, and room for both.
    fn shared(&self) -> bool {
        let lone_bar = self.bar.is_some_and(|bar| bar.interval.is_none());
        !lone_bar && self.published.is_some() && self.width >= 15.0
    }

    /// Where the interval, or the mark of a missing value, stands.
    fn whisker(&self) -> f64 {
        self.at(if self.shared() { 0.27 } else { 0.5 })
    }

    /// Width of the interval's caps.
    fn cap(&self) -> f64 {
        (0.5 * self.width).min(if self.shared() { 6.0 } else { 8.0 })
    }

    /// Where the published value stands, and half its diagonal.
    fn diamond(&self) -> (f64, f64) {
        (self.at(if self.shared() { 0.71 } else { 0.5 }), (0.42 * self.width).clamp(1.5, DIAMOND))
    }
}

/// A panel being drawn.
struct Sheet<'a> {
    chart: &'a GroupedBars,
    panel: &'a Panel,
    layout: &'a Layout,
    plot: Plot,
    slots: Vec<Slot<'a>>,
}

/// Draws all panels from the figure's free room on; gives the lower edge.
pub(super) fn panels(figure: &mut Figure, chart: &GroupedBars, layout: &Layout) -> f64 {
    let mut top = figure.top;
    let mut bottom = top;
    for (i, panel) in chart.panels.iter().enumerate() {
        let column = i % layout.columns;
        if i > 0 && column == 0 {
            top = bottom + 4.0;
        }
        let plot = layout.plot(column, top);
        bottom = plot.bottom() + layout.names_room;
        let sheet = Sheet { chart, panel, layout, plot, slots: slots(panel, layout, &plot) };
        figure.canvas.open("g", &[("class", &"panel")]);
        plot.title(&mut figure.canvas, &panel.title, (TITLE_RISE, layout.page));
        plot.y_axis(&mut figure.canvas, &layout.scale);
        if column == 0 {
            let title = axis_title(&chart.y_label, "", layout.scale.exponent);
            plot.y_title(&mut figure.canvas, &title, layout.y_title());
        }
        sheet.draw(&mut figure.canvas);
        figure.canvas.close("g");
    }
    bottom
}

fn slots<'a>(panel: &'a Panel, layout: &Layout, plot: &Plot) -> Vec<Slot<'a>> {
    let count = panel.series.len().max(1);
    let place = |(i, (category, series)): (usize, (usize, &'a Series))| {
        let (left, width) = layout.bar(panel, plot, (category, i % count));
        let (bar, published) = (series.bar(category), series.published(category));
        Slot { series, category, left, width, bar, published }
    };
    panel.slots().enumerate().map(place).collect()
}

impl Sheet<'_> {
    fn draw(&self, canvas: &mut Canvas) {
        self.bars(canvas);
        let zero = self.y(0.0);
        canvas.open("g", &[("class", &"baseline"), ("stroke", &INK), ("stroke-width", &"1")]);
        canvas.line((self.plot.left, zero), (self.plot.right(), zero));
        canvas.close("g");
        self.whiskers(canvas);
        self.published(canvas);
        if self.slots.iter().all(|slot| slot.bar.is_none() && slot.published.is_none()) {
            self.plot.note(canvas, "no value");
        } else {
            self.missing(canvas);
            if self.layout.labelled(self.chart, self.panel) {
                self.values(canvas);
            }
        }
        self.names(canvas);
    }

    /// Vertical place of a drawable value; the scale is linear and covers all of them.
    fn y(&self, value: f64) -> f64 {
        self.plot.y(&self.layout.scale, value).unwrap_or(self.plot.bottom())
    }

    fn bars(&self, canvas: &mut Canvas) {
        canvas.open("g", &[("class", &"bars")]);
        for slot in &self.slots {
            let Some(bar) = slot.bar else { continue };
            let (zero, end) = (self.y(0.0), self.y(bar.value));
            let name = &self.panel.categories[slot.category];
            canvas.tipped(
                "rect",
                &[
                    ("x", &Px(slot.left)),
                    ("y", &Px(zero.min(end))),
                    ("width", &Px(slot.width)),
                    ("height", &Px((zero - end).abs())),
                    ("fill", &slot.series.role.colour()),
                ],
                &self.chart.slot_words(name, (slot.category, slot.series)),
            );
        }
        canvas.close("g");
    }

    fn whiskers(&self, canvas: &mut Canvas) {
        canvas.open("g", &[("class", &"whiskers")]);
        for slot in &self.slots {
            if let Some((low, high)) = slot.bar.and_then(|bar| bar.interval) {
                canvas.whisker(slot.whisker(), (self.y(low), self.y(high)), slot.cap());
            }
        }
        canvas.close("g");
    }

    fn published(&self, canvas: &mut Canvas) {
        canvas.open("g", &[("class", &"published")]);
        for slot in &self.slots {
            if let Some(value) = slot.published {
                let (x, r) = slot.diamond();
                canvas.diamond((x, self.y(value)), r);
            }
        }
        canvas.close("g");
    }

    fn missing(&self, canvas: &mut Canvas) {
        canvas.open("g", &[("class", &"missing")]);
        for slot in self.slots.iter().filter(|slot| slot.bar.is_none()) {
            canvas.cross((slot.whisker(), self.y(0.0) - 6.0));
        }
        canvas.close("g");
    }

    fn values(&self, canvas: &mut Canvas) {
        let (mut marks, mut wanted, mut texts) = (Vec::new(), Vec::new(), Vec::new());
        for slot in &self.slots {
            if let Some(value) = slot.published {
                let (x, r) = slot.diamond();
                let y = self.y(value);
                marks.push(Area::about(x, r, (y - r, y + r)));
            }
            let Some(bar) = slot.bar else { continue };
            let (low, high) = bar.interval.unwrap_or((bar.value, bar.value));
            let middle = slot.at(0.5);
            marks.push(Area::about(middle, slot.width / 2.0, (self.y(0.0), self.y(bar.value))));
            marks.push(Area::about(slot.whisker(), slot.cap() / 2.0, (self.y(low), self.y(high))));
            let text = percent(bar.value);
            let above = [0.0, bar.value, low, high].map(|v| self.y(v)).into_iter().fold(f64::INFINITY, f64::min);
            wanted.push(Wanted { middle, above, width: VALUE.width(&text), height: VALUE.cap_height() });
            texts.push(text);
        }
        canvas.open("g", &[("class", &"values")]);
        for (text, area) in texts.iter().zip(place(&wanted, &marks, self.plot.top)) {
            if let Some(area) = area {
                let at = ((area.left + area.right) / 2.0, area.bottom);
                canvas.text(&Text::new(text, at, VALUE).anchor(Anchor::Middle).halo());
            }
        }
        canvas.close("g");
    }

    fn names(&self, canvas: &mut Canvas) {
        canvas.open("g", &[("class", &"categories")]);
        let pitch = self.layout.pitch(self.panel);
        let top = self.plot.bottom() + 6.0;
        for (i, name) in self.panel.categories.iter().enumerate() {
            let middle = self.layout.group(self.panel, &self.plot, i);
            match self.layout.names {
                Names::Level(_) => {
                    for (row, line) in wrap(name, pitch - 6.0, TICK).iter().enumerate() {
                        let baseline = top + TICK.cap_height() + row as f64 * TICK.leading();
                        canvas.text(&Text::new(line, (middle, baseline), TICK).anchor(Anchor::Middle));
                    }
                }
                Names::Turned(degrees) => {
                    // The end of the name hangs under the group's middle.
                    let (sin, cos) = degrees.to_radians().sin_cos();
                    let half = TICK.cap_height() / 2.0;
                    let at = (middle + half * sin, top + half * cos);
                    let text = self.layout.turned_name(name);
                    let text = Text::new(&text, at, TICK).anchor(Anchor::End).turn(-degrees).whole(name);
                    canvas.text(&text);
                }
            }
        }
        canvas.close("g");
    }
}
