//! What the readings say, in sentences.

use super::Readings;

pub fn summary(_readings: &Readings) -> Vec<String> {
    Vec::new()
}
