//! A comparison as a document, with its charts: the indices side by side, and their differences.

use apportion::result::json;
use apportion::uncertainty::{Estimate, Interval};
use apportion_base::text::listed;

use super::record::{ComparedFactor, ComparedIndex, ComparedOutput, ComparedSide, ComparisonFile};
use crate::chart::{Chart, Colour, Series};
use crate::document::{Document, OutputReport, Part, Report, Section, Table};
use crate::factor_bars::{DIFFERENCES, INDEX, INDICES, MAX_BARS, both_orders, index_panel, not_drawn};
use crate::format::{give_or_take, name, or_dash, significant};
use crate::leading::{self, Contender};

/// Builds the document of a comparison, whose files begin with `files`. A star marks intervals that exclude 0.
pub fn comparison_document(file: &ComparisonFile, files: &str) -> Document {
    let outputs = file.outputs.iter().map(|output| OutputReport {
        name: &output.name,
        unit: &output.unit,
        answer: format!("For {}, {}.", name(&output.name), leaders(output)),
        parts: output_parts(output),
        charts: vec![("", side_by_side(file, output)), ("-differences", differences(file, output))],
        ..OutputReport::default()
    });
    Report {
        name: files.to_owned(),
        kicker: "Comparison of two results",
        title: format!("{} and {}", file.a.label, file.b.label),
        lead: vec![legend(file)],
        first: vec![Section::new("sides", "What is compared", sides(file))],
        outputs: outputs.collect(),
        json: json(file),
        csv: Some(all_indices(file)),
        ..Report::default()
    }
    .document()
}

/// Describes the two results, the differences of their studies, and what only one of them has.
fn sides(file: &ComparisonFile) -> Vec<Part> {
    let mut parts = Vec::new();
    for (letter, ComparedSide { label, title, file, .. }) in [("A", &file.a), ("B", &file.b)] {
        let title = title.as_ref().map_or_else(String::new, |title| format!(", {title}"));
        parts.push(Part::Text(format!("{letter}: {label}{title} ({file})")));
    }
    if !file.settings.is_empty() {
        let settings = Table::from_rows("Differences between the studies.", &file.settings)
            .text("what differs", |setting| &setting.what)
            .text("A", |setting| setting.a.as_deref().unwrap_or("–"))
            .text("B", |setting| setting.b.as_deref().unwrap_or("–"));
        parts.push(settings.into());
    }
    for (what, sided) in [("outputs", &file.outputs_left_out), ("factors", &file.factors_left_out)] {
        for (side, names) in [("A", &sided.a), ("B", &sided.b)].into_iter().filter(|(_, names)| !names.is_empty()) {
            parts.push(Part::Text(format!("{what} only in {side}: {}", names.join(", "))));
        }
    }
    parts
}

fn output_parts(output: &ComparedOutput) -> Vec<Part> {
    let mut parts = Vec::new();
    for (letter, reason) in ["A", "B"].into_iter().zip(&output.reasons) {
        parts.extend(reason.as_ref().map(|reason| Part::no_indices(format!("There are none in {letter}: {reason}."))));
    }
    let moments = [("Mean", output.mean, output.mean_interval), ("Standard deviation", output.sd, [None; 2])];
    for (what, of, [of_a, of_b]) in moments {
        if let [Some(a), Some(b)] = of {
            parts.push(Part::Text(format!("{what}: A {}, B {}.", moment(a, of_a), moment(b, of_b))));
        }
    }
    // Side by side they would be wider than a page.
    parts.push(index_table(output, "First-order index S_1", "S_1", |factor| &factor.first_order));
    parts.push(index_table(output, "Total index S_T", "S_T", |factor| &factor.total));
    parts
}

fn moment(estimate: f64, interval: Option<Interval>) -> String {
    match interval {
        Some(_) => give_or_take(Estimate { estimate, interval }),
        None => significant(estimate),
    }
}

/// A choice of one of the indices of a factor.
type IndexOf = fn(&ComparedFactor) -> &ComparedIndex;

fn index_table(output: &ComparedOutput, what: &str, symbol: &str, of: IndexOf) -> Part {
    let caption = format!(
        "{what} in both, with the half width of its 95 % interval, and the difference; a star marks differences whose interval \
         excludes 0."
    );
    Table::from_rows(caption, &output.factors)
        .text("factor", |factor| format!("{}{}", if factor.group { "group " } else { "" }, name(&factor.name)))
        .number(format!("{symbol} of A"), |factor| of(factor).a)
        .number(format!("{symbol} of B"), |factor| of(factor).b)
        .number("B − A", |factor| {
            let ComparedIndex { difference, differs, .. } = of(factor);
            or_dash(*difference, give_or_take) + if *differs == Some(true) { " *" } else { "" }
        })
        .into()
}

/// Says which factor has the largest total index in each, as far as intervals show, without output and full stop.
fn leaders(output: &ComparedOutput) -> String {
    match (leaders_of(output, |total| total.a), leaders_of(output, |total| total.b)) {
        (Some(a), Some(b)) if a == b => format!("{a} in both"),
        (Some(a), Some(b)) => format!("{a} in A; {b} in B"),
        _ => "one of the results has no indices".to_owned(),
    }
}

/// Says which factor has the largest total index in one of them; `None` if it has no indices.
fn leaders_of(output: &ComparedOutput, side: fn(&ComparedIndex) -> Option<Estimate>) -> Option<String> {
    let mut contenders = Vec::new();
    for factor in single_factors(output) {
        contenders.extend(side(&factor.total).map(|total| Contender::new(name(&factor.name), total)));
    }
    let leaders = leading::leaders(&contenders);
    let names: Vec<&str> = leaders.iter().map(|&place| contenders[place].label.as_str()).collect();
    match &names[..] {
        [] => None,
        [one] => Some(format!("{one} has the largest total index")),
        several => Some(format!("{} cannot be distinguished by their total indices", listed(several))),
    }
}

/// Explains the stars and how reliable they are.
fn legend(file: &ComparisonFile) -> String {
    let factors = file.outputs.iter().flat_map(|output| &output.factors);
    let indices: Vec<&ComparedIndex> = factors.flat_map(|factor| [&factor.first_order, &factor.total]).collect();
    let compared = indices.iter().filter(|index| index.differs.is_some()).count();
    if compared == 0 {
        return "There are no intervals: the errors of the differences are unknown.".to_owned();
    }
    let differing = indices.iter().filter(|index| index.differs == Some(true)).count();
    let mut text = format!(
        "A star marks a difference whose 95 % interval excludes 0: {differing} of {compared}; chance alone gives \
         about one in twenty."
    );
    if indices.iter().all(|index| index.a == index.b) {
        text.push_str(" All indices are the same, to the last bit.");
    } else if file.shared_points {
        text.push_str(
            " Both use the same points, so their errors are correlated: the intervals of differences may be too \
             wide.",
        );
    }
    text
}

/// Returns a line per output, factor or group, and index.
fn all_indices(file: &ComparisonFile) -> Table {
    let factors = file.outputs.iter().flat_map(|output| output.factors.iter().map(move |factor| (output, factor)));
    let rows = factors.flat_map(|(output, factor)| {
        [("first_order", &factor.first_order), ("total", &factor.total)].map(|index| (output, factor, index))
    });
    Table::from_rows("", rows)
        .file("output", |(output, ..)| &output.name)
        .file("kind", |(_, factor, _)| if factor.group { "group" } else { "factor" })
        .file("name", |(_, factor, _)| &factor.name)
        .file("index", |(.., (name, _))| name)
        .file_estimate("a", |(.., (_, index))| index.a)
        .file_estimate("b", |(.., (_, index))| index.b)
        .file_estimate("difference", |(.., (_, index))| index.difference)
        .file("differs", |(.., (_, index))| index.differs)
        .into()
}

/// Draws the indices side by side. Of more than 20 factors, those with the largest total indices in either result.
pub(super) fn side_by_side(file: &ComparisonFile, output: &ComparedOutput) -> Chart {
    let factors = single_factors(output);
    let kinds: [(&str, IndexOf); 2] =
        [("First-order indices", |factor| &factor.first_order), ("Total indices", |factor| &factor.total)];
    let panels = kinds.map(|(title, of)| {
        let series = [
            (Series::new(&file.a.label, Colour::Series(1)), factors.iter().map(|factor| of(factor).a).collect()),
            (Series::new(&file.b.label, Colour::Series(0)), factors.iter().map(|factor| of(factor).b).collect()),
        ];
        index_panel(INDEX, names(&factors), series, INDICES, &keys(&factors)).titled(title)
    });
    let title = format!("Indices of {}: {} and {}", name(&output.name), file.a.label, file.b.label);
    Chart::new(title, caption(output)).side_by_side().panels(panels)
}

/// Draws the differences.
pub(super) fn differences(file: &ComparisonFile, output: &ComparedOutput) -> Chart {
    let factors = single_factors(output);
    let shared = if file.shared_points { " Both use the same points: the intervals may be too wide." } else { "" };
    let first_order = factors.iter().map(|factor| factor.first_order.difference).collect();
    let total = factors.iter().map(|factor| factor.total.difference).collect();
    let label = "difference: parts of the variance";
    let title = format!("Indices of {}: {} minus {}", name(&output.name), file.b.label, file.a.label);
    let (names, keys) = (names(&factors), keys(&factors));
    let panel = index_panel(label, names, both_orders(first_order, total), DIFFERENCES, &keys);
    Chart::new(title, caption(output) + shared).panels([panel])
}

/// Returns the factors that are drawn; groups are not.
fn single_factors(output: &ComparedOutput) -> Vec<&ComparedFactor> {
    output.factors.iter().filter(|factor| !factor.group).collect()
}

fn names(factors: &[&ComparedFactor]) -> Vec<String> {
    factors.iter().map(|factor| name(&factor.name)).collect()
}

/// Returns the sort keys of both charts: the larger total index.
fn keys(factors: &[&ComparedFactor]) -> Vec<f64> {
    let totals = factors.iter().map(|factor| [factor.total.a, factor.total.b].into_iter().flatten());
    totals.map(|totals| totals.map(|total| total.estimate).fold(0.0, f64::max)).collect()
}

/// Says how many differences exceed the errors, and what is not drawn.
fn caption(output: &ComparedOutput) -> String {
    if let Some(reason) = output.reasons.iter().flatten().next() {
        return format!("No differences of {}: {reason}.", name(&output.name));
    }
    let singles = single_factors(output);
    let sure = singles.iter().filter(|factor| factor.total.differs == Some(true)).count();
    format!(
        "{sure} of {} total indices differ by more than the errors of both.{}",
        singles.len(),
        not_drawn(singles.len(), MAX_BARS)
    )
}
