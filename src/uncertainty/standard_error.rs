//! Standard errors, the influences that they follow from, and their kinds.

use crate::effect::Kind;

/// A standard error with its degrees of freedom of Student's t.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandardError {
    /// The standard error, in the unit of the estimate.
    pub error: f64,
    /// Degrees of freedom.
    pub freedom: f64,
}

/// Mean influences of the parts of every net on one quantity: `[net][part]`, all nets with the same parts, which have
/// equal numbers of points except the last. Their mean over everything is 0.
pub type PartInfluences = Vec<Vec<f64>>;

/// The sides of an estimate on which the true value may be if few rows dominate it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Above: a sum of contributions of one sign, such as an index or a variance.
    Above,
    /// On both: a difference, a share, a mean.
    Both,
}

/// The behaviour of the errors of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ErrorKind {
    /// Where the true value may be outside an interval if few rows dominate the quantity.
    pub side: Side,
    /// Whether it helps to determine how fast all errors decrease with the number of points.
    pub is_pooled: bool,
}

impl ErrorKind {
    /// Returns the behaviour of quantities of this kind: indices and their sums are sums of contributions of one sign.
    pub fn of_kind(kind: Kind) -> Self {
        let side = if kind == Kind::Difference { Side::Both } else { Side::Above };
        Self { side, is_pooled: kind == Kind::Index }
    }
}
