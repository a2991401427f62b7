//! Formulas as models, through the program and the library.

use std::path::Path;

use crate::common::{Folder, analysed, apportion, gap, numbers, stderr, study_path, succeed};
use crate::messages::messages;

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

#[test]
fn faults_are_named_with_line_and_column() {
    let formula = "\"sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)\"";
    let empty = "model = \"expression\"\n[[factor]]\nname = \"x\"\nmin = 0\nmax = 1\n";
    let changes = [
        ("sin(x2)", "sin(x4)", "3:22"),
        ("sin(x2)", "sine(x2)", "3:18"),
        ("sin(x2)", "sin(x2, 1)", "3:18"),
        ("x3^4", "x3^", "3:35"),
        (formula, "{ formula = \"1 + sine(x1)\", unit = \"nN\" }", "3:22"),
        (formula, "{ formula = \"x1\", unit = \"parsec\" }", "3:5"),
        (formula, "{ formula = \"x1\", units = \"N\" }", "3:5"),
        (formula, "3", "3:5"),
        ("constants.a = 7\n", "", "3:16"),
        ("constants.a = 7", "constants.a = \"7 parsecs\"", "5:15"),
        ("constants.a = 7", "constants.a = [7]", "5:15"),
        ("constants.a", "constants.x1", "5:11"),
        ("constants.a", "constants.sin", "5:11"),
        ("name = \"x3\"", "name = \"x 3\"", "18:8"),
        ("name = \"x3\"", "name = \"x1\"", "3:32"),
        ("[outputs]", "[afm]\n[outputs]", "2:1"),
        ("model = \"expression\"", "model = \"ishigami\"", "4:1"),
        ("constants.a = 7", "constant.a = 7", "5:1"),
        ("y = \"sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)\"\n", "", "2:1"),
        (ISHIGAMI, empty, "1:1"),
    ];
    messages!().spoilt(&Folder::new(), ISHIGAMI, &changes);
}

#[test]
fn unused_factors_and_constants_are_noted() {
    let study =
        apportion_files::parse_study(&ISHIGAMI.replace("b*x3^4*sin(x1)", "1"), Path::new("s.toml"), &[]).unwrap();
    messages!().add("without x3 and b", &study.notes().join("\n"));
}

#[test]
fn the_language_is_shown() {
    messages!().add("models expression", &succeed(&["models", "expression"]));
}
