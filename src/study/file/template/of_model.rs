//! What a study of a model in this program says of it: its choices, its inputs and outputs.

use crate::afm::Options;
use crate::model::{Input, ModelKind, Output};
use crate::study::file::units::with_unit;

/// How far a factor reaches to both sides of its nominal value where the model does not say how it varies.
const REACH: f64 = 0.1;

pub(super) fn outputs_line(outputs: &[&Output], known: &[Output]) -> String {
    let quoted: Vec<String> = outputs.iter().map(|output| format!("\"{}\"", output.name)).collect();
    let mut text = format!("outputs = [{}]\n", quoted.join(", "));
    let others: Vec<&str> = known.iter().filter(|o| !outputs.contains(o)).map(|output| &*output.name).collect();
    if !others.is_empty() {
        text.push_str(&format!("# also: {}\n", others.join(", ")));
    }
    text
}

/// The choices in force, and how to fix a constant.
pub(in crate::study::file) fn afm_table(model: ModelKind, inputs: &[Input], factors: &[&Input]) -> String {
    let options = Options::default();
    let in_force = |key: &str| match key {
        "friction" => Some(options.friction.name()),
        "contact" => Some(options.contact.name()),
        "fidelity" => Some(options.fidelity.name()),
        _ => None,
    };
    let mut text = "\n# The physics. Each choice stands as it would be if it were left out.\n[afm]\n".to_owned();
    for (key, names) in model.choices() {
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
pub(in crate::study::file) fn function_table(model: ModelKind, _: &[Input], _: &[&Input]) -> String {
    let Some(answer) = model.known else { return String::new() };
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

/// A factor; the `first` one with more words.
pub(super) fn factor_table(input: &Input, first: bool) -> String {
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
