//! Other sensitivity measures in the document of given data, and their tables for other documents.

use std::collections::BTreeMap;

use apportion::given::{InputMeasures, Measure, NoVariance};

use super::record::GivenFile;
use crate::document::{Part, Section, Table};
use crate::format::{fixed, index as of_error};

impl GivenFile {
    /// Adds `measures` to each output of the result.
    #[must_use]
    pub fn with_measures(mut self, measures: &[Result<Vec<InputMeasures>, NoVariance>]) -> Self {
        for (output, measures) in self.outputs.iter_mut().zip(measures) {
            output.measures = measures.as_ref().ok().cloned();
        }
        self
    }
}

/// Builds the section of the measures of all outputs; `None` if there are none.
pub(super) fn section(result: &GivenFile, name: &str) -> Option<Section> {
    let mut parts = Vec::new();
    for output in &result.outputs {
        let Some(inputs) = output.measures.as_deref() else { continue };
        parts.push(Part::Text(agreement(&output.name, inputs, &Measure::ALL)));
        let mut table = table(&output.name, ("input", inputs), &Measure::ALL);
        table.file = format!("{name}-measures.csv");
        parts.push(table.into());
    }
    (!parts.is_empty()).then(|| Section::new("measures", "Other measures", parts))
}

/// Returns the input with the largest measure.
fn first(inputs: &[InputMeasures], measure: Measure) -> Option<usize> {
    let values = inputs.iter().map(|of| of.get(measure).map_or(f64::NEG_INFINITY, |index| index.estimate.estimate));
    values.enumerate().rev().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Says whether the measures agree on the most important input, and which inputs no measure distinguishes from chance.
pub(crate) fn agreement(output: &str, inputs: &[InputMeasures], measures: &[Measure]) -> String {
    let mut leading: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    let mut measures = measures.to_vec();
    measures.retain(|measure| inputs.iter().any(|of| of.get(*measure).is_some()));
    for &measure in &measures {
        if let Some(lead) = first(inputs, measure) {
            leading.entry(lead).or_default().push(measure.heading());
        }
    }
    let mut leads: Vec<(usize, Vec<&str>)> = leading.into_iter().collect();
    leads.sort_by_key(|(_, by)| std::cmp::Reverse(by.len()));
    let mut text = match &leads[..] {
        [(lead, _)] if measures.len() > 1 => format!("All measures put {} first for {output}.", inputs[*lead].input),
        [] => String::new(),
        [(lead, _)] => format!("{} comes first for {output}.", inputs[*lead].input),
        leads => {
            let leads = leads.iter().map(|(lead, by)| format!("{} by {}", inputs[*lead].input, by.join(", ")));
            let leads: Vec<String> = leads.collect();
            format!("The measures disagree on the most important input for {output}: {}.", leads.join("; "))
        }
    };
    let idle = inputs.iter().filter(|of| measures.iter().all(|measure| of.may_be_chance(*measure)));
    let idle: Vec<&str> = idle.map(|of| of.input.as_str()).collect();
    if !idle.is_empty() {
        text.push_str(&format!(" No measure tells {} from an input without influence.", idle.join(", ")));
    }
    text
}

/// Tabulates the `measures` of an output, a row for each input or factor, named by `what`.
pub(crate) fn table(output: &str, (what, inputs): (&'static str, &[InputMeasures]), measures: &[Measure]) -> Table {
    let has_kernels = measures.contains(&Measure::Hsic);
    let by_permutations = format!("by {} permutations of the output", InputMeasures::PERMUTATIONS);
    let chance = match (measures == [Measure::Hsic], has_kernels) {
        (true, _) => "by a gamma distribution".to_owned(),
        (false, true) => format!("{by_permutations}, of R2-HSIC by a gamma distribution"),
        (false, false) => by_permutations,
    };
    let article = if what == "input" { "an" } else { "a" };
    let mut values = inputs.iter().flat_map(|of| of.measures.values());
    let mut caption = if values.clone().any(|value| value.p_value.is_some()) {
        format!(
            "In brackets: the value that {article} {what} without influence reaches in more than {:.0} of 100 tables, {chance}.",
            100.0 * InputMeasures::SIGNIFICANT
        )
    } else {
        "The rows are not independent draws, so there are no p-values.".to_owned()
    };
    if values.any(|value| value.estimate.interval.is_some()) {
        caption.push_str(" Delta has its 95 % interval.");
    }
    if has_kernels {
        caption
            .push_str(&format!(" R2-HSIC uses at most {} rows, drawn at random.", InputMeasures::MAX_ROWS_OF_KERNELS));
        if inputs.iter().any(|of| of.get(Measure::Hsic).is_none()) {
            caption.push_str(" It is empty where these rows have one value only.");
        }
    }
    let mut rows = Table::from_rows(caption, inputs).file("output", |_| output).text(what, |of| &of.input).named(what);
    for &measure in measures {
        rows = rows
            .number(measure.heading(), |of| value_text(of, measure))
            .estimate(measure.name(), |of| Some(of.get(measure)?.estimate))
            .file(format!("{}_p", measure.name()), |of| of.get(measure).and_then(|value| value.p_value));
    }
    rows.into()
}

/// Formats a measure of an input, in brackets if it may be chance.
fn value_text(of: &InputMeasures, measure: Measure) -> String {
    let text = of.get(measure).map_or_else(String::new, |value| match value.estimate.interval {
        Some(_) => of_error(value.estimate),
        None => fixed(value.estimate.estimate, 3),
    });
    if of.may_be_chance(measure) { format!("({text})") } else { text }
}
