//! The charts of a screening: mu* against sigma, and mu* with its intervals.

use super::super::Drawing;
use super::super::chart::{
    Axis, Chart, Guide, Range, RangeBars, RangeRow, Role, ScatterChart, ScatterPoint, ScatterSeries,
};
use super::super::format::{axis_unit, sentence, short_with_unit, the, words};
use super::super::leading::{Contender, may_lead, names};
use super::{FactorScreeningRecord, OutputScreeningRecord, ScreeningFile};
use crate::names::file_stems;
use crate::screening::{FIXABLE, Reading};

/// Most bars in a chart; the rest are counted in its caption.
const MOST_BARS: usize = 40;

/// The charts of every output: `-screen` (mu* against sigma) and `-screen-bars`, with the output's name in between
/// where there are several.
pub fn screening_charts(file: &ScreeningFile) -> Vec<Drawing> {
    let names: Vec<&str> = file.outputs.iter().map(|output| output.name.as_str()).collect();
    let drawn = file.outputs.iter().zip(screening_suffixes(&names)).flat_map(|(output, [suffix, of_bars])| {
        [
            Drawing { chart: Chart::Scatter(scatter(file, output)), suffix },
            Drawing { chart: Chart::Ranges(bars(file, output)), suffix: of_bars },
        ]
    });
    drawn.collect()
}

/// What the files of the two charts of each output end in, after the study's name.
pub fn screening_suffixes(outputs: &[&str]) -> Vec<[String; 2]> {
    let stems = file_stems("-screen", outputs, &["", "-bars"]);
    stems.into_iter().map(|stem| [stem.clone(), format!("{stem}-bars")]).collect()
}

/// A reading's colour and shape: the calmest for the plainest.
fn role(reading: Option<Reading>) -> Role {
    match reading {
        Some(Reading::NonLinearOrInteracting) => Role::Other(0),
        Some(Reading::AlmostMonotone) => Role::Other(1),
        Some(Reading::Monotone) => Role::Other(2),
        Some(Reading::Linear) => Role::Other(3),
        None => Role::Reference,
    }
}

fn title(file: &ScreeningFile, output: &OutputScreeningRecord) -> String {
    format!("{}: screening of {}", file.study.headline(), the(&output.name))
}

fn axis(symbol: &str, output: &OutputScreeningRecord) -> Axis {
    Axis { label: symbol.to_owned(), unit: axis_unit(&output.unit), ..Axis::default() }
}

fn scatter(file: &ScreeningFile, output: &OutputScreeningRecord) -> ScatterChart {
    let readings = Reading::ALL.iter().rev().map(|&reading| Some(reading));
    let series = readings.chain([None]).map(|reading| {
        let own = output.factors.iter().filter(|factor| factor.reading == reading && factor.mu_star.is_some());
        let name = reading.map_or("no effect", Reading::words).to_owned();
        let point = |factor: &FactorScreeningRecord| ScatterPoint {
            x: factor.mu_star.map_or(f64::NAN, |estimate| estimate.estimate),
            y: factor.sigma.map_or(f64::NAN, |estimate| estimate.estimate),
            // Those without effect all lie at the origin; the caption names them.
            label: reading.map_or_else(String::new, |_| words(&factor.factor)),
            ..ScatterPoint::default()
        };
        ScatterSeries { name, role: role(reading), points: own.map(point).collect() }
    });
    let guide = |slope: f64, label: &str| Guide { slope, label: label.to_owned() };
    ScatterChart {
        title: title(file, output),
        caption: format!(
            "Mean size μ* of the elementary effects per full range of each factor, and their standard deviation σ, from \
             {} trajectories. {}{}",
            file.provenance.trajectories,
            leader(output),
            idle(output)
        ),
        x: axis("μ*, mean size of the effects", output),
        y: axis("σ, standard deviation of the effects", output),
        series: series.collect(),
        guides: vec![guide(1.0, "σ = μ*"), guide(0.5, "σ = 0.5 μ*"), guide(0.1, "σ = 0.1 μ*")],
    }
}

fn bars(file: &ScreeningFile, output: &OutputScreeningRecord) -> RangeBars {
    let mut ranked: Vec<&FactorScreeningRecord> = output.factors.iter().collect();
    ranked.sort_by_key(|factor| factor.rank);
    let beyond = match ranked.len().saturating_sub(MOST_BARS) {
        0 => String::new(),
        more => format!(" {more} factors of less effect are not shown."),
    };
    let row = |factor: &&FactorScreeningRecord| {
        let mu_star = factor.mu_star;
        // A bar of no length would still be a colour in the legend.
        let bar = mu_star.filter(|_| factor.reading.is_some()).map(|e| Range {
            role: role(factor.reading),
            from: 0.0,
            to: e.estimate,
        });
        RangeRow {
            name: words(&factor.factor),
            bars: bar.into_iter().collect(),
            interval: mu_star.and_then(|e| e.low.zip(e.high)),
            note: match (mu_star, factor.could_be_fixed) {
                (Some(e), Some(true)) => format!("{}, could be fixed", short_with_unit(e.estimate, &output.unit)),
                (Some(e), _) => short_with_unit(e.estimate, &output.unit),
                (None, _) => String::new(),
            },
        }
    };
    RangeBars {
        title: title(file, output),
        caption: format!(
            "Mean size μ* of the elementary effects. A factor could be fixed where the upper bound of μ* lies below {} % \
             of the largest μ*. {}{beyond}",
            100.0 * FIXABLE,
            leader(output)
        ),
        x: axis("μ*, mean size of the effects per full range of the factor", output),
        reference: None,
        series: Reading::ALL.iter().rev().map(|&reading| (reading.words().to_owned(), role(Some(reading)))).collect(),
        interval_label: "95 % interval".to_owned(),
        rows: ranked.iter().take(MOST_BARS).map(row).collect(),
    }
}

/// Which factors have no effect, if some have one.
fn idle(output: &OutputScreeningRecord) -> String {
    let still = output.factors.iter().filter(|factor| factor.reading.is_none() && factor.mu_star.is_some());
    let names: Vec<String> = still.map(|factor| words(&factor.factor)).collect();
    if names.is_empty() || names.len() == output.factors.len() {
        return String::new();
    }
    format!(" Without effect: {}.", names.join(", "))
}

/// What is seen, in one sentence.
fn leader(output: &OutputScreeningRecord) -> String {
    let contender = |factor: &FactorScreeningRecord| {
        let total = factor.mu_star.filter(|mu_star| mu_star.estimate > 0.0)?;
        Some(Contender { label: the(&factor.factor), first_order: None, total, probability: None })
    };
    let moving: Vec<Contender> = output.factors.iter().filter_map(contender).collect();
    let mu_star = |contender: &Contender| short_with_unit(contender.total.estimate, &output.unit);
    match &may_lead(&moving)[..] {
        [] => "No factor has any effect.".to_owned(),
        [lead] => format!("{} matters most: μ* = {}.", sentence(&moving[*lead].label), mu_star(&moving[*lead])),
        tied => format!("What matters most cannot be told apart, by μ*: {}.", names(&moving, tied, &mu_star)),
    }
}
