//! Pages, charts, and results that are read again.

mod live;
mod page;
mod result_reading;
mod scatter;
mod scene_files;
mod terminal;
