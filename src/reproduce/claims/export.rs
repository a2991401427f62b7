//! Claims for programs.

use serde::Serialize;

use super::{Claim, ClaimsError};

#[derive(Serialize)]
struct ClaimsFile<'a> {
    format: &'static str,
    version: u32,
    claims: &'a [Claim],
}

/// The claims as JSON: `format` (`apportion-claims`), `version`, `claims`, each with the fields of [`Claim`], its verdict
/// as `verdict` (`reproduced`, `not-reproduced`, `contradicted`, with `own`).
///
/// # Errors
/// [`ClaimsError::Format`] if it cannot be written, which memory does not refuse.
pub fn claims_json(claims: &[Claim]) -> Result<String, ClaimsError> {
    let file = ClaimsFile { format: "apportion-claims", version: 2, claims };
    let mut text = serde_json::to_string_pretty(&file).map_err(|error| ClaimsError::Format(error.to_string()))?;
    text.push('\n');
    Ok(text)
}
