//! Studies whose factors and outputs are the user's own: of formulas, and of a model outside.

use super::{GROUPS, LAWS, TemplateRequest, design_table, heading, refuse_repeated};
use crate::model::SeriesAxis;
use crate::study::file::error::Problem;

/// A study of formulas to be replaced: each output is the sum of the factors.
pub(in crate::study::file) fn formula_template(request: &TemplateRequest) -> Result<String, Problem> {
    let (factors, outputs) = own_names(request)?;
    let mut text = heading(request);
    text.push_str(
        "\n# Formulas in the factors and the constants, all in SI units; `apportion models expression` lists the\n\
         # functions.\n[expression]\n",
    );
    for output in &outputs {
        let formula = toml::Value::String(factors.join(" + "));
        text.push_str(&format!("outputs.{} = {formula}\n", bare_or_quoted(output)));
    }
    text.push_str("# constants.a = 7    # a number, or a quantity as in \"10 nm\"\n");
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!("\n# The inputs of the formulas.\n{GROUPS}"));
    text.push_str(&own_factors(&factors));
    Ok(text)
}

/// A study of a model outside.
pub(in crate::study::file) fn external_template(request: &TemplateRequest) -> Result<String, Problem> {
    let (factors, outputs) = own_names(request)?;
    let mut text = heading(request);
    text.push_str(
        "\n# The model runs outside: `apportion sample FILE -o design.csv` writes the points, and when it has computed its\n\
         # outputs there, `apportion analyze outputs.csv --design design.csv` reads them. The unit of each output:\n\
         [external]\n",
    );
    outputs.iter().for_each(|output| text.push_str(&output_line(output)));
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!("\n# The inputs of the model.\n{GROUPS}"));
    text.push_str(&own_factors(&factors));
    Ok(text)
}

/// Name and length of a series, which is asked for as `infected[0..60]`; `None` of a single output.
pub(super) fn series_of(output: &str) -> Option<(&str, usize)> {
    let (name, length) = output.strip_suffix(']')?.rsplit_once("[0..")?;
    let length = length.parse().ok().filter(|length| SeriesAxis::even("", "", *length, 0.0, 1.0).is_ok())?;
    (!name.is_empty()).then_some((name, length))
}

/// An output in the table of a model.
pub(super) fn output_line(output: &str) -> String {
    match series_of(output) {
        Some((name, length)) => format!(
            "outputs.{} = {{ length = {length}, axis = \"index\" }}    # a series; also unit, axis_unit, positions\n",
            bare_or_quoted(name)
        ),
        None => format!("outputs.{} = \"1\"\n", bare_or_quoted(output)),
    }
}

/// Names of factors and outputs of a model that has none of its own.
pub(super) fn own_names(request: &TemplateRequest) -> Result<(Vec<String>, Vec<String>), Problem> {
    refuse_repeated("factor", &request.factors)?;
    refuse_repeated("output", &request.outputs)?;
    let named = |names: &[String], default: &[&str]| -> Vec<String> {
        if names.is_empty() { default.iter().map(|&name| name.to_owned()).collect() } else { names.to_vec() }
    };
    Ok((named(&request.factors, &["x1", "x2"]), named(&request.outputs, &["y"])))
}

/// Factors between 0 and 1, to be changed.
pub(super) fn own_factors(factors: &[String]) -> String {
    let factor = |factor: &String| {
        let name = toml::Value::String(factor.clone());
        format!("\n[[factor]]\nname = {name}\n{LAWS}\nmin = 0\nmax = 1\n")
    };
    factors.iter().map(factor).collect()
}

/// A key of TOML, in quotes where it needs them.
pub(super) fn bare_or_quoted(key: &str) -> String {
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    if bare { key.to_owned() } else { toml::Value::String(key.to_owned()).to_string() }
}
