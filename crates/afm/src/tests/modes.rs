//! Limits in which a mode has a closed form, and a result or a named failure for all input.

use proptest::prelude::*;

use super::*;

fn nominal() -> Pushing {
    Pushing::new(Scene::default())
}

fn close(actual: f64, expected: f64, tolerance: f64) {
    assert!((actual / expected - 1.0).abs() < tolerance, "{actual} is not {expected}");
}

/// JKR on the substrate: F_Y* = mu_s F_Z + tau pi a^2 as in the closed-form critical force.
#[test]
fn sliding_sets_in_at_the_critical_lateral_force() {
    let critical = crate::critical_force(&Scene::default(), &crate::Options::default()).unwrap();
    let Onset::At(lateral) = nominal().onset(Mode::Slide, critical.normal_force).unwrap() else { panic!() };
    close(lateral, critical.lateral_force, 1e-15);
}

/// These criteria contradict the claim that sliding precedes rolling; sliding does not precede a slip of the
/// tip, whose preload pushes 60 degrees off the contact's normal. At the critical force the tip holds.
#[test]
fn order_at_the_nominal_scene() {
    let normal = 489.4e-9;
    let onset = |mode| nominal().onset(mode, normal).unwrap();
    assert_eq!([onset(Mode::TipSlip), onset(Mode::Roll)], [Onset::AtOnce; 2]);
    assert!(Onset::AtOnce < onset(Mode::Spin) && onset(Mode::Spin) < onset(Mode::Slide));
    let moving = |lateral| {
        let moves = |mode: &Mode| nominal().balance(*mode, TipForce { normal, lateral }).unwrap().moves();
        Mode::ALL.iter().copied().filter(moves).collect::<Vec<_>>()
    };
    assert_eq!(moving(0.0), [Mode::TipSlip, Mode::Roll]);
    assert_eq!(moving(282e-9), [Mode::Spin], "psi = phi/2 = 30 degrees");
    assert_eq!(moving(398e-9), [Mode::Roll, Mode::Spin]);
    assert_eq!(moving(399e-9), [Mode::Slide, Mode::Roll, Mode::Spin]);
}

/// The resistance to rolling that would let the particle slide first, in units of the nominal one.
#[test]
fn rolling_would_need_a_shift_of_tens_of_nanometres_to_wait_for_sliding() {
    let rolls = |rolling_shift| {
        let constants = ModeConstants { rolling_shift, ..ModeConstants::default() };
        let force = TipForce { normal: 489.4e-9, lateral: 398e-9 };
        Pushing { constants, ..nominal() }.balance(Mode::Roll, force).unwrap().moves()
    };
    assert!(rolls(13e-9) && !rolls(15e-9));
}

/// Without shear strength F* = mu_s F_ad/(sin psi - mu_s cos psi), F_ad = 1.5 pi w R_p.
#[test]
fn mode_diagram_without_shear_strength() {
    let scene = Scene { shear_strength: 0.0, ..Scene::default() };
    let sticky = Pushing { adhesion_in_load: true, ..Pushing::new(scene) };
    let angle = 1.2_f64;
    let expected = 0.8 * 1.5 * PI * 0.2 * 50e-9 / (libm::sin(angle) - 0.8 * libm::cos(angle));
    close(sticky.critical_tip_force(Mode::Slide, angle).unwrap().unwrap(), expected, 1e-14);
    // Without both, only the friction cone remains.
    let dry = Pushing::new(scene);
    assert_eq!(dry.critical_tip_force(Mode::Slide, libm::atan(0.8) + 1e-9), Ok(Some(0.0)));
    assert_eq!(dry.critical_tip_force(Mode::Slide, libm::atan(0.8) - 1e-9), Ok(None));
}

/// Pushed along the line from tip to particle, the tip cannot slip; with the tip on top, it slips like a substrate.
#[test]
fn tip_slip_in_line_and_on_top() {
    let scene = Scene::default();
    assert_eq!(nominal().critical_tip_force(Mode::TipSlip, scene.contact_angle), Ok(None));
    let on_top = Pushing::new(Scene { contact_angle: 0.0, ..scene });
    let force = TipForce { normal: 4e-7, lateral: 3e-7 };
    let (tip, area) = (Pair::tip(&scene), |c: Contact| PI * c.radius * c.radius);
    let resistance = 0.8 * 4e-7 + 28e6 * area(ContactTheory::Jkr.contact(&tip, 4e-7).unwrap());
    let balance = on_top.balance(Mode::TipSlip, force).unwrap();
    close(balance.drive, 3e-7, 1e-15);
    close(balance.resistance, resistance, 1e-15);
}

/// M = 4 F_ad xi at either contact without load; there is no resistance without adhesion.
#[test]
fn rolling_limits() {
    let none = TipForce { normal: 0.0, lateral: 0.0 };
    let at_rest = nominal().balance(Mode::Roll, none).unwrap();
    let radii = 50e-9 + Pair::tip(&Scene::default()).radius;
    close(at_rest.resistance, 4.0 * 1.5 * PI * 0.2 * radii * 0.5e-9, 1e-14);
    assert_eq!(at_rest.drive, 0.0);
    let dry = Pushing::new(Scene { adhesion: 0.0, ..Scene::default() });
    for theory in ContactTheory::ALL {
        let balance = Pushing { theory, ..dry }.balance(Mode::Roll, TipForce { normal: 1e-7, lateral: 1e-7 }).unwrap();
        assert_eq!(balance.resistance, 0.0);
        assert!(balance.moves());
    }
    // Rigid bodies: the moment vanishes where the force passes through both contacts, psi = phi/2.
    let rigid = Pushing::new(Scene { equivalent_modulus: 1e30, adhesion: 0.0, ..Scene::default() });
    let drive = |psi: f64| rigid.balance(Mode::Roll, TipForce::polar(1e-7, psi)).unwrap().drive;
    assert!(drive(30_f64.to_radians()) < 1e-15 * drive(0.0));
    close(drive(0.0), 1e-7 * 50e-9 * libm::sin(60_f64.to_radians()), 1e-7);
}

/// F_Y x0 = (2 pi/3) tau a^3; a push through the centre causes no spin.
#[test]
fn spin_limits() {
    let radius = ContactTheory::Jkr.contact(&Pair::substrate(&Scene::default()), 5e-7).unwrap().radius;
    let expected = 2.0 * PI / 3.0 * 28e6 * radius.powi(3) / 5e-9;
    let Onset::At(lateral) = nominal().onset(Mode::Spin, 5e-7).unwrap() else { panic!() };
    close(lateral, expected, 1e-14);
    let central = Pushing { constants: ModeConstants { offset: 0.0, ..ModeConstants::default() }, ..nominal() };
    assert_eq!(central.onset(Mode::Spin, 5e-7), Ok(Onset::Never));
}

#[test]
fn unphysical_values_are_named() {
    let constants = ModeConstants { tip_friction: -1.0, ..ModeConstants::default() };
    let force = TipForce { normal: 1e-7, lateral: 0.0 };
    let failure = Pushing { constants, ..nominal() }.balance(Mode::Slide, force).unwrap_err();
    assert!(failure.to_string().starts_with("tip_friction is outside"), "{failure}");
    assert_eq!(
        nominal().critical_tip_force(Mode::Slide, 1.6),
        Err(Failure::OutOfDomain { parameter: "psi", domain: Domain::AcuteAngle })
    );
    let torn = TipForce { normal: -1e-6, lateral: 0.0 };
    assert_eq!(nominal().balance(Mode::Slide, torn), Err(Failure::BeyondPullOff));
}

fn pushing() -> impl Strategy<Value = Pushing> {
    let scene = (-9.0..-5.0_f64, 8.0..13.0_f64, prop_oneof![Just(0.0), 0.0..3.0_f64], 0.0..1.57_f64);
    (scene, proptest::sample::select(ContactTheory::ALL.to_vec()), any::<bool>()).prop_map(
        |((radius, modulus, adhesion, contact_angle), theory, adhesion_in_load)| {
            let scene = Scene {
                particle_radius: libm::pow(10.0, radius),
                equivalent_modulus: libm::pow(10.0, modulus),
                adhesion,
                contact_angle,
                ..Scene::default()
            };
            Pushing { theory, adhesion_in_load, ..Pushing::new(scene) }
        },
    )
}

proptest! {
    /// The force of the diagram solves its implicit formula: 1e-9, since near tan psi = mu_s its bracket cancels.
    #[test]
    fn mode_diagram_solves_its_formula(pushing in pushing(), angle in 0.0..=1.57_f64) {
        let bracket = libm::sin(angle) - 0.8 * libm::cos(angle);
        prop_assume!(bracket.abs() > 1e-3);
        match pushing.critical_tip_force(Mode::Slide, angle).unwrap() {
            None => prop_assert!(bracket < 0.0),
            Some(force) => {
                let pair = Pair::substrate(&pushing.scene);
                let contact = pushing.theory.contact(&pair, force * libm::cos(angle)).unwrap();
                let adhesive = if pushing.adhesion_in_load { pushing.theory.pull_off(&pair) } else { 0.0 };
                let expected = (28e6 * contact.area() + 0.8 * adhesive) / bracket;
                prop_assert!((force - expected).abs() <= 1e-9 * expected, "{force} {expected}");
            }
        }
    }

    /// The onset separates sticking from motion.
    #[test]
    fn onsets_part_rest_from_motion(pushing in pushing(), log_normal in -9.0..-5.0_f64) {
        let normal = libm::pow(10.0, log_normal);
        for mode in Mode::ALL {
            let moves = |lateral| pushing.balance(mode, TipForce { normal, lateral }).unwrap().moves();
            match pushing.onset(mode, normal).unwrap() {
                Onset::AtOnce => prop_assert!(moves(0.0)),
                Onset::At(lateral) => {
                    prop_assert!(moves(lateral.max(1e-18) * (1.0 + 1e-9)));
                    prop_assert!(!moves(lateral * (1.0 - 1e-9)));
                }
                Onset::Never => prop_assert!(!moves(0.0) && !moves(1.0)),
            }
        }
    }
}
