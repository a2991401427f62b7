//! Charts as SVG text and PNG pictures, all in one style.
//!
//! A chart is plain data, [`GroupedBars`], [`LineChart`], [`RangeBars`], [`ScatterChart`] or [`CloudChart`]; its method `svg` draws it, and [`png()`] turns the
//! SVG into a picture. Colours belong to a [`Role`], so a friction model looks the same in every chart.
//! The same data give the same bytes. Text stays text, is escaped, and is laid out with the advances of
//! the embedded faces, which are those of Arial. Numbers that cannot be drawn (not finite, or beyond
//! 1e300) appear as missing values or gaps.

mod any;
mod bars;
mod cloud;
mod error;
mod figure;
mod font;
mod lines;
mod marks;
mod plot;
mod png;
mod ranges;
mod scale;
mod scatter;
mod sheet;
mod style;
mod svg;
mod text;

#[cfg(test)]
mod reading;

pub use any::{Chart, Drawing, Picture};
pub use bars::{Bar, GroupedBars, Panel, Series};
pub use cloud::{CloudChart, CloudPanel};
pub use error::ChartError;
pub use lines::{Axis, LineChart, LinePanel, LineSeries, Marker, Stroke};
pub use png::{PNG_SCALE, Png, PngError, png};
pub use ranges::{Range, RangeBars, RangeRow, Reference};
pub use scale::Spacing;
pub use scatter::{Guide, ScatterChart, ScatterPoint, ScatterSeries};
#[doc(hidden)]
pub use sheet::{Look, Sheet, Sketch};
pub use style::{ChartWidth, Role};
