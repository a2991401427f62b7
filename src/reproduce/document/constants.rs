//! The constants that the papers print, those that are used, and why; and the ranges of the factors.

use crate::reproduce::general_study;
use apportion::afm::Scene;
use apportion::afm::modes::ModeConstants;
use apportion::report::document::{Part, Section, Table};
use apportion::report::with_unit;
use apportion::space::Factor;

/// A constant: its name, what is printed and where, what is used, and why.
type Row = [String; 4];

fn row(name: &str, printed: &str, used: String, why: &str) -> Row {
    [name.to_owned(), printed.to_owned(), used, why.to_owned()]
}

/// The constants whose value in use needs a reason. What is used is read from the scene that the studies use.
fn constants() -> Vec<Row> {
    let scene = Scene::default();
    let modes = ModeConstants::default();
    let giga = |pascals: f64| with_unit((pascals / 1e7).round() / 100.0, "GPa");
    vec![
        row(
            "shear strength τ",
            "28 N/m² (TS04)",
            with_unit(scene.shear_strength / 1e6, "MPa"),
            "as printed it would be nothing; N/mm² is meant",
        ),
        row(
            "shear modulus G",
            "66.54 GPa (TS04, table 2); 40.5 GPa (CHK, LG)",
            format!("E/(2 (1 + ν)), {} at the nominal E", giga(scene.effective_shear_modulus())),
            "TS04's value is that of its E and ν; the studies vary E, so G follows. Claim 1 gives both",
        ),
        row(
            "Young's modulus E, nominal",
            "169 GPa (TS04, CHK); 102.87 GPa (LG)",
            giga(scene.elastic_modulus),
            "LG's own value lies below the range that it prints, 120 to 200 GPa",
        ),
        row(
            "viscous friction σ₂ of LuGre",
            "1e-7 N s/m (LG)",
            format!("{:e} N s/m", scene.viscous_friction),
            "as printed; 0.3 N s/m in the viscous variant, which shows what the printed share of the velocity takes",
        ),
        row(
            "friction at the tip μ_t",
            "–",
            modes.tip_friction.to_string(),
            "ours: that of the particle on the substrate",
        ),
        row(
            "shift of the pressure in rolling ξ",
            "–",
            with_unit(modes.rolling_shift * 1e9, "nm"),
            "ours: of atomic size (Dominik and Tielens 1997); TS04 prints no criterion for rolling",
        ),
        row(
            "offset of the tip for spin x₀",
            "0 (TS04)",
            with_unit((modes.offset * 1e10).round() / 10.0, "nm"),
            "ours, and only where spin is asked for: without an offset nothing spins",
        ),
        row(
            "Poisson ratios of gold and silica",
            "–",
            format!("{} and {}", scene.particle_poisson_ratio, scene.substrate_poisson_ratio),
            "ours; for LuGre friction with the parameters of the contact",
        ),
    ]
}

/// The section: constants, then the ranges of the general study.
pub(super) fn section() -> Section {
    let caption = "Constants that a paper prints in another way than it is used, or that no paper prints. All others are \
                   used as printed.";
    let constants = constants();
    let mut rows = Table::of(caption, &constants);
    for (place, heading) in ["constant", "printed", "used", "why"].into_iter().enumerate() {
        rows = rows.text(heading, |row| &row[place]);
    }
    let mut parts = vec![rows.into()];
    if let Ok(study) = general_study() {
        let range = |factor: &Factor| {
            let (low, high) = factor.distribution().support();
            format!("{low} to {high} {}", factor.unit())
        };
        let caption = "The ranges of the factors, uniform, as CHK prints them in its tables 1 to 3.";
        let table = Table::of(caption, study.space().factors())
            .text("factor", |factor| factor.name.replace('_', " "))
            .text("range", range)
            .text("group", |factor| factor.group.as_deref().unwrap_or_default());
        parts.push(Part::Details { summary: "The ranges of the factors".to_owned(), parts: vec![table.into()] });
    }
    Section::new("constants", "Constants: printed, used, and why", vec![Part::OnPage(parts)])
}
