//! Results as text for a terminal and as CSV for a spreadsheet.

use comfy_table::{CellAlignment, ContentArrangement, ContentLineStyle, LineStyle, Table, TableStyle};

use super::result::{EffectRecord, EstimateRecord, IntervalRecord, OutputRecord, ResultFile};

/// Rules above, under the header and below; nothing between the rows.
const STYLE: TableStyle = TableStyle::new()
    .top_border(LineStyle::new('─', '─', '─', '─'))
    .header_lines(ContentLineStyle::new(' ', ' ', ' '))
    .header_separator(LineStyle::new('─', '─', '─', '─'))
    .content_lines(ContentLineStyle::new(' ', ' ', ' '))
    .bottom_border(LineStyle::new('─', '─', '─', '─'));

/// An empty table in the program's one style, as wide as the terminal allows. Columns stand to the right, as numbers
/// do, but for those whose places are in `text`.
pub fn table(header: &[&str], text: &[usize]) -> Table {
    let mut table = Table::new();
    table.load_style(STYLE).set_content_arrangement(ContentArrangement::Dynamic).set_header(header);
    for (place, column) in table.column_iter_mut().enumerate() {
        if !text.contains(&place) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// A value with its unit, if it has one.
pub fn with_unit(value: f64, unit: &str) -> String {
    let value = significant(value);
    if matches!(unit, "" | "1") { value } else { format!("{value} {unit}") }
}

/// A result as text: for every output its moments, a table of indices, and the warnings; then the validity flags.
pub fn summary(result: &ResultFile) -> String {
    let outputs: Vec<String> = result.outputs.iter().map(output_summary).collect();
    outputs.join("\n") + &validity_summary(result) + &effort_summary(result)
}

/// Which rungs of a ladder of fidelities answered, at what cost, and how wrong they may be.
fn effort_summary(result: &ResultFile) -> String {
    let Some(effort) = &result.effort else { return String::new() };
    let rungs: Vec<String> = effort.rungs.iter().map(|rung| format!("{} {} runs", rung.rung, rung.runs)).collect();
    format!(
        "fidelity: {}; {} evaluations; largest error estimate {:.1e}\n",
        rungs.join(", "),
        effort.evaluations,
        effort.largest_error_estimate
    )
}

/// A share of the runs that is not zero, in percent.
pub fn share_of_runs(share: f64) -> String {
    if share < 0.001 { "less than 0.1 %".to_owned() } else { format!("{:.1} %", 100.0 * share) }
}

/// One line for each validity flag that was raised.
fn validity_summary(result: &ResultFile) -> String {
    let raised = result.validity.iter().filter(|flag| flag.runs > 0);
    raised
        .map(|flag| {
            format!("validity: {} on {} of the runs: {}\n", flag.flag, share_of_runs(flag.share), flag.description)
        })
        .collect()
}

fn output_summary(output: &OutputRecord) -> String {
    let mut text = format!("{} [{}]", output.name, output.unit);
    if let (Some(mean), Some(variance)) = (output.mean, output.variance) {
        text.push_str(&format!(": mean {}, standard deviation {}", significant(mean), significant(variance.sqrt())));
    }
    text.push('\n');
    if let Some(indices) = &output.indices {
        let mut table = table(&["factor", "first order S1", "total ST", "share S1 %", "share ST %"], &[0]);
        for index in indices {
            table.add_row(effect_row(&index.factor, &index.effect));
        }
        for group in output.groups.iter().flatten() {
            table.add_row(effect_row(&format!("group {}", group.group), &group.effect));
        }
        let sum = |sum: Option<EstimateRecord>| sum.map_or_else(String::new, |s| estimate(s, 4));
        table.add_row([
            "sum of factors".to_owned(),
            sum(output.sum_first_order),
            sum(output.sum_total),
            String::new(),
            String::new(),
        ]);
        text.push_str(&format!("{table}\n"));
    }
    if let Some(reason) = &output.reason {
        text.push_str(&format!("no indices: {reason}\n"));
    }
    for warning in &output.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    for failure in &output.failures {
        let inputs: Vec<String> =
            failure.first_inputs.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        text.push_str(&format!(
            "failed: {} runs: {} (first at row {}: {})\n",
            failure.runs,
            failure.reason,
            failure.first_row,
            inputs.join(", ")
        ));
    }
    text
}

fn effect_row(name: &str, effect: &EffectRecord) -> [String; 5] {
    [
        name.to_owned(),
        estimate(effect.first_order, 4),
        estimate(effect.total, 4),
        share(effect.share_first_order, effect.share_first_order_interval),
        share(effect.share_total, effect.share_total_interval),
    ]
}

/// `0.3374 [0.3350, 0.3398]`, or the estimate alone where there is no interval.
pub fn estimate(record: EstimateRecord, digits: usize) -> String {
    match (record.low, record.high) {
        (Some(low), Some(high)) => {
            format!("{} [{}, {}]", fixed(record.estimate, digits), fixed(low, digits), fixed(high, digits))
        }
        _ => fixed(record.estimate, digits),
    }
}

/// A share in percent with its interval, `-` if it does not exist.
pub fn share(share: Option<f64>, interval: Option<IntervalRecord>) -> String {
    match (share, interval) {
        (None, _) => "-".to_owned(),
        (Some(share), None) => fixed(share, 1),
        (Some(share), Some(i)) => format!("{} [{}, {}]", fixed(share, 1), fixed(i.low, 1), fixed(i.high, 1)),
    }
}

/// `value` with `digits` decimals, where a zero has no sign.
pub fn fixed(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text }
}

/// `value` with six significant digits, in exponent form where that is shorter.
pub fn significant(value: f64) -> String {
    const DIGITS: i32 = 6;
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..=DIGITS + 2).contains(&exponent) {
        return format!("{value:.*e}", DIGITS as usize - 1);
    }
    let text = format!("{value:.*}", (DIGITS - 1 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Indices as CSV: one line per output and factor or group; an empty cell where there is no number.
pub fn indices_csv(result: &ResultFile) -> String {
    let mut text = String::from(
        "output,kind,name,first_order,first_order_low,first_order_high,total,total_low,total_high,\
         share_first_order,share_first_order_low,share_first_order_high,share_total,share_total_low,share_total_high\n",
    );
    for output in &result.outputs {
        for index in output.indices.iter().flatten() {
            text.push_str(&csv_line(&output.name, ("factor", &index.factor), &index.effect));
        }
        for group in output.groups.iter().flatten() {
            text.push_str(&csv_line(&output.name, ("group", &group.group), &group.effect));
        }
    }
    text
}

fn csv_line(output: &str, (kind, name): (&str, &str), effect: &EffectRecord) -> String {
    let estimate = |e: EstimateRecord| [Some(e.estimate), e.low, e.high];
    let share = |share, interval: Option<IntervalRecord>| [share, interval.map(|i| i.low), interval.map(|i| i.high)];
    let numbers = [
        estimate(effect.first_order),
        estimate(effect.total),
        share(effect.share_first_order, effect.share_first_order_interval),
        share(effect.share_total, effect.share_total_interval),
    ];
    let cells = numbers.iter().flatten().map(|number| number.map_or_else(String::new, |x| x.to_string()));
    let head = [output, kind, name].map(csv_field);
    let cells: Vec<String> = head.into_iter().chain(cells).collect();
    cells.join(",") + "\n"
}

/// A text as a CSV field, quoted where it must be (RFC 4180).
pub(super) fn csv_field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(significant(489.404_123), "489.404");
        assert_eq!(significant(0.0), "0");
        assert_eq!(significant(1.5e-9), "1.50000e-9");
        assert_eq!(significant(-12_345_678.0), "-12345678");
        assert_eq!(significant(100.0), "100");
        assert_eq!(significant(0.001), "0.001");
        assert_eq!(fixed(-0.00001, 4), "0.0000");
        assert_eq!(fixed(-0.5, 1), "-0.5");
        assert_eq!(csv_field("a, \"b\""), "\"a, \"\"b\"\"\"");
    }
}
