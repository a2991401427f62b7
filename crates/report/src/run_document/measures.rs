//! Other measures than Sobol' indices, from the rows of A and B.

use apportion::given::Measure;
use apportion::result::{OutputResult, RunMeasures, StudyResult};

use super::tables::FACTORS;
use crate::document::{Part, Table, csv};
use crate::format::grouped;
use crate::given::{agreement, measures_table};

/// Describes the measures, with a row for each factor.
pub(super) fn measures(output: &OutputResult) -> Vec<Part> {
    let Some(record) = &output.measures else { return Vec::new() };
    let wanted = wanted([record]);
    let text = format!(
        "{} They are estimated from the first {} rows A and B of the run, as from given data.",
        agreement(&output.name, &record.factors, &wanted),
        grouped(record.rows as u64)
    );
    vec![Part::Text(text), table(output, record, &wanted).into()]
}

/// Returns the measures that any of the records has.
fn wanted<'a>(records: impl IntoIterator<Item = &'a RunMeasures>) -> Vec<Measure> {
    let factors: Vec<_> = records.into_iter().flat_map(|record| &record.factors).collect();
    let is_there = |measure: &Measure| factors.iter().any(|of| of.measures.contains_key(measure));
    Measure::ALL.into_iter().filter(is_there).collect()
}

fn table(output: &OutputResult, record: &RunMeasures, wanted: &[Measure]) -> Table {
    let table = measures_table(&output.name, ("factor", &record.factors), wanted);
    let printed = Some((0..table.rows.len().min(FACTORS)).collect());
    Table { printed, ..table }
}

/// Formats the measures of all outputs as CSV.
pub(super) fn measures_csv(result: &StudyResult) -> String {
    let wanted = wanted(result.outputs.iter().filter_map(|output| output.measures.as_ref()));
    let tables = result.outputs.iter().filter_map(|output| Some(table(output, output.measures.as_ref()?, &wanted)));
    csv(tables)
}
