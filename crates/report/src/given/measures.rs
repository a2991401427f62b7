//! Other sensitivity measures in the document of given data, and their tables for other documents.

use std::collections::BTreeMap;

use apportion::given::{InputMeasures, MAX_ROWS_OF_KERNELS, Measure, NoVariance, PERMUTATIONS, SIGNIFICANT};

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
    let value = |k: usize| inputs[k].get(measure).map_or(f64::NEG_INFINITY, |found| found.estimate.estimate);
    (0..inputs.len()).rev().max_by(|&a, &b| value(a).total_cmp(&value(b)))
}

/// Says whether the measures agree on the most important input, and which inputs no measure distinguishes from chance.
pub(crate) fn agreement(output: &str, inputs: &[InputMeasures], measures: &[Measure]) -> String {
    let mut leading: BTreeMap<usize, Vec<&str>> = BTreeMap::new();
    let is_known = |measure: &&Measure| inputs.iter().any(|of| of.get(**measure).is_some());
    let measures: Vec<Measure> = measures.iter().filter(is_known).copied().collect();
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
            let one = |(lead, by): &(usize, Vec<&str>)| format!("{} by {}", inputs[*lead].input, by.join(", "));
            let all: Vec<String> = leads.iter().map(one).collect();
            format!("The measures disagree on the most important input for {output}: {}.", all.join("; "))
        }
    };
    let no_influence = |of: &&InputMeasures| measures.iter().all(|measure| of.may_be_chance(*measure));
    let idle: Vec<&str> = inputs.iter().filter(no_influence).map(|of| of.input.as_str()).collect();
    if !idle.is_empty() {
        text.push_str(&format!(" No measure tells {} from an input without influence.", idle.join(", ")));
    }
    text
}

/// Tabulates the `measures` of an output, a row for each input or factor, named by `what`.
pub(crate) fn table(output: &str, (what, inputs): (&'static str, &[InputMeasures]), measures: &[Measure]) -> Table {
    let has = |measure| measures.contains(&measure);
    let chance = match (measures == [Measure::Hsic], has(Measure::Hsic)) {
        (true, _) => "by a gamma distribution".to_owned(),
        (false, true) => format!("by {PERMUTATIONS} permutations of the output, of R2-HSIC by a gamma distribution"),
        (false, false) => format!("by {PERMUTATIONS} permutations of the output"),
    };
    let article = if what == "input" { "an" } else { "a" };
    let found = || inputs.iter().flat_map(|of| of.measures.values());
    let mut caption = if found().any(|found| found.p_value.is_some()) {
        format!(
            "In brackets: the value that {article} {what} without influence reaches in more than {:.0} of 100 tables, {chance}.",
            100.0 * SIGNIFICANT
        )
    } else {
        "The rows are not independent draws, so there are no p-values.".to_owned()
    };
    if found().any(|found| found.estimate.interval.is_some()) {
        caption.push_str(" Delta has its 95 % interval.");
    }
    if has(Measure::Hsic) {
        caption.push_str(&format!(" R2-HSIC uses at most {MAX_ROWS_OF_KERNELS} rows, drawn at random."));
        if inputs.iter().any(|of| of.get(Measure::Hsic).is_none()) {
            caption.push_str(" It is empty where these rows have one value only.");
        }
    }
    let mut rows = Table::from_rows(caption, inputs).file("output", |_| output).text(what, |of| &of.input).named(what);
    for &measure in measures {
        let found = |of: &'_ InputMeasures| of.get(measure).map(|found| (found.estimate, found.p_value));
        let said = |of: &'_ InputMeasures| {
            let text = found(of).map_or_else(String::new, |(estimate, _)| match estimate.interval {
                Some(_) => of_error(estimate),
                None => fixed(estimate.estimate, 3),
            });
            if of.may_be_chance(measure) { format!("({text})") } else { text }
        };
        rows = rows
            .number(measure.heading(), said)
            .estimate(measure.name(), |of| Some(found(of)?.0))
            .file(format!("{}_p", measure.name()), |of| found(of).and_then(|(_, p_value)| p_value));
    }
    rows.into()
}
