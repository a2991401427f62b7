//! The formulas of SALib, which centres outputs by the mean of all rows (Iwanaga, Usher and Herman 2022, Socio-Environ.
//! Syst. Model. 4, 18155): S1 by Saltelli et al. 2010, ST by Jansen 1999, S2 by Saltelli 2002.

use super::{FirstOrder, Indices, Moments, SecondOrder, Total, Undefined};

impl Indices {
    /// Computes the first-order and total indices as SALib does.
    ///
    /// # Errors
    /// As for [`Indices::by`].
    pub fn of_salib(moments: &Moments) -> Result<Self, Undefined> {
        let mut indices = Self::by(moments, FirstOrder::Saltelli2010, Total::Jansen1999)?;
        let shift = shift(moments);
        for (swap, index) in indices.first_order.iter_mut().enumerate() {
            let swap = moments.swap(swap);
            *index -= shift * swap.mean_d / swap.base.variance();
        }
        Ok(indices)
    }
}

/// Computes the second-order index of the swaps `j` and `k` as SALib does; NaN unless they are two of the paired ones.
pub fn second_order_of_salib(moments: &Moments, j: usize, k: usize) -> f64 {
    let swap = moments.swap(j.min(k));
    let Some(ba) = &swap.ba else { return f64::NAN };
    // If centred elsewhere than at f0, the products of rows change by the differences of their means.
    let change = shift(moments) * (swap.mean_d - ba.mean_e) / swap.base.variance();
    SecondOrder::ClosedMinusFirst.estimate(moments, j, k) + change
}

/// Returns the mean of all rows minus the mean f0 of the rows A and B.
fn shift(moments: &Moments) -> f64 {
    let gap = 2.0 * moments.base().half_gap();
    // Relative to the mean of A, so that an offset costs no digits.
    let (mut sum, mut rows) = (gap, 2.0);
    for swap in (0..moments.swaps()).map(|swap| moments.swap(swap)) {
        sum += swap.mean_d + swap.ba.as_ref().map_or(0.0, |ba| gap + ba.mean_e);
        rows += if swap.ba.is_some() { 2.0 } else { 1.0 };
    }
    sum / rows - gap / 2.0
}
