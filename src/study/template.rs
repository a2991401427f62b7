//! A study to begin with: a file that runs as it is, with comments that teach.

use super::error::Problem;
use super::resolve::{unknown_name, with_unit};
use crate::afm::Options;
use crate::design::DesignSettings;
use crate::model::{Input, KnownAnswer, ModelKind, Output};
use crate::words::capitalised;

/// What a study to begin with is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TemplateRequest {
    /// The model.
    pub model: ModelKind,
    /// Title for people; the model's description if there is none.
    pub title: Option<String>,
    /// Names of the inputs that become factors; a choice of the model's if there are none.
    pub factors: Vec<String>,
    /// Names of the outputs; the model's first if there are none.
    pub outputs: Vec<String>,
}

/// How far a factor reaches to both sides of its nominal value where the model does not say how it varies.
const REACH: f64 = 0.1;
/// The factors of the nanoparticle model where none are named: the cantilever's dimensions.
const AFM_FACTORS: [&str; 3] = ["length", "width", "thickness"];

/// A remark above the factors.
const GROUPS: &str = "# Factors that name the same `group` also get joint indices.\n";
/// A remark in the first factor.
const LAWS: &str = "# uniform; or normal, log-normal, triangular, beta, categorical, ...: see docs/factors.md";

/// The text of a study file on `request`: it can be run as it is. A factor of a model that does not say how its inputs vary
/// is uniform within 10 % of its nominal value (from 0 to 1 in its unit where that is 0).
///
/// ```
/// use std::path::Path;
/// use apportion::model::ModelKind;
/// use apportion::study::{Study, TemplateRequest, template};
///
/// let factors = vec!["thickness".to_owned(), "velocity".to_owned()];
/// let request = TemplateRequest { model: ModelKind::Afm, title: None, factors, outputs: Vec::new() };
/// let study = Study::parse(&template(&request)?, Path::new("mine.toml"), &[])?;
/// assert_eq!(study.space.factors()[1].name, "velocity");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Problem::UnknownName`] for a factor or output that the model does not have, [`Problem::Repeated`] for one named twice.
pub fn template(request: &TemplateRequest) -> Result<String, Problem> {
    let model = request.model;
    match model {
        ModelKind::Expression => return formula_template(request),
        ModelKind::External => return external_template(request),
        ModelKind::Command => return program_template(request),
        ModelKind::Afm | ModelKind::Known(_) => (),
    }
    let (inputs, known_outputs) = (model.inputs(), model.outputs());
    let factors = factors(request, &inputs)?;
    let outputs = outputs(request, &known_outputs)?;
    let mut text = heading(request);
    text.push_str(&outputs_line(&outputs, &known_outputs));
    text.push_str(&match model {
        ModelKind::Afm => afm_table(&inputs, &factors),
        ModelKind::Known(answer) => function_table(answer),
        ModelKind::Expression | ModelKind::Command | ModelKind::External => String::new(),
    });
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!(
        "\n# The inputs whose influence is asked for. All others stand at their nominal values.\n{GROUPS}"
    ));
    for (place, factor) in factors.iter().enumerate() {
        text.push_str(&factor_table(factor, place == 0));
    }
    Ok(text)
}

/// What stands at the top: what the file is for, title and model.
fn heading(request: &TemplateRequest) -> String {
    let model = request.model;
    let title = request.title.clone().unwrap_or_else(|| capitalised(model.description()));
    format!(
        "# A study of apportion: which inputs of a model decide its output, and by how many percent.\n\
         # `apportion check FILE` explains it and tells what it will cost, `apportion run FILE` runs it,\n\
         # `apportion models {}` lists everything that can stand here.\n\n\
         title = {}\nmodel = \"{}\"\n",
        model.name(),
        toml::Value::String(title),
        model.name()
    )
}

/// A study of formulas to be replaced: each output is the sum of the factors.
fn formula_template(request: &TemplateRequest) -> Result<String, Problem> {
    let (factors, outputs) = own_names(request)?;
    let mut text = heading(request);
    text.push_str(
        "\n# Formulas in the factors and the constants, all in SI units; `apportion models expression` lists the\n\
         # functions.\n[expression]\n",
    );
    for output in &outputs {
        text.push_str(&format!("outputs.{output} = \"{}\"\n", factors.join(" + ")));
    }
    text.push_str("# constants.a = 7    # a number, or a quantity as in \"10 nm\"\n");
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!("\n# The inputs of the formulas.\n{GROUPS}"));
    text.push_str(&own_factors(&factors));
    Ok(text)
}

/// A study of a model outside.
fn external_template(request: &TemplateRequest) -> Result<String, Problem> {
    let (factors, outputs) = own_names(request)?;
    let mut text = heading(request);
    text.push_str(
        "\n# The model runs outside: `apportion sample FILE -o design.csv` writes the points, and when it has computed its\n\
         # outputs there, `apportion analyze outputs.csv --design design.csv` reads them. The unit of each output:\n\
         [external]\n",
    );
    outputs.iter().for_each(|output| text.push_str(&format!("outputs.{} = \"1\"\n", bare_or_quoted(output))));
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!("\n# The inputs of the model.\n{GROUPS}"));
    text.push_str(&own_factors(&factors));
    Ok(text)
}

/// Names of factors and outputs of a model that has none of its own.
fn own_names(request: &TemplateRequest) -> Result<(Vec<String>, Vec<String>), Problem> {
    refuse_repeated("factor", &request.factors)?;
    refuse_repeated("output", &request.outputs)?;
    let named = |names: &[String], default: &[&str]| -> Vec<String> {
        if names.is_empty() { default.iter().map(|&name| name.to_owned()).collect() } else { names.to_vec() }
    };
    Ok((named(&request.factors, &["x1", "x2"]), named(&request.outputs, &["y"])))
}

/// Factors between 0 and 1, to be changed.
fn own_factors(factors: &[String]) -> String {
    let factor = |factor: &String| {
        let name = toml::Value::String(factor.clone());
        format!("\n[[factor]]\nname = {name}\n{LAWS}\nmin = 0\nmax = 1\n")
    };
    factors.iter().map(factor).collect()
}

/// File name of the program in a new study of a program.
pub const NEW_PROGRAM: &str = "my_model.py";

/// A study of a program, which stands in its comments.
fn program_template(request: &TemplateRequest) -> Result<String, Problem> {
    let (factors, outputs) = own_names(request)?;
    let mut text = heading(request);
    let names: Vec<String> = outputs.iter().map(|output| toml::Value::String(output.clone()).to_string()).collect();
    text.push_str(&format!(
        "outputs = [{}]    # the columns that the program prints, in its order\n\n\
         # The program is started once for each core and kept alive. It reads a header and then lines of factor values on\n\
         # its standard input, and prints a line for each; docs/worker-protocol.md has it in full. This one is {NEW_PROGRAM}:\n\
         #\n",
        names.join(", ")
    ));
    for line in python_program(&factors, &outputs).lines() {
        text.push_str(format!("#     {line}").trim_end());
        text.push('\n');
    }
    text.push_str(&format!(
        "#\n[command]\nprogram = [\"python3\", \"{NEW_PROGRAM}\"]    # relative to this file; no shell reads it\n\
         # outputs.{} = \"nN\"    # or here, each with its unit\n\
         # protocol = \"json-lines\"    # an object for each row instead of a line of CSV\n\
         # workers = 4    # processes at once [default: one for each core]\n\
         # timeout = \"60 s\"    # for a row, after which the program is started anew [default: none]\n\
         # retries = 1    # of a row on which the program died or hung, before it counts as failed\n",
        bare_or_quoted(&outputs[0])
    ));
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!("\n# What the program gets, in this order and in these units.\n{GROUPS}"));
    text.push_str(&own_factors(&factors));
    Ok(text)
}

/// A key of TOML, in quotes where it needs them.
fn bare_or_quoted(key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    if bare { key.to_owned() } else { toml::Value::String(key.to_owned()).to_string() }
}

/// The program of a [new study](template) of a program: in Python, of its factors and outputs, each of which is the sum of
/// the factors until somebody writes another; `None` of other models.
///
/// # Errors
/// [`Problem::Repeated`] for a name given twice.
pub fn new_program(request: &TemplateRequest) -> Result<Option<String>, Problem> {
    if request.model != ModelKind::Command {
        return Ok(None);
    }
    let (factors, outputs) = own_names(request)?;
    Ok(Some(python_program(&factors, &outputs)))
}

fn python_program(factors: &[String], outputs: &[String]) -> String {
    // JSON's texts are Python's too.
    let value = |name: &String| format!("x[{}]", serde_json::Value::from(name.as_str()));
    let sum = factors.iter().map(value).collect::<Vec<_>>().join(" + ");
    let values = vec!["y"; outputs.len()].join(", ");
    let (comma, join) =
        if outputs.len() > 1 { (format!("    # {}", outputs.join(", ")), ", sep=\",\"") } else { (String::new(), "") };
    format!(
        "import csv\nimport sys\n\n\
         # One line of factor values in, one line of outputs out; print nothing else, or to sys.stderr.\n\
         for row in csv.DictReader(sys.stdin):\n    x = {{name: float(value) for name, value in row.items()}}\n    \
         y = {sum}\n    print({values}{join}, flush=True){comma}\n"
    )
}

fn factors<'a>(request: &TemplateRequest, inputs: &'a [Input]) -> Result<Vec<&'a Input>, Problem> {
    let find = |name: &str| {
        let found = inputs.iter().find(|input| input.name == name);
        found.ok_or_else(|| unknown_name("factor", name, inputs.iter().map(|input| input.name.as_str())))
    };
    refuse_repeated("factor", &request.factors)?;
    match request.model {
        _ if !request.factors.is_empty() => request.factors.iter().map(|name| find(name)).collect(),
        ModelKind::Afm => AFM_FACTORS.iter().map(|name| find(name)).collect(),
        ModelKind::Known(_) | ModelKind::Expression | ModelKind::Command | ModelKind::External => {
            Ok(inputs.iter().collect())
        }
    }
}

fn outputs<'a>(request: &TemplateRequest, known: &'a [Output]) -> Result<Vec<&'a Output>, Problem> {
    refuse_repeated("output", &request.outputs)?;
    let find = |name: &String| {
        let found = known.iter().find(|output| output.name == *name);
        found.ok_or_else(|| unknown_name("output", name, known.iter().map(|output| &*output.name)))
    };
    if request.outputs.is_empty() {
        Ok(known.iter().take(1).collect())
    } else {
        request.outputs.iter().map(find).collect()
    }
}

fn refuse_repeated(what: &'static str, names: &[String]) -> Result<(), Problem> {
    let repeated = names.iter().enumerate().find(|(place, name)| names[..*place].contains(name));
    repeated.map_or(Ok(()), |(_, name)| Err(Problem::Repeated { what, name: name.clone() }))
}

fn outputs_line(outputs: &[&Output], known: &[Output]) -> String {
    let quoted: Vec<String> = outputs.iter().map(|output| format!("\"{}\"", output.name)).collect();
    let mut text = format!("outputs = [{}]\n", quoted.join(", "));
    let others: Vec<&str> = known.iter().filter(|o| !outputs.contains(o)).map(|output| &*output.name).collect();
    if !others.is_empty() {
        text.push_str(&format!("# also: {}\n", others.join(", ")));
    }
    text
}

/// The choices in force, and how to fix a constant.
fn afm_table(inputs: &[Input], factors: &[&Input]) -> String {
    let options = Options::default();
    let in_force = |key: &str| match key {
        "friction" => Some(options.friction.name()),
        "contact" => Some(options.contact.name()),
        "fidelity" => Some(options.fidelity.name()),
        _ => None,
    };
    let mut text = "\n# The physics. Each choice stands as it would be if it were left out.\n[afm]\n".to_owned();
    for (key, names) in ModelKind::Afm.choices() {
        match in_force(key) {
            Some(name) => text.push_str(&format!("{key} = \"{name}\"    # {}\n", names.join(", "))),
            None => text.push_str(&format!("# {key}: {}\n", names.join(", "))),
        }
    }
    let fixed = inputs.iter().find(|input| input.unit.symbol() != "1" && !factors.contains(input));
    if let Some(input) = fixed {
        text.push_str(&format!(
            "# An input that is no factor can be fixed, with its unit:\n# {} = \"{} {}\"\n",
            input.name, input.nominal, input.unit
        ));
    }
    text
}

/// The parameters of a function, as comments: they are those in force.
fn function_table(answer: KnownAnswer) -> String {
    let function = answer.default_function();
    let about = |name: &str| answer.parameters().iter().find(|p| p.name == name).map_or("", |p| p.description);
    let lines: String = function
        .parameters()
        .iter()
        .map(|(name, value)| format!("# {name} = {value}    # {}\n", about(name)))
        .collect();
    let formula = format!("\n# {}\n", answer.formula());
    if lines.is_empty() { formula } else { format!("{formula}[function]\n{lines}") }
}

fn design_table(factors: usize) -> String {
    let settings = DesignSettings::default();
    format!(
        "\n# The cost is base_samples x (2 + factors) runs: {} here. With more of them the intervals are narrower.\n\
         [design]\n\
         base_samples = {}    # best a power of two\n\
         seed = {}    # the same seed gives the same numbers, on any machine and any number of threads\n\
         # target = {{ half_width = 0.01 }}    # or: go on until every index is known to this, starting small\n\
         # budget = \"60 s\"    # but stop before this time is over\n\n\
         # More from the same runs: joint effects of pairs (nearly twice the runs), a factor that does nothing.\n\
         [analysis]\n\
         # second_order = true\n\
         # dummy = true\n",
        settings.base_samples * (2 + factors as u64),
        settings.base_samples,
        settings.seed
    )
}

/// A factor; the `first` one with more words.
fn factor_table(input: &Input, first: bool) -> String {
    let symbol = if input.symbol == input.name { String::new() } else { format!(" ({})", input.symbol) };
    let what =
        if input.description.is_empty() { String::new() } else { format!("    # {}{symbol}", input.description) };
    let mut text = format!("\n[[factor]]\nname = \"{}\"{what}\n", input.name);
    let laws = "# or normal, truncated-normal, log-normal, triangular, beta, discrete, ...: see the README";
    match &input.distribution {
        Some(own) => {
            text.push_str(&format!(
                "# {}, as the function has it; for another: distribution, min, max, ...\n",
                in_words(own)
            ));
        }
        None => {
            let (min, max) = range(input);
            let laws = if first { format!("    {laws}") } else { String::new() };
            text.push_str(&format!("distribution = \"uniform\"{laws}\nmin = {min}\nmax = {max}\n"));
            if input.unit.symbol() != "1" {
                text.push_str(&format!("unit = \"{}\"\n", input.unit));
            }
            let nominal = with_unit(input.nominal, input.unit.symbol());
            text.push_str(&format!("# the nominal value is {nominal}\n"));
        }
    }
    text
}

fn in_words(distribution: &crate::space::Distribution) -> String {
    let value = serde_json::to_value(distribution).unwrap_or_default();
    let entries = value.as_object().into_iter().flatten();
    let said = entries.map(|(key, value)| match (key.as_str(), value.as_str()) {
        ("name", Some(name)) => name.to_owned(),
        _ => format!("{key} {value}"),
    });
    said.collect::<Vec<_>>().join(", ")
}

/// The nominal value and a tenth of it to both sides, as far as that is physical.
fn range(input: &Input) -> (f64, f64) {
    let nominal = input.nominal;
    if nominal == 0.0 {
        return (0.0, 1.0);
    }
    let inside = |value: f64| input.domain.is_none_or(|domain| domain.contains(input.unit.to_si(value)));
    let bound = |factor: f64| {
        let value = short(nominal * factor);
        if inside(value) { value } else { nominal }
    };
    let (a, b) = (bound(1.0 - REACH), bound(1.0 + REACH));
    (a.min(b), a.max(b))
}

/// Four significant digits: people will change it.
fn short(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study::Study;

    fn studied(request: &TemplateRequest) -> Study {
        let text = template(request).unwrap_or_else(|problem| panic!("{request:?}: {problem}"));
        let study = Study::parse(&text, Path::new("new.toml"), &[]);
        let study = study.unwrap_or_else(|error| panic!("{request:?}: {error}\n{text}"));
        assert!(study.notes.is_empty(), "{:?}", study.notes);
        study
    }

    fn request(model: ModelKind) -> TemplateRequest {
        TemplateRequest { model, title: None, factors: Vec::new(), outputs: Vec::new() }
    }

    #[test]
    fn every_model_has_a_study_to_begin_with() {
        for model in ModelKind::all() {
            let study = studied(&request(model));
            assert_eq!(study.subject.kind(), Some(model));
            assert!(!study.space.factors().is_empty());
        }
    }

    #[test]
    fn every_input_can_be_a_factor_and_every_output_asked_for() {
        for model in ModelKind::all() {
            let outputs: Vec<String> = model.outputs().iter().map(|output| output.name.to_string()).collect();
            for input in model.inputs() {
                let study = studied(&TemplateRequest {
                    factors: vec![input.name.clone()],
                    outputs: outputs.clone(),
                    title: Some("a \"quoted\" \\ title\nof two lines".to_owned()),
                    ..request(model)
                });
                assert_eq!(study.space.factors()[0].name, input.name);
                assert_eq!(study.model().outputs().len(), outputs.len());
                assert_eq!(study.title.as_deref(), Some("a \"quoted\" \\ title\nof two lines"));
            }
        }
    }

    /// What the comments say of choices and parameters is true: without its comments a study means the same.
    #[test]
    fn choices_and_parameters_are_those_in_force() {
        let plain = Study::parse(
            "[[factor]]\nname = \"length\"\nmin = 1\nmax = 2\nunit = \"um\"",
            Path::new("plain.toml"),
            &[],
        );
        assert_eq!(studied(&request(ModelKind::Afm)).settings(), plain.unwrap().settings());
        for model in KnownAnswer::all().map(ModelKind::Known) {
            let text = template(&request(model)).unwrap();
            let told = text.lines().skip_while(|line| *line != "[function]").take_while(|line| !line.is_empty());
            let said: String = told.map(|line| line.trim_start_matches("# ").to_owned() + "\n").collect();
            // A list says how many inputs there are; `dimension` beside it is refused.
            let lines = said.lines().filter(|line| !(line.starts_with("dimension") && said.contains(" = [")));
            let said: Vec<&str> = lines.collect();
            let text = format!("model = \"{}\"\n{}", model.name(), said.join("\n"));
            let study = Study::parse(&text, Path::new("said.toml"), &[]);
            let study = study.unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(study.subject, studied(&request(model)).subject);
        }
    }

    #[test]
    fn unknown_and_repeated_names_are_refused() {
        let with = |factors: &[&str], outputs: &[&str]| {
            let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
            template(&TemplateRequest { factors: owned(factors), outputs: owned(outputs), ..request(ModelKind::Afm) })
        };
        assert_eq!(with(&["lenght"], &[]).unwrap_err().to_string(), "unknown factor `lenght`: did you mean `length`?");
        assert!(matches!(with(&["length", "length"], &[]), Err(Problem::Repeated { what: "factor", .. })));
        assert!(matches!(with(&[], &["force"]), Err(Problem::UnknownName { what: "output", .. })));
    }
}
