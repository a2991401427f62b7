//! Claims about the dimensions of the cantilever: 8 to 11.

use super::bench::{Bench, LAWS, Sweep, closed, exact};
use super::curve::Curve;
use super::judge::Holding;
use super::numbers::{change, nano, number};
use super::{Claim, ClaimsError};
use apportion::afm::{Failure, FrictionLaw, Options, Scene};

/// A curve flattens if no step is steeper than the one before by more than this share of the mean steepness: what would
/// not be seen in a chart.
const STEEPENING: f64 = 0.01;

/// A rise is linear if no point is farther from the straight line of least squares than this share of the rise: about
/// the width of a chart's line.
pub(super) const STRAIGHT: f64 = 0.01;

/// A factor has no effect if it changes F_cr by less than this share.
pub(super) const NO_EFFECT: f64 = 0.01;

/// The options under a friction law: those of a rung.
type OptionsOf = fn(FrictionLaw) -> Options;
/// A curve in words.
type Words<'a> = &'a dyn Fn(&Curve) -> String;

pub(super) fn claims(bench: &Bench<'_>) -> Result<Vec<Claim>, ClaimsError> {
    Ok(vec![length(bench)?, width(bench)?, thickness(bench)?, height(bench)?])
}

/// For each friction model of the papers, whether its curve along a sweep has a shape.
fn under_each(bench: &Bench<'_>, sweep: &Sweep, shape: &dyn Fn(&Curve) -> bool) -> Result<Vec<Holding>, Failure> {
    LAWS.iter()
        .map(|(law, name)| {
            let rule = |scene: &Scene| Ok(shape(&bench.curve(sweep, scene, &closed(*law))?));
            bench.holding(*name, bench.sizes.points, &rule)
        })
        .collect()
}

/// The nominal curve under each friction model, put into words and joined.
pub(super) fn nominal_curves(
    bench: &Bench<'_>,
    sweep: &Sweep,
    options: OptionsOf,
    words: Words<'_>,
) -> Result<String, Failure> {
    let each: Result<Vec<String>, Failure> = LAWS
        .iter()
        .map(|(law, name)| Ok(format!("{} ({name})", words(&bench.curve(sweep, &Scene::default(), &options(*law))?))))
        .collect();
    Ok(each?.join(", "))
}

/// The setting of a claim about closed formulas along a sweep, in words that end in a semicolon.
pub(super) fn closed_setting(bench: &Bench<'_>, sweep: &Sweep) -> Result<String, Failure> {
    let mut farthest = 0.0_f64;
    for (law, _) in LAWS {
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
fn length(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let sweep = bench.over("length")?;
    let holdings = under_each(bench, &sweep, &|curve| curve.falls() && curve.steepens() <= STEEPENING)?;
    let ends = nominal_curves(bench, &sweep, closed, &from_to)?;
    Ok(Claim {
        number: 8,
        source: "CHK fig. 6, LG fig. 2a",
        statement: "F_cr falls with the cantilever's length, ever more slowly.",
        finding: format!("From {} in length F_cr falls {ends} at the nominal scene.", sweep.words()),
        setting: format!(
            "{} falling at every step, and no step steeper than the one before by more than {} of the mean slope.",
            closed_setting(bench, &sweep)?,
            change(STEEPENING)
        ),
        figures: &["chk-6", "lg-2a"],
        ..Claim::judged(&holdings)
    })
}

/// Claim 9.
fn width(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let sweep = bench.over("width")?;
    let holdings = under_each(bench, &sweep, &|curve| curve.rises() && curve.bend().0 <= STRAIGHT)?;
    let bends = nominal_curves(bench, &sweep, closed, &straightness)?;
    Ok(Claim {
        number: 9,
        source: "CHK fig. 7, LG fig. 2b",
        statement: "F_cr rises linearly with the cantilever's width.",
        finding: format!("From {} in width F_cr rises {bends} at the nominal scene.", sweep.words()),
        setting: format!(
            "{} linear means rising and nowhere farther from the straight line of least squares than {} of the rise.",
            closed_setting(bench, &sweep)?,
            change(STRAIGHT)
        ),
        figures: &["chk-7", "lg-2b"],
        ..Claim::judged(&holdings)
    })
}

/// The ends of a rise, and how far it is from straight.
pub(super) fn straightness(curve: &Curve) -> String {
    let (bend, r_squared) = curve.bend();
    let r_squared = if r_squared > 0.999_95 { "above 0.9999".to_owned() } else { format!("{r_squared:.4}") };
    format!("{}, off a straight line by {} of the rise, R² {r_squared}", from_to(curve), change(bend))
}

/// Claim 10.
fn thickness(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let sweep = bench.over("thickness")?;
    let holdings = under_each(bench, &sweep, &|curve| curve.rises() && curve.elasticity() > 1.0)?;
    let powers = nominal_curves(bench, &sweep, closed, &|curve| {
        format!("{}, as t^{}", from_to(curve), number(curve.elasticity(), ""))
    })?;
    Ok(Claim {
        number: 10,
        source: "CHK fig. 8, LG fig. 2c",
        statement: "F_cr rises steeply with the cantilever's thickness.",
        finding: format!("From {} in thickness F_cr rises {powers} at the nominal scene.", sweep.words()),
        setting: format!(
            "{} steep means rising at every step, and over the range by more than in proportion (mean elasticity above 1).",
            closed_setting(bench, &sweep)?
        ),
        figures: &["chk-8", "lg-2c"],
        ..Claim::judged(&holdings)
    })
}

/// Claim 11. The closed form has no height in it, so that only exact geometry can say anything.
fn height(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let sweep = Sweep { count: 4, ..bench.over("height")? };
    let holdings = without_effect(bench, &sweep, exact)?;
    let spreads = nominal_curves(bench, &sweep, exact, &|curve| change(curve.spread()))?;
    Ok(Claim {
        number: 11,
        source: "CHK fig. 9, LG fig. 2d",
        statement: "The height of the tip has no effect on F_cr.",
        finding: format!("A height of {} changes F_cr by {spreads} at the nominal scene.", sweep.words()),
        setting: effect_setting(bench, &sweep, "Exact geometry"),
        figures: &["chk-9", "lg-2d"],
        ..Claim::judged(&holdings)
    })
}

/// For each friction model, whether a sweep leaves F_cr as it is.
pub(super) fn without_effect(bench: &Bench<'_>, sweep: &Sweep, options: OptionsOf) -> Result<Vec<Holding>, Failure> {
    LAWS.iter()
        .map(|(law, name)| {
            let rule = |scene: &Scene| Ok(bench.curve(sweep, scene, &options(*law))?.spread() < NO_EFFECT);
            bench.holding(*name, points_of(bench, *law), &rule)
        })
        .collect()
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
