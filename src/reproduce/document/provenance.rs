//! How the page came about.

use crate::reproduce::{Effort, Reproduced, Reproduction};
use apportion::report::document::{Part, Table};
use apportion::report::grouped;

/// Version, designs, estimators, intervals and cost, as a table of two columns.
pub(super) fn table(reproduction: &Reproduction) -> Part {
    let effort = match reproduction.effort {
        Effort::Full => "full",
        Effort::Quick => "quick: fewer points and repetitions, wider intervals",
    };
    let program = format!("apportion {}", env!("CARGO_PKG_VERSION"));
    let mut rows = vec![("program", program), ("effort", effort.to_owned())];
    if let Some(study) = reproduction.studies.first() {
        rows.extend(design(study));
        let runs: u64 = reproduction.studies.iter().map(|study| study.result.provenance.model_runs).sum();
        let seconds: f64 = reproduction.studies.iter().map(|study| study.result.provenance.wall_seconds).sum();
        let threads = study.result.provenance.threads;
        let cost = format!("{} model runs in {seconds:.2} s on {threads} threads", grouped(runs));
        rows.push(("cost of the studies", cost));
    }
    let caption = "How this page was made. The numbers are the same on every machine and for any number of threads; only the \
                   times differ.";
    Part::Table(Table::pairs(caption, rows))
}

/// What all studies share.
fn design(study: &Reproduced) -> Vec<(&'static str, String)> {
    let provenance = &study.result.provenance;
    let design = format!(
        "{} points, {} base samples in {} replicates, seed {}",
        provenance.sampler, provenance.base_samples, provenance.replicates, provenance.seed
    );
    let mut rows = vec![
        ("design", design),
        ("first-order estimator", provenance.first_order_estimator.clone()),
        ("total estimator", provenance.total_estimator.clone()),
    ];
    rows.extend(provenance.interval.clone().map(|words| ("95 % intervals", words)));
    if !study.result.study.overrides.is_empty() {
        rows.push(("changes on the command line", study.result.study.overrides.join(", ")));
    }
    rows
}
