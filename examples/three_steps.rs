//! The three steps of a study on their own, joined by files: sample, evaluate somewhere else, analyse.
//!
//!     cargo run --release --example three_steps

use std::error::Error;
use std::fmt::Write;
use std::path::Path;

use apportion_files::exchange::{
    AnswersRequest, Format, Manifest, Missing, Points, ReadOptions, open_table, read_answers, sample,
};
use apportion_report::{run_document, stream_atomically, write_atomically};

const STUDY: &str = r#"
title = "The force of a spring"
model = "external"
[outputs]
force = "nN"
[design]
base_samples = 1024
[[factor]]
name = "stiffness"
min = 0.5
max = 1.5
unit = "N/m"
[[factor]]
name = "extension"
min = 10
max = 20
unit = "nm"
"#;

/// The first step: the points, and beside them a manifest that says whose they are.
fn sampled(points: &Path) -> Result<(), Box<dyn Error>> {
    let study = apportion_files::parse_study(STUDY, Path::new("spring.toml"), &[])?;
    let rows = Points::Design(study.design());
    let manifest = stream_atomically(points, |out| sample(&study, Path::new("spring.toml"), &rows, Format::Csv, out))?;
    Ok(write_atomically(&Manifest::path_for(points), manifest.json().as_bytes())?)
}

/// The second step, which any program on any machine can do: an output for each point, in the order of the points.
fn evaluated(points: &str) -> Result<String, Box<dyn Error>> {
    let mut outputs = "force\n".to_owned();
    for line in points.lines().skip(1) {
        let (stiffness, extension) = line.split_once(',').ok_or("a line without a comma")?;
        // N/m times nm is nN.
        writeln!(outputs, "{}", stiffness.parse::<f64>()? * extension.parse::<f64>()?)?;
    }
    Ok(outputs)
}

pub fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let (points, outputs) = (folder.path().join("spring-design.csv"), folder.path().join("outputs.csv"));
    sampled(&points)?;
    std::fs::write(&outputs, evaluated(&std::fs::read_to_string(&points)?)?)?;

    // The third: outputs that are not those of the points in the manifest are refused, with the first place that shows it.
    let manifest = Manifest::parse(&std::fs::read_to_string(Manifest::path_for(&points))?)?;
    let request = AnswersRequest { manifest: &manifest, outputs: &[], units: &[], missing: Missing::Refuse };
    let answers = read_answers(open_table(&outputs, &ReadOptions::default())?.as_mut(), &request)?;
    let result = answers.study.runner().store(&answers.store).run()?;
    print!("{}", run_document(&result).text());

    // With c^2 = variance / mean^2, here 1/12 and 1/27: S_i = c_i^2 / ((1 + c_1^2) (1 + c_2^2) - 1).
    let output = &result.outputs[0];
    for (factor, exact) in [("stiffness", 0.675), ("extension", 0.3)] {
        assert!((output.factor(factor)?.first_order.estimate - exact).abs() < 0.005);
    }
    Ok(())
}
