//! Claims about velocity, moduli and adhesion: 12 to 16.

use super::ClaimsError;
use super::bench::{Bench, Sweep, closed, exact, in_motion};
use super::dimensions::{
    NO_EFFECT, closed_setting, effect_setting, from_to, is_linear_rise, linear_means, nominal_curves, straightness,
    without_effect,
};
use super::judge::Answer;
use super::numbers::{change, nano};
use crate::reproduce::FRICTIONS;
use apportion::afm::{Failure, Fidelity, FrictionLaw, LuGreParameters, Options, Scene};

/// Up to where CHK and LG see no effect of the velocity (m/s).
const SLOW: f64 = 600e-9;

/// "Unmoved" by the contact modulus: less than this share. Coulomb's law has a small term in the contact's area, tau pi
/// a^2, so that the claim can only mean that nothing is seen beside the fall of the other model.
const UNMOVED: f64 = 0.05;

/// The viscous friction that brings LuGre friction to the percentages of LG fig. 4b (N s/m).
const VISCOUS: f64 = 0.3;

/// Claim 12. Only the equations of motion have the velocity in them under every friction model.
pub(super) fn velocity(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let whole = Sweep { count: 5, ..bench.over("velocity")? };
    let slow = Sweep { range: (0.0, SLOW), count: 4, ..whole };
    let holdings = without_effect(bench, &slow, in_motion)?;
    let spread = |curve: &super::curve::Curve| change(curve.spread());
    let spreads = nominal_curves(bench, &slow, in_motion, &spread)?;
    let beyond = nominal_curves(bench, &whole, in_motion, &spread)?;
    let nominal = Scene::default();
    let viscous = Scene { viscous_friction: VISCOUS, ..nominal };
    let viscous = bench.curve(&slow, &viscous, &exact(FrictionLaw::LuGre))?;
    let naive = Options { fidelity: Fidelity::FixedStep, ..exact(FrictionLaw::Coulomb) };
    let naive_curve = bench.curve(&Sweep { count: 13, ..slow }, &nominal, &naive)?;
    Ok(Answer {
        finding: format!(
            "A velocity of {} changes F_cr by {spreads} at the nominal scene, one of {} by {beyond}. It would change it by \
             {} under LuGre friction with a viscous part of {VISCOUS} N s/m, and by {} under Coulomb friction marched in \
             steps of {} ms without locating the slip.",
            slow.words(),
            whole.words(),
            change(viscous.spread()),
            change(naive_curve.spread()),
            naive.step * 1e3
        ),
        setting: format!(
            "{} The motion is solved to {} of the force: smaller changes are as good as none.",
            effect_setting(bench, &slow, "Equations of motion"),
            change(in_motion(FrictionLaw::LuGre).tolerance)
        ),
        ..Answer::judged(&holdings)
    })
}

/// Claim 13.
pub(super) fn elastic_modulus(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let sweep = bench.over("elastic_modulus")?;
    let points = bench.sizes.points;
    let rise = |law, scene: &Scene| Ok(is_linear_rise(&bench.curve(&sweep, scene, &closed(law))?));
    let mut holdings = bench.holding_under(&FRICTIONS, "linear rise under ", |_| points, rise)?;
    let gap = |scene: &Scene| Ok(gap(bench, scene, &closed(FrictionLaw::Coulomb))?.abs());
    let diverge = |scene: &Scene| Ok(bench.curve_of(&sweep, scene, &gap)?.rises());
    holdings.push(bench.holding("divergence of Coulomb and Hurtado-Kim", points, &diverge)?);
    let nominal_gap = bench.curve_of(&sweep, &Scene::default(), &gap)?;
    Ok(Answer {
        finding: format!(
            "From {} F_cr rises {} at the nominal scene, and the gap of Coulomb to Hurtado-Kim goes {}.",
            sweep.words(),
            nominal_curves(bench, &sweep, closed, &straightness)?,
            from_to(&nominal_gap)
        ),
        setting: format!(
            "{} {}; diverging, that the gap in size grows at every step.",
            closed_setting(bench, &sweep)?,
            linear_means()
        ),
        ..Answer::judged(&holdings)
    })
}

/// F_cr under Coulomb friction with these options, less that under Hurtado-Kim friction (N).
fn gap(bench: &Bench<'_>, scene: &Scene, coulomb: &Options) -> Result<f64, Failure> {
    Ok(bench.force(scene, coulomb)? - bench.force(scene, &closed(FrictionLaw::HurtadoKim))?)
}

/// Claim 14.
pub(super) fn contact_modulus(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let sweep = bench.over("equivalent_modulus")?;
    let points = bench.sizes.points;
    let (coulomb, hurtado_kim) = (closed(FrictionLaw::Coulomb), closed(FrictionLaw::HurtadoKim));
    let unmoved = |scene: &Scene| Ok(bench.curve(&sweep, scene, &coulomb)?.spread() < UNMOVED);
    let falls = |scene: &Scene| Ok(bench.curve(&sweep, scene, &hurtado_kim)?.falls());
    let holdings =
        [bench.holding("Coulomb unmoved", points, &unmoved)?, bench.holding("Hurtado-Kim falling", points, &falls)?];
    let nominal = Scene::default();
    let (flat, falling) = (bench.curve(&sweep, &nominal, &coulomb)?, bench.curve(&sweep, &nominal, &hurtado_kim)?);
    Ok(Answer {
        finding: format!(
            "From {} F_cr goes {} under Coulomb friction, a change of {} by its term τ π a², and {} under Hurtado-Kim \
             friction, a change of {}, at the nominal scene.",
            sweep.words(),
            from_to(&flat),
            change(flat.spread()),
            from_to(&falling),
            change(falling.spread())
        ),
        setting: format!(
            "{} unmoved means by less than {}, falling means at every step.",
            closed_setting(bench, &sweep)?,
            change(UNMOVED)
        ),
        ..Answer::judged(&holdings)
    })
}

/// Claim 15.
pub(super) fn adhesion(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let sweep = bench.over("adhesion")?;
    let points = bench.sizes.points;
    let rises = |law, scene: &Scene| Ok(bench.curve(&sweep, scene, &closed(law))?.rises());
    let mut holdings = bench.holding_under(&FRICTIONS[..2], "rise under ", |_| points, rises)?;
    let coulomb = closed(FrictionLaw::Coulomb);
    let distance = |scene: &Scene| Ok(gap(bench, scene, &coulomb)?.abs());
    let approach = |scene: &Scene| Ok(bench.curve_of(&sweep, scene, &distance)?.falls());
    holdings.push(bench.holding("approach", points, &approach)?);
    let nominal = Scene::default();
    let loaded = Options { adhesion_in_load: true, ..coulomb };
    let apart = bench.curve_of(&sweep, &nominal, &distance)?;
    let apart_loaded = bench.curve_of(&sweep, &nominal, &|scene| Ok(gap(bench, scene, &loaded)?.abs()))?;
    Ok(Answer {
        finding: format!(
            "From {} F_cr goes {} under Coulomb and {} under Hurtado-Kim friction at the nominal scene, and the gap {}. \
             With the pull-off force in the load of Coulomb friction the gap goes {}.",
            sweep.words(),
            from_to(&bench.curve(&sweep, &nominal, &coulomb)?),
            from_to(&bench.curve(&sweep, &nominal, &closed(FrictionLaw::HurtadoKim))?),
            from_to(&apart),
            from_to(&apart_loaded)
        ),
        setting: format!(
            "{} rising at every step; approach means that the gap in size shrinks at every step; pull-off force not in \
             the load.",
            closed_setting(bench, &sweep)?
        ),
        ..Answer::judged(&holdings)
    })
}

/// Claim 16.
pub(super) fn constant_parameters(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let options = closed(FrictionLaw::LuGre);
    let nominal = Scene::default();
    let from_contact = Options { lugre: LuGreParameters::Contact, ..exact(FrictionLaw::LuGre) };
    let loaded = Options { adhesion_in_load: true, ..options };
    let mut holdings = Vec::new();
    let mut findings = Vec::new();
    for (name, symbol) in [("equivalent_modulus", "K"), ("adhesion", "ω")] {
        let sweep = bench.over(name)?;
        let rule = |scene: &Scene| Ok(bench.curve(&sweep, scene, &options)?.spread() < NO_EFFECT);
        holdings.push(bench.holding(format!("{symbol} invisible"), bench.sizes.points, &rule)?);
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
    Ok(Answer {
        finding: format!(
            "At the nominal scene (F_cr {}) {}.",
            nano(bench.force(&nominal, &options)?, "N"),
            findings.join("; ")
        ),
        setting: format!(
            "Closed form; the parameters of LuGre friction are held constant as in LG, by which neither factor can act: \
             this is so by construction. Invisible means by less than {}, at the nominal scene and at {} points of the \
             general study's box.",
            change(NO_EFFECT),
            bench.sizes.points
        ),
        ..Answer::judged(&holdings)
    })
}
