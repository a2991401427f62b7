//! What do a thousand outputs cost on top of the model that computes them?
//!
//! `cargo bench --bench many_outputs` prints, on one thread, the seconds of the model alone and those that a study takes beyond it, for 8
//! factors and 1000 outputs: 10 and 82 million numbers without surrogates, and 2.6 million with them. `tests/peers/many_outputs.py`
//! gives those of jaxgsa at the 82 million.

use std::time::Instant;

use apportion::model::{Batch, Model, Output, RunContext, Worker};
use apportion::{AnalysisOptions, Distribution, Sampler, Study, SurrogateChoice, Unit};

const FACTORS: usize = 8;
const OUTPUTS: usize = 1000;

/// Output k is a sum of squares and of one product, with weights of its own.
struct Curves {
    outputs: Vec<Output>,
    weights: Vec<[f64; FACTORS]>,
}

impl Curves {
    fn new() -> Self {
        let outputs = (0..OUTPUTS).map(|k| Output::new(format!("y{k}"), Unit::dimensionless(), "")).collect();
        let weights = (0..OUTPUTS).map(|k| std::array::from_fn(|j| 1.0 + ((7 * k + 3 * j) % 11) as f64)).collect();
        Self { outputs, weights }
    }
}

impl Model for Curves {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker<'a>(&'a self, _: &RunContext) -> Box<dyn Worker + 'a> {
        Box::new(self)
    }
}

impl Worker for &Curves {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        let rows = inputs[0].len();
        let mut column = vec![0.0; rows];
        let squares: Vec<Vec<f64>> = inputs.iter().map(|x| x.iter().map(|x| x * x).collect()).collect();
        let product: Vec<f64> = inputs[0].iter().zip(inputs[1]).map(|(a, b)| 3.0 * a * b).collect();
        for (k, weights) in self.weights.iter().enumerate() {
            column.copy_from_slice(&product);
            for (weight, square) in weights.iter().zip(&squares) {
                for (y, x) in column.iter_mut().zip(square) {
                    *y += weight * x;
                }
            }
            batch.column_mut(k).copy_from_slice(&column);
        }
    }
}

fn study(base_samples: u64, surrogate: SurrogateChoice) -> Study {
    let options = AnalysisOptions { surrogate, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    let mut builder = Study::builder("curves", Curves::new()).base_samples(base_samples).analysis(options);
    for j in 0..FACTORS {
        builder = builder.factor(&format!("x{j}"), Distribution::uniform(0.0, 1.0).expect("a range"));
    }
    builder.build().expect("a study")
}

/// Seconds of the model alone for so many rows, in blocks of 256.
fn model_alone(rows: u64) -> f64 {
    let model = Curves::new();
    let columns: Vec<Vec<f64>> =
        (0..FACTORS).map(|j| (0..256).map(|i| (i * (j + 1) % 257) as f64 / 257.0).collect()).collect();
    let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let context = RunContext::default();
    let mut worker = model.worker(&context);
    let mut batch = Batch::new(&model);
    let start = Instant::now();
    for _ in 0..rows.div_ceil(256) {
        batch.reset(256);
        worker.run(std::hint::black_box(&inputs), &mut batch);
        std::hint::black_box(batch.column(0));
    }
    start.elapsed().as_secs_f64()
}

fn main() {
    println!(
        "{:<24} {:>12} {:>12} {:>12} {:>8}",
        "base samples, surrogates", "numbers", "model, s", "beyond it, s", "ratio"
    );
    for (base_samples, surrogate) in [
        (1024, SurrogateChoice::Off),
        (8192, SurrogateChoice::Off),
        (256, SurrogateChoice::Off),
        (256, SurrogateChoice::Auto),
    ] {
        let study = study(base_samples, surrogate);
        let rows = study.design().rows();
        let model = (0..3).map(|_| model_alone(rows)).fold(f64::INFINITY, f64::min);
        let of_run = || {
            let start = Instant::now();
            std::hint::black_box(study.runner().threads(1).run().expect("a result"));
            start.elapsed().as_secs_f64()
        };
        let all = (0..3).map(|_| of_run()).fold(f64::INFINITY, f64::min);
        let label = format!("{base_samples}, {surrogate:?}");
        println!("{label:<24} {:>12} {model:>12.2} {:>12.2} {:>8.1}", rows * OUTPUTS as u64, all - model, all / model);
    }
}
