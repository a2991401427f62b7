//! A study of a program, and the program to begin with.

use super::own::{bare_or_quoted, output_line, own_factors, own_names, series_of};
use super::{GROUPS, TemplateRequest, design_table, heading};
use crate::model::ModelKind;
use crate::study::file::error::Problem;

/// File name of the program in a new study of a program.
pub const NEW_PROGRAM: &str = "my_model.py";

/// A study of a program, which stands in its comments.
pub(in crate::study::file) fn program_template(request: &TemplateRequest) -> Result<String, Problem> {
    let (factors, outputs) = own_names(request)?;
    let mut text = heading(request);
    let names: Vec<String> = outputs.iter().map(|output| toml::Value::String(output.clone()).to_string()).collect();
    let has_series = outputs.iter().any(|output| series_of(output).is_some());
    if !has_series {
        let names = names.join(", ");
        text.push_str(&format!("outputs = [{names}]    # the columns that the program prints, in its order\n"));
    }
    text.push_str(&format!(
        "\n\
         # The program is started once for each core and kept alive. It reads a header and then a line for each row on its\n\
         # standard input, the row's number and the factor values, and prints a line for each, the number and the outputs;\n\
         # docs/worker-protocol.md has it in full. This one is {NEW_PROGRAM}:\n\
         #\n"
    ));
    for line in python_program(&factors, &outputs).lines() {
        text.push_str(format!("#     {line}").trim_end());
        text.push('\n');
    }
    let stated = match has_series {
        true => outputs.iter().map(|output| output_line(output)).collect(),
        false => format!("# outputs.{} = \"nN\"    # or here, each with its unit\n", bare_or_quoted(&outputs[0])),
    };
    text.push_str(&format!(
        "#\n[command]\nprogram = [\"python3\", \"{NEW_PROGRAM}\"]    # relative to this file; no shell reads it\n\
         {stated}\
         # protocol = \"json-lines\"    # an object for each row instead of a line of CSV\n\
         # workers = 4    # processes at once [default: one for each core]\n\
         # timeout = \"60 s\"    # for a row, after which the program is started anew [default: none]\n\
         # retries = 1    # of a row on which the program died or hung, before it counts as failed\n"
    ));
    text.push_str(&design_table(factors.len()));
    text.push_str(&format!("\n# What the program gets, in this order and in these units.\n{GROUPS}"));
    text.push_str(&own_factors(&factors));
    Ok(text)
}

/// The program of a [new study](fn@crate::study::template) of a program: in Python, of its factors and outputs, each of which is the sum of
/// the factors until somebody writes another; `None` of other models.
///
/// # Errors
/// [`Problem::Repeated`] for a name given twice.
pub fn new_program(request: &TemplateRequest) -> Result<Option<String>, Problem> {
    if request.model != ModelKind::COMMAND {
        return Ok(None);
    }
    let (factors, outputs) = own_names(request)?;
    Ok(Some(python_program(&factors, &outputs)))
}

fn python_program(factors: &[String], outputs: &[String]) -> String {
    // JSON's texts are Python's too.
    let value = |name: &String| format!("x[{}]", serde_json::Value::from(name.as_str()));
    let sum = factors.iter().map(value).collect::<Vec<_>>().join(" + ");
    let value = |output: &String| match series_of(output) {
        Some((_, length)) => format!("*[y for index in range({length})]"),
        None => "y".to_owned(),
    };
    let values = outputs.iter().map(value).collect::<Vec<_>>().join(", ");
    format!(
        "import csv\nimport sys\n\n\
         # One line in for each row: its number and the factor values. One line out: the number and the outputs.\n\
         # Print nothing else, or to sys.stderr.\n\
         for row in csv.DictReader(sys.stdin):\n    number = row.pop(\"id\")\n    \
         x = {{name: float(value) for name, value in row.items()}}\n    \
         y = {sum}\n    print(number, {values}, sep=\",\", flush=True)    # id, {}\n",
        outputs.join(", ")
    )
}
