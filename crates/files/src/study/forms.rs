//! The alternative forms of a study file, converted to one before it is read: `[factors]` becomes a list of
//! `[[factor]]`, and `noise` one more factor. Every value keeps its position in the file.

use std::borrow::Cow;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::context::{Context, Fault};
use super::error::Problem;
use super::sections::{At, FactorSection, StudyFile};

/// Converts `root`, a study file, to the form of `StudyFile`: `noise = "seed"` is `noise.name = "seed"`.
pub(super) fn normalise(context: &Context<'_>, root: &mut DeTable<'_>) -> Result<(), Fault> {
    if let Some((key, _)) = root.get_key_value("factor").filter(|(_, value)| value.get_ref().is_table()) {
        let right = "factors are lines of the table `[factors]`, or tables `[[factor]]`";
        return Err(context.fault(key.span(), Problem::misplaced("factor", right)));
    }
    if let Some(noise) = root.get_mut("noise").filter(|noise| noise.get_ref().is_str()) {
        let key = Spanned::new(noise.span(), Cow::Borrowed("name"));
        let name = Spanned::new(noise.span(), noise.get_ref().clone());
        *noise.get_mut() = DeValue::Table(DeTable::from_iter([(key, name)]));
    }
    Ok(())
}

/// Joins the factors in one list, each with its name: those of `[[factor]]`, or of the lines of `[factors]` in the
/// order of the file; the seed of a stochastic model is the last one.
pub(super) fn join_factors(context: &Context<'_>, file: &mut StudyFile) -> Result<(), Fault> {
    if let Some(factor) = file.factor.iter().find(|factor| factor.get_ref().name.span().is_empty()) {
        return Err(context.fault(factor.span(), Problem::new("missing field `name`")));
    }
    let mut lines: Vec<_> = std::mem::take(&mut file.factors).into_iter().collect();
    lines.sort_by_key(|(name, _)| name.span().start);
    if let (Some((name, _)), false) = (lines.first(), file.factor.is_empty()) {
        let right = "factors are also listed in `[[factor]]`: keep one of the two";
        return Err(context.fault(name.span(), Problem::misplaced("factors", right)));
    }
    for (name, line) in lines {
        let span = line.span();
        let fields = line.into_inner();
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
