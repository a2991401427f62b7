//! What `accuracy` keeps of its promise, and what it costs.
//!
//! `cargo bench --bench promise` writes `docs/accuracy/promise.md` (some minutes on two cores); `cargo bench --bench promise -- 10` takes
//! 10 seeds and writes nothing, and `-- 10 motion` those of the timed studies alone.
//!
//! Functions with exact answers stand for programs that take their time: their cost is the number of runs. The exhaustive search
//! looks for the fewest runs of a fixed design, with and without surrogates and plain rows, whose own intervals reach the accuracy.
//! The study of the equations of motion is timed.

#[path = "slow/mod.rs"]
mod slow;

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use apportion::model::KnownAnswer;
use apportion::{AnalysisOptions, Sampler, Study, StudyResult, SurrogateChoice, Target};
use slow::Slow;

/// How a study is run.
enum Way {
    Accurate(f64),
    Plain { half_width: f64 },
    Runs(u64),
    BaseSamples(u64),
}

fn study(name: &str, seed: u64, way: &Way) -> Study {
    let known =
        apportion_files::parse_study(&format!("model = \"{name}\"\n"), Path::new("known.toml"), &[]).expect("a study");
    let mut builder = known
        .space()
        .factors()
        .iter()
        .cloned()
        .fold(Study::builder(name, Slow(known.model())), |builder, factor| builder.with_factor(factor));
    let analysis = |surrogate| AnalysisOptions { surrogate, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    builder = match *way {
        Way::Accurate(accuracy) => builder.until(Target::accuracy(accuracy)),
        Way::Plain { half_width } => {
            builder.until(Target::accuracy(half_width)).analysis(analysis(SurrogateChoice::Off))
        }
        Way::Runs(runs) => builder.runs(runs).analysis(analysis(SurrogateChoice::On)),
        Way::BaseSamples(base_samples) => builder.base_samples(base_samples).analysis(analysis(SurrogateChoice::Off)),
    };
    builder.seed(seed).build().expect("a study")
}

fn runs(result: &StudyResult) -> u64 {
    result.spending.as_ref().map_or(result.provenance.model_runs, |spending| spending.runs)
}

fn half_width(result: &StudyResult) -> f64 {
    result.outputs[0].largest_half_width().unwrap_or(f64::INFINITY)
}

/// The largest error of an index.
fn error(result: &StudyResult, truth: &[[f64; 2]]) -> f64 {
    let Some(indices) = &result.outputs[0].indices else { return f64::INFINITY };
    let of_factor = |(index, [first, total]): (&apportion::result::Named<apportion::EffectEstimates>, &[f64; 2])| {
        (index.effect.first_order.estimate - first).abs().max((index.effect.total.estimate - total).abs())
    };
    indices.iter().zip(truth).map(of_factor).fold(0.0, f64::max)
}

fn median(mut list: Vec<f64>) -> f64 {
    list.sort_by(f64::total_cmp);
    list[list.len() / 2]
}

/// The fewest runs of a fixed design whose intervals reach `accuracy`, among powers of two.
fn cheapest(name: &str, seed: u64, accuracy: f64) -> u64 {
    let rows = study(name, seed, &Way::BaseSamples(16)).design().rows_per_point();
    let mut best = u64::MAX;
    for surrogate in [false, true] {
        let mut base_samples = 16;
        while base_samples <= 1 << 15 && base_samples * rows < best {
            let way = if surrogate { Way::Runs(base_samples * rows) } else { Way::BaseSamples(base_samples) };
            let result = study(name, seed, &way).run().expect("a result");
            if half_width(&result) <= accuracy {
                best = result.provenance.model_runs;
            }
            base_samples *= 2;
        }
    }
    best
}

fn functions(seeds: u64) -> String {
    let mut text = String::from(
        "| function | accuracy | kept, of seeds | runs, median | most | cheapest fixed design, median | ratio of medians | plain \
         pick-freeze, median |\n|---|---|---|---|---|---|---|---|\n",
    );
    for name in ["borehole", "wing-weight", "ishigami", "flood", "sobol-g"] {
        let exact =
            KnownAnswer::from_name(name).expect("a function").default_function().exact().indices.expect("indices");
        let truth: Vec<[f64; 2]> = exact.first_order.iter().zip(&exact.total).map(|(s, t)| [*s, *t]).collect();
        let accuracy = 0.02;
        let results: Vec<StudyResult> =
            (0..seeds).map(|seed| study(name, seed, &Way::Accurate(accuracy)).run().expect("a result")).collect();
        let kept = results.iter().filter(|result| error(result, &truth) <= accuracy).count();
        let spent: Vec<f64> = results.iter().map(|result| runs(result) as f64).collect();
        let most = spent.iter().copied().fold(0.0, f64::max);
        let few = seeds.min(10);
        let best = median((0..few).map(|seed| cheapest(name, seed, accuracy) as f64).collect());
        let until = Way::Plain { half_width: accuracy };
        let plain =
            median((0..few).map(|seed| runs(&study(name, seed, &until).run().expect("a result")) as f64).collect());
        let spent = median(spent);
        let row = format!(
            "| {name} | {accuracy} | {kept} of {seeds} | {spent} | {most} | {best} | {:.2} | {plain} |",
            spent / best
        );
        println!("{row}");
        let _ = writeln!(text, "{row}");
    }
    text
}

fn motion(seeds: u64) -> String {
    let load = |name: &str, more: &[String]| {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("studies").join(format!("{name}.toml"));
        let sets = [&["afm.fidelity=dynamic".to_owned()], more].concat();
        apportion_files::load_study(&path, &sets).expect("a study of the repository")
    };
    let mut text = String::from(
        "| study | accuracy | kept, of seeds | seconds, median | plain pick-freeze, median | ratio | runs | plain runs |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for name in ["lugre-environmental", "lugre-environmental-viscous"] {
        let accuracy = 0.01;
        let finest = load(name, &["accuracy=1e-5".to_owned(), "design.seed=1000".to_owned()]).run().expect("a result");
        let of = |result: &StudyResult| -> Vec<[f64; 2]> {
            let indices = result.outputs[0].indices.as_ref().expect("indices");
            indices.iter().map(|i| [i.effect.first_order.estimate, i.effect.total.estimate]).collect()
        };
        let truth = of(&finest);
        let timed = |more: &[String]| {
            let study = load(name, more);
            let start = Instant::now();
            let result = study.run().expect("a result");
            (start.elapsed().as_secs_f64(), result)
        };
        let seed = |seed: u64| format!("design.seed={seed}");
        let all: Vec<(f64, StudyResult)> =
            (0..seeds).map(|k| timed(&[format!("accuracy={accuracy}"), seed(k)])).collect();
        let plain: Vec<(f64, StudyResult)> = (0..seeds.min(5))
            .map(|k| timed(&[format!("accuracy={accuracy}"), "analysis.surrogate=\"off\"".to_owned(), seed(k)]))
            .collect();
        let kept = all.iter().filter(|(_, result)| error(result, &truth) <= accuracy).count();
        let seconds = |list: &[(f64, StudyResult)]| median(list.iter().map(|(seconds, _)| *seconds).collect());
        let count = |list: &[(f64, StudyResult)]| median(list.iter().map(|(_, result)| runs(result) as f64).collect());
        let row = format!(
            "| {name} | {accuracy} | {kept} of {seeds} | {:.3} | {:.3} | {:.1} | {} | {} |",
            seconds(&all),
            seconds(&plain),
            seconds(&plain) / seconds(&all),
            count(&all),
            count(&plain)
        );
        println!("{row}");
        let _ = writeln!(text, "{row}");
    }
    text
}

fn main() {
    let asked: Option<u64> = std::env::args().skip(1).find_map(|argument| argument.parse().ok());
    let seeds = asked.unwrap_or(100);
    if std::env::args().any(|argument| argument == "motion") {
        motion(seeds);
        return;
    }
    let (first, second) = (functions(seeds), motion(seeds));
    if asked.is_none() {
        let page = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/accuracy/promise.md");
        let head = include_str!("promise.md.in");
        std::fs::write(page, format!("{head}\n{first}\n{second}")).expect("docs/accuracy can be written");
    }
}
