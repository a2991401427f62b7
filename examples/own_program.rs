//! A program as a model, started and asked from Rust: a script for `sh` and `awk` here; yours may be in any language.
//!
//!     cargo run --release --example own_program

use std::error::Error;

use apportion::{Distribution, Factor, Study, Unit, function_model};
use apportion_files::{CommandModel, CommandOutput, CommandSettings, Form, Program, Protocol};

/// Reads a header, then a line of a row number, length (mm), thickness (mm) and load (N) for each run; prints the number and
/// the outputs for each.
const SCRIPT: &str = r#"
read -r header
while IFS=, read -r id length thickness load
do
  awk -v id="$id" -v L="$length" -v t="$thickness" -v F="$load" 'BEGIN {
    printf "%s,%.17g,%.17g\n", id, 4 * F * L * L * L / (70e3 * 10 * t * t * t), 6 * F * L / (10 * t * t)
  }'
done
"#;

pub fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    std::fs::write(folder.path().join("beam.sh"), SCRIPT)?;
    let millimetres = || Unit::parse("mm");
    let factors = vec![
        Factor::new("length", millimetres()?, Distribution::uniform(95.0, 105.0)?)?,
        Factor::new("thickness", millimetres()?, Distribution::uniform(1.9, 2.1)?)?,
        Factor::new("load", Unit::parse("N")?, Distribution::uniform(4.0, 6.0)?)?,
    ];
    let output = |name: &str, unit| CommandOutput { name: name.to_owned(), unit, pick: None };
    let settings = CommandSettings {
        program: Program {
            arguments: ["sh", "beam.sh"].map(str::to_owned).to_vec(),
            directory: folder.path().to_owned(),
            environment: Vec::new(),
        },
        form: Form::KeptAlive(Protocol::Csv),
        outputs: vec![output("deflection", millimetres()?), output("stress", Unit::parse("MPa")?)],
        series: Vec::new(),
        requested: vec![0, 1],
        workers: Some(2),
        timeout: None,
        retries: 1,
    };
    let model = CommandModel::new(settings, factors.clone());
    let builder = Study::builder("beam", model).base_samples(128);
    let study = factors.into_iter().fold(builder, |builder, factor| builder.with_factor(factor)).build()?;

    let result = study.run()?;
    for output in &result.outputs {
        assert_eq!(output.runs_failed, 0, "{:?}", output.failures);
        for factor in study.space().factors() {
            let share = output.factor(&factor.name)?.share_total.ok_or("no share")?;
            println!("{}: {} {:.0} %", output.name, factor.name, share);
        }
    }

    // The same formula in Rust, at the same points. Its numbers and those of awk may differ in their last bits.
    let stress = function_model("stress", |x| 6.0 * x[2] * x[0] / (10.0 * x[1] * x[1]));
    let check = Study::builder("check", stress)
        .factor("length", Distribution::uniform(95.0, 105.0)?)
        .factor("thickness", Distribution::uniform(1.9, 2.1)?)
        .factor("load", Distribution::uniform(4.0, 6.0)?)
        .base_samples(128)
        .build()?;
    let expected = check.run()?;
    for factor in ["length", "thickness", "load"] {
        let (mine, theirs) = (result.output("stress")?.factor(factor)?, expected.output("stress")?.factor(factor)?);
        assert!((mine.total.estimate - theirs.total.estimate).abs() < 1e-9);
    }
    Ok(())
}
