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
#[path = "tests/history.rs"]
mod tests;
