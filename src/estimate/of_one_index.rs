//! The estimators of first-order and of total indices.

use super::formula::{correlation, difference, double, product};
use super::{Moments, SwapMoments};
use apportion_base::names::named;

/// Declares an enum of estimators: a doc line, the name in results, the formula on the sums of a swap, and its source.
macro_rules! estimators {
    ($(#[$meta:meta])* pub enum $type:ident {
        $($(#[$doc:meta])* $variant:ident = $name:literal, $formula:path, $source:expr;)+
    }) => {
        named! {
            $(#[$meta])*
            pub enum $type { $($(#[$doc])* $variant = $name,)+ }
        }

        impl $type {
            /// Returns the source of the formula.
            pub fn source(self) -> &'static str {
                match self { $(Self::$variant => $source),+ }
            }

            /// Returns whether it needs the rows BA in addition to A, B and AB.
            pub fn needs_ba(self) -> bool {
                matches!(self, Self::GlenIsaacs2012 | Self::Azzini2021)
            }

            /// Returns the index of swap `swap`, not clamped; NaN without variance, or without rows BA if
            /// [needed](Self::needs_ba).
            ///
            /// # Panics
            /// If there is no such swap.
            pub fn estimate(self, moments: &Moments, swap: usize) -> f64 {
                let formula: fn(&SwapMoments) -> f64 = match self { $(Self::$variant => $formula),+ };
                formula(moments.swap(swap))
            }
        }
    };
}

estimators! {
/// An estimator of first-order indices (of a group: closed first-order indices).
///
/// In the formulas n is the number of base points, m_B the mean of y_B, V_B its variance, f0 and V the mean and
/// variance of y_A and y_B pooled, r Pearson's correlation; AB is A with the columns of the swap from B. Sobol1993,
/// HommaSaltelli1996, Saltelli2002 and Sobol2007 are not centred, as published: if the offset of the output is large
/// compared with its spread, their error grows in proportion (Saltelli2002: also its square over n), and digits are
/// lost.
///
/// ```
/// use apportion::estimate::{BlockOutputs, Moments, Workspace};
/// use apportion::FirstOrder;
///
/// // y = x, sampled at every pair of 0, 1 and 0, 1: AB, which takes x from B, has the outputs of B.
/// let (a, b) = ([0.0, 0.0, 1.0, 1.0], [0.0, 1.0, 0.0, 1.0]);
/// let block = BlockOutputs { a: &a, b: &b, ab: &[&b], ..BlockOutputs::default() };
/// let moments = Moments::of_block(block, &mut Workspace::default());
/// assert_eq!(FirstOrder::Saltelli2010.estimate(&moments, 0), 1.0);
/// assert!(FirstOrder::Azzini2021.estimate(&moments, 0).is_nan(), "no rows BA");
/// ```
pub enum FirstOrder {
    /// S = (1/n sum y_B y_AB - m_B^2)/V_B.
    Sobol1993 = "sobol-1993", product::sobol_1993,
        "Sobol' (1993), Math. Model. Comput. Exp. 1, 407-414; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (a)";
    /// S = (1/n sum y_B y_AB - f0^2)/V.
    HommaSaltelli1996 = "homma-saltelli-1996", product::homma_saltelli_first_order,
        "Homma and Saltelli (1996), Reliab. Eng. Syst. Saf. 52, 1-17, with the mean and variance of A and B pooled";
    /// S = 1 - 1/(2n) sum (y_B - y_AB)^2/V.
    Jansen1999 = "jansen-1999", difference::jansen_first_order,
        "Jansen (1999), Comput. Phys. Commun. 117, 35-43; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (c)";
    /// S = (1/(n-1) sum y_B y_AB - 1/n sum y_A y_B)/V_A.
    Saltelli2002 = "saltelli-2002", product::saltelli_2002,
        "Saltelli (2002), Comput. Phys. Commun. 145, 280-297, in the form of sobol2002 of the R package sensitivity";
    /// S = 1/n sum y_B (y_AB - y_A)/V.
    Sobol2007 = "sobol-2007", product::sobol_2007_first_order,
        "Sobol', Tarantola, Gatelli, Kucherenko and Mauntz (2007), Reliab. Eng. Syst. Saf. 92, 957-960";
    /// S = 1/n sum (y_B - f0)(y_AB - y_A)/V.
    Saltelli2010 = "saltelli-2010", difference::saltelli_2010,
        "Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (b), centred on the pooled mean";
    /// S = r(y_B, y_AB).
    Martinez2011 = "martinez-2011", correlation::martinez_first_order,
        "Martinez (2011), Analyse de sensibilite globale par decomposition de la variance, GdR Ondes and GdR MASCOT-NUM, Paris";
    /// Correlations of all pairs of rows, corrected for spurious ones.
    GlenIsaacs2012 = "glen-isaacs-2012", correlation::glen_isaacs_first_order,
        "Glen and Isaacs (2012), Environ. Model. Softw. 37, 157-166, formulas D3, on Pearson correlations";
    /// S = cov(y_B, y_AB)/V, mean and variance from those two rows pooled.
    JanonMonod2014 = "janon-monod-2014", correlation::janon_monod_first_order,
        "Janon, Klein, Lagnoux, Nodet and Prieur (2014), ESAIM: PS 18, 342-364, eq. 6, after Monod, Naud and Makowski (2006)";
    /// S = 2 sum (y_BA - y_B)(y_A - y_AB)/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2]: the default with rows BA.
    Azzini2021 = "azzini-2021", double::azzini_first_order,
        "Azzini, Mara and Rosati (2021), Environ. Model. Softw. 144, 105167";
    /// S = 1/n sum (y_B - f0)(y_AB - y_A)/(S V_B,AB + (1 - S) V3 - c), V_B,AB the variance of y_B and y_AB pooled, V3 that
    /// of y_A, y_B and y_AB, c the covariance of y_A and y_B: the default without rows BA.
    ///
    /// The covariance, which tends to 0, is in the numerator too; so is the variance of y_B and y_AB at S = 1: their
    /// noise cancels. Small indices have the denominator from the most rows. (On the right side S is clamped to between
    /// 0 and 1, c to between -V3/2 and V3/2, and V_B,AB - c is at least half of V3 - c.)
    SaltelliPooled = "saltelli-pooled", difference::saltelli_pooled,
        "Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (b), centred on the pooled mean, over a mixture of the variances of B and AB, and of A, B and AB, less the covariance of A and B";
}
}

impl FirstOrder {
    /// Returns the default: the most accurate estimator for the existing rows (`benches/accuracy.rs`). With rows BA it
    /// is Azzini's, otherwise Saltelli's of 2010 over the variance of all three rows.
    pub fn default_for(has_ba: bool) -> Self {
        if has_ba { Self::Azzini2021 } else { Self::SaltelliPooled }
    }
}

estimators! {
/// An estimator of total indices. Symbols are those of [`FirstOrder`]; HommaSaltelli1996 and Sobol2007 are not centred,
/// as published.
pub enum Total {
    /// ST = (V - 1/n sum y_A y_AB + f0^2)/V.
    HommaSaltelli1996 = "homma-saltelli-1996", product::homma_saltelli_total,
        "Homma and Saltelli (1996), Reliab. Eng. Syst. Saf. 52, 1-17; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (d)";
    /// ST = 1/(2n) sum (y_A - y_AB)^2/V.
    Jansen1999 = "jansen-1999", difference::jansen_total,
        "Jansen (1999), Comput. Phys. Commun. 117, 35-43, eq. 14; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (f)";
    /// ST = 1/n sum y_A (y_A - y_AB)/V.
    Sobol2007 = "sobol-2007", product::sobol_2007_total,
        "Sobol', Tarantola, Gatelli, Kucherenko and Mauntz (2007), Reliab. Eng. Syst. Saf. 92, 957-960; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (e)";
    /// ST = 1 - r(y_A, y_AB).
    Martinez2011 = "martinez-2011", correlation::martinez_total,
        FirstOrder::Martinez2011.source();
    /// Correlations of all pairs of rows, corrected for spurious ones.
    GlenIsaacs2012 = "glen-isaacs-2012", correlation::glen_isaacs_total,
        FirstOrder::GlenIsaacs2012.source();
    /// ST = 1 - cov(y_A, y_AB)/V, mean and variance from those two rows pooled.
    JanonMonod2014 = "janon-monod-2014", difference::janon_monod_total,
        FirstOrder::JanonMonod2014.source();
    /// ST = sum [(y_B - y_BA)^2 + (y_A - y_AB)^2]/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2]: the default with rows BA.
    Azzini2021 = "azzini-2021", double::azzini_total,
        FirstOrder::Azzini2021.source();
    /// ST = 1/(2n) sum (y_A - y_AB)^2/(ST V_A,AB + (1 - ST) V3), V_A,AB the variance of y_A and y_AB pooled, at least
    /// V3/2: the default without rows BA, for the reasons of [`FirstOrder::SaltelliPooled`].
    JansenPooled = "jansen-pooled", difference::jansen_pooled,
        "Jansen (1999), Comput. Phys. Commun. 117, 35-43, eq. 14, over a mixture of the variances of A and AB, and of A, B and AB";
}
}

impl Total {
    /// Returns the default: the most accurate estimator for the existing rows, as [`FirstOrder::default_for`]. With
    /// rows BA it is Azzini's, otherwise Jansen's over the variance of all three rows.
    pub fn default_for(has_ba: bool) -> Self {
        if has_ba { Self::Azzini2021 } else { Self::JansenPooled }
    }
}
