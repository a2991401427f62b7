//! Claim 7: which friction model holds the particle less.

use apportion_afm::{FrictionLaw, Scene};

use super::bench::{Bench, closed};
use super::judge::{Answer, Holding};
use super::numbers::nano;

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
