//! Names and units of factors as figures write them.

use apportion::afm::Parameter;

/// A unit as a chart prints it.
pub(super) fn printed(unit: &str) -> &str {
    match unit {
        "um" => "µm",
        "J/m2" => "J/m²",
        other => other,
    }
}

/// A unit as a part of a column's name.
pub(super) fn column(unit: &str) -> String {
    unit.replace('/', "_per_")
}

/// A parameter's symbol.
pub(super) fn symbol(parameter: &Parameter) -> &'static str {
    if parameter.symbol == "omega" { "ω" } else { parameter.symbol }
}
