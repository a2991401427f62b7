//! Do intervals hold on functions that no constant was fitted to, and what does `accuracy` keep of its promise?
//!
//! `benches/functions/functions.json` has functions of the kinds that fool an analysis: steps, ridges, thin regions, switches, heavy
//! tails, high frequencies. Each has its indices, exact to the stated `error`.
//!
//! `cargo bench --bench functions` writes `docs/accuracy/functions.md` (hours); `-- 4` takes 4 seeds and writes nothing, and `-- 4 steps` those
//! of one kind alone.

#[path = "slow/mod.rs"]
mod slow;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use apportion::result::{StopReason, StudyResult};
use apportion::{Interval, Study, Target};
use rayon::prelude::*;
use serde::Deserialize;
use slow::Slow;

const SEEDS: u64 = 20;
const SIZES: [u64; 4] = [32, 128, 512, 2048];
const ACCURACIES: [f64; 2] = [0.05, 0.01];
/// The largest number of runs of a program that a search may take.
const MAX_RUNS: u64 = 100_000;

#[derive(Deserialize)]
struct Function {
    name: String,
    kind: String,
    formula: String,
    /// Names and distributions.
    factors: Vec<(String, String)>,
    first_order: Vec<f64>,
    total: Vec<f64>,
    error: f64,
}

impl Function {
    fn study(&self, sets: &[String]) -> Study {
        let mut text = format!("model = \"expression\"\n[outputs]\ny = \"{}\"\n[factors]\n", self.formula);
        for (name, law) in &self.factors {
            let _ = writeln!(text, "{name} = {{ {law} }}");
        }
        apportion_files::parse_study(&text, Path::new("function.toml"), sets).expect("a study")
    }

    fn at_size(&self, base_samples: u64, seed: u64) -> StudyResult {
        let sets = [format!("design.base_samples={base_samples}"), format!("design.seed={seed}")];
        self.study(&sets).runner().threads(1).run().expect("a result")
    }

    fn to_accuracy(&self, accuracy: f64, seed: u64) -> StudyResult {
        let study = self.study(&[]);
        let mut builder = Study::builder("function", Slow(study.model()));
        for factor in study.space().factors() {
            builder = builder.with_factor(factor.clone());
        }
        let target = Target::accuracy(accuracy).max_runs(MAX_RUNS);
        builder.until(target).seed(seed).build().expect("a study").runner().threads(1).run().expect("a result")
    }

    /// The right values in the order of [`indices`].
    fn exact(&self) -> impl Iterator<Item = f64> {
        self.first_order.iter().zip(&self.total).flat_map(|(first, total)| [*first, *total])
    }
}

/// First-order and total index of every factor.
fn indices(result: &StudyResult) -> Vec<(f64, Option<Interval>)> {
    let indices = result.outputs[0].indices.iter().flatten();
    let both = indices.flat_map(|of| [of.effect.first_order, of.effect.total]);
    both.map(|index| (index.estimate, index.interval)).collect()
}

#[derive(Default)]
struct Tally {
    cells: u64,
    low_cells: u64,
    held: [u64; 2],
    all: [u64; 2],
    /// The largest share of misses of a cell.
    most_missed: f64,
    runs: u64,
    silent: u64,
}

impl Tally {
    /// Adds the results of a function at one size.
    fn add(&mut self, function: &Function, results: &[StudyResult], enough: f64) {
        let (mut held, mut all) = ([0; 2], [0; 2]);
        for result in results {
            let mut is_far_off = false;
            for (k, ((estimate, interval), exact)) in indices(result).into_iter().zip(function.exact()).enumerate() {
                let Some(Interval { low, high }) = interval else { continue };
                all[k % 2] += 1;
                held[k % 2] += u64::from(low - function.error <= exact && exact <= high + function.error);
                is_far_off |= (estimate - exact).abs() > 1.5 * (high - low) + function.error + 1e-6;
            }
            self.silent += u64::from(is_far_off && result.outputs[0].warnings.is_empty());
            self.runs += 1;
        }
        for (k, (held, all)) in held.into_iter().zip(all).enumerate().filter(|(_, (_, all))| *all > 0) {
            let coverage = held as f64 / all as f64;
            self.cells += 1;
            self.low_cells += u64::from(coverage < enough);
            self.most_missed = self.most_missed.max(1.0 - coverage);
            self.held[k] += held;
            self.all[k] += all;
        }
    }

    fn row(&self, kind: &str) -> String {
        let coverage = |k: usize| self.held[k] as f64 / self.all[k].max(1) as f64;
        format!(
            "| {kind} | {:.3} | {:.3} | {:.2} | {} of {} | {} of {} |",
            coverage(0),
            coverage(1),
            1.0 - self.most_missed,
            self.cells - self.low_cells,
            self.cells,
            self.silent,
            self.runs
        )
    }
}

fn sizes(functions: &[Function], seeds: u64) -> String {
    let mut text = String::from(
        "| kind | coverage of S_1 | of S_T | least of a cell | cells of at least .92 (heavy: .90) | silent misses |\n|---|---|---|---|---|---|\n",
    );
    let mut kinds: BTreeMap<&str, Tally> = BTreeMap::new();
    let mut all = Tally::default();
    for function in functions {
        let enough = if function.kind == "heavy" { 0.9 } else { 0.92 };
        let mut of_function = Tally::default();
        for base_samples in SIZES {
            let results: Vec<StudyResult> =
                (0..seeds).into_par_iter().map(|seed| function.at_size(base_samples, seed)).collect();
            for tally in [&mut all, &mut of_function, kinds.entry(&function.kind).or_default()] {
                tally.add(function, &results, enough);
            }
        }
        println!("{}", of_function.row(&function.name));
    }
    for (kind, tally) in kinds.iter().map(|(kind, tally)| (*kind, tally)).chain([("all", &all)]) {
        let _ = writeln!(text, "{}", tally.row(kind));
    }
    text
}

/// Searches that met their accuracy, of these false ones, those by more than 1.5 times, and all; and their numbers of runs.
#[derive(Default)]
struct Searches {
    counts: [u64; 4],
    runs: Vec<u64>,
}

fn accuracies(functions: &[Function], seeds: u64) -> String {
    let mut text = String::from(
        "| kind | accuracy | met | false | by more than 1.5 times | runs, median | most |\n|---|---|---|---|---|---|---|\n",
    );
    let mut kinds: BTreeMap<(&str, usize), Searches> = BTreeMap::new();
    for function in functions {
        for (place, accuracy) in ACCURACIES.into_iter().enumerate() {
            let results: Vec<StudyResult> =
                (0..seeds).into_par_iter().map(|seed| function.to_accuracy(accuracy, seed)).collect();
            let mut counts = [0; 4];
            let mut runs = Vec::new();
            for result in &results {
                let errors = indices(result).into_iter().zip(function.exact());
                let error =
                    errors.map(|((index, _), exact)| (index - exact).abs()).fold(0.0, f64::max) - function.error;
                let is_met =
                    result.stopping.as_ref().is_some_and(|of| matches!(of.reason, StopReason::TargetMet { .. }));
                let of = [is_met, is_met && error > accuracy, is_met && error > 1.5 * accuracy, true];
                counts.iter_mut().zip(of).for_each(|(count, is)| *count += u64::from(is));
                runs.push(result.spending.as_ref().map_or(0, |spending| spending.runs));
            }
            println!("{} | {accuracy} | {counts:?} | {runs:?}", function.name);
            for kind in [function.kind.as_str(), "all"] {
                let searches = kinds.entry((kind, place)).or_default();
                searches.counts.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
                searches.runs.extend(&runs);
            }
        }
    }
    for ((kind, place), Searches { counts: [met, wrong, far, all], mut runs }) in kinds {
        runs.sort_unstable();
        let _ = writeln!(
            text,
            "| {kind} | {} | {met} of {all} | {wrong} | {far} | {} | {} |",
            ACCURACIES[place],
            runs[runs.len() / 2],
            runs[runs.len() - 1]
        );
    }
    text
}

fn main() {
    let asked: Option<u64> = std::env::args().skip(1).find_map(|argument| argument.parse().ok());
    let kind = std::env::args().skip(1).find(|argument| !argument.starts_with('-') && argument.parse::<u64>().is_err());
    let mut functions: Vec<Function> =
        serde_json::from_str(include_str!("functions/functions.json")).expect("a list of functions");
    functions.retain(|function| kind.as_ref().is_none_or(|kind| *kind == function.kind));
    let seeds = asked.unwrap_or(SEEDS);
    let page = format!(
        "{}\n{}\n{}{}",
        include_str!("functions.md.in").replace("SEEDS", &seeds.to_string()),
        sizes(&functions, seeds),
        "\n## What `accuracy` keeps of its promise\n\n\
         As programs (`smallest_region` 0.05), at most 100,000 runs. False: met, but an index is off by more than the accuracy.\n\n",
        accuracies(&functions, seeds)
    );
    println!("{page}");
    if asked.is_none() && kind.is_none() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/accuracy/functions.md");
        std::fs::write(path, page).expect("the page");
    }
}
