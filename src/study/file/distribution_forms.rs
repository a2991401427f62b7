//! The distributions as study files write them: one table for the reader, the schema and the messages.

use crate::space::distribution::Law;

/// How each distribution is written, the default first.
pub(super) const FORMS: [Form; 26] = [
    Form { name: "uniform", own: &["min", "max"], takes: Takes::Law(Law::Uniform) },
    Form { name: "log-uniform", own: &["min", "max"], takes: Takes::Law(Law::LogUniform) },
    Form { name: "normal", own: &["mean", "sd"], takes: Takes::Law(Law::Normal) },
    Form { name: "truncated-normal", own: &[], takes: Takes::Keys("mean and sd before truncation, min and max") },
    Form { name: "log-normal", own: &["mean", "sd"], takes: Takes::Law(Law::LogNormal) },
    Form { name: "triangular", own: &["min", "mode", "max"], takes: Takes::Law(Law::Triangular) },
    Form { name: "beta", own: &[], takes: Takes::Keys("min, max, and either alpha and beta or mean and sd") },
    Form { name: "weibull", own: &["shape", "scale", "location"], takes: Takes::Law(Law::Weibull) },
    Form { name: "gumbel", own: &["location", "scale"], takes: Takes::Law(Law::Gumbel) },
    Form {
        name: "truncated-gumbel",
        own: &[],
        takes: Takes::Keys("location and scale before truncation, min and max"),
    },
    Form { name: "gamma", own: &["shape", "scale", "location"], takes: Takes::Law(Law::Gamma) },
    Form { name: "exponential", own: &["scale", "location"], takes: Takes::Law(Law::Exponential) },
    Form { name: "logistic", own: &["location", "scale"], takes: Takes::Law(Law::Logistic) },
    Form { name: "student-t", own: &["df", "location", "scale"], takes: Takes::Law(Law::StudentT) },
    Form { name: "pareto", own: &["shape", "min"], takes: Takes::Law(Law::Pareto) },
    Form { name: "inverse-gaussian", own: &["mean", "scale"], takes: Takes::Law(Law::InverseGaussian) },
    Form { name: "poisson", own: &[], takes: Takes::Keys("mean") },
    Form {
        name: "histogram",
        own: &[],
        takes: Takes::Keys(
            "edges and weights of bins; or quantiles (or min, max, p01, p05, ..., p99), 0 and 1 among them",
        ),
    },
    Form {
        name: "mixture",
        own: &[],
        takes: Takes::Keys("components, tables of a distribution with its keys, and weights (default equal)"),
    },
    Form { name: "discrete", own: &[], takes: Takes::Keys("values, and weights (default equal)") },
    Form { name: "integer", own: &[], takes: Takes::Keys("min and max, whole numbers, both included") },
    Form { name: "boolean", own: &[], takes: Takes::Keys("probability of true (default 0.5)") },
    Form {
        name: "categorical",
        own: &[],
        takes: Takes::Keys(
            "labels, weights (default equal) and values (what the model gets; default 0, 1, 2 and so on)",
        ),
    },
    Form {
        name: "empirical",
        own: &[],
        takes: Takes::Keys("values, or file, a table in CSV, and its column (where it has several)"),
    },
    Form { name: "seed", own: &[], takes: Takes::Keys("nothing: it is the noise of a stochastic model") },
    Form { name: "constant", own: &[], takes: Takes::Keys("value") },
];

/// One distribution in a study file.
#[derive(Clone, Copy)]
pub(super) struct Form {
    pub name: &'static str,
    /// The parameters by which it is computed; any other determination is solved for them.
    pub own: &'static [&'static str],
    pub takes: Takes,
}

/// What a distribution takes.
#[derive(Clone, Copy)]
pub(super) enum Takes {
    /// What determines the family.
    Law(Law),
    /// Keys in words.
    Keys(&'static str),
}

impl Takes {
    pub fn words(self) -> &'static str {
        match self {
            Self::Law(law) => law.needs(),
            Self::Keys(words) => words,
        }
    }
}
