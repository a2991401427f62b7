//! Any chart, for whoever lays out charts without caring what kind they are.

use super::{ChartError, GroupedBars, LineChart, RangeBars, ScatterChart};

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
}

/// For which room a chart is laid out; texts have the same size in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChartWidth {
    /// A page column, 720 px.
    #[default]
    Wide,
    /// A phone, 360 px.
    Narrow,
}

impl Chart {
    /// Headline of the chart.
    pub fn title(&self) -> &str {
        match self {
            Self::Bars(chart) => &chart.title,
            Self::Lines(chart) => &chart.title,
            Self::Ranges(chart) => &chart.title,
            Self::Scatter(chart) => &chart.title,
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
        match self {
            Self::Bars(chart) => chart.svg(),
            Self::Lines(chart) => chart.svg(),
            Self::Ranges(chart) => chart.svg(),
            Self::Scatter(chart) => chart.svg(),
            Self::Picture(picture) => Ok(match width {
                ChartWidth::Wide => picture.wide.clone(),
                ChartWidth::Narrow => picture.narrow.clone(),
            }),
        }
    }
}
