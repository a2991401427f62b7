//! Claim 7: which friction model holds the particle less.

use super::ClaimsError;
use super::bench::{Bench, Region, closed};
use super::judge::{Answer, Holding};
use super::numbers::nano;
use apportion::afm::{FrictionLaw, Scene};

pub(super) fn weaker_law(bench: &Bench<'_>) -> Result<Answer, ClaimsError> {
    let (coulomb, hurtado_kim) = (closed(FrictionLaw::Coulomb), closed(FrictionLaw::HurtadoKim));
    let below = |scene: &Scene| Ok(bench.force(scene, &hurtado_kim)? < bench.force(scene, &coulomb)?);
    // One sample of each box shares the scrambles of the others, so that they differ by their factors alone.
    let points = bench.sizes.points;
    let general = bench.share(Region::General, points, &below)?;
    let dimensional = bench.share(Region::Group("dimensional"), points, &below)?;
    let environmental = bench.share(Region::Group("environmental"), points, &below)?;
    let nominal = Scene::default();
    let holding =
        Holding { what: "F_cr(Hurtado-Kim) < F_cr(Coulomb)".to_owned(), nominal: below(&nominal)?, share: general };
    Ok(Answer {
        finding: format!(
            "At the nominal scene F_cr is {} under Hurtado-Kim and {} under Coulomb friction. Hurtado-Kim friction gives \
             the smaller force on {}, {} and {}.",
            nano(bench.force(&nominal, &hurtado_kim)?, "N"),
            nano(bench.force(&nominal, &coulomb)?, "N"),
            general.words_of("the box of the general study"),
            dimensional.words_of("that of the dimensional study"),
            environmental.words_of("that of the environmental study")
        ),
        setting: format!(
            "Closed form, JKR; shares with 95 % intervals from 8 scrambles of {} Sobol' points each.",
            points / 8
        ),
        ..Answer::judged(&[holding])
    })
}
