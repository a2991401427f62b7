//! From a study and its totals to the result file.

use serde_json::{Map, Value};

use super::result::{
    ConstantRecord, EffectRecord, EffortRecord, EstimateRecord, FactorRecord, FailureRecord, GroupRecord, IndexRecord,
    IntervalRecord, OutputRecord, Provenance, ResultFile, RungRecord, StudyRecord, ValidityRecord,
};
use super::warnings;
use crate::estimate::Moments;
use crate::model::{Model, Output};
use crate::run::{OutputTotals, Tally, Totals};
use crate::study::Study;
use crate::uncertainty::{
    EffectEstimates, Estimate, Interval, ReplicatedIndices, replicated_indices, replicated_moments,
};

/// What the result says about the run besides its totals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunFacts {
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
}

/// The result of `study`, whose `model` left `replicates`.
pub fn build_result(study: &Study, model: &dyn Model, replicates: &[Totals], facts: RunFacts) -> ResultFile {
    let mut whole = replicates[0].clone();
    for totals in &replicates[1..] {
        whole.merge(totals);
    }
    let outputs = model
        .outputs()
        .iter()
        .enumerate()
        .map(|(number, output)| {
            let moments: Vec<Moments> = replicates.iter().map(|t| t.outputs[number].moments.clone()).collect();
            output_record(study, output, &whole.outputs[number], &moments)
        })
        .collect();
    let validity = model
        .flags()
        .iter()
        .zip(&whole.flags)
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
        provenance: provenance(study, facts),
        factors: factor_records(study),
        outputs,
        validity,
        effort: effort_record(model, &whole),
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
        model: study.subject.kind().name().to_owned(),
        settings: study.settings().into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        constants: constants.collect(),
        overrides: study.overrides.clone(),
        source: study.source.clone(),
    }
}

fn provenance(study: &Study, facts: RunFacts) -> Provenance {
    let settings = study.design.settings();
    let interval = (settings.replicates > 1).then(|| {
        format!(
            "95 % t-interval (delete-one jackknife) from {} independent randomisations of the design; the estimate \
             rests on all of them together",
            settings.replicates
        )
    });
    Provenance {
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: settings.seed,
        sampler: settings.sampler.name().to_owned(),
        base_samples: settings.base_samples,
        replicates: settings.replicates,
        model_runs: study.design.rows(),
        threads: facts.threads,
        wall_seconds: facts.wall_seconds,
        study_sha256: study.sha256.clone(),
        first_order_estimator: "Saltelli et al. 2010 (b), centred".to_owned(),
        total_estimator: "Jansen 1999".to_owned(),
        interval,
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

fn output_record(study: &Study, output: &Output, totals: &OutputTotals, replicates: &[Moments]) -> OutputRecord {
    let unit = &output.unit;
    let moments = replicated_moments(replicates);
    let squared = |x: f64| unit.from_si(unit.from_si(x));
    let in_unit = |x: f64| unit.from_si(x);
    let indices = replicated_indices(replicates, study.design.factors());
    let mut record = OutputRecord {
        name: output.name.to_string(),
        unit: unit.to_string(),
        mean: moments.map(|m| in_unit(m.mean.estimate)),
        variance: moments.map(|m| squared(m.variance.estimate)),
        mean_interval: moments.and_then(|m| interval_record(m.mean.interval, &in_unit)),
        variance_interval: moments.and_then(|m| interval_record(m.variance.interval, &squared)),
        runs_ok: study.design.rows() - totals.runs_failed,
        runs_failed: totals.runs_failed,
        base_points_used: totals.moments.count(),
        failures: totals.failures.iter().map(|(failure, tally)| failure_record(study, failure, *tally)).collect(),
        sum_first_order: None,
        sum_total: None,
        indices: None,
        groups: None,
        reason: None,
        warnings: Vec::new(),
    };
    record.warnings = warnings::of_runs(study, &record);
    match indices {
        Err(undefined) => record.reason = Some(undefined.to_string()),
        Ok(indices) => {
            record.warnings.extend(warnings::of_indices(study, &indices));
            add_indices(&mut record, study, &indices);
        }
    }
    record
}

fn add_indices(record: &mut OutputRecord, study: &Study, indices: &ReplicatedIndices) {
    let factors = study.space.factors();
    record.sum_first_order = Some(estimate_record(indices.sum_first_order));
    record.sum_total = Some(estimate_record(indices.sum_total));
    let of_factor = |(factor, effect): (&crate::space::Factor, &EffectEstimates)| IndexRecord {
        factor: factor.name.clone(),
        effect: effect_record(effect),
    };
    record.indices = Some(factors.iter().zip(&indices.factors).map(of_factor).collect());
    let of_group = |(group, effect): (crate::space::Group, &EffectEstimates)| GroupRecord {
        factors: group.factors.iter().map(|&number| factors[number].name.clone()).collect(),
        group: group.name,
        effect: effect_record(effect),
    };
    record.groups = Some(study.space.groups().into_iter().zip(&indices.groups).map(of_group).collect());
}

fn effect_record(effect: &EffectEstimates) -> EffectRecord {
    let same = |x: f64| x;
    let interval = |share: Option<Estimate>| share.and_then(|s| interval_record(s.interval, &same));
    EffectRecord {
        first_order: estimate_record(effect.first_order),
        total: estimate_record(effect.total),
        share_first_order: effect.share_first_order.map(|share| share.estimate),
        share_total: effect.share_total.map(|share| share.estimate),
        share_first_order_interval: interval(effect.share_first_order),
        share_total_interval: interval(effect.share_total),
    }
}

fn estimate_record(Estimate { estimate, interval }: Estimate) -> EstimateRecord {
    EstimateRecord { estimate, low: interval.map(|i| i.low), high: interval.map(|i| i.high) }
}

fn interval_record(interval: Option<Interval>, convert: &dyn Fn(f64) -> f64) -> Option<IntervalRecord> {
    interval.map(|i| IntervalRecord { low: convert(i.low), high: convert(i.high) })
}

fn failure_record(study: &Study, failure: &crate::model::RowFailure, tally: Tally) -> FailureRecord {
    let mut u = vec![0.0; study.design.factors()];
    study.design.point(tally.first_row, &mut u);
    let values = study.space.values_at(&u);
    let named = |(factor, value): (&crate::space::Factor, f64)| (factor.name.clone(), Value::from(value));
    let first_inputs: Map<String, Value> = study.space.factors().iter().zip(values).map(named).collect();
    FailureRecord { reason: failure.to_string(), runs: tally.count, first_row: tally.first_row, first_inputs }
}
