//! The alternative forms of a study file, converted to one before it is read: `[factors]` becomes a list of
//! `[[factor]]`, and `noise` one more factor. Every value keeps its position in the file. Obsolete forms are refused.

use std::borrow::Cow;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::context::{Context, Fault};
use super::error::Problem;
use super::sections::{At, FactorSection, LineSection, StudyFile};

/// Converts `root`, a study file, to the form of `StudyFile`: `noise = "seed"` is `noise.name = "seed"`.
pub(super) fn normalise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    refuse_old_forms(context, root)?;
    if let Some(noise) = root.get_mut("noise").filter(|noise| noise.get_ref().is_str()) {
        let key = Spanned::new(noise.span(), Cow::Borrowed("name"));
        let name = Spanned::new(noise.span(), noise.get_ref().clone());
        *noise.get_mut() = DeValue::Table(DeTable::from_iter([(key, name)]));
    }
    Ok(())
}

/// Refuses obsolete forms of factors and outputs.
fn refuse_old_forms(context: &Context<'_>, root: &DeTable<'_>) -> Result<(), Fault> {
    let factors = "[factors]\nx1 = { min = 0, max = 1 }\nx2 = { min = 0, max = 1 }";
    let mut old = Vec::new();
    match (root.get_key_value("factor"), root.get_key_value("factors")) {
        (Some((key, value)), _) if value.get_ref().is_table() => old.push((key, "[factor]".to_owned(), factors)),
        (_, Some((key, value))) if value.get_ref().is_array() => {
            old.push((key, "a list `factors`".to_owned(), factors))
        }
        _ => (),
    }
    for section in ["expression", "command", "external"] {
        let table = root.get(section).and_then(|value| value.get_ref().as_table());
        if let Some((key, _)) = table.and_then(|table| table.get_key_value("outputs")) {
            let lines = "outputs.y = ...\nabove the first table of the file";
            old.push((key, format!("outputs in [{section}]"), lines));
        }
    }
    let Some((key, form, lines)) = old.into_iter().next() else { return Ok(()) };
    let message = format!("{form}: this form of factors and outputs is no longer read");
    Err(context.fault(key.span(), Problem::with_help(message, format!("write\n{lines}"))))
}

pub(super) fn is_bare(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c))
}

/// Joins the factors in one list, each with its name: those of `[[factor]]`, or of the lines of `[factors]` in the
/// order of the file; the seed of a stochastic model is the last one.
pub(super) fn join_factors(context: &Context<'_>, file: &mut StudyFile) -> Result<(), Fault> {
    let mut lines: Vec<_> = std::mem::take(&mut file.factors).into_iter().collect();
    lines.sort_by_key(|(name, _)| name.span().start);
    if let (Some((name, _)), false) = (lines.first(), file.factor.is_empty()) {
        let right = "factors are also listed in `[[factor]]`: keep one of the two";
        return Err(context.fault(name.span(), Problem::misplaced("factors", right)));
    }
    for (name, line) in lines {
        let span = line.span();
        let LineSection(fields) = line.into_inner();
        if !fields.name.span().is_empty() {
            let right = "the name of this factor is the key before its table";
            return Err(context.fault(fields.name.span(), Problem::misplaced("name", right)));
        }
        file.factor.push(At::new(span, FactorSection { name, ..fields }));
    }
    if let Some(noise) = &file.noise {
        let at_noise = |text: &str| At::new(noise.span(), text.to_owned());
        let name = noise.get_ref().name.clone().unwrap_or_else(|| at_noise("seed"));
        let fields = FactorSection { name, distribution: Some(at_noise("seed")), ..FactorSection::default() };
        file.factor.push(At::new(noise.span(), fields));
    }
    Ok(())
}
