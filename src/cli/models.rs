//! `apportion models`: what can be studied.

use apportion::model::ModelKind;
use apportion::report::{significant, table};

use super::{Failure, print};

pub fn models() -> Result<(), Failure> {
    let mut text = String::new();
    for kind in ModelKind::all() {
        text.push_str(&format!("{}: {}\n\n", kind.name(), kind.description()));
        for (key, names) in kind.choices() {
            text.push_str(&format!("  {key}: {}\n", names.join(", ")));
        }
        let mut inputs = table(&["factor", "symbol", "nominal", "unit", "must be", "meaning"], &[0, 1, 3, 4, 5]);
        for input in kind.inputs() {
            let domain = input.domain.map_or_else(|| "any number".to_owned(), |domain| domain.to_string());
            let unit = input.unit.to_string();
            inputs.add_row([input.name, input.symbol, &significant(input.nominal), &unit, &domain, &input.description]);
        }
        text.push_str(&format!("{inputs}\n"));
        let mut outputs = table(&["output", "unit", "meaning"], &[0, 1, 2]);
        for output in kind.outputs() {
            outputs.add_row([output.name, &output.unit.to_string(), output.description]);
        }
        text.push_str(&format!("{outputs}\n\n"));
    }
    print(&text)
}
