//! The printed percentages, and ours under every reading.

use std::collections::BTreeMap;

use super::QUICK;

/// Our shares of a study under a reading, and their distance to the printed ones.
struct Study {
    /// Our share and the printed one, by factor.
    shares: BTreeMap<String, (f64, Option<f64>)>,
    distance: f64,
}

/// The studies by friction model, output, measure and group.
fn studies() -> BTreeMap<[String; 4], Study> {
    let mut studies = BTreeMap::new();
    for row in QUICK.rows("percentages.csv") {
        let key = [0, 1, 2, 3].map(|place| row[place].to_owned());
        let distance = row[7].parse().unwrap();
        let study = studies.entry(key).or_insert(Study { shares: BTreeMap::new(), distance });
        assert_eq!(study.distance, distance);
        study.shares.insert(row[4].to_owned(), (row[5].parse().unwrap(), row[6].parse().ok()));
    }
    studies
}

/// Over the printed factors and, as one more, the sum of all others.
#[test]
fn a_distance_is_a_root_mean_square() {
    for (key, Study { shares, distance }) in studies() {
        let mut printed: Vec<f64> = shares.values().filter_map(|(ours, printed)| Some(ours - (*printed)?)).collect();
        let rest = shares.values().filter(|(_, printed)| printed.is_none()).map(|(ours, _)| ours).sum::<f64>();
        let printed_rest = 100.0 - shares.values().filter_map(|(_, printed)| *printed).sum::<f64>();
        printed.push(rest - printed_rest);
        let expected = (printed.iter().map(|x| x * x).sum::<f64>() / printed.len() as f64).sqrt();
        // Rounding of percentages.
        assert!((distance - expected).abs() < 1e-11, "{key:?}: {distance}, {expected}");
    }
}

/// Exact shares of a product of powers of uniform factors, for the force and for its logarithm.
#[test]
fn the_shares_are_those_of_the_product_form() {
    let studies = studies();
    assert_eq!(studies.len(), 4 * 2 * 2 * 3);
    let study =
        |friction: &str, output: &str, group: &str| &studies[&[friction, output, "S_1", group].map(str::to_owned)];
    let share = |output, factor| study("LuGre", output, "dimensional").shares[factor].0;
    // V(t^3), V(L^-2), V(w) over squared means; Var(ln) of the same powers. 0.5: the error at few base samples.
    let [t, l, w] = [1.05755, 0.595_238, 0.259_516];
    assert!((share("F_cr", "thickness") - 100.0 * t / (t + l + w)).abs() < 0.5);
    let variance_of_log = |a: f64, b: f64| {
        let product = a * b / (b - a).powi(2) * (b / a).ln().powi(2);
        1.0 - product
    };
    let [t, l, w] = [9.0 * variance_of_log(0.25, 2.5), 4.0 * variance_of_log(200.0, 700.0), variance_of_log(5.0, 80.0)];
    assert!((share("ln F_cr", "thickness") - 100.0 * t / (t + l + w)).abs() < 0.5);
    // The viscous variant gives the velocity its printed share; the force of the others does not depend on it.
    let distance = |friction| study(friction, "F_cr", "environmental").distance;
    assert!(distance("viscous LuGre") < 1.5 && distance("LuGre") > 10.0);
    let of_every_factor: usize = studies.values().map(|study| study.shares.len()).sum();
    assert_eq!(of_every_factor, 4 * 2 * 2 * (4 + 4 + 8));
}
