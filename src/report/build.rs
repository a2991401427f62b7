//! From a study and its totals to the result file.

use serde_json::Value;

use super::build_output::output_record;
use super::records::estimate_record;
use super::result::{
    AggregateIndexRecord, AggregateRecord, ConstantRecord, EffortRecord, FactorRecord, OutputRecord, Provenance,
    ResultFile, RungRecord, StoppingRecord, StudyRecord, ValidityRecord,
};
use super::scatter::{FirstRows, Sampled, scatter_record};
use crate::design::Design;
use crate::estimate::{FirstOrder, MomentParts, Scaling, Total};
use crate::model::{Model, Output};
use crate::run::Totals;
use crate::study::Study;
use crate::uncertainty::{AggregateIndices, IntervalMethod, aggregate_indices};

/// What the result says about the run besides its totals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunFacts {
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
}

/// A run of a study that is over.
#[derive(Clone, Copy)]
pub struct FinishedRun<'a> {
    /// The study.
    pub study: &'a Study,
    /// Its model.
    pub model: &'a dyn Model,
    /// The design as it was in the end: a run that grows leaves the study's own behind.
    pub design: &'a Design,
    /// Totals of each replicate.
    pub replicates: &'a [Totals],
    /// Threads and time.
    pub facts: RunFacts,
}

/// The result of a run; `stopping` tells why a growing one ended.
pub fn build_result(run: &FinishedRun<'_>, stopping: Option<StoppingRecord>) -> ResultFile {
    let FinishedRun { study, model, replicates, .. } = *run;
    let mut whole = Totals::none(model);
    replicates.iter().for_each(|totals| whole.add_counts(totals));
    let rows = FirstRows::of(run.design);
    let sampled = Sampled { rows: &rows, space: &study.space, replicates };
    let record = |(number, output): (usize, &Output)| {
        let record = output_record(run, output, number, &whole);
        let indices = record.indices.as_deref();
        let scatter = indices.and_then(|indices| scatter_record(sampled, (number, &output.unit), indices));
        OutputRecord { scatter, ..record }
    };
    let outputs = model.outputs().iter().enumerate().map(record).collect();
    let validity = model
        .flags()
        .iter()
        .zip(&whole.flags)
        .filter(|(flag, runs)| !flag.warns || **runs > 0)
        .map(|(flag, &runs)| ValidityRecord {
            flag: flag.name.to_string(),
            description: flag.description.to_string(),
            runs,
            share: runs as f64 / whole.runs as f64,
        })
        .collect();
    ResultFile {
        format: "apportion-result".to_owned(),
        version: 1,
        study: study_record(study),
        provenance: provenance(run),
        factors: factor_records(study),
        outputs,
        validity,
        effort: effort_record(model, &whole),
        aggregate: aggregate_record(study, model, replicates),
        stopping,
    }
}

fn effort_record(model: &dyn Model, whole: &Totals) -> Option<EffortRecord> {
    let rungs = model.rungs().iter().zip(&whole.effort.rungs).filter(|(_, runs)| **runs > 0);
    let rungs = rungs.map(|(rung, &runs)| RungRecord { rung: (*rung).to_owned(), runs });
    (!model.rungs().is_empty()).then(|| EffortRecord {
        rungs: rungs.collect(),
        evaluations: whole.effort.evaluations,
        largest_error_estimate: whole.effort.largest_error,
    })
}

/// The result as JSON text, ending in a newline.
pub fn result_json(result: &ResultFile) -> String {
    // Serialisation fails on maps without text keys only, of which there is none; a number that is not finite is null.
    serde_json::to_string_pretty(result).expect("a result is plain data") + "\n"
}

fn study_record(study: &Study) -> StudyRecord {
    let constants = study.constants().into_iter().map(|(name, value, unit)| ConstantRecord { name, value, unit });
    StudyRecord {
        name: study.name.clone(),
        title: study.title.clone(),
        model: study.subject.name().to_owned(),
        settings: study.settings().into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        constants: constants.collect(),
        overrides: study.overrides.clone(),
        source: study.source.clone(),
    }
}

fn provenance(run: &FinishedRun<'_>) -> Provenance {
    let FinishedRun { study, design, .. } = *run;
    let (settings, analysis) = (design.settings(), &study.analysis);
    let alone = settings.replicates == 1 && analysis.intervals == IntervalMethod::Replicates;
    Provenance {
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: settings.seed,
        sampler: settings.sampler.name().to_owned(),
        base_samples: settings.base_samples,
        replicates: settings.replicates,
        model_runs: design.rows(),
        threads: run.facts.threads,
        wall_seconds: run.facts.wall_seconds,
        study_sha256: study.sha256.clone(),
        first_order_estimator: FirstOrder::of_rows(design.companions()).source().to_owned(),
        total_estimator: Total::of_rows(design.companions()).source().to_owned(),
        interval: (!alone).then(|| analysis.intervals.words(settings.replicates, analysis.resamples)),
        interval_method: analysis.intervals.name().to_owned(),
        threshold: analysis.threshold,
        mixed_models: Vec::new(),
    }
}

fn factor_records(study: &Study) -> Vec<FactorRecord> {
    let record = |factor: &crate::space::Factor| FactorRecord {
        name: factor.name.clone(),
        unit: factor.unit().to_string(),
        group: factor.group.clone(),
        distribution: serde_json::to_value(factor.distribution()).unwrap_or(Value::Null),
        nominal: factor.nominal,
    };
    study.space.factors().iter().map(record).collect()
}

fn aggregate_record(study: &Study, model: &dyn Model, replicates: &[Totals]) -> Option<AggregateRecord> {
    let outputs = model.outputs();
    if !study.analysis.aggregate || outputs.len() < 2 {
        return None;
    }
    let same_unit = outputs.iter().all(|output| output.unit.compatible(&outputs[0].unit));
    let (scaling, weighting) = if same_unit {
        (Scaling::Plain, "each output counts by its variance (Gamboa et al. 2014)")
    } else {
        (Scaling::Standardised, "each output is divided by its standard deviation first, since their units differ")
    };
    let parts: Vec<Vec<MomentParts>> = (0..outputs.len())
        .map(|number| replicates.iter().map(|totals| totals.outputs[number].moments.clone()).collect())
        .collect();
    let parts: Vec<&[MomentParts]> = parts.iter().map(Vec::as_slice).collect();
    let aggregate = aggregate_indices(&parts, scaling, study.analysis.intervals);
    let record = |(number, factor): (usize, &crate::space::Factor), all: &AggregateIndices| AggregateIndexRecord {
        factor: factor.name.clone(),
        first_order: estimate_record(all.first_order[number]),
        total: estimate_record(all.total[number]),
    };
    let factors = || study.space.factors().iter().enumerate();
    Some(AggregateRecord {
        outputs: outputs.iter().map(|output| output.name.to_string()).collect(),
        weighting: weighting.to_owned(),
        indices: aggregate.as_ref().ok().map(|all| factors().map(|factor| record(factor, all)).collect()),
        reason: aggregate.err().map(|undefined| undefined.to_string()),
    })
}
