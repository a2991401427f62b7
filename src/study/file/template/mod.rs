//! A study to begin with: a file that runs as it is, with comments that teach.

mod of_model;
mod own;
mod program;

pub use program::{NEW_PROGRAM, new_program};

use super::context::unknown_name;
use super::error::Problem;
use crate::design::DesignSettings;
use crate::model::{Input, ModelKind, Output};
use crate::words::capitalised;
use of_model::{afm_table, factor_table, function_table, outputs_line};
use own::{external_template, formula_template};
use program::program_template;

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
/// assert_eq!(study.space().factors()[1].name, "velocity");
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
    // What the model is says nothing of a study whose model is the user's own.
    let is_own = matches!(model, ModelKind::Expression | ModelKind::Command | ModelKind::External);
    let title = |text: String| format!("title = {}", toml::Value::String(text));
    let title = match &request.title {
        Some(text) => title(text.clone()),
        None if is_own => format!("# {}    # for the page and the charts", title("What is asked".to_owned())),
        None => title(capitalised(model.description())),
    };
    format!(
        "# A study of apportion: which inputs of a model decide its output, and by how many percent.\n\
         # `apportion check FILE` explains it and tells what it will cost, `apportion run FILE` runs it,\n\
         # `apportion models {}` lists everything that can stand here.\n\n\
         {title}\nmodel = \"{}\"\n",
        model.name(),
        model.name()
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

#[cfg(test)]
mod tests;
