//! A quantity along values of one constant of the scene, and the shape of that curve.

use apportion_base::sum;

/// A quantity over a rising grid.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
}

/// Returns `count` evenly spaced values from `low` to `high`, both included.
pub(super) fn grid((low, high): (f64, f64), count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count).map(|i| low + (high - low) * (i as f64 / last)).collect()
}

impl Curve {
    pub fn first(&self) -> f64 {
        self.y[0]
    }

    pub fn last(&self) -> f64 {
        self.y[self.y.len() - 1]
    }

    /// Returns whether every value is higher than the one before.
    pub fn rises(&self) -> bool {
        self.y.windows(2).all(|pair| pair[1] > pair[0])
    }

    /// Returns whether every value is lower than the one before.
    pub fn falls(&self) -> bool {
        self.y.windows(2).all(|pair| pair[1] < pair[0])
    }

    /// Returns the largest value minus the smallest, in units of the mean.
    pub fn spread(&self) -> f64 {
        let mean = sum::mean(&self.y);
        self.extent() / mean.abs()
    }

    fn extent(&self) -> f64 {
        let (low, high) = self.y.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &y| (l.min(y), h.max(y)));
        high - low
    }

    /// Returns the largest increase of steepness from one step to the next, in units of the mean steepness; 0 if the
    /// curve flattens everywhere.
    pub fn steepens(&self) -> f64 {
        let steps: Vec<f64> =
            self.x.windows(2).zip(self.y.windows(2)).map(|(x, y)| ((y[1] - y[0]) / (x[1] - x[0])).abs()).collect();
        let mean = ((self.last() - self.first()) / (self.x[self.x.len() - 1] - self.x[0])).abs();
        steps.windows(2).fold(0.0, |most: f64, pair| most.max((pair[1] - pair[0]) / mean))
    }

    /// Returns the largest distance from the least-squares line, in units of the total change, and R^2 of that line.
    pub fn bend(&self) -> (f64, f64) {
        let x = (&self.x[..], sum::mean(&self.x));
        let y = (&self.y[..], sum::mean(&self.y));
        let slope = sum::centred_product(x, y) / sum::centred_product(x, x);
        let off: Vec<f64> = self.x.iter().zip(&self.y).map(|(x_i, y_i)| y_i - y.1 - slope * (x_i - x.1)).collect();
        let rest = sum::centred_product((&off, 0.0), (&off, 0.0));
        let farthest = off.iter().fold(0.0, |far: f64, off| far.max(off.abs()));
        (farthest / self.extent(), 1.0 - rest / sum::centred_product(y, y))
    }

    /// Returns the mean elasticity, ln(y_n/y_0)/ln(x_n/x_0): the power of x that joins the ends.
    pub fn elasticity(&self) -> f64 {
        libm::log(self.last() / self.first()) / libm::log(self.x[self.x.len() - 1] / self.x[0])
    }
}

#[cfg(test)]
#[path = "tests/curve.rs"]
mod tests;
