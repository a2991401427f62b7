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
mod plot;
#[cfg(feature = "png")]
mod png;
mod rows;
mod scale;
mod style;
mod svg;
mod text;

pub use model::Bar;
pub use model::{Arrangement, Axis, Chart, Mark, Panel, Point, Shape, Tile};
pub use model::{Series, Stroke};
#[cfg(feature = "pdf")]
pub use png::pdf;
#[cfg(feature = "png")]
pub use png::{PictureError, png};
pub use scale::Spacing;
pub use style::Colour;
pub use style::{ChartWidth, PaperWidth};
