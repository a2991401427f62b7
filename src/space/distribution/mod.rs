//! Distributions of single factors, by their quantile functions.
//!
//! A design is in the open unit cube; each coordinate becomes a value by the inverse of the factor's cumulative
//! distribution function. Every distribution is checked when it is created: after that, every quantile for `u` in
//! [[`Distribution::SMALLEST_U`], [`Distribution::LARGEST_U`]], the mean and the standard deviation are finite.
//!
//! To add a distribution: one file here with a struct, its constructor on [`Distribution`], its `Family` and its
//! entries for study files; one line in the list of families below; one case in `tests/oracle/distributions.py`. The
//! reader of study files, the schema, the messages and the constructors of Python are generated from the entries.

mod beta;
mod constant;
mod counts;
mod entry;
mod error;
mod exponential;
mod family;
mod gamma;
mod gumbel;
mod histogram;
mod integer;
mod keys;
mod kind;
mod log_normal;
mod log_uniform;
mod logistic;
mod normal;
mod parameter;
mod pareto;
mod pert;
mod quadrature;
mod seed;
mod solve;
mod solved;
mod student_t;
mod triangular;
mod truncated;
mod uniform;
mod values;
mod weibull;

pub use error::DistributionError;
use family::Family;
pub use keys::{KEYS, Key, KeyKind};
pub use kind::{Argument, Kind};
pub use parameter::{MeasuredFile, Parameter};
pub(crate) use seed::{mixed, seed_of};
use serde::ser::{Serialize, SerializeMap, Serializer};
pub use values::Values;

use apportion_base::quantity::Unit;

/// Imports for the file of a family.
mod prelude {
    pub(super) use super::entry::*;
    pub(super) use super::error::*;
    pub(super) use super::family::Family;
    pub(super) use super::parameter::{MeasuredFile, Parameter};
    pub(super) use super::{Distribution, DistributionError};
}

/// Declares a variant of [`Distribution`] for each family, and the list of their entries.
macro_rules! families {
    ($($variant:ident($family:ident) = $module:ident::$entries:ident,)+) => {
        /// A univariate distribution with its parameters, immutable and checked.
        ///
        /// Created by the constructors named after the families; in JSON it is a map of `name` (its
        /// [`name`](Self::name)) and its [`parameters`](Self::parameters).
        ///
        /// ```
        /// use apportion::Distribution;
        ///
        /// let length = Distribution::uniform(1.0, 3.0)?;
        /// assert_eq!(length.quantile(0.25), 1.5);
        /// assert_eq!(length.mean(), 2.0);
        /// assert_eq!(
        ///     Distribution::uniform(3.0, 1.0).unwrap_err().to_string(),
        ///     "`min` is 3 and `max` is 1, but `min` must be below `max`"
        /// );
        /// # Ok::<(), apportion::DistributionError>(())
        /// ```
        #[derive(Clone, Debug, PartialEq)]
        pub enum Distribution {
            $(#[doc = concat!("See `", stringify!($family), "`.")] $variant($module::$family),)+
        }

        /// The entries of the families in study files, the default first.
        static ENTRIES: &[&[entry::Entry]] = &[$($module::$entries),+];

        impl Distribution {
            fn family(&self) -> &dyn Family {
                match self { $(Self::$variant(family) => family),+ }
            }

            /// Returns the first entry of its family.
            fn entry(&self) -> &'static entry::Entry {
                match self { $(Self::$variant(_) => &$module::$entries[0]),+ }
            }
        }
    };
}

families! {
    Uniform(Uniform) = uniform::ENTRIES,
    LogUniform(LogUniform) = log_uniform::ENTRIES,
    Normal(Normal) = normal::ENTRIES,
    Truncated(Truncated) = truncated::ENTRIES,
    LogNormal(LogNormal) = log_normal::ENTRIES,
    Triangular(Triangular) = triangular::ENTRIES,
    Beta(Beta) = beta::ENTRIES,
    Pert(Pert) = pert::ENTRIES,
    Weibull(Weibull) = weibull::ENTRIES,
    Gumbel(Gumbel) = gumbel::ENTRIES,
    Gamma(Gamma) = gamma::ENTRIES,
    Exponential(Exponential) = exponential::ENTRIES,
    Poisson(Counts) = counts::POISSON,
    Binomial(Counts) = counts::BINOMIAL,
    NegativeBinomial(Counts) = counts::NEGATIVE_BINOMIAL,
    Geometric(Counts) = counts::GEOMETRIC,
    StudentT(StudentT) = student_t::ENTRIES,
    Logistic(Logistic) = logistic::ENTRIES,
    Pareto(Pareto) = pareto::ENTRIES,
    Histogram(Histogram) = histogram::ENTRIES,
    Discrete(Values) = values::DISCRETE,
    Integer(Integer) = integer::ENTRIES,
    Categorical(Values) = values::CATEGORICAL,
    Empirical(Values) = values::EMPIRICAL,
    Seed(Seed) = seed::ENTRIES,
    Constant(Constant) = constant::ENTRIES,
}

impl Distribution {
    /// The smallest `u` at which quantiles are guaranteed to be finite, 2^-64.
    pub const SMALLEST_U: f64 = 1.0 / (1u128 << 64) as f64;

    /// The largest `u` below 1, 1 - 2^-53.
    pub const LARGEST_U: f64 = 1.0 - f64::EPSILON / 2.0;

    /// Returns the quantile (the inverse of the cumulative distribution function) at `u` in the open interval (0, 1).
    ///
    /// Finite from [`Distribution::SMALLEST_U`] to [`Distribution::LARGEST_U`], inside [`support`](Self::support), and non-decreasing: exactly so
    /// for the uniform, triangular, discrete, integer, categorical, empirical and constant distributions and those of counts,
    /// otherwise up to the last few bits of the result; the [`seed`](Self::seed)s of a stochastic model have no order.
    /// Outside (0, 1) the result has no meaning, but there is no panic.
    pub fn quantile(&self, u: f64) -> f64 {
        self.family().quantile(u)
    }

    /// Computes the quantiles of a column: `out[i] = quantile(u[i])`, with the same bits.
    ///
    /// # Panics
    ///
    /// If the two slices are of different lengths.
    pub fn fill(&self, u: &[f64], out: &mut [f64]) {
        assert_eq!(u.len(), out.len(), "a column and its quantiles are of one length");
        self.family().fill(u, out);
    }

    /// Returns the mean.
    pub fn mean(&self) -> f64 {
        self.family().moments().0
    }

    /// Returns the standard deviation.
    pub fn sd(&self) -> f64 {
        self.family().moments().1
    }

    /// Returns the median.
    pub fn median(&self) -> f64 {
        self.quantile(0.5)
    }

    /// Returns the smallest closed interval that contains every value; its ends may be infinite.
    pub fn support(&self) -> (f64, f64) {
        self.family().support()
    }

    /// Returns the values of a discrete factor, ascending, each with a `u` at which it is the quantile: for discrete or
    /// categorical distributions, and for up to 1024 whole numbers (of counts except a thousandth at either
    /// end). `None` for all others: measured values represent the range between them.
    pub fn levels(&self) -> Option<Vec<(f64, f64)>> {
        match self {
            Self::Discrete(values) | Self::Categorical(values) => Some(values.levels()),
            Self::Integer(integer) => integer.levels(),
            _ => self.counts()?.levels(),
        }
    }

    /// Returns the distribution of counts: Poisson, binomial, negative binomial or geometric.
    pub(crate) fn counts(&self) -> Option<&counts::Counts> {
        match self {
            Self::Poisson(law) | Self::Binomial(law) | Self::NegativeBinomial(law) | Self::Geometric(law) => Some(law),
            _ => None,
        }
    }

    /// Returns whether its values are whole numbers: for integers, counts and seeds.
    pub fn is_whole(&self) -> bool {
        self.is_converted_by_value() || self.is_noise()
    }

    /// Returns whether values are converted to SI one by one, because whole numbers are not whole in another unit.
    pub(super) fn is_converted_by_value(&self) -> bool {
        matches!(self, Self::Integer(_)) || self.counts().is_some()
    }

    /// Returns whether its values are the seeds of a stochastic model: the factor is the noise, not an input.
    pub fn is_noise(&self) -> bool {
        matches!(self, Self::Seed(_))
    }

    /// Returns whether values come close to the lower end of the support without reaching it.
    pub fn is_open_below(&self) -> bool {
        let (low, _) = self.support();
        match self {
            Self::LogNormal(_) | Self::Weibull(_) | Self::Gamma(_) | Self::Exponential(_) => true,
            Self::Truncated(truncated) => truncated.law().support().0 == low && truncated.law().is_open_below(),
            _ => false,
        }
    }

    /// Returns the categories of a categorical or boolean distribution.
    fn categories(&self) -> Option<&Values> {
        if let Self::Categorical(categories) = self { Some(categories) } else { None }
    }

    /// Returns the labels of a categorical or boolean distribution, as given.
    pub fn labels(&self) -> Option<&[String]> {
        self.categories().map(Values::labels)
    }

    /// Returns whether its values have no order: labels and seeds.
    fn has_no_order(&self) -> bool {
        self.labels().is_some() || self.is_noise()
    }

    /// Returns the label for `value`, in a categorical or boolean distribution.
    pub fn label(&self, value: f64) -> Option<&str> {
        self.categories()?.label(value)
    }

    /// Returns the value for `label`, in a categorical or boolean distribution.
    pub fn value_of(&self, label: &str) -> Option<f64> {
        self.categories()?.value_of(label)
    }

    /// Returns the default nominal value: the most probable category, otherwise the median.
    pub fn central(&self) -> f64 {
        self.categories().map_or_else(|| self.median(), Values::most_probable)
    }

    /// Returns the name of the family, as in study files: `log-uniform`.
    pub fn name(&self) -> &'static str {
        self.family().name(self.entry().name)
    }

    /// Returns the parameters from which it was created, with their names.
    pub fn parameters(&self) -> Vec<(&'static str, Parameter)> {
        self.family().parameters()
    }

    /// Returns the distribution of the same quantity in SI, this one being in `unit`; for a distribution whose values
    /// are not [converted one by one](Self::is_converted_by_value).
    ///
    /// Parameters that are values are converted one by one, so that bounds and constants are the `f64` nearest to what
    /// was typed (a constant of 225 um is 225e-6); a `log_mean` is shifted by the logarithm of the factor; shapes are
    /// unchanged.
    ///
    /// # Errors
    ///
    /// As for the constructor, if a parameter exceeds the range of `f64`.
    pub(super) fn to_si(&self, unit: &Unit) -> Result<Self, DistributionError> {
        self.in_si(unit)?.finite()
    }

    /// Does the same without a check of the variance: a truncated part may have one.
    fn in_si(&self, unit: &Unit) -> Result<Self, DistributionError> {
        self.family().in_si(self.entry(), unit)
    }

    /// Returns P(X <= x) and P(X > x).
    fn tails(&self, x: f64) -> (f64, f64) {
        match x.is_infinite() {
            true if x > 0.0 => (1.0, 0.0),
            true => (0.0, 1.0),
            false => self.family().tails(x),
        }
    }

    /// Returns the quantile at 1 - `v`, to full precision if `v` is small.
    pub(crate) fn upper_quantile(&self, v: f64) -> f64 {
        self.family().upper_quantile(v)
    }

    /// Returns values and weights of a quadrature of a continuous distribution, down to probabilities of 1e-290.
    pub(crate) fn quadrature(&self) -> Vec<(f64, f64)> {
        let nodes = quadrature::nodes();
        nodes.map(|(u, v, weight)| (if u < v { self.quantile(u) } else { self.upper_quantile(v) }, weight)).collect()
    }

    /// Refuses a distribution that has no variance, or overflows within the guaranteed range of `u`.
    fn finite(self) -> Result<Self, DistributionError> {
        self.family().refuse_infinite_variance()?;
        let figures =
            [self.quantile(Distribution::SMALLEST_U), self.quantile(Distribution::LARGEST_U), self.mean(), self.sd()];
        match figures.iter().all(|figure| figure.is_finite()) {
            true => Ok(self),
            false => Err(error::overflow(self.name())),
        }
    }
}

impl Serialize for Distribution {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let parameters = self.parameters();
        let mut map = serializer.serialize_map(Some(parameters.len() + 1))?;
        map.serialize_entry("name", self.name())?;
        for (name, value) in &parameters {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

#[cfg(test)]
mod tests;
