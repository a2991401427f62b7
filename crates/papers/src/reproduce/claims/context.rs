//! What the checks are computed with: the physics, the box of the papers' general study, and the nine studies.

use apportion::design::SobolSequence;
use apportion::space::Space;
use apportion::uncertainty::Interval;
use apportion_afm::history::{History, history};
use apportion_afm::modes::Pushing;
use apportion_afm::{Critical, Failure, Fidelity, FrictionLaw, Options, Parameter, Scene, critical_force, edge_unit};
use apportion_base::sum;

use super::curve::{Curve, grid};
use super::judge::{ClaimPart, Share, number};
use crate::reproduce::studies::{Effort, Friction, Reproduced, general_study};
use crate::reproduce::words::Words;

/// Seed of every sample of the box.
const SEED: u64 = 5;

/// Number of independent scrambles for the interval of a share: enough degrees of freedom for a t-quantile near 2.
const REPLICATES: u64 = 8;

/// A function for the critical force of a scene, such as [`critical_force`].
pub(super) type ForceOf<'a> = &'a dyn Fn(&Scene, &Options) -> Result<Critical, Failure>;
/// A function for a scene in time, such as [`history`].
pub(super) type HistoryOf<'a> = &'a dyn Fn(&Scene, &Options, f64) -> Result<History, Failure>;

/// The physics of the checks: ours, or a modified one in a test.
#[derive(Clone, Copy)]
pub(super) struct Physics<'a> {
    pub force: ForceOf<'a>,
    pub history: HistoryOf<'a>,
    pub pushing: &'a dyn Fn(Scene) -> Pushing,
}

impl Physics<'static> {
    pub fn ours() -> Self {
        Self { force: &critical_force, history: &history, pushing: &Pushing::new }
    }
}

/// The numbers of points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Points of the box for checks with closed formulas.
    pub points: u64,
    /// Points of the box for checks with a history or a search for equilibria.
    pub slow_points: u64,
    /// Points of the box for checks with an integration of LuGre friction, a third of a millisecond each.
    pub ramp_points: u64,
    /// Points of a curve.
    pub curve: usize,
}

impl Sizes {
    fn new(effort: Effort) -> Self {
        match effort {
            Effort::Full => Self { points: 8192, slow_points: 1024, ramp_points: 64, curve: 25 },
            Effort::Quick => Self { points: 1024, slow_points: 128, ramp_points: 8, curve: 13 },
        }
    }

    /// Returns the values that the texts of claims name.
    pub fn words(&self) -> Words {
        let curve = ("curve", self.curve.to_string());
        vec![("points", self.points.to_string()), ("slow_points", self.slow_points.to_string()), curve]
    }
}

/// Evenly spaced values of one constant of the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub parameter: &'static Parameter,
    /// First and last value (SI).
    pub range: (f64, f64),
    /// Number of values.
    pub count: usize,
}

impl Sweep {
    /// Describes it as in `200 to 700 um`.
    pub fn words(&self) -> String {
        let unit = edge_unit(self.parameter);
        let (low, high) = (unit.from_si(self.range.0), unit.from_si(self.range.1));
        format!("{} to {}", number(low, ""), number(high, &unit.to_string()))
    }
}

/// The data for the checks of all claims.
pub(super) struct ClaimContext<'a> {
    pub physics: Physics<'a>,
    pub sizes: Sizes,
    /// The studies with their results.
    pub studies: &'a [Reproduced],
    space: Space,
}

impl<'a> ClaimContext<'a> {
    /// Creates the context with the ranges of the general study.
    pub fn new(physics: Physics<'a>, effort: Effort, studies: &'a [Reproduced]) -> Self {
        Self { physics, sizes: Sizes::new(effort), studies, space: general_study().space().clone() }
    }

    /// Returns F_cr (N).
    pub fn force(&self, scene: &Scene, options: &Options) -> Result<f64, Failure> {
        Ok((self.physics.force)(scene, options)?.critical_force)
    }

    /// Returns a sweep of a factor over its range in the general study.
    pub fn over(&self, name: &str) -> Sweep {
        let factor = self.space.factors().iter().find(|factor| factor.name == name).expect("a factor of the study");
        let (low, high) = factor.distribution().support();
        let range = (factor.unit().to_si(low), factor.unit().to_si(high));
        Sweep { parameter: parameter(name), range, count: self.sizes.curve }
    }

    /// Returns F_cr along a sweep of one constant of `scene`.
    pub fn curve(&self, sweep: &Sweep, scene: &Scene, options: &Options) -> Result<Curve, Failure> {
        self.curve_of(sweep, scene, |scene| self.force(scene, options))
    }

    /// Returns any quantity along a sweep of one constant of `scene`.
    pub fn curve_of(
        &self,
        sweep: &Sweep,
        scene: &Scene,
        quantity: impl Fn(&Scene) -> Result<f64, Failure>,
    ) -> Result<Curve, Failure> {
        let (x, mut scene) = (grid(sweep.range, sweep.count), *scene);
        let y = x.iter().map(|&value| {
            (sweep.parameter.set)(&mut scene, value);
            quantity(&scene)
        });
        Ok(Curve { y: y.collect::<Result<_, _>>()?, x })
    }

    /// Returns the share of `count` points of a box where `rule` holds: Sobol' points, in independent scrambles for the
    /// interval. The factors of `group` vary, or all; the others are at their nominal values.
    pub fn share(
        &self,
        group: Option<&str>,
        count: u64,
        rule: impl Fn(&Scene) -> Result<bool, Failure>,
    ) -> Result<Share, Failure> {
        let each = (count / REPLICATES).max(1);
        let mut shares = Vec::new();
        for replicate in 0..REPLICATES {
            let mut held = 0_u64;
            for scene in self.scenes(group, replicate, each) {
                held += u64::from(rule(&scene)?);
            }
            shares.push(held as f64 / each as f64);
        }
        let replicates = REPLICATES as f64;
        let value = sum::mean(&shares);
        let spread = sum::centred_product((&shares, value), (&shares, value));
        let error = (spread / (replicates * (replicates - 1.0))).sqrt();
        let interval = Interval::students_t(value, error, replicates - 1.0);
        let interval = interval.map(|i| Interval { low: i.low.max(0.0), high: i.high.min(1.0) });
        Ok(Share { value, interval })
    }

    /// Returns whether `rule` holds at the nominal scene, and on what share of the general box.
    pub fn part(
        &self,
        what: &str,
        count: u64,
        rule: impl Fn(&Scene) -> Result<bool, Failure>,
    ) -> Result<ClaimPart, Failure> {
        let nominal = rule(&Scene::default())?;
        Ok(ClaimPart { what: what.to_owned(), nominal, share: self.share(None, count, rule)? })
    }

    /// Returns the same under each of these friction laws, with its name after `label`.
    pub fn parts_under(
        &self,
        frictions: &[Friction],
        label: &str,
        count: impl Fn(FrictionLaw) -> u64,
        rule: impl Fn(FrictionLaw, &Scene) -> Result<bool, Failure>,
    ) -> Result<Vec<ClaimPart>, Failure> {
        let parts = frictions.iter().map(|&Friction { law, name, .. }| {
            self.part(&format!("{label}{name}"), count(law), |scene| rule(law, scene))
        });
        parts.collect()
    }

    fn scenes(&self, group: Option<&str>, replicate: u64, count: u64) -> Vec<Scene> {
        let mut scenes = vec![Scene::default(); count as usize];
        let sequence = SobolSequence::scrambled(self.space.factors().len(), SEED, replicate);
        let (mut u, mut si) = (vec![0.0; scenes.len()], vec![0.0; scenes.len()]);
        for (place, factor) in self.space.factors().iter().enumerate() {
            if group.is_some() && factor.group.as_deref() != group {
                continue;
            }
            sequence.fill(place, 0, &mut u);
            factor.fill_si(&u, &mut si);
            let set = parameter(&factor.name).set;
            for (scene, &value) in scenes.iter_mut().zip(&si) {
                set(scene, value);
            }
        }
        scenes
    }
}

/// Returns a parameter of the nanoparticle model.
pub(super) fn parameter(name: &str) -> &'static Parameter {
    Parameter::from_name(name).expect("a parameter of the model")
}

/// Options of the closed formulas under `friction`, otherwise as in the papers and in the nine studies.
pub(super) fn closed(friction: FrictionLaw) -> Options {
    Options { friction, ..Options::default() }
}

/// Options of exact geometry and the ramps of LuGre friction, to 1e-5 of the force: a thousandth of any criterion here.
pub(super) fn exact(friction: FrictionLaw) -> Options {
    Options { friction, fidelity: Fidelity::QuasiStatic, tolerance: 1e-3, ..Options::default() }
}

/// Options of the equations of motion, to 1e-6 of the force.
pub(super) fn in_motion(friction: FrictionLaw) -> Options {
    Options { friction, fidelity: Fidelity::Dynamic, ..Options::default() }
}
