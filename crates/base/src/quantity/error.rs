//! Errors in units.

/// Why a unit or a quantity could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnitError {
    /// A symbol that is not a unit.
    #[error(
        "unit \"{unit}\": \"{symbol}\" is not understood{}; units look like {EXAMPLES}; inputs and outputs of your own model may have none: their numbers are then passed unchanged",
        hint(nearest)
    )]
    Unknown {
        /// The unit as typed.
        unit: String,
        /// The part of it that is not a unit.
        symbol: String,
        /// The most similar known symbol, if there is one.
        nearest: Option<String>,
    },
    /// A malformed unit.
    #[error("unit \"{unit}\": {reason}; units look like {EXAMPLES}")]
    Malformed {
        /// The unit as typed.
        unit: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A quantity that does not begin with a finite number.
    #[error("\"{text}\" is not a quantity: it must be a finite number and a unit, such as \"0.7 deg\" or \"225 um\"")]
    NotANumber {
        /// The quantity as typed.
        text: String,
    },
}

const EXAMPLES: &str = r#""um", "nm/s", "GPa", "mJ/m2", "nN", "N/m", "N s/m", "kg/m3", "V", "K", "degC", "deg", "ms", "h", "%" and "1" for a pure number"#;

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|symbol| format!(", did you mean \"{symbol}\"?")).unwrap_or_default()
}
