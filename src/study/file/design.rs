//! The `[design]` table with what `[analysis]` asks of it: how many runs, of which rows, until when.

use super::context::{Context, Fault};
use super::error::Problem;
use super::sections::{At, DesignSection, StudyFile};
use super::{analysis, context::choice};
use crate::design::{Design, DesignError, DesignSettings, Sampler};
use crate::space::Space;
use crate::study::options::rows;
use crate::study::{AnalysisOptions, Stopping};

/// The design with what is asked of it, and notes on what was read otherwise than it was written.
pub(super) struct Plan {
    pub design: Design,
    pub analysis: AnalysisOptions,
    pub stopping: Stopping,
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
    let analysis = analysis::analysis(context, &file.analysis, sampler, space)?;
    let stopping = analysis::stopping(context, section, sampler)?;
    let or = |value: &Option<At<u64>>, default| value.as_ref().map_or(default, |value| *value.get_ref());
    let replicates = or(&section.replicates, analysis.intervals.default_replicates());
    let unsaid = match stopping {
        // A model so slow that its user thinks in time may not have time for more.
        Stopping { budget: Some(_), .. } => FIRST_POINTS.saturating_mul(replicates),
        stopping if stopping.grows() => FIRST_STAGE,
        _ => defaults.base_samples,
    };
    let settings = DesignSettings {
        sampler,
        base_samples: or(&section.base_samples, unsaid),
        replicates,
        seed: or(&section.seed, defaults.seed),
    };
    let mut notes = Vec::new();
    let settings = if stopping.grows() { whole_nets(settings, &mut notes) } else { settings };
    let asked = settings.base_samples;
    let design = Design::new(settings, space.factors().len(), rows(&analysis, space)).map_err(|error| {
        let span = match error {
            DesignError::NoReplicates => section.replicates.as_ref().map(At::span),
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
    let design = within_max_runs(context, section, design)?;
    if section.base_samples.is_some() && design.settings().base_samples < begun {
        notes.push(format!(
            "the run starts with base_samples = {} instead of {begun}, which would take more than max_runs",
            design.settings().base_samples
        ));
    }
    if analysis.aggregate && outputs < 2 {
        notes.push("`aggregate` has no effect with a single output".to_owned());
    }
    Ok(Plan { design, analysis, stopping, notes })
}

/// Base samples with which a growing run starts.
const FIRST_STAGE: u64 = 1 << 10;

/// Base points of each replicate with which one starts that has a budget of time.
const FIRST_POINTS: u64 = 64;

/// The design halved until it takes no more than `max_runs`.
fn within_max_runs(context: &Context<'_>, section: &DesignSection, mut design: Design) -> Result<Design, Fault> {
    let Some(max_runs) = &section.max_runs else { return Ok(design) };
    while design.rows() > *max_runs.get_ref() {
        match design.with_points(design.points_per_replicate() / 2) {
            Ok(shorter) => design = shorter,
            Err(_) => {
                let replicates = design.settings().replicates;
                let problem = Problem::WrongType {
                    key: "max_runs".to_owned(),
                    expected: format!(
                        "{} or more (2 base points in each of {replicates} replicate{}, {} runs each)",
                        design.rows(),
                        if replicates == 1 { "" } else { "s" },
                        design.rows_per_point()
                    ),
                    found: max_runs.get_ref().to_string(),
                };
                return Err(context.fault(max_runs.span(), problem));
            }
        }
    }
    Ok(design)
}

/// A growing run goes from one power of two to the next.
fn whole_nets(settings: DesignSettings, notes: &mut Vec<String>) -> DesignSettings {
    let DesignSettings { base_samples, replicates, .. } = settings;
    let Some(points) = base_samples.div_ceil(replicates.max(1)).checked_next_power_of_two() else { return settings };
    let Some(rounded) = points.checked_mul(replicates) else { return settings };
    if rounded != base_samples && base_samples >= 2 * replicates {
        notes.push(format!(
            "a run that grows by doubling starts with a power of two in each replicate: base_samples = {rounded} instead of {base_samples}"
        ));
        return DesignSettings { base_samples: rounded, ..settings };
    }
    settings
}
