//! The equations of motion of the tip, its apex fixed to the particle (Tafazzoli & Sitti 2004).
//!
//! With y_P the lateral deflection of the cantilever and theta its twist, and the apex at s = V t,
//!
//!   y_P + H sin theta = s,  I_T theta'' = H (K_y y_P cos theta + K_z z_P sin theta) - K_theta theta,
//!
//! with I_T = I_p + m H^2/2 the moment of inertia about the apex. Integrated as y_P' = V - H theta' cos theta with
//! theta', the twist from the constraint: y_P and not theta, since F_Y = K_y y_P and the cantilever is far stiffer
//! laterally than in torsion. In units of the quasi-static slip: its F_Y for forces, its time for time, V/H for theta'.

use super::slip::Slip;
use super::statics::Statics;
use super::swing::{Swing, inertia_about_apex};
use crate::ode::Problem;
use crate::{Options, Scene};

/// The tip pushed by a stuck particle. Unknowns: K_y y_P and theta'.
pub(super) struct Motion<'a> {
    pub scene: &'a Scene,
    pub statics: &'a Statics<'a>,
    /// Units of force (N) and of length V t_cr (m).
    pub force: f64,
    pub length: f64,
    /// I_T (kg m2) and m (kg).
    pub inertia: f64,
    mass: f64,
    /// The time unit (s): travel to the slip over V.
    pub time: f64,
    /// K_y over the unit of stiffness.
    pub stiffness: f64,
    /// theta'' in units of V/H per unit of time, per newton of moment over H.
    agility: f64,
}

/// A twist of the tip.
pub(super) struct Twist {
    theta: f64,
    sin: f64,
    cos: f64,
    /// F_Z of the probe alone (N).
    pub normal_spring: f64,
}

/// The tip at an instant, in SI.
pub(super) struct Tip {
    pub twist: f64,
    pub lateral_force: f64,
    pub normal_force: f64,
}

impl<'a> Motion<'a> {
    /// Creates the motion of a scene whose quasi-static slip is `slip`, at a velocity above zero.
    pub fn new(scene: &'a Scene, statics: &'a Statics<'a>, slip: &Slip) -> Self {
        let &Slip { lateral_force: force, travel: length, .. } = slip;
        let (time, inertia, height) = (length / scene.velocity, inertia_about_apex(scene), scene.height);
        Self {
            scene,
            statics,
            force,
            length,
            inertia,
            mass: scene.effective_tip_mass(),
            time,
            stiffness: statics.probe.lateral * length / force,
            agility: height * time * (height / scene.velocity) / inertia,
        }
    }

    /// Returns the frequency of the fastest motion: the swing of the tip about the apex, in radians per unit of time.
    pub fn frequency(&self) -> f64 {
        self.swing().frequency * self.time
    }

    pub fn swing(&self) -> Swing {
        Swing::new(self.scene, &self.statics.probe)
    }

    /// Returns the twist at the apex position `s` (units of length), with the lateral force `q` (units of force). NaN
    /// if the tip would have to be longer.
    pub fn twist(&self, s: f64, q: f64) -> Twist {
        let deflection = q * self.force / self.statics.probe.lateral;
        let theta = libm::asin((s * self.length - deflection) / self.scene.height);
        let (sin, cos) = libm::sincos(theta);
        Twist { theta, sin, cos, normal_spring: self.statics.normal_force(theta) }
    }

    /// Returns y' of `Motion` at a twist, where the apex moves at `u` (units of V).
    pub fn rates(&self, twist: &Twist, u: f64, &[q, w]: &[f64; 2]) -> [f64; 2] {
        [self.stiffness * (u - w * twist.cos), self.agility * self.moment(twist, q)]
    }

    /// Returns the moment about the apex over H (N): F_Y cos theta + F_Z sin theta - K_theta theta/H.
    fn moment(&self, twist: &Twist, q: f64) -> f64 {
        let lateral = self.statics.restoring * twist.theta - twist.normal_spring * twist.sin;
        q * self.force * twist.cos - lateral
    }

    /// Returns the derivatives of [`rates`](Self::rates) by q, w, and s.
    pub fn slopes(&self, twist: &Twist, &[q, w]: &[f64; 2]) -> [[f64; 3]; 2] {
        let (&Self { stiffness, agility, .. }, &Twist { theta, sin, cos, .. }) = (self, twist);
        let by_s = self.length / (self.scene.height * cos);
        let by_q = -by_s / stiffness;
        let turning = stiffness * w * sin;
        let moment = -q * self.force * sin - self.statics.lateral_moment_slope(theta);
        [
            [turning * by_q, -stiffness * cos, turning * by_s],
            [agility * (self.force * cos + moment * by_q), 0.0, agility * moment * by_s],
        ]
    }

    /// Returns the forces of the tip on the particle, by the printed equations, at the apex position `s`, without the
    /// accelerations of the indentations, which follow the forces.
    pub fn tip(&self, s: f64, &[q, w]: &[f64; 2]) -> Tip {
        let twist = self.twist(s, q);
        let Twist { theta, sin, cos, normal_spring } = twist;
        let height = self.scene.height;
        let spin = w * self.scene.velocity / height;
        let lateral_spring = q * self.force;
        let moment = self.moment(&twist, q);
        let angular = height * moment / self.inertia;
        let half = 0.5 * self.mass * height;
        // I_p = I_T - m H^2/2.
        let turning = (self.inertia - half * height) / height * angular;
        // [K_theta th/H] sin th + K_z z_P cos^2 th - K_y y_P sin th cos th, minus the moment it contains.
        let normal_force = normal_spring - moment * sin + turning * sin - half * cos * spin * spin;
        let lateral_force = lateral_spring + half * (spin * spin * sin - angular * cos);
        Tip { twist: theta, lateral_force, normal_force }
    }
}

impl Problem<2> for Motion<'_> {
    fn rate(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        self.rates(&self.twist(t, y[0]), 1.0, y)
    }

    fn jacobian(&self, t: f64, y: &[f64; 2]) -> [[f64; 2]; 2] {
        self.slopes(&self.twist(t, y[0]), y).map(|[by_q, by_w, _]| [by_q, by_w])
    }

    fn time_rate(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        self.slopes(&self.twist(t, y[0]), y).map(|[_, _, by_s]| by_s)
    }
}

/// Minimum local tolerance: below it rounding is visible.
pub(super) const FINEST: f64 = 1e-12;

/// Returns the tolerance of a step.
pub(super) fn local_tolerance(options: &Options) -> f64 {
    (0.1 * options.tolerance).max(FINEST)
}
