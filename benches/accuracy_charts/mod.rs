//! The charts of `docs/accuracy/`.

use apportion::design::Sampler;
use apportion::estimate::{FirstOrder, Total};
use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Spacing, Stroke};

use super::{Curve, Formula, SEEDS};

/// Functions that have a panel.
const SHOWN: [&str; 4] = ["ishigami", "product", "sobol-g", "steps"];

/// Whether it is what a study uses that asks for nothing, or for rows BA.
pub fn is_default(formula: Formula) -> bool {
    let (first, total) =
        ([FirstOrder::SaltelliPooled, FirstOrder::Azzini2021], [Total::JansenPooled, Total::Azzini2021]);
    match formula {
        Formula::First(estimator) => first.contains(&estimator),
        Formula::Total(estimator) => total.contains(&estimator),
    }
}

fn axis(label: &str) -> Axis {
    Axis::new(label, "").spaced(Spacing::Logarithmic)
}

fn panels(all: &[Curve], x: &str, line: impl Fn(&Curve) -> Option<Mark>) -> Vec<Panel> {
    let panel = |function: &&str| {
        let of_function: Vec<&Curve> = all.iter().filter(|curve| curve.function == *function).collect();
        Panel::new(axis(x), axis("RMSE"))
            .titled(format!("{function} ({})", of_function[0].kind))
            .with(of_function.into_iter().filter_map(&line))
    };
    SHOWN.iter().map(panel).collect()
}

/// The default estimators without companion rows, by sampler.
fn samplers(all: &[Curve]) -> Chart {
    let line = |curve: &Curve| {
        let stroke = match curve.formula {
            Formula::First(FirstOrder::SaltelliPooled) => Stroke::SolidWithPoints,
            Formula::Total(Total::JansenPooled) => Stroke::Dashed,
            _ => return None,
        };
        let colour = match curve.sampler {
            Sampler::Sobol => Colour::Series(0),
            Sampler::Random => Colour::Series(1),
            Sampler::LatinHypercube => Colour::Series(6),
        };
        let name = format!("{}, {}", curve.sampler.name(), curve.formula.index());
        Some(Series::new(name, colour).stroke(stroke).line(curve.points.clone()))
    };
    let caption = format!(
        "Root mean square error over the factors and {SEEDS} seeds against the number of base points. By \
         the default estimators."
    );
    Chart::new("Error of the indices by sampler", caption).panels(panels(all, "Base points", line))
}

/// The estimators over mixtures of variances, one for each index.
const POOLED: [&str; 2] = ["saltelli-pooled", "jansen-pooled"];

/// The series of an estimator: the stroke tells the family of its formula.
fn series(name: &str) -> Series {
    let families = [
        (Stroke::Dotted, ["sobol-1993", "homma-saltelli-1996", "saltelli-2002", "sobol-2007", ""]),
        (Stroke::Dashed, ["martinez-2011", "glen-isaacs-2012", "janon-monod-2014", "", ""]),
        (Stroke::SolidWithPoints, ["saltelli-2010", "jansen-1999", "azzini-2021", POOLED[0], ""]),
        (Stroke::SolidWithPoints, ["", "", "", "", POOLED[1]]),
    ];
    let colours = [0, 1, 2, 4, 6].map(Colour::Series);
    let place =
        |(stroke, names): &(Stroke, [&str; 5])| Some((colours[names.iter().position(|n| *n == name)?], *stroke));
    let (colour, stroke) = families.iter().find_map(place).unwrap_or((Colour::Reference, Stroke::Solid));
    Series::new(name, colour).stroke(stroke)
}

/// All estimators of one kind of index on Sobol' points, against what they cost.
fn estimators(all: &[Curve], index: &str) -> Chart {
    let line = |curve: &Curve| {
        let shown = curve.sampler == Sampler::Sobol && curve.formula.index() == index;
        let points = curve.points.iter().map(|(n, error)| (n * curve.runs_per_point as f64, *error)).collect();
        shown.then(|| series(curve.formula.name()).line(points))
    };
    let caption = format!(
        "Root mean square error over the factors and {SEEDS} seeds against the model runs of a study that asks for \
         this estimator alone, 2^6 to 2^14 base points. Dotted: products of outputs as published; dashed: \
         correlations; full: products of differences."
    );
    let title = format!("Error of {index} indices on Sobol' points by estimator");
    Chart::new(title, caption).panels(panels(all, "Model runs", line))
}

/// Draws and writes all charts.
pub fn write(all: &[Curve]) {
    let charts = [
        ("samplers", samplers(all)),
        ("first-order", estimators(all, "first-order")),
        ("total", estimators(all, "total")),
    ];
    for (name, chart) in charts {
        super::write(&format!("{name}.svg"), chart.svg().as_bytes());
    }
}
