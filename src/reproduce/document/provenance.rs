//! How the page came about.

use crate::reproduce::{Effort, Reproduced, Reproduction};
use apportion::report::document::{Part, Table};
use apportion::report::grouped;

/// Version, designs, estimators, intervals and cost, as a table of two columns.
pub(super) fn table(reproduction: &Reproduction) -> Part {
    let mut rows: Vec<(String, String)> =
        vec![("program".to_owned(), format!("apportion {}", env!("CARGO_PKG_VERSION")))];
    rows.push((
        "effort".to_owned(),
        match reproduction.effort {
            Effort::Full => "full",
            Effort::Quick => "quick: fewer points and repetitions, wider intervals",
        }
        .to_owned(),
    ));
    if let Some(study) = reproduction.studies.first() {
        rows.extend(design(study));
        let runs: u64 = reproduction.studies.iter().map(|study| study.result.provenance.model_runs).sum();
        let seconds: f64 = reproduction.studies.iter().map(|study| study.result.provenance.wall_seconds).sum();
        rows.push((
            "cost of the studies".to_owned(),
            format!("{} model runs in {seconds:.2} s on {} threads", grouped(runs), study.result.provenance.threads),
        ));
    }
    let caption = "How this page was made. The numbers are the same on every machine and for any number of threads; only the \
                   times differ.";
    Part::Table(Table::pairs(caption, rows))
}

/// What all studies share.
fn design(study: &Reproduced) -> Vec<(String, String)> {
    let provenance = &study.result.provenance;
    let named = |name: &str, value: String| (name.to_owned(), value);
    let mut rows = vec![
        named(
            "design",
            format!(
                "{} points, {} base samples in {} replicates, seed {}",
                provenance.sampler, provenance.base_samples, provenance.replicates, provenance.seed
            ),
        ),
        named("first-order estimator", provenance.first_order_estimator.clone()),
        named("total estimator", provenance.total_estimator.clone()),
    ];
    rows.extend(provenance.interval.clone().map(|words| named("95 % intervals", words)));
    if !study.result.study.overrides.is_empty() {
        rows.push(named("changes on the command line", study.result.study.overrides.join(", ")));
    }
    rows
}
