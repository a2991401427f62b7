//! Claims about the friction model, velocity, moduli and adhesion: 7, 12 to 16.

use apportion_afm::{Failure, Fidelity, FrictionLaw, LuGreParameters, Options, Scene};

use super::bench::{Bench, Sweep, closed, exact, in_motion};
use super::dimensions::{
    NO_EFFECT, STRAIGHT, closed_setting, from_to, is_linear_rise, nominal_curves, straightness, without_effect,
};
use super::judge::{Answer, Holding, change, nano};
use crate::reproduce::FRICTIONS;

/// Velocity up to which CHK and LG see no effect (m/s).
const SLOW: f64 = 600e-9;

/// Maximum relative change that counts as "unmoved" by the contact modulus. Coulomb's law has a small term in the
/// contact area, tau pi a^2, so the claim can only mean that the change is invisible next to the fall of the other
/// model.
const UNMOVED: f64 = 0.05;

/// The viscous friction that brings LuGre friction to the percentages of LG fig. 4b (N s/m).
const VISCOUS: f64 = 0.3;

/// Checks claim 7: which friction model holds the particle less.
pub(super) fn weaker_law(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let (coulomb, hurtado_kim) = (closed(FrictionLaw::Coulomb), closed(FrictionLaw::HurtadoKim));
    let below = |scene: &Scene| Ok(bench.force(scene, &hurtado_kim)? < bench.force(scene, &coulomb)?);
    // All samples of a box share the scrambles, so that they differ only by their factors.
    let points = bench.sizes.points;
    let general = bench.share(None, points, &below)?;
    let dimensional = bench.share(Some("dimensional"), points, &below)?;
    let environmental = bench.share(Some("environmental"), points, &below)?;
    let nominal = Scene::default();
    let holding =
        Holding { what: "F_cr(Hurtado-Kim) < F_cr(Coulomb)".to_owned(), nominal: below(&nominal)?, share: general };
    let words = [
        ("hurtado_kim", nano(bench.force(&nominal, &hurtado_kim)?, "N")),
        ("coulomb", nano(bench.force(&nominal, &coulomb)?, "N")),
        ("general", general.words_of("the box of the general study")),
        ("dimensional", dimensional.words_of("that of the dimensional study")),
        ("environmental", environmental.words_of("that of the environmental study")),
        ("each", (points / 8).to_string()),
    ];
    Ok(Answer::judged(&[holding], words))
}

/// Checks claim 12. Only the equations of motion depend on the velocity under every friction model.
pub(super) fn velocity(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let whole = Sweep { count: 5, ..bench.over("velocity") };
    let slow = Sweep { range: (0.0, SLOW), count: 4, ..whole };
    let mut answer = without_effect(bench, &slow, in_motion)?;
    let nominal = Scene::default();
    let viscous = Scene { viscous_friction: VISCOUS, ..nominal };
    let viscous = bench.curve(&slow, &viscous, &exact(FrictionLaw::LuGre))?;
    let naive = Options { fidelity: Fidelity::FixedStep, ..exact(FrictionLaw::Coulomb) };
    let naive_curve = bench.curve(&Sweep { count: 13, ..slow }, &nominal, &naive)?;
    answer.words.extend([
        ("whole", whole.words()),
        ("beyond", nominal_curves(bench, &whole, in_motion, &|curve| change(curve.spread()))?),
        ("viscous", change(viscous.spread())),
        ("coefficient", VISCOUS.to_string()),
        ("naive", change(naive_curve.spread())),
        ("step", (naive.step * 1e3).to_string()),
        ("tolerance", change(in_motion(FrictionLaw::LuGre).tolerance)),
    ]);
    Ok(answer)
}

/// Checks claim 13.
pub(super) fn elastic_modulus(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let sweep = bench.over("elastic_modulus");
    let points = bench.sizes.points;
    let rise = |law, scene: &Scene| Ok(is_linear_rise(&bench.curve(&sweep, scene, &closed(law))?));
    let mut holdings = bench.holding_under(&FRICTIONS, "linear rise under ", |_| points, rise)?;
    let gap = |scene: &Scene| Ok(gap(bench, scene, &closed(FrictionLaw::Coulomb))?.abs());
    let diverge = |scene: &Scene| Ok(bench.curve_of(&sweep, scene, &gap)?.rises());
    holdings.push(bench.holding("divergence of Coulomb and Hurtado-Kim", points, &diverge)?);
    let words = [
        ("sweep", sweep.words()),
        ("curves", nominal_curves(bench, &sweep, closed, &straightness)?),
        ("gap", from_to(&bench.curve_of(&sweep, &Scene::default(), &gap)?)),
        ("closed", closed_setting(bench, &sweep)?),
        ("straight", change(STRAIGHT)),
    ];
    Ok(Answer::judged(&holdings, words))
}

/// Returns F_cr under Coulomb friction with these options, minus that under Hurtado-Kim friction (N).
fn gap(bench: &Bench<'_>, scene: &Scene, coulomb: &Options) -> Result<f64, Failure> {
    Ok(bench.force(scene, coulomb)? - bench.force(scene, &closed(FrictionLaw::HurtadoKim))?)
}

/// Checks claim 14.
pub(super) fn contact_modulus(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let sweep = bench.over("equivalent_modulus");
    let points = bench.sizes.points;
    let (coulomb, hurtado_kim) = (closed(FrictionLaw::Coulomb), closed(FrictionLaw::HurtadoKim));
    let unmoved = |scene: &Scene| Ok(bench.curve(&sweep, scene, &coulomb)?.spread() < UNMOVED);
    let falls = |scene: &Scene| Ok(bench.curve(&sweep, scene, &hurtado_kim)?.falls());
    let holdings =
        [bench.holding("Coulomb unmoved", points, &unmoved)?, bench.holding("Hurtado-Kim falling", points, &falls)?];
    let nominal = Scene::default();
    let (flat, falling) = (bench.curve(&sweep, &nominal, &coulomb)?, bench.curve(&sweep, &nominal, &hurtado_kim)?);
    let words = [
        ("sweep", sweep.words()),
        ("flat", from_to(&flat)),
        ("flat_change", change(flat.spread())),
        ("falling", from_to(&falling)),
        ("falling_change", change(falling.spread())),
        ("closed", closed_setting(bench, &sweep)?),
        ("least", change(UNMOVED)),
    ];
    Ok(Answer::judged(&holdings, words))
}

/// Checks claim 15.
pub(super) fn adhesion(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let sweep = bench.over("adhesion");
    let points = bench.sizes.points;
    let rises = |law, scene: &Scene| Ok(bench.curve(&sweep, scene, &closed(law))?.rises());
    let mut holdings = bench.holding_under(&FRICTIONS[..2], "rise under ", |_| points, rises)?;
    let coulomb = closed(FrictionLaw::Coulomb);
    let distance = |scene: &Scene| Ok(gap(bench, scene, &coulomb)?.abs());
    let approach = |scene: &Scene| Ok(bench.curve_of(&sweep, scene, &distance)?.falls());
    holdings.push(bench.holding("approach", points, &approach)?);
    let nominal = Scene::default();
    let loaded = Options { adhesion_in_load: true, ..coulomb };
    let loaded_distance = |scene: &Scene| Ok(gap(bench, scene, &loaded)?.abs());
    let words = [
        ("sweep", sweep.words()),
        ("coulomb", from_to(&bench.curve(&sweep, &nominal, &coulomb)?)),
        ("hurtado_kim", from_to(&bench.curve(&sweep, &nominal, &closed(FrictionLaw::HurtadoKim))?)),
        ("gap", from_to(&bench.curve_of(&sweep, &nominal, &distance)?)),
        ("loaded_gap", from_to(&bench.curve_of(&sweep, &nominal, &loaded_distance)?)),
        ("closed", closed_setting(bench, &sweep)?),
    ];
    Ok(Answer::judged(&holdings, words))
}

/// Checks claim 16.
pub(super) fn constant_parameters(bench: &Bench<'_>) -> anyhow::Result<Answer> {
    let options = closed(FrictionLaw::LuGre);
    let nominal = Scene::default();
    let from_contact = Options { lugre: LuGreParameters::Contact, ..exact(FrictionLaw::LuGre) };
    let loaded = Options { adhesion_in_load: true, ..options };
    let mut holdings = Vec::new();
    let mut findings = Vec::new();
    for (name, symbol) in [("equivalent_modulus", "K"), ("adhesion", "ω")] {
        let sweep = bench.over(name);
        let rule = |scene: &Scene| Ok(bench.curve(&sweep, scene, &options)?.spread() < NO_EFFECT);
        holdings.push(bench.holding(&format!("{symbol} invisible"), bench.sizes.points, &rule)?);
        let few = Sweep { count: 4, ..sweep };
        findings.push(format!(
            "{symbol} of {} changes F_cr by {} (by {} with bristles that follow the contact, by {} with the pull-off force \
             in the load)",
            sweep.words(),
            change(bench.curve(&sweep, &nominal, &options)?.spread()),
            change(bench.curve(&few, &nominal, &from_contact)?.spread()),
            change(bench.curve(&sweep, &nominal, &loaded)?.spread())
        ));
    }
    let words = [
        ("force", nano(bench.force(&nominal, &options)?, "N")),
        ("changes", findings.join("; ")),
        ("no_effect", change(NO_EFFECT)),
    ];
    Ok(Answer::judged(&holdings, words))
}
