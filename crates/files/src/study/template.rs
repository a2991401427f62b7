//! A new study file, which runs unchanged and has explanatory comments.

use apportion::design::DesignSettings;
use apportion::model::{Choice, Input, Output};
use apportion_afm::Options;
use apportion_base::text::capitalised;

use super::context::unknown_name;
use super::distribution::with_unit;
use super::error::Problem;
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
/// let request = TemplateRequest { model: ModelKind::AFM, title: None, factors, outputs: Vec::new() };
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
    let title = |text: String| format!("title = {}", toml::Value::String(text));
    let title = match &request.title {
        Some(text) => title(text.clone()),
        None if model.is_users_own() => format!("# {}", title("For the page and the charts".to_owned())),
        None => title(capitalised(model.description)),
    };
    Ok(format!(
        "# A study of apportion: which inputs of a model decide its output, and by how many percent.\n\
         # `apportion check FILE` explains it and its cost, `apportion run FILE` runs it,\n\
         # `apportion models {name}` lists all keys and values.\n\n\
         {title}\nmodel = \"{name}\"\n{model_lines}\n\
         # The cost is base_samples x (2 + factors) runs: {runs} here. With more of them the intervals are narrower.\n\
         [design]\n\
         base_samples = {base_samples}    # or runs = 300 where runs take minutes; or accuracy = 0.01 above all tables\n\
         seed = {seed}    # the same seed gives the same numbers, on any machine and any number of threads\n\n\
         # The inputs to compare: uniform from min to max, or distribution = \"normal\" with mean and sd,\n\
         # and many others (docs/factors.md). Factors that name the same `group` also get joint indices.\n\
         [factors]\n{lines}",
        name = model.name,
        runs = settings.base_samples * (2 + factors.len() as u64),
        base_samples = settings.base_samples,
        seed = settings.seed,
        lines = factors.concat(),
    ))
}

/// Returns the program of a new study of a program: in Python, with its factors and outputs, each of which is the sum
/// of the factors until the user replaces it; `None` for other models.
pub fn new_program(request: &TemplateRequest) -> Option<String> {
    if request.model != ModelKind::COMMAND {
        return None;
    }
    let (factors, outputs) = own_names(request);
    // Strings of JSON are also strings of Python.
    let value = |name: &String| format!("x[{}]", serde_json::Value::from(name.as_str()));
    let sum = factors.iter().map(value).collect::<Vec<_>>().join(" + ");
    let values = vec!["y"; outputs.len()].join(", ");
    Some(format!(
        "import csv\nimport sys\n\n\
         # One line in for each row: its number and the factor values. One line out: the number and the outputs.\n\
         # Print nothing else, or to sys.stderr.\n\
         for row in csv.DictReader(sys.stdin):\n    number = row.pop(\"id\")\n    \
         x = {{name: float(value) for name, value in row.items()}}\n    \
         y = {sum}\n    print(number, {values}, sep=\",\", flush=True)    # id, {}\n",
        outputs.join(", ")
    ))
}

/// Returns names of factors and outputs for a model without its own.
fn own_names(request: &TemplateRequest) -> (Vec<String>, Vec<String>) {
    let named = |names: &[String], default: &[&str]| -> Vec<String> {
        if names.is_empty() { default.iter().map(|&name| name.to_owned()).collect() } else { names.to_vec() }
    };
    (named(&request.factors, &["x1", "x2"]), named(&request.outputs, &["y"]))
}

/// Returns the lines on outputs and model, and those of the factors, of the user's own model.
fn of_user(request: &TemplateRequest) -> (String, Vec<String>) {
    let (factors, outputs) = own_names(request);
    let sum = toml::Value::String(factors.join(" + "));
    let lines = |value: &str| -> String {
        outputs.iter().map(|output| format!("outputs.{} = {value}\n", bare_or_quoted(output))).collect()
    };
    let model = match request.model {
        kind if kind == ModelKind::EXPRESSION => format!(
            "# Formulas in the factors and the constants, all in SI units.\n{}\n[expression]\n\
             # constants.a = 7    # a number, or a quantity as in \"10 nm\"\n",
            lines(&sum.to_string())
        ),
        kind if kind == ModelKind::COMMAND => format!(
            "# What the program prints, in its order, with units.\n{}\n\
             # It is started once for each core and kept alive: it reads one line for each row and prints one.\n\
             [command]\nprogram = [\"python3\", \"{NEW_PROGRAM}\"]    # relative to this file; no shell reads it\n\
             # timeout = \"60 s\"    # for a row, after which the program is started again [default: none]\n",
            lines("\"1\"")
        ),
        _ => format!(
            "# Units of the outputs. `apportion sample FILE -o design.csv` writes the points, and when the model has computed\n\
             # its outputs there, `apportion analyze outputs.csv --design design.csv` reads them.\n{}",
            lines("\"1\"")
        ),
    };
    (model, factors.iter().map(|name| format!("{} = {{ min = 0, max = 1 }}\n", bare_or_quoted(name))).collect())
}

/// Returns the same for a model with its own inputs and outputs.
fn of_model(request: &TemplateRequest) -> Result<(String, Vec<String>), Problem> {
    let model = request.model;
    let (inputs, outputs) = (model.inputs(), model.outputs());
    let input = |name: &str| {
        let found = inputs.iter().find(|input| input.name == name);
        found.ok_or_else(|| unknown_name("factor", name, inputs.iter().map(|input| input.name.as_str())))
    };
    let factors: Vec<&Input> = match (&request.factors[..], model.main_inputs) {
        ([], []) => inputs.iter().collect(),
        ([], main) => main.iter().map(|name| input(name)).collect::<Result<_, _>>()?,
        (names, _) => names.iter().map(|name| input(name)).collect::<Result<_, _>>()?,
    };
    let is_known = |name: &&String| outputs.iter().any(|output| output.name == **name);
    if let Some(name) = request.outputs.iter().find(|name| !is_known(name)) {
        return Err(unknown_name("output", name, outputs.iter().map(|output| &*output.name)));
    }
    let is_asked = |output: &&Output| match &request.outputs[..] {
        [] => output.name == outputs[0].name,
        names => names.iter().any(|name| *name == *output.name),
    };
    let (asked, others): (Vec<&Output>, Vec<&Output>) = outputs.iter().partition(is_asked);
    let names = |outputs: &[&Output]| outputs.iter().map(|o| format!("\"{}\"", o.name)).collect::<Vec<_>>().join(", ");
    let mut text = format!("outputs = [{}]\n", names(&asked));
    if !others.is_empty() {
        text.push_str(&format!("# also: {}\n", names(&others)));
    }
    text.push_str(&if model == ModelKind::AFM { afm_table() } else { function_table(model) });
    Ok((text, factors.into_iter().map(factor_line).collect()))
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
    let about = |name: &str| answer.parameters.iter().find(|p| p.name == name).map_or("", |p| p.description);
    let function = answer.default_function();
    let lines: String = function
        .parameters()
        .iter()
        .map(|(name, value)| format!("# {name} = {value}    # {}\n", about(name)))
        .collect();
    let table = if lines.is_empty() { "" } else { "[function]\n" };
    format!("\n# {}\n{table}{lines}", answer.formula)
}

/// Formats a factor with its description.
fn factor_line(input: &Input) -> String {
    let name = bare_or_quoted(&input.name);
    match &input.distribution {
        Some(own) => format!("{name} = {{}}    # {}, as the function has it\n", own.name()),
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
    let inside = |value: f64| input.domain.is_none_or(|domain| domain.contains(input.unit.to_si(value)));
    let bound = |factor: f64| {
        // Four significant digits: users will change it.
        let value: f64 = format!("{:.3e}", nominal * factor).parse().unwrap_or(nominal);
        if inside(value) { value } else { nominal }
    };
    let (a, b) = (bound(0.9), bound(1.1));
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
