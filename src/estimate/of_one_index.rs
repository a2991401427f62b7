//! The estimators of first-order and of total indices by name.

use super::formula::{correlation, difference, double, product};
use super::{Moments, SwapMoments};
use crate::design::Companions;

const BA: Companions = Companions { ba: true, bc: false, cb: false };

/// An estimator of first-order indices (of a group: closed first-order indices).
///
/// In the formulas n is the number of base points, m_B the mean of y_B, V_B its variance, f0 and V the mean and
/// variance of y_A and y_B pooled, r Pearson's correlation; AB is A with the columns of the swap from B. Sobol1993,
/// HommaSaltelli1996, Saltelli2002 and Sobol2007 are not centred, as published: an offset of the output that is large
/// against its spread makes their error grow in proportion (Saltelli2002: also its square over n), and takes digits.
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstOrder {
    /// S = (1/n sum y_B y_AB - m_B^2)/V_B.
    Sobol1993,
    /// S = (1/n sum y_B y_AB - f0^2)/V.
    HommaSaltelli1996,
    /// S = (1/(n-1) sum y_B y_AB - 1/n sum y_A y_B)/V_A.
    Saltelli2002,
    /// S = 1/n sum y_B (y_AB - y_A)/V.
    Sobol2007,
    /// S = 1/n sum (y_B - f0)(y_AB - y_A)/V.
    Saltelli2010,
    /// S = 1/n sum (y_B - f0)(y_AB - y_A)/(S V_B,AB + (1 - S) V3 - c), V_B,AB the variance of y_B and y_AB pooled, V3 that
    /// of y_A, y_B and y_AB, c the covariance of y_A and y_B: the default without rows BA.
    ///
    /// The covariance, 0 for all points, is in the numerator too; at S = 1 so is the variance of y_B and y_AB: their noise
    /// cancels. Small indices have the denominator of most rows. (On the right side S is held between 0 and 1, c between
    /// -V3/2 and V3/2, and V_B,AB - c is at least half of V3 - c.)
    SaltelliPooled,
    /// S = 1 - 1/(2n) sum (y_B - y_AB)^2/V.
    Jansen1999,
    /// S = cov(y_B, y_AB)/V, mean and variance from those two rows pooled.
    JanonMonod2014,
    /// S = r(y_B, y_AB).
    Martinez2011,
    /// Correlations of all pairs of rows, corrected for spurious ones.
    GlenIsaacs2012,
    /// S = 1/n sum (y_B - y_BC)(y_AB - y_A)/V: for small indices.
    Owen2013,
    /// S = 2 sum (y_BA - y_B)(y_A - y_AB)/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2]: the default with rows BA.
    Azzini2021,
}

impl FirstOrder {
    /// All of them, in the order of their years.
    pub const ALL: [Self; 12] = [
        Self::Sobol1993,
        Self::HommaSaltelli1996,
        Self::Jansen1999,
        Self::Saltelli2002,
        Self::Sobol2007,
        Self::Saltelli2010,
        Self::Martinez2011,
        Self::GlenIsaacs2012,
        Self::Owen2013,
        Self::JanonMonod2014,
        Self::Azzini2021,
        Self::SaltelliPooled,
    ];

    /// The default: the most accurate estimator of the rows that there are (`benches/accuracy.rs`). With rows BA that is
    /// Azzini's, else Saltelli's of 2010 over the variance of all three rows.
    pub fn of_rows(companions: Companions) -> Self {
        if companions.ba { Self::Azzini2021 } else { Self::SaltelliPooled }
    }

    /// The name used in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sobol1993 => "sobol-1993",
            Self::HommaSaltelli1996 => "homma-saltelli-1996",
            Self::Saltelli2002 => "saltelli-2002",
            Self::Sobol2007 => "sobol-2007",
            Self::Saltelli2010 => "saltelli-2010",
            Self::SaltelliPooled => "saltelli-pooled",
            Self::Jansen1999 => "jansen-1999",
            Self::JanonMonod2014 => "janon-monod-2014",
            Self::Martinez2011 => "martinez-2011",
            Self::GlenIsaacs2012 => "glen-isaacs-2012",
            Self::Owen2013 => "owen-2013",
            Self::Azzini2021 => "azzini-2021",
        }
    }

    /// Where the formula comes from.
    pub fn source(self) -> &'static str {
        match self {
            Self::Sobol1993 => {
                "Sobol' (1993), Math. Model. Comput. Exp. 1, 407-414; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (a)"
            }
            Self::HommaSaltelli1996 => {
                "Homma and Saltelli (1996), Reliab. Eng. Syst. Saf. 52, 1-17, with the mean and variance of A and B pooled"
            }
            Self::Saltelli2002 => {
                "Saltelli (2002), Comput. Phys. Commun. 145, 280-297, in the form of sobol2002 of the R package sensitivity"
            }
            Self::Sobol2007 => {
                "Sobol', Tarantola, Gatelli, Kucherenko and Mauntz (2007), Reliab. Eng. Syst. Saf. 92, 957-960"
            }
            Self::Saltelli2010 => {
                "Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (b), centred on the pooled mean"
            }
            Self::SaltelliPooled => {
                "Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (b), centred on the pooled mean, over a mixture of the variances of B and AB, and of A, B and AB, less the covariance of A and B"
            }
            Self::Jansen1999 => {
                "Jansen (1999), Comput. Phys. Commun. 117, 35-43; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (c)"
            }
            Self::JanonMonod2014 => {
                "Janon, Klein, Lagnoux, Nodet and Prieur (2014), ESAIM: PS 18, 342-364, eq. 6, after Monod, Naud and Makowski (2006)"
            }
            Self::Martinez2011 => {
                "Martinez (2011), Analyse de sensibilite globale par decomposition de la variance, GdR Ondes and GdR MASCOT-NUM, Paris"
            }
            Self::GlenIsaacs2012 => {
                "Glen and Isaacs (2012), Environ. Model. Softw. 37, 157-166, formulas D3, on Pearson correlations"
            }
            Self::Owen2013 => "Owen (2013), ACM Trans. Model. Comput. Simul. 23(2), 11",
            Self::Azzini2021 => "Azzini, Mara and Rosati (2021), Environ. Model. Softw. 144, 105167",
        }
    }

    /// The rows it needs beside A, B and AB.
    pub fn needs(self) -> Companions {
        match self {
            Self::GlenIsaacs2012 | Self::Azzini2021 => BA,
            Self::Owen2013 => Companions { bc: true, ..Companions::NONE },
            _ => Companions::NONE,
        }
    }

    /// Model runs of a base point for `d` factors, where no two rows are the same point.
    pub fn runs_per_point(self, d: u64) -> u64 {
        runs_per_point(self.needs(), d)
    }

    /// The index of swap number `swap`, not clamped; NaN without the rows that it [needs](Self::needs) or without
    /// variance.
    ///
    /// # Panics
    /// If there is no such swap.
    pub fn estimate(self, moments: &Moments, swap: usize) -> f64 {
        self.of(moments.swap(swap)).unwrap_or(f64::NAN)
    }

    fn of(self, swap: &SwapMoments) -> Option<f64> {
        match self {
            Self::Sobol1993 => Some(product::sobol_1993(swap)),
            Self::HommaSaltelli1996 => Some(product::homma_saltelli_first_order(swap)),
            Self::Saltelli2002 => Some(product::saltelli_2002(swap)),
            Self::Sobol2007 => Some(product::sobol_2007_first_order(swap)),
            Self::Saltelli2010 => Some(difference::saltelli_2010(swap)),
            Self::SaltelliPooled => Some(difference::saltelli_pooled(swap)),
            Self::Jansen1999 => Some(difference::jansen_first_order(swap)),
            Self::JanonMonod2014 => Some(correlation::janon_monod_first_order(swap)),
            Self::Martinez2011 => Some(correlation::martinez_first_order(swap)),
            Self::GlenIsaacs2012 => correlation::glen_isaacs(swap).map(|(first_order, _)| first_order),
            Self::Owen2013 => double::owen_first_order(swap),
            Self::Azzini2021 => double::azzini_first_order(swap),
        }
    }
}

/// An estimator of total indices. Symbols are those of [`FirstOrder`]; HommaSaltelli1996 and Sobol2007 are not centred,
/// as published.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Total {
    /// ST = (V - 1/n sum y_A y_AB + f0^2)/V.
    HommaSaltelli1996,
    /// ST = 1/n sum y_A (y_A - y_AB)/V.
    Sobol2007,
    /// ST = 1/(2n) sum (y_A - y_AB)^2/V.
    Jansen1999,
    /// ST = 1/(2n) sum (y_A - y_AB)^2/(ST V_A,AB + (1 - ST) V3), V_A,AB the variance of y_A and y_AB pooled, at least V3/2:
    /// the default without rows BA, with the reasons of [`FirstOrder::SaltelliPooled`].
    JansenPooled,
    /// ST = 1 - cov(y_A, y_AB)/V, mean and variance from those two rows pooled.
    JanonMonod2014,
    /// ST = 1 - r(y_A, y_AB).
    Martinez2011,
    /// Correlations of all pairs of rows, corrected for spurious ones.
    GlenIsaacs2012,
    /// ST = 1 - 1/n sum (y_B - y_CB)(y_BA - y_A)/V.
    Owen2013,
    /// ST = sum [(y_B - y_BA)^2 + (y_A - y_AB)^2]/sum [(y_A - y_B)^2 + (y_BA - y_AB)^2]: the default with rows BA.
    Azzini2021,
}

impl Total {
    /// All of them, in the order of their years.
    pub const ALL: [Self; 9] = [
        Self::HommaSaltelli1996,
        Self::Jansen1999,
        Self::Sobol2007,
        Self::Martinez2011,
        Self::GlenIsaacs2012,
        Self::Owen2013,
        Self::JanonMonod2014,
        Self::Azzini2021,
        Self::JansenPooled,
    ];

    /// The default: the most accurate estimator of the rows that there are, as [`FirstOrder::of_rows`]. With rows BA
    /// that is Azzini's, else Jansen's over the variance of all three rows.
    pub fn of_rows(companions: Companions) -> Self {
        if companions.ba { Self::Azzini2021 } else { Self::JansenPooled }
    }

    /// The name used in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::HommaSaltelli1996 => "homma-saltelli-1996",
            Self::Sobol2007 => "sobol-2007",
            Self::Jansen1999 => "jansen-1999",
            Self::JansenPooled => "jansen-pooled",
            Self::JanonMonod2014 => "janon-monod-2014",
            Self::Martinez2011 => "martinez-2011",
            Self::GlenIsaacs2012 => "glen-isaacs-2012",
            Self::Owen2013 => "owen-2013",
            Self::Azzini2021 => "azzini-2021",
        }
    }

    /// Where the formula comes from.
    pub fn source(self) -> &'static str {
        match self {
            Self::HommaSaltelli1996 => {
                "Homma and Saltelli (1996), Reliab. Eng. Syst. Saf. 52, 1-17; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (d)"
            }
            Self::Sobol2007 => {
                "Sobol', Tarantola, Gatelli, Kucherenko and Mauntz (2007), Reliab. Eng. Syst. Saf. 92, 957-960; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (e)"
            }
            Self::Jansen1999 => {
                "Jansen (1999), Comput. Phys. Commun. 117, 35-43, eq. 14; Saltelli et al. (2010), Comput. Phys. Commun. 181, 259-270, table 2 (f)"
            }
            Self::JansenPooled => {
                "Jansen (1999), Comput. Phys. Commun. 117, 35-43, eq. 14, over a mixture of the variances of A and AB, and of A, B and AB"
            }
            Self::JanonMonod2014 => FirstOrder::JanonMonod2014.source(),
            Self::Martinez2011 => FirstOrder::Martinez2011.source(),
            Self::GlenIsaacs2012 => FirstOrder::GlenIsaacs2012.source(),
            Self::Owen2013 => FirstOrder::Owen2013.source(),
            Self::Azzini2021 => FirstOrder::Azzini2021.source(),
        }
    }

    /// The rows it needs beside A, B and AB.
    pub fn needs(self) -> Companions {
        match self {
            Self::GlenIsaacs2012 | Self::Azzini2021 => BA,
            Self::Owen2013 => Companions { ba: true, cb: true, ..Companions::NONE },
            _ => Companions::NONE,
        }
    }

    /// Model runs of a base point for `d` factors, where no two rows are the same point.
    pub fn runs_per_point(self, d: u64) -> u64 {
        runs_per_point(self.needs(), d)
    }

    /// The index of swap number `swap`, not clamped; NaN without the rows that it [needs](Self::needs) or without
    /// variance.
    ///
    /// # Panics
    /// If there is no such swap.
    pub fn estimate(self, moments: &Moments, swap: usize) -> f64 {
        self.of(moments.swap(swap)).unwrap_or(f64::NAN)
    }

    fn of(self, swap: &SwapMoments) -> Option<f64> {
        match self {
            Self::HommaSaltelli1996 => Some(product::homma_saltelli_total(swap)),
            Self::Sobol2007 => Some(product::sobol_2007_total(swap)),
            Self::Jansen1999 => Some(difference::jansen_total(swap)),
            Self::JansenPooled => Some(difference::jansen_pooled(swap)),
            Self::JanonMonod2014 => Some(difference::janon_monod_total(swap)),
            Self::Martinez2011 => Some(correlation::martinez_total(swap)),
            Self::GlenIsaacs2012 => correlation::glen_isaacs(swap).map(|(_, total)| total),
            Self::Owen2013 => double::owen_total(swap),
            Self::Azzini2021 => double::azzini_total(swap),
        }
    }
}

fn runs_per_point(needs: Companions, d: u64) -> u64 {
    2 + d * (1 + needs.count())
}
