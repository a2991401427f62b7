//! One scene in time: sticking until the critical force, slipping after.
//!
//! Before the slip the particle moves with the substrate, except for the creep on its bristles, and moves the tip
//! through its equilibria: exact geometry, no inertia. The swing of the tip, 1e-7 of the force, would be invisible.
//! After the slip the tip holds the particle at rest and the substrate slides under it, with all forces constant
//! (Tafazzoli & Sitti 2004); on bristles they rise by the last 0.1 % after the slip. So the drop from static to sliding
//! friction is not followed: at V it is (V/v_s)^2 of the force for the Stribeck curves, but not small for
//! Lemaitre-Carlson, whose layer sticks and slips.

use apportion_base::quantity::Domain;

use super::contact::{Contact, Pair};
use super::force::{Presliding, Statics, Substrate};
use super::friction::LuGreForm;
use super::{Critical, Failure, Fidelity, Options, Scene, critical_force};
use crate::probe::Probe;
use crate::root::{self, Point};

/// The scene at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time since the substrate started (s).
    pub time: f64,
    /// Lateral force on the tip F_Y (N).
    pub lateral_force: f64,
    /// Normal force on the tip F_Z (N).
    pub normal_force: f64,
    /// Tip force F_T (N).
    pub tip_force: f64,
    /// Its angle psi from the vertical (rad).
    pub force_angle: f64,
    /// Twist of the cantilever theta (rad).
    pub twist: f64,
    /// Lateral deflection of the cantilever y_P (m).
    pub lateral_deflection: f64,
    /// Normal deflection of the cantilever z_P (m).
    pub normal_deflection: f64,
    /// Position of the substrate (m).
    pub substrate: f64,
    /// Position of the particle (m).
    pub particle: f64,
    /// Position of the particle relative to the substrate (m).
    pub relative: f64,
    /// Contact of particle and substrate.
    pub substrate_contact: Contact,
    /// Contact of particle and tip; `None` if the tip force pulls it apart.
    pub tip_contact: Option<Contact>,
    /// Whether the particle sticks to the substrate.
    pub sticking: bool,
}

/// A scene in time.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Samples in the order of time, from 0 to the duration. Between two of them every quantity is linear to
    /// [`STRAIGHT`] of its range. At the slip there are two: the last one that sticks and the first one that slips.
    pub samples: Vec<Sample>,
    /// The slip, by the quasi-static rung, which may be after the duration.
    pub critical: Critical,
}

/// Maximum deviation of a quantity from the line between two samples, as a share of its size.
pub const STRAIGHT: f64 = 1e-3;

/// Maximum number of halvings of an interval.
const DEEPEST: u32 = 12;

/// Computes the scene from the start of the substrate for `duration` (s).
///
/// # Errors
/// Those of [`critical_force`] at the quasi-static rung; [`Failure::VelocityZero`] if the substrate is at rest;
/// [`Failure::OutOfDomain`] if the duration is not a positive number; [`Failure::BeyondPullOff`] if the contact breaks.
///
/// # Example
/// ```
/// use apportion_afm::{Options, Scene, history};
///
/// let scene = Scene { shear_modulus: Some(40.5e9), ..Scene::default() };
/// let history = history::history(&scene, &Options::default(), 0.4)?;
/// let end = history.samples.last().unwrap();
/// assert_eq!(format!("{:.0} nm", end.relative * 1e9), "-19 nm");
/// # Ok::<(), apportion_afm::Failure>(())
/// ```
pub fn history(scene: &Scene, options: &Options, duration: f64) -> Result<History, Failure> {
    Failure::unless_in(Domain::Positive, "duration", duration)?;
    let options = Options { fidelity: Fidelity::QuasiStatic, accurate_time: true, ..*options };
    let critical = critical_force(scene, &options)?;
    let slip_time = critical.critical_time?;
    let stage = Stage::new(scene, &options, &critical)?;
    let at_peak = duration >= slip_time && stage.presliding.is_none();
    let last_twist = if at_peak { critical.twist } else { stage.twist_at(scene.velocity * duration.min(slip_time))? };
    let mut samples = vec![stage.sticking(0.0)?];
    // Start with quarters, so that a symmetric bend cannot be missed in the middle of the whole.
    for quarter in 1..=4 {
        let start = samples[samples.len() - 1];
        let end = stage.sticking(last_twist * f64::from(quarter) / 4.0)?;
        stage.refine((&start, &end), DEEPEST, &mut samples)?;
        samples.push(end);
    }
    if duration >= slip_time {
        let last = samples.len() - 1;
        // Exact to the bit; a value computed back from the twist would not be.
        samples[last].time = slip_time;
        samples.push(Sample { sticking: false, ..samples[last] });
        if duration > slip_time {
            samples.push(Sample { sticking: false, ..stage.at(duration)? });
        }
    }
    Ok(History { samples, critical })
}

/// Computes the scene at `times` (s, from 0 on, in any order), by the same rules, exactly; `take` receives each with
/// its index. If the substrate is at rest the scene stays as it was at the start.
///
/// # Errors
/// Those of [`history`], except [`Failure::VelocityZero`]; some samples may have been passed to `take` before.
pub fn at_times(
    scene: &Scene,
    options: &Options,
    times: &[f64],
    mut take: impl FnMut(usize, &Sample),
) -> Result<(), Failure> {
    let options = Options { fidelity: Fidelity::QuasiStatic, accurate_time: true, ..*options };
    let critical = critical_force(scene, &options)?;
    let slip_time = match critical.critical_time {
        Ok(time) => time,
        Err(Failure::VelocityZero) => f64::INFINITY,
        Err(failure) => return Err(failure),
    };
    let stage = Stage::new(scene, &options, &critical)?;
    for (place, &time) in times.iter().enumerate() {
        take(place, &Sample { sticking: time < slip_time, ..stage.at(time)? });
    }
    Ok(())
}

struct Stage<'a> {
    scene: &'a Scene,
    options: &'a Options,
    statics: Statics<'a>,
    /// The creep before the slip, on bristles.
    presliding: Option<Presliding>,
    /// F_Y at its peak (N).
    peak: f64,
    /// The twist from which on the tip holds the particle at rest: at the peak, or negligibly close to it.
    last_twist: f64,
    /// Travel of the substrate at that twist (m).
    last_travel: f64,
}

/// Share of the peak force that is negligible.
const UNSEEN: f64 = 1e-12;

impl<'a> Stage<'a> {
    fn new(scene: &'a Scene, options: &'a Options, critical: &Critical) -> Result<Self, Failure> {
        let probe = Probe::new(scene, options.torsion);
        let substrate = Substrate::new(scene, options, &probe, LuGreForm::Ramp);
        let statics = Statics::new(scene, &probe)?;
        let spring = statics.spring(critical.twist);
        let presliding = Presliding::new(&substrate, &critical.slip(), &probe, spring)?;
        let twist = critical.twist;
        let last_twist = if presliding.is_some() { twist * (1.0 - UNSEEN) } else { twist };
        let peak = critical.lateral_force;
        let stage = Self { scene, options, statics, presliding, peak, last_twist, last_travel: 0.0 };
        Ok(Self { last_travel: stage.travel(last_twist), ..stage })
    }

    /// Returns the creep of the particle on its bristles (m) at a lateral force (N).
    fn creep(&self, lateral_force: f64) -> f64 {
        let missing = (1.0 - lateral_force / self.peak).max(0.1 * UNSEEN);
        self.presliding.map_or(0.0, |presliding| presliding.creep(missing))
    }

    /// Returns the travel of the substrate (m) in equilibrium at a twist.
    fn travel(&self, twist: f64) -> f64 {
        let lateral_force = self.statics.lateral_force(twist);
        self.statics.travel(twist, lateral_force) + self.creep(lateral_force)
    }

    /// Returns the twist at the travel `travel` of the substrate, at most the last one.
    fn twist_at(&self, travel: f64) -> Result<f64, Failure> {
        if travel <= 0.0 || travel >= self.last_travel {
            return Ok(if travel <= 0.0 { 0.0 } else { self.last_twist });
        }
        let rest = Point { x: 0.0, y: self.travel(0.0) - travel };
        let slip = Point { x: self.last_twist, y: self.last_travel - travel };
        root::between(rest, slip, |twist| Ok(self.travel(twist) - travel))
    }

    /// Computes the scene at a time, except whether the particle sticks.
    fn at(&self, time: f64) -> Result<Sample, Failure> {
        let travel = self.scene.velocity * time;
        let sample = self.sticking(self.twist_at(travel)?)?;
        let slid = (travel - sample.substrate).max(0.0);
        let slid = if travel > self.last_travel { slid } else { 0.0 };
        Ok(Sample { time, substrate: sample.substrate + slid, relative: sample.relative - slid, ..sample })
    }

    fn sticking(&self, twist: f64) -> Result<Sample, Failure> {
        let &Scene { particle_radius, tip_radius, .. } = self.scene;
        let theory = self.options.contact;
        let normal_force = self.statics.normal_force(twist);
        let lateral_force = self.statics.lateral_force(twist);
        let particle = self.statics.travel(twist, lateral_force);
        let crept = self.creep(lateral_force);
        let substrate = particle + crept;
        let tip_force = libm::hypot(normal_force, lateral_force);
        let force_angle = libm::atan2(lateral_force, normal_force);
        let on_substrate = Pair::substrate(self.scene);
        let at_tip = Pair { radius: particle_radius * tip_radius / (particle_radius + tip_radius), ..on_substrate };
        let pressing = tip_force * libm::cos(force_angle - self.scene.contact_angle);
        let tip_contact = match theory.contact(&at_tip, pressing) {
            Ok(contact) => Some(contact),
            Err(Failure::BeyondPullOff) => None,
            Err(failure) => return Err(failure),
        };
        Ok(Sample {
            time: substrate / self.scene.velocity,
            lateral_force,
            normal_force,
            tip_force,
            force_angle,
            twist,
            lateral_deflection: lateral_force / self.statics.probe.lateral,
            normal_deflection: normal_force / self.statics.probe.normal,
            substrate,
            particle,
            relative: -crept,
            substrate_contact: theory.contact(&on_substrate, normal_force)?,
            tip_contact,
            sticking: true,
        })
    }

    /// Adds samples strictly between two sticking samples, until all quantities are linear.
    fn refine(&self, (start, end): (&Sample, &Sample), depth: u32, into: &mut Vec<Sample>) -> Result<(), Failure> {
        let middle = self.sticking(0.5 * (start.twist + end.twist))?;
        if depth == 0 || straight(start, &middle, end) {
            return Ok(());
        }
        self.refine((start, &middle), depth - 1, into)?;
        into.push(middle);
        self.refine((&middle, end), depth - 1, into)
    }
}

/// Returns whether the middle is on the line between the ends, in every quantity that may bend.
fn straight(start: &Sample, middle: &Sample, end: &Sample) -> bool {
    let span = end.time - start.time;
    if span <= 0.0 {
        return true;
    }
    let share = (middle.time - start.time) / span;
    let quantities: [fn(&Sample) -> f64; 10] = [
        |s| s.lateral_force,
        |s| s.normal_force,
        |s| s.tip_force,
        |s| s.force_angle,
        |s| s.twist,
        |s| s.normal_deflection,
        |s| s.substrate_contact.radius,
        |s| s.substrate_contact.indentation,
        |s| s.tip_contact.map_or(0.0, |contact| contact.radius),
        |s| s.tip_contact.map_or(0.0, |contact| contact.indentation),
    ];
    quantities.iter().all(|quantity| {
        let (a, b, c) = (quantity(start), quantity(middle), quantity(end));
        (b - (a + share * (c - a))).abs() <= STRAIGHT * a.abs().max(c.abs())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FrictionLaw;

    fn nominal() -> History {
        history(&Scene::default(), &Options::default(), 0.4).unwrap()
    }

    /// F_Y grows, F_Z hardly moves, F_T rises to F_cr and stays (their figures 8 and 9).
    #[test]
    fn forces_rise_to_the_critical_force_and_stay() {
        let History { samples, critical } = nominal();
        for pair in samples.windows(2) {
            assert!(pair[1].time >= pair[0].time && pair[1].lateral_force >= pair[0].lateral_force);
            assert!((pair[1].normal_force / 489.4e-9 - 1.0).abs() < 1e-3);
        }
        let slipping: Vec<_> = samples.iter().filter(|s| !s.sticking).collect();
        assert_eq!(slipping.len(), 2);
        // The force from the geometry against that from friction: they meet at the slip.
        assert!(slipping.iter().all(|s| (s.tip_force / critical.critical_force - 1.0).abs() < 1e-12));
        assert!((slipping[0].time / critical.critical_time.unwrap() - 1.0).abs() < 1e-12);
    }

    /// The printed run: slip at 0.209 s, then -V (t - t_cr), -19 nm at 0.4 s.
    #[test]
    fn the_particle_stays_behind_after_the_slip() {
        let scene = Scene { shear_modulus: Some(40.5e9), ..Scene::default() };
        let History { samples, .. } = history(&scene, &Options::default(), 0.4).unwrap();
        let end = samples[samples.len() - 1];
        assert!((end.time, end.sticking) == (0.4, false));
        assert!((end.relative + 19.1e-9).abs() < 0.1e-9, "{}", end.relative);
        assert!((end.particle - end.substrate - end.relative).abs() < 1e-20);
        assert!(samples.iter().filter(|s| s.sticking).all(|s| s.relative == 0.0 && s.particle == s.substrate));
    }

    /// The tip presses harder and harder while the normal force on the particle hardly decreases (their figure 13).
    #[test]
    fn the_tip_contact_grows_and_the_substrate_contact_shrinks() {
        let History { samples, .. } = nominal();
        for pair in samples.windows(2).filter(|pair| pair[1].sticking) {
            let [before, after] = [pair[0].tip_contact.unwrap(), pair[1].tip_contact.unwrap()];
            assert!(after.radius > before.radius && after.indentation > before.indentation);
            assert!(pair[1].substrate_contact.radius < pair[0].substrate_contact.radius);
        }
    }

    /// Linear between samples by the definition, tested at a third of the way, with no more samples than needed.
    #[test]
    fn samples_are_where_things_bend() {
        let scene = Scene { static_friction: 100.0, ..Scene::default() };
        let options = Options::default();
        let History { samples, critical } = history(&scene, &options, 1e3).unwrap();
        let stage = Stage::new(&scene, &options, &critical).unwrap();
        for pair in samples.windows(2).filter(|pair| pair[1].sticking) {
            let between = stage.sticking(pair[0].twist + (pair[1].twist - pair[0].twist) / 3.0).unwrap();
            let share = (between.time - pair[0].time) / (pair[1].time - pair[0].time);
            let line = pair[0].tip_force + share * (pair[1].tip_force - pair[0].tip_force);
            assert!((between.tip_force - line).abs() < 1.5 * STRAIGHT * pair[1].tip_force);
        }
        assert!(samples.len() < 200 && nominal().samples.len() < 100, "{} {}", samples.len(), nominal().samples.len());
    }

    #[test]
    fn a_run_may_end_before_the_slip() {
        let History { samples, critical } = history(&Scene::default(), &Options::default(), 0.05).unwrap();
        let end = samples[samples.len() - 1];
        assert!(end.sticking && (end.time / 0.05 - 1.0).abs() < 1e-12 && critical.critical_time.unwrap() > 0.05);
    }

    #[test]
    fn without_friction_the_particle_slips_at_once() {
        let smooth = Scene { static_friction: 0.0, shear_strength: 0.0, ..Scene::default() };
        let history = history(&smooth, &Options::default(), 0.4).unwrap();
        assert!((history.samples[history.samples.len() - 1].relative + 40e-9).abs() < 1e-20);
    }

    /// The same as the samples of a history, if it has samples at these times.
    #[test]
    fn times_are_those_of_the_history() {
        for friction in FrictionLaw::ALL {
            let options = Options { friction, ..Options::default() };
            let samples = history(&Scene::default(), &options, 0.4).unwrap().samples;
            let slip = samples.iter().position(|sample| !sample.sticking).unwrap();
            // The last that sticks is at the same time as the first that slips.
            let samples: Vec<Sample> = samples[..slip - 1].iter().chain(&samples[slip..]).copied().collect();
            let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
            let mut taken = 0;
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
            at_times(&Scene::default(), &options, &times, |place, sample| {
                let other = &samples[place];
                assert!(close(sample.tip_force, other.tip_force) && close(sample.particle, other.particle));
                assert!(close(sample.substrate_contact.radius, other.substrate_contact.radius));
                assert_eq!((sample.time, sample.sticking), (other.time, other.sticking));
                taken += 1;
            })
            .unwrap();
            assert_eq!(taken, times.len());
        }
    }

    #[test]
    fn a_substrate_at_rest_moves_nothing() {
        let resting = Scene { velocity: 0.0, ..Scene::default() };
        let mut forces = Vec::new();
        at_times(&resting, &Options::default(), &[0.0, 1.0, 1e9], |_, sample| {
            assert!(sample.sticking && sample.particle == 0.0);
            forces.push(sample.tip_force);
        })
        .unwrap();
        assert!(forces.len() == 3 && forces[0] == forces[1] && forces[1] == forces[2] && forces[0] > 0.0);
    }

    #[test]
    fn models_that_cannot_run_are_named() {
        let resting = Scene { velocity: 0.0, ..Scene::default() };
        assert_eq!(history(&resting, &Options::default(), 0.4), Err(Failure::VelocityZero));
        for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let named = Failure::OutOfDomain { parameter: "duration", domain: Domain::Positive };
            assert_eq!(history(&Scene::default(), &Options::default(), duration), Err(named));
        }
    }
}
