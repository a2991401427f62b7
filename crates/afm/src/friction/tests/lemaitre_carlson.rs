use super::*;
use crate::ode::assert_jacobian;
use crate::root::{self, Point};

const PRESSED: Pressed = Pressed { load: 4.9e-7, radius: 9.09e-9 };

/// Returns the stress over mubar over the last half of a strain of `strain`, at `velocity` through a spring of
/// `stiffness`: minimum and maximum.
fn swing(velocity: f64, stiffness: f64, strain: f64) -> (f64, f64) {
    let drive = Drive { tolerance: 1e-6, ..Drive::from_scene(&Scene::default(), stiffness) };
    let scene = Scene::default();
    let layer = LemaitreCarlson(&scene).sheared(PI * PRESSED.radius.powi(2), velocity, stiffness);
    let mut march = March::<Rodas, _, 2>::new(&layer, (0.0, [0.0, 0.06]), layer.control(&drive));
    let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
    while march.state().t < strain {
        march.advance(strain).unwrap();
        if march.state().t > 0.5 * strain {
            least = least.min(march.state().y[0]);
            largest = largest.max(march.state().y[0]);
        }
    }
    (least, largest)
}

/// On a stiff spring the stress peaks and settles; on a soft one it sticks and slips. 1e-4 is the rest of the
/// settling.
#[test]
fn stick_slip_gives_way_to_steady_sliding() {
    let (least, largest) = swing(1e-7, f64::INFINITY, 1e3);
    assert!(largest - least < 1e-4 * largest, "{least} {largest}");
    let steady = LemaitreCarlson(&Scene::default()).steady_stress(1e-7).unwrap() / 10e6;
    assert!((largest / steady - 1.0).abs() < 1e-4, "{largest} {steady}");
    let (least, largest) = swing(1e-7, 0.1, 1e4);
    assert!(largest > 1.5 * least, "{least} {largest}");
}

/// About the shear strength of 28 MPa at 100 nm/s, for which the defaults were chosen; weaker when faster.
#[test]
fn steady_sliding_weakens_with_velocity() {
    let stress = |velocity| LemaitreCarlson(&Scene::default()).steady_stress(velocity).unwrap();
    assert!((stress(1e-7) / 28e6 - 1.0).abs() < 0.1, "{}", stress(1e-7));
    assert!(stress(1e-8) > stress(1e-7) && stress(1e-7) > stress(1e-6));
    assert_eq!(LemaitreCarlson(&Scene::default()).steady_stress(0.0), Err(Failure::VelocityZero));
}

/// Break-away is above steady sliding, and higher for an older (less disordered) layer.
#[test]
fn break_away_rises_with_age() {
    let drive = Drive::from_scene(&Scene::default(), 30.0);
    let force = |initial_disorder| {
        let scene = Scene { initial_disorder, ..Scene::default() };
        LemaitreCarlson(&scene).capacity(PRESSED, &drive).unwrap().force
    };
    let steady = LemaitreCarlson(&Scene::default()).steady_stress(1e-7).unwrap() * PI * PRESSED.radius.powi(2);
    assert!(force(0.06) > steady && force(0.05) > force(0.06), "{} {steady}", force(0.06));
}

#[test]
fn a_layer_at_rest_has_no_break_away_force() {
    let drive = Drive { velocity: 0.0, ..Drive::from_scene(&Scene::default(), 30.0) };
    assert_eq!(LemaitreCarlson(&Scene::default()).capacity(PRESSED, &drive), Err(Failure::VelocityZero));
}

#[test]
fn the_jacobian_is_the_derivative() {
    let scene = Scene::default();
    assert_jacobian(&LemaitreCarlson(&scene).sheared(2.6e-16, 1e-7, 30.0), [2.5, 0.11], 1e-6);
}

impl LemaitreCarlson<'_> {
    /// Returns the stress of steady sliding at `velocity` (m/s), > 0 (Pa): the disorder at which ageing balances
    /// plastic work, chi = kappa/ln(E1/(alpha sig gam')), inserted in gam' = V/(2h). If work exceeds ageing, chi grows
    /// without bound and exp(-1/chi) is one.
    ///
    /// # Errors
    /// [`Failure::VelocityZero`] at rest.
    pub fn steady_stress(&self, velocity: f64) -> Result<f64, Failure> {
        if velocity == 0.0 {
            return Err(Failure::VelocityZero);
        }
        let rate = velocity / (2.0 * self.0.layer_half_thickness);
        // In logarithms, increasing in sig: ln sinh(sig/mubar) + ln(E0/rate) - 1/chi.
        let balance = |s: f64| {
            let disorder = self.0.disorder_gain * self.0.layer_stress * s * rate / self.0.ageing_rate;
            let barrier = (-libm::log(disorder) / self.0.ageing_barrier).max(0.0);
            let ln_sinh = s + libm::log(-libm::expm1(-2.0 * s)) - std::f64::consts::LN_2;
            Ok(ln_sinh + libm::log(self.0.rearrangement_rate / rate) - barrier)
        };
        let (low, high) = (f64::MIN_POSITIVE, 1e6);
        let s = root::between(Point { x: low, y: balance(low)? }, Point { x: high, y: balance(high)? }, balance)?;
        Ok(s * self.0.layer_stress)
    }
}
