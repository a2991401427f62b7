//! Sweeps as JSON, CSV, text and charts.

mod charts;
mod record;

pub use charts::{sweep_charts, sweep_suffixes};
pub use record::{
    AgainstRecord, CurveRecord, FactorSweepRecord, GapRecord, NominalRecord, OutputCurveRecord, SweepEffectRecord,
    SweepFile, SweepProvenance, build_sweep,
};

use super::asked::{cell, csv_text, json, short, short_with_unit, validity_lines};
use super::table;

/// The sweeps as JSON text, ending in a newline.
pub fn sweep_json(file: &SweepFile) -> String {
    json(file)
}

/// The sweeps as CSV: one line per factor, curve, output and value; an empty cell where there is no number, with the
/// reason in the last column.
pub fn sweep_csv(file: &SweepFile) -> String {
    let header = "factor,unit,value,against,against_unit,against_value,output,output_unit,output_value,failure";
    let mut rows = vec![header.split(',').map(str::to_owned).collect::<Vec<_>>()];
    for sweep in &file.sweeps {
        for curve in &sweep.curves {
            let against = curve.against.as_ref();
            let text = |read: fn(&AgainstRecord) -> &String| against.map_or_else(String::new, |a| read(a).clone());
            for output in &curve.outputs {
                for (place, (x, y)) in sweep.values.iter().zip(&output.values).enumerate() {
                    let gap = output.gaps.iter().find(|gap| gap.place == place);
                    rows.push(vec![
                        sweep.factor.clone(),
                        sweep.unit.clone(),
                        sweep.labels.as_ref().map_or_else(|| cell(Some(*x)), |labels| labels[place].clone()),
                        text(|a| &a.factor),
                        text(|a| &a.unit),
                        against.map_or_else(String::new, |a| a.label.clone().unwrap_or_else(|| cell(Some(a.value)))),
                        output.name.clone(),
                        output.unit.clone(),
                        cell(*y),
                        gap.map_or_else(String::new, |gap| gap.reason.clone()),
                    ]);
                }
            }
        }
    }
    csv_text(rows)
}

/// The sweeps as text: for every output a table of how far each factor moves it, widest first, and the failures.
pub fn sweep_summary(file: &SweepFile) -> String {
    let mut text = String::new();
    for (number, nominal) in file.nominal.iter().enumerate() {
        text.push_str(&match (nominal.value, &nominal.reason) {
            (Some(value), _) => format!(
                "{} = {} where every factor is nominal\n",
                nominal.output,
                short_with_unit(value, &nominal.unit)
            ),
            (None, reason) => format!(
                "{} has no value where every factor is nominal: {}\n",
                nominal.output,
                reason.as_deref().unwrap_or("the run failed")
            ),
        });
        let header = ["factor", "from", "to", "output from", "to", "least", "largest", "moves by %", "elasticity"];
        let mut table = table(&header, &[0]);
        let mut sweeps: Vec<(&FactorSweepRecord, &SweepEffectRecord)> =
            file.sweeps.iter().filter_map(|sweep| Some((sweep, sweep.effects.get(number)?))).collect();
        sweeps.sort_by(|a, b| b.1.width().total_cmp(&a.1.width()));
        for (sweep, effect) in sweeps {
            let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), short);
            table.add_row([
                sweep.factor.clone(),
                sweep.value_in_words(0),
                sweep.value_in_words(sweep.values.len().saturating_sub(1)),
                number(effect.first),
                number(effect.last),
                number(effect.low),
                number(effect.high),
                number(effect.percent),
                number(effect.elasticity),
            ]);
        }
        text.push_str(&format!("{table}\n"));
    }
    for sweep in &file.sweeps {
        for line in gap_lines(sweep) {
            text.push_str(&format!("failed: {line}\n"));
        }
    }
    text + &validity_lines(&file.validity)
}

/// For each output and reason: at how many points of the sweep it has no value, over all curves.
fn gap_lines(sweep: &FactorSweepRecord) -> Vec<String> {
    let mut counts: Vec<(&str, &str, usize)> = Vec::new();
    for output in sweep.curves.iter().flat_map(|curve| &curve.outputs) {
        for gap in &output.gaps {
            match counts.iter_mut().find(|(name, reason, _)| *name == output.name && *reason == gap.reason) {
                Some((_, _, count)) => *count += 1,
                None => counts.push((&output.name, &gap.reason, 1)),
            }
        }
    }
    let points = sweep.values.len() * sweep.curves.len();
    let line = |(name, reason, count): (&str, &str, usize)| {
        format!("{name} at {count} of {points} points of {}: {reason}", sweep.factor)
    };
    counts.into_iter().map(line).collect()
}
