//! Claims about one scene in time: 1, 2, 3, 5.

use apportion_afm::contact::Contact;
use apportion_afm::history::{History, Sample};
use apportion_afm::{Failure, FrictionLaw, Scene};

use super::Verdict;
use super::bench::{Bench, Sweep, closed, parameter};
use super::judge::{Answer, change, nano, number};
use crate::reproduce::FRICTIONS;
use crate::reproduce::figures::{DURATION, PRINTED_SHEAR_MODULUS};

/// Time after which every scene of the box has slipped (s).
const FOREVER: f64 = 1e9;

/// "Near 0.2 s": read from a chart, to a tenth.
const SLIP_TIME: (f64, f64) = (0.18, 0.22);

/// "-21 nm", printed in whole nanometres: to one nanometre.
const DISPLACEMENT: (f64, f64) = (-22e-9, -20e-9);

/// "Nearly constant": to one percent.
const NEARLY: f64 = 0.01;

/// Relative change of a contact that no chart shows.
const AS_GOOD_AS_NONE: f64 = 1e-4;

/// Tolerance for rounding between the forces by geometry and by friction.
const ROUNDING: f64 = 1e-9;

/// Checks a half of claim 1: whether a quantity of the scene in time is in a range, with the shear modulus of TS04, and
/// for comparison with that of CHK and LG.
fn half(
    bench: &Bench<'_>,
    (low, high): (f64, f64),
    quantity: fn(&History) -> Result<f64, Failure>,
    said: fn(f64) -> String,
) -> anyhow::Result<Answer> {
    let nominal = Scene::default();
    let other = Scene { shear_modulus: Some(PRINTED_SHEAR_MODULUS), ..nominal };
    let of = |scene| quantity(&(bench.physics.history)(scene, &closed(FrictionLaw::Coulomb), DURATION)?);
    let (ours, theirs) = (of(&nominal)?, of(&other)?);
    let verdict = |value: f64| Verdict::reproduced_if((low..=high).contains(&value));
    let [modulus, printed] = [nominal, other].map(|scene| number(scene.effective_shear_modulus() / 1e9, "GPa"));
    let (word, theirs) = (verdict(theirs).word(), said(theirs));
    Ok(Answer {
        verdict: verdict(ours),
        range: format!("with G = {printed}, as CHK and LG print: {word} ({theirs})"),
        words: vec![("value", said(ours)), ("duration", DURATION.to_string()), ("modulus", modulus)],
    })
}

/// Checks the first half of claim 1.
pub(super) fn slip_time(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let mut answer = half(bench, SLIP_TIME, |history| history.critical.critical_time, |time| number(time, "s"))?;
    answer.words.extend([("from", SLIP_TIME.0.to_string()), ("to", SLIP_TIME.1.to_string())]);
    Ok(answer)
}

/// Checks the second half of claim 1.
pub(super) fn displacement(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let moved = |history: &History| Ok(history.samples.last().map_or(0.0, |end| end.relative));
    let mut answer = half(bench, DISPLACEMENT, moved, |moved| nano(moved, "m"))?;
    let needed = DURATION + (DISPLACEMENT.0 + DISPLACEMENT.1) / 2.0 / Scene::default().velocity;
    answer.words.push(("needed", number(needed, "s")));
    Ok(answer)
}

/// Checks claim 2.
pub(super) fn forces(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let rule = |law, scene: &Scene| Ok(rises_and_stays(&(bench.physics.history)(scene, &closed(law), FOREVER)?));
    let holdings = bench.holding_under(&FRICTIONS[..2], "", |_| bench.sizes.slow_points, rule)?;
    let nominal = (bench.physics.history)(&Scene::default(), &closed(FrictionLaw::Coulomb), DURATION)?;
    let (start, held) = ends(&nominal.samples);
    let words = [
        ("lateral", nano(start.lateral_force, "N")),
        ("held_lateral", nano(held.lateral_force, "N")),
        ("normal", change(held.normal_force / start.normal_force - 1.0)),
        ("tip", nano(start.tip_force, "N")),
        ("held_tip", nano(held.tip_force, "N")),
        ("nearly", change(NEARLY)),
    ];
    Ok(Answer::judged(&holdings, words))
}

/// Returns whether F_Y and F_T never fall while the particle sticks, F_Z is nearly constant, and F_T stays at F_cr.
fn rises_and_stays(history: &History) -> bool {
    let History { samples, critical } = history;
    let (start, held) = ends(samples);
    let near = |value: f64, target: f64, tolerance: f64| (value - target).abs() <= tolerance * target.abs();
    let mut sticking = samples.windows(2).filter(|pair| pair[1].sticking);
    sticking.all(|pair| pair[1].lateral_force > pair[0].lateral_force && pair[1].tip_force > pair[0].tip_force)
        && samples.iter().all(|sample| near(sample.normal_force, start.normal_force, NEARLY))
        && near(held.tip_force, critical.critical_force, ROUNDING)
        && samples.iter().filter(|sample| !sample.sticking).all(|s| near(s.tip_force, held.tip_force, ROUNDING))
}

/// Returns the first sample, and the last one that sticks.
fn ends(samples: &[Sample]) -> (&Sample, &Sample) {
    let start = &samples[0];
    (start, samples.iter().rev().find(|sample| sample.sticking).unwrap_or(start))
}

/// Checks claim 3.
pub(super) fn delay(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let sweep = Sweep { parameter: parameter("static_friction"), range: (0.1, 1.2), count: bench.sizes.curve };
    let options = closed(FrictionLaw::Coulomb);
    let slip_time = |scene: &Scene| (bench.physics.force)(scene, &options)?.critical_time;
    let rule = |scene: &Scene| Ok(bench.curve_of(&sweep, scene, &slip_time)?.rises());
    let holdings = [bench.holding("later slip with higher μ_s", bench.sizes.points, &rule)?];
    let nominal = bench.curve_of(&sweep, &Scene::default(), &slip_time)?;
    let words = [("first", number(nominal.first(), "s")), ("last", number(nominal.last(), "s"))];
    Ok(Answer::judged(&holdings, words))
}

/// Checks claim 5.
pub(super) fn contacts(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let options = closed(FrictionLaw::Coulomb);
    let history = |scene: &Scene| (bench.physics.history)(scene, &options, FOREVER);
    // At every step, and by more than nothing from the start to the slip.
    let always = |grows: fn(&Sample, &Sample, f64) -> bool| {
        move |scene: &Scene| -> Result<bool, Failure> {
            let samples = history(scene)?.samples;
            let (start, held) = ends(&samples);
            let mut steps = samples.windows(2).filter(|p| p[1].sticking);
            Ok(steps.all(|p| grows(&p[0], &p[1], 0.0)) && grows(start, held, AS_GOOD_AS_NONE))
        }
    };
    let points = bench.sizes.slow_points;
    let tip = always(|before, after, least| {
        after.tip_contact.zip(before.tip_contact).is_some_and(|(after, before)| is_larger(after, before, least))
    });
    let substrate = always(|before, after, least| is_larger(before.substrate_contact, after.substrate_contact, least));
    let holdings = [
        bench.holding("growth at the tip", points, &tip)?,
        bench.holding("shrinkage on the substrate", points, &substrate)?,
    ];
    let nominal = history(&Scene::default())?;
    let (start, held) = ends(&nominal.samples);
    let square_nano = |area: f64| number(area * 1e18, "nm²");
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
    Ok(Answer::judged(&holdings, words))
}

/// Returns whether one contact exceeds another by more than `least`, in area and in indentation.
fn is_larger(one: Contact, other: Contact, least: f64) -> bool {
    let is_larger = |one: f64, other: f64| one - other > least * other.abs();
    is_larger(one.area(), other.area()) && is_larger(one.indentation, other.indentation)
}
