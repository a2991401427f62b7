//! Some of the outputs of a result, as the subject of a document or a section, and access to their indices.

use apportion::result::{Named, OutputResult, SeriesRecord, StudyResult};
use apportion::uncertainty::{EffectEstimates, Estimate};
use apportion::{IndexPair, Scaling, Undefined};

use crate::format::name;

/// A single output, or a series.
#[derive(Clone, Copy, Debug)]
pub enum Subject<'a> {
    /// An output.
    Output(&'a OutputResult),
    /// A series of outputs.
    Series(&'a SeriesRecord),
}

impl<'a> Subject<'a> {
    /// Finds the series or output called `name`; without a name, or if there is none of this name, the first one.
    pub fn find(result: &'a StudyResult, name: Option<&str>) -> Option<Self> {
        let mut series = result.series.iter();
        let mut outputs = result.outputs.iter();
        if let Some(series) = series.clone().find(|series| Some(&*series.name) == name) {
            return Some(Self::Series(series));
        }
        if let Some(output) = outputs.clone().find(|output| Some(&*output.name) == name) {
            return Some(Self::Output(output));
        }
        let first = series.find(|series| series.first_output == 0).map(Self::Series);
        first.or_else(|| outputs.next().map(Self::Output))
    }
}

/// How the values of a series are weighted.
const WEIGHTING: &str = "each value counts by its variance (Gamboa et al. 2014)";

/// Some of the outputs of a result.
#[derive(Clone, Debug)]
pub(crate) struct OutputView<'a> {
    pub result: &'a StudyResult,
    /// The names of what has indices: factors, or groups in their place.
    pub factors: Vec<&'a str>,
    /// The series among them.
    pub series: Vec<&'a SeriesRecord>,
    /// The outputs that are in none of these series.
    pub outputs: Vec<&'a OutputResult>,
    /// What `together` describes, such as `all outputs together`.
    pub label: String,
    /// The indices of `outputs` together.
    pub together: Option<Together<'a>>,
}

/// The indices of several outputs together, or why there are none.
#[derive(Clone, Debug)]
pub(crate) struct Together<'a> {
    pub outputs: Vec<&'a str>,
    pub weighting: &'static str,
    pub indices: Option<&'a [Named<IndexPair<Estimate>>]>,
    pub noise: Option<&'a Named<IndexPair<Estimate>>>,
    pub reason: Option<Undefined>,
}

impl<'a> OutputView<'a> {
    /// Returns all series and outputs of a result.
    pub fn new(result: &'a StudyResult) -> Self {
        let in_series = |place: &usize| result.series.iter().any(|series| series.places().contains(place));
        let outputs = (0..).zip(&result.outputs).filter(|(place, _)| !in_series(place));
        let together = result.aggregate.as_ref().map(|record| Together {
            outputs: record.outputs.iter().map(String::as_str).collect(),
            weighting: weighting(record.weighting),
            indices: record.indices.as_deref(),
            noise: record.noise.as_ref(),
            reason: record.reason,
        });
        Self {
            result,
            factors: result.indexed_names(),
            series: result.series.iter().collect(),
            outputs: outputs.map(|(_, output)| output).collect(),
            label: "all outputs together".to_owned(),
            together,
        }
    }

    /// Returns a single output or series of a result.
    pub fn one(result: &'a StudyResult, subject: Option<Subject<'a>>) -> Self {
        let (mut series, mut outputs) = (Vec::new(), Vec::new());
        match subject {
            Some(Subject::Series(record)) => series.push(record),
            Some(Subject::Output(output)) => outputs.push(output),
            None => (),
        }
        Self { result, factors: result.indexed_names(), series, outputs, label: String::new(), together: None }
    }

    /// Returns the values of a series as outputs.
    pub fn values(&self, series: &'a SeriesRecord) -> Self {
        let outputs: Vec<&OutputResult> = self.result.outputs[series.places()].iter().collect();
        let together = Together {
            outputs: outputs.iter().map(|output| output.name.as_str()).collect(),
            weighting: WEIGHTING,
            indices: series.indices.as_deref(),
            noise: None,
            reason: series.reason,
        };
        let label = format!("{} as a whole", name(&series.name));
        let factors = self.factors.clone();
        Self { result: self.result, factors, series: Vec::new(), outputs, label, together: Some(together) }
    }

    /// Iterates over the outputs, the values of the series included.
    pub fn all_outputs(&self) -> impl Iterator<Item = &'a OutputResult> {
        let result = self.result;
        let values = self.series.iter().flat_map(|series| &result.outputs[series.places()]);
        values.chain(self.outputs.iter().copied())
    }

    /// Returns whether it is a single output, whose topics are sections of their own.
    pub fn is_single_output(&self) -> bool {
        self.series.is_empty() && self.outputs.len() == 1
    }

    /// Returns the indices of all of its outputs together, if there are any.
    pub fn together_indices(&self) -> &'a [Named<IndexPair<Estimate>>] {
        self.together.as_ref().and_then(|together| together.indices).unwrap_or_default()
    }

    /// Returns why there are no indices of all of its outputs together.
    pub fn reason(&self) -> String {
        reason_in_words(self.together.as_ref().and_then(|together| together.reason))
    }
}

/// Says why there are no indices.
pub(crate) fn reason_in_words(reason: Option<Undefined>) -> String {
    reason.map_or_else(|| "the result has none".to_owned(), |reason| reason.to_string())
}

/// A choice of one of the indices of a factor.
pub(crate) type IndexOf = fn(&EffectEstimates) -> Estimate;

/// Iterates over the names and indices of the factors of an output, or of its groups in their place.
pub(crate) fn effects(output: &OutputResult) -> impl Iterator<Item = (&str, &EffectEstimates)> + Clone {
    output.indices.iter().flatten().map(|index| (index.name.as_str(), &index.effect))
}

/// Returns the indices of the factor at this position in the study.
pub(crate) fn effect_at(output: &OutputResult, factor: usize) -> Option<&EffectEstimates> {
    output.indices.as_ref()?.get(factor).map(|index| &index.effect)
}

/// Says how outputs are weighted against each other.
fn weighting(scaling: Scaling) -> &'static str {
    match scaling {
        Scaling::Plain => "each output counts by its variance (Gamboa et al. 2014)",
        Scaling::Standardised => "each output is divided by its standard deviation first, since their units differ",
    }
}
