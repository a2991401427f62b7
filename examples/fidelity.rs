//! How good is `fidelity = "auto"` of the nanoparticle? The tables of `docs/background/fidelity.md`.
//!
//!     cargo run --release --example fidelity -- [part of a name] > tables.md
//!
//! For every law of friction over the boxes of the papers' studies, at tolerances from 1e-2 to 1e-8: which rung serves
//! how much of the box, what a run costs, and the largest deviation from the `dynamic` rung. That deviation is searched
//! for, since the worst scenes of a box are few and lie where a rung is just still taken: by differential evolution (Storn
//! and Price 1997) from 100 starts, of which every other one climbs the deviation, and the rest the deviation over
//! the error that was estimated, so that an estimate that is too small is found wherever it is.
//!
//! The reference is the `dynamic` rung at a hundredth of the tolerance (no finer than 1e-10), which is its own error.
//! Seeded: the same tables on every machine, but for the times. Some minutes on one core, most of them in
//! the laws that are integrated, which are searched in fewer generations.

use apportion::model::Counter;
use std::time::Instant;

use apportion::Study;
use apportion::model::{Batch, Model, RunContext, Worker};

/// A box of scenes: the name of its study, the study, and what is changed in it.
type Area = (&'static str, &'static str, &'static [&'static str]);

macro_rules! study {
    ($name:literal) => {
        include_str!(concat!("../studies/", $name, ".toml"))
    };
}

const GENERAL: &str = study!("coulomb-general");

const AREAS: [Area; 16] = [
    ("coulomb-dimensional", study!("coulomb-dimensional"), &[]),
    ("coulomb-environmental", study!("coulomb-environmental"), &[]),
    ("coulomb-general", GENERAL, &[]),
    ("soft-cantilever", study!("soft-cantilever"), &[]),
    ("hk-dimensional", study!("hk-dimensional"), &[]),
    ("hk-environmental", study!("hk-environmental"), &[]),
    ("hk-general", study!("hk-general"), &[]),
    ("general, Dahl", GENERAL, &["afm.friction=\"dahl\""]),
    ("general, Stribeck", GENERAL, &["afm.friction=\"stribeck\""]),
    ("general, Armstrong", GENERAL, &["afm.friction=\"armstrong\""]),
    ("lugre-dimensional", study!("lugre-dimensional"), &[]),
    ("lugre-environmental", study!("lugre-environmental"), &[]),
    ("lugre-environmental-viscous", study!("lugre-environmental-viscous"), &[]),
    ("lugre-general", study!("lugre-general"), &[]),
    ("lugre-parameters", study!("lugre-parameters"), &[]),
    ("general, Lemaitre-Carlson", GENERAL, &["afm.friction=\"lemaitre-carlson\""]),
];

/// Tolerances of `auto`, as powers of ten.
const DECADES: std::ops::RangeInclusive<i32> = 2..=8;

/// Starts of a search.
const STARTS: usize = 100;

/// The finest tolerance of the reference.
const FINEST: f64 = 1e-10;

/// Random numbers by SplitMix64 (Steele, Lea and Flood 2014, OOPSLA).
struct Random(u64);

impl Random {
    /// Uniform in [0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.uniform() * n as f64) as usize
    }

    fn point(&mut self, dimensions: usize) -> Vec<f64> {
        (0..dimensions).map(|_| self.uniform()).collect()
    }
}

/// A study at one fidelity and tolerance.
fn study(of: &Area, fidelity: &str, tolerance: f64) -> Study {
    let (name, text, changes) = of;
    let own = [format!("afm.fidelity=\"{fidelity}\""), format!("afm.tolerance={tolerance:e}")];
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).chain(own).collect();
    apportion_files::parse_study(text, name.as_ref(), &changes).expect("a study of this repository")
}

/// Evaluates scenes of a study, given in the unit cube.
struct Rung<'a> {
    study: &'a Study,
    model: &'a dyn Model,
    worker: Box<dyn Worker + 'a>,
    batch: Batch,
}

impl<'a> Rung<'a> {
    fn new(study: &'a Study, model: &'a dyn Model, context: &'a RunContext<'a>) -> Self {
        Self { study, model, worker: model.worker(context), batch: Batch::new(model) }
    }

    fn run(&mut self, points: &[Vec<f64>]) -> &Batch {
        let factors = self.study.space().factors();
        let column = |j: usize| {
            // The ends of the box, which a search comes to, stand for the values next to them.
            let u: Vec<f64> = points.iter().map(|point| point[j].clamp(1e-9, 1.0 - 1e-9)).collect();
            let mut values = vec![0.0; u.len()];
            factors[j].fill_si(&u, &mut values);
            values
        };
        let columns: Vec<Vec<f64>> = (0..factors.len()).map(column).collect();
        let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        self.batch.reset(points.len());
        self.worker.run(&inputs, &mut self.batch);
        self.batch.settle();
        &self.batch
    }

    /// The count of that name in the batch run last.
    fn count(&self, name: &str) -> f64 {
        let number = self.model.counters().iter().position(|counter| counter.name == name).expect("a counter");
        self.batch.counts().values().nth(number).expect("one count for each counter")
    }
}

/// What `auto` makes of one scene.
#[derive(Clone, Copy, Default)]
struct Found {
    /// Relative deviation of the critical force from the reference; negative where either has none.
    deviation: f64,
    /// Estimated error, and the deviation beyond the error of the reference over it.
    estimate: f64,
    ratio: f64,
}

fn compare(auto: &mut Rung, dynamic: &mut Rung, finest: f64, point: &[f64]) -> Found {
    let scene = [point.to_vec()];
    let value = auto.run(&scene).column(0)[0];
    let deviation = (value / dynamic.run(&scene).column(0)[0] - 1.0).abs();
    if deviation.is_nan() {
        return Found { deviation: -1.0, estimate: 0.0, ratio: -1.0 };
    }
    let estimate = auto.count(Counter::LARGEST_ERROR);
    Found { deviation, estimate, ratio: (deviation - finest).max(0.0) / estimate }
}

/// The largest deviation and the largest ratio of deviation and estimate, over a cube.
fn search(dimensions: usize, generations: usize, mut at: impl FnMut(&[f64]) -> Found) -> [Found; 2] {
    let mut random = Random(15);
    // Even ones climb the deviation, odd ones the ratio.
    let height = |i: usize, found: &Found| if i.is_multiple_of(2) { found.deviation } else { found.ratio };
    let mut all: Vec<(Vec<f64>, Found)> = Vec::with_capacity(STARTS);
    for _ in 0..STARTS {
        let point = random.point(dimensions);
        let found = at(&point);
        all.push((point, found));
    }
    let best = |all: &[(Vec<f64>, Found)], kind: usize| {
        let higher = |a: usize, b: usize| if height(kind, &all[b].1) > height(kind, &all[a].1) { b } else { a };
        (0..STARTS).reduce(higher).unwrap_or(0)
    };
    for _ in 0..generations {
        for i in 0..STARTS {
            let (leader, one, other) = (best(&all, i), random.below(STARTS), random.below(STARTS));
            let step = 0.3 + 0.7 * random.uniform();
            let pull = if random.uniform() < 0.5 { step } else { 0.0 };
            let forced = random.below(dimensions);
            let mut point = all[i].0.clone();
            for (j, u) in point.iter_mut().enumerate() {
                if random.uniform() < 0.7 || j == forced {
                    let towards = pull * (all[leader].0[j] - *u);
                    *u = (*u + towards + step * (all[one].0[j] - all[other].0[j])).clamp(0.0, 1.0);
                }
            }
            let found = at(&point);
            if height(i, &found) >= height(i, &all[i].1) {
                all[i] = (point, found);
            }
        }
    }
    [all[best(&all, 0)].1, all[best(&all, 1)].1]
}

fn row(of: &Area, decade: i32) {
    let tolerance = 10_f64.powi(-decade);
    let finest = (0.01 * tolerance).max(FINEST);
    let (auto, dynamic) = (study(of, "auto", tolerance), study(of, "dynamic", finest));
    let (auto_model, dynamic_model) = (auto.model(), dynamic.model());
    let context = RunContext::default();
    let mut lowest = Rung::new(&auto, auto_model.as_ref(), &context);
    let mut highest = Rung::new(&dynamic, dynamic_model.as_ref(), &context);
    let dimensions = auto.space().factors().len();
    let is_integrated = of.0.starts_with("lugre") || of.0.ends_with("Carlson");
    let (scenes, generations) = if is_integrated { (200, 3) } else { (4000, 20) };
    let mut random = Random(decade as u64);
    let points: Vec<Vec<f64>> = (0..scenes).map(|_| random.point(dimensions)).collect();
    let start = Instant::now();
    lowest.run(&points);
    let microseconds = start.elapsed().as_secs_f64() / f64::from(scenes) * 1e6;
    let share = |rung: &str| 100.0 * lowest.count(&format!("{}{rung}", Counter::RUNGS)) / f64::from(scenes);
    let shares = ["closed-form", "quasi-static", "dynamic"].map(|rung| format!("{:.1}", share(rung)));
    let evaluations = lowest.count(Counter::EVALUATIONS) / f64::from(scenes);
    let [worst, closest] = search(dimensions, generations, |point| compare(&mut lowest, &mut highest, finest, point));
    println!(
        "| {} | 1e-{decade} | {} | {evaluations:.0} | {microseconds:.2} | {:.1e} | {:.1e} | {:.2} |",
        of.0,
        shares.join(" | "),
        worst.deviation,
        worst.estimate,
        closest.ratio,
    );
}

fn main() {
    let part = std::env::args().nth(1).unwrap_or_default();
    println!(
        "| box | tolerance | closed-form % | quasi-static % | dynamic % | evaluations | us a run | largest deviation | its estimate | deviation/estimate |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for of in AREAS.iter().filter(|of| of.0.contains(&part)) {
        for decade in DECADES {
            row(of, decade);
        }
    }
}
