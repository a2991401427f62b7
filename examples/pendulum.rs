//! The pendulum of the README: which of its length, gravity and the angle decides its period?
//!
//!     cargo run --release --example pendulum

use std::error::Error;
use std::f64::consts::PI;

use apportion::{Distribution, Study, function_model};

pub fn main() -> Result<(), Box<dyn Error>> {
    let period = |x: &[f64]| 2.0 * PI * (x[0] / x[1]).sqrt() * (1.0 + x[2].powi(2) / 16.0);
    let study = Study::builder("pendulum", function_model("period", period))
        .factor("length", Distribution::normal(1.0, 0.01)?)
        .factor("gravity", Distribution::uniform(9.78, 9.83)?)
        .factor("angle", Distribution::uniform(0.1, 0.4)?)
        .build()?;
    let share = study.run()?.output("period")?.factor("length")?.total.estimate;
    println!("The length has {:.1} % of the variance.", 100.0 * share);
    assert!((share - 0.758).abs() < 1e-3);
    Ok(())
}
