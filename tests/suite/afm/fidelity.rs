//! Cheaper models and runs with `accuracy`: correct, unbiased, reproducible to the bit, and refused with reasons.

use std::path::Path;

use apportion::result::{Warning, read_result};
use apportion::run::Store;
use apportion::{Distribution, Study, Target, function_model};

use crate::common::{Folder, apportion, effects, stderr, study_path, succeed, text};
use crate::messages::messages;

/// Ishigami's function with a = 5 and the cheaper one of Qian et al. (2018), section 4.1.
const PAIR: &str = "model = \"expression\"\n[outputs]\ny = \"sin(x1) + 5*sin(x2)^2 + 0.1*x3^4*sin(x1)\"\n\
    [[factor]]\nname = \"x1\"\nmin = -3.141592653589793\nmax = 3.141592653589793\n\
    [[factor]]\nname = \"x2\"\nmin = -3.141592653589793\nmax = 3.141592653589793\n\
    [[factor]]\nname = \"x3\"\nmin = -3.141592653589793\nmax = 3.141592653589793\n\
    [fidelity]\nlow = [{ name = \"coarse\", outputs = { y = \"sin(x1) + 3*sin(x2)^2 + 0.9*x3^2*sin(x1)\" } }]\n\
    base_samples = 1024\n[design]\nbase_samples = 64\n";

fn study(text: &str, more: &[&str]) -> Study {
    let overrides: Vec<String> = more.iter().map(|text| (*text).to_owned()).collect();
    apportion_files::parse_study(text, Path::new("fidelity.toml"), &overrides).unwrap()
}

/// First-order and total indices of the first output.
fn numbers(study: &Study, threads: usize) -> Vec<f64> {
    let result = study.runner().threads(threads).run().unwrap();
    effects(&result.outputs[0]).iter().flat_map(|f| [f.first_order.estimate, f.total.estimate]).collect()
}

#[test]
fn a_cheaper_step_model_removes_most_of_the_error_without_bias() {
    // Products of steps, plain: V_i = (2/3) c^2/(1 + c)^2 of 1 + c floor(3 x).
    let c = [0.8, 0.5, 0.3];
    let product =
        |c: [f64; 3]| (0..3).map(|i| format!("(1 + {}*floor(3*x{}))", c[i], i + 1)).collect::<Vec<_>>().join("*");
    let factors: String = (1..=3).map(|i| format!("[[factor]]\nname = \"x{i}\"\nmin = 0\nmax = 1\n")).collect();
    let base = format!("model = \"expression\"\n[outputs]\ny = \"{}\"\n{factors}", product(c));
    let low = format!(
        "[fidelity]\nlow = [{{ name = \"low\", outputs = {{ y = \"{}\" }} }}]\nbase_samples = 4096\n",
        product([0.75, 0.55, 0.3])
    );
    let parts: Vec<f64> = c.iter().map(|c: &f64| (2.0 / 3.0) * c * c / (1.0 + c).powi(2)).collect();
    let variance: f64 = parts.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
    let exact: Vec<f64> =
        parts.iter().flat_map(|v| [v / variance, v / (1.0 + v) * (variance + 1.0) / variance]).collect();
    const SEEDS: usize = 8;
    let errors = |text: &str| -> Vec<Vec<f64>> {
        let of_seed = |seed: usize| {
            let found = numbers(&study(text, &[&format!("design.seed={seed}"), "design.base_samples=64"]), 1);
            found.iter().zip(&exact).map(|(found, exact)| found - exact).collect()
        };
        (0..SEEDS).map(of_seed).collect()
    };
    let square = |errors: &[Vec<f64>]| errors.iter().flatten().map(|e| e * e).sum::<f64>();
    let plain = "[analysis]\nsurrogate = \"off\"\n";
    let (with, without) = (errors(&format!("{base}{low}")), errors(&format!("{base}{plain}")));
    assert!(10.0 * square(&with) < square(&without), "{} {}", square(&with), square(&without));
    for place in 0..exact.len() {
        let column: Vec<f64> = with.iter().map(|errors| errors[place]).collect();
        let mean = column.iter().sum::<f64>() / SEEDS as f64;
        let sd = (column.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / (SEEDS - 1) as f64).sqrt();
        // One in 30,000 indices has its mean further away.
        assert!(mean.abs() < 4.5 * sd / (SEEDS as f64).sqrt(), "index {place}: {mean} {sd}");
    }
}

#[test]
fn intervals_contain_the_exact_values_and_bits_do_not_depend_on_threads() {
    let (a, b, pi) = (5.0, 0.1, std::f64::consts::PI);
    let v1 = 0.5 * (1.0 + b * pi.powi(4) / 5.0_f64).powi(2);
    let (v2, v13) = (a * a / 8.0, b * b * pi.powi(8) * (1.0 / 18.0 - 1.0 / 50.0));
    let v = v1 + v2 + v13;
    let exact = [v1 / v, (v1 + v13) / v, v2 / v, v2 / v, 0.0, v13 / v];
    let study = study(PAIR, &[]);
    let (one, two) = (numbers(&study, 1), numbers(&study, 2));
    assert_eq!(one, two);
    for (found, exact) in one.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-4, "{one:?}");
    }
    let result = study.run().unwrap();
    let used = result.outputs[0].surrogate.clone().unwrap();
    let json = result;
    assert_eq!(json.low_fidelity.len(), 1);
    assert_eq!((json.low_fidelity[0].shared_runs, json.low_fidelity[0].own_runs), (64 * 5, 1024 * 5));
    assert!(used.corrects_total && used.gain_total.unwrap() > 100.0, "{used:?}");
}

#[test]
fn a_cheaper_model_equal_to_the_model_explains_all_variance() {
    let model = || function_model("y", |x| (3.0 * x[0]).floor() * (1.0 + x[1]) + f64::from(u8::from(x[1] > 0.37)));
    let builder = |low: bool| {
        let builder = Study::builder("same", model())
            .factor("a", Distribution::uniform(0.0, 1.0).unwrap())
            .factor("b", Distribution::uniform(0.0, 1.0).unwrap())
            .base_samples(if low { 16 } else { 1 << 14 });
        if low { builder.low_fidelity("the same", model(), Some(1 << 14)) } else { builder }.build().unwrap()
    };
    // The cheaper model has other points, with other errors.
    for (found, other) in numbers(&builder(true), 1).iter().zip(numbers(&builder(false), 1)) {
        assert!((found - other).abs() < 2e-3, "{found} {other}");
    }
    let result = builder(true).run().unwrap();
    let used = result.outputs[0].surrogate.clone().unwrap();
    assert!(used.low.as_ref().is_some_and(|low| (low.slope - 1.0).abs() < 1e-9 && low.explained > 1.0 - 1e-9));
}

#[test]
fn rows_on_which_the_cheaper_model_fails_are_left_out() {
    let low = "sin(x1) + 3*sin(x2)^2 + 0.9*x3^2*sin(x1) + 0*sqrt(x3 + 3.1)";
    let text = PAIR.replace("sin(x1) + 3*sin(x2)^2 + 0.9*x3^2*sin(x1)", low);
    let result = study(&text, &[]).run().unwrap();
    let total = effects(&result.outputs[0])[1].total;
    assert!((total.estimate - 0.29).abs() < 0.02, "{total:?}");
}

#[test]
fn an_accuracy_is_kept_and_its_lines_make_the_same_run_again() {
    let folder = Folder::new();
    let study = study_path("lugre-environmental");
    let out = folder.path("out");
    let run = |more: &[&str], out: &Path| {
        let arguments = ["run", text(&study), "--set", "afm.fidelity=dynamic", "--charts", "none", "--out", text(out)];
        succeed(&[&arguments[..], more].concat());
        read_result(&out.join("lugre-environmental.json")).unwrap()
    };
    let first = run(&["--accuracy", "0.01"], &out);
    let spending = first.spending.clone().unwrap();
    assert_eq!((spending.accuracy, first.stopping.as_ref().unwrap().target_met), (0.01, Some(true)));
    for index in first.outputs[0].indices.as_ref().unwrap() {
        let of = &index.effect.first_order;
        assert!(of.interval.unwrap().high - of.interval.unwrap().low <= 0.02, "{index:?}");
    }
    let mut lines: Vec<String> = Vec::new();
    let mut table = "";
    for line in apportion_report::lines_to_repeat(&first).unwrap().lines() {
        match line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            Some(name) => table = name,
            None => lines.extend(["--set".to_owned(), format!("{table}.{}", line.replace(' ', ""))]),
        }
    }
    let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
    let again = run(&lines, &folder.path("again"));
    assert_eq!(first.outputs[0].indices, again.outputs[0].indices);
}

#[test]
fn an_interrupted_run_with_accuracy_of_a_program_resumes() {
    let folder = Folder::new();
    let program = folder.with(
        "wing.py",
        "import sys\nnext(sys.stdin)\nfor line in sys.stdin:\n    n, a, b, c = (float(x) for x in line.split(','))\n    \
         print(n, a * a + b * c + 1, sep=',', flush=True)\n",
    );
    let file = folder.with(
        "wing.toml",
        format!(
            "model = \"command\"\ncommand = [\"python3\", {:?}]\noutputs.y = \"1\"\naccuracy = 0.001\n[[factor]]\nname = \"a\"\n\
             min = 0\nmax = 1\n[[factor]]\nname = \"b\"\nmin = 0\nmax = 1\n[[factor]]\nname = \"c\"\nmin = 0\nmax = 1\n",
            text(&program)
        ),
    );
    let out = folder.path("out");
    let run = || {
        let said = apportion(&["run", text(&file), "--charts", "none", "--out", text(&out)]);
        assert_eq!(said.status.code(), Some(0), "{}", stderr(&said));
        (read_result(&out.join("wing.json")).unwrap(), stderr(&said))
    };
    let (first, _) = run();
    let (second, _) = run();
    assert_eq!(first.outputs[0].indices, second.outputs[0].indices);
    let spending = first.spending.unwrap();
    assert!(spending.runs <= 100, "{spending:?}");
    assert!(out.join("wing.journal").is_file());
    // a^2 has variance 4/45, b c 7/144.
    let (own, pair) = (4.0 / 45.0, 7.0 / 144.0);
    let found = first.outputs[0].indices.as_ref().unwrap()[0].effect.total.estimate;
    assert!((found - own / (own + pair)).abs() < 0.001, "{found}");
}

#[test]
fn quick_models_are_doubled_without_surrogates() {
    let product = function_model("y", |x| x[0] * x[1]);
    let study = Study::builder("product", product)
        .factor("a", Distribution::uniform(1.0, 2.0).unwrap())
        .factor("b", Distribution::uniform(1.0, 5.0).unwrap())
        .until(Target::accuracy(0.002))
        .build()
        .unwrap();
    let result = study.run().unwrap();
    let spending = result.spending.as_ref().unwrap();
    assert!(result.stopping.as_ref().unwrap().target_met == Some(true) && spending.runs >= 3000);
    let total = result.output("y").unwrap().factor("a").unwrap().total;
    assert!((total.estimate - (27.0 + 4.0) / 139.0).abs() < 0.002, "{total:?}");
}

#[test]
fn invalid_settings_are_refused_with_the_reason() {
    let (folder, mut messages) = (Folder::new(), messages!());
    let ishigami = "model = \"ishigami\"\n";
    for study in [
        &format!("accuracy = -1\n{ishigami}")[..],
        &format!("accuracy = 0.1\n{ishigami}[design]\nbase_samples = 64\n"),
        &format!("accuracy = 0.1\n{ishigami}[design]\nsampler = \"latin-hypercube\"\n"),
        &format!("{ishigami}[fidelity]\nlow = [\"coarse\"]\n"),
        "afm.fidelity = \"dynamic\"\n[fidelity]\nlow = [\"closed\"]\n[factors.length]\nmin = 200\nmax = 700\nunit = \"um\"\n",
    ] {
        messages.refused_as(study, &["check", text(&folder.with("refused.toml", study))]);
    }
    let changes = [
        ("{ y = \"sin(x1) + 3", "{ z = \"sin(x1) + 3", "17:7"),
        ("name = \"coarse\", ", "", "17:8"),
        ("name = \"coarse\"", "name = \"\"", "17:8"),
        ("3*sin(x2)^2 +", "3*sin(x2^2 +", "17:8"),
    ];
    messages.spoilt(&folder, PAIR, &changes);
}

#[test]
fn one_way_to_size_a_run_takes_the_place_of_another() {
    let path = study_path("ishigami");
    let loaded = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
        apportion_files::load_study(&path, &overrides).unwrap()
    };
    assert!(loaded(&["accuracy=0.01"]).target().accuracy.is_some());
    assert_eq!(loaded(&["accuracy=0.01", "design.base_samples=64"]).target(), Target::default());
    let plain = loaded(&["design.runs=203"]);
    assert!(plain.design().is_plain() && plain.design().rows() == 200);
}

#[test]
fn the_physics_gives_the_same_bits_row_by_row() {
    for fidelity in ["closed-form", "quasi-static"] {
        let changes = [format!("afm.fidelity=\"{fidelity}\""), "design.base_samples=64".to_owned()];
        let study = apportion_files::load_study(&study_path("lugre-general"), &changes).unwrap();
        let plain = study.runner().threads(1).run().unwrap();
        let store = Store::new(study.model().as_ref());
        let stored = study.runner().threads(2).store(&store).run().unwrap();
        assert!(stored.outputs == plain.outputs, "{fidelity}");
    }
}

/// Products of steps, and a cheaper model that is the same but for a spike in a thousandth of the space.
#[test]
fn a_cheaper_model_with_a_spike_that_no_shared_row_met_is_not_used() {
    let product = "(1 + 0.8*floor(3*a))*(1 + 0.5*floor(3*b))";
    let text = format!(
        "model = \"expression\"\n[outputs]\ny = \"{product}\"\n[factors]\na = {{ min = 0, max = 1 }}\nb = {{ min = 0, max = 1 }}\n\
         [fidelity]\nlow = [{{ name = \"low\", outputs = {{ y = \"{product} + 20*(a > 0.97)*(b > 0.97)\" }} }}]\n\
         base_samples = 4096\n[design]\nbase_samples = 32\n"
    );
    // V_i = (2/3) c^2/(1 + c)^2.
    let [a, b] = [0.8, 0.5].map(|c: f64| (2.0 / 3.0) * c * c / (1.0 + c).powi(2));
    let variance = (1.0 + a) * (1.0 + b) - 1.0;
    let (mut refused, mut held) = (0, 0);
    for seed in 0..12 {
        let output = study(&text, &[&format!("design.seed={seed}")]).run().unwrap().outputs.remove(0);
        let unmet = output.warnings.iter().filter(|warning| matches!(warning, Warning::UnmetLowFidelity { .. }));
        let low = output.surrogate.as_ref().and_then(|used| used.low.as_ref());
        assert!(unmet.clone().count() == 0 || low.is_none(), "{:?}", output.warnings);
        refused += unmet.count();
        for (factor, exact) in effects(&output).iter().zip([a / variance, b / variance]) {
            let interval = factor.first_order.interval.unwrap();
            held += usize::from(interval.low <= exact && exact <= interval.high);
        }
    }
    assert!(refused >= 8 && held >= 22, "{refused} refused, {held} of 24 held");
}
