//! Problem definitions that exist: SALib's parameter file, its problem as JSON, or a CSV table of names and bounds.

use serde::Deserialize;
use toml::Value;

use super::error::Problem;
use crate::exchange::number;

/// A problem of SALib, as `json.dump` writes it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SalibProblem {
    num_vars: Option<usize>,
    names: Vec<String>,
    bounds: Vec<Vec<f64>>,
    groups: Option<Vec<String>>,
    dists: Option<Vec<String>>,
}

/// A factor as a problem states it: a line of a table, in the order of SALib's parameter file or under a header.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stated {
    #[serde(alias = "parameter", alias = "param", alias = "variable", alias = "factor")]
    name: String,
    #[serde(alias = "lower", alias = "lower_bound", alias = "min", alias = "minimum")]
    low: f64,
    #[serde(alias = "upper", alias = "upper_bound", alias = "max", alias = "maximum")]
    high: f64,
    #[serde(default)]
    group: Option<String>,
    #[serde(default, alias = "distribution")]
    dist: Option<String>,
    #[serde(default)]
    unit: Option<String>,
    /// Further numbers of its distribution.
    #[serde(skip)]
    more: Vec<f64>,
}

/// The distributions of SALib with ours, and the keys that its bounds are.
const DISTS: [(&str, &str, &[&str]); 7] = [
    ("unif", "uniform", &["min", "max"]),
    ("logunif", "log-uniform", &["min", "max"]),
    // Its third number is the part of the way from the first to the second.
    ("triang", "triangular", &["min", "max", "mode"]),
    ("norm", "normal", &["mean", "sd"]),
    ("truncnorm", "truncated-normal", &["min", "max", "mean", "sd"]),
    ("lognorm", "log-normal", &["log_mean", "log_sd"]),
    ("weibull", "weibull", &["shape", "scale"]),
];

/// Returns the factors of a problem definition: the name of each, and its table in a study file.
///
/// # Errors
/// [`Problem`] with the line or the factor that is not understood.
pub fn problem_factors(text: &str) -> Result<Vec<(String, String)>, Problem> {
    let text = text.trim_start_matches('\u{feff}');
    let stated = if text.trim_start().starts_with('{') { of_json(text)? } else { of_table(text)? };
    if stated.is_empty() {
        return Err(Problem::new("there are no factors in it"));
    }
    stated.into_iter().map(|factor| Ok((factor.name.clone(), factor.table()?))).collect()
}

fn of_json(text: &str) -> Result<Vec<Stated>, Problem> {
    let SalibProblem { num_vars, names, bounds, groups, dists } = serde_json::from_str(text)
        .map_err(|error| Problem::new(format!("expected a problem of SALib as `json.dump` writes it: {error}")))?;
    let lengths = [num_vars, Some(bounds.len()), groups.as_ref().map(Vec::len), dists.as_ref().map(Vec::len)];
    if lengths.iter().flatten().any(|length| *length != names.len()) || bounds.iter().any(|bounds| bounds.len() < 2) {
        return Err(Problem::new(
            "num_vars, names, bounds, groups and dists must be of one length, with two bounds or more",
        ));
    }
    let factors = names.into_iter().zip(bounds).enumerate().map(|(at, (name, bounds))| {
        let [group, dist] = [&groups, &dists].map(|list| Some(list.as_ref()?[at].clone()));
        Stated { name, low: bounds[0], high: bounds[1], group, dist, unit: None, more: bounds[2..].to_vec() }
    });
    Ok(factors.collect())
}

fn of_table(text: &str) -> Result<Vec<Stated>, Problem> {
    let first = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    let (separator, text) = match [',', ';', '\t'].into_iter().find(|separator| first.contains(*separator)) {
        Some(separator) => (separator, text.to_owned()),
        None => {
            let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join("\t"));
            ('\t', lines.collect::<Vec<_>>().join("\n"))
        }
    };
    let has_header = first.split([separator, ' ']).all(|cell| number(cell).is_none());
    let mut reader = csv::ReaderBuilder::new();
    reader.delimiter(separator as u8).comment(Some(b'#')).trim(csv::Trim::All);
    let mut reader = reader.has_headers(has_header).flexible(!has_header).from_reader(text.as_bytes());
    let refused = |error: csv::Error| {
        let (line, message) = (error.position().map_or(1, csv::Position::line), error.to_string());
        let unknown = message.split('`').nth(1).map_or_else(String::new, |name| format!(", not `{name}`"));
        let expected = "a name, two numbers, and perhaps the columns group, dist and unit";
        Problem::new(format!("line {line}: expected {expected}{unknown}"))
    };
    if has_header {
        let names = reader.headers().map_err(refused)?.iter().map(|name| name.to_lowercase().replace(' ', "_"));
        let names = names.collect();
        reader.set_headers(names);
    }
    reader.deserialize().map(|line| line.map_err(refused)).collect()
}

impl Stated {
    /// Returns its table in a study file.
    fn table(self) -> Result<String, Problem> {
        let (Self { name, low, high, more, .. }, dist) = (&self, self.dist.as_deref().unwrap_or("unif"));
        let found = DISTS.iter().find(|(salib, _, keys)| *salib == dist && keys.len() == 2 + more.len());
        let Some((_, distribution, keys)) = found else {
            let known = DISTS.map(|(dist, _, keys)| format!("{dist} ({})", keys.join(", "))).join(", ");
            let count = 2 + more.len();
            return Err(Problem::new(format!(
                "factor `{name}`: `{dist}` with {count} numbers: expected one of {known}"
            )));
        };
        let mut text = format!("{{ distribution = \"{distribution}\"");
        for (key, value) in keys.iter().zip([low, high].into_iter().chain(more)) {
            let value = if *key == "mode" { low + value * (high - low) } else { *value };
            text += &format!(", {key} = {value:?}");
        }
        let group = self.group.filter(|group| group != "NA" && *group != self.name);
        for (key, value) in [("unit", self.unit), ("group", group)] {
            text += &value.map_or_else(String::new, |value| format!(", {key} = {}", Value::from(value)));
        }
        Ok(text + " }")
    }
}
