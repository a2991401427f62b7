//! Charts as SVG text, PNG pictures and PDF pages, all in one style.
//!
//! A [`Chart`] is plain data: panels of marks on axes, each mark of a [`Series`]. One layout and one drawing pass turn
//! it into SVG; [`png()`] turns the SVG into a picture, and `pdf()` into a page of vectors and text. Colours belong to
//! series by number, see [`Colour`]. The same data give the same bytes. Text is escaped, and is laid out with the
//! advances of the embedded faces, which are those of Arial. Numbers that cannot be drawn (not finite, or beyond 1e300)
//! appear as missing values or gaps.

mod draw;
mod figure;
mod flags;
mod labels;
mod layout;
mod model;
mod path;
#[cfg(feature = "pdf")]
mod pdf;
mod plot;
#[cfg(feature = "png")]
mod png;
mod rows;
mod scale;
mod style;
mod svg;
mod text;

pub use model::{Arrangement, Axis, Bar, Chart, Mark, Panel, Point, Series, Shape, Stroke, Tile};
#[cfg(feature = "pdf")]
pub use pdf::pdf;
#[cfg(feature = "png")]
pub use png::{PictureError, png};
pub use scale::Spacing;
pub use style::{ChartWidth, Colour, PaperWidth};
