//! A comparison as text for a terminal, and as CSV.

use super::index::ComparedIndex;
use super::record::{ComparedFactor, ComparedOutput, ComparedSide, ComparisonFile};
use crate::report::asked::{cell, csv_text};
use crate::report::result::EstimateRecord;
use crate::report::tables::give_or_take;
use crate::report::{significant, table};

/// A comparison as text: what is compared, in what the studies differ, then a table for every output, in which a star
/// marks the differences whose intervals leave out 0.
pub fn comparison_summary(file: &ComparisonFile) -> String {
    let mut text = side("A", &file.a) + &side("B", &file.b);
    if !file.settings.is_empty() {
        let mut rows = table(&["what differs", "A", "B"], &[0, 1, 2]);
        for setting in &file.settings {
            let said = |value: &Option<String>| value.clone().unwrap_or_else(|| "-".to_owned());
            rows.add_row([setting.what.clone(), said(&setting.a), said(&setting.b)]);
        }
        text.push_str(&format!("{rows}\n"));
    }
    for output in &file.outputs {
        text.push('\n');
        text.push_str(&output_summary(output));
    }
    for (what, sided) in [("outputs", &file.outputs_left_out), ("factors", &file.factors_left_out)] {
        for (side, names) in [("A", &sided.a), ("B", &sided.b)] {
            if !names.is_empty() {
                text.push_str(&format!("{what} of {side} alone: {}\n", names.join(", ")));
            }
        }
    }
    text + &legend(file)
}

fn side(letter: &str, side: &ComparedSide) -> String {
    let title = side.title.as_ref().map_or_else(String::new, |title| format!(", {title}"));
    format!("{letter}: {}{title} ({})\n", side.label, side.file)
}

fn output_summary(output: &ComparedOutput) -> String {
    let mut text = format!("{} [{}]: {}\n", output.name, output.unit, leaders(output));
    for (what, [a, b]) in [("mean", output.mean), ("standard deviation", output.sd)] {
        if let (Some(a), Some(b)) = (a, b) {
            text.push_str(&format!("{what}: A {}, B {}\n", significant(a), significant(b)));
        }
    }
    let mut rows = table(&["factor", "S1 of A", "S1 of B", "B - A", "ST of A", "ST of B", "B - A"], &[0]);
    for factor in &output.factors {
        let name = if factor.group { format!("group {}", factor.name) } else { factor.name.clone() };
        let [s1_a, s1_b, s1] = cells(&factor.first_order);
        let [st_a, st_b, st] = cells(&factor.total);
        rows.add_row([name, s1_a, s1_b, s1, st_a, st_b, st]);
    }
    text.push_str(&format!("{rows}\n"));
    for (letter, reason) in ["A", "B"].into_iter().zip(&output.reasons) {
        if let Some(reason) = reason {
            text.push_str(&format!("no indices in {letter}: {reason}\n"));
        }
    }
    text
}

fn cells(index: &ComparedIndex) -> [String; 3] {
    let said = |estimate: Option<EstimateRecord>| estimate.map_or_else(|| "-".to_owned(), give_or_take);
    let star = if index.differs == Some(true) { " *" } else { "" };
    [said(index.a), said(index.b), said(index.difference) + star]
}

/// Which factor has the largest total index in each.
fn leaders(output: &ComparedOutput) -> String {
    let leader = |of: fn(&ComparedFactor) -> Option<EstimateRecord>| {
        let singles = output.factors.iter().filter(|factor| !factor.group);
        let known = singles.filter_map(|factor| Some((factor, of(factor)?.estimate)));
        known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(factor, _)| factor.name.as_str())
    };
    match (leader(|f| f.total.a), leader(|f| f.total.b)) {
        (Some(a), Some(b)) if a == b => format!("{a} has the largest total index in both"),
        (Some(a), Some(b)) => format!("the largest total index is that of {a} in A, that of {b} in B"),
        _ => "one of the results has no indices".to_owned(),
    }
}

/// What the stars mean, and how far they can be trusted.
fn legend(file: &ComparisonFile) -> String {
    let indices = || file.outputs.iter().flat_map(|o| &o.factors).flat_map(|f| [&f.first_order, &f.total]);
    let compared = indices().filter(|index| index.differs.is_some()).count();
    if compared == 0 {
        return "no intervals: nothing can be said about the errors of the differences\n".to_owned();
    }
    let differing = indices().filter(|index| index.differs == Some(true)).count();
    let mut text = format!(
        "* the 95 % interval of the difference leaves out 0: {differing} of {compared}, where chance alone makes about \
         one in twenty\n"
    );
    if indices().all(|index| index.a == index.b) {
        text.push_str("all indices are the same, to the last bit\n");
    } else if file.shared_points {
        text.push_str(
            "both use the same points, so their errors have much in common: the intervals of differences are rather too wide\n",
        );
    }
    text
}

/// A comparison as CSV: one line per output, factor or group, and index, with as many digits as it takes to read the same
/// bits back.
pub fn comparison_csv(file: &ComparisonFile) -> String {
    const HEADER: [&str; 14] = [
        "output",
        "kind",
        "name",
        "index",
        "a",
        "a_low",
        "a_high",
        "b",
        "b_low",
        "b_high",
        "difference",
        "difference_low",
        "difference_high",
        "differs",
    ];
    let mut rows = vec![HEADER.map(str::to_owned).to_vec()];
    for output in &file.outputs {
        for factor in &output.factors {
            let kind = if factor.group { "group" } else { "factor" };
            for (name, index) in [("first_order", &factor.first_order), ("total", &factor.total)] {
                let mut row: Vec<String> = [&output.name, kind, &factor.name, name].map(str::to_owned).to_vec();
                for estimate in [index.a, index.b, index.difference] {
                    row.push(cell(estimate.map(|e| e.estimate)));
                    row.push(cell(estimate.and_then(|e| e.low)));
                    row.push(cell(estimate.and_then(|e| e.high)));
                }
                row.push(index.differs.map_or_else(String::new, |differs| differs.to_string()));
                rows.push(row);
            }
        }
    }
    csv_text(rows)
}
