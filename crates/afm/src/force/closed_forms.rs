//! The closed form of many scenes at once, column by column: the same operations for each scene as in
//! [`critical_force`](super::critical_force), so that the compiler can use vector registers, and only the requested
//! results.

use std::f64::consts::FRAC_PI_2;
use std::ops::RangeInclusive;

use apportion_base::quantity::Domain;
use multiversion::multiversion;

use super::presliding::Presliding;
use super::slip::{ORDINARY_SQUARES, Slip, critical_time};
use super::substrate::{Substrate, adhesion};
use super::{Fidelity, Options, closed_form};
use crate::contact::{Contact, Pair};
use crate::friction::{Drive, LuGreForm, Pressed};
use crate::probe::Probe;
use crate::{ContactTheory, Failure, Flag, Flags, FrictionLaw, Parameter, Scene, Torsion};

/// Maximum number of scenes at once: their columns fit into the nearest cache.
pub const AT_ONCE: usize = 64;

/// A number for each scene.
pub type Column = [f64; AT_ONCE];

/// Scenes with parameters far from overflow, computed at once.
pub struct ClosedForms {
    scene: Scene,
    options: Options,
    drive: Drive,
    columns: Columns,
    probes: Probes,
    slips: Slips,
    flags: [Flags; AT_ONCE],
}

/// The results of each scene.
pub struct Slips {
    /// Normal force on the tip (N).
    pub normal_force: Column,
    /// Lateral force on the tip (N).
    pub lateral_force: Column,
    /// Critical force (N).
    pub critical_force: Column,
    /// Travel of the substrate (m).
    pub travel: Column,
    /// Radius of the contact between particle and substrate (m).
    pub contact_radius: Column,
    /// Twist of the cantilever (rad).
    pub twist: Column,
    /// Estimated relative error of the critical force.
    pub error_estimate: Column,
}

/// Intermediate stiffnesses and forces of each scene.
struct Probes {
    normal: Column,
    lateral: Column,
    torsional: Column,
    apex: Column,
    preload_force: Column,
    adhesive_load: Column,
    support: Column,
    of_law: Column,
}

macro_rules! columns {
    ($($field:ident)+) => {
        /// The parameters that may differ between the scenes.
        struct Columns { $($field: Column),+ }

        impl Columns {
            fn from_scene(scene: &Scene) -> Self {
                Self { $($field: [scene.$field; AT_ONCE]),+ }
            }

            /// Returns the column of a parameter, if it has one.
            fn get(&mut self, name: &str) -> Option<&mut Column> {
                match name { $(stringify!($field) => Some(&mut self.$field),)+ _ => None }
            }

            #[inline(always)]
            fn scene(&self, i: usize, rest: &Scene) -> Scene {
                Scene { $($field: self.$field[i],)+ ..*rest }
            }
        }
    };
}

columns! {
    length width thickness height velocity elastic_modulus equivalent_modulus adhesion poisson_ratio probe_density
    tip_base_radius particle_radius static_friction dynamic_friction shear_strength viscous_friction stribeck_velocity
    equilibrium_separation hardness
}

impl ClosedForms {
    /// Creates scenes that differ from `scene` in `parameters`. `None` if they must be computed one by one: by another
    /// rung, with an integrated law, with parameters without columns, or with numbers that may overflow.
    pub fn new(scene: &Scene, options: &Options, parameters: &[&'static Parameter]) -> Option<Self> {
        let mut columns = Columns::from_scene(scene);
        let is_closed = options.fidelity == Fidelity::ClosedForm && options.friction != FrictionLaw::LemaitreCarlson;
        let has_columns = parameters.iter().all(|parameter| columns.get(parameter.name).is_some());
        let mut others = Parameter::ALL.iter().filter(|other| parameters.iter().all(|one| one.name != other.name));
        let are_ordinary = others.all(|other| ordinary(other.domain).contains(&(other.get)(scene)));
        if !(is_closed && has_columns && are_ordinary && options.check().is_ok()) {
            return None;
        }
        let probe = Probe::new(scene, options.torsion);
        let drive = Substrate::new(scene, options, &probe, LuGreForm::Fast).drive;
        let (probes, slips, flags) = (Probes::none(), Slips::none(), [Flags::NONE; AT_ONCE]);
        Some(Self { scene: *scene, options: *options, drive, columns, probes, slips, flags })
    }

    /// Sets `parameter` of the first scenes, at most [`AT_ONCE`], to these values. Returns false if one of them
    /// requires the scenes to be computed one by one.
    pub fn set(&mut self, parameter: &Parameter, values: &[f64]) -> bool {
        let Some(column) = self.columns.get(parameter.name) else { return false };
        column[..values.len()].copy_from_slice(values);
        let ordinary = ordinary(parameter.domain);
        // One pass without early exit, many values at a time.
        values.iter().fold(true, |all, value| all & ordinary.contains(value))
    }

    /// Returns the last results.
    pub fn slips(&self) -> &Slips {
        &self.slips
    }

    /// Computes the slips of all scenes.
    pub fn solve(&mut self) {
        let Self { scene, options, drive, columns, probes, slips, .. } = self;
        press(scene, options, columns, probes, &mut slips.contact_radius);
        slide(scene, options, drive, columns, probes, slips);
        if options.accurate_time {
            creep(scene, options, drive, columns, probes, slips);
        }
        doubt(scene, options, columns, slips, &mut self.flags);
    }

    /// Returns whether the results of the first `scenes` are valid. Otherwise use
    /// [`critical_force`](super::critical_force).
    pub fn are_ordinary(&self, scenes: usize) -> bool {
        let Slips { critical_force, travel, contact_radius, twist, error_estimate, .. } = &self.slips;
        let forces = ORDINARY_SQUARES.start().sqrt()..=ORDINARY_SQUARES.end().sqrt();
        (0..scenes).fold(true, |all, i| {
            all & forces.contains(&critical_force[i])
                & (contact_radius[i] <= 1e60)
                & (travel[i] <= f64::MAX)
                & (twist[i] <= f64::MAX)
                & (error_estimate[i] <= 1.0)
        })
    }

    /// Adds how often each flag is raised by the first `scenes`, in the order of [`Flag::ALL`].
    pub fn count_flags(&self, scenes: usize, mut add: impl FnMut(usize, u64)) {
        for (number, &flag) in Flag::ALL.iter().enumerate() {
            // At most `AT_ONCE`, which fits into eight bits.
            let raised = self.flags[..scenes].iter().fold(0, |raised, flags| raised + u8::from(flags.contains(flag)));
            add(number, raised.into());
        }
    }

    /// Returns the time until scene number `i` slips (s).
    ///
    /// # Errors
    /// As in [`Critical::critical_time`](super::Critical::critical_time).
    pub fn critical_time(&self, i: usize) -> Result<f64, Failure> {
        critical_time(self.slips.travel[i], self.columns.velocity[i])
    }

    /// Returns the indentation of the contact between particle and substrate of scene number `i` (m).
    ///
    /// # Errors
    /// Those of [`ContactTheory::contact`].
    pub fn indentation(&self, i: usize) -> Result<f64, Failure> {
        let pair = Pair::substrate(&self.columns.scene(i, &self.scene));
        Ok(self.options.contact.contact(&pair, self.slips.normal_force[i])?.indentation)
    }
}

impl Probes {
    fn none() -> Self {
        let none = [0.0; AT_ONCE];
        Self {
            normal: none,
            lateral: none,
            torsional: none,
            apex: none,
            preload_force: none,
            adhesive_load: none,
            support: none,
            of_law: none,
        }
    }

    #[inline(always)]
    fn probe(&self, i: usize) -> Probe {
        Probe {
            normal: self.normal[i],
            lateral: self.lateral[i],
            torsional: self.torsional[i],
            apex: self.apex[i],
            preload_deflection: 0.0,
            preload_force: self.preload_force[i],
        }
    }

    #[inline(always)]
    fn substrate<'a>(&self, i: usize, scene: &'a Scene, options: &'a Options, drive: Drive) -> Substrate<'a> {
        let (adhesive_load, support) = (self.adhesive_load[i], self.support[i]);
        Substrate { scene, options, pair: Pair::substrate(scene), adhesive_load, support, drive }
    }
}

impl Slips {
    fn none() -> Self {
        let none = [0.0; AT_ONCE];
        Self {
            normal_force: none,
            lateral_force: none,
            critical_force: none,
            travel: none,
            contact_radius: none,
            twist: none,
            error_estimate: none,
        }
    }
}

/// Returns the part of a domain from which no intermediate result overflows unnoticed.
fn ordinary(domain: Domain) -> RangeInclusive<f64> {
    match domain {
        Domain::Positive => 1e-60..=1e60,
        Domain::NonNegative => 0.0..=1e60,
        Domain::PoissonRatio => (-1.0_f64).next_up()..=0.5,
        Domain::AcuteAngle => 0.0..=FRAC_PI_2,
    }
}

/// Each theory and formula has its own loops, in which it is a constant.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn press(scene: &Scene, options: &Options, columns: &Columns, probes: &mut Probes, radius: &mut Column) {
    match options.torsion {
        Torsion::ThinStrip => bend(scene, Torsion::ThinStrip, columns, probes),
        Torsion::Rectangle => bend(scene, Torsion::Rectangle, columns, probes),
    }
    match options.contact {
        ContactTheory::Jkr => {
            touch(scene, &Options { contact: ContactTheory::Jkr, ..*options }, columns, probes, radius)
        }
        _ => touch(scene, options, columns, probes, radius),
    }
}

#[inline(always)]
fn bend(scene: &Scene, torsion: Torsion, columns: &Columns, probes: &mut Probes) {
    let sine = libm::sin(scene.preload_angle);
    for i in 0..AT_ONCE {
        let probe = Probe::with_sine(&columns.scene(i, scene), torsion, sine);
        probes.normal[i] = probe.normal;
        probes.lateral[i] = probe.lateral;
        probes.torsional[i] = probe.torsional;
        probes.apex[i] = probe.apex;
        probes.preload_force[i] = probe.preload_force;
    }
}

#[inline(always)]
fn touch(scene: &Scene, options: &Options, columns: &Columns, probes: &mut Probes, radius: &mut Column) {
    for (i, radius) in radius.iter_mut().enumerate() {
        let pair = Pair::substrate(&columns.scene(i, scene));
        *radius = options.contact.radius(&pair, probes.preload_force[i]);
        (probes.adhesive_load[i], probes.support[i]) = adhesion(options, &pair);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn slide(scene: &Scene, options: &Options, drive: &Drive, columns: &Columns, probes: &mut Probes, slips: &mut Slips) {
    macro_rules! with_constant {
        ($($law:ident)+) => {
            match options.friction {
                $(FrictionLaw::$law => {
                    hold(scene, &Options { friction: FrictionLaw::$law, ..*options }, drive, columns, probes, slips);
                })+
                _ => hold(scene, options, drive, columns, probes, slips),
            }
        };
    }
    with_constant!(Coulomb HurtadoKim LuGre);
}

#[inline(always)]
fn hold(rest: &Scene, options: &Options, drive: &Drive, columns: &Columns, probes: &mut Probes, slips: &mut Slips) {
    for i in 0..AT_ONCE {
        let scene = columns.scene(i, rest);
        let drive = Drive { velocity: scene.velocity, stiffness: probes.apex[i], ..*drive };
        let load = probes.preload_force[i] + probes.adhesive_load[i];
        let pressed = Pressed { load, radius: slips.contact_radius[i] };
        // Only integrations can fail, and integrated laws are not computed here.
        let force = options.friction.capacity(&scene, pressed, &drive).map_or(f64::NAN, |held| held.force);
        let substrate = probes.substrate(i, &scene, options, drive);
        slips.lateral_force[i] = force;
        probes.of_law[i] = closed_form::of_law(&substrate, probes.preload_force[i], force);
    }
    // A separate loop, which has no calls and is vectorised.
    for i in 0..AT_ONCE {
        let scene = columns.scene(i, rest);
        let (probe, substrate) = (probes.probe(i), probes.substrate(i, &scene, options, *drive));
        let contact = Contact { radius: slips.contact_radius[i], indentation: 0.0 };
        let slip = closed_form::slip(&probe, scene.height, slips.lateral_force[i], contact);
        slips.normal_force[i] = slip.normal_force;
        slips.critical_force[i] = slip.squared().sqrt();
        slips.travel[i] = slip.travel;
        slips.twist[i] = slip.twist;
        slips.error_estimate[i] = closed_form::left_out(&substrate, &probe, &slip, probes.of_law[i]).of_ordinary(&slip);
    }
}

/// Adds the creep before the slips, which affects only their times.
fn creep(rest: &Scene, options: &Options, drive: &Drive, columns: &Columns, probes: &Probes, slips: &mut Slips) {
    for i in 0..AT_ONCE {
        let scene = columns.scene(i, rest);
        let drive = Drive { velocity: scene.velocity, stiffness: probes.apex[i], ..*drive };
        let (probe, substrate) = (probes.probe(i), probes.substrate(i, &scene, options, drive));
        let contact = Contact { radius: slips.contact_radius[i], indentation: 0.0 };
        let slip = closed_form::slip(&probe, scene.height, slips.lateral_force[i], contact);
        let presliding = Presliding::new(&substrate, &slip, &probe, probe.apex).unwrap_or_default();
        let slip = presliding.map_or(slip, |presliding| presliding.timed(&slip, probe.apex));
        slips.travel[i] = slip.travel + slip.advance;
        slips.error_estimate[i] =
            closed_form::error(&substrate, &probe, (&slip, presliding.as_ref()), probes.of_law[i]);
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn doubt(rest: &Scene, options: &Options, columns: &Columns, slips: &Slips, flags: &mut [Flags; AT_ONCE]) {
    match options.contact {
        ContactTheory::Jkr => look(rest, &Options { contact: ContactTheory::Jkr, ..*options }, columns, slips, flags),
        _ => look(rest, options, columns, slips, flags),
    }
}

#[inline(always)]
fn look(rest: &Scene, options: &Options, columns: &Columns, slips: &Slips, flags: &mut [Flags; AT_ONCE]) {
    for (i, flags) in flags.iter_mut().enumerate() {
        let scene = columns.scene(i, rest);
        let contact = Contact { radius: slips.contact_radius[i], indentation: 0.0 };
        let slip = Slip {
            normal_force: slips.normal_force[i],
            lateral_force: slips.lateral_force[i],
            travel: slips.travel[i],
            twist: slips.twist[i],
            contact,
            advance: 0.0,
            slowdown: 1.0,
        };
        *flags = closed_form::flags(&slip, &scene, options);
    }
}
