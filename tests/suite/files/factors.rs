//! Factors in the forms that users have, through the program: named statistics, whole numbers, categories, measured values.

use std::path::PathBuf;

use serde_json::Value;

use crate::common::{FAMILIES, Folder, apportion, stderr, succeed, text};
use crate::messages::messages;

/// A study with a factor of every kind; its model returns its inputs.
const STUDY: &str = r#"model = "expression"
[outputs]
y = "d + n + wet + 10*material + r"
[design]
base_samples = 256
replicates = 4
[[factor]]
name = "d"
distribution = "triangular"
mode = 3
p05 = 1
p95 = 5
[[factor]]
name = "n"
distribution = "integer"
min = 1
max = 6
[[factor]]
name = "wet"
distribution = "boolean"
probability = 0.25
[[factor]]
name = "material"
distribution = "categorical"
labels = ["steel", "brass", "soft, pure copper"]
weights = [5, 2, 1]
[[factor]]
name = "r"
distribution = "empirical"
file = "measured.csv"
column = "radius"
"#;

const MEASURED: &str = "\u{feff}run, radius\r\n1, 52\r\n2, 48\r\n\r\n3, 49\r\n4, 51";

fn studied() -> (Folder, PathBuf) {
    let folder = Folder::new();
    folder.with("measured.csv", MEASURED);
    let study = folder.with("study.toml", STUDY);
    (folder, study)
}

/// The cells of the line of check's table that begins with `factor`.
fn line(table: &str, factor: &str) -> Vec<String> {
    let lines = table.lines().map(|line| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>());
    lines.into_iter().find(|cells| cells.first().is_some_and(|cell| cell == factor)).unwrap_or_default()
}

#[test]
fn check_prints_what_is_implied() {
    let (_folder, study) = studied();
    let table = succeed(&["check", text(&study)]);
    // Mean, sd, 5 %, median, 95 %, nominal.
    assert_eq!(line(&table, "n")[..8], ["n", "integer", "3.5", "1.70783", "1", "4", "6", "4"]);
    assert_eq!(line(&table, "wet")[..8], ["wet", "boolean", "0.25", "0.433013", "false", "false", "true", "false"]);
    let material = ["material", "categorical", "-", "-", "steel", "steel", "soft,"];
    assert_eq!(line(&table, "material")[..7], material);
    assert_eq!(line(&table, "r")[..8], ["r", "empirical", "50", "1.58114", "48", "51", "52", "51"]);
    let d = line(&table, "d");
    assert_eq!((d[4].as_str(), d[5].as_str(), d[6].as_str()), ("1", "3", "5"));
    assert!(table.contains("material: steel 62.5 %, brass 25 %, soft, pure copper 12.5 %"), "{table}");
    assert!(table.contains("mode = 3, max = "), "{table}");
}

#[test]
fn labels_are_kept_in_results_points_and_sweeps() {
    let (folder, study) = studied();
    let out = folder.path("out");
    succeed(&["run", text(&study), "--out", text(&out)]);
    let result: Value = serde_json::from_str(&std::fs::read_to_string(out.join("study.json")).unwrap()).unwrap();
    let factors = &result["factors"];
    assert_eq!(factors[3]["distribution"]["labels"][2], "soft, pure copper");
    assert_eq!(factors[4]["distribution"]["file"], "measured.csv");
    assert_eq!(factors[4]["distribution"]["sha256"].as_str().unwrap().len(), 64);

    // Points by label, or by the number of one.
    let points = folder.with("points.csv", "material,d,wet\nbrass,0,true\n\"soft, pure copper\",0,false\n0,0,0\n");
    let values = folder.path("values.csv");
    succeed(&["evaluate", text(&study), text(&points), "-o", text(&values)]);
    // n and r are left out: they are 4 and 51.
    assert_eq!(std::fs::read_to_string(&values).unwrap(), "y\n66.0\n75.0\n55.0\n");

    succeed(&["sweep", text(&study), "--factor", "material", "--out", text(&out)]);
    let csv = std::fs::read_to_string(out.join("study-sweep.csv")).unwrap();
    assert!(csv.contains("material,1,steel,y,") && csv.contains("material,1,brass,y,"), "{csv}");
    let json = std::fs::read_to_string(out.join("study-sweep.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["sweeps"][0]["labels"][1], "brass");
    let chart = std::fs::read_to_string(out.join("charts/study-sweep-material.svg")).unwrap();
    for label in ["steel", "brass", "soft, pure copper"] {
        assert!(chart.contains(&format!(">{label}<")), "{label}");
    }
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    let (scatter, ranges) = (read("charts/study-scatter.svg"), read("charts/study-sweep-ranges.svg"));
    for label in ["steel", "brass", "false", "true"] {
        assert!(scatter.contains(&format!(">{label}<")), "{label}");
    }
    assert!(ranges.contains("steel, brass, soft, pure copper") && !ranges.contains("its low end<"), "{ranges}");
    // Whole numbers are swept one by one.
    succeed(&["sweep", text(&study), "--factor", "n", "--out", text(&out)]);
    let csv = std::fs::read_to_string(out.join("study-sweep.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 6, "{csv}");
}

#[test]
fn a_failed_run_names_its_category() {
    let (folder, _) = studied();
    let study = folder.with("fail.toml", STUDY.replace("10*material", "ln(1 - material)"));
    let out = folder.path("out");
    let output = apportion(&["run", text(&study), "--out", text(&out), "--set", "analysis.max_failed=1"]);
    assert!(output.status.code().is_some(), "{}", stderr(&output));
    let result: Value = serde_json::from_str(&std::fs::read_to_string(out.join("fail.json")).unwrap()).unwrap();
    let failures = result["outputs"][0]["failures"].as_array().unwrap();
    let reasons: Vec<&str> = failures.iter().filter_map(|failure| failure["reason"].as_str()).collect();
    messages!().add("the reasons", &reasons.join("\n"));
    let labels: Vec<&Value> = failures.iter().map(|failure| &failure["first_inputs"]["material"]).collect();
    assert!(labels.iter().all(|label| *label == "brass" || *label == "soft, pure copper"), "{labels:?}");
}

#[test]
fn incomplete_parameters_are_refused_with_their_place() {
    let changes = [
        ("p95 = 5\n", "", "8:8"),
        ("p95 = 5", "p95 = 5\nmean = 3", "13:8"),
        ("p95 = 5", "p95 = 0.5", "11:7"),
        ("mode = 3", "mode = 5.5", "10:8"),
        ("p05 = 1", "p06 = 1", "11:1"),
        ("p05 = 1", "log_sd = 1", "11:10"),
        ("min = 1", "min = 1.5", "16:7"),
        ("max = 6", "max = 0", "16:7"),
        ("probability = 0.25", "probability = 25", "21:15"),
        ("probability = 0.25", "values = [0, 1]", "21:10"),
        ("\"brass\"", "\"steel\"", "25:10"),
        ("\"brass\"", "\" \"", "25:10"),
        ("[5, 2, 1]", "[5, 2]", "26:11"),
        ("weights = [5, 2, 1]", "values = [5, 2, 5]", "26:10"),
        ("labels = [\"steel\", \"brass\", \"soft, pure copper\"]\n", "", "23:8"),
        ("weights = [5, 2, 1]", "weights = [5, 2, 1]\nnominal = \"gold\"", "27:11"),
        ("weights = [5, 2, 1]", "weights = [5, 2, 1]\nnominal = 0.5", "27:11"),
        ("max = 6", "max = 6\nnominal = 2.5", "18:11"),
    ];
    messages!().spoilt(&studied().0, STUDY, &changes);
}

#[test]
fn measured_values_are_refused_with_their_line() {
    let mut messages = messages!();
    let changes = [
        ("measured.csv", "measurd.csv", "30:8"),
        ("\"radius\"", "\"radios\"", "31:10"),
        ("column = \"radius\"\n", "", "30:8"),
    ];
    let (folder, study) = studied();
    messages.spoilt(&folder, STUDY, &changes);
    folder.with("study.toml", STUDY);
    for (case, measured, place) in [
        ("no number", &b"radius\n1\n\nnan\n"[..], ": line 4: "),
        ("too few cells", b"radius,b\n1,2\n3\n", ": line 3: "),
        ("a header alone", b"radius\n", ": "),
        ("nothing", b"", ": "),
        ("no UTF-8", b"radius\n\xff\n", ": line 2: "),
    ] {
        folder.with("measured.csv", measured);
        let message = messages.refused_as(case, &["check", text(&study)]);
        assert!(message.contains(&format!("measured.csv{place}")), "not at {place}: {message}");
    }
    // Bare numbers need no header.
    let (folder, _) = studied();
    folder.with("measured.csv", "1\n2\n6\n");
    let bare = folder.with("bare.toml", STUDY.replace("column = \"radius\"\n", ""));
    assert_eq!(line(&succeed(&["check", text(&bare)]), "r")[2], "3");
}

#[test]
fn points_of_no_category_are_refused() {
    let (folder, study) = studied();
    let values = folder.path("values.csv");
    let mut messages = messages!();
    for cell in ["gold", "0.5", "nan"] {
        let points = folder.with("points.csv", format!("d,material\n1,steel\n1,{cell}\n"));
        let output = apportion(&["evaluate", text(&study), text(&points), "-o", text(&values)]);
        messages.ended(cell, 2, &output);
        assert!(stderr(&output).contains("line 3: column 2 (`material`)"), "{}", stderr(&output));
    }
}

/// Indices of a sum are the shares of the variances, which all have closed forms here.
#[test]
fn every_family_has_its_share_of_a_sum() {
    let folder = Folder::new();
    let (study, out) = (folder.with("study.toml", FAMILIES), folder.path("out"));
    let table = succeed(&["check", text(&study)]);
    // The median of 1 + an exponential of mean 1 from 0.5 on; the mean of the half normal distribution.
    assert_eq!(line(&table, "e")[1..6], ["exponential", "1.5", "1", "0.551293", "1.19315"]);
    assert_eq!(line(&table, "n")[1..3], ["truncated-normal", "-0.797885"]);
    assert!(table.contains("truncate = [0.5, inf]") && table.contains("truncate = [1, 4]"), "{table}");
    succeed(&["run", text(&study), "--out", text(&out), "--set", "analysis.surrogate=\"off\""]);
    let result: Value = serde_json::from_str(&std::fs::read_to_string(out.join("study.json")).unwrap()).unwrap();
    // Of a Pareto distribution of shape 1 between 1 and 4: mean 4/3 ln 4, mean square 4/3 * 3.
    let pareto = 4.0 - (4.0 / 3.0 * 4f64.ln()).powi(2);
    // Of bins: mean of the squared deviations and of the widths over 12.
    let quantiles = 0.5 * (1.0 + 1.0) + (1.0 + 9.0) / 24.0;
    let bins = 0.25 * 1.125f64.powi(2) + 0.75 * 0.375f64.powi(2) + (0.25 + 0.75 * 4.0) / 12.0;
    let half_normal = 1.0 - 2.0 / std::f64::consts::PI;
    let variances = [1.0, 1.0, 4.0, 5.0 / 3.0, 1.0, pareto, quantiles, bins, half_normal];
    let total: f64 = variances.iter().sum();
    let indices = result["outputs"][0]["indices"].as_array().expect("a list");
    for (index, variance) in indices.iter().zip(variances) {
        for kind in ["first_order", "total"] {
            let estimate = index[kind]["estimate"].as_f64().expect("a number");
            // The long tails matter at 4096 base samples.
            assert!((estimate - variance / total).abs() < 0.01, "{index} {}", variance / total);
        }
    }
    assert_eq!(result["factors"][1]["distribution"]["truncate"][1], "inf");
    // Swept from end to end, whole numbers one by one.
    succeed(&["sweep", text(&study), "--out", text(&out)]);
    succeed(&["screen", text(&study), "--out", text(&out)]);
    let csv = std::fs::read_to_string(out.join("study-sweep.csv")).unwrap();
    assert!(csv.lines().any(|line| line.starts_with("p,1,3,")), "{csv}");
}

#[test]
fn invalid_parameters_of_families_are_refused_with_their_place() {
    let changes = [
        ("truncate = [-inf, 0]", "truncate = [2, -1]", "42:12"),
        ("truncate = [-inf, 0]", "truncate = [1]", "42:12"),
        ("truncate = [-inf, 0]", "truncate = [50, 60]", "42:12"),
        ("truncate = [-inf, 4]", "", "28:9"),
        ("df = 5", "df = 2", "19:6"),
        ("\"0.5\" = 2", "\"x\" = 2", "33:24"),
        ("\"0.5\" = 2", "0.5 = 2", "33:24"),
        ("\"1\" = 5", "\"0.9\" = 5", "33:13"),
        ("edges = [0, 1, 3]", "edges = [0, 1, 1]", "36:9"),
        ("\"poisson\"", "\"pois\"", "15:16"),
        // The distribution before its keys.
        ("\"poisson\"\nmean = 4", "\"zipf\"\nexponent = 2", "15:16"),
        ("\"poisson\"\nmean = 4", "\"binomial\"\nn = 4.5\np = 0.5", "16:5"),
        // What is constant, and what is negative.
        ("\"poisson\"\nmean = 4", "\"log-normal\"\nmedian = 4\ngsd = 1", "17:7"),
        ("\"poisson\"\nmean = 4", "\"log-normal\"\nlog_mean = 4\nlog_sd = 0", "17:10"),
        ("\"poisson\"\nmean = 4", "\"log-normal\"\nmedian = -4\ngsd = 2", "16:10"),
        ("\"poisson\"\nmean = 4", "\"log-normal\"\np05 = -4\np95 = -2", "16:7"),
        ("truncate = [-inf, 0]", "max = \"g\"", "42:7"),
        ("truncate = [-inf, 0]", "truncate = [0, \"g\"]", "42:16"),
    ];
    messages!().spoilt(&Folder::new(), FAMILIES, &changes);
}

/// Names of one's own for units, and the ways to give a distribution in which people of life-cycle assessment think.
#[test]
fn factors_of_own_models_take_any_unit() {
    let folder = Folder::new();
    let study = folder.with(
        "study.toml",
        "model = 'expression'\noutputs.y = 'price + amount + defects + length'\n[factors]\n\
         price = { min = 1, max = 3, unit = 'EUR/kWh' }\n\
         amount = { distribution = 'log-normal', median = 2, gsd = 1.5, unit = 'kg CO2-eq' }\n\
         defects = { distribution = 'binomial', n = 10, p = 0.25 }\n\
         length = { min = 1, max = 3, unit = 'um' }\n",
    );
    let out = folder.path("out");
    succeed(&["run", text(&study), "--out", text(&out)]);
    let result: Value = serde_json::from_str(&std::fs::read_to_string(out.join("study.json")).unwrap()).unwrap();
    let unit = |factor: usize| result["factors"][factor]["unit"].clone();
    assert_eq!([0, 1, 3].map(unit), ["EUR/kWh", "kg CO2-eq", "um"]);
    let log_sd = result["factors"][1]["distribution"]["log_sd"].as_f64().unwrap();
    assert!((log_sd - 1.5f64.ln()).abs() < 1e-15, "{log_sd}");
    // Variances 1/3, 4 exp(s^2) (exp(s^2) - 1) and 10/4 3/4; the length counts in metres.
    let square = (log_sd * log_sd).exp();
    let parts = [1.0 / 3.0, 4.0 * square * (square - 1.0), 1.875, 0.0];
    for (factor, part) in result["outputs"][0]["indices"].as_array().unwrap().iter().zip(parts) {
        let first = factor["first_order"]["estimate"].as_f64().unwrap();
        assert!((first - part / parts.iter().sum::<f64>()).abs() < 0.02, "{factor}");
    }
    let long = folder.with(
        "long.toml",
        format!(
            "model = 'expression'\noutputs.y = 'x'\n[factors]\nx = {{ min = 0, max = 1, unit = '{}' }}\n",
            "m".repeat(61)
        ),
    );
    messages!().refused(&["check", text(&long)]);
}
