//! Other measures than Sobol' indices in the result of a run, from its first rows A and B.

use ::apportion::given::{Column, Measure, analyse, measures};
use ::apportion::{AnalysisOptions, Distribution, Sampler, Study, SurrogateChoice, function_model};

use crate::common::{Folder, run_in_parts, succeed, text};
use crate::messages::messages;

/// A sum of three normal factors with slopes 3, 2 and 1, and one without effect; rows with a large first factor fail if requested.
fn linear(sampler: Sampler, base_samples: u64, wanted: &[Measure], fails: bool) -> Study {
    let value = move |x: &[f64]| if fails && x[0] > 1.0 { f64::NAN } else { 3.0 * x[0] + 2.0 * x[1] + x[2] };
    let options = AnalysisOptions {
        measures: wanted.to_vec(),
        surrogate: SurrogateChoice::Off,
        max_failed: 0.5,
        ..AnalysisOptions::for_sampler(sampler)
    };
    let mut builder = Study::builder("linear", function_model("y", value)).sampler(sampler).base_samples(base_samples);
    for name in ["x1", "x2", "x3", "idle"] {
        builder = builder.factor(name, Distribution::normal(0.0, 1.0).unwrap());
    }
    builder.seed(3).analysis(options).build().unwrap()
}

/// The deltas of a sum of normals by quadrature, and the squares of the correlations, which the spectrum finds.
#[test]
fn exact_measures_are_found_from_nets_and_random_rows() {
    for sampler in [Sampler::Sobol, Sampler::Random, Sampler::LatinHypercube] {
        let analysis = linear(sampler, 1 << 13, &[Measure::Delta, Measure::Fourier], false).run().unwrap();
        let found = analysis.outputs[0].measures.as_ref().unwrap();
        assert_eq!(found.rows, 4096, "{sampler:?}");
        let names: Vec<&str> = found.factors.iter().map(|factor| factor.input.as_str()).collect();
        assert_eq!(names, ["x1", "x2", "x3", "idle"]);
        for (factor, (delta, first)) in found.factors.iter().zip([(0.3873, 9.0), (0.2016, 4.0), (0.0890, 1.0)]) {
            let [found, s1] = [Measure::Delta, Measure::Fourier].map(|measure| factor.get(measure).unwrap());
            let s1 = s1.estimate.estimate;
            let interval = found.estimate.interval.unwrap();
            assert!(interval.low < delta && delta < interval.high, "{sampler:?} {}: {found:?}", factor.input);
            assert!(interval.high - interval.low < 0.1, "{sampler:?} {}: {found:?}", factor.input);
            assert!((s1 - first / 14.0).abs() < 0.04, "{sampler:?} {}: {s1}", factor.input);
            // Evenly spread rows are not independent draws, so permutations do not apply.
            assert_eq!(found.p_value.map(|p| p < 0.01), (sampler == Sampler::Random).then_some(true), "{sampler:?}");
            assert!(factor.get(Measure::Hsic).is_none());
        }
        let idle = found.factors[3].get(Measure::Delta).unwrap();
        assert!(idle.p_value.is_none_or(|p| p > 0.05), "{sampler:?}: {idle:?}");
        assert!(idle.estimate.interval.unwrap().low <= 0.0, "{sampler:?}: {idle:?}");
    }
}

/// The same bits as from a table of the same rows.
#[test]
fn rows_of_a_run_are_given_data() {
    let study = linear(Sampler::Random, 256, &Measure::ALL, true);
    let analysis = study.run().unwrap();
    let found = analysis.outputs[0].measures.as_ref().unwrap();
    let (design, factors) = (study.design(), study.space().factors());
    let mut inputs: Vec<Column> =
        factors.iter().map(|factor| Column { name: factor.name.clone(), values: Vec::new() }).collect();
    let mut y = Vec::new();
    for base in 0..256 {
        for run in 0..2 {
            let mut u = [0.0; 4];
            design.point(base * design.rows_per_point() + run, &mut u);
            let x = study.space().values_at(&u);
            if x[0] <= 1.0 {
                inputs.iter_mut().zip(&x).for_each(|(input, x)| input.values.push(*x));
                y.push(3.0 * x[0] + 2.0 * x[1] + x[2]);
            }
        }
    }
    assert_eq!(found.rows, y.len());
    let outputs = [Column { name: "y".to_owned(), values: y }];
    let indices = analyse(&inputs, &outputs, 3).unwrap();
    assert_eq!(measures(&inputs, &outputs, &indices, 3).remove(0).unwrap(), found.factors);
}

#[test]
fn measures_are_missing_for_constant_outputs_and_few_rows() {
    let of = |value: fn(&[f64]) -> f64, base_samples: u64| {
        let options =
            AnalysisOptions { measures: vec![Measure::Delta], ..AnalysisOptions::for_sampler(Sampler::Sobol) };
        let builder = Study::builder("s", function_model("y", value)).base_samples(base_samples);
        let builder = builder.factor("x", Distribution::uniform(0.0, 1.0).unwrap());
        builder.analysis(options).build().unwrap().run().unwrap().outputs[0].measures.clone()
    };
    assert!(of(|_| 1.0, 64).is_none() && of(|x| x[0], 8).is_none() && of(|x| x[0], 64).is_some());
}

const STUDY: &str = "model = \"expression\"\n[outputs]\ny = \"3*a + 2*b*b\"\nz = \"b\"\n[design]\nbase_samples = 512\n\
                     [analysis]\nmeasures = [\"pawn_median\", \"delta\"]\n";

fn study() -> String {
    let factor = |name: &str| format!("[[factor]]\nname = \"{name}\"\nmin = -1\nmax = 1\n");
    STUDY.to_owned() + &["a", "b", "idle"].map(factor).concat()
}

#[test]
fn the_program_lists_them_with_the_indices() {
    let folder = Folder::new();
    let file = folder.with("study.toml", study());
    let (out, mut messages) = (folder.path("out"), messages!());
    messages.add_printed("check", &succeed(&["check", text(&file)]));
    messages.add_printed("run", &succeed(&["run", text(&file), "--out", text(&out)]));
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("study.json")).unwrap()).unwrap();
    let of = |output: usize, factor: usize| json["outputs"][output]["measures"]["factors"][factor].clone();
    assert_eq!(json["outputs"][0]["measures"]["rows"], 1024);
    let delta = &of(0, 0)["measures"]["delta"];
    assert!(delta["low"].is_number() && delta["p_value"].is_null() && of(0, 0)["input"] == "a");
    assert_eq!(of(0, 0)["measures"].as_object().unwrap().len(), 2);
    let csv = std::fs::read_to_string(out.join("study-measures.csv")).unwrap();
    assert!(csv.starts_with("output,factor,delta,delta_low,delta_high,delta_p,pawn_median,"), "{csv}");
    assert_eq!(csv.lines().count(), 1 + 2 * 3);
    let page = std::fs::read_to_string(out.join("study.html")).unwrap();
    let again = folder.path("again");
    succeed(&["report", text(&out.join("study.json")), "--out", text(&again)]);
    assert_eq!(page, std::fs::read_to_string(again.join("study.html")).unwrap());
    // Random points are independent draws.
    let drawn = folder.path("drawn");
    let random = ["run", text(&file), "--set", "design.sampler=random", "--out", text(&drawn)];
    messages.add_printed("random points", &succeed(&random));
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(drawn.join("study.json")).unwrap()).unwrap();
    let idle = &json["outputs"][1]["measures"]["factors"][0]["measures"]["pawn_median"]["p_value"];
    assert!(idle.as_f64().unwrap() > 0.05, "z is b alone");
    // Threads and merged shards make no difference.
    let measured = |folder: &std::path::Path| std::fs::read(folder.join("study-measures.csv")).unwrap();
    let alone = folder.path("alone");
    succeed(&["run", text(&file), "--threads", "1", "--out", text(&alone)]);
    assert_eq!(measured(&out), measured(&alone));
    let merged = folder.path("merged");
    run_in_parts(&file, &merged);
    assert_eq!(measured(&out), measured(&merged));
}

#[test]
fn unknown_measures_are_refused() {
    let folder = Folder::new();
    let file = folder.with("study.toml", study());
    let mut messages = messages!();
    for change in ["analysis.measures=[\"pawn\"]", "analysis.measures=\"delta\""] {
        messages.refused(&["check", text(&file), "--set", change]);
    }
    let outputs: String = (0..101).map(|k| format!("y{k} = \"a + {k}*b\"\n")).collect();
    let many = study().replace("y = \"3*a + 2*b*b\"\nz = \"b\"\n", &outputs);
    messages.refused(&["check", text(&folder.with("many.toml", many))]);
}
