//! Claims about the friction model, velocity, moduli and adhesion: 7, 12 to 16.

use apportion_afm::{Failure, Fidelity, FrictionLaw, LuGreParameters, Options, Scene};

use super::context::{ClaimContext, Sweep, closed, exact, in_motion};
use super::curve::Curve;
use super::dimensions::{
    NO_EFFECT, STRAIGHT, closed_setting, from_to, is_linear_rise, nominal_curves, straightness, without_effect,
};
use super::judge::{Answer, change, nano};
use crate::reproduce::studies::FRICTIONS;

/// Velocity up to which CHK and LG see no effect (m/s).
const SLOW: f64 = 600e-9;

/// Maximum relative change that counts as "unmoved" by the contact modulus. Coulomb's law has a small term in the
/// contact area, tau pi a^2, so the claim can only mean that the change is invisible next to the fall of the other
/// model.
const UNMOVED: f64 = 0.05;

/// The viscous friction that brings LuGre friction to the percentages of LG fig. 4b (N s/m).
const VISCOUS: f64 = 0.3;

/// Checks claim 7: which friction model holds the particle less.
pub(super) fn weaker_law(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    // All samples of a box share the scrambles, so that they differ only by their factors.
    let points = context.sizes.points;
    let part =
        context.part("F_cr(Hurtado-Kim) < F_cr(Coulomb)", points, |scene| is_hurtado_kim_weaker(context, scene))?;
    let dimensional = context.share(Some("dimensional"), points, |scene| is_hurtado_kim_weaker(context, scene))?;
    let environmental = context.share(Some("environmental"), points, |scene| is_hurtado_kim_weaker(context, scene))?;
    let nominal = Scene::default();
    let words = [
        ("hurtado_kim", nano(context.force(&nominal, &closed(FrictionLaw::HurtadoKim))?, "N")),
        ("coulomb", nano(context.force(&nominal, &closed(FrictionLaw::Coulomb))?, "N")),
        ("general", part.share.words_of("the box of the general study")),
        ("dimensional", dimensional.words_of("that of the dimensional study")),
        ("environmental", environmental.words_of("that of the environmental study")),
        ("each", (points / 8).to_string()),
    ];
    Ok(Answer::judged(&[part], words))
}

fn is_hurtado_kim_weaker(context: &ClaimContext<'_>, scene: &Scene) -> Result<bool, Failure> {
    Ok(context.force(scene, &closed(FrictionLaw::HurtadoKim))? < context.force(scene, &closed(FrictionLaw::Coulomb))?)
}

/// Checks claim 12. Only the equations of motion depend on the velocity under every friction model.
pub(super) fn velocity(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let full_range = Sweep { count: 5, ..context.over("velocity") };
    let slow = Sweep { range: (0.0, SLOW), count: 4, ..full_range };
    let mut answer = without_effect(context, &slow, in_motion)?;
    let nominal = Scene::default();
    let viscous = Scene { viscous_friction: VISCOUS, ..nominal };
    let viscous = context.curve(&slow, &viscous, &exact(FrictionLaw::LuGre))?;
    let naive = Options { fidelity: Fidelity::FixedStep, ..exact(FrictionLaw::Coulomb) };
    let naive_curve = context.curve(&Sweep { count: 13, ..slow }, &nominal, &naive)?;
    answer.words.extend([
        ("whole", full_range.words()),
        ("beyond", nominal_curves(context, &full_range, in_motion, |curve| change(curve.spread()))?),
        ("viscous", change(viscous.spread())),
        ("coefficient", VISCOUS.to_string()),
        ("naive", change(naive_curve.spread())),
        ("step", (naive.step * 1e3).to_string()),
        ("tolerance", change(in_motion(FrictionLaw::LuGre).tolerance)),
    ]);
    Ok(answer)
}

/// Checks claim 13.
pub(super) fn elastic_modulus(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let sweep = context.over("elastic_modulus");
    let points = context.sizes.points;
    let mut parts = context.parts_under(
        &FRICTIONS,
        "linear rise under ",
        |_| points,
        |law, scene| Ok(is_linear_rise(&context.curve(&sweep, scene, &closed(law))?)),
    )?;
    let coulomb = closed(FrictionLaw::Coulomb);
    parts.push(context.part("divergence of Coulomb and Hurtado-Kim", points, |scene| {
        Ok(gaps(context, &sweep, scene, &coulomb)?.rises())
    })?);
    let words = [
        ("sweep", sweep.words()),
        ("curves", nominal_curves(context, &sweep, closed, straightness)?),
        ("gap", from_to(&gaps(context, &sweep, &Scene::default(), &coulomb)?)),
        ("closed", closed_setting(context, &sweep)?),
        ("straight", change(STRAIGHT)),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Returns the distance of F_cr under Coulomb friction with these options from that under Hurtado-Kim friction (N).
fn gaps(context: &ClaimContext<'_>, sweep: &Sweep, scene: &Scene, coulomb: &Options) -> Result<Curve, Failure> {
    context.curve_of(sweep, scene, |scene| {
        Ok((context.force(scene, coulomb)? - context.force(scene, &closed(FrictionLaw::HurtadoKim))?).abs())
    })
}

/// Checks claim 14.
pub(super) fn contact_modulus(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let sweep = context.over("equivalent_modulus");
    let points = context.sizes.points;
    let (coulomb, hurtado_kim) = (closed(FrictionLaw::Coulomb), closed(FrictionLaw::HurtadoKim));
    let parts = [
        context
            .part("Coulomb unmoved", points, |scene| Ok(context.curve(&sweep, scene, &coulomb)?.spread() < UNMOVED))?,
        context.part("Hurtado-Kim falling", points, |scene| Ok(context.curve(&sweep, scene, &hurtado_kim)?.falls()))?,
    ];
    let nominal = Scene::default();
    let (flat, falling) = (context.curve(&sweep, &nominal, &coulomb)?, context.curve(&sweep, &nominal, &hurtado_kim)?);
    let words = [
        ("sweep", sweep.words()),
        ("flat", from_to(&flat)),
        ("flat_change", change(flat.spread())),
        ("falling", from_to(&falling)),
        ("falling_change", change(falling.spread())),
        ("closed", closed_setting(context, &sweep)?),
        ("least", change(UNMOVED)),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Checks claim 15.
pub(super) fn adhesion(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let sweep = context.over("adhesion");
    let points = context.sizes.points;
    let mut parts = context.parts_under(
        &FRICTIONS[..2],
        "rise under ",
        |_| points,
        |law, scene| Ok(context.curve(&sweep, scene, &closed(law))?.rises()),
    )?;
    let coulomb = closed(FrictionLaw::Coulomb);
    parts.push(context.part("approach", points, |scene| Ok(gaps(context, &sweep, scene, &coulomb)?.falls()))?);
    let nominal = Scene::default();
    let loaded = Options { adhesion_in_load: true, ..coulomb };
    let words = [
        ("sweep", sweep.words()),
        ("coulomb", from_to(&context.curve(&sweep, &nominal, &coulomb)?)),
        ("hurtado_kim", from_to(&context.curve(&sweep, &nominal, &closed(FrictionLaw::HurtadoKim))?)),
        ("gap", from_to(&gaps(context, &sweep, &nominal, &coulomb)?)),
        ("loaded_gap", from_to(&gaps(context, &sweep, &nominal, &loaded)?)),
        ("closed", closed_setting(context, &sweep)?),
    ];
    Ok(Answer::judged(&parts, words))
}

/// Checks claim 16.
pub(super) fn constant_parameters(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let options = closed(FrictionLaw::LuGre);
    let nominal = Scene::default();
    let from_contact = Options { lugre: LuGreParameters::Contact, ..exact(FrictionLaw::LuGre) };
    let loaded = Options { adhesion_in_load: true, ..options };
    let mut parts = Vec::new();
    let mut findings = Vec::new();
    for (name, symbol) in [("equivalent_modulus", "K"), ("adhesion", "ω")] {
        let sweep = context.over(name);
        parts.push(context.part(&format!("{symbol} invisible"), context.sizes.points, |scene| {
            Ok(context.curve(&sweep, scene, &options)?.spread() < NO_EFFECT)
        })?);
        let few = Sweep { count: 4, ..sweep };
        findings.push(format!(
            "{symbol} of {} changes F_cr by {} (by {} with bristles that follow the contact, by {} with the pull-off force \
             in the load)",
            sweep.words(),
            change(context.curve(&sweep, &nominal, &options)?.spread()),
            change(context.curve(&few, &nominal, &from_contact)?.spread()),
            change(context.curve(&sweep, &nominal, &loaded)?.spread())
        ));
    }
    let words = [
        ("force", nano(context.force(&nominal, &options)?, "N")),
        ("changes", findings.join("; ")),
        ("no_effect", change(NO_EFFECT)),
    ];
    Ok(Answer::judged(&parts, words))
}
