//! The constants that the papers print, those that are used, and the reasons; and the ranges of the factors.

use apportion::space::Factor;
use apportion_afm::Scene;
use apportion_afm::modes::ModeConstants;
use apportion_report::document::{Part, Section, Table};
use apportion_report::with_unit;

use crate::reproduce::general_study;
use crate::reproduce::papers::{Words, filled, papers};

/// Returns the values of the scene that the studies use.
fn used() -> Words {
    let (scene, modes) = (Scene::default(), ModeConstants::default());
    let giga = |pascals: f64| with_unit((pascals / 1e7).round() / 100.0, "GPa");
    vec![
        ("shear_strength", with_unit(scene.shear_strength / 1e6, "MPa")),
        ("shear_modulus", giga(scene.effective_shear_modulus())),
        ("elastic_modulus", giga(scene.elastic_modulus)),
        ("viscous_friction", format!("{:e}", scene.viscous_friction)),
        ("tip_friction", modes.tip_friction.to_string()),
        ("rolling_shift", with_unit(modes.rolling_shift * 1e9, "nm")),
        ("offset", with_unit((modes.offset * 1e10).round() / 10.0, "nm")),
        ("particle_ratio", scene.particle_poisson_ratio.to_string()),
        ("substrate_ratio", scene.substrate_poisson_ratio.to_string()),
    ]
}

/// Builds the section: constants, then the ranges of the general study.
pub(super) fn section() -> Section {
    let caption = "Constants whose printed and used values differ, or that no paper prints. All others are \
                   used as printed.";
    let words = used();
    let constants = Table::from_rows(caption, &papers().constants)
        .text("constant", |constant| constant.name)
        .text("printed", |constant| constant.printed)
        .text("used", |constant| filled(constant.used, &words))
        .text("why", |constant| constant.why);
    let range = |factor: &Factor| {
        let (low, high) = factor.distribution().support();
        format!("{low} to {high} {}", factor.unit())
    };
    let caption = "The ranges of the factors, uniform, as CHK prints them in its tables 1 to 3.";
    let study = general_study();
    let ranges = Table::from_rows(caption, study.space().factors())
        .text("factor", |factor| factor.name.replace('_', " "))
        .text("range", range)
        .text("group", |factor| factor.group.as_deref().unwrap_or_default());
    let ranges = Part::Details { summary: "The ranges of the factors".to_owned(), parts: vec![ranges.into()] };
    let parts = vec![constants.into(), ranges];
    Section::new("constants", "Constants: printed, used, and why", vec![Part::OnPage(parts)])
}
