//! Claims about the dimensions of the cantilever: 8 to 11.

use apportion_afm::{Failure, FrictionLaw, Options, Scene};

use super::context::{ClaimContext, Sizes, Sweep, closed, exact};
use super::curve::Curve;
use super::judge::{Answer, change, nano, number};
use crate::reproduce::studies::FRICTIONS;

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
type CurveWords = fn(&Curve) -> String;

/// Checks a claim about the shape of the curves of the closed formulas along a factor, and describes the curves.
fn shaped(
    context: &ClaimContext<'_>,
    factor: &str,
    shape: fn(&Curve) -> bool,
    words: CurveWords,
) -> anyhow::Result<Answer> {
    let sweep = context.over(factor);
    let parts = context.parts_under(
        &FRICTIONS,
        "",
        |_| context.sizes.points,
        |law, scene| Ok(shape(&context.curve(&sweep, scene, &closed(law))?)),
    )?;
    let words = [
        ("sweep", sweep.words()),
        ("curves", nominal_curves(context, &sweep, closed, words)?),
        ("closed", closed_setting(context, &sweep)?),
        ("steepening", change(STEEPENING)),
        ("straight", change(STRAIGHT)),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Describes the nominal curve under each friction model.
pub(super) fn nominal_curves(
    context: &ClaimContext<'_>,
    sweep: &Sweep,
    options: OptionsOf,
    words: CurveWords,
) -> Result<String, Failure> {
    let mut curves = Vec::new();
    for friction in FRICTIONS {
        let curve = context.curve(sweep, &Scene::default(), &options(friction.law))?;
        curves.push(format!("{} ({})", words(&curve), friction.name));
    }
    Ok(curves.join(", "))
}

/// Describes the setting of a claim about closed formulas along a sweep, ending in a semicolon.
pub(super) fn closed_setting(context: &ClaimContext<'_>, sweep: &Sweep) -> Result<String, Failure> {
    let mut farthest = 0.0_f64;
    for law in FRICTIONS.map(|friction| friction.law) {
        let ends = Sweep { count: 3, ..*sweep };
        let formula = context.curve(&ends, &Scene::default(), &closed(law))?;
        let geometry = context.curve(&ends, &Scene::default(), &exact(law))?;
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
        context.sizes.points
    ))
}

pub(super) fn from_to(curve: &Curve) -> String {
    format!("from {} to {}", nano(curve.first(), "N"), nano(curve.last(), "N"))
}

/// Checks claim 8.
pub(super) fn length(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    shaped(context, "length", |curve| curve.falls() && curve.steepens() <= STEEPENING, from_to)
}

/// Returns whether a curve rises in a straight line.
pub(super) fn is_linear_rise(curve: &Curve) -> bool {
    curve.rises() && curve.bend().0 <= STRAIGHT
}

/// Checks claim 9.
pub(super) fn width(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    shaped(context, "width", is_linear_rise, straightness)
}

/// Describes the ends of a rise, and its distance from a straight line.
pub(super) fn straightness(curve: &Curve) -> String {
    let (bend, r_squared) = curve.bend();
    let r_squared = if r_squared > 0.999_95 { "above 0.9999".to_owned() } else { format!("{r_squared:.4}") };
    format!("{}, off a straight line by {} of the rise, R² {r_squared}", from_to(curve), change(bend))
}

/// Checks claim 10.
pub(super) fn thickness(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    shaped(
        context,
        "thickness",
        |curve| curve.rises() && curve.elasticity() > 1.0,
        |curve| format!("{}, as t^{}", from_to(curve), number(curve.elasticity(), "")),
    )
}

/// Checks claim 11. The closed form does not contain the height, so only exact geometry can decide.
pub(super) fn height(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    without_effect(context, &Sweep { count: 4, ..context.over("height") }, exact)
}

/// Checks the claim that a sweep does not change F_cr.
pub(super) fn without_effect(context: &ClaimContext<'_>, sweep: &Sweep, options: OptionsOf) -> anyhow::Result<Answer> {
    // Computations without a closed formula are slow, the ramps of LuGre friction most of all.
    let Sizes { slow_points, ramp_points, .. } = context.sizes;
    let parts = context.parts_under(
        &FRICTIONS,
        "",
        |law| if law == FrictionLaw::LuGre { ramp_points } else { slow_points },
        |law, scene| Ok(context.curve(sweep, scene, &options(law))?.spread() < NO_EFFECT),
    )?;
    let unmoved = format!(
        "{} values of the {} from {}, at the nominal scene and at {slow_points} points of the general study's box \
         ({ramp_points} under LuGre friction); no effect means a change by less than {}.",
        sweep.count,
        sweep.parameter.name.replace('_', " "),
        sweep.words(),
        change(NO_EFFECT)
    );
    let curves = nominal_curves(context, sweep, options, |curve| change(curve.spread()))?;
    Ok(Answer::judged(&parts, [("sweep", sweep.words()), ("curves", curves), ("unmoved", unmoved)]))
}
