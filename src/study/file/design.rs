//! The `[design]` table with what `[analysis]` asks of it: how many runs, of which rows, until when.

use super::context::{Context, Fault, wrong};
use super::error::Problem;
use super::sections::{At, DesignSection, StudyFile};
use super::{analysis, context::choice, fidelity, noise};
use crate::design::{Design, DesignError, DesignSettings, Sampler};
use crate::space::Space;
use crate::study::options::{MOST_OUTPUTS_OF_MEASURES, rows, split_design};
use crate::study::{AnalysisOptions, SurrogateChoice, Target};
use crate::surrogate::FEWEST_NETS;

/// The design with what is asked of it, and notes on what was read otherwise than it was written.
pub(super) struct Plan {
    pub design: Design,
    pub analysis: AnalysisOptions,
    pub target: Target,
    pub notes: Vec<String>,
}

/// The plan that `[design]` and `[analysis]` of `file` make for factors of `space` and that many outputs.
pub(super) fn plan(context: &Context<'_>, file: &StudyFile, space: &Space, outputs: usize) -> Result<Plan, Fault> {
    let section = &file.design;
    let defaults = DesignSettings::default();
    let sampler = match &section.sampler {
        None => defaults.sampler,
        Some(name) => choice(context, name, "sampler", &Sampler::ALL, Sampler::name)?,
    };
    let mut analysis = analysis::analysis(context, &file.analysis, sampler, space)?;
    if let Some(measures) = file.analysis.measures.as_ref().filter(|_| outputs > MOST_OUTPUTS_OF_MEASURES) {
        let expected = format!("none of more than {MOST_OUTPUTS_OF_MEASURES} outputs");
        return Err(context.fault(measures.span(), wrong("measures", &expected, format!("some of {outputs} outputs"))));
    }
    for subset in noise::subsets_of_mean(file, space) {
        if !analysis.subsets.contains(&subset) {
            analysis.subsets.push(subset);
        }
    }
    let target = analysis::target(context, section, sampler)?;
    let target = fidelity::accuracy(context, file, target, sampler)?;
    let or = |value: &Option<At<u64>>, default| value.as_ref().map_or(default, |value| *value.get_ref());
    let replicates = or(&section.replicates, analysis.intervals.default_replicates());
    let split = sizes_within_budget(context, section, &analysis, space, sampler, replicates)?;
    let (base_samples, plain_rows) =
        split.unwrap_or_else(|| (or(&section.base_samples, target.base_samples(replicates)), 0));
    let plain_rows = section.plain_rows.as_ref().map_or(plain_rows, |rows| *rows.get_ref());
    let seed = or(&section.seed, defaults.seed);
    let settings = target.first_stage(DesignSettings { sampler, base_samples, replicates, seed });
    let mut notes = Vec::new();
    if settings.base_samples != base_samples {
        notes.push(format!(
            "a run that grows by doubling starts with a power of two in each replicate: base_samples = {} instead of {base_samples}",
            settings.base_samples
        ));
    }
    let asked = settings.base_samples;
    let design = Design::new(settings, space.factors().len(), rows(&analysis, space, plain_rows)).map_err(|error| {
        let span = match error {
            DesignError::NoReplicates => section.replicates.as_ref().map(At::span),
            DesignError::TooManyPlainRows { .. } => section.plain_rows.as_ref().map(At::span),
            DesignError::TooManyPairs { .. } => file.analysis.second_order.as_ref().map(At::span),
            _ => section.base_samples.as_ref().or(section.replicates.as_ref()).map(At::span),
        };
        context.fault(span.unwrap_or(0..0), error.into())
    })?;
    let in_force = design.settings();
    if in_force.base_samples != asked {
        notes.push(format!(
            "base_samples = {asked} is not a multiple of {} replicates: {} are used",
            in_force.replicates, in_force.base_samples
        ));
    }
    let begun = design.settings().base_samples;
    let runs_per_point = design.rows_per_point();
    let design = target.within_max_runs(design).map_err(|least| {
        let problem = Problem::WrongType {
            key: "max_runs".to_owned(),
            expected: format!(
                "{least} or more (2 base points in each of {replicates} replicate{}, {runs_per_point} runs each)",
                if replicates == 1 { "" } else { "s" },
            ),
            found: target.max_runs.unwrap_or_default().to_string(),
        };
        context.fault(section.max_runs.as_ref().map_or(0..0, At::span), problem)
    })?;
    if section.base_samples.is_some() && design.settings().base_samples < begun {
        notes.push(format!(
            "the run starts with base_samples = {} instead of {begun}, which would take more than max_runs",
            design.settings().base_samples
        ));
    }
    if analysis.surrogate == SurrogateChoice::On && replicates < FEWEST_NETS as u64 {
        notes.push(format!("`surrogate` has no effect with fewer than {FEWEST_NETS} replicates"));
    }
    if analysis.aggregate && outputs < 2 {
        notes.push("`aggregate` has no effect with a single output".to_owned());
    }
    Ok(Plan { design, analysis, target, notes })
}

/// Base samples and plain rows by `budget_runs`, if the section has it; and whether plain rows are of any use here.
fn sizes_within_budget(
    context: &Context<'_>,
    section: &DesignSection,
    analysis: &AnalysisOptions,
    space: &Space,
    sampler: Sampler,
    replicates: u64,
) -> Result<Option<(u64, u32)>, Fault> {
    let wrong = |key: &str, expected: &str, found: String| Problem::WrongType {
        key: key.to_owned(),
        expected: expected.to_owned(),
        found,
    };
    let plain_rows =
        section.plain_rows.as_ref().filter(|rows| *rows.get_ref() > 0).map(|rows| ("plain_rows", rows.span()));
    let Some((key, span)) = section.budget_runs.as_ref().map(|runs| ("budget_runs", runs.span())).or(plain_rows) else {
        return Ok(None);
    };
    if let Some(why) = analysis.refuses_plain_rows(sampler, replicates) {
        let expected = "beside surrogates, which alone learn from plain rows";
        return Err(context.fault(span, wrong(key, expected, format!("beside {why}"))));
    }
    let Some(runs) = &section.budget_runs else { return Ok(None) };
    let others = [
        ("base_samples", section.base_samples.is_some()),
        ("plain_rows", section.plain_rows.is_some()),
        ("target", section.target.is_some()),
        ("budget", section.budget.is_some()),
        ("max_runs", section.max_runs.is_some()),
    ];
    if let Some((other, _)) = others.into_iter().find(|(_, is_there)| *is_there) {
        let expected = "alone: it decides the size of the design";
        return Err(context.fault(runs.span(), wrong(key, expected, format!("beside `{other}`"))));
    }
    // What is wrong with the rows is told of when the design is made.
    let split = split_design(*runs.get_ref(), analysis, space, sampler, replicates).transpose();
    split.map_err(|least| {
        let expected = format!(
            "{least} or more, the runs of 2 base samples in each of {replicates} replicates (fewer runs tell most as random \
             points: `apportion sample STUDY --random {}`, then `apportion given-data`)",
            runs.get_ref().max(&10)
        );
        context.fault(runs.span(), wrong(key, &expected, runs.get_ref().to_string()))
    })
}
