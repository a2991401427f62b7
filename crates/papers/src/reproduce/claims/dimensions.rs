//! Claims about the dimensions of the cantilever: 8 to 11.

use apportion_afm::{Failure, FrictionLaw, Options, Scene};

use super::bench::{Bench, Curve, Sizes, Sweep, closed, exact};
use super::judge::{Answer, change, nano, number};
use crate::reproduce::FRICTIONS;

/// Maximum increase of steepness of a flattening curve from one step to the next, as a share of the mean steepness: it
/// would not be visible in a chart.
const STEEPENING: f64 = 0.01;

/// Maximum distance of a linear rise from the least-squares line, as a share of the rise: about the width of a chart's
/// line.
pub(super) const STRAIGHT: f64 = 0.01;

/// Maximum relative change of F_cr by a factor without effect.
pub(super) const NO_EFFECT: f64 = 0.01;

/// The options for a friction law, by a rung.
type OptionsOf = fn(FrictionLaw) -> Options;
/// A description of a curve.
type CurveWords<'a> = &'a dyn Fn(&Curve) -> String;

/// Checks a claim about the shape of the curves of the closed formulas along a factor, and describes the curves.
fn shaped(bench: &Bench<'_>, factor: &str, shape: fn(&Curve) -> bool, words: CurveWords<'_>) -> anyhow::Result<Answer> {
    let sweep = bench.over(factor);
    let rule = |law, scene: &Scene| Ok(shape(&bench.curve(&sweep, scene, &closed(law))?));
    let holdings = bench.holding_under(&FRICTIONS, "", |_| bench.sizes.points, rule)?;
    let words = [
        ("sweep", sweep.words()),
        ("curves", nominal_curves(bench, &sweep, closed, words)?),
        ("closed", closed_setting(bench, &sweep)?),
        ("steepening", change(STEEPENING)),
        ("straight", change(STRAIGHT)),
    ];
    Ok(Answer::judged(&holdings, words))
}

/// Describes the nominal curve under each friction model.
pub(super) fn nominal_curves(
    bench: &Bench<'_>,
    sweep: &Sweep,
    options: OptionsOf,
    words: CurveWords<'_>,
) -> Result<String, Failure> {
    let each: Result<Vec<String>, Failure> = FRICTIONS
        .iter()
        .map(|friction| {
            let curve = bench.curve(sweep, &Scene::default(), &options(friction.law))?;
            Ok(format!("{} ({})", words(&curve), friction.name))
        })
        .collect();
    Ok(each?.join(", "))
}

/// Describes the setting of a claim about closed formulas along a sweep, ending in a semicolon.
pub(super) fn closed_setting(bench: &Bench<'_>, sweep: &Sweep) -> Result<String, Failure> {
    let mut farthest = 0.0_f64;
    for law in FRICTIONS.map(|friction| friction.law) {
        let ends = Sweep { count: 3, ..*sweep };
        let formula = bench.curve(&ends, &Scene::default(), &closed(law))?;
        let geometry = bench.curve(&ends, &Scene::default(), &exact(law))?;
        for (a, b) in formula.y.iter().zip(&geometry.y) {
            farthest = farthest.max((a / b - 1.0).abs());
        }
    }
    Ok(format!(
        "Closed form (exact geometry is within {} of it at the nominal scene), JKR; {} values of the {} from {}, at the \
         nominal scene and at {} points of the general study's box;",
        change(farthest),
        sweep.count,
        sweep.parameter.name.replace('_', " "),
        sweep.words(),
        bench.sizes.points
    ))
}

pub(super) fn from_to(curve: &Curve) -> String {
    format!("from {} to {}", nano(curve.first(), "N"), nano(curve.last(), "N"))
}

/// Checks claim 8.
pub(super) fn length(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    shaped(bench, "length", |curve| curve.falls() && curve.steepens() <= STEEPENING, &from_to)
}

/// Returns whether a curve rises in a straight line.
pub(super) fn is_linear_rise(curve: &Curve) -> bool {
    curve.rises() && curve.bend().0 <= STRAIGHT
}

/// Checks claim 9.
pub(super) fn width(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    shaped(bench, "width", is_linear_rise, &straightness)
}

/// Describes the ends of a rise, and its distance from a straight line.
pub(super) fn straightness(curve: &Curve) -> String {
    let (bend, r_squared) = curve.bend();
    let r_squared = if r_squared > 0.999_95 { "above 0.9999".to_owned() } else { format!("{r_squared:.4}") };
    format!("{}, off a straight line by {} of the rise, R² {r_squared}", from_to(curve), change(bend))
}

/// Checks claim 10.
pub(super) fn thickness(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let words = |curve: &Curve| format!("{}, as t^{}", from_to(curve), number(curve.elasticity(), ""));
    shaped(bench, "thickness", |curve| curve.rises() && curve.elasticity() > 1.0, &words)
}

/// Checks claim 11. The closed form does not contain the height, so only exact geometry can decide.
pub(super) fn height(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    without_effect(bench, &Sweep { count: 4, ..bench.over("height") }, exact)
}

/// Checks the claim that a sweep does not change F_cr.
pub(super) fn without_effect(bench: &Bench<'_>, sweep: &Sweep, options: OptionsOf) -> anyhow::Result<Answer> {
    let rule = |law, scene: &Scene| Ok(bench.curve(sweep, scene, &options(law))?.spread() < NO_EFFECT);
    // Computations without a closed formula are slow, the ramps of LuGre friction most of all.
    let Sizes { slow_points, ramp_points, .. } = bench.sizes;
    let points = |law| if law == FrictionLaw::LuGre { ramp_points } else { slow_points };
    let holdings = bench.holding_under(&FRICTIONS, "", points, rule)?;
    let unmoved = format!(
        "{} values of the {} from {}, at the nominal scene and at {slow_points} points of the general study's box \
         ({ramp_points} under LuGre friction); no effect means a change by less than {}.",
        sweep.count,
        sweep.parameter.name.replace('_', " "),
        sweep.words(),
        change(NO_EFFECT)
    );
    let curves = nominal_curves(bench, sweep, options, &|curve| change(curve.spread()))?;
    Ok(Answer::judged(&holdings, [("sweep", sweep.words()), ("curves", curves), ("unmoved", unmoved)]))
}
