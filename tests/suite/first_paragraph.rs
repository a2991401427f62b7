//! What stands at the top of a page: what decides, how sure that is, how much is interaction, whether the model holds, and
//! what cannot be told apart.

use std::path::Path;

use apportion::report::{ResultFile, run_document};
use apportion::{Distribution, FunctionModel, SeriesAxis, Study, Unit};

use crate::common::{analysed, study_path, succeed, text};

/// The paragraphs at the top of the page on `y` = `formula` of a, b and c between 0 and 1.
fn of(formula: &str, design: &str) -> String {
    let factors: String =
        ["a", "b", "c"].map(|name| format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n")).concat();
    told(&format!("model = \"expression\"\n[expression]\noutputs.y = \"{formula}\"\n[design]\n{design}\n{factors}"))
}

fn told(text: &str) -> String {
    let study = Study::parse(text, Path::new("small.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    lead(&ResultFile::new(&study, &study.run().unwrap()))
}

fn lead(result: &ResultFile) -> String {
    run_document(result).lead.join("\n")
}

/// A wave at twelve times, the first of which does not vary.
fn series() -> String {
    let positions: Vec<f64> = (0..12).map(|k| f64::from(k) * 0.5).collect();
    let axis = SeriesAxis::new("time", "s", positions.clone()).unwrap();
    let model = FunctionModel::new(Vec::new(), move |x: &[f64], y: &mut [f64]| {
        y.iter_mut().zip(&positions).for_each(|(y, t)| *y = x[0] * t + x[1] * x[2] * t * t);
        Ok(())
    });
    let model = model.with_series("wave", Unit::parse("um").unwrap(), axis);
    let uniform = || Distribution::uniform(0.0, 1.0).unwrap();
    let study =
        ["a", "b", "c"].iter().fold(Study::builder("waves", model), |study, name| study.factor(name, uniform()));
    let study = study.base_samples(256).build().unwrap();
    lead(&ResultFile::new(&study, &study.run().unwrap()))
}

/// y = a + b + 3 (a - 1/2)(b - 1) + c e, e a number that is drawn anew in every run.
fn stochastic() -> String {
    let model = apportion::function_model("y", |x: &[f64]| {
        let e = (x[3] + 0.5) / 2f64.powi(30) - 1.0;
        x[0] + x[1] + 3.0 * (x[0] - 0.5) * (x[1] - 1.0) + x[2] * e
    });
    let uniform = |max| Distribution::uniform(0.0, max).unwrap();
    let study = Study::builder("noisy", model).factor("a", uniform(1.0)).factor("b", uniform(2.0));
    let study =
        study.factor("c", uniform(1.0)).factor("seed", Distribution::seed()).base_samples(1024).build().unwrap();
    lead(&ResultFile::new(&study, &study.run().unwrap()))
}

/// What the program prints of a screening before its first table.
fn screened(study: &str, more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path(study);
    let said = succeed(&[&["screen", text(&study), "--charts", "none", "--out", text(folder.path())], more].concat());
    said.split("\n\n").next().unwrap_or_default().to_owned()
}

fn of_file(name: &str, base_samples: u64) -> String {
    lead(&analysed(name, &[&format!("design.base_samples={base_samples}")]))
}

#[test]
fn the_first_paragraph_tells_what_the_intervals_bear() {
    const FAILING: &str = "base_samples = 256\n[analysis]\nmax_failed = 0.9";
    let kinds = [
        ("clear winner", of("4*a+2*b+c*b", "base_samples = 256")),
        ("tie", of("a+b+0.1*c", "base_samples = 64")),
        ("three tied", of("a+b+c+a*b*c", "base_samples = 64\n[analysis]\nsurrogate = 'off'")),
        ("constant output", of("3+0*a", "base_samples = 64")),
        ("all rows failed", of("ln(-1-a)", FAILING)),
        ("many failed", of("if(a < 0.3, ln(-1), a+b*c)", FAILING)),
        ("out of validity", of_file("soft-cantilever", 256)),
        ("skewed", of("exp(9*a*a*b)+c", "base_samples = 64")),
        ("interactions only", of("(a-0.5)*(b-0.5)*(1+0.1*c)", "base_samples = 256")),
        ("series", series()),
        (
            "a single replicate",
            of("4*a+2*b*c", "base_samples = 64\nreplicates = 1\n[analysis]\nintervals = 'replicates'"),
        ),
        ("dependent factors", of_file("portfolio", 1024)),
        ("stochastic", stochastic()),
        ("screened", screened("sobol-g", &[])),
        ("screened by derivatives", screened("ishigami", &["--design", "derivative", "--trajectories", "256"])),
    ];
    let all: String = kinds.iter().map(|(kind, text)| format!("{kind}:\n{text}\n\n")).collect();
    insta::assert_snapshot!(all.trim_end());
}
