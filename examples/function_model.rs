//! A Rust function as a model: which of three numbers decides its value?
//!
//!     cargo run --release --example function_model

use std::error::Error;
use std::f64::consts::PI;

use apportion::{Distribution, Study, function_model};

pub fn main() -> Result<(), Box<dyn Error>> {
    // The function of Ishigami and Homma (1990), whose indices are known.
    let ishigami = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
    let angle = || Distribution::uniform(-PI, PI);
    let study = Study::builder("ishigami", function_model("y", ishigami))
        .factor("x1", angle()?)
        .factor("x2", angle()?)
        .factor("x3", angle()?)
        .base_samples(4096)
        .seed(1)
        .build()?;

    let result = study.run()?;
    let y = result.output("y")?;
    // x3 does nothing alone, but a quarter of the variance together with x1.
    for (name, exact) in [("x1", (0.3139, 0.5576)), ("x2", (0.4424, 0.4424)), ("x3", (0.0, 0.2437))] {
        let (alone, all) = (y.factor(name)?.first_order, y.factor(name)?.total);
        println!("{name}: alone {:.3}, with all interactions {:.3}", alone.estimate, all.estimate);
        assert!((alone.estimate - exact.0).abs() < 0.01);
        assert!((all.estimate - exact.1).abs() < 0.01);
    }
    Ok(())
}
