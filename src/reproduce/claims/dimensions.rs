//! Claims about the dimensions of the cantilever: 8 to 11.

use super::ClaimsError;
use super::bench::{Bench, Sweep, closed, exact};
use super::curve::Curve;
use super::judge::Answer;
use super::judge::Holding;
use super::numbers::{change, nano, number};
use crate::reproduce::FRICTIONS;
use apportion::afm::{Failure, FrictionLaw, Options, Scene};

/// A curve flattens if no step is steeper than the one before by more than this share of the mean steepness: what would
/// not be seen in a chart.
const STEEPENING: f64 = 0.01;

/// A rise is linear if no point is farther from the straight line of least squares than this share of the rise: about
/// the width of a chart's line.
const STRAIGHT: f64 = 0.01;

/// A factor has no effect if it changes F_cr by less than this share.
pub(super) const NO_EFFECT: f64 = 0.01;

/// The options under a friction law: those of a rung.
type OptionsOf = fn(FrictionLaw) -> Options;
/// A curve in words.
type Words<'a> = &'a dyn Fn(&Curve) -> String;

/// A claim about the shape of the curves of the closed formulas along a factor: what it means, what F_cr does from one end to
/// the other, and how the nominal curves are put into words.
fn shaped(
    bench: &Bench<'_>,
    factor: &str,
    shape: fn(&Curve) -> bool,
    (goes, words): (&str, Words<'_>),
    means: &str,
) -> Result<Answer, ClaimsError> {
    let sweep = bench.over(factor)?;
    let rule = |law, scene: &Scene| Ok(shape(&bench.curve(&sweep, scene, &closed(law))?));
    let holdings = bench.holding_under(&FRICTIONS, "", |_| bench.sizes.points, rule)?;
    let curves = nominal_curves(bench, &sweep, closed, words)?;
    Ok(Answer {
        finding: format!("From {} in {factor} F_cr {goes} {curves} at the nominal scene.", sweep.words()),
        setting: format!("{} {means}.", closed_setting(bench, &sweep)?),
        ..Answer::judged(&holdings)
    })
}

/// The nominal curve under each friction model, put into words and joined.
pub(super) fn nominal_curves(
    bench: &Bench<'_>,
    sweep: &Sweep,
    options: OptionsOf,
    words: Words<'_>,
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

/// The setting of a claim about closed formulas along a sweep, in words that end in a semicolon.
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

/// Claim 8.
pub(super) fn length(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let steepening = change(STEEPENING);
    let means = format!(
        "falling at every step, and no step steeper than the one before by more than {steepening} of the mean slope"
    );
    let shape = |curve: &Curve| curve.falls() && curve.steepens() <= STEEPENING;
    shaped(bench, "length", shape, ("falls", &from_to), &means)
}

/// A rise in a straight line.
pub(super) fn is_linear_rise(curve: &Curve) -> bool {
    curve.rises() && curve.bend().0 <= STRAIGHT
}

/// What that means.
pub(super) fn linear_means() -> String {
    let straight = change(STRAIGHT);
    format!(
        "linear means rising and nowhere farther from the straight line of least squares than {straight} of the rise"
    )
}

/// Claim 9.
pub(super) fn width(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    shaped(bench, "width", is_linear_rise, ("rises", &straightness), &linear_means())
}

/// The ends of a rise, and how far it is from straight.
pub(super) fn straightness(curve: &Curve) -> String {
    let (bend, r_squared) = curve.bend();
    let r_squared = if r_squared > 0.999_95 { "above 0.9999".to_owned() } else { format!("{r_squared:.4}") };
    format!("{}, off a straight line by {} of the rise, R² {r_squared}", from_to(curve), change(bend))
}

/// Claim 10.
pub(super) fn thickness(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let words = |curve: &Curve| format!("{}, as t^{}", from_to(curve), number(curve.elasticity(), ""));
    let means =
        "steep means rising at every step, and over the range by more than in proportion (mean elasticity above 1)";
    let shape = |curve: &Curve| curve.rises() && curve.elasticity() > 1.0;
    shaped(bench, "thickness", shape, ("rises", &words), means)
}

/// Claim 11. The closed form has no height in it, so that only exact geometry can say anything.
pub(super) fn height(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let sweep = Sweep { count: 4, ..bench.over("height")? };
    let holdings = without_effect(bench, &sweep, exact)?;
    let spreads = nominal_curves(bench, &sweep, exact, &|curve| change(curve.spread()))?;
    Ok(Answer {
        finding: format!("A height of {} changes F_cr by {spreads} at the nominal scene.", sweep.words()),
        setting: effect_setting(bench, &sweep, "Exact geometry"),
        ..Answer::judged(&holdings)
    })
}

/// For each friction model, whether a sweep leaves F_cr as it is.
pub(super) fn without_effect(bench: &Bench<'_>, sweep: &Sweep, options: OptionsOf) -> Result<Vec<Holding>, Failure> {
    let rule = |law, scene: &Scene| Ok(bench.curve(sweep, scene, &options(law))?.spread() < NO_EFFECT);
    bench.holding_under(&FRICTIONS, "", |law| points_of(bench, law), rule)
}

/// Points of the box for what is not a closed formula under a friction law.
fn points_of(bench: &Bench<'_>, law: FrictionLaw) -> u64 {
    if law == FrictionLaw::LuGre { bench.sizes.ramp_points } else { bench.sizes.slow_points }
}

/// The setting of [`without_effect`] in words.
pub(super) fn effect_setting(bench: &Bench<'_>, sweep: &Sweep, fidelity: &str) -> String {
    format!(
        "{fidelity}, JKR; {} values of the {} from {}, at the nominal scene and at {} points of the general study's \
         box ({} under LuGre friction); no effect means a change by less than {}.",
        sweep.count,
        sweep.parameter.name.replace('_', " "),
        sweep.words(),
        bench.sizes.slow_points,
        bench.sizes.ramp_points,
        change(NO_EFFECT)
    )
}
