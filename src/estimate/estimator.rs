//! Estimators as named in study files.

use super::of_one_index::{FirstOrder, Total};
use apportion_base::names::named;

named! {
/// An estimator named in study files: a paper's estimators of first-order and total indices. Variants have both unless
/// stated otherwise.
#[derive(Default)]
pub enum Estimator {
    /// The most accurate estimators for the existing rows.
    #[default]
    Default = "default",
    /// Sobol' 1993: first order only.
    Sobol1993 = "sobol-1993",
    /// Homma and Saltelli 1996.
    HommaSaltelli = "homma-saltelli",
    /// Saltelli 2002: first order only.
    Saltelli2002 = "saltelli-2002",
    /// Sobol' et al. 2007.
    Sobol2007 = "sobol-2007",
    /// Saltelli et al. 2010: first order only.
    Saltelli2010 = "saltelli-2010",
    /// Jansen 1999.
    Jansen = "jansen",
    /// Janon et al. 2014 and Monod et al. 2006.
    JanonMonod = "janon-monod",
    /// Martinez 2011.
    Martinez = "martinez",
    /// Glen and Isaacs 2012.
    GlenIsaacs = "glen-isaacs",
    /// Azzini et al. 2021.
    Azzini = "azzini",
}
}

impl Estimator {
    /// Returns its estimators of first-order and of total indices; `None` where the paper defines none, and the default
    /// for the existing rows is used.
    pub fn formulas(self) -> (Option<FirstOrder>, Option<Total>) {
        match self {
            Self::Default => (None, None),
            Self::Sobol1993 => (Some(FirstOrder::Sobol1993), None),
            Self::HommaSaltelli => (Some(FirstOrder::HommaSaltelli1996), Some(Total::HommaSaltelli1996)),
            Self::Saltelli2002 => (Some(FirstOrder::Saltelli2002), None),
            Self::Sobol2007 => (Some(FirstOrder::Sobol2007), Some(Total::Sobol2007)),
            Self::Saltelli2010 => (Some(FirstOrder::Saltelli2010), None),
            Self::Jansen => (Some(FirstOrder::Jansen1999), Some(Total::Jansen1999)),
            Self::JanonMonod => (Some(FirstOrder::JanonMonod2014), Some(Total::JanonMonod2014)),
            Self::Martinez => (Some(FirstOrder::Martinez2011), Some(Total::Martinez2011)),
            Self::GlenIsaacs => (Some(FirstOrder::GlenIsaacs2012), Some(Total::GlenIsaacs2012)),
            Self::Azzini => (Some(FirstOrder::Azzini2021), Some(Total::Azzini2021)),
        }
    }

    /// Returns whether it needs the rows BA in addition to A, B and AB.
    pub fn needs_ba(self) -> bool {
        let (first_order, total) = self.formulas();
        first_order.is_some_and(FirstOrder::needs_ba) || total.is_some_and(Total::needs_ba)
    }
}
