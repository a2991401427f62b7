//! The readings as charts.

use super::Readings;
use crate::report::chart::Chart;

pub fn distance_chart(_readings: &Readings) -> Chart {
    todo!()
}

pub fn small_sample_chart(_readings: &Readings) -> Chart {
    todo!()
}
