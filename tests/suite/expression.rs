//! Formulas as models, through the program and the library.

use std::path::Path;

use crate::common::{analysed, apportion, gap, numbers, stderr, stdout, study_path};

/// The Ishigami function, as a user would write it.
const ISHIGAMI: &str = r#"model = "expression"
[outputs]
y = "sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)"
[expression]
constants.a = 7
constants.b = 0.1
[design]
base_samples = 4096
[[factor]]
name = "x1"
min = -3.141592653589793
max = 3.141592653589793
[[factor]]
name = "x2"
min = -3.141592653589793
max = 3.141592653589793
[[factor]]
name = "x3"
min = -3.141592653589793
max = 3.141592653589793
"#;

#[test]
fn ishigami_by_formula_is_the_built_in_one() {
    let study = apportion_files::parse_study(ISHIGAMI, Path::new("formula.toml"), &[]).unwrap();
    let by_formula = study.run().unwrap();
    let built_in = analysed("ishigami", &["design.base_samples=4096"]);
    let (first, total) = numbers(&by_formula.outputs[0]);
    let (known_first, known_total) = numbers(&built_in.outputs[0]);
    // The values agree to a few 1e-15; indices are quotients of their sums.
    assert!(gap(&first, &known_first) < 1e-12 && gap(&total, &known_total) < 1e-12);
    assert_eq!(by_formula.study.settings["formulas"]["y"], "sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)");
    assert_eq!(by_formula.study.model, "expression");
}

#[test]
fn formulas_are_in_si_and_their_outputs_in_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.csv");
    std::fs::write(&path, "thickness,width,length,E\n1,40,225,<110>\n2,40,225,<100>\n").unwrap();
    let out = folder.path().join("values.csv");
    let study = study_path("cantilever-formula");
    let arguments = ["evaluate", study.to_str().unwrap(), path.to_str().unwrap(), "-o", out.to_str().unwrap()];
    let output = apportion(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = std::fs::read_to_string(&out).unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    assert!(text.starts_with("stiffness,force\n"), "{text}");
    // E w t^3 / (4 L^3) in N/m, and the force of 10 nm of it in nN.
    let stiffness = |modulus: f64, thickness: f64| modulus * 40e-6 * thickness.powi(3) / (4.0 * 225e-6f64.powi(3));
    for (row, expected) in rows.iter().zip([stiffness(169e9, 1e-6), stiffness(130e9, 2e-6)]) {
        assert!((row[0] / expected - 1.0).abs() < 1e-14 && (row[1] / (10.0 * expected) - 1.0).abs() < 1e-14, "{row:?}");
    }
}

/// Replaces `from` in the study and expects exit code 2 with all of `expected` in the message.
#[track_caller]
fn refused(from: &str, to: &str, expected: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    assert!(ISHIGAMI.contains(from), "{from}");
    std::fs::write(&path, ISHIGAMI.replacen(from, to, 1)).unwrap();
    let output = apportion(&["check", path.to_str().unwrap()]);
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(2), "{message}");
    for part in expected {
        assert!(message.contains(part), "no {part:?} in:\n{message}");
    }
}

#[test]
fn faults_are_named_with_line_and_column() {
    refused("sin(x2)", "sin(x4)", &["study.toml:3:22:", "there is no `x4`: did you mean `x1`?", "x1, x2, x3, a, b"]);
    refused(
        "sin(x2)",
        "sine(x2)",
        &["study.toml:3:18:", "no function `sine`: did you mean `sin`?", "functions: sin, cos"],
    );
    refused("sin(x2)", "sin(x2, 1)", &["study.toml:3:18:", "`sin` takes one argument, not 2"]);
    refused("x3^4", "x3^", &["study.toml:3:35:", "expected a number, a name or `(`, not `*`"]);
    let formula = "\"sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)\"";
    refused(formula, "{ formula = \"1 + sine(x1)\", unit = \"nN\" }", &["study.toml:3:22:", "no function `sine`"]);
    refused(formula, "{ formula = \"x1\", unit = \"parsec\" }", &["study.toml:3:5:", "parsec"]);
    refused(
        formula,
        "{ formula = \"x1\", units = \"N\" }",
        &["study.toml:3:5:", "unknown key `units`: did you mean `unit`?"],
    );
    refused(formula, "3", &["study.toml:3:5:", "`y` must be a formula", "not integer"]);
    refused("constants.a = 7\n", "", &["study.toml:3:16:", "there is no `a`"]);
    refused("constants.a = 7", "constants.a = \"7 parsecs\"", &["study.toml:5:15:", "parsecs"]);
    refused("constants.a = 7", "constants.a = [7]", &["study.toml:5:15:", "a finite number or a quantity"]);
    refused("constants.a", "constants.x1", &["study.toml:5:11:", "`x1` is listed twice"]);
    refused("constants.a", "constants.sin", &["study.toml:5:11:", "not a function or number of the formula language"]);
    refused("name = \"x3\"", "name = \"x 3\"", &["study.toml:18:8:", "formulas use it"]);
    refused("name = \"x3\"", "name = \"x1\"", &["study.toml:3:32:", "there is no `x3`"]);
    refused("[outputs]", "[afm]\n[outputs]", &["study.toml:2:1:", "unknown key `afm`"]);
    refused("model = \"expression\"", "model = \"ishigami\"", &["unknown key `expression`"]);
    refused(
        "constants.a = 7",
        "constant.a = 7",
        &["study.toml:5:1:", "unknown key `constant`: did you mean `constants`?"],
    );
    refused("y = \"sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)\"\n", "", &["study.toml:2:1:", "has no formula"]);
    let empty = "model = \"expression\"\n[[factor]]\nname = \"x\"\nmin = 0\nmax = 1\n";
    refused(ISHIGAMI, empty, &["study.toml:1:1:", "has no formula", "outputs.y = "]);
}

#[test]
fn unused_factors_and_constants_are_noted() {
    let study =
        apportion_files::parse_study(&ISHIGAMI.replace("b*x3^4*sin(x1)", "1"), Path::new("s.toml"), &[]).unwrap();
    assert_eq!(study.notes(), ["factor `x3` is used in no formula", "constant `b` is used in no formula"]);
}

#[test]
fn the_language_is_shown() {
    let output = apportion(&["models", "expression"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("atan2") && stdout(&output).contains("-x^2 is -(x^2)"));
}
