//! A model with units, two outputs, and runs that have no answer: a column that buckles or yields.
//!
//!     cargo run --release --example units_and_failures

use std::error::Error;
use std::f64::consts::PI;

use apportion::{AnalysisOptions, Distribution, FunctionModel, Output, RowFailure, Study, Unit};
use apportion_report::run_document;

pub fn main() -> Result<(), Box<dyn Error>> {
    let force = Output::new("critical_force", Unit::parse("kN")?, "Euler's force of buckling");
    let slenderness = Output::new("slenderness", Unit::dimensionless(), "length over radius of gyration");
    // Values come and go in SI units; what people see is in the units of factors and outputs.
    let column = FunctionModel::new(vec![force, slenderness], |x: &[f64], y: &mut [f64]| {
        let (modulus, length, radius) = (x[0], x[1], x[2]);
        let slenderness = length / (radius / 2.0);
        if slenderness < 80.0 {
            return Err(RowFailure::new("the column is too stout for Euler's formula"));
        }
        y[0] = PI.powi(3) * modulus * radius.powi(4) / (4.0 * length * length);
        y[1] = slenderness;
        Ok(())
    });
    let sampler = apportion::Sampler::Sobol;
    let study = Study::builder("column", column)
        .title("A column that buckles")
        .factor_in("modulus", Unit::parse("GPa")?, Distribution::normal(210.0, 10.0)?)
        .factor_in("length", Unit::parse("m")?, Distribution::uniform(1.9, 2.1)?)
        .factor_in("radius", Unit::parse("mm")?, Distribution::truncated_normal(42.0, 3.0, 36.0, 48.0)?)
        .base_samples(2048)
        .analysis(AnalysisOptions { second_order: true, ..AnalysisOptions::for_sampler(sampler) })
        .build()?;

    let result = study.run()?;
    print!("{}", run_document(&result).text());
    let output = &result.outputs[0];
    assert!(output.runs_failed > 0 && output.failures[0].reason.contains("too stout"));
    // The force grows with the fourth power of the radius: it decides.
    assert!(output.factor("radius")?.share_total.is_some_and(|share| share > 80.0));
    Ok(())
}
