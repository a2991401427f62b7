//! A study to begin with: a file that runs as it is, with comments that teach.

mod of_model;
mod own;
mod program;

pub use program::{NEW_PROGRAM, new_program};

use super::context::unknown_name;
use super::error::Problem;
use crate::design::DesignSettings;
use crate::model::{Input, ModelKind, Output};
use crate::text::capitalised;
use of_model::{factor_table, outputs_line};

pub(super) use of_model::{afm_table, function_table};
pub(super) use own::{external_template, formula_template};
pub(super) use program::program_template;

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

/// A remark above the factors.
const GROUPS: &str = "# Factors that name the same `group` also get joint indices.\n";
/// A remark in the first factor.
const LAWS: &str = "# uniform; or normal, log-normal, triangular, beta, categorical, ...: see docs/factors.md";

/// A study of a model whose inputs and outputs are its own; `table` writes what it says of its choices.
pub(super) fn model_template(
    request: &TemplateRequest,
    table: fn(ModelKind, &[Input], &[&Input]) -> String,
) -> Result<String, Problem> {
    let model = request.model;
    let (inputs, known_outputs) = (model.inputs(), model.outputs());
    let factors = factors(request, &inputs)?;
    let outputs = outputs(request, &known_outputs)?;
    let mut text = heading(request);
    text.push_str(&outputs_line(&outputs, &known_outputs));
    text.push_str(&table(model, &inputs, &factors));
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
    let title = |text: String| format!("title = {}", toml::Value::String(text));
    let title = match &request.title {
        Some(text) => title(text.clone()),
        // What the model is says nothing of a study whose model is the user's own.
        None if model.is_users_own() => {
            format!("# {}    # for the page and the charts", title("What is asked".to_owned()))
        }
        None => title(capitalised(model.description)),
    };
    format!(
        "# A study of apportion: which inputs of a model decide its output, and by how many percent.\n\
         # `apportion check FILE` explains it and tells what it will cost, `apportion run FILE` runs it,\n\
         # `apportion models {}` lists everything that can stand here.\n\n\
         {title}\nmodel = \"{}\"\n",
        model.name, model.name
    )
}

fn factors<'a>(request: &TemplateRequest, inputs: &'a [Input]) -> Result<Vec<&'a Input>, Problem> {
    let find = |name: &str| {
        let found = inputs.iter().find(|input| input.name == name);
        found.ok_or_else(|| unknown_name("factor", name, inputs.iter().map(|input| input.name.as_str())))
    };
    refuse_repeated("factor", &request.factors)?;
    if !request.factors.is_empty() {
        return request.factors.iter().map(|name| find(name)).collect();
    }
    match request.model.main_inputs {
        [] => Ok(inputs.iter().collect()),
        main => main.iter().map(|name| find(name)).collect(),
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
         # budget_runs = 300    # instead of base_samples where runs take minutes: so many in all, split for surrogates\n\
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
