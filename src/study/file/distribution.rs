//! The parameters of a factor's distribution, from the keys of its `[[factor]]` table.

use std::ops::Range;

use super::context::{Context, Fault, wrong};
use super::distribution_forms::{FORMS, Form, Takes};
use super::error::Problem;
use super::measured;
use super::sections::{At, FactorSection};
use crate::names::nearest;
use crate::space::distribution::{Law, Pareto, Statistic, StudentT};
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
            nearest: nearest(typed, FORMS.iter().map(|form| form.name)),
            expected: FORMS.iter().map(|form| form.name.to_owned()).collect(),
        };
        return Err(context.fault(span, problem));
    };
    let mut keys = Keys { context, fields, form, used: Vec::new() };
    let whole = keys.make()?;
    let made = keys.truncated(whole)?;
    keys.refuse_others()?;
    made.map_err(|error| {
        let span = keys.blamed(&error);
        context.fault(span, Problem::Distribution { factor: fields.name.get_ref().clone(), source: error })
    })
}

/// One distribution of a mixture, whose unit is that of the factor.
fn component(context: &Context<'_>, section: &At<FactorSection>) -> Result<Distribution, Fault> {
    let fields = section.get_ref();
    // A name that is not written stands where the component does.
    let own_name = Some(fields.name.span()).filter(|span| *span != section.span());
    let spans = [
        ("name", own_name),
        ("unit", fields.unit.as_ref().map(At::span)),
        ("group", fields.group.as_ref().map(At::span)),
        ("nominal", fields.nominal.as_ref().map(At::span)),
    ];
    match spans.into_iter().find_map(|(key, span)| Some((key, span?))) {
        Some((key, span)) => {
            let right = "it belongs to the whole factor, beside `components`";
            Err(context.fault(span, Problem::Misplaced { name: key.to_owned(), right: right.to_owned() }))
        }
        None => of(context, section),
    }
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
            "beta" if self.fields.mean.is_some() || self.fields.sd.is_some() => {
                let (mean, sd) = (self.number("mean")?, self.number("sd")?);
                Distribution::beta_of_mean(mean, sd, self.number("min")?, self.number("max")?)
            }
            "beta" => {
                let (alpha, beta) = (self.number("alpha")?, self.number("beta")?);
                Distribution::beta(alpha, beta, self.number("min")?, self.number("max")?)
            }
            "weibull" => {
                let location = self.location()?;
                Distribution::weibull(self.number("shape")?, self.number("scale")?, location)
            }
            "gamma" => {
                let location = self.location()?;
                Distribution::gamma(self.number("shape")?, self.number("scale")?, location)
            }
            "exponential" => {
                let location = self.location()?;
                Distribution::exponential(self.number("scale")?, location)
            }
            "logistic" => Distribution::logistic(self.number("location")?, self.number("scale")?),
            "student-t" => {
                let (df, location, scale) = (self.number("df")?, self.number("location")?, self.number("scale")?);
                match self.fields.truncate {
                    // Its variance may be finite all the same.
                    Some(_) => StudentT::new(df, location, scale).map(Distribution::StudentT),
                    None => Distribution::student_t(df, location, scale),
                }
            }
            "pareto" => {
                let (shape, min) = (self.number("shape")?, self.number("min")?);
                match self.fields.truncate {
                    Some(_) => Pareto::new(shape, min).map(Distribution::Pareto),
                    None => Distribution::pareto(shape, min),
                }
            }
            "inverse-gaussian" => Distribution::inverse_gaussian(self.number("mean")?, self.number("scale")?),
            "poisson" => Distribution::poisson(self.number("mean")?),
            "histogram" if self.fields.edges.is_some() || self.fields.weights.is_some() => {
                let edges = self.list("edges")?;
                Distribution::histogram(&edges, &self.list("weights")?)
            }
            "histogram" => Distribution::histogram_of_quantiles(&self.quantiles()?),
            "mixture" => {
                let components = self.fields.components.as_ref().ok_or_else(|| self.missing("components"))?;
                self.used.push(("components", components.span()));
                let component = |component: &At<FactorSection>| self::component(self.context, component);
                let components = components.get_ref().iter().map(component).collect::<Result<Vec<_>, _>>()?;
                let weights = if self.fields.weights.is_some() { Some(self.list("weights")?) } else { None };
                Distribution::mixture(&components, weights.as_deref())
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
            "seed" => Ok(Distribution::seed()),
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
        // What is truncated is said beside what is stated.
        self.used.extend(self.fields.truncate.as_ref().map(|truncate| ("truncate", truncate.span())));
        Some(self.refuse_others().map(|()| Distribution::stated(law, &statements)))
    }

    /// What `truncate` leaves of a distribution.
    fn truncated(
        &mut self,
        whole: Result<Distribution, DistributionError>,
    ) -> Result<Result<Distribution, DistributionError>, Fault> {
        let Some(truncate) = &self.fields.truncate else { return Ok(whole) };
        self.used.push(("truncate", truncate.span()));
        let [min, max] = truncate.get_ref()[..] else {
            let expected = "two numbers, as in truncate = [1, 5]; inf or -inf cuts nothing off";
            let found = format!("a list of {}", truncate.get_ref().len());
            return Err(self.context.fault(truncate.span(), wrong("truncate", expected, found)));
        };
        Ok(whole.and_then(|whole| whole.truncated(min, max)))
    }

    /// The quantiles of a histogram, by the probabilities in `quantiles` and by the keys that have one.
    fn quantiles(&mut self) -> Result<Vec<(f64, f64)>, Fault> {
        let mut quantiles = Vec::new();
        if let Some(typed) = &self.fields.quantiles {
            self.used.push(("quantiles", typed.span()));
            for (key, value) in typed.get_ref() {
                let Ok(probability) = key.get_ref().trim().parse::<f64>() else {
                    let expected = "values by probabilities from 0 to 1, as in { \"0\" = 1, \"0.5\" = 2, \"1\" = 5 }";
                    return Err(self
                        .context
                        .fault(key.span(), wrong("quantiles", expected, format!("{:?}", key.get_ref()))));
                };
                quantiles.push((probability, *value.get_ref()));
            }
        }
        for (key, value) in numbers(self.fields) {
            let statistic = Statistic::ALL.into_iter().find(|statistic| statistic.name() == key);
            if let Some((probability, value)) = statistic.and_then(Statistic::probability).zip(value.as_ref()) {
                self.used.push((key, value.span()));
                quantiles.push((probability, *value.get_ref()));
            }
        }
        if quantiles.is_empty() { Err(self.missing("quantiles")) } else { Ok(quantiles) }
    }

    /// `location`, by default 0.
    fn location(&mut self) -> Result<f64, Fault> {
        if self.fields.location.is_some() { self.number("location") } else { Ok(0.0) }
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
        | DistributionError::NotWhole { parameter, .. }
        | DistributionError::InfiniteVariance { parameter, .. } => Some(parameter),
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
        DistributionError::EntryNotFinite { list, .. } | DistributionError::NotRising { list, .. } => Some(list),
        DistributionError::NothingLeft { .. } | DistributionError::TruncationBounds { .. } => Some("truncate"),
        DistributionError::NoOrder { what: "truncated", .. } => Some("truncate"),
        DistributionError::NoOrder { .. } | DistributionError::NoComponents => Some("components"),
        DistributionError::Edges { .. } => Some("edges"),
        DistributionError::Quantiles { .. } => Some("quantiles"),
        DistributionError::Lengths { .. }
        | DistributionError::Components { .. }
        | DistributionError::NegativeWeight { .. }
        | DistributionError::ZeroWeights
        | DistributionError::WeightSum => Some("weights"),
        DistributionError::Overflow { .. }
        | DistributionError::Determined { .. }
        | DistributionError::UnitOfSeed { .. }
        | DistributionError::OffsetUnit { .. } => None,
    }
}

type Numbers<'a> = [(&'static str, &'a Option<At<f64>>); 24];

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
        ("df", &fields.df),
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

fn lists(fields: &FactorSection) -> [(&'static str, &Option<At<Vec<f64>>>); 3] {
    [("values", &fields.values), ("weights", &fields.weights), ("edges", &fields.edges)]
}

/// The places of the keys that are no numbers.
fn others(fields: &FactorSection) -> [(&'static str, Option<Range<usize>>); 9] {
    [
        ("edges", fields.edges.as_ref().map(At::span)),
        ("quantiles", fields.quantiles.as_ref().map(At::span)),
        ("components", fields.components.as_ref().map(At::span)),
        ("truncate", fields.truncate.as_ref().map(At::span)),
        ("values", fields.values.as_ref().map(At::span)),
        ("weights", fields.weights.as_ref().map(At::span)),
        ("labels", fields.labels.as_ref().map(At::span)),
        ("file", fields.file.as_ref().map(At::span)),
        ("column", fields.column.as_ref().map(At::span)),
    ]
}
