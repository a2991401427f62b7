//! Claims about one scene in time: 1, 2, 3, 5.

use super::bench::{Bench, LAWS, Sweep, closed};
use super::numbers::{change, nano, number};
use super::{Claim, ClaimsError, Verdict};
use apportion::afm::contact::Contact;
use apportion::afm::history::{History, Sample};
use apportion::afm::{Failure, FrictionLaw, Parameter, Scene};

/// The duration of TS04's run (s).
const DURATION: f64 = 0.4;

/// Longer than any scene of the box takes to slip (s).
const FOREVER: f64 = 1e9;

/// The shear modulus that CHK and LG print (Pa).
const PRINTED_SHEAR_MODULUS: f64 = 40.5e9;

/// "Near 0.2 s": read off a chart, to a tenth.
const SLIP_TIME: (f64, f64) = (0.18, 0.22);

/// "-21 nm", printed in whole nanometres: to one of them.
const DISPLACEMENT: (f64, f64) = (-22e-9, -20e-9);

/// "Nearly constant": to one percent.
const NEARLY: f64 = 0.01;

/// A change of a contact that no chart shows.
const AS_GOOD_AS_NONE: f64 = 1e-4;

/// Equal up to rounding, of the forces by geometry and by friction.
const ROUNDING: f64 = 1e-9;

pub(super) fn claims(bench: &Bench<'_>) -> Result<Vec<Claim>, ClaimsError> {
    let [slip, displacement] = run(bench)?;
    Ok(vec![slip, displacement, forces(bench)?, delay(bench)?, contacts(bench)?])
}

/// Claim 1, in its two halves: with the shear modulus of TS04, and for comparison with that of CHK and LG.
fn run(bench: &Bench<'_>) -> Result<[Claim; 2], ClaimsError> {
    let nominal = Scene::default();
    let other = Scene { shear_modulus: Some(PRINTED_SHEAR_MODULUS), ..nominal };
    let run = |scene: &Scene| -> Result<(f64, f64), ClaimsError> {
        let History { samples, critical } = (bench.physics.history)(scene, &closed(FrictionLaw::Coulomb), DURATION)?;
        Ok((critical.critical_time?, samples.last().map_or(0.0, |end| end.relative)))
    };
    let ((slip, moved), (other_slip, other_moved)) = (run(&nominal)?, run(&other)?);
    let verdict = |value: f64, (low, high): (f64, f64)| {
        if (low..=high).contains(&value) { Verdict::Reproduced } else { Verdict::NotReproduced }
    };
    let giga = |scene: &Scene| number(scene.effective_shear_modulus() / 1e9, "GPa");
    let beside = |verdict: &Verdict, value: String| {
        format!("with G = {}, as CHK and LG print: {} ({value})", giga(&other), verdict.word())
    };
    let setting = format!(
        "Exact geometry, Coulomb friction, JKR, nominal scene at V = 100 nm/s, {DURATION} s, with G = {} = E/(2 (1 + ν)), \
         which TS04 prints in its table 2",
        giga(&nominal)
    );
    let needed = DURATION + (DISPLACEMENT.0 + DISPLACEMENT.1) / 2.0 / nominal.velocity;
    Ok([
        Claim {
            number: 1,
            source: "TS04",
            statement: "Pushed at 100 nm/s, the particle slips near 0.2 s.",
            verdict: verdict(slip, SLIP_TIME),
            range: beside(&verdict(other_slip, SLIP_TIME), number(other_slip, "s")),
            finding: format!("The particle slips after {}.", number(slip, "s")),
            setting: format!("{setting}; near 0.2 s means from {} to {} s.", SLIP_TIME.0, SLIP_TIME.1),
            figures: &["ts04-8", "ts04-10"],
        },
        Claim {
            number: 1,
            source: "TS04",
            statement: "After 0.4 s the particle has moved −21 nm relative to the substrate.",
            verdict: verdict(moved, DISPLACEMENT),
            range: beside(&verdict(other_moved, DISPLACEMENT), nano(other_moved, "m")),
            finding: format!(
                "It has moved {}. At 100 nm/s, −21 nm belong to a slip at {}.",
                nano(moved, "m"),
                number(needed, "s")
            ),
            setting: format!("{setting}; −21 nm means to 1 nm."),
            figures: &["ts04-10"],
        },
    ])
}

/// Claim 2.
fn forces(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let mut holdings = Vec::new();
    for (law, name) in &LAWS[..2] {
        let rule = |scene: &Scene| {
            let history = (bench.physics.history)(scene, &closed(*law), FOREVER)?;
            Ok(rises_and_stays(&history))
        };
        holdings.push(bench.holding(*name, bench.sizes.slow_points, &rule)?);
    }
    let nominal = (bench.physics.history)(&Scene::default(), &closed(FrictionLaw::Coulomb), DURATION)?;
    let (start, held) = ends(&nominal.samples);
    Ok(Claim {
        number: 2,
        source: "TS04 figs. 8, 9, CHK fig. 5",
        statement: "While pushing, F_Y grows and F_Z is nearly constant; F_T rises to F_cr and then stays.",
        finding: format!(
            "At the nominal scene under Coulomb friction F_Y grows from {} to {}, F_Z changes by {}, F_T rises from {} \
             to {}.",
            nano(start.lateral_force, "N"),
            nano(held.lateral_force, "N"),
            change(held.normal_force / start.normal_force - 1.0),
            nano(start.tip_force, "N"),
            nano(held.tip_force, "N")
        ),
        setting: format!(
            "Exact geometry; nearly constant means to {}; after the slip the tip is taken to hold the particle still \
             under steady friction; nominal scene and {} points of the general study's box.",
            change(NEARLY),
            bench.sizes.slow_points
        ),
        figures: &["ts04-8", "ts04-9", "chk-5"],
        ..Claim::judged(&holdings)
    })
}

/// F_Y and F_T never fall while the particle sticks, F_Z is nearly constant, and F_T is F_cr at the slip and after.
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

/// The first sample, and the last that sticks.
fn ends(samples: &[Sample]) -> (&Sample, &Sample) {
    let start = &samples[0];
    (start, samples.iter().rev().find(|sample| sample.sticking).unwrap_or(start))
}

/// Claim 3.
fn delay(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let parameter = Parameter::from_name("static_friction").ok_or(ClaimsError::NoRanges)?;
    let sweep = Sweep { parameter, range: (0.1, 1.2), count: bench.sizes.curve };
    let options = closed(FrictionLaw::Coulomb);
    let slip_time = |scene: &Scene| (bench.physics.force)(scene, &options)?.critical_time;
    let rule = |scene: &Scene| Ok(bench.curve_of(&sweep, scene, &slip_time)?.rises());
    let holdings = [bench.holding("later slip with higher μ_s", bench.sizes.points, &rule)?];
    let nominal = bench.curve_of(&sweep, &Scene::default(), &slip_time)?;
    Ok(Claim {
        number: 3,
        source: "TS04 fig. 11",
        statement: "A higher coefficient of friction delays the slip.",
        finding: format!(
            "At the nominal scene the slip comes after {} with μ_s = 0.1 and after {} with μ_s = 1.2.",
            number(nominal.first(), "s"),
            number(nominal.last(), "s")
        ),
        setting: format!(
            "Closed form, Coulomb friction (that of TS04; Hurtado-Kim friction knows no μ_s), {} values of μ_s from 0.1 \
             to 1.2 at the nominal scene and at {} points of the general study's box.",
            sweep.count, bench.sizes.points
        ),
        figures: &["ts04-11"],
        ..Claim::judged(&holdings)
    })
}

/// Claim 5.
fn contacts(bench: &Bench<'_>) -> Result<Claim, ClaimsError> {
    let options = closed(FrictionLaw::Coulomb);
    let history = |scene: &Scene| (bench.physics.history)(scene, &options, FOREVER);
    // At every step, and from the start to the slip by more than nothing.
    let always = |grows: fn(&Sample, &Sample, f64) -> Option<bool>| {
        move |scene: &Scene| -> Result<bool, Failure> {
            let samples = history(scene)?.samples;
            let rises = |before: &Sample, after: &Sample, least: f64| grows(before, after, least).unwrap_or(false);
            let (start, held) = ends(&samples);
            let mut steps = samples.windows(2).filter(|p| p[1].sticking);
            Ok(steps.all(|p| rises(&p[0], &p[1], 0.0)) && rises(start, held, AS_GOOD_AS_NONE))
        }
    };
    let points = bench.sizes.slow_points;
    let tip = always(|before, after, least| Some(is_larger(after.tip_contact?, before.tip_contact?, least)));
    let substrate =
        always(|before, after, least| Some(is_larger(before.substrate_contact, after.substrate_contact, least)));
    let holdings = [
        bench.holding("growth at the tip", points, &tip)?,
        bench.holding("shrinkage on the substrate", points, &substrate)?,
    ];
    let nominal = history(&Scene::default())?;
    let (start, held) = ends(&nominal.samples);
    let square_nano = |area: f64| number(area * 1e18, "nm²");
    let tip_finding = match (start.tip_contact, held.tip_contact) {
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
    Ok(Claim {
        number: 5,
        source: "TS04 fig. 13",
        statement: "Area and indentation of the tip's contact grow while pushing, those of the substrate's shrink.",
        finding: format!(
            "At the nominal scene {tip_finding}; on the substrate the area of {} changes by {}, the indentation of {} by \
             {}.",
            square_nano(before.area()),
            change(after.area() / before.area() - 1.0),
            nano(before.indentation, "m"),
            change(after.indentation / before.indentation - 1.0)
        ),
        setting: format!(
            "Exact geometry, Coulomb friction, JKR, from the start to the slip, at every step of the history; changes below \
             {} in all are as good as none; nominal scene and {points} points of the general study's box.",
            change(AS_GOOD_AS_NONE)
        ),
        figures: &["ts04-13"],
        ..Claim::judged(&holdings)
    })
}

/// Whether one contact is larger than another by more than that part, in area and in indentation.
fn is_larger(one: Contact, other: Contact, least: f64) -> bool {
    let is_larger = |one: f64, other: f64| one - other > least * other.abs();
    is_larger(one.area(), other.area()) && is_larger(one.indentation, other.indentation)
}
