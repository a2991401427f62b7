//! The result file of given data.

use apportion::given::{
    Column, Dependence, GivenIndices, InputIndices, InputMeasures, OutputIndices, PointSet, Replicates,
    SurrogateOutput, SurrogateRefusal, Surrogates, TextColumn,
};
use apportion::result::OutputDistribution;
use apportion::uncertainty::Estimate;
use apportion_base::quantity::Unit;
use serde::{Deserialize, Serialize};

use super::sentences;

/// A result from given data, as described in `docs/reference/given-data-format.md`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenFile {
    /// `"apportion-given-data"`.
    pub format: String,
    /// 1.
    pub version: u32,
    /// How the numbers came about.
    pub provenance: GivenProvenance,
    /// The table.
    pub table: TableRecord,
    /// The inputs, in the order of the analysis.
    pub inputs: Vec<GivenInputRecord>,
    /// Dependence between the inputs; `null` with fewer than two that vary.
    pub dependence: Option<Dependence>,
    /// How surrogates were fitted.
    pub surrogate: GivenSurrogateRecord,
    /// The outputs.
    pub outputs: Vec<GivenOutputRecord>,
    /// Warnings on this table, in sentences.
    pub warnings: Vec<String>,
    /// What indices from given data cannot show, in sentences.
    pub notes: Vec<String>,
}

/// How the numbers came about.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct GivenProvenance {
    /// Version of this program.
    pub apportion_version: String,
    /// Seed of the order of ties in the intervals of the rank estimator.
    pub seed: u64,
    /// The estimators.
    pub estimators: Vec<String>,
    /// The method of the intervals; `null` if there are none.
    pub interval: Option<String>,
}

/// The table that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableRecord {
    /// Its file, as named by the user.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Rows used.
    pub rows: u64,
    /// Rows left out for missing values.
    pub rows_dropped: u64,
    /// Line of the first of them.
    pub first_dropped_line: Option<u64>,
    /// `"independent"`, `"too-even"` or `"grid"`.
    pub points: String,
    /// Why the rows are not considered independent draws, if so.
    pub points_reason: Option<String>,
    /// Columns that are not inputs because they hold text.
    pub columns_left_out: Vec<TextColumn>,
}

impl GivenFile {
    /// Adds a note on what was done with the table before it was analysed.
    #[must_use]
    pub fn after(mut self, replicates: Option<&Replicates>, counter: Option<&str>) -> Self {
        let counter = counter.map(|name| {
            format!("the column `{name}` numbers the rows: it is no input, and the rows were put in its order")
        });
        let replicates = replicates.map(|of| sentences::replicates(of, &self.outputs));
        self.warnings.splice(0..0, counter.into_iter().chain(replicates));
        self
    }

    /// Adds a note that these columns of the table hold text, as the first one.
    #[must_use]
    pub fn without(mut self, columns: &[TextColumn]) -> Self {
        self.table.columns_left_out = columns.to_vec();
        self.warnings.splice(0..0, columns.iter().map(ToString::to_string));
        self
    }
}

/// An input: indices are valid for its values in the table, between these bounds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenInputRecord {
    /// Its name.
    pub name: String,
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
}

/// An output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenOutputRecord {
    /// Its name.
    pub name: String,
    /// Its distribution over the rows.
    pub distribution: Option<OutputDistribution>,
    /// One entry per input; `null` if there are no indices.
    pub indices: Option<Vec<InputIndices>>,
    /// Sum over the inputs of the estimates by ranks or bins, those with the wider intervals.
    pub sum_first_order: Option<f64>,
    /// Indices by surrogates; `null` if there are none.
    pub surrogate: Option<SurrogateOutput>,
    /// Other measures, one entry per input; `null` if they were not requested, or there are none.
    pub measures: Option<Vec<InputMeasures>>,
    /// Why there are no indices.
    pub reason: Option<String>,
    /// Warnings, in sentences.
    pub warnings: Vec<String>,
}

impl GivenOutputRecord {
    /// Returns the indices by surrogates that are valid.
    pub(super) fn served(&self) -> Option<&SurrogateOutput> {
        self.surrogate.as_ref().filter(|surrogate| surrogate.serves)
    }

    /// Returns the first-order index of an input that is shown: the surrogate's if it serves.
    pub(super) fn first_order(&self, number: usize) -> Option<Estimate> {
        let by_surrogate = self.served().map(|of| of.indices[number].first_order);
        by_surrogate.or_else(|| Some(self.indices.as_ref()?[number].leading()))
    }
}

/// Surrogates, or why there are none.
pub type SurrogateResult = Result<Surrogates, SurrogateRefusal>;

/// How surrogates were fitted to a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GivenSurrogateRecord {
    /// Why there are none, if so.
    pub refused: Option<String>,
    /// Rows used; `null` without surrogates.
    pub rows: Option<u64>,
    /// Parts of the table, each corrected by a surrogate of the others; `null` without surrogates.
    pub folds: Option<u64>,
    /// `"columns"`: those of the columns; `"given"`: those of a study. `null` without surrogates.
    pub distributions: Option<String>,
    /// Share of the variance that a surrogate must explain to be used.
    pub least_explained: f64,
}

fn surrogate_record(result: &SurrogateResult) -> GivenSurrogateRecord {
    let fitted = result.as_ref().ok();
    GivenSurrogateRecord {
        refused: result.as_ref().err().map(ToString::to_string),
        rows: fitted.map(|all| all.rows as u64),
        folds: fitted.map(|all| all.folds as u64),
        distributions: fitted.map(|all| if all.given_distributions { "given" } else { "columns" }.to_owned()),
        least_explained: SurrogateOutput::MIN_EXPLAINED,
    }
}

/// Facts for the result besides the indices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GivenFacts {
    /// The table's file, as named by the user.
    pub file: String,
    /// Its SHA-256.
    pub sha256: String,
    /// Rows left out, and the line of the first.
    pub dropped: Option<(u64, u64)>,
    /// The seed.
    pub seed: u64,
}

/// Builds the result file for `indices` of the columns they were estimated from, and the `surrogates`.
pub fn build_given(
    indices: &GivenIndices,
    surrogates: &SurrogateResult,
    inputs: &[Column],
    outputs: &[Column],
    facts: &GivenFacts,
) -> GivenFile {
    let (columns, fitted) = (outputs, surrogates.as_ref().ok());
    let mut records = Vec::new();
    for (number, (indices, column)) in indices.outputs.iter().zip(outputs).enumerate() {
        let surrogate = fitted.and_then(|all| all.outputs[number].as_ref().ok());
        records.push(output_record(indices, surrogate, column));
    }
    let outputs: Vec<GivenOutputRecord> = records;
    let serves = outputs.iter().any(|output| output.served().is_some());
    let warnings = sentences::warnings(indices, surrogates, facts.dropped);
    GivenFile {
        format: "apportion-given-data".to_owned(),
        version: 1,
        provenance: GivenProvenance {
            apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
            seed: facts.seed,
            estimators: sentences::estimators(indices, surrogates),
            interval: sentences::interval(indices, serves),
        },
        table: TableRecord {
            file: facts.file.clone(),
            sha256: facts.sha256.clone(),
            rows: indices.rows as u64,
            rows_dropped: facts.dropped.map_or(0, |(rows, _)| rows),
            first_dropped_line: facts.dropped.map(|(_, line)| line),
            points: points_name(&indices.points).to_owned(),
            points_reason: indices.points.reason(),
            columns_left_out: Vec::new(),
        },
        inputs: inputs.iter().map(input_record).collect(),
        dependence: indices.dependence.clone(),
        surrogate: surrogate_record(surrogates),
        outputs,
        warnings: sentences::codes(inputs).into_iter().chain(sentences::codes(columns)).chain(warnings).collect(),
        notes: sentences::notes(serves),
    }
}

fn points_name(points: &PointSet) -> &'static str {
    match points {
        PointSet::Independent => "independent",
        PointSet::TooEven(_) => "too-even",
        PointSet::Grid => "grid",
    }
}

fn input_record(column: &Column) -> GivenInputRecord {
    let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
    for &value in &column.values {
        (min, max) = (min.min(value), max.max(value));
    }
    GivenInputRecord { name: column.name.clone(), min, max }
}

fn output_record(output: &OutputIndices, surrogate: Option<&SurrogateOutput>, column: &Column) -> GivenOutputRecord {
    let indices = output.indices.as_ref();
    let distribution = OutputDistribution::from_values(&column.values, &Unit::dimensionless());
    let few_rows = distribution.as_ref().and_then(sentences::few_rows);
    GivenOutputRecord {
        name: output.name.clone(),
        distribution,
        indices: indices.ok().cloned(),
        sum_first_order: indices.ok().map(|indices| indices.iter().map(|index| index.leading().estimate).sum()),
        surrogate: surrogate.filter(|_| indices.is_ok()).cloned(),
        measures: None,
        reason: indices.err().map(ToString::to_string),
        warnings: few_rows.into_iter().chain(sentences::output_warnings(output, surrogate)).collect(),
    }
}
