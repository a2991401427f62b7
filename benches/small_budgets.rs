//! What 50 to 500 runs of a model tell, by which method.
//!
//! `cargo bench --bench small_budgets` writes `docs/guide/small-budgets.md` from `small_budgets.md.in` (more than an hour); `-- 10` takes 10
//! seeds and writes nothing.
//!
//! Errors are the root mean square, over all factors and seeds, of estimate less exact index. Where a method gives no number (it
//! refuses, or surrogates do not serve), the share of the seeds without one is told. What a screening gives is no index: it is judged
//! by how often a factor comes first whose total index is the largest, or within 0.01 of it.

use std::fmt::Write as _;
use std::path::Path;

use apportion::given::{Column, analyse, surrogate_indices};
use apportion::model::{Batch, KnownAnswer, RunContext};
use apportion::screening::{ScreeningDesign, ScreeningSettings};
use apportion::{
    AnalysisOptions, Distribution, Estimate, Sampler, Space, Study, StudyBuilder, SurrogateChoice, function_model,
};
use rayon::prelude::*;

const BUDGETS: [u64; 4] = [50, 100, 200, 500];
const SEEDS: u64 = 16;

/// A function with its exact indices, and what it is like.
struct Known {
    name: &'static str,
    like: &'static str,
    truth: Vec<[f64; 2]>,
}

fn functions() -> Vec<Known> {
    let list = [
        ("wing-weight", "smooth, 10 factors"),
        ("borehole", "smooth, 8 factors"),
        ("flood", "smooth, 8 factors of other distributions"),
        ("ishigami", "waves, 3 factors"),
        ("sobol-g", "kinks, few factors that act"),
        ("morris", "many interactions, 20 factors"),
    ];
    let known = |(name, like): (&'static str, &'static str)| {
        let exact = KnownAnswer::from_name(name)?.default_function().exact().indices?;
        let truth = exact.first_order.iter().zip(&exact.total).map(|(s, t)| [*s, *t]).collect();
        Some(Known { name, like, truth })
    };
    list.into_iter().filter_map(known).collect()
}

/// The study of a function, whose design is still to be said.
fn builder(name: &str, seed: u64, surrogate: SurrogateChoice) -> StudyBuilder {
    let known =
        apportion_files::parse_study(&format!("model = \"{name}\"\n"), Path::new("known.toml"), &[]).expect("a study");
    let (factors, model) = (known.space().factors().to_vec(), known.model());
    let of_row = move |x: &[f64]| {
        let columns: Vec<[f64; 1]> = x.iter().map(|x| [*x]).collect();
        let inputs: Vec<&[f64]> = columns.iter().map(<[f64; 1]>::as_slice).collect();
        let mut batch = Batch::new(model.as_ref());
        batch.reset(1);
        model.worker(&RunContext::default()).run(&inputs, &mut batch);
        batch.column(0)[0]
    };
    let start = Study::builder(name, function_model("y", of_row)).seed(seed);
    let options = AnalysisOptions { surrogate, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    factors.into_iter().fold(start, StudyBuilder::with_factor).analysis(options)
}

/// Errors of exact indices, and of those of nearly exact surrogates.
const ROUNDING: f64 = 1e-9;

/// The first-order and the total index of every factor.
type Found = Vec<(Estimate, Option<Estimate>)>;

/// Squared errors of first-order and of total indices so far, and the seeds with and without numbers.
#[derive(Default)]
struct Errors {
    first: f64,
    total: f64,
    numbers: f64,
    /// Of which kinds there are numbers.
    has_total: bool,
    seeds: u64,
    without: u64,
    /// Seeds in which the right factor came first.
    leads: u64,
    /// Intervals, and those that hold the exact index.
    intervals: u64,
    held: u64,
}

impl Errors {
    fn add(&mut self, found: Option<Found>, truth: &[[f64; 2]]) {
        self.seeds += 1;
        let Some(found) = found else {
            self.without += 1;
            return;
        };
        for ((first, total), [s, t]) in found.iter().zip(truth) {
            self.first += (first.estimate - s).powi(2);
            self.total += total.map_or(0.0, |total| (total.estimate - t).powi(2));
            self.has_total |= total.is_some();
            for (estimate, exact) in [(Some(first), s), (total.as_ref(), t)] {
                let Some(interval) = estimate.and_then(|of| of.interval) else { continue };
                self.intervals += 1;
                self.held += u64::from(interval.low - ROUNDING <= *exact && *exact <= interval.high + ROUNDING);
            }
        }
        self.numbers += truth.len() as f64;
        let weights: Vec<f64> = found.iter().map(|(first, total)| total.unwrap_or(*first).estimate).collect();
        self.leads += u64::from(leads(&weights, truth));
    }

    fn cell(&self) -> String {
        let rms = |sum: f64| match (sum / self.numbers).sqrt() {
            small if small < 0.0005 => format!("{small:.0e}"),
            error => format!("{error:.3}"),
        };
        let leads = 100 * self.leads / self.seeds;
        match self.without {
            all if all == self.seeds => "–".to_owned(),
            none => {
                let total = if self.has_total { rms(self.total) } else { "–".to_owned() };
                let none = if none > 0 { format!(" ({} % none)", 100 * none / self.seeds) } else { String::new() };
                let held =
                    (100 * self.held).checked_div(self.intervals).map_or("–".to_owned(), |held| format!("{held} %"));
                format!("{} / {total} / {leads} % / {held}{none}", rms(self.first))
            }
        }
    }
}

fn largest(list: &[f64]) -> usize {
    (0..list.len()).max_by(|&a, &b| list[a].total_cmp(&list[b])).unwrap_or(0)
}

/// Whether the factor of the largest weight is one of those that lead: its total index is the largest, or within 0.01 of it.
fn leads(weights: &[f64], truth: &[[f64; 2]]) -> bool {
    let most = truth.iter().map(|[_, total]| *total).fold(0.0, f64::max);
    truth[largest(weights)][1] > most - 0.01
}

/// First-order and total indices of a run of `study`.
fn of_run(study: Result<Study, apportion::BuildError>) -> Option<Found> {
    let analysis = study.ok()?.run().ok()?;
    let indices = analysis.outputs[0].indices.as_ref()?;
    Some(indices.iter().map(|i| (i.effect.first_order, Some(i.effect.total))).collect())
}

/// A table of `rows` random rows, in SI units, and its output.
fn table(name: &str, seed: u64, rows: u64) -> (Vec<Column>, Vec<Column>, Vec<Distribution>) {
    let study = builder(name, seed, SurrogateChoice::Off);
    let study = study.sampler(Sampler::Random).analysis(AnalysisOptions::for_sampler(Sampler::Random));
    let study = study.base_samples(rows.max(64)).build().expect("a study");
    let (space, design, model): (&Space, _, _) = (study.space(), study.design(), study.model());
    let factors = space.factors();
    let mut values = vec![Vec::new(); factors.len()];
    let mut u = vec![0.0; factors.len()];
    // The rows A of all replicates.
    let rows_of_a = (0..design.rows()).step_by(design.rows_per_point() as usize).take(rows as usize);
    for row in rows_of_a {
        design.point(row, &mut u);
        values.iter_mut().zip(space.values_at(&u)).for_each(|(column, x)| column.push(x));
    }
    let in_si = |(factor, column): (&apportion::Factor, &Vec<f64>)| -> Vec<f64> {
        column.iter().map(|x| factor.unit().to_si(*x)).collect()
    };
    let in_si: Vec<Vec<f64>> = factors.iter().zip(&values).map(in_si).collect();
    let inputs: Vec<&[f64]> = in_si.iter().map(Vec::as_slice).collect();
    let mut batch = Batch::new(model.as_ref());
    batch.reset(rows as usize);
    model.worker(&RunContext::default()).run(&inputs, &mut batch);
    let output = Column { name: "y".to_owned(), values: batch.column(0).to_vec() };
    let column = |(factor, values): (&apportion::Factor, Vec<f64>)| Column { name: factor.name.clone(), values };
    let laws = factors.iter().map(|factor| factor.distribution().clone()).collect();
    (factors.iter().zip(values).map(column).collect(), vec![output], laws)
}

/// The methods, in the order of the table.
const METHODS: [&str; 6] = [
    "`given-data` by ranks, random rows",
    "`given-data` with `--study`, random rows",
    "`screen`",
    "pick-freeze, `surrogate = \"off\"`",
    "pick-freeze with surrogates (the default)",
    "`runs`",
];

fn one(known: &Known, method: usize, budget: u64, seed: u64, errors: &mut Errors) {
    let Known { name, truth, .. } = known;
    let per_point = truth.len() as u64 + 2;
    match method {
        0 => {
            let (inputs, outputs, _) = table(name, seed, budget);
            let found = analyse(&inputs, &outputs, seed).ok();
            let of = |given: apportion::given::GivenIndices| {
                let indices = given.outputs[0].indices.as_ref().ok()?;
                indices.iter().map(|index| Some((*index.rank.as_ref()?, None))).collect::<Option<Vec<_>>>()
            };
            errors.add(found.and_then(of), truth);
        }
        1 => {
            let (inputs, outputs, laws) = table(name, seed, budget);
            let given = analyse(&inputs, &outputs, seed).ok();
            let found = given.and_then(|given| surrogate_indices(&inputs, &outputs, &given, Some(&laws)).ok());
            let found = found.and_then(|found| found.outputs.into_iter().next()?.ok()).filter(|found| found.serves);
            let of = |found: apportion::given::SurrogateOutput| {
                found.indices.iter().map(|index| (index.first_order, Some(index.total))).collect()
            };
            errors.add(found.map(of), truth);
        }
        2 => {
            let study = builder(name, seed, SurrogateChoice::Off).build().expect("a study");
            let trajectories = budget / (truth.len() as u64 + 1);
            let design = ScreeningDesign::Radial { sampler: Sampler::Sobol };
            let settings = ScreeningSettings { design, trajectories, seed };
            errors.seeds += 1;
            match study.runner().threads(1).screen(settings) {
                Err(_) => errors.without += 1,
                Ok(found) => {
                    let weights: Vec<f64> = found.outputs[0]
                        .factors
                        .iter()
                        .map(|f| f.mu_star.map_or(0.0, |mu_star| mu_star.estimate))
                        .collect();
                    errors.leads += u64::from(leads(&weights, truth));
                }
            }
        }
        3 | 4 => {
            let surrogate = if method == 3 { SurrogateChoice::Off } else { SurrogateChoice::On };
            // The largest power of two in each of four nets.
            let points = budget / per_point / 4;
            let study = builder(name, seed, surrogate);
            let points = if points < 2 { None } else { Some(1 << points.ilog2()) };
            errors.add(points.and_then(|points: u64| of_run(study.base_samples(4 * points).build())), truth);
        }
        _ => errors.add(of_run(builder(name, seed, SurrogateChoice::On).runs(budget).build()), truth),
    }
}

fn section(known: &Known, seeds: u64) -> String {
    let mut text = format!("\n### {} ({})\n\n", known.name, known.like);
    let header: String = BUDGETS.iter().map(|budget| format!(" {budget} runs |")).collect();
    let _ = writeln!(text, "| method |{header}\n|---|{}", "---|".repeat(BUDGETS.len()));
    for (method, label) in METHODS.into_iter().enumerate() {
        let _ = write!(text, "| {label} |");
        for budget in BUDGETS {
            let mut errors = Errors::default();
            (0..seeds).for_each(|seed| one(known, method, budget, seed, &mut errors));
            let cell = match method {
                2 if errors.without == errors.seeds => "–".to_owned(),
                2 => format!("– / – / {} %", 100 * errors.leads / errors.seeds),
                _ => errors.cell(),
            };
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

fn main() {
    let asked = std::env::args().nth(1).and_then(|text| text.parse().ok());
    let seeds = asked.unwrap_or(SEEDS);
    let sections: Vec<String> = functions().par_iter().map(|known| section(known, seeds)).collect();
    let text = sections.concat();
    print!("{text}");
    if asked.is_none() {
        let head = include_str!("small_budgets.md.in");
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/guide/small-budgets.md");
        std::fs::write(path, head.replace("SEEDS", &seeds.to_string()) + &text).expect("the page can be written");
    }
}
