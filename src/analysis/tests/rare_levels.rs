use super::*;
use crate::design::{DesignSettings, Rows};
use crate::space::Factor;
use apportion_base::quantity::Unit;

fn listed(law: Distribution, base_samples: u64) -> Vec<RareLevel> {
    let factor = Factor::new("d", Unit::dimensionless(), law).unwrap();
    let space = Space::new(vec![factor]);
    let settings = DesignSettings { base_samples, ..DesignSettings::default() };
    super::rare_levels(&space, &Design::new(settings, 1, Rows::plain(vec![vec![0]])).unwrap())
}

#[test]
fn levels_are_counted_by_their_probabilities() {
    let rare = listed(Distribution::boolean(0.03).unwrap(), 128);
    assert_eq!(rare.len(), 1);
    assert_eq!((rare[0].level.as_str(), rare[0].values), ("true", 256));
    assert!((rare[0].probability - 0.03).abs() < 1e-12 && (4..10).contains(&rare[0].draws), "{rare:?}");
    assert!((enough_base_samples(&rare) - 166.7).abs() < 0.1);
    assert!(listed(Distribution::boolean(0.03).unwrap(), 512).is_empty());
    // The same level from the other side.
    assert_eq!(listed(Distribution::boolean(0.999).unwrap(), 64)[0].level, "false");
}

#[test]
fn two_levels_may_hardly_meet() {
    let boolean =
        |name: &str, p: f64| Factor::new(name, Unit::dimensionless(), Distribution::boolean(p).unwrap()).unwrap();
    let listed = |p: [f64; 2], base_samples: u64| {
        let space = Space::new(vec![boolean("d", p[0]), boolean("e", p[1])]);
        let settings = DesignSettings { base_samples, ..DesignSettings::default() };
        super::rare_levels(&space, &Design::new(settings, 2, Rows::plain(vec![vec![0], vec![1]])).unwrap())
    };
    let rare = listed([0.05, 0.05], 128);
    assert_eq!((rare.len(), rare[0].partner, rare[0].draws, rare[0].values), (1, Some(1), 1, 512), "{rare:?}");
    assert!(rare[0].is_missed() && (rare[0].base_samples(10.0) - 1000.0).abs() < 1e-6);
    assert!(listed([0.05, 0.05], 512).is_empty());
    // Their joint effect is small compared with the effect of either alone.
    assert!(listed([0.01, 0.01], 512).iter().all(|rare| rare.partner.is_none()));
}

#[test]
fn ordered_numbers_count_as_levels_only_if_rare() {
    let values: Vec<f64> = (0..200).map(f64::from).collect();
    assert!(listed(Distribution::discrete(&values, None).unwrap(), 64).is_empty());
    assert!(listed(Distribution::poisson(3.0).unwrap(), 64).is_empty());
    assert_eq!(listed(Distribution::poisson(0.001).unwrap(), 64)[0].level, "above 0");
    let rare = listed(Distribution::discrete(&[0.0, 1.0, 2.0], Some(&[0.499, 0.499, 0.002])).unwrap(), 128);
    assert_eq!(rare.iter().map(|rare| rare.level.as_str()).collect::<Vec<_>>(), ["2"]);
}

#[test]
fn thin_bins_count_where_they_carry_the_variance() {
    let law = |edges: &[f64]| Distribution::histogram(edges, &[0.999, 0.001]).unwrap();
    assert_eq!(listed(law(&[0.0, 1.0, 1000.0]), 128)[0].level, "1 to 1000");
    assert!(listed(law(&[0.0, 1.0, 1.1]), 128).is_empty());
}
