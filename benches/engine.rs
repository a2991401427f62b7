//! What does the engine cost on top of the model, and does memory grow with the number of samples?
//!
//! Prints, for the general study: seconds of the bare model loop and of the whole study on one thread and their ratio;
//! seconds on all threads; and the peak memory after runs of 2^14, 2^18 and 2^22 base samples in one process.

use std::time::Instant;

use apportion::design::{Design, DesignSettings, Rows};
use apportion::model::{Batch, Model, RunContext};
use apportion::study::Study;

fn study(base_samples: u64) -> Study {
    let overrides = [format!("design.base_samples={base_samples}")];
    let text = include_str!("../studies/coulomb-general.toml");
    apportion_files::parse_study(text, "coulomb-general.toml".as_ref(), &overrides).expect("a study of this repository")
}

/// Seconds for `rows` evaluations in blocks of 256 on one thread, nothing else: no sampling, no sums.
fn bare_loop(model: &dyn Model, rows: u64, columns: &[Vec<f64>]) -> f64 {
    let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let context = RunContext::default();
    let mut worker = model.worker(&context);
    let mut batch = Batch::new(model);
    let start = Instant::now();
    for _ in 0..rows / 256 {
        batch.reset(256);
        worker.run(std::hint::black_box(&inputs), &mut batch);
        std::hint::black_box(batch.column(0));
    }
    start.elapsed().as_secs_f64()
}

fn whole_study(study: &Study, threads: usize) -> f64 {
    let start = Instant::now();
    let result = study.runner().threads(threads).run().expect("threads");
    std::hint::black_box(result);
    start.elapsed().as_secs_f64()
}

fn overhead() {
    let study = study(1 << 18);
    let model = study.model();
    let settings = DesignSettings { base_samples: 256, replicates: 1, ..study.design().settings().clone() };
    let design = Design::new(settings, study.design().factors(), Rows::default()).expect("a plain design");
    let mut unit = vec![vec![0.0; 256]; study.design().factors() * 2];
    design.replicate(0).fill(0, &mut unit);
    let mut columns = vec![vec![0.0; 256]; study.design().factors()];
    for ((factor, u), si) in study.space().factors().iter().zip(&unit).zip(&mut columns) {
        factor.fill_si(u, si);
    }
    let best = |f: &dyn Fn() -> f64| (0..3).map(|_| f()).fold(f64::INFINITY, f64::min);
    let rows = study.design().rows();
    let bare = best(&|| bare_loop(model.as_ref(), rows, &columns));
    let whole = best(&|| whole_study(&study, 1));
    println!("engine overhead, {rows} runs on one thread:");
    println!("  bare model loop {bare:.3} s ({:.0} ns a run)", bare / rows as f64 * 1e9);
    println!("  whole study     {whole:.3} s ({:.0} ns a run)", whole / rows as f64 * 1e9);
    println!("  ratio           {:.2}", whole / bare);
    println!("  all threads     {:.3} s", best(&|| whole_study(&study, 0)));
}

/// Peak resident memory of this process so far in MB, where the system tells.
fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1e3)
}

fn memory() {
    println!("memory, general study:");
    for exponent in [14, 18, 20, 22] {
        let study = study(1 << exponent);
        let seconds = whole_study(&study, 0);
        let peak = peak_megabytes().map_or_else(|| "unknown".to_owned(), |mb| format!("{mb:.1} MB"));
        println!("  2^{exponent} base samples: {} runs in {seconds:.2} s, peak {peak}", study.design().rows());
    }
}

fn main() {
    memory();
    overhead();
}
