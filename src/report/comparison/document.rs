//! A comparison as a document.

use super::comparison_charts;
use super::index::ComparedIndex;
use super::record::{ComparedFactor, ComparedOutput, ComparedSide, ComparisonFile};
use crate::report::csv::{Csv, fields};
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Part, Section, Table, Value};
use crate::report::format::{give_or_take, heading, name, significant};
use crate::report::leading::{Contender, Verdict, first_answers};
use crate::report::listed;
use crate::result::json;
use crate::uncertainty::{Estimate, Interval};

/// The document of a comparison, whose files begin with `name`. A star marks the differences whose intervals leave out 0.
pub fn comparison_document(file: &ComparisonFile, files: &str) -> Document {
    let answers = file.outputs.iter().map(|output| format!("For {}, {}.", name(&output.name), leaders(output)));
    let mut lead = first_answers(answers.collect());
    lead.push(legend(file));
    let mut sections = vec![Section::new("sides", "What is compared", sides(file))];
    let mut of_outputs = Vec::new();
    let mut figures = Figure::numbered(comparison_charts(file), (files, ""), &format!("{files}.csv")).into_iter();
    for output in &file.outputs {
        let mut parts = output_parts(output);
        // Two charts for each output: the indices side by side, and their differences.
        parts.extend(figures.by_ref().take(2).map(Part::from));
        of_outputs.push((heading(&output.name, &output.unit), parts));
    }
    sections.extend(Document::sections_of_outputs(of_outputs));
    Document {
        name: files.to_owned(),
        kicker: "Comparison of two results".to_owned(),
        title: format!("{} and {}", file.a.label, file.b.label),
        lead,
        sections,
        footer: format!("Made by apportion {}.", env!("CARGO_PKG_VERSION")),
        files: vec![
            DataFile::new(format!("{files}.json"), json(file)),
            DataFile::new(format!("{files}.csv"), comparison_csv(file)),
        ],
        ..Document::default()
    }
}

/// The two results, in what their studies differ, and what only one of them has.
fn sides(file: &ComparisonFile) -> Vec<Part> {
    let side = |letter: &str, side: &ComparedSide| {
        let title = side.title.as_ref().map_or_else(String::new, |title| format!(", {title}"));
        Part::Text(format!("{letter}: {}{title} ({})", side.label, side.file))
    };
    let mut parts = vec![side("A", &file.a), side("B", &file.b)];
    let said = |value: &Option<String>| Cell::from(value.as_deref().unwrap_or("–"));
    let rows = file.settings.iter().map(|setting| vec![Cell::from(&setting.what), said(&setting.a), said(&setting.b)]);
    let columns = Column::list(3, &["what differs", "A", "B"]);
    let settings = Table::new("In what the studies differ.", columns).with_rows(rows);
    if !settings.rows.is_empty() {
        parts.push(Part::Table(settings));
    }
    for (what, sided) in [("outputs", &file.outputs_left_out), ("factors", &file.factors_left_out)] {
        for (side, names) in [("A", &sided.a), ("B", &sided.b)] {
            if !names.is_empty() {
                parts.push(Part::Text(format!("{what} of {side} alone: {}", names.join(", "))));
            }
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
    for (what, of, intervals) in moments {
        if let [Some(a), Some(b)] = of {
            let said = |estimate: f64, interval: Option<Interval>| {
                let known = interval.map(|_| Estimate { estimate, interval });
                known.map_or_else(|| significant(estimate), give_or_take)
            };
            parts.push(Part::Text(format!("{what}: A {}, B {}.", said(a, intervals[0]), said(b, intervals[1]))));
        }
    }
    // Side by side they would be wider than a page.
    parts.push(index_table(output, "First-order index S_1", ["S_1 of A", "S_1 of B"], |factor| &factor.first_order));
    parts.push(index_table(output, "Total index S_T", ["S_T of A", "S_T of B"], |factor| &factor.total));
    parts
}

fn index_table(
    output: &ComparedOutput,
    what: &str,
    [a, b]: [&str; 2],
    of: fn(&ComparedFactor) -> &ComparedIndex,
) -> Part {
    let row = |factor: &ComparedFactor| {
        let label = if factor.group { format!("group {}", name(&factor.name)) } else { name(&factor.name) };
        [label].into_iter().chain(cells(of(factor))).map(Cell::from).collect()
    };
    let caption = format!(
        "{what} in both, with the half width of its 95 % interval, and the difference; a star marks those whose interval \
         leaves out 0."
    );
    let columns = Column::list(1, &["factor", a, b, "B − A"]);
    Part::Table(Table::new(caption, columns).with_rows(output.factors.iter().map(row)))
}

fn cells(index: &ComparedIndex) -> [String; 3] {
    let said = |estimate: Option<Estimate>| estimate.map_or_else(|| "–".to_owned(), give_or_take);
    let star = if index.differs == Some(true) { " *" } else { "" };
    [said(index.a), said(index.b), said(index.difference) + star]
}

/// Which factor has the largest total index in each, as far as the intervals tell, without the output and a full stop.
fn leaders(output: &ComparedOutput) -> String {
    let leaders = |of: fn(&ComparedFactor) -> Option<Estimate>| -> Option<String> {
        let contender = |factor: &ComparedFactor| Some(Contender::new(name(&factor.name), of(factor)?));
        let known: Vec<Contender> = output.factors.iter().filter(|f| !f.group).filter_map(contender).collect();
        let names: Vec<&str> =
            Verdict::new(&known).leaders().iter().map(|&place| known[place].label.as_str()).collect();
        match &names[..] {
            [] => None,
            [one] => Some(format!("{one} has the largest total index")),
            several => Some(format!("{} cannot be told apart by their total indices", listed(several))),
        }
    };
    match (leaders(|f| f.total.a), leaders(|f| f.total.b)) {
        (Some(a), Some(b)) if a == b => format!("{a} in both"),
        (Some(a), Some(b)) => format!("{a} in A; {b} in B"),
        _ => "one of the results has no indices".to_owned(),
    }
}

/// What the stars mean, and how far they can be trusted.
fn legend(file: &ComparisonFile) -> String {
    let indices = || file.outputs.iter().flat_map(|o| &o.factors).flat_map(|f| [&f.first_order, &f.total]);
    let compared = indices().filter(|index| index.differs.is_some()).count();
    if compared == 0 {
        return "There are no intervals: nothing can be said about the errors of the differences.".to_owned();
    }
    let differing = indices().filter(|index| index.differs == Some(true)).count();
    let mut text = format!(
        "A star marks a difference whose 95 % interval leaves out 0: {differing} of {compared}, where chance alone makes \
         about one in twenty."
    );
    if indices().all(|index| index.a == index.b) {
        text.push_str(" All indices are the same, to the last bit.");
    } else if file.shared_points {
        text.push_str(
            " Both use the same points, so their errors have much in common: the intervals of differences are rather too \
             wide.",
        );
    }
    text
}

/// A comparison as CSV: one line per output, factor or group, and index.
fn comparison_csv(file: &ComparisonFile) -> String {
    let mut fields = fields(&["output", "kind", "name", "index"], &["a", "b", "difference"]);
    fields.push(crate::report::csv::Field::new("differs"));
    let mut csv = Csv::new(fields);
    for output in &file.outputs {
        for factor in &output.factors {
            let kind = if factor.group { "group" } else { "factor" };
            for (name, index) in [("first_order", &factor.first_order), ("total", &factor.total)] {
                let texts = [&output.name, kind, &factor.name, name].map(Value::from);
                let numbers = [index.a, index.b, index.difference].map(Value::Estimate);
                csv.row(texts.into_iter().chain(numbers).chain([index.differs.into()]));
            }
        }
    }
    csv.text()
}
