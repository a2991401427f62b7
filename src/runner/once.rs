//! One run of a study, from its journal to its result.

use std::sync::atomic::{AtomicU64, Ordering};

use super::Runner;
use super::growth::{Grown, Growth};
use super::journal::{self, RunJournal};
use super::low_fidelity::{LowFidelityRun, LowFidelityStudy};
use crate::analysis::{FinishedRun, LowFidelityTotals, result};
use crate::model::{Messages, RunContext};
use crate::result::{StopReason, StudyResult};
use crate::run::{GrowingRun, Job, Progress, RemoteWorkers, RunError, Shard, repeat_rows, threads_in_force};

impl<'a> Runner<'a> {
    pub(super) fn open(&self, shard: Option<Shard>, messages: &Messages) -> Result<RunJournal, RunError> {
        if self.resume.is_required() {
            self.journal_for("a run that is resumed")?;
        }
        match &self.journal {
            None => Ok(RunJournal::none(self.study)),
            Some(path) => journal::open(self, path, shard, messages),
        }
    }

    pub(super) fn set_up<'r>(
        &self,
        job: Job<'r>,
        context: &'r RunContext<'r>,
        journal: &'r RunJournal,
    ) -> Result<GrowingRun<'r>, RunError>
    where
        'a: 'r,
    {
        // Some systems refuse more, and others take minutes to start them.
        const MAX_THREADS: usize = 1024;
        if self.threads > MAX_THREADS {
            let source = format!("at most {MAX_THREADS}").into();
            return Err(RunError::Threads { threads: self.threads, source });
        }
        let mut run = GrowingRun::new(job, context, self.threads).with_remote(self.remote_for(0));
        run.failures = self.study.analysis.failures;
        run.keeps_outputs = self.study.needs_outputs();
        run.journal = Some(&journal.open);
        Ok(run)
    }

    /// Runs the study and estimates its indices; also returns why a growing run stopped.
    pub(super) fn analyse(
        &self,
        context: &RunContext<'_>,
        journal: RunJournal,
    ) -> Result<(StudyResult, Option<StopReason>), RunError> {
        let (study, model) = (self.study, self.study.model());
        let longest = if study.target.grows() { study.design.longest() } else { study.design.clone() };
        let job = Job { design: &longest, space: &study.space, model: model.as_ref() };
        if let Some(store) = self.store {
            for block in journal.store.blocks() {
                store.insert(block);
            }
        }
        let (outputs, evaluated) = (model.outputs().len(), AtomicU64::new(0));
        let is_stored = journal.open.get().is_some() || model.is_slow() || self.remote.is_some();
        let store = self.store.or(is_stored.then_some(&journal.store));
        let low_studies = study.low_fidelities.iter().map(|low| LowFidelityStudy::new(self, low, context.messages()));
        let low_studies = low_studies.collect::<Result<Vec<_>, _>>()?;
        let on_progress = |progress: Progress| {
            evaluated.fetch_max(progress.done.saturating_sub(progress.recalled), Ordering::Relaxed);
            journal.watch(progress, outputs, context.messages());
            (self.on_progress)(progress);
        };
        let mut run = self.set_up(job, context, &journal)?;
        run.store = store;
        let low_fidelity = LowFidelityRun::all(self, &low_studies, context)?;
        let mut growth = Growth { study, run, low_fidelity, on_progress: &on_progress };
        let grown = growth.run_all();
        // An error of the run takes precedence over one of its journal.
        let Grown { reason: stopped, surrogates, plain } = grown.and_then(|grown| journal.finish().map(|()| grown))?;
        let Growth { run, low_fidelity, .. } = growth;
        let design = longest.with_points(run.points_per_replicate()).unwrap_or(longest.clone());
        let low_fidelity: Vec<LowFidelityTotals<'_>> = low_fidelity.iter().map(LowFidelityRun::totals).collect();
        let finished = FinishedRun {
            study,
            model: model.as_ref(),
            design: &design,
            replicates: run.totals(),
            low_fidelity: &low_fidelity,
            surrogates: surrogates.as_deref(),
            plain: plain.as_ref(),
            threads: threads_in_force(self.threads) + self.remote.map_or(0, RemoteWorkers::count),
            wall_seconds: run.elapsed().as_secs_f64(),
        };
        let mut result = run.install(|| result(&finished, stopped));
        let evaluated = evaluated.load(Ordering::Relaxed);
        if let Some(repeats) = repeat_rows(Job { design: &design, ..job }, context, evaluated, store) {
            for (output, differing) in result.outputs.iter_mut().zip(&repeats.differing) {
                output.warnings.extend(repeats.warning(*differing, study.space.noise().is_some()));
            }
        }
        Ok((result, stopped))
    }
}
