//! The parameters of a factor's distribution, from the keys of its `[[factor]]` table.

use std::ops::Range;

use super::context::{Context, Fault};
use super::distribution_forms::{FORMS, Form, Takes};
use super::error::{Problem, meant};
use super::measured;
use super::sections::{At, FactorSection};
use crate::space::distribution::{Law, Statistic};
use crate::space::{Distribution, DistributionError};

/// Whether a factor's table says nothing of its distribution.
pub(super) fn is_unsaid(fields: &FactorSection) -> bool {
    fields.distribution.is_none()
        && numbers(fields).iter().all(|(_, value)| value.is_none())
        && others(fields).into_iter().all(|(_, span)| span.is_none())
}

/// Whether a factor's distribution is given by something else than its own parameters.
pub(super) fn is_determined(fields: &FactorSection) -> bool {
    form(fields).is_some_and(|form| !statements(fields, form).is_empty())
}

fn form(fields: &FactorSection) -> Option<Form> {
    let typed = fields.distribution.as_ref().map_or(FORMS[0].name, |name| name.get_ref());
    FORMS.into_iter().find(|form| form.name == typed)
}

/// What is stated of a distribution, where that is more than its own parameters; else nothing.
fn statements(fields: &FactorSection, form: Form) -> Vec<(&At<f64>, Statistic)> {
    let Takes::Law(law) = form.takes else { return Vec::new() };
    let given = || numbers(fields).into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?)));
    let statistic = |key: &str| Statistic::ALL.into_iter().find(|statistic| statistic.name() == key);
    let logs = law == Law::LogNormal && given().any(|(key, _)| key.starts_with("log_"));
    let own: &[&str] = if logs { &["log_mean", "log_sd"] } else { form.own };
    let stated = given().filter_map(|(key, value)| Some((value, statistic(key).filter(|s| law.takes(*s))?)));
    let stated: Vec<(&At<f64>, Statistic)> = stated.collect();
    if stated.iter().all(|(_, statistic)| own.contains(&statistic.name())) { Vec::new() } else { stated }
}

/// The distribution of a factor.
pub(super) fn of(context: &Context<'_>, section: &At<FactorSection>) -> Result<Distribution, Fault> {
    let fields = section.get_ref();
    let Some(form) = form(fields) else {
        let (typed, span) =
            fields.distribution.as_ref().map_or(("", 0..0), |name| (name.get_ref().as_str(), name.span()));
        let problem = Problem::UnknownName {
            what: "distribution",
            name: typed.to_owned(),
            nearest: meant(typed, FORMS.iter().map(|form| form.name)),
            expected: FORMS.iter().map(|form| form.name.to_owned()).collect(),
        };
        return Err(context.fault(span, problem));
    };
    let mut keys = Keys { context, fields, form, used: Vec::new() };
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
    form: Form,
    used: Vec<(&'static str, Range<usize>)>,
}

impl Keys<'_> {
    fn make(&mut self) -> Result<Result<Distribution, DistributionError>, Fault> {
        if let Some(statements) = self.statements() {
            return statements;
        }
        Ok(match self.form.name {
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
            "integer" => Distribution::integer(self.number("min")?, self.number("max")?),
            "boolean" => {
                Distribution::boolean(if self.fields.probability.is_some() { self.number("probability")? } else { 0.5 })
            }
            "categorical" => {
                let labels = self.labels()?;
                let values = if self.fields.values.is_some() { Some(self.list("values")?) } else { None };
                let weights = if self.fields.weights.is_some() { Some(self.list("weights")?) } else { None };
                Distribution::categorical(&labels, values.as_deref(), weights.as_deref())
            }
            "empirical" => match &self.fields.file {
                Some(file) => {
                    self.used.push(("file", file.span()));
                    self.used.extend(self.fields.column.iter().map(|column| ("column", column.span())));
                    let (values, source) = measured::read(self.context, file, self.fields.column.as_ref())?;
                    Distribution::empirical(&values, Some(source))
                }
                None => Distribution::empirical(&self.list("values")?, None),
            },
            _ => Distribution::constant(self.number("value")?),
        })
    }

    /// The distribution by what is stated of it, if that is more than its own parameters.
    fn statements(&mut self) -> Option<Result<Result<Distribution, DistributionError>, Fault>> {
        let Takes::Law(law) = self.form.takes else { return None };
        let stated = statements(self.fields, self.form);
        if stated.is_empty() {
            return None;
        }
        self.used.extend(stated.iter().map(|(value, statistic)| (statistic.name(), value.span())));
        let statements: Vec<(Statistic, f64)> =
            stated.iter().map(|(value, statistic)| (*statistic, *value.get_ref())).collect();
        Some(self.refuse_others().map(|()| Distribution::stated(law, &statements)))
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

    fn labels(&mut self) -> Result<Vec<String>, Fault> {
        let labels = self.fields.labels.as_ref().ok_or_else(|| self.missing("labels"))?;
        self.used.push(("labels", labels.span()));
        Ok(labels.get_ref().clone())
    }

    fn missing(&self, parameter: &'static str) -> Fault {
        let (distribution, takes) = (self.form.name, self.form.takes.words());
        let factor = self.fields.name.get_ref().clone();
        let problem = Problem::MissingParameter { factor, distribution, parameter, takes };
        self.context.fault(self.fields.name.span(), problem)
    }

    /// A parameter that stands in the table but that the distribution does not have is a mistake, not a decoration.
    fn refuse_others(&self) -> Result<(), Fault> {
        let numbers = numbers(self.fields).into_iter().filter_map(|(key, value)| Some((key, value.as_ref()?.span())));
        let others = others(self.fields).into_iter().filter_map(|(key, span)| Some((key, span?)));
        match numbers.chain(others).find(|(key, _)| self.used.iter().all(|(used, _)| used != key)) {
            None => Ok(()),
            Some((parameter, span)) => {
                let (distribution, takes) = (self.form.name, self.form.takes.words());
                let factor = self.fields.name.get_ref().clone();
                Err(self.context.fault(span, Problem::ForeignParameter { factor, distribution, parameter, takes }))
            }
        }
    }

    /// The place of the parameter that `error` names, or else of the first one.
    fn blamed(&self, error: &DistributionError) -> Range<usize> {
        if let DistributionError::Determined { .. } = error {
            // What stands beside the usual parameters: perhaps too much, perhaps not enough.
            let beside = self.used.iter().find(|(key, _)| !self.form.own.contains(key));
            return beside.map_or_else(|| self.fields.name.span(), |(_, span)| span.clone());
        }
        let named = self.used.iter().find(|(key, _)| Some(*key) == blamed_key(error));
        named.or(self.used.first()).map_or_else(|| self.fields.name.span(), |(_, span)| span.clone())
    }
}

/// The key that an error is about, where it is about one.
fn blamed_key(error: &DistributionError) -> Option<&'static str> {
    match error {
        DistributionError::NotFinite { parameter, .. }
        | DistributionError::NotPositive { parameter, .. }
        | DistributionError::OutOfRange { parameter, .. }
        | DistributionError::NotWhole { parameter, .. } => Some(parameter),
        DistributionError::NotStated { statistic, .. } | DistributionError::StatedTwice { statistic } => {
            Some(statistic)
        }
        DistributionError::NoSuchDistribution { first, .. } => Some(first),
        DistributionError::Order { upper, .. } => Some(upper),
        DistributionError::EmptyLabel { .. } | DistributionError::RepeatedLabel { .. } => Some("labels"),
        DistributionError::Labels { .. } | DistributionError::RepeatedValue { .. } => Some("values"),
        DistributionError::Bounds { .. }
        | DistributionError::Truncation { .. }
        | DistributionError::GumbelTruncation { .. } => Some("min"),
        DistributionError::Mode { .. } => Some("mode"),
        DistributionError::NoValues => Some("values"),
        DistributionError::EntryNotFinite { list, .. } => Some(list),
        DistributionError::Lengths { .. }
        | DistributionError::NegativeWeight { .. }
        | DistributionError::ZeroWeights => Some("weights"),
        DistributionError::Overflow { .. }
        | DistributionError::Determined { .. }
        | DistributionError::OffsetUnit { .. } => None,
    }
}

type Numbers<'a> = [(&'static str, &'a Option<At<f64>>); 23];

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
        ("p01", &fields.p01),
        ("p05", &fields.p05),
        ("p10", &fields.p10),
        ("p25", &fields.p25),
        ("p50", &fields.p50),
        ("p75", &fields.p75),
        ("p90", &fields.p90),
        ("p95", &fields.p95),
        ("p99", &fields.p99),
        ("probability", &fields.probability),
        ("value", &fields.value),
    ]
}

fn lists(fields: &FactorSection) -> [(&'static str, &Option<At<Vec<f64>>>); 2] {
    [("values", &fields.values), ("weights", &fields.weights)]
}

/// The places of the keys that are no numbers.
fn others(fields: &FactorSection) -> [(&'static str, Option<Range<usize>>); 5] {
    [
        ("values", fields.values.as_ref().map(At::span)),
        ("weights", fields.weights.as_ref().map(At::span)),
        ("labels", fields.labels.as_ref().map(At::span)),
        ("file", fields.file.as_ref().map(At::span)),
        ("column", fields.column.as_ref().map(At::span)),
    ]
}
