//! The table of distributions, from which the package makes their constructors.

use apportion::space::distribution::{KeyKind, Kind};
use pyo3::prelude::*;

/// A key, the kind of its value, what it says, whether it may be left out, and what it is then.
type Parameter = (&'static str, &'static str, &'static str, bool, Option<f64>);

/// (name, summary, parameters) of every family.
#[pyfunction]
pub fn distributions() -> Vec<(&'static str, &'static str, Vec<Parameter>)> {
    Kind::all().map(|kind| (kind.name(), kind.summary(), parameters(kind))).collect()
}

fn parameters(kind: Kind) -> Vec<Parameter> {
    let parameter = |argument: apportion::space::distribution::Argument| {
        let value = match argument.key.kind {
            KeyKind::Number => "number",
            KeyKind::Texts => "texts",
            _ => "numbers",
        };
        (argument.key.name, value, argument.key.description, argument.is_optional, argument.default)
    };
    kind.arguments().map(parameter).collect()
}
