//! The basis of the checks: the physics, the nominal scene, the box of the papers' general study, and the shape of curves.

use apportion::design::SobolSequence;
use apportion::space::Space;
use apportion::uncertainty::{Interval, StandardError, t_interval};
use apportion_afm::history::{History, history};
use apportion_afm::modes::Pushing;
use apportion_afm::{Critical, Failure, Fidelity, FrictionLaw, Options, Parameter, Scene, critical_force, edge_unit};
use apportion_base::sum;

use super::judge::{Holding, Share, number};
use crate::reproduce::papers::Words;
use crate::reproduce::{Effort, Friction, Reproduced, general_study};

/// Seed of every sample of the box.
const SEED: u64 = 5;

/// Number of independent scrambles for the interval of a share: enough degrees of freedom for a t-quantile near 2.
const REPLICATES: u64 = 8;

/// A function for the critical force of a scene, such as [`critical_force`].
pub(super) type ForceOf<'a> = &'a dyn Fn(&Scene, &Options) -> Result<Critical, Failure>;
/// A function for a scene in time, such as [`history`].
pub(super) type HistoryOf<'a> = &'a dyn Fn(&Scene, &Options, f64) -> Result<History, Failure>;

/// A function for a number of a scene, or for whether a rule holds there.
pub(super) type OfScene<'a, T> = &'a dyn Fn(&Scene) -> Result<T, Failure>;

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
pub(super) struct Bench<'a> {
    pub physics: Physics<'a>,
    pub sizes: Sizes,
    /// The studies with their results.
    pub studies: &'a [Reproduced],
    space: Space,
}

impl<'a> Bench<'a> {
    /// Creates a bench with the ranges of the general study.
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
        self.curve_of(sweep, scene, &|scene| self.force(scene, options))
    }

    /// Returns any quantity along a sweep of one constant of `scene`.
    pub fn curve_of(&self, sweep: &Sweep, scene: &Scene, quantity: OfScene<'_, f64>) -> Result<Curve, Failure> {
        let (x, mut scene) = (grid(sweep.range, sweep.count), *scene);
        let y = x.iter().map(|&value| {
            (sweep.parameter.set)(&mut scene, value);
            quantity(&scene)
        });
        Ok(Curve { y: y.collect::<Result<_, _>>()?, x })
    }

    /// Returns the share of `count` points of a box where `rule` holds: Sobol' points, in independent scrambles for the
    /// interval. The factors of `group` vary, or all; the others are at their nominal values.
    pub fn share(&self, group: Option<&str>, count: u64, rule: OfScene<'_, bool>) -> Result<Share, Failure> {
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
        let interval = t_interval(value, StandardError { error, freedom: replicates - 1.0 });
        let interval = interval.map(|i| Interval { low: i.low.max(0.0), high: i.high.min(1.0) });
        Ok(Share { value, interval })
    }

    /// Returns whether `rule` holds at the nominal scene, and on what share of the general box.
    pub fn holding(&self, what: &str, count: u64, rule: OfScene<'_, bool>) -> Result<Holding, Failure> {
        let nominal = rule(&Scene::default())?;
        Ok(Holding { what: what.to_owned(), nominal, share: self.share(None, count, rule)? })
    }

    /// Returns the same under each of these friction laws, with its name after `label`.
    pub fn holding_under(
        &self,
        frictions: &[Friction],
        label: &str,
        count: impl Fn(FrictionLaw) -> u64,
        rule: impl Fn(FrictionLaw, &Scene) -> Result<bool, Failure>,
    ) -> Result<Vec<Holding>, Failure> {
        let under = |&Friction { law, name, .. }: &Friction| {
            self.holding(&format!("{label}{name}"), count(law), &|scene| rule(law, scene))
        };
        frictions.iter().map(under).collect()
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
            scenes.iter_mut().zip(&si).for_each(|(scene, &value)| set(scene, value));
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

/// A quantity over a rising grid.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
}

/// Returns `count` evenly spaced values from `low` to `high`, both included.
pub(super) fn grid((low, high): (f64, f64), count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    (0..count).map(|i| low + (high - low) * (i as f64 / last)).collect()
}

impl Curve {
    pub fn first(&self) -> f64 {
        self.y[0]
    }

    pub fn last(&self) -> f64 {
        self.y[self.y.len() - 1]
    }

    /// Returns whether every value is higher than the one before.
    pub fn rises(&self) -> bool {
        self.y.windows(2).all(|pair| pair[1] > pair[0])
    }

    /// Returns whether every value is lower than the one before.
    pub fn falls(&self) -> bool {
        self.y.windows(2).all(|pair| pair[1] < pair[0])
    }

    /// Returns the largest value minus the smallest, in units of the mean.
    pub fn spread(&self) -> f64 {
        let mean = sum::mean(&self.y);
        self.extent() / mean.abs()
    }

    fn extent(&self) -> f64 {
        let (low, high) = self.y.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &y| (l.min(y), h.max(y)));
        high - low
    }

    /// Returns the largest increase of steepness from one step to the next, in units of the mean steepness; 0 if the
    /// curve flattens everywhere.
    pub fn steepens(&self) -> f64 {
        let steps: Vec<f64> =
            self.x.windows(2).zip(self.y.windows(2)).map(|(x, y)| ((y[1] - y[0]) / (x[1] - x[0])).abs()).collect();
        let mean = ((self.last() - self.first()) / (self.x[self.x.len() - 1] - self.x[0])).abs();
        steps.windows(2).fold(0.0, |most: f64, pair| most.max((pair[1] - pair[0]) / mean))
    }

    /// Returns the largest distance from the least-squares line, in units of the whole change, and R^2 of that line.
    pub fn bend(&self) -> (f64, f64) {
        let x = (&self.x[..], sum::mean(&self.x));
        let y = (&self.y[..], sum::mean(&self.y));
        let slope = sum::centred_product(x, y) / sum::centred_product(x, x);
        let off: Vec<f64> = self.x.iter().zip(&self.y).map(|(x_i, y_i)| y_i - y.1 - slope * (x_i - x.1)).collect();
        let rest = sum::centred_product((&off, 0.0), (&off, 0.0));
        let farthest = off.iter().fold(0.0, |far: f64, off| far.max(off.abs()));
        (farthest / self.extent(), 1.0 - rest / sum::centred_product(y, y))
    }

    /// Returns the mean elasticity, ln(y_n/y_0)/ln(x_n/x_0): the power of x that joins the ends.
    pub fn elasticity(&self) -> f64 {
        libm::log(self.last() / self.first()) / libm::log(self.x[self.x.len() - 1] / self.x[0])
    }
}

#[cfg(test)]
mod tests;
