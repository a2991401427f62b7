//! Draws a scatter chart.

use super::super::bars::labels::Area;
use super::super::figure::Figure;
use super::super::marks::Ends;
use super::super::plot::{Plot, TICK_GAP, tick_room, title_room};
use super::super::scale::{Scale, Spacing, Wish};
use super::super::style::{ChartWidth, MARGIN, MUTED, TICK};
use super::super::svg::{Anchor, Canvas, Text};
use super::super::text::shorten;
use super::labels::{Place, Wanted, place};
use super::{Guide, ScatterChart, ScatterPoint};

/// Height of the plot, px, and the same on a phone.
const HEIGHTS: (f64, f64) = (400.0, 290.0);
/// Room above the plot for the ends of steep guides, px.
const HEAD: f64 = 18.0;
/// Longest label of a guide, px, and the same on a phone.
const LONGEST_GUIDE: (f64, f64) = (120.0, 64.0);
/// Longest label of a point on a phone, px.
const LONGEST_LABEL: f64 = 110.0;
/// Most points that are labelled: more would be a thicket.
const MOST_LABELS: usize = 60;

/// Draws the plot into the figure's free room; gives the lower edge.
pub(super) fn plot(figure: &mut Figure, chart: &ScatterChart, page: ChartWidth) -> f64 {
    let height = page.choose(HEIGHTS.0, HEIGHTS.1);
    let points = || chart.series.iter().flat_map(|series| &series.points);
    let ends = |interval: Option<(f64, f64)>| interval.into_iter().flat_map(|(low, high)| [low, high]);
    let xs = points().flat_map(|point| ends(point.x_interval).chain([point.x]));
    let ys = points().flat_map(|point| ends(point.y_interval).chain([point.y]));
    let (x, y) = (scale(xs, page.choose(6, 4)), scale(ys, 6));
    let y_title = chart.y.title(y.exponent);
    let left = MARGIN + title_room(&y_title, height) + tick_room(&y);
    let beside = chart.guides.iter().map(|guide| TICK.width(&guide_label(guide, page)) + 4.0).fold(0.0, f64::max);
    let overhang = x.ticks.last().map_or(0.0, |tick| TICK.width(&tick.label) / 2.0 + 4.0);
    let width = page.px() - left - MARGIN - beside.max(overhang);
    let plot = Plot { left, top: figure.top + HEAD, width, height };
    let x = if page == ChartWidth::Narrow { x.with_room(width) } else { x };
    let canvas = &mut figure.canvas;
    canvas.open("g", &[("class", &"panel")]);
    plot.x_grid(canvas, &x);
    plot.y_axis(canvas, &y);
    plot.y_title(canvas, &y_title, left - tick_room(&y) - TICK_GAP - 3.0);
    plot.axis_lines(canvas);
    let sheet = Sheet { chart, plot, x: &x, y: &y, page };
    sheet.guides(canvas);
    sheet.labels(canvas);
    sheet.points(canvas);
    if points().all(|point| sheet.at(point).is_none()) {
        plot.note(canvas, "no value");
    }
    canvas.close("g");
    plot.x_labels(canvas, &x, &chart.x.title(x.exponent))
}

/// Zero belongs to both axes, and a little air above the largest value.
fn scale(values: impl Iterator<Item = f64>, steps: usize) -> Scale {
    Scale::over(values.chain([0.0]), Wish { spacing: Spacing::Linear, air: 0.06, steps })
}

struct Sheet<'a> {
    chart: &'a ScatterChart,
    plot: Plot,
    x: &'a Scale,
    y: &'a Scale,
    page: ChartWidth,
}

impl Sheet<'_> {
    fn at(&self, point: &ScatterPoint) -> Option<(f64, f64)> {
        Some((self.plot.x(self.x, point.x)?, self.plot.y(self.y, point.y)?))
    }

    fn guides(&self, canvas: &mut Canvas) {
        let origin = self.plot.x(self.x, 0.0).zip(self.plot.y(self.y, 0.0));
        let (Some(origin), Some(x_px), Some(y_px)) =
            (origin, px_per_unit(self.x, self.plot.width), px_per_unit(self.y, self.plot.height))
        else {
            return;
        };
        canvas.open("g", &[("class", &"guides")]);
        for guide in &self.chart.guides {
            let rise = guide.slope * (y_px / x_px);
            if !(rise.is_finite() && rise > 0.0) {
                continue;
            }
            let (width, height) = (self.plot.right() - origin.0, origin.1 - self.plot.top);
            let steep = rise > height / width;
            let end = if steep {
                (origin.0 + height / rise, self.plot.top)
            } else {
                (self.plot.right(), origin.1 - rise * width)
            };
            canvas.open("g", &[("stroke", &MUTED), ("stroke-width", &"1"), ("stroke-dasharray", &"5 4")]);
            canvas.line(origin, end);
            canvas.close("g");
            let label = guide_label(guide, self.page);
            let text = if steep {
                Text::new(&label, (end.0, end.1 - 4.0), TICK).anchor(Anchor::Middle)
            } else {
                Text::new(&label, (end.0 + 4.0, end.1 + TICK.cap_height() / 2.0), TICK)
            };
            canvas.text(&text.fill(MUTED).whole(&guide.label));
        }
        canvas.close("g");
    }

    fn labels(&self, canvas: &mut Canvas) {
        let points = self.chart.series.iter().flat_map(|series| &series.points);
        let mut shown: Vec<_> = points.filter_map(|point| Some((point, self.at(point)?))).collect();
        shown.sort_by(|a, b| b.0.x.total_cmp(&a.0.x).then(b.0.y.total_cmp(&a.0.y)));
        let words = |label: &str| self.page.choose(label.to_owned(), shorten(label, LONGEST_LABEL, TICK));
        let wanted: Vec<Wanted> = shown
            .iter()
            .enumerate()
            .map(|(number, (point, at))| {
                // Without a label, or beyond the most labels, there is no room of any width.
                let labelled = number < MOST_LABELS && !point.label.trim().is_empty();
                let width = if labelled { TICK.width(&words(&point.label)) } else { f64::INFINITY };
                Wanted { at: *at, width, height: TICK.cap_height() }
            })
            .collect();
        let whiskers: Vec<Area> = shown
            .iter()
            .flat_map(|(point, at)| {
                let (level, upright) = self.whiskers(point);
                let level = level.map(|(from, to)| Area {
                    left: from.min(to),
                    right: from.max(to),
                    top: at.1 - 1.0,
                    bottom: at.1 + 1.0,
                });
                let upright = upright.map(|(from, to)| Area::about(at.0, 1.0, (from, to)));
                level.into_iter().chain(upright)
            })
            .collect();
        let plot = &self.plot;
        let bounds = Area { left: plot.left, right: plot.right() + 2.0, top: plot.top, bottom: plot.bottom() };
        canvas.open("g", &[("class", &"labels")]);
        for ((point, _), Place { area, leader }) in
            shown.iter().zip(place(&wanted, &whiskers, bounds)).filter_map(|(shown, place)| Some((shown, place?)))
        {
            if let Some([from, to]) = leader {
                canvas.open("g", &[("stroke", &MUTED), ("stroke-width", &"0.7")]);
                canvas.line(from, to);
                canvas.close("g");
            }
            let middle = ((area.left + area.right) / 2.0, (area.top + area.bottom + TICK.cap_height()) / 2.0);
            let label = words(&point.label);
            canvas.text(&Text::new(&label, middle, TICK).anchor(Anchor::Middle).halo().whole(&point.label));
        }
        canvas.close("g");
    }

    /// The places of a point's interval ends, along the axes.
    fn whiskers(&self, point: &ScatterPoint) -> (Ends, Ends) {
        let x = |(low, high)| Some((self.plot.x(self.x, low)?, self.plot.x(self.x, high)?));
        let y = |(low, high)| Some((self.plot.y(self.y, low)?, self.plot.y(self.y, high)?));
        (point.x_interval.and_then(x), point.y_interval.and_then(y))
    }

    fn points(&self, canvas: &mut Canvas) {
        for series in &self.chart.series {
            canvas.open("g", &[("class", &"series")]);
            canvas.content("title", &[], &series.name);
            for (at, point) in series.points.iter().filter_map(|point| Some((self.at(point)?, point))) {
                canvas.thin_whiskers(at, self.whiskers(point), series.role);
            }
            for at in series.points.iter().filter_map(|point| self.at(point)) {
                canvas.point(at, series.role);
            }
            canvas.close("g");
        }
    }
}

/// The label of a guide, shortened if need be: it takes its room from the plot.
fn guide_label(guide: &Guide, page: ChartWidth) -> String {
    shorten(&guide.label, page.choose(LONGEST_GUIDE.0, LONGEST_GUIDE.1), TICK)
}

/// Length of one unit of a linear scale that is so many px long.
fn px_per_unit(scale: &Scale, length: f64) -> Option<f64> {
    let [first, second] = [scale.ticks.first()?.value, scale.ticks.get(1)?.value];
    Some((scale.place(second)? - scale.place(first)?) * length / (second - first))
}
