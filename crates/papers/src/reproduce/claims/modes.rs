//! Claims about other motions of the particle than sliding, and their forces: 4, 6.

use std::f64::consts::FRAC_PI_2;

use apportion_afm::modes::{Mode, Onset, TipForce};
use apportion_afm::{Failure, FrictionLaw, Scene};

use super::context::{ClaimContext, Sweep, closed, exact, parameter};
use super::curve::grid;
use super::judge::{Answer, change, nano, number, over_ranges};
use super::verdict::Verdict;

/// Distance of the start of the mode diagram above the angle of friction (rad): at that angle F* is unbounded.
const ABOVE_FRICTION: f64 = 0.05;

/// Returns F*_ss (N) at each of the angles of the mode diagram; `None` if no force makes the particle slide.
fn diagram(
    context: &ClaimContext<'_>,
    scene: &Scene,
    adhesion_in_load: bool,
) -> Result<Vec<(f64, Option<f64>)>, Failure> {
    let mut pushing = (context.physics.pushing)(*scene);
    pushing.adhesion_in_load = adhesion_in_load;
    let lowest = libm::atan(pushing.scene.static_friction) + ABOVE_FRICTION;
    let angles = grid((lowest, FRAC_PI_2), context.sizes.curve);
    angles.into_iter().map(|angle| Ok((angle, pushing.critical_tip_force(Mode::Slide, angle)?))).collect()
}

/// Checks claim 4.
pub(super) fn angle(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let sweep = Sweep { parameter: parameter("contact_angle"), range: (0.0, FRAC_PI_2), count: 5 };
    let options = exact(FrictionLaw::Coulomb);
    let points = context.sizes.slow_points;
    let parts = [
        context.part("fall of F_ss* with the angle ψ of the tip force", points, |scene| {
            let mut falls = true;
            for adhesion_in_load in [false, true] {
                let points = diagram(context, scene, adhesion_in_load)?;
                falls &= points.windows(2).all(|pair| matches!((pair[0].1, pair[1].1), (Some(a), Some(b)) if b < a));
            }
            Ok(falls)
        })?,
        context.part("fall of F_cr with the contact angle φ", points, |scene| {
            Ok(context.curve(&sweep, scene, &options)?.falls())
        })?,
    ];
    let nominal = Scene::default();
    let words = [
        ("ends", diagram_ends(&diagram(context, &nominal, false)?)),
        ("loaded_ends", diagram_ends(&diagram(context, &nominal, true)?)),
        ("unmoved", change(context.curve(&sweep, &nominal, &options)?.spread())),
        ("count", sweep.count.to_string()),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Formats the first and the last force of a mode diagram with their angles.
fn diagram_ends(points: &[(f64, Option<f64>)]) -> String {
    let [first, last] = [points[0], points[points.len() - 1]].map(|(angle, force)| {
        let force = force.map_or_else(|| "no bound".to_owned(), |force| nano(force, "N"));
        format!("{force} at {}°", number(angle.to_degrees(), ""))
    });
    format!("{first} to {last}")
}

/// Checks claim 6. TS04 prints no criterion for rolling: the moment criterion is ours. Between a resting tip and a
/// moving substrate the particle can only roll if it slips or rolls at the tip too, so rolling starts where the moment
/// criterion holds and the tip slips.
pub(super) fn rolling(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let points = context.sizes.slow_points;
    let parts = [
        context.part("by the moment alone", points, |scene| {
            let Onsets { slide, roll, .. } = Onsets::new(context, scene)?;
            Ok(slide < roll)
        })?,
        context.part("if rolling waits for slip at the tip", points, |scene| {
            let onsets = Onsets::new(context, scene)?;
            Ok(onsets.slide < onsets.roll_with_tip_slip())
        })?,
    ];
    let nominal = Scene::default();
    let onsets = Onsets::new(context, &nominal)?;
    let pushing = (context.physics.pushing)(nominal);
    let balance = pushing.balance(Mode::Roll, TipForce { normal: onsets.normal, lateral: 0.0 })?;
    let excess = balance.drive / balance.resistance;
    Ok(Answer {
        verdict: Verdict::reproduced_if(parts[0].nominal),
        range: format!("by our criterion; {}", over_ranges(&parts)),
        words: vec![
            ("roll", onset_in_words(onsets.roll)),
            ("slide", onset_in_words(onsets.slide)),
            ("tip", onset_in_words(onsets.tip_slip)),
            ("excess", number(excess, "")),
            // The resistance is proportional to xi.
            ("least_shift", nano(pushing.constants.rolling_shift * excess, "m")),
            ("later", onset_in_words(onsets.roll_with_tip_slip())),
            ("shift", nano(pushing.constants.rolling_shift, "m")),
            ("tip_friction", pushing.constants.tip_friction.to_string()),
        ],
    })
}

/// When motions of a particle set in, and the normal force there (N).
struct Onsets {
    normal: f64,
    slide: Onset,
    roll: Onset,
    tip_slip: Onset,
}

impl Onsets {
    fn new(context: &ClaimContext<'_>, scene: &Scene) -> Result<Self, Failure> {
        let normal = (context.physics.force)(scene, &closed(FrictionLaw::Coulomb))?.normal_force;
        let pushing = (context.physics.pushing)(*scene);
        Ok(Self {
            normal,
            slide: pushing.onset(Mode::Slide, normal)?,
            roll: pushing.onset(Mode::Roll, normal)?,
            tip_slip: pushing.onset(Mode::TipSlip, normal)?,
        })
    }

    /// Returns the onset of rolling that waits for slip at the tip.
    fn roll_with_tip_slip(&self) -> Onset {
        if self.roll > self.tip_slip { self.roll } else { self.tip_slip }
    }
}

fn onset_in_words(onset: Onset) -> String {
    match onset {
        Onset::AtOnce => "under the preload alone".to_owned(),
        Onset::At(lateral) => format!("at F_Y = {}", nano(lateral, "N")),
        Onset::Never => "at no F_Y".to_owned(),
    }
}
