//! The means of an output over slices of a factor, as marks of a chart.

use super::super::chart::{Colour, Mark, Series, Stroke};
use super::super::result::ConditionalMeansRecord;

/// What the line is called.
pub(super) const SLICES: &str = "mean over a slice of the factor";
/// Up to so many slices, each mean is marked by a point.
const FEW_SLICES: usize = 12;

/// The means of the output over slices of a factor.
pub(super) struct Means {
    pub series: Series,
    pub points: Vec<(f64, f64)>,
    /// As (x, low, high).
    pub band: Vec<(f64, f64, f64)>,
}

impl Means {
    pub fn new(means: &ConditionalMeansRecord) -> Self {
        let number = |value: Option<&Option<f64>>| value.copied().flatten().unwrap_or(f64::NAN);
        let at = |(place, x): (usize, &f64)| (*x, number(means.low.get(place)), number(means.high.get(place)));
        let (name, stroke) = match means.x.len() {
            ..=FEW_SLICES => ("mean at a value of the factor", Stroke::SolidWithPoints),
            _ => (SLICES, Stroke::Solid),
        };
        Self {
            series: Series::new(name, Colour::Reference).stroke(stroke),
            points: means.x.iter().enumerate().map(|(place, x)| (*x, number(means.mean.get(place)))).collect(),
            band: means.x.iter().enumerate().map(at).collect(),
        }
    }

    pub fn marks(self) -> [Mark; 2] {
        [self.series.band(self.band), self.series.line(self.points)]
    }
}
