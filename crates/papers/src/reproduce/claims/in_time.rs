//! Claims about one scene in time: 1, 2, 3, 5.

use std::ops::RangeInclusive;

use apportion_afm::contact::Contact;
use apportion_afm::history::{History, Sample};
use apportion_afm::{Failure, FrictionLaw, Scene};

use super::context::{ClaimContext, Sweep, closed, parameter};
use super::curve::Curve;
use super::judge::{Answer, change, nano, number};
use super::verdict::Verdict;
use crate::reproduce::figures::{DURATION, PRINTED_SHEAR_MODULUS};
use crate::reproduce::studies::FRICTIONS;

/// Time after which every scene of the box has slipped (s).
const FOREVER: f64 = 1e9;

/// "Near 0.2 s": read from a chart, to a tenth.
const SLIP_TIME: RangeInclusive<f64> = 0.18..=0.22;

/// "-21 nm", printed in whole nanometres: to one nanometre.
const DISPLACEMENT: RangeInclusive<f64> = -22e-9..=-20e-9;

/// "Nearly constant": to one percent.
const NEARLY: f64 = 0.01;

/// Relative change of a contact that no chart shows.
const AS_GOOD_AS_NONE: f64 = 1e-4;

/// Tolerance for rounding between the forces by geometry and by friction.
const ROUNDING: f64 = 1e-9;

/// Checks a half of claim 1: whether a quantity of the scene in time is in a range, with the shear modulus of TS04, and
/// for comparison with that of CHK and LG.
fn half(
    context: &ClaimContext<'_>,
    range: RangeInclusive<f64>,
    quantity: fn(&History) -> Result<f64, Failure>,
    format_value: fn(f64) -> String,
) -> anyhow::Result<Answer> {
    let nominal = Scene::default();
    let printed = Scene { shear_modulus: Some(PRINTED_SHEAR_MODULUS), ..nominal };
    let [ours, theirs] = [nominal, printed].map(|scene| -> Result<_, Failure> {
        let value = quantity(&(context.physics.history)(&scene, &closed(FrictionLaw::Coulomb), DURATION)?)?;
        let modulus = number(scene.effective_shear_modulus() / 1e9, "GPa");
        Ok((Verdict::reproduced_if(range.contains(&value)), format_value(value), modulus))
    });
    let (verdict, value, modulus) = ours?;
    let (printed_verdict, printed_value, printed_modulus) = theirs?;
    Ok(Answer {
        verdict,
        range: format!("with G = {printed_modulus}, as CHK and LG print: {} ({printed_value})", printed_verdict.word()),
        words: vec![("value", value), ("duration", DURATION.to_string()), ("modulus", modulus)],
    })
}

/// Checks the first half of claim 1.
pub(super) fn slip_time(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let mut answer = half(context, SLIP_TIME, |history| history.critical.critical_time, |time| number(time, "s"))?;
    answer.words.extend([("from", SLIP_TIME.start().to_string()), ("to", SLIP_TIME.end().to_string())]);
    Ok(answer)
}

/// Checks the second half of claim 1.
pub(super) fn displacement(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let mut answer = half(
        context,
        DISPLACEMENT,
        |history| Ok(history.samples.last().map_or(0.0, |end| end.relative)),
        |moved| nano(moved, "m"),
    )?;
    let needed = DURATION + (DISPLACEMENT.start() + DISPLACEMENT.end()) / 2.0 / Scene::default().velocity;
    answer.words.push(("needed", number(needed, "s")));
    Ok(answer)
}

/// Checks claim 2.
pub(super) fn forces(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let parts = context.parts_under(
        &FRICTIONS[..2],
        "",
        |_| context.sizes.slow_points,
        |law, scene| Ok(rises_and_stays(&(context.physics.history)(scene, &closed(law), FOREVER)?)),
    )?;
    let nominal = (context.physics.history)(&Scene::default(), &closed(FrictionLaw::Coulomb), DURATION)?;
    let (start, held) = ends(&nominal.samples);
    let words = [
        ("lateral", nano(start.lateral_force, "N")),
        ("held_lateral", nano(held.lateral_force, "N")),
        ("normal", change(held.normal_force / start.normal_force - 1.0)),
        ("tip", nano(start.tip_force, "N")),
        ("held_tip", nano(held.tip_force, "N")),
        ("nearly", change(NEARLY)),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Returns whether F_Y and F_T never fall while the particle sticks, F_Z is nearly constant, and F_T stays at F_cr.
fn rises_and_stays(history: &History) -> bool {
    let History { samples, critical } = history;
    let (start, held) = ends(samples);
    let mut sticking = samples.windows(2).filter(|pair| pair[1].sticking);
    sticking.all(|pair| pair[1].lateral_force > pair[0].lateral_force && pair[1].tip_force > pair[0].tip_force)
        && samples.iter().all(|sample| is_near(sample.normal_force, start.normal_force, NEARLY))
        && is_near(held.tip_force, critical.critical_force, ROUNDING)
        && samples.iter().filter(|sample| !sample.sticking).all(|s| is_near(s.tip_force, held.tip_force, ROUNDING))
}

fn is_near(value: f64, target: f64, tolerance: f64) -> bool {
    (value - target).abs() <= tolerance * target.abs()
}

/// Returns the first sample, and the last one that sticks.
fn ends(samples: &[Sample]) -> (&Sample, &Sample) {
    let start = &samples[0];
    (start, samples.iter().rev().find(|sample| sample.sticking).unwrap_or(start))
}

/// Checks claim 3.
pub(super) fn delay(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let sweep = Sweep { parameter: parameter("static_friction"), range: (0.1, 1.2), count: context.sizes.curve };
    let parts = [context.part("later slip with higher μ_s", context.sizes.points, |scene| {
        Ok(slip_times(context, &sweep, scene)?.rises())
    })?];
    let nominal = slip_times(context, &sweep, &Scene::default())?;
    let words = [("first", number(nominal.first(), "s")), ("last", number(nominal.last(), "s"))];
    Ok(Answer::judged(&parts, words))
}

fn slip_times(context: &ClaimContext<'_>, sweep: &Sweep, scene: &Scene) -> Result<Curve, Failure> {
    let options = closed(FrictionLaw::Coulomb);
    context.curve_of(sweep, scene, |scene| (context.physics.force)(scene, &options)?.critical_time)
}

/// Checks claim 5.
pub(super) fn contacts(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let options = closed(FrictionLaw::Coulomb);
    let points = context.sizes.slow_points;
    let parts = [
        context.part("growth at the tip", points, |scene| {
            let history = (context.physics.history)(scene, &options, FOREVER)?;
            Ok(holds_until_slip(&history, |before, after, least| {
                after.tip_contact.zip(before.tip_contact).is_some_and(|(after, before)| is_larger(after, before, least))
            }))
        })?,
        context.part("shrinkage on the substrate", points, |scene| {
            let history = (context.physics.history)(scene, &options, FOREVER)?;
            Ok(holds_until_slip(&history, |before, after, least| {
                is_larger(before.substrate_contact, after.substrate_contact, least)
            }))
        })?,
    ];
    let nominal = (context.physics.history)(&Scene::default(), &options, FOREVER)?;
    let (start, held) = ends(&nominal.samples);
    let tip = match (start.tip_contact, held.tip_contact) {
        (Some(before), Some(after)) => format!(
            "the tip's contact grows from {} to {} and its indentation from {} to {}",
            square_nano(before.area()),
            square_nano(after.area()),
            nano(before.indentation, "m"),
            nano(after.indentation, "m")
        ),
        _ => "the tip's contact breaks".to_owned(),
    };
    let (before, after) = (start.substrate_contact, held.substrate_contact);
    let words = [
        ("tip", tip),
        ("area", square_nano(before.area())),
        ("area_change", change(after.area() / before.area() - 1.0)),
        ("indentation", nano(before.indentation, "m")),
        ("indentation_change", change(after.indentation / before.indentation - 1.0)),
        ("none", change(AS_GOOD_AS_NONE)),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Returns whether samples change as in `changes` at every step until the slip, and by more than nothing in total.
fn holds_until_slip(history: &History, changes: fn(&Sample, &Sample, f64) -> bool) -> bool {
    let (start, held) = ends(&history.samples);
    let mut steps = history.samples.windows(2).filter(|pair| pair[1].sticking);
    steps.all(|pair| changes(&pair[0], &pair[1], 0.0)) && changes(start, held, AS_GOOD_AS_NONE)
}

/// Returns whether one contact exceeds another by more than the part `least`, in area and in indentation.
fn is_larger(one: Contact, other: Contact, least: f64) -> bool {
    one.area() - other.area() > least * other.area().abs()
        && one.indentation - other.indentation > least * other.indentation.abs()
}

/// Formats an area (m²) in square nanometres.
fn square_nano(area: f64) -> String {
    number(area * 1e18, "nm²")
}
