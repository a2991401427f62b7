//! What stands at the top of a page: what decides, how sure that is, how much is interaction, whether the model holds, and
//! what cannot be told apart.

use std::path::Path;

use apportion::report::{OutputRecord, ResultFile, run_document};
use apportion::{Distribution, FunctionModel, SeriesAxis, Study, Unit};

use crate::common::{analysed, study_path, succeed, text};

/// The paragraphs at the top of the page on `y` = `formula` of a, b and c between 0 and 1.
fn of(formula: &str, design: &str) -> String {
    let factors: String =
        ["a", "b", "c"].map(|name| format!("[[factor]]\nname = \"{name}\"\nmin = 0\nmax = 1\n")).concat();
    told(&format!("model = \"expression\"\n[expression]\noutputs.y = \"{formula}\"\n[design]\n{design}\n{factors}"))
}

fn told(text: &str) -> String {
    lead(&result(text))
}

fn result(text: &str) -> ResultFile {
    let study = Study::parse(text, Path::new("small.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    ResultFile::new(&study, &study.run().unwrap())
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
fn stochastic() -> ResultFile {
    let model = apportion::function_model("y", |x: &[f64]| {
        let e = (x[3] + 0.5) / 2f64.powi(30) - 1.0;
        x[0] + x[1] + 3.0 * (x[0] - 0.5) * (x[1] - 1.0) + x[2] * e
    });
    let uniform = |max| Distribution::uniform(0.0, max).unwrap();
    let study = Study::builder("noisy", model).factor("a", uniform(1.0)).factor("b", uniform(2.0));
    let study =
        study.factor("c", uniform(1.0)).factor("seed", Distribution::seed()).base_samples(1024).build().unwrap();
    ResultFile::new(&study, &study.run().unwrap())
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
        ("stochastic", lead(&stochastic())),
        ("screened", screened("sobol-g", &[])),
        ("screened by derivatives", screened("ishigami", &["--design", "derivative", "--trajectories", "256"])),
    ];
    let all: String = kinds.iter().map(|(kind, text)| format!("{kind}:\n{text}\n\n")).collect();
    insta::assert_snapshot!(all.trim_end());
}

/// Nothing is interaction where one factor alone moves the output, be it rarely.
#[test]
fn a_rare_event_of_one_factor_is_no_interaction() {
    let factors = "[factors]\na = { min = 0, max = 1 }\nb = { min = 0, max = 1 }\nc = { min = 0, max = 1 }\n";
    for seed in 0..10 {
        let study = format!(
            "model = \"expression\"\noutputs.y = \"if(a>0.999,1,0)\"\n[design]\nbase_samples = 1024\nseed = {seed}\n{factors}"
        );
        let document = run_document(&result(&study));
        let captions: Vec<&str> = document.figures().iter().map(|figure| figure.chart.caption()).collect();
        let said = document.text() + &captions.join(" ");
        for claim in [
            "is interaction",
            "acts together",
            "acts most together",
            "together with others.",
            "with all its interactions",
        ] {
            assert!(!said.contains(claim), "{seed}: {claim} in {said}");
        }
    }
}

/// Of four factors: three that act together and one that hardly acts, at few base samples of a seed.
fn few(seed: u64) -> ResultFile {
    let factors: String = (1..=4).map(|k| format!("x{k} = {{ min = -1, max = 1 }}\n")).collect();
    result(&format!(
        "model = \"expression\"\noutputs.y = \"x1*x2*x3+0.001*x4\"\n[design]\nbase_samples = 16\nseed = {seed}\n[analysis]\n\
         surrogate = \"off\"\n[factors]\n{factors}"
    ))
}

/// The number before a phrase.
fn number_before(text: &str, phrase: &str) -> usize {
    let before = text.split_once(phrase).map_or("", |(before, _)| before);
    before.rsplit(' ').next().unwrap().parse().unwrap_or(0)
}

#[test]
fn what_is_sure_is_so_by_its_interval_too() {
    const THRESHOLD: f64 = 0.05;
    for seed in 0..60 {
        let result = few(seed);
        let said = lead(&result);
        let totals = || result.outputs[0].indices.iter().flatten().map(|index| index.effect.total);
        let exceed = totals().filter(|total| total.low.is_some_and(|low| low > THRESHOLD)).count();
        let stay = totals().filter(|total| total.high.is_some_and(|high| high < THRESHOLD)).count();
        assert!(number_before(&said, " surely exceed") <= exceed, "{seed}: {said}");
        assert!(number_before(&said, " surely do") <= stay, "{seed}: {said}");
    }
}

#[test]
fn nobody_below_a_tie_has_a_larger_estimate() {
    let total = |output: &OutputRecord, factor: &str| {
        output.indices.iter().flatten().find(|index| index.factor == factor).unwrap().effect.total.estimate
    };
    for seed in 0..60 {
        let result = few(seed);
        let (said, output) = (lead(&result), &result.outputs[0]);
        let Some((tied, rest)) = said.split_once(" Next come") else { continue };
        let rest = rest.split_once(';').unwrap().0;
        let named = |part: &str| {
            ["x1", "x2", "x3", "x4"]
                .into_iter()
                .filter(|x| part.contains(x))
                .map(|x| total(output, x))
                .collect::<Vec<_>>()
        };
        let least = named(tied).into_iter().fold(f64::INFINITY, f64::min);
        assert!(named(rest).into_iter().all(|other| other <= least), "{seed}: {said}");
    }
}

/// A surrogate knows the mean better than the values do: the two are not mixed up.
#[test]
fn values_have_their_own_mean() {
    let factors = "[factors]\nx1 = { min = 0, max = 1 }\nx2 = { min = 0, max = 1 }\nx3 = { min = 0, max = 1 }\n";
    let study = "model = \"expression\"\noutputs.y = \"exp(3*x1)+x2*x3\"\n[design]\nbase_samples = 16\n";
    let result = result(&format!("{study}{factors}"));
    let own = format!("{:.3}", result.outputs[0].distribution.as_ref().unwrap().sample.mean);
    assert!(format!("{:.3}", result.outputs[0].mean.unwrap()) != own, "the example needs a mean that is corrected");
    let html = run_document(&result).html().unwrap();
    assert!(html.contains(&format!("their mean is {own}")), "{html}");
    assert!(html.contains(&format!("corrected by the surrogate (that of the values is {own})")));
    assert!(html.contains("mean, corrected by the surrogate") && html.contains("mean of the values"));
}

/// The part of the noise and the rest are two sides of one number.
#[test]
fn the_rest_beside_the_noise_has_the_same_error() {
    let mut result = stochastic();
    let noise = result.outputs[0].noise.as_mut().unwrap();
    let total = &mut noise.effect.total;
    (total.estimate, total.low, total.high) = (0.52, Some(0.44), Some(0.69));
    let said = run_document(&result).text();
    assert!(said.contains("52 [44, 69] % is noise") && said.contains("the other 48 [31, 56] %"), "{said}");
    assert!(said.contains("every index of the values is known to"), "{said}");
}

/// Plain rows have no part in plain indices: what surrogates gain is beside the base samples alone.
#[test]
fn a_gain_says_what_it_is_measured_by() {
    let study = |model: &str, design: &str| {
        let text = format!("model = \"{model}\"\n[design]\n{design}\n");
        run_document(&result(&text)).text()
    };
    let split = study("ishigami", "base_samples = 256\nplain_rows = 8");
    assert!(split.contains(" times its base samples alone") && !split.contains(" times the runs"), "{split}");
    assert!(study("ishigami", "base_samples = 256").contains(" times the runs"));
    // Where a warning says that plain rows are of little use, no gain is told.
    let poor = study("steps", "base_samples = 64\nplain_rows = 2");
    assert!(poor.contains("all runs as base samples are better"), "{poor}");
    assert!(!poor.contains("with the accuracy of"), "{poor}");
    // Of few base points the error of plain indices is hardly known.
    let few = study("linear", "base_samples = 8\nplain_rows = 8");
    assert!(!few.contains("million times") && few.contains("more than a thousand times"), "{few}");
}
