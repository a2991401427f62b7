//! Any chart, for whoever lays out charts without caring what kind they are.

use super::style::Medium;
use super::{ChartError, ChartWidth, CloudChart, GroupedBars, LineChart, RangeBars, ScatterChart};

/// A chart of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Chart {
    /// Grouped bars.
    Bars(GroupedBars),
    /// Lines.
    Lines(LineChart),
    /// Level bars.
    Ranges(RangeBars),
    /// Labelled points.
    Scatter(ScatterChart),
    /// Clouds of points.
    Cloud(CloudChart),
    /// A picture that was drawn elsewhere.
    Picture(Picture),
}

/// A drawn picture with its words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Headline.
    pub title: String,
    /// One sentence under the picture.
    pub caption: String,
    /// The SVG document for a page column.
    pub wide: String,
    /// The SVG document for a phone.
    pub narrow: String,
    /// The SVG element for a page column of a page that sets title and caption as text.
    pub inline_wide: String,
    /// The same for a phone.
    pub inline_narrow: String,
}

impl Chart {
    /// Headline of the chart.
    pub fn title(&self) -> &str {
        match self {
            Self::Bars(chart) => &chart.title,
            Self::Lines(chart) => &chart.title,
            Self::Ranges(chart) => &chart.title,
            Self::Scatter(chart) => &chart.title,
            Self::Cloud(chart) => &chart.title,
            Self::Picture(picture) => &picture.title,
        }
    }

    /// The sentence under the chart.
    pub fn caption(&self) -> &str {
        match self {
            Self::Bars(chart) => &chart.caption,
            Self::Lines(chart) => &chart.caption,
            Self::Ranges(chart) => &chart.caption,
            Self::Scatter(chart) => &chart.caption,
            Self::Cloud(chart) => &chart.caption,
            Self::Picture(picture) => &picture.caption,
        }
    }

    /// The chart as an SVG document for a page column.
    ///
    /// # Errors
    /// [`ChartError`] if there is nothing to draw, or the data of the chart do not fit together.
    pub fn svg(&self) -> Result<String, ChartError> {
        self.svg_at(ChartWidth::Wide)
    }

    /// The chart as an SVG document for `width`.
    ///
    /// # Errors
    /// [`ChartError`], as for [`svg`](Self::svg).
    pub fn svg_at(&self, width: ChartWidth) -> Result<String, ChartError> {
        self.drawn(width.into())
    }

    /// The chart as an SVG element for a page that sets [`title`](Self::title) and [`caption`](Self::caption) as text: it
    /// has a `viewBox` but no size, so that the style of the page scales it; an `aria-label`, and title and description
    /// for screen readers; and no `id`, so that any number of them may stand on a page.
    ///
    /// ```
    /// use apportion::report::chart::{Axis, Chart, ChartWidth, Range, RangeBars, RangeRow, Role};
    ///
    /// let bars = vec![Range { role: Role::Other(0), from: 0.0, to: 4.0 }];
    /// let chart = Chart::Ranges(RangeBars {
    ///     title: "Effects".into(),
    ///     caption: "The thickness matters.".into(),
    ///     x: Axis { label: "effect".into(), unit: "nN".into(), ..Axis::default() },
    ///     reference: None,
    ///     series: Vec::new(),
    ///     interval_label: String::new(),
    ///     rows: vec![RangeRow { name: "thickness".into(), bars, interval: None, note: String::new() }],
    /// });
    /// let svg = chart.inline(ChartWidth::Narrow)?;
    /// assert!(svg.starts_with("<svg") && svg.contains("viewBox=\"0 0 360 "));
    /// # Ok::<(), apportion::report::chart::ChartError>(())
    /// ```
    ///
    /// # Errors
    /// [`ChartError`], as for [`svg`](Self::svg).
    pub fn inline(&self, width: ChartWidth) -> Result<String, ChartError> {
        self.drawn(Medium { width, inline: true })
    }

    /// What the chart shows in words: its caption, then axes, series and, where they are few, all numbers.
    pub fn description(&self) -> String {
        let data = match self {
            Self::Bars(chart) => chart.description(),
            Self::Lines(chart) => chart.description(),
            Self::Ranges(chart) => chart.description(),
            Self::Scatter(chart) => chart.description(),
            Self::Cloud(chart) => chart.description(),
            Self::Picture(_) => String::new(),
        };
        format!("{} {data}", self.caption()).trim().to_owned()
    }

    fn drawn(&self, medium: Medium) -> Result<String, ChartError> {
        match self {
            Self::Bars(chart) => chart.drawn(medium),
            Self::Lines(chart) => chart.drawn(medium),
            Self::Ranges(chart) => chart.drawn(medium),
            Self::Scatter(chart) => chart.drawn(medium),
            Self::Cloud(chart) => chart.drawn(medium),
            Self::Picture(picture) => {
                let Picture { wide, narrow, inline_wide, inline_narrow, .. } = picture;
                let (wide, narrow) = if medium.inline { (inline_wide, inline_narrow) } else { (wide, narrow) };
                Ok(medium.width.choose(wide, narrow).clone())
            }
        }
    }
}
