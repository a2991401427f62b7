//! Indices corrected by surrogates: exact where the model is a polynomial, more accurate elsewhere, the same bits on any
//! number of threads and from a journal, and described in the result.

use std::path::Path;

use apportion::model::KnownAnswer;
use apportion::{Resume, Study};

use crate::common::{effects, run_in_parts, succeed, text};
use crate::messages::messages;

fn study(text: &str, more: &[&str]) -> Study {
    let overrides: Vec<String> = more.iter().map(|text| (*text).to_owned()).collect();
    apportion_files::parse_study(text, Path::new("surrogate.toml"), &overrides).unwrap()
}

const ON: &str = "analysis.surrogate=\"on\"";

const OFF: &str = "analysis.surrogate=\"off\"";

#[test]
fn a_polynomial_has_its_indices_to_rounding() {
    // Var(x1) = 1/12, Var(2 x2) = 4/12, x1 x2 centred 3: 9/144.
    let text = "model = \"expression\"\n[outputs]\ny = \"x1 + 2*x2 + 3*(x1-0.5)*(x2-0.5)\"\n\
                [[factor]]\nname = \"x1\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"x2\"\nmin = 0\nmax = 1\n\
                [[factor]]\nname = \"x3\"\nmin = 0\nmax = 1\n[analysis]\nsecond_order = true\nsubsets = [[\"x1\", \"x2\"]]\n";
    let result = study(text, &[ON, "design.base_samples=64"]).run().unwrap();
    let output = result.output("y").unwrap();
    let factors = effects(output);
    let (one, two, both) = (1.0 / 12.0, 4.0 / 12.0, 9.0 / 144.0);
    let variance = one + two + both;
    let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-9, "{found} {exact}");
    for (effect, first, total) in
        [(0, one, one + both), (1, two, two + both), (2, 0.0, 0.0)].map(|(k, s, t)| (factors[k], s, t))
    {
        close(effect.first_order.estimate, first / variance);
        close(effect.total.estimate, total / variance);
        close(effect.interaction.unwrap().estimate, (total - first) / variance);
        let interval = effect.total.interval.unwrap();
        assert!(
            interval.low <= total / variance
                && total / variance <= interval.high
                && interval.high - interval.low < 1e-8
        );
    }
    close(output.subsets.as_ref().unwrap()[0].effect.first_order.estimate, 1.0);
    close(output.second_order.as_ref().unwrap()[0].index.estimate, both / variance);
    close(output.sum_first_order.unwrap().estimate, (one + two) / variance);
    close(factors[1].share_first_order.unwrap(), 80.0);
    close(output.variance.unwrap(), variance);
    close(output.mean.unwrap(), 1.5);
    let used = output.surrogate.as_ref().unwrap();
    assert!(used.corrects_first_order && used.corrects_total && used.explained > 1.0 - 1e-9);
    assert_eq!(used.leading_terms[0].degrees, [("x2".to_owned(), 1)].into());
    close(used.leading_terms[0].share, 100.0 * two / variance);
}

#[test]
fn mean_and_variance_keep_their_intervals_at_any_scale() {
    let relative = |factor: &str| {
        let text = format!(
            "model = \"expression\"\n[outputs]\ny = \"{factor}*(exp(2*x1)*abs(x2-0.3)+x1)\"\n\
             [[factor]]\nname = \"x1\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"x2\"\nmin = 0\nmax = 1\n"
        );
        let result = study(&text, &[ON, "design.base_samples=64"]).run().unwrap();
        let output = result.output("y").unwrap();
        [(output.mean, output.mean_interval), (output.variance, output.variance_interval)].map(|(of, interval)| {
            let (of, interval) = (of.unwrap(), interval.unwrap());
            [(of - interval.low) / of, (interval.high - of) / of]
        })
    };
    let plain = relative("1");
    assert!(plain.iter().flatten().all(|width| *width > 1e-6 && *width < 0.5), "{plain:?}");
    for factor in ["1e-9", "1e-60", "1e60"] {
        for (found, expected) in relative(factor).iter().flatten().zip(plain.iter().flatten()) {
            // Scaled outputs differ by rounding, and so do the steps of the search for hyperparameters.
            assert!((found / expected - 1.0).abs() < 0.1, "{factor}: {found} {expected}");
        }
    }
}

#[test]
fn smooth_functions_are_known_a_hundred_times_better_and_rough_ones_no_worse() {
    for (name, factor) in [("ishigami", 1000.0), ("wing-weight", 100.0), ("sobol-g", 3.0), ("steps", 0.9)] {
        let exact = KnownAnswer::from_name(name).unwrap().default_function().exact().indices.unwrap();
        let error = |more: &[&str]| -> f64 {
            let seeds = (0..2).map(|seed| {
                let seed = format!("design.seed={seed}");
                let model = format!("model = \"{name}\"");
                let result = study(&model, &[more, &["design.base_samples=128", &seed]].concat()).run().unwrap();
                let indices = effects(&result.outputs[0]);
                let squares =
                    indices.iter().zip(exact.first_order.iter().zip(&exact.total)).map(|(effect, (first, total))| {
                        (effect.first_order.estimate - first).powi(2) + (effect.total.estimate - total).powi(2)
                    });
                squares.sum::<f64>()
            });
            seeds.sum::<f64>().sqrt()
        };
        let (plain, corrected) = (error(&[OFF]), error(&[ON]));
        assert!(corrected * factor < plain, "{name}: {corrected:e} against {plain:e}");
    }
}

#[test]
fn few_levels_and_normal_factors_are_fitted_in_their_own_polynomials() {
    let text = "model = \"expression\"\n[outputs]\ny = \"z^2 + k*z + t\"\n\
                [[factor]]\nname = \"z\"\ndistribution = \"normal\"\nmean = 0\nsd = 1\n\
                [[factor]]\nname = \"k\"\ndistribution = \"discrete\"\nvalues = [1, 2, 5]\nweights = [0.5, 0.3, 0.2]\n\
                [[factor]]\nname = \"t\"\ndistribution = \"triangular\"\nmin = 0\nmode = 1\nmax = 3\n";
    let result = study(text, &[ON, "design.base_samples=64"]).run().unwrap();
    let indices = effects(&result.outputs[0]);
    // Var z^2 = 2; E k = 2.1, E k^2 = 6.7; Var t = (9 + 1 - 3)/18.
    let (alone, interaction, triangle) = (2.0 + 2.1 * 2.1, 6.7 - 2.1 * 2.1, 7.0 / 18.0);
    let variance = alone + interaction + triangle;
    for (effect, exact) in indices.iter().zip([(alone, alone + interaction), (0.0, interaction), (triangle, triangle)])
    {
        assert!((effect.first_order.estimate - exact.0 / variance).abs() < 1e-9, "{effect:?}");
        assert!((effect.total.estimate - exact.1 / variance).abs() < 1e-9, "{effect:?}");
    }
}

#[test]
fn the_bits_are_the_same_on_any_number_of_threads_and_from_a_journal() {
    let folder = tempfile::tempdir().unwrap();
    let study = study("model = \"borehole\"\n[analysis]\ndummy = true\n", &[ON, "design.base_samples=64"]);
    let run = |threads: usize, resume: Resume| {
        let journal = folder.path().join("borehole.journal");
        let result = study.runner().threads(threads).journal(journal).resume(resume).run().unwrap();
        let mut file = result;
        (file.provenance.wall_seconds, file.provenance.threads) = (0.0, 0);
        file
    };
    let first = run(1, Resume::Restart);
    assert_eq!(first, run(2, Resume::Restart));
    assert_eq!(first, run(2, Resume::Require));
    assert!(first.outputs[0].surrogate.as_ref().unwrap().gain_total.unwrap() > 100.0);
}

/// The stages need additional fits, and do not change the result.
#[test]
fn stages_can_be_left_out() {
    let result = |more: &str| {
        let study = study("model = \"borehole\"", &[ON, "design.base_samples=256", more]);
        let mut file = study.run().unwrap();
        file.outputs.remove(0)
    };
    let (with, mut without) = (result("analysis.convergence=true"), result("analysis.convergence=false"));
    assert_eq!((with.convergence.len() > 1, &without.convergence[..]), (true, &[][..]));
    without.convergence.clone_from(&with.convergence);
    assert_eq!(with, without);
}

#[test]
fn without_a_fit_the_plain_indices_are_reported() {
    let with = |text: &str, more: &[&str]| {
        let result = study(text, &[more, &[ON]].concat()).run().unwrap();
        result.outputs[0].surrogate.is_some()
    };
    assert!(with("model = \"ishigami\"", &["design.base_samples=64"]));
    assert!(!with("model = \"ishigami\"", &["design.base_samples=64", "design.replicates=2"]), "too few nets");
    assert!(!with("model = \"ishigami\"", &["design.base_samples=8"]), "too few points");
    assert!(!with("model = \"linear\"\n[function]\nc = [0, 0]", &["design.base_samples=64"]), "no variance");
}

#[test]
fn a_few_hundred_runs_are_plain_rows() {
    let run = |text: &str, more: &[&str]| {
        let study = study(text, more);
        (study.design().clone(), study.run().unwrap())
    };
    let (design, result) = run("model = \"borehole\"", &["design.runs=300"]);
    assert_eq!((design.settings().base_samples, design.is_plain(), design.rows()), (148, true, 296));
    let exact = KnownAnswer::from_name("borehole").unwrap().default_function().exact().indices.unwrap();
    let error = |result: &apportion::StudyResult| {
        let factors = effects(&result.outputs[0]);
        let of = |(effect, exact): (&apportion::EffectEstimates, &f64)| (effect.total.estimate - exact).abs();
        factors.iter().zip(&exact.total).map(of).fold(0.0, f64::max)
    };
    let (_, plain) = run("model = \"borehole\"", &["design.base_samples=28", OFF]);
    assert!(error(&result) < 1e-4 && error(&plain) > 1e-2, "{:e} {:e}", error(&result), error(&plain));
    // A polynomial of two factors is exact.
    let text = "model = \"expression\"\n[outputs]\ny = \"x1 + 2*x2\"\n\
                [[factor]]\nname = \"x1\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"x2\"\nmin = 0\nmax = 1\n";
    let (_, result) = run(text, &["design.runs=72"]);
    let output = &result.outputs[0];
    let totals: Vec<f64> = effects(output).iter().map(|effect| effect.total.estimate).collect();
    assert!((totals[0] - 0.2).abs() < 1e-9 && (totals[1] - 0.8).abs() < 1e-9, "{totals:?}");
    assert!((output.mean.unwrap() - 1.5).abs() < 1e-9);
}

#[test]
fn without_surrogates_runs_are_all_at_base_samples() {
    for without in [OFF, "analysis.intervals=replicates", "design.sampler=latin-hypercube", "design.replicates=2"] {
        let study = study("model = \"borehole\"", &["design.runs=900", without]);
        let design = study.design();
        assert!(!design.is_plain(), "{without}");
        assert!(design.rows() <= 900 && 2 * design.rows() > 900, "{without}: {}", design.rows());
    }
}

#[test]
fn shards_and_files_of_outputs_give_the_bits_of_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let file = path("mine.toml");
    std::fs::write(&file, "model = \"ishigami\"\n[design]\nruns = 600\n").unwrap();
    let numbers = |name: &str| -> serde_json::Value {
        let json = std::fs::read_to_string(path(name)).unwrap();
        serde_json::from_str::<serde_json::Value>(&json).unwrap()["outputs"][0].take()
    };
    succeed(&["run", text(&file), "--out", text(&path("one"))]);
    run_in_parts(&file, &path("merged"));
    assert_eq!(numbers("one/mine.json"), numbers("merged/mine.json"));
    // The same by a table of the points, evaluated on its own.
    let (points, outputs, out) = (path("points.csv"), path("outputs.csv"), path("analysed"));
    succeed(&["sample", text(&file), "-o", text(&points)]);
    succeed(&["evaluate", text(&file), text(&points), "-o", text(&outputs)]);
    succeed(&["analyze", text(&outputs), "--design", text(&points), "--out", text(&out)]);
    let name = crate::common::files(&out).into_iter().find(|name| name.ends_with(".json")).unwrap();
    let (one, analysed) = (numbers("one/mine.json"), numbers(&format!("analysed/{name}")));
    for key in ["indices", "surrogate", "mean", "variance"] {
        assert_eq!(one[key], analysed[key], "{key}");
    }
}

#[test]
fn the_stages_of_a_run_are_what_shorter_runs_give() {
    let folder = tempfile::tempdir().unwrap();
    let result = |base_samples: u64, surrogate: &str| -> serde_json::Value {
        let path = |ending: &str| folder.path().join(format!("{base_samples}{ending}"));
        let lines = format!(
            "model = \"sobol-g\"\n[design]\nbase_samples = {base_samples}\n[analysis]\nsurrogate = \"{surrogate}\"\n"
        );
        std::fs::write(path(".toml"), lines).unwrap();
        succeed(&["run", text(&path(".toml")), "--out", text(folder.path())]);
        serde_json::from_str(&std::fs::read_to_string(path(".json")).unwrap()).unwrap()
    };
    let whole = result(512, "off");
    let stages = whole["outputs"][0]["convergence"].as_array().unwrap();
    assert_eq!(stages.len(), 5);
    for stage in stages {
        let shorter = result(stage["base_samples"].as_u64().unwrap(), "off");
        let last = shorter["outputs"][0]["convergence"].as_array().unwrap().last().unwrap();
        assert_eq!(stage, last);
        let of_result = |index: &serde_json::Value| [index["first_order"].clone(), index["total"].clone()];
        let shorter = shorter["outputs"][0]["indices"].as_array().unwrap();
        let stage = stage["indices"].as_array().unwrap();
        assert!(stage.iter().map(of_result).eq(shorter.iter().map(of_result)));
    }
    // Those of surrogates are in the terms of the whole run, which ends as it says.
    let whole = &result(512, "on")["outputs"][0];
    let last = whole["convergence"].as_array().unwrap().last().unwrap()["indices"].as_array().unwrap();
    let indices = whole["indices"].as_array().unwrap();
    assert!(last.iter().zip(indices).all(|(last, index)| last["total"] == index["total"]));
}

#[test]
fn the_program_describes_the_surrogate() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    std::fs::write(&file, "model = \"ishigami\"\n[design]\nbase_samples = 256\n[analysis]\nsurrogate = \"auto\"\n")
        .unwrap();
    let mut messages = messages!();
    messages.add_printed("run", &succeed(&["run", text(&file), "--out", text(folder.path())]));
    let json = std::fs::read_to_string(folder.path().join("mine.json")).unwrap();
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    let record = &value["outputs"][0]["surrogate"];
    assert!(record["explained"].as_f64().unwrap() > 0.999_999 && record["plain"].as_array().unwrap().len() == 3);
    assert!(record["leading_terms"][0]["degrees"].is_object());
    // The same from the file only.
    succeed(&["report", text(&folder.path().join("mine.json")), "--out", text(&folder.path().join("again"))]);
    messages.refused(&["run", text(&file), "--set", "analysis.intervals=replicates", "--set", ON]);
    messages.refused(&["check", text(&file), "--set", "analysis.surrogate=yes"]);
}

/// cos(2 a) or sin(2 a) of a standard normal a, and 1.5 c: polynomials that fit them where the runs are blow up beyond.
#[test]
fn intervals_hold_where_polynomials_blow_up_in_the_tails() {
    let of_c = 1.5_f64.powi(2) / 12.0;
    let waves = [("cos", (1.0 + libm::exp(-8.0)) / 2.0 - libm::exp(-4.0)), ("sin", (1.0 - libm::exp(-8.0)) / 2.0)];
    for (wave, of_a) in waves {
        let exact = [of_a / (of_a + of_c), of_c / (of_a + of_c)];
        let text = format!(
            "model = \"expression\"\noutputs.y = \"{wave}(2*a) + 1.5*c\"\n[factors]\n\
             a = {{ distribution = \"normal\", mean = 0, sd = 1 }}\nc = {{ min = 0, max = 1 }}\n"
        );
        let (mut held, mut all, mut squares) = (0, 0, 0.0);
        for seed in 0..5 {
            let result = study(&text, &["design.base_samples=256", &format!("design.seed={seed}")]).run().unwrap();
            let output = &result.outputs[0];
            assert!(output.surrogate.is_some());
            for (factor, exact) in effects(output).iter().zip(exact) {
                for estimate in [factor.first_order, factor.total] {
                    let interval = estimate.interval.unwrap();
                    held += usize::from(interval.low <= exact && exact <= interval.high);
                    all += 1;
                    squares += (estimate.estimate - exact).powi(2);
                }
            }
        }
        // Without the terms of the polynomials for the tails: 30 and 45 of 80 (20 seeds), and errors of 0.08.
        assert!(held >= all * 3 / 4, "{wave}: {held} of {all}");
        let error = (squares / all as f64).sqrt();
        assert!(error < 0.005, "{wave}: {error}");
    }
}

/// Polynomials also have values where the model fails and has none.
#[test]
fn outputs_with_failed_runs_are_not_corrected_unless_asked() {
    let text = "model = \"expression\"\noutputs.y = \"x1 + 2*x2 + 10*x1*x2 + 0*sqrt(0.3 - x1*x2)\"\noutputs.z = \"x1*x2\"\n\
                [factors]\nx1 = { min = 0, max = 1 }\nx2 = { min = 0, max = 1 }\n\
                [design]\nbase_samples = 1024\n[analysis]\nmax_failed = 0.9\n";
    let result = study(text, &[]).run().unwrap();
    let [y, z] = ["y", "z"].map(|name| result.output(name).unwrap());
    assert!(y.surrogate.is_none() && z.surrogate.is_some());
    // By quadrature over x1 x2 < 0.3: the others lie in the part of the space where both runs of a pair succeed.
    let total = effects(y)[1].total;
    let interval = total.interval.unwrap();
    assert!(interval.low < 0.83 && 0.83 < interval.high + 0.03 && interval.high - interval.low > 0.02, "{total:?}");
    let file = study(text, &[ON]).run().unwrap();
    assert!(file.outputs[0].surrogate.is_some());
}
