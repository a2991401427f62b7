//! Where panels, groups, bars and names go.

use super::super::plot::{Plot, axis_title, tick_room, title_room};
use super::super::scale::{Scale, Spacing, Wish};
use super::super::style::{ChartWidth, MARGIN, TICK, VALUE};
use super::super::text::{percent, shorten, widest_word, wrap};
use super::{GroupedBars, Panel};

/// Part of a group's pitch that its bars fill.
pub(super) const FILL: f64 = 0.84;
/// Part of a bar's slot that the bar fills.
const BODY: f64 = 0.94;
/// Widest bar, px.
const WIDEST: f64 = 44.0;
/// Thinnest slot of a bar, px, before the figure grows.
const THINNEST: f64 = 4.0;
/// Room kept for a value label above the highest bar, px.
const HEADROOM: f64 = 18.0;
/// Longest turned name, px, and the same on a phone; longer ones are shortened.
const LONGEST_NAME: (f64, f64) = (150.0, 110.0);
/// Heights of the plots of a figure with one row of panels and with several, px.
const HEIGHTS: (f64, f64) = (250.0, 190.0);
/// The same on a phone.
const NARROW_HEIGHTS: (f64, f64) = (200.0, 170.0);
/// Gap between panels, px.
const GAP: f64 = 18.0;
/// Room for a panel's title, px.
const PANEL_HEAD: f64 = 30.0;

/// How the names of the categories are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Names {
    /// Level, in up to so many lines.
    Level(usize),
    /// Rising to the right by so many degrees.
    Turned(f64),
}

/// Lengths and scale common to all panels, px.
pub(super) struct Layout {
    pub width: f64,
    pub page: ChartWidth,
    pub columns: usize,
    pub scale: Scale,
    pub names: Names,
    /// Height below the plot that the names take.
    pub names_room: f64,
    /// Left edge of the first plot.
    left: f64,
    plot_width: f64,
    plot_height: f64,
    tick_room: f64,
}

impl Layout {
    /// The first arrangement, from panels side by side to one column, in which value labels and level names
    /// fit; one column if none does.
    pub fn of(chart: &GroupedBars, page: ChartWidth) -> Self {
        let side_by_side = (2..=chart.panels.len().min(page.choose(3, 1))).rev();
        side_by_side
            .map(|columns| Self::with(chart, (columns, page)))
            .find(|layout| {
                matches!(layout.names, Names::Level(_)) && layout.slot(chart.busiest()) >= labelled_slot(chart)
            })
            .unwrap_or_else(|| Self::with(chart, (1, page)))
    }

    fn with(chart: &GroupedBars, (columns, page): (usize, ChartWidth)) -> Self {
        let heights = page.choose(HEIGHTS, NARROW_HEIGHTS);
        let plot_height = if columns > 1 || chart.panels.len() == 1 { heights.0 } else { heights.1 };
        let scale = shared_scale(chart, plot_height);
        let tick_room = tick_room(&scale);
        let (groups, bars) = chart.busiest();
        let title = axis_title(&chart.y_label, "", scale.exponent);
        let mut left = MARGIN + title_room(&title, plot_height) + tick_room;
        let needed = (groups * bars) as f64 * THINNEST / FILL;
        let width = |left: f64| page.choose(page.px().max(left + needed + MARGIN), page.px());
        let between = (columns - 1) as f64 * (GAP + tick_room);
        let plot_width = |left: f64| (width(left) - left - MARGIN - between) / columns as f64;
        let names = name_style(chart, plot_width(left) / groups as f64);
        if let Names::Turned(degrees) = names {
            left = left.max(left_for_turned(chart, degrees, (width(left), page)));
        }
        Self {
            width: width(left),
            page,
            columns,
            scale,
            names,
            names_room: names_room(chart, names, page),
            left,
            plot_width: plot_width(left),
            plot_height,
            tick_room,
        }
    }

    /// The plotting rectangle of a panel whose column and upper edge (of the panel's title) are given.
    pub fn plot(&self, column: usize, top: f64) -> Plot {
        Plot {
            left: self.left + column as f64 * (self.plot_width + GAP + self.tick_room),
            top: top + PANEL_HEAD,
            width: self.plot_width,
            height: self.plot_height,
        }
    }

    /// Where the title of the vertical axis has its baseline.
    pub fn y_title(&self) -> f64 {
        self.left - self.tick_room - 6.0
    }

    /// Distance from one bar of a group to the next, px.
    fn slot(&self, (groups, bars): (usize, usize)) -> f64 {
        (self.plot_width / groups as f64 * FILL / bars as f64).min(WIDEST / BODY)
    }

    /// The bars of a panel as (left edge, width) by category and series.
    pub fn bar(&self, panel: &Panel, plot: &Plot, (category, series): (usize, usize)) -> (f64, f64) {
        let (groups, bars) = (panel.categories.len().max(1), panel.series.len().max(1));
        let slot = self.slot((groups, bars));
        let middle = self.group(panel, plot, category);
        let left = middle + (series as f64 - bars as f64 / 2.0) * slot;
        (left + slot * (1.0 - BODY) / 2.0, slot * BODY)
    }

    /// Middle of a group.
    pub fn group(&self, panel: &Panel, plot: &Plot, category: usize) -> f64 {
        plot.left + (category as f64 + 0.5) * self.pitch(panel)
    }

    /// Distance from one group to the next.
    pub fn pitch(&self, panel: &Panel) -> f64 {
        self.plot_width / panel.categories.len().max(1) as f64
    }

    /// A turned name, shortened if need be.
    pub fn turned_name(&self, name: &str) -> String {
        turned_name(name, self.page)
    }

    /// Whether value labels are narrow enough for the bars of a panel.
    pub fn labelled(&self, chart: &GroupedBars, panel: &Panel) -> bool {
        let slot = self.slot((panel.categories.len().max(1), panel.series.len().max(1)));
        slot >= labelled_slot(chart)
    }
}

impl GroupedBars {
    /// Most categories and most series of any panel, at least one of each.
    fn busiest(&self) -> (usize, usize) {
        let most = |count: fn(&Panel) -> usize| self.panels.iter().map(count).max().unwrap_or(0).max(1);
        (most(|panel| panel.categories.len()), most(|panel| panel.series.len()))
    }
}

fn turned_name(name: &str, page: ChartWidth) -> String {
    shorten(name, page.choose(LONGEST_NAME.0, LONGEST_NAME.1), TICK)
}

/// The slot of a bar from which value labels are drawn: the mean label just fits.
fn labelled_slot(chart: &GroupedBars) -> f64 {
    let slots = chart.panels.iter().flat_map(Panel::slots);
    let widths: Vec<f64> = slots.filter_map(|(i, series)| Some(VALUE.width(&percent(series.bar(i)?.value)))).collect();
    widths.iter().sum::<f64>() / widths.len().max(1) as f64 + 1.0
}

fn all_names(chart: &GroupedBars) -> impl Iterator<Item = &str> {
    chart.panels.iter().flat_map(|panel| &panel.categories).map(String::as_str)
}

fn name_style(chart: &GroupedBars, pitch: f64) -> Names {
    let room = pitch - 6.0;
    let most = all_names(chart).map(|name| wrap(name, room, TICK).len()).max().unwrap_or(1).max(1);
    if most <= 3 && all_names(chart).all(|name| widest_word(name, TICK) <= room) {
        Names::Level(most)
    } else if pitch >= 18.0 {
        Names::Turned(40.0)
    } else {
        Names::Turned(90.0)
    }
}

/// Height that the names take below a plot, px.
fn names_room(chart: &GroupedBars, names: Names, page: ChartWidth) -> f64 {
    const AIR: f64 = 10.0;
    match names {
        Names::Level(lines) => AIR + lines as f64 * TICK.leading(),
        Names::Turned(degrees) => {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let lengths = all_names(chart).map(|name| TICK.width(&turned_name(name, page)));
            AIR + lengths.fold(0.0, f64::max) * sin + TICK.size * cos
        }
    }
}

/// The left edge of the plots, one below the other in a figure of this width, from which turned names, that
/// reach to the left of their groups, stay inside the figure.
fn left_for_turned(chart: &GroupedBars, degrees: f64, (width, page): (f64, ChartWidth)) -> f64 {
    let cos = degrees.to_radians().cos();
    let name = |panel: &Panel, i: usize| {
        // The group's middle is `left + part * (width - MARGIN - left)`; solved for `left`.
        let part = (i as f64 + 0.5) / panel.categories.len() as f64;
        let reach = TICK.width(&turned_name(&panel.categories[i], page)) * cos;
        (MARGIN + reach - part * (width - MARGIN)) / (1.0 - part)
    };
    let panels = chart.panels.iter();
    panels.flat_map(|panel| (0..panel.categories.len()).map(move |i| name(panel, i))).fold(0.0, f64::max)
}

/// One scale for all panels: zero, every value, bound and published value, and room for labels above.
fn shared_scale(chart: &GroupedBars, plot_height: f64) -> Scale {
    let slots = chart.panels.iter().flat_map(Panel::slots);
    let mut values: Vec<f64> = slots
        .flat_map(|(i, series)| {
            let bar = series.bar(i);
            let (low, high) = bar.and_then(|bar| bar.interval).unzip();
            [bar.map(|bar| bar.value), low, high, series.published(i)]
        })
        .flatten()
        .collect();
    if values.is_empty() {
        values.push(100.0);
    }
    let low = values.iter().copied().fold(0.0, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    let span = high - low;
    values = vec![high + span * HEADROOM / plot_height];
    values.push(if low < 0.0 { low - span * 6.0 / plot_height } else { 0.0 });
    Scale::over(values, Wish { spacing: Spacing::Linear, air: 0.0, steps: 6 })
}
