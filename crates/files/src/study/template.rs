//! A new study file, which runs unchanged and has explanatory comments.

use apportion::design::DesignSettings;
use apportion::model::{Choice, Input, Output};
use apportion_afm::Options;
use apportion_base::text::capitalised;

use super::context::unknown_name;
use super::error::Problem;
use super::units::with_unit;
use crate::ModelKind;

/// The request for a new study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TemplateRequest {
    /// The model.
    pub model: ModelKind,
    /// Title; the model's description by default.
    pub title: Option<String>,
    /// Names of the inputs that become factors; by default a choice of the model's.
    pub factors: Vec<String>,
    /// The table of each of these in a model of one's own, as [`problem_factors`](super::problem_factors) returns them; by
    /// default from 0 to 1.
    pub tables: Vec<String>,
    /// Names of the outputs; by default the model's first.
    pub outputs: Vec<String>,
}

/// File name of the program in a new study of a program.
pub const NEW_PROGRAM: &str = "my_model.py";

/// Returns the text of a study file for `request`, which runs unchanged. A factor is uniform within 10 % of its nominal
/// value (from 0 to 1 in its unit if that is 0) if the model does not say how its inputs vary.
///
/// ```
/// use std::path::Path;
/// use apportion_files::ModelKind;
/// use apportion::study::Study;
/// use apportion_files::{TemplateRequest, template};
///
/// let factors = vec!["thickness".to_owned(), "velocity".to_owned()];
/// let request = TemplateRequest { model: ModelKind::AFM, title: None, factors, tables: Vec::new(), outputs: Vec::new() };
/// let study = apportion_files::parse_study(&template(&request)?, Path::new("mine.toml"), &[])?;
/// assert_eq!(study.space().factors()[1].name, "velocity");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Problem::UnknownName`] for an unknown factor or output, [`Problem::Repeated`] for one named twice.
pub fn template(request: &TemplateRequest) -> Result<String, Problem> {
    refuse_repeated("factor", &request.factors)?;
    refuse_repeated("output", &request.outputs)?;
    let model = request.model;
    let (model_lines, factors) = if model.is_users_own() { of_user(request) } else { of_model(request)? };
    let settings = DesignSettings::default();
    let title = match &request.title {
        Some(text) => format!("title = {}", toml::Value::from(text.as_str())),
        None if model.is_users_own() => "# title = \"For the page and the charts\"".to_owned(),
        None => format!("title = {}", toml::Value::String(capitalised(model.description))),
    };
    Ok(format!(
        include_str!("../../templates/new/study.toml"),
        name = model.name,
        title = title,
        model = model_lines,
        runs = settings.base_samples * (2 + factors.len() as u64),
        base_samples = settings.base_samples,
        seed = settings.seed,
        factors = factors.concat(),
    ))
}

/// Returns the program of a new study of a program: in Python, with its factors and outputs, each of which is the sum
/// of the factors until the user replaces it; `None` for other models.
pub fn new_program(request: &TemplateRequest) -> Option<String> {
    if request.model != ModelKind::COMMAND {
        return None;
    }
    let (factors, outputs) = names(request);
    // Strings of JSON are also strings of Python.
    let values = factors.iter().map(|name| format!("x[{}]", serde_json::Value::from(name.as_str())));
    let sum = values.collect::<Vec<_>>().join(" + ");
    let (values, outputs) = (vec!["y"; outputs.len()].join(", "), outputs.join(", "));
    Some(format!(include_str!("../../templates/new/my_model.py"), sum = sum, values = values, outputs = outputs))
}

/// Returns the requested names of factors and outputs, or default ones, for a model that has none.
fn names(request: &TemplateRequest) -> (Vec<String>, Vec<String>) {
    let (mut factors, mut outputs) = (request.factors.clone(), request.outputs.clone());
    if factors.is_empty() {
        factors.extend(["x1", "x2"].map(str::to_owned));
    }
    if outputs.is_empty() {
        outputs.push("y".to_owned());
    }
    (factors, outputs)
}

/// Returns the lines on outputs and model, and those of the factors, of the user's own model.
fn of_user(request: &TemplateRequest) -> (String, Vec<String>) {
    let (factors, outputs) = names(request);
    let value = match request.model {
        kind if kind == ModelKind::EXPRESSION => toml::Value::String(factors.join(" + ")).to_string(),
        _ => "\"1\"".to_owned(),
    };
    let lines: String = outputs.iter().map(|name| format!("outputs.{} = {value}\n", bare_or_quoted(name))).collect();
    let model = match request.model {
        kind if kind == ModelKind::EXPRESSION => {
            format!(include_str!("../../templates/new/expression.toml"), outputs = lines)
        }
        kind if kind == ModelKind::COMMAND => {
            format!(include_str!("../../templates/new/command.toml"), outputs = lines, program = NEW_PROGRAM)
        }
        _ => format!(include_str!("../../templates/new/external.toml"), outputs = lines),
    };
    let tables = request.tables.iter().map(String::as_str).chain(std::iter::repeat("{ min = 0, max = 1 }"));
    (model, factors.iter().zip(tables).map(|(name, table)| format!("{} = {table}\n", bare_or_quoted(name))).collect())
}

/// Returns the same for a model with its own inputs and outputs.
fn of_model(request: &TemplateRequest) -> Result<(String, Vec<String>), Problem> {
    let model = request.model;
    let (inputs, outputs) = (model.inputs(), model.outputs());
    let mut names: Vec<&str> = request.factors.iter().map(String::as_str).collect();
    if names.is_empty() && model.main_inputs.is_empty() {
        names.extend(inputs.iter().map(|input| input.name.as_str()));
    } else if names.is_empty() {
        names.extend(model.main_inputs);
    }
    let mut factors = Vec::with_capacity(names.len());
    for name in names {
        let input = inputs.iter().find(|input| input.name == name);
        let input = input.ok_or_else(|| unknown_name("factor", name, inputs.iter().map(|input| &*input.name)))?;
        factors.push(factor_line(input));
    }
    let valid = outputs.iter().map(|output| &*output.name);
    if let Some(name) = request.outputs.iter().find(|name| !valid.clone().any(|output| output == *name)) {
        return Err(unknown_name("output", name, valid));
    }
    let (chosen, others): (Vec<&Output>, Vec<&Output>) =
        outputs.iter().partition(|output| match &request.outputs[..] {
            [] => output.name == outputs[0].name,
            names => names.iter().any(|name| *name == *output.name),
        });
    let mut text = format!("outputs = [{}]\n", quoted_names(&chosen));
    if !others.is_empty() {
        text.push_str(&format!("# also: {}\n", quoted_names(&others)));
    }
    text.push_str(&if model == ModelKind::AFM { afm_table() } else { function_table(model) });
    Ok((text, factors))
}

fn quoted_names(outputs: &[&Output]) -> String {
    outputs.iter().map(|output| format!("\"{}\"", output.name)).collect::<Vec<_>>().join(", ")
}

/// Lists the current choices, and explains how to fix a constant.
fn afm_table() -> String {
    let options = Options::default();
    let mut text = "\n# The physics. Each choice is the default.\n[afm]\n".to_owned();
    for Choice { key, values, .. } in ModelKind::AFM.choices() {
        let in_force = match key {
            "friction" => options.friction.name(),
            "contact" => options.contact.name(),
            "fidelity" => options.fidelity.name(),
            _ => continue,
        };
        text.push_str(&format!("{key} = \"{in_force}\"    # {}\n", values.join(", ")));
    }
    text + "# An input that is not a factor can be fixed, with its unit:\n# width = \"40 um\"\n"
}

/// Lists the current parameters of a function, as comments.
fn function_table(model: ModelKind) -> String {
    let Some(answer) = model.known else { return String::new() };
    let mut text = format!("\n# {}\n", answer.formula);
    for (number, (name, value)) in answer.default_function().parameters().iter().enumerate() {
        let description = answer.parameters.iter().find(|p| p.name == *name).map_or("", |p| p.description);
        let table = if number == 0 { "[function]\n" } else { "" };
        text.push_str(&format!("{table}# {name} = {value}    # {description}\n"));
    }
    text
}

/// Formats a factor with its description.
fn factor_line(input: &Input) -> String {
    let name = bare_or_quoted(&input.name);
    match &input.distribution {
        Some(default) => format!("{name} = {{}}    # {}, as the function has it\n", default.name()),
        None => {
            let (min, max) = range(input);
            let unit = match input.unit.symbol() {
                "1" => String::new(),
                symbol => format!(", unit = \"{symbol}\""),
            };
            let nominal = with_unit(input.nominal, input.unit.symbol());
            format!("{name} = {{ min = {min}, max = {max}{unit} }}    # {}, nominal {nominal}\n", input.description)
        }
    }
}

/// Returns the range of the nominal value plus or minus a tenth of it, as far as that is physical.
fn range(input: &Input) -> (f64, f64) {
    let nominal = input.nominal;
    if nominal == 0.0 {
        return (0.0, 1.0);
    }
    let [a, b] = [0.9, 1.1].map(|factor| {
        // Four significant digits: users will change it.
        let value: f64 = format!("{:.3e}", nominal * factor).parse().unwrap_or(nominal);
        let is_inside = input.domain.is_none_or(|domain| domain.contains(input.unit.to_si(value)));
        if is_inside { value } else { nominal }
    });
    (a.min(b), a.max(b))
}

fn refuse_repeated(what: &'static str, names: &[String]) -> Result<(), Problem> {
    let repeated = names.iter().enumerate().find(|(place, name)| names[..*place].contains(name));
    repeated.map_or(Ok(()), |(_, name)| Err(Problem::Repeated { what, name: name.clone() }))
}

/// Formats a key of TOML, in quotes if it needs them.
fn bare_or_quoted(key: &str) -> String {
    toml_edit::Key::new(key).display_repr().into_owned()
}
