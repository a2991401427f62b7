use super::*;

/// Constants under which friction falls far, and rises again.
fn scene() -> Scene {
    Scene { dynamic_friction: 0.5, viscous_friction: 1e-6, ..Scene::default() }
}

/// From F_S at rest down through the dip and up again along F_C + F_v v.
#[test]
fn dips_and_rises() {
    let (load, scene) = (1e-7, scene());
    let law = Stribeck(&scene);
    assert_eq!(law.force(load, 0.0), 0.8 * load);
    let by_hand = load * (0.5 + 0.3 * libm::exp(-4.0_f64)) + 2e-9;
    assert!((law.force(load, 2e-3) / by_hand - 1.0).abs() < 1e-15);
    assert!(law.force(load, 2e-3) < law.force(load, 1e-3) && law.force(load, 2e-3) < law.force(load, 1e-1));
    assert_eq!(law.force(load, 1.0), 0.5 * load + 1e-6);
}

/// The first peak by stepping along the curve, 1e-6 for the step.
#[test]
fn capacity_is_the_first_peak() {
    for exponent in [0.5, 1.0, 1.5, 2.0, 4.0] {
        for viscous_friction in [0.0, 1e-7, 1e-6, 1e-5, 1e-3] {
            for velocity in [0.0, 1e-7, 3e-4, 1e-3, 5e-3] {
                let scene = Scene { viscous_friction, stribeck_exponent: exponent, ..scene() };
                let law = Stribeck(&scene);
                let mut peak = law.force(1e-7, 0.0);
                for i in 1..=20_000 {
                    let next = law.force(1e-7, velocity * f64::from(i) / 2e4);
                    if next < peak {
                        break;
                    }
                    peak = next;
                }
                let capacity = law.capacity(1e-7, velocity).unwrap();
                assert!(
                    (capacity / peak - 1.0).abs() < 1e-6,
                    "{exponent} {viscous_friction} {velocity} {capacity} {peak}"
                );
            }
        }
    }
}

#[test]
fn friction_that_only_rises_holds_to_the_end() {
    let scene = Scene { static_friction: 0.3, ..scene() };
    let law = Stribeck(&scene);
    assert_eq!(law.capacity(1e-7, 2e-3).unwrap(), law.force(1e-7, 2e-3));
}
