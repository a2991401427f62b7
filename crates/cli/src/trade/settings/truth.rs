//! The reference from which errors are measured.

use apportion::clock::Instant;
use apportion::result::OutputResult;
use apportion::run::RunError;
use apportion::study::Target;

use super::curve::rungs;
use super::{SettingsJob, TruthFound};

/// Target half width of a reference.
const FINEST: f64 = 1e-6;

/// First-order and total index of every factor, of every output that has them.
type Indices = Vec<[f64; 2]>;

pub(super) struct Truth {
    pub outputs: Vec<Option<Indices>>,
    pub found: TruthFound,
}

impl Truth {
    /// Returns the exact indices if the function has them, else those of a run of the finest model of so many seconds.
    pub fn new(job: &SettingsJob<'_>, seconds: f64) -> Result<Self, RunError> {
        let study = job.study;
        if let Some((first, total)) = study.subject().exact_indices(study.space()) {
            let indices = first.into_iter().zip(total).map(|(first, total)| [first, total]).collect();
            let found = TruthFound {
                words: "the exact indices of the function".to_owned(),
                error: Some(0.0),
                runs: 0,
                seconds: 0.0,
            };
            return Ok(Self { outputs: vec![Some(indices)], found });
        }
        let rung = rungs(study).into_iter().rfind(|rung| rung.is_finest);
        let name = rung.as_ref().map_or_else(String::new, |rung| rung.name.clone());
        let subject = rung.map_or_else(|| study.subject().clone(), |rung| rung.subject);
        let max_time = study.target().max_time.map_or(seconds, |limit| limit.min(seconds));
        let target = Target::accuracy(FINEST).max_time(max_time);
        let analysis = study.analysis().clone();
        let analysis =
            apportion::AnalysisOptions { pictures: false, second_order: false, estimators: Vec::new(), ..analysis };
        let finest = study.clone().with_subject(subject).with_target(target);
        // A design with fewer swaps always exists.
        let finest = finest.clone().with_design(study.design().settings().clone(), analysis).unwrap_or(finest);
        let start = Instant::now();
        let result = job.run(&finest)?;
        let known = result.outputs.iter().filter(|output| output.indices.is_some());
        let error =
            known.map(OutputResult::largest_half_width).try_fold(0.0, |largest, width| Some(f64::max(largest, width?)));
        let of_output = |output: &OutputResult| {
            let indices = output.indices.as_ref()?;
            Some(indices.iter().map(|i| [i.effect.first_order.estimate, i.effect.total.estimate]).collect())
        };
        let runs = result.spending.as_ref().map_or(result.provenance.model_runs, |spending| spending.runs);
        let words = format!("a run of {name} with {} base samples", result.provenance.base_samples);
        let found = TruthFound { words, error, runs, seconds: start.elapsed().as_secs_f64() };
        Ok(Self { outputs: result.outputs.iter().map(of_output).collect(), found })
    }
}
