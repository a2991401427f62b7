//! The parameters of a factor's distribution, from the keys of its `[[factor]]` table.

use std::ops::Range;

use super::error::{Problem, nearest};
use super::file::{At, FactorSection};
use super::resolve::{Context, Fault};
use crate::space::{Distribution, DistributionError};

/// How each distribution is written, the default first.
pub(super) const LAWS: [Law; 12] = [
    Law { name: "uniform", takes: "min, max" },
    Law { name: "log-uniform", takes: "min, max" },
    Law { name: "normal", takes: "mean, sd" },
    Law { name: "truncated-normal", takes: "mean, sd (before truncation), min, max" },
    Law { name: "log-normal", takes: "mean, sd of the factor itself, or log_mean, log_sd of its logarithm" },
    Law { name: "triangular", takes: "min, mode, max" },
    Law { name: "beta", takes: "alpha, beta, min, max" },
    Law { name: "weibull", takes: "shape, scale, and location (default 0)" },
    Law { name: "gumbel", takes: "location, scale" },
    Law { name: "truncated-gumbel", takes: "location, scale (before truncation), min, max" },
    Law { name: "discrete", takes: "values, and weights (default equal)" },
    Law { name: "constant", takes: "value" },
];

#[derive(Clone, Copy)]
pub(super) struct Law {
    pub name: &'static str,
    takes: &'static str,
}

/// Whether a factor's table says nothing of its distribution.
pub(super) fn is_unsaid(fields: &FactorSection) -> bool {
    fields.distribution.is_none()
        && numbers(fields).iter().all(|(_, value)| value.is_none())
        && lists(fields).iter().all(|(_, value)| value.is_none())
}

/// The distribution of a factor.
pub(super) fn of(context: &Context<'_>, section: &At<FactorSection>) -> Result<Distribution, Fault> {
    let fields = section.get_ref();
    let typed = fields.distribution.as_ref().map_or(LAWS[0].name, |name| name.get_ref());
    let Some(law) = LAWS.into_iter().find(|law| law.name == typed) else {
        let span = fields.distribution.as_ref().map_or(0..0, At::span);
        let problem = Problem::UnknownName {
            what: "distribution",
            name: typed.to_owned(),
            nearest: nearest(typed, LAWS.iter().map(|law| law.name)),
            expected: LAWS.iter().map(|law| law.name.to_owned()).collect(),
        };
        return Err(context.fault(span, problem));
    };
    let mut keys = Keys { context, fields, law, used: Vec::new() };
    let made = keys.make()?;
    keys.refuse_others()?;
    made.map_err(|error| {
        let span = keys.blamed(&error);
        context.fault(span, Problem::Distribution { factor: fields.name.get_ref().clone(), source: error })
    })
}

/// The keys of a `[[factor]]` table, and which of them the distribution has taken.
struct Keys<'a> {
    context: &'a Context<'a>,
    fields: &'a FactorSection,
    law: Law,
    used: Vec<(&'static str, Range<usize>)>,
}

impl Keys<'_> {
    fn make(&mut self) -> Result<Result<Distribution, DistributionError>, Fault> {
        Ok(match self.law.name {
            "uniform" => Distribution::uniform(self.number("min")?, self.number("max")?),
            "log-uniform" => Distribution::log_uniform(self.number("min")?, self.number("max")?),
            "normal" => Distribution::normal(self.number("mean")?, self.number("sd")?),
            "truncated-normal" => {
                let (mean, sd) = (self.number("mean")?, self.number("sd")?);
                Distribution::truncated_normal(mean, sd, self.number("min")?, self.number("max")?)
            }
            "log-normal" if self.fields.log_mean.is_some() || self.fields.log_sd.is_some() => {
                Distribution::log_normal_of_logs(self.number("log_mean")?, self.number("log_sd")?)
            }
            "log-normal" => Distribution::log_normal(self.number("mean")?, self.number("sd")?),
            "triangular" => Distribution::triangular(self.number("min")?, self.number("mode")?, self.number("max")?),
            "beta" => {
                let (alpha, beta) = (self.number("alpha")?, self.number("beta")?);
                Distribution::beta(alpha, beta, self.number("min")?, self.number("max")?)
            }
            "weibull" => {
                let location = if self.fields.location.is_some() { self.number("location")? } else { 0.0 };
                Distribution::weibull(self.number("shape")?, self.number("scale")?, location)
            }
            "gumbel" => Distribution::gumbel(self.number("location")?, self.number("scale")?),
            "truncated-gumbel" => {
                let (location, scale) = (self.number("location")?, self.number("scale")?);
                Distribution::truncated_gumbel(location, scale, self.number("min")?, self.number("max")?)
            }
            "discrete" => {
                let values = self.list("values")?;
                let weights = if self.fields.weights.is_some() { Some(self.list("weights")?) } else { None };
                Distribution::discrete(&values, weights.as_deref())
            }
            _ => Distribution::constant(self.number("value")?),
        })
    }

    fn number(&mut self, key: &'static str) -> Result<f64, Fault> {
        let found =
            numbers(self.fields).into_iter().find(|(name, _)| *name == key).and_then(|(_, value)| value.as_ref());
        let value = found.ok_or_else(|| self.missing(key))?;
        self.used.push((key, value.span()));
        Ok(*value.get_ref())
    }

    fn list(&mut self, key: &'static str) -> Result<Vec<f64>, Fault> {
        let found = lists(self.fields).into_iter().find(|(name, _)| *name == key).and_then(|(_, value)| value.as_ref());
        let value = found.ok_or_else(|| self.missing(key))?;
        self.used.push((key, value.span()));
        Ok(value.get_ref().clone())
    }

    fn missing(&self, parameter: &'static str) -> Fault {
        let Law { name: distribution, takes } = self.law;
        let factor = self.fields.name.get_ref().clone();
        let problem = Problem::MissingParameter { factor, distribution, parameter, takes };
        self.context.fault(self.fields.name.span(), problem)
    }

    /// A parameter that stands in the table but that the distribution does not have is a mistake, not a decoration.
    fn refuse_others(&self) -> Result<(), Fault> {
        let numbers = numbers(self.fields).into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?.span())));
        let lists = lists(self.fields).into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?.span())));
        match numbers.chain(lists).find(|(key, _)| self.used.iter().all(|(used, _)| used != key)) {
            None => Ok(()),
            Some((parameter, span)) => {
                let Law { name: distribution, takes } = self.law;
                let factor = self.fields.name.get_ref().clone();
                Err(self.context.fault(span, Problem::ForeignParameter { factor, distribution, parameter, takes }))
            }
        }
    }

    /// The place of the parameter that `error` names, or else of the first one.
    fn blamed(&self, error: &DistributionError) -> Range<usize> {
        let named = self.used.iter().find(|(key, _)| Some(*key) == blamed_key(error));
        named.or(self.used.first()).map_or_else(|| self.fields.name.span(), |(_, span)| span.clone())
    }
}

/// The key that an error is about, where it is about one.
fn blamed_key(error: &DistributionError) -> Option<&'static str> {
    match error {
        DistributionError::NotFinite { parameter, .. }
        | DistributionError::NotPositive { parameter, .. }
        | DistributionError::OutOfRange { parameter, .. } => Some(parameter),
        DistributionError::Bounds { .. }
        | DistributionError::Truncation { .. }
        | DistributionError::GumbelTruncation { .. } => Some("min"),
        DistributionError::Mode { .. } => Some("mode"),
        DistributionError::NoValues => Some("values"),
        DistributionError::EntryNotFinite { list, .. } => Some(list),
        DistributionError::Lengths { .. }
        | DistributionError::NegativeWeight { .. }
        | DistributionError::ZeroWeights => Some("weights"),
        DistributionError::Overflow { .. } => None,
    }
}

type Numbers<'a> = [(&'static str, &'a Option<At<f64>>); 13];

fn numbers(fields: &FactorSection) -> Numbers<'_> {
    [
        ("min", &fields.min),
        ("max", &fields.max),
        ("mean", &fields.mean),
        ("sd", &fields.sd),
        ("log_mean", &fields.log_mean),
        ("log_sd", &fields.log_sd),
        ("mode", &fields.mode),
        ("alpha", &fields.alpha),
        ("beta", &fields.beta),
        ("shape", &fields.shape),
        ("scale", &fields.scale),
        ("location", &fields.location),
        ("value", &fields.value),
    ]
}

fn lists(fields: &FactorSection) -> [(&'static str, &Option<At<Vec<f64>>>); 2] {
    [("values", &fields.values), ("weights", &fields.weights)]
}
