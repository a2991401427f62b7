//! Claims about other motions of the particle than sliding, and their forces: 4, 6.

use std::f64::consts::FRAC_PI_2;

use apportion_afm::modes::{Mode, Onset, TipForce};
use apportion_afm::{Failure, FrictionLaw, Scene};

use super::Verdict;
use super::bench::{Bench, Sweep, closed, exact, grid, parameter};
use super::judge::{Answer, change, nano, number, over_ranges};

/// Distance of the start of the mode diagram above the angle of friction (rad): at that angle F* is unbounded.
const ABOVE_FRICTION: f64 = 0.05;

/// Returns F*_ss (N) at each of the angles of the mode diagram; `None` if no force makes the particle slide.
fn diagram(bench: &Bench<'_>, scene: &Scene, adhesion_in_load: bool) -> Result<Vec<(f64, Option<f64>)>, Failure> {
    let mut pushing = (bench.physics.pushing)(*scene);
    pushing.adhesion_in_load = adhesion_in_load;
    let lowest = libm::atan(pushing.scene.static_friction) + ABOVE_FRICTION;
    let angles = grid((lowest, FRAC_PI_2), bench.sizes.curve);
    angles.into_iter().map(|angle| Ok((angle, pushing.critical_tip_force(Mode::Slide, angle)?))).collect()
}

/// Checks claim 4.
pub(super) fn angle(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let sweep = Sweep { parameter: parameter("contact_angle"), range: (0.0, FRAC_PI_2), count: 5 };
    let options = exact(FrictionLaw::Coulomb);
    let against_force_angle = |scene: &Scene| {
        let mut falls = true;
        for adhesion_in_load in [false, true] {
            let points = diagram(bench, scene, adhesion_in_load)?;
            falls &= points.windows(2).all(|pair| matches!((pair[0].1, pair[1].1), (Some(a), Some(b)) if b < a));
        }
        Ok(falls)
    };
    let against_contact_angle = |scene: &Scene| Ok(bench.curve(&sweep, scene, &options)?.falls());
    let points = bench.sizes.slow_points;
    let holdings = [
        bench.holding("fall of F_ss* with the angle ψ of the tip force", points, &against_force_angle)?,
        bench.holding("fall of F_cr with the contact angle φ", points, &against_contact_angle)?,
    ];
    let nominal = Scene::default();
    let ends = |adhesion_in_load| -> Result<String, Failure> {
        let points = diagram(bench, &nominal, adhesion_in_load)?;
        let [first, last] = [points[0], points[points.len() - 1]].map(|(angle, force)| {
            let force = force.map_or_else(|| "no bound".to_owned(), |force| nano(force, "N"));
            format!("{force} at {}°", number(angle.to_degrees(), ""))
        });
        Ok(format!("{first} to {last}"))
    };
    let words = [
        ("ends", ends(false)?),
        ("loaded_ends", ends(true)?),
        ("unmoved", change(bench.curve(&sweep, &nominal, &options)?.spread())),
        ("count", sweep.count.to_string()),
    ];
    Ok(Answer::judged(&holdings, words))
}

/// Checks claim 6. TS04 prints no criterion for rolling: the moment criterion is ours. Between a resting tip and a
/// moving substrate the particle can only roll if it slips or rolls at the tip too, so rolling starts where the moment
/// criterion holds and the tip slips.
pub(super) fn rolling(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let options = closed(FrictionLaw::Coulomb);
    let normal = |scene: &Scene| Ok::<f64, Failure>((bench.physics.force)(scene, &options)?.normal_force);
    let later = |one: Onset, other: Onset| if one > other { one } else { other };
    let onsets = |scene: &Scene| -> Result<[Onset; 3], Failure> {
        let (normal, pushing) = (normal(scene)?, (bench.physics.pushing)(*scene));
        let onset = |mode| pushing.onset(mode, normal);
        Ok([onset(Mode::Slide)?, onset(Mode::Roll)?, onset(Mode::TipSlip)?])
    };
    let by_moment = |scene: &Scene| onsets(scene).map(|[slide, roll, _]| slide < roll);
    let by_kinematics = |scene: &Scene| onsets(scene).map(|[slide, roll, tip]| slide < later(roll, tip));
    let points = bench.sizes.slow_points;
    let holdings = [
        bench.holding("by the moment alone", points, &by_moment)?,
        bench.holding("if rolling waits for slip at the tip", points, &by_kinematics)?,
    ];
    let nominal = Scene::default();
    let [slide, roll, tip] = onsets(&nominal)?;
    let pushing = (bench.physics.pushing)(nominal);
    let preload = TipForce { normal: normal(&nominal)?, lateral: 0.0 };
    let balance = pushing.balance(Mode::Roll, preload)?;
    let excess = balance.drive / balance.resistance;
    let at = |onset| match onset {
        Onset::AtOnce => "under the preload alone".to_owned(),
        Onset::At(lateral) => format!("at F_Y = {}", nano(lateral, "N")),
        Onset::Never => "at no F_Y".to_owned(),
    };
    Ok(Answer {
        verdict: Verdict::reproduced_if(holdings[0].nominal),
        range: format!("by our criterion; {}", over_ranges(&holdings)),
        words: vec![
            ("roll", at(roll)),
            ("slide", at(slide)),
            ("tip", at(tip)),
            ("excess", number(excess, "")),
            // The resistance is proportional to xi.
            ("least_shift", nano(pushing.constants.rolling_shift * excess, "m")),
            ("later", at(later(roll, tip))),
            ("shift", nano(pushing.constants.rolling_shift, "m")),
            ("tip_friction", pushing.constants.tip_friction.to_string()),
        ],
    })
}
