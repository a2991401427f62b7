//! Other measures than Sobol' indices, of the first rows A and B.

use super::tables::FACTORS;
use crate::given::Measure;
use crate::report::document::{Part, Table, csv};
use crate::report::format::grouped;
use crate::report::given::{agreement, measures_table};
use crate::result::RunMeasures;
use crate::result::{OutputResult, StudyResult};

/// What they say, and a row for each factor.
pub(super) fn measures(output: &OutputResult) -> Vec<Part> {
    let Some(record) = &output.measures else { return Vec::new() };
    let wanted = wanted(record);
    let text = format!(
        "{} They are taken from {} rows A and B, the first of the run, as from given data.",
        agreement(&output.name, &record.factors, &wanted),
        grouped(record.rows as u64)
    );
    vec![Part::Text(text), table(output, record).into()]
}

/// The measures of a record.
fn wanted(record: &RunMeasures) -> Vec<Measure> {
    let is_there = |measure: &Measure| record.factors.iter().any(|of| of.measures.contains_key(measure));
    Measure::ALL.into_iter().filter(is_there).collect()
}

fn table(output: &OutputResult, record: &RunMeasures) -> Table {
    let table = measures_table(&output.name, ("factor", &record.factors), &wanted(record));
    let printed = Some((0..table.rows.len().min(FACTORS)).collect());
    Table { printed, ..table }
}

/// Those of all outputs.
pub(super) fn measures_csv(result: &StudyResult) -> String {
    let tables = result.outputs.iter().filter_map(|output| Some(table(output, output.measures.as_ref()?)));
    csv(tables)
}
