//! A friction law without a probe: against velocity, and along a given motion.

use std::f64::consts::PI;

use crate::friction::lemaitre_carlson::activation;
use crate::friction::{
    Armstrong, Coulomb, Dahl, FrictionLaw, HurtadoKim, LemaitreCarlson, LuGre, LuGreParameters, Pressed, Stribeck,
};
use crate::ode::{Control, DormandPrince, March, Problem};
use crate::{Failure, Scene};

/// A contact on the bench.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specimen<'a> {
    /// Law of friction.
    pub law: FrictionLaw,
    /// Constants of the law.
    pub scene: &'a Scene,
    /// Load, > 0, and radius of the contact.
    pub pressed: Pressed,
    /// Source of the LuGre parameters.
    pub lugre: LuGreParameters,
}

/// A motion forced on the specimen.
#[derive(Clone, Copy)]
pub(super) struct Motion<'a> {
    /// Velocity (m/s) at a time (s); also asked for times before the start, by laws with a lag.
    pub velocity: &'a dyn Fn(f64) -> f64,
    /// Its duration (s), > 0.
    pub duration: f64,
    /// Number of equal sampling steps, > 0.
    pub samples: u32,
}

/// The specimen at an instant of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Time (s).
    pub time: f64,
    /// Displacement since the start (m).
    pub displacement: f64,
    /// Velocity (m/s).
    pub velocity: f64,
    /// Friction force, positive against a positive velocity (N).
    pub force: f64,
}

/// Friction of steady sliding at `velocity` (m/s), >= 0 (N). If friction at rest may have any value up to a
/// largest one, that one at 0.
///
/// # Errors
/// [`Failure::VelocityZero`] for a Lemaitre-Carlson layer at rest.
pub(super) fn against_velocity(specimen: &Specimen, velocity: f64) -> Result<f64, Failure> {
    let &Specimen { law, scene, pressed, .. } = specimen;
    let load = pressed.load;
    Ok(match law {
        FrictionLaw::Coulomb => Coulomb(scene).capacity(pressed),
        FrictionLaw::HurtadoKim => HurtadoKim(scene).capacity(pressed.radius),
        FrictionLaw::LuGre => LuGre::from_scene(scene).steady_force(load, velocity),
        FrictionLaw::Dahl => Dahl(scene).capacity(load),
        FrictionLaw::Stribeck => Stribeck(scene).force(load, velocity),
        FrictionLaw::Armstrong => Armstrong(scene).sliding_force(load, velocity, velocity, scene.rest_time),
        FrictionLaw::LemaitreCarlson => {
            PI * pressed.radius * pressed.radius * LemaitreCarlson(scene).steady_stress(velocity)?
        }
    })
}

/// Friction along a motion, from rest without any force; `samples` + 1 samples, the first at time 0.
///
/// # Errors
/// [`Failure::StepBudget`] and [`Failure::StepTooSmall`] of the laws that are integrated.
pub(super) fn against_displacement(specimen: &Specimen, motion: &Motion) -> Result<Vec<Sample>, Failure> {
    let &Specimen { law, scene, pressed, lugre } = specimen;
    let load = pressed.load;
    match law {
        FrictionLaw::Coulomb | FrictionLaw::HurtadoKim | FrictionLaw::Stribeck => {
            let static_law = |v: f64| {
                against_velocity(specimen, v.abs()).map(|force| if v == 0.0 { 0.0 } else { force.copysign(v) })
            };
            motion.instants().map(|at| Ok(at.with(static_law(at.velocity)?))).collect()
        }
        FrictionLaw::LuGre => {
            let law = LuGre::with(scene, lugre, pressed.radius);
            let rate = |v: f64, &[p]: &[f64; 1]| {
                [law.stiffness * law.deflection_rate(load, p * load / law.stiffness, v) / load]
            };
            follow(motion, &rate, [0.0], |v, &[p]| law.force(load, p * load / law.stiffness, v))
        }
        FrictionLaw::Dahl => {
            let law = Dahl(scene);
            let rate = |v: f64, &[p]: &[f64; 1]| [v * law.slope(load, p * load, v.signum()) / load];
            follow(motion, &rate, [0.0], |_, &[p]| p * load)
        }
        FrictionLaw::Armstrong => Ok(armstrong(scene, load, motion)),
        FrictionLaw::LemaitreCarlson => {
            let area = PI * pressed.radius * pressed.radius;
            let rate = |v: f64, y: &[f64; 2]| rates_of_layer(scene, v, y);
            follow(motion, &rate, [0.0, scene.initial_disorder], |_, &[s, _]| s * scene.layer_stress * area)
        }
    }
}

/// d/dt of stress in units of mubar and of disorder (1/s) of a layer sheared at `velocity` (m/s) of either sign.
fn rates_of_layer(scene: &Scene, velocity: f64, &[s, disorder]: &[f64; 2]) -> [f64; 2] {
    let flow = scene.rearrangement_rate * activation(1.0, disorder) * libm::sinh(s);
    let ageing = scene.ageing_rate * activation(scene.ageing_barrier, disorder);
    let shear = velocity / (2.0 * scene.layer_half_thickness);
    [
        scene.layer_modulus / scene.layer_stress * (shear - flow),
        scene.disorder_gain * scene.layer_stress * s * flow - ageing,
    ]
}

impl Motion<'_> {
    /// The sampled instants, without their forces; displacement by Simpson's rule between them.
    fn instants(&self) -> impl Iterator<Item = Sample> + '_ {
        let step = self.duration / f64::from(self.samples);
        let mut displacement = 0.0;
        (0..=self.samples).map(move |i| {
            let time = f64::from(i) * step;
            let velocity = (self.velocity)(time);
            if i > 0 {
                let (before, middle) = ((self.velocity)(time - step), (self.velocity)(time - 0.5 * step));
                displacement += step / 6.0 * (before + 4.0 * middle + velocity);
            }
            Sample { time, displacement, velocity, force: 0.0 }
        })
    }
}

impl Sample {
    fn with(self, force: f64) -> Self {
        Self { force, ..self }
    }
}

/// State of a law along a motion, y' = rate(v(t), y).
struct Along<'a, const N: usize> {
    motion: &'a Motion<'a>,
    rate: &'a dyn Fn(f64, &[f64; N]) -> [f64; N],
}

impl<const N: usize> Problem<N> for Along<'_, N> {
    fn rate(&self, t: f64, y: &[f64; N]) -> [f64; N] {
        (self.rate)((self.motion.velocity)(t), y)
    }

    /// For the explicit method, which needs none.
    fn jacobian(&self, _: f64, _: &[f64; N]) -> [[f64; N]; N] {
        [[0.0; N]; N]
    }
}

fn follow<const N: usize>(
    motion: &Motion,
    rate: &dyn Fn(f64, &[f64; N]) -> [f64; N],
    start: [f64; N],
    force: impl Fn(f64, &[f64; N]) -> f64,
) -> Result<Vec<Sample>, Failure> {
    let step = motion.duration / f64::from(motion.samples);
    let control = Control {
        tolerance: 1e-9,
        scale: start.map(|value| if value > 0.0 { value } else { 1e-3 }),
        first_step: 1e-3 * step,
        longest_step: step,
        step_budget: 10_000_000,
    };
    let along = Along { motion, rate };
    let mut march = March::<DormandPrince, _, N>::new(&along, (0.0, start), control);
    let at = |sample: Sample| {
        while march.state().t < sample.time {
            march.advance(sample.time)?;
        }
        Ok(sample.with(force(sample.velocity, &march.state().y)))
    };
    motion.instants().map(at).collect()
}

enum Mode {
    /// The displacement at which the spring of the sticking contact is unloaded; since then it sticks.
    Sticking { slack: f64, since: f64 },
    /// In this direction, after this rest.
    Sliding { direction: f64, rest: f64 },
}

fn armstrong(scene: &Scene, load: f64, motion: &Motion) -> Vec<Sample> {
    let mut mode = Mode::Sticking { slack: 0.0, since: -scene.rest_time };
    let mut last = 0.0;
    let force = |at: Sample| {
        if let Mode::Sliding { direction, .. } = mode
            && at.velocity * direction <= 0.0
        {
            mode = Mode::Sticking { slack: at.displacement - last / scene.bristle_stiffness, since: at.time };
        }
        if let Mode::Sticking { slack, since } = mode {
            let held = scene.bristle_stiffness * (at.displacement - slack);
            // A spring that the motion unloads sticks at any strain.
            if held * at.velocity <= 0.0 || held.abs() <= Armstrong(scene).static_force(load, at.time - since) {
                last = held;
                return at.with(held);
            }
            mode = Mode::Sliding { direction: held.signum(), rest: at.time - since };
        }
        if let Mode::Sliding { direction, rest } = mode {
            let lagged = (motion.velocity)(at.time - scene.frictional_lag).abs();
            last = direction * Armstrong(scene).sliding_force(load, at.velocity.abs(), lagged, rest);
        }
        at.with(last)
    };
    motion.instants().map(force).collect()
}
