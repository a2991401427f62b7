//! Conversion of the totals of a run to its result.

use crate::model::Counter;
use std::path::Path;

use rayon::prelude::*;

use super::finished_run::{FinishedRun, LowFidelityTotals};
use super::measures::MeasuredRows;
use super::output::{OutputRows, output_result};
use super::scatter::rows_of_scatter;
use super::series::{series, single_outputs, together, together_records};
use super::setup::{factor_record, study_record};
use super::surrogates::Corrections;
use crate::effect::Effect;
use crate::estimate::{FirstOrder, Scaling, Total};
use crate::model::Model;
use crate::result::{
    AggregateRecord, EffortRecord, LowFidelityRuns, Provenance, RungRecord, StopReason, StoppingRecord, StudyResult,
    ValidityRecord,
};
use crate::run::Totals;
use crate::study::Study;
use crate::uncertainty::IntervalMethod;

/// The source of the indices of plain rows.
const SURROGATE: &str = "polynomial chaos (Sudret 2008)";

/// Returns the result of a run; `stopped` is why a growing one ended.
pub(crate) fn result(run: &FinishedRun<'_>, stopped: Option<StopReason>) -> StudyResult {
    let FinishedRun { study, model, design, replicates, low_fidelity, .. } = *run;
    let mut counts = Totals::none(model);
    replicates.iter().for_each(|totals| counts.add_counts(totals));
    let corrected = Corrections::new(run);
    let series = series(run, &counts, &corrected);
    let wanted = &study.analysis.measures;
    let rows = OutputRows {
        scatter: study.analysis.pictures.then(|| rows_of_scatter(design)),
        measured: (!wanted.is_empty()).then(|| MeasuredRows::new(design, &study.space)),
    };
    let outputs = model.outputs().par_iter().enumerate();
    let factors = study.space.factors().iter().filter(|factor| !factor.distribution().is_noise());
    StudyResult {
        format: "apportion-result".to_owned(),
        version: 1,
        study: study_record(study),
        provenance: provenance(run),
        indices_of: study.analysis.indices_of,
        factors: factors.map(|factor| factor_record(study, factor)).collect(),
        outputs: outputs
            .map(|(number, output)| output_result(run, output, number, &counts, &corrected, &rows))
            .collect(),
        validity: ValidityRecord::of_flags(model.flags().iter().zip(counts.flags.iter().copied()), design.rows()),
        effort: effort(model, &counts),
        aggregate: aggregate(run, &counts, &corrected),
        series,
        stopping: stopped.map(|reason| stopping(study, reason)),
        spending: None,
        low_fidelity: low_fidelity.iter().map(low_runs).collect(),
    }
}

fn low_runs(low: &LowFidelityTotals<'_>) -> LowFidelityRuns {
    LowFidelityRuns {
        name: low.name.to_owned(),
        shared_runs: low.shared.iter().map(|totals| totals.runs).sum(),
        own_base_samples: low.design.settings().base_samples,
        own_runs: low.own.iter().map(|totals| totals.runs).sum(),
    }
}

fn stopping(study: &Study, reason: StopReason) -> StoppingRecord {
    let target = study.target;
    StoppingRecord {
        reason,
        target_met: target.accuracy.map(|_| matches!(reason, StopReason::TargetMet { .. })),
        target_half_width: target.accuracy,
        budget_seconds: target.max_time,
        max_runs: target.max_runs,
    }
}

fn provenance(run: &FinishedRun<'_>) -> Provenance {
    let FinishedRun { study, design, .. } = *run;
    let options = &study.analysis;
    let settings = design.settings();
    let alone = settings.replicates == 1 && options.intervals == IntervalMethod::Replicates;
    let sources = match design.is_plain() {
        true => [SURROGATE; 2],
        false => [FirstOrder::default_for(design.has_ba()).source(), Total::default_for(design.has_ba()).source()],
    };
    let [first_order_estimator, total_estimator] = sources.map(str::to_owned);
    Provenance {
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: settings.seed,
        sampler: settings.sampler,
        base_samples: settings.base_samples,
        replicates: settings.replicates,
        plain: design.is_plain(),
        model_runs: design.rows(),
        threads: run.threads,
        wall_seconds: run.wall_seconds,
        study_sha256: study.source.sha256.clone(),
        first_order_estimator,
        total_estimator,
        interval_method: (!alone && !design.is_plain()).then_some(options.intervals),
        resamples: (options.intervals == IntervalMethod::Percentile).then_some(options.resamples),
        threshold: options.threshold,
        model_files: study.subject.files().iter().map(|file| name_of(file)).collect(),
    }
}

fn name_of(file: &Path) -> String {
    file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Aggregates all outputs if the study requests it, otherwise those that belong to no series, if there are many.
fn aggregate(run: &FinishedRun<'_>, counts: &Totals, corrected: &Corrections) -> Option<AggregateRecord> {
    let FinishedRun { study, model, .. } = *run;
    let (outputs, single) = (model.outputs(), single_outputs(model));
    let places = if study.analysis.aggregate { (0..outputs.len()).collect() } else { single };
    if places.len() < 2 || !study.analysis.aggregate && places.len() < StudyResult::MIN_OUTPUTS_TOGETHER {
        return None;
    }
    let same_unit = places.iter().all(|&place| outputs[place].unit.compatible(&outputs[places[0]].unit));
    let weighting = if same_unit { Scaling::Plain } else { Scaling::Standardised };
    let names = places.iter().map(|&place| outputs[place].name.to_string()).collect();
    let indices = together(run, counts, corrected, places.into_iter(), weighting);
    Some(AggregateRecord {
        outputs: names,
        weighting,
        indices: indices.as_ref().ok().map(|all| together_records(study, all, Effect::is_factor)),
        noise: indices.as_ref().ok().and_then(|all| together_records(study, all, |of| of == Effect::Noise).pop()),
        reason: indices.err(),
    })
}

/// Returns the effort of a model with a ladder of fidelities, by its counters.
fn effort(model: &dyn Model, counts: &Totals) -> Option<EffortRecord> {
    let counts = || model.counters().iter().zip(counts.counts.values());
    let value = |name| counts().find(|(counter, _)| counter.name == name).map_or(0.0, |(_, value)| value);
    let rungs = counts().filter(|(_, runs)| *runs > 0.0).filter_map(|(counter, runs)| {
        Some(RungRecord { rung: counter.name.strip_prefix(Counter::RUNGS)?.to_owned(), runs: runs as u64 })
    });
    (!model.counters().is_empty()).then(|| EffortRecord {
        rungs: rungs.collect(),
        evaluations: value(Counter::EVALUATIONS) as u64,
        largest_error_estimate: value(Counter::LARGEST_ERROR),
    })
}
