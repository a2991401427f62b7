//! From a study and its analysis to the result file.

use std::path::Path;

use rayon::prelude::*;

use super::build_output::OutputRecords;
use super::records::{factor_record, json, study_record, validity};
use super::result::{
    AggregateRecord, EffortRecord, PlainIndexRecord, Provenance, ResultFile, RungRecord, SeriesRecord, SpendingRecord,
    StoppingRecord,
};
use crate::analysis::{Analysis, SeriesAnalysis, Spending};
use crate::estimate::{FirstOrder, Scaling, Total};
use crate::model::{EVALUATIONS, LARGEST_ERROR, RUNGS};
use crate::study::Study;
use crate::uncertainty::{AggregateIndices, IntervalMethod};

/// How long a run took, and on how many threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunFacts {
    /// Threads used.
    pub threads: usize,
    /// Seconds from the first run to the last.
    pub wall_seconds: f64,
}

impl ResultFile {
    /// The result file of `analysis`, which a run of `study` gave.
    pub fn new(study: &Study, analysis: &Analysis) -> Self {
        let factors = study.space.factors().iter().filter(|factor| !factor.distribution().is_noise());
        let records = OutputRecords::new(study, analysis);
        let is_item = |place: &usize| analysis.series.iter().any(|all| all.series.places().contains(place));
        let outputs = analysis.outputs.par_iter().enumerate();
        Self {
            format: "apportion-result".to_owned(),
            version: 1,
            study: study_record(study),
            provenance: provenance(study, analysis),
            factors: factors.map(factor_record).collect(),
            outputs: outputs.map(|(place, output)| records.record(output, is_item(&place))).collect(),
            validity: validity(analysis.flags.iter().map(|(flag, raised)| (flag, *raised)), analysis.design.rows()),
            effort: effort_record(analysis),
            aggregate: aggregate_record(study, analysis),
            series: analysis.series.iter().map(|series| series_record(study, analysis, series)).collect(),
            stopping: stopping_record(study, analysis),
            spending: spending_record(study, analysis),
            lows: analysis.lows.clone(),
        }
    }
}

fn stopping_record(study: &Study, analysis: &Analysis) -> Option<StoppingRecord> {
    let target = study.target;
    analysis.stopped.as_ref().map(|stopped| StoppingRecord {
        reason: stopped.reason.to_string(),
        target_met: stopped.target_met,
        target_half_width: target.accuracy,
        budget_seconds: target.max_time,
        max_runs: target.max_runs,
    })
}

fn spending_record(study: &Study, analysis: &Analysis) -> Option<SpendingRecord> {
    let Spending { accuracy, runs, surrogate, plain_runs, reasons } = analysis.spending.as_ref()?;
    let design = &analysis.design;
    let mut lines = match design.plain_rows() {
        0 => format!("[design]\nbase_samples = {}\n", design.settings().base_samples),
        _ => format!("[design]\nruns = {}\n", design.rows()),
    };
    lines.push_str(&format!("[analysis]\nsurrogate = \"{}\"\n", surrogate.name()));
    if let [low] = &analysis.lows[..] {
        lines.push_str("[fidelity]\n");
        lines.push_str(&match study.lows.len() {
            0 => format!("low = [\"{}\"]\n", low.name),
            1 => String::new(),
            _ => format!("# of `low` keep `{}` alone\n", low.name),
        });
        lines.push_str(&format!("base_samples = {}\n", low.own_base_samples));
    }
    Some(SpendingRecord { accuracy: *accuracy, runs: *runs, plain_runs: *plain_runs, reasons: reasons.clone(), lines })
}

fn effort_record(analysis: &Analysis) -> Option<EffortRecord> {
    let counts = || analysis.counts.iter();
    let value = |name| counts().find(|(counter, _)| counter.name == name).map_or(0.0, |(_, value)| *value);
    let rungs = counts().filter(|(_, runs)| *runs > 0.0).filter_map(|(counter, runs)| {
        Some(RungRecord { rung: counter.name.strip_prefix(RUNGS)?.to_owned(), runs: *runs as u64 })
    });
    (!analysis.counts.is_empty()).then(|| EffortRecord {
        rungs: rungs.collect(),
        evaluations: value(EVALUATIONS) as u64,
        largest_error_estimate: value(LARGEST_ERROR),
    })
}

/// The result as JSON text, ending in a newline.
pub fn result_json(result: &ResultFile) -> String {
    json(result)
}

fn provenance(study: &Study, analysis: &Analysis) -> Provenance {
    let (design, options) = (&analysis.design, &study.analysis);
    let settings = design.settings();
    let alone = settings.replicates == 1 && options.intervals == IntervalMethod::Replicates;
    let (first_order, total) = match options.salib {
        true => (FirstOrder::Saltelli2010, Total::Jansen1999),
        false => (FirstOrder::default_for(design.has_ba()), Total::default_for(design.has_ba())),
    };
    Provenance {
        apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: settings.seed,
        sampler: settings.sampler.name().to_owned(),
        base_samples: settings.base_samples,
        replicates: settings.replicates,
        plain_rows: design.plain_rows(),
        model_runs: design.rows(),
        threads: analysis.threads,
        wall_seconds: analysis.wall_seconds,
        study_sha256: study.sha256.clone(),
        first_order_estimator: first_order.source().to_owned(),
        total_estimator: total.source().to_owned(),
        shapley_method: options.shapley_of(&study.space).map(|method| method.name().to_owned()),
        interval: (!alone).then(|| options.intervals.words(settings.replicates, options.resamples)),
        interval_method: options.intervals.name().to_owned(),
        threshold: options.threshold,
        model_files: study.subject.files().iter().map(|file| name_of(file)).collect(),
    }
}

fn name_of(file: &Path) -> String {
    file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn aggregate_record(study: &Study, analysis: &Analysis) -> Option<AggregateRecord> {
    let aggregate = analysis.aggregate.as_ref()?;
    let weighting = match aggregate.scaling {
        Scaling::Plain => "each output counts by its variance (Gamboa et al. 2014)",
        Scaling::Standardised => "each output is divided by its standard deviation first, since their units differ",
    };
    let indices = aggregate.indices.as_ref();
    Some(AggregateRecord {
        outputs: aggregate.outputs.clone(),
        weighting: weighting.to_owned(),
        indices: indices.ok().map(|all| together_records(study, all)),
        noise: study.space.noise().zip(indices.ok()).map(|(noise, all)| together_record(study, all, noise)),
        reason: indices.err().map(|undefined| undefined.to_string()),
    })
}

fn together_records(study: &Study, all: &AggregateIndices) -> Vec<PlainIndexRecord> {
    let known = (0..study.space.factors().len()).filter(|factor| Some(*factor) != study.space.noise());
    known.map(|factor| together_record(study, all, factor)).collect()
}

fn together_record(study: &Study, all: &AggregateIndices, factor: usize) -> PlainIndexRecord {
    PlainIndexRecord {
        factor: study.space.factors()[factor].name.clone(),
        first_order: all.first_order[factor],
        total: all.total[factor],
    }
}

fn series_record(study: &Study, analysis: &Analysis, found: &SeriesAnalysis) -> SeriesRecord {
    let SeriesAnalysis { series, aggregate } = found;
    let unit = &analysis.outputs[series.first].unit;
    SeriesRecord {
        name: series.name.clone(),
        unit: unit.to_string(),
        axis: series.axis.label().to_owned(),
        axis_unit: series.axis.unit().to_owned(),
        first_output: series.first,
        positions: series.axis.positions().to_vec(),
        indices: aggregate.as_ref().ok().map(|all| together_records(study, all)),
        reason: aggregate.as_ref().err().map(ToString::to_string),
    }
}
