//! The estimators by the names of study files.

use super::of_one_index::{FirstOrder, Total};
use crate::design::Companions;

/// What a study file names: a paper's estimators of first-order and total indices. The variants that say nothing else
/// have both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// The most accurate of the rows that there are.
    #[default]
    Default,
    /// Sobol' 1993: first order only.
    Sobol1993,
    /// Homma and Saltelli 1996.
    HommaSaltelli,
    /// Saltelli 2002: first order only.
    Saltelli2002,
    /// Sobol' et al. 2007.
    Sobol2007,
    /// Saltelli et al. 2010: first order only.
    Saltelli2010,
    /// Jansen 1999.
    Jansen,
    /// Janon et al. 2014 and Monod et al. 2006.
    JanonMonod,
    /// Martinez 2011.
    Martinez,
    /// Glen and Isaacs 2012.
    GlenIsaacs,
    /// Owen 2013.
    Owen,
    /// Azzini et al. 2021.
    Azzini,
}

impl Estimator {
    /// All of them, the default first.
    pub const ALL: [Self; 12] = [
        Self::Default,
        Self::Sobol1993,
        Self::HommaSaltelli,
        Self::Saltelli2002,
        Self::Sobol2007,
        Self::Saltelli2010,
        Self::Jansen,
        Self::JanonMonod,
        Self::Martinez,
        Self::GlenIsaacs,
        Self::Owen,
        Self::Azzini,
    ];

    /// The name used in study files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::Sobol1993 => "sobol-1993",
            Self::HommaSaltelli => "homma-saltelli",
            Self::Saltelli2002 => "saltelli-2002",
            Self::Sobol2007 => "sobol-2007",
            Self::Saltelli2010 => "saltelli-2010",
            Self::Jansen => "jansen",
            Self::JanonMonod => "janon-monod",
            Self::Martinez => "martinez",
            Self::GlenIsaacs => "glen-isaacs",
            Self::Owen => "owen",
            Self::Azzini => "azzini",
        }
    }

    /// Its estimators of first-order and of total indices; `None` where the paper has none of its own, and the default
    /// for the rows that there are is used.
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
            Self::Owen => (Some(FirstOrder::Owen2013), Some(Total::Owen2013)),
            Self::Azzini => (Some(FirstOrder::Azzini2021), Some(Total::Azzini2021)),
        }
    }

    /// Its estimators, with the default ones for rows `companions` where it has none of its own.
    ///
    /// ```
    /// use apportion::Companions;
    /// use apportion::{Estimator, FirstOrder, Total};
    ///
    /// let plain = Estimator::Sobol1993.with_rows(Companions::NONE);
    /// assert_eq!(plain, (FirstOrder::Sobol1993, Total::JansenPooled));
    /// ```
    pub fn with_rows(self, companions: Companions) -> (FirstOrder, Total) {
        let (first_order, total) = self.formulas();
        let or_default = first_order.unwrap_or_else(|| FirstOrder::of_rows(companions));
        (or_default, total.unwrap_or_else(|| Total::of_rows(companions)))
    }

    /// The rows it needs beside A, B and AB.
    pub fn needs(self) -> Companions {
        let (first_order, total) = self.formulas();
        first_order.map_or(Companions::NONE, FirstOrder::needs).union(total.map_or(Companions::NONE, Total::needs))
    }
}
