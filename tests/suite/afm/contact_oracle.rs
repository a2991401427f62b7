//! Maugis-Dugdale contacts against `tests/oracle/maugis_dugdale.json`, computed to 60 digits by the script next to it.

use apportion_afm::ContactTheory::MaugisDugdale;
use apportion_afm::contact::Pair;
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    radius: f64,
    modulus: f64,
    separation: f64,
    cases: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    adhesion: f64,
    load: f64,
    radius: f64,
    indentation: f64,
    /// By how much more than F + 2 pi w R the radius changes, relatively.
    condition: f64,
    pull_off: f64,
    pull_off_radius: f64,
}

/// Lambda from 1e-3 to 1e3, loads from 1e-9 of pi w R above pull-off to 1e18. The bound is 1e-12 where the radius is a
/// well-conditioned function of the load, and the rounding of the load where it is not.
#[test]
fn maugis_dugdale_agrees_to_twelve_digits() {
    let oracle: Oracle = serde_json::from_str(include_str!("../../oracle/maugis_dugdale.json")).unwrap();
    assert!(oracle.cases.len() > 140);
    let mut worst = (0.0_f64, 0.0_f64, 0.0_f64);
    for case in &oracle.cases {
        let pair = Pair {
            radius: oracle.radius,
            modulus: oracle.modulus,
            adhesion: case.adhesion,
            separation: oracle.separation,
        };
        let contact = MaugisDugdale.contact(&pair, case.load).unwrap();
        let error = (contact.radius / case.radius - 1.0).abs();
        let bound = 1e-12_f64.max(4e-16 * case.condition.abs());
        assert!(error < bound, "lambda {} load {}: {error:e}", pair.transition(), case.load);
        // An indentation may be zero: it is measured by a^2/R.
        let scale = case.radius * case.radius / oracle.radius;
        let depth_error = (contact.indentation - case.indentation).abs() / scale;
        let depth_bound = 2e-12_f64.max(1e-15 * case.condition.abs()) * (1.0 + case.indentation.abs() / scale);
        assert!(depth_error < depth_bound, "lambda {} load {}: {depth_error:e}", pair.transition(), case.load);
        if case.condition.abs() < 10.0 {
            worst.0 = worst.0.max(error);
            worst.1 = worst.1.max(depth_error);
        }
        let pull_off_error = (MaugisDugdale.pull_off(&pair) / case.pull_off - 1.0).abs();
        worst.2 = worst.2.max(pull_off_error);
        assert!(pull_off_error < 1e-14, "{pull_off_error:e}");
        // Exactly at pull-off the load is known to a rounding error and the radius to its square root, by the curvature
        // of the load there, which falls like lambda while the radius itself does.
        let last = MaugisDugdale.contact(&pair, -MaugisDugdale.pull_off(&pair)).unwrap();
        let last_error = (last.radius / case.pull_off_radius - 1.0).abs();
        assert!(last_error < 1e-7 * (1.0 + pair.transition().powf(-1.5)), "{last_error:e}");
    }
    println!("worst errors of radius, indentation, pull-off: {worst:.1e}", worst = worst.0);
    println!("{:.1e} {:.1e}", worst.1, worst.2);
}
