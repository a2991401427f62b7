//! Units of factors and outputs, through the binary: the inputs of a model, and the printed values.

use std::path::Path;

use apportion::result::read_result;
use apportion_report::screening::ScreeningFile;

use crate::common::{Folder, apportion, stderr, stdout, succeed, text};
use crate::messages::messages;

/// A program of one temperature in degC and one time in h, which answers in its own units.
const PROGRAM: &str = "import sys\nsys.stdin.readline()\nfor line in sys.stdin:\n    n, *x = [float(c) for c in line.split(',')]\n    \
                       print(f'{n},{x[0]!r},{x[0] * x[1]!r},{x[1]!r}', flush=True)\n";

const STUDY: &str = r#"
model = "command"
command = ["python3", "model.py"]
[design]
base_samples = 64
[outputs]
heat = "degC"
cost = "EUR/kWh"
time = "h"
[factors.temperature]
min = 20.1
max = 30
unit = "degC"
[factors.duration]
distribution = "normal"
mean = 2
sd = 0.25
unit = "h"
"#;

#[test]
fn a_program_works_in_the_units_of_its_study() {
    let folder = Folder::new();
    folder.with("model.py", PROGRAM);
    let study = folder.with("study.toml", STUDY);
    let printed = succeed(&["run", text(&study), "--out", text(&folder.path("out"))]);
    assert!(printed.contains("heat (°C)") && printed.contains("cost (EUR/kWh)"), "{printed}");
    let result = read_result(&folder.path("out/study.json")).unwrap();
    let units: Vec<&str> = result.outputs.iter().map(|output| output.unit.as_str()).collect();
    assert_eq!(units, ["degC", "EUR/kWh", "h"]);
    let heat = &result.outputs[0];
    // A uniform variable: mean 25.05 in degC, variance (9.9^2)/12 without the zero of the unit; 256 base points.
    assert!((heat.mean.unwrap() - 25.05).abs() < 0.02, "{:?}", heat.mean);
    assert!((heat.variance.unwrap() / (9.9f64.powi(2) / 12.0) - 1.0).abs() < 0.02, "{:?}", heat.variance);
    let (low, high) = heat.variance_interval.map(|interval| (interval.low, interval.high)).unwrap();
    assert!(0.0 < low && low < high && high < 20.0, "{low} {high}");
    let sample = heat.distribution.as_ref().unwrap();
    assert!((sample.sd.unwrap() - 9.9 / 12f64.sqrt()).abs() < 0.05, "{:?}", sample.sd);
    assert!(20.1 <= sample.min && sample.max <= 30.0, "{} {}", sample.min, sample.max);
    let histogram = sample.histogram.as_ref().unwrap();
    assert_eq!(histogram.counts.iter().sum::<u64>(), sample.count);
    let scatter = heat.scatter.as_ref().unwrap();
    assert!(scatter.points.iter().all(|point| point.iter().all(|x| x.abs() < 40.0)), "in degC and h");
    let time = &result.outputs[2];
    assert!((time.mean.unwrap() - 2.0).abs() < 0.01 && (time.variance.unwrap().sqrt() - 0.25).abs() < 0.02);
    let factor = &result.factors[0];
    assert_eq!((factor.unit.as_str(), factor.nominal), ("degC", 25.05));
    // The result is read again, labels and all, and compared with itself.
    let json = folder.path("out/study.json");
    succeed(&["report", text(&json), "--out", text(&folder.path("again"))]);
    let compared = succeed(&["compare", text(&json), text(&json), "--out", text(&folder.path("compared"))]);
    assert!(compared.contains("heat"), "{compared}");
}

#[test]
fn sweeps_and_screenings_are_in_the_declared_units() {
    let folder = Folder::new();
    let study = folder.with(
        "s.toml",
        "model = \"expression\"\noutputs.t = { formula = \"T + 0*k\", unit = \"degC\" }\n[factors.T]\nmin = 50\n\
         max = 68\nunit = \"degF\"\n[factors.k]\nmin = 1\nmax = 2\n",
    );
    let out = folder.path("sweep");
    succeed(&["sweep", text(&study), "--factor", "T", "--points", "3", "--out", text(&out)]);
    let csv = std::fs::read_to_string(out.join("s-sweep.csv")).unwrap();
    for line in ["T,degF,50,", "T,degF,59,", "T,degF,68,"] {
        assert!(csv.contains(line), "no {line} in\n{csv}");
    }
    let heat = |fahrenheit: &str| -> f64 {
        let line = csv.lines().find(|line| line.starts_with(&format!("T,degF,{fahrenheit},"))).unwrap();
        line.split(',').nth(5).unwrap().parse().unwrap()
    };
    // Rounded in kelvin.
    assert!((heat("50") - 10.0).abs() < 1e-12 && (heat("68") - 20.0).abs() < 1e-12, "{csv}");
    // 1 % of a temperature in degC is nothing.
    let json = std::fs::read_to_string(out.join("s-sweep.json")).unwrap();
    assert!(json.contains("\"percent\": null"), "{json}");
    succeed(&["screen", text(&study), "--trajectories", "8", "--out", text(&folder.path("screen"))]);
    let screening = std::fs::read_to_string(folder.path("screen/s-screen.json")).unwrap();
    let screening: ScreeningFile = serde_json::from_str(&screening).unwrap();
    // The full range: 18 degF are 10 degC, without the zero of either.
    assert!((screening.outputs[0].factors[0].mu_star.unwrap().estimate - 10.0).abs() < 1e-9);
    // The bounds in a file of points are the typed numbers.
    let points = folder.with("points.csv", "T,k\n68,1\n50.5,1\n");
    succeed(&["evaluate", text(&study), text(&points), "-o", text(&folder.path("answers.csv"))]);
    let answers = std::fs::read_to_string(folder.path("answers.csv")).unwrap();
    let answer: f64 = answers.lines().nth(1).unwrap().rsplit(',').next().unwrap().parse().unwrap();
    assert!((answer - 20.0).abs() < 1e-12, "{answers}");
}

#[test]
fn spans_have_no_zero_and_ratios_are_refused_in_degrees() {
    let study = |keys: &str| {
        let text = format!("model = \"expression\"\noutputs.y = \"T\"\n[factors.T]\nunit = \"degC\"\n{keys}\n");
        apportion_files::parse_study(&text, Path::new("s.toml"), &[])
    };
    for keys in [
        "distribution = \"normal\"\nmean = 20\nsd = 2",
        "distribution = \"truncated-normal\"\nmean = 20\nsd = 2\nmin = 14\nmax = 26",
        "distribution = \"normal\"\np05 = 16.71\np95 = 23.29",
        "distribution = \"weibull\"\nshape = 2\nscale = 4.317\nlocation = 16.174",
        "distribution = \"gumbel\"\nlocation = 19.1\nscale = 1.559",
        "distribution = \"beta\"\nalpha = 2\nbeta = 2\nmin = 15.528\nmax = 24.472",
        "distribution = \"triangular\"\nmin = 15.1\nmode = 20\nmax = 24.9",
        "distribution = \"discrete\"\nvalues = [18, 22]",
        "min = 16.536\nmax = 23.464",
    ] {
        let study = study(keys).unwrap_or_else(|error| panic!("{error}"));
        let mut si = vec![0.0; 4096];
        let u: Vec<f64> = (0..4096).map(|k| (f64::from(k) + 0.5) / 4096.0).collect();
        study.space().factors()[0].fill_si(&u, &mut si);
        let mean = si.iter().sum::<f64>() / 4096.0;
        let sd = (si.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 4096.0).sqrt();
        // All of them have mean 20 degC and, to what is typed, sd 2 degC.
        assert!((mean - 293.15).abs() < 0.02 && (sd - 2.0).abs() < 0.05, "{keys}: {mean} {sd}");
    }
    let mut messages = messages!();
    for keys in ["distribution = \"log-normal\"\nmean = 20\nsd = 2", "distribution = \"log-uniform\"\nmin = 1\nmax = 2"]
    {
        messages.add(keys, &study(keys).unwrap_err().to_string());
    }
}

#[test]
fn labels_of_outputs_are_any_short_text() {
    let folder = Folder::new();
    let study = |unit: &str| {
        let text = format!("model = \"external\"\noutputs.y = {unit}\n[factors.x]\nmin = 0\nmax = 1\n");
        let path = folder.with("s.toml", text);
        apportion(&["check", text_of(&path)])
    };
    fn text_of(path: &Path) -> &str {
        text(path)
    }
    for unit in
        ["\"kWh\"", "\"degC\"", "\"h\"", "\"psi\"", "\"USD\"", "\"m\u{b3} H\u{2082}O\"", "\"\"", "\"a / b / c d\""]
    {
        let output = study(unit);
        assert_eq!(output.status.code(), Some(0), "{unit}: {}{}", stdout(&output), stderr(&output));
    }
    let mut messages = messages!();
    for unit in ["\"a\\u0000b\"".to_owned(), "\"a\\u202eb\"".to_owned(), format!("\"{}\"", "x".repeat(61))] {
        let output = study(&unit);
        messages.ended(&unit, 2, &output);
        assert!(stderr(&output).contains("s.toml:2:13:"), "{}", stderr(&output));
    }
    // Other units of one kind convert when results are compared; labels do not.
    let result = |unit: &str, folder: &Folder| {
        let study = format!(
            "model = \"command\"\ncommand = [\"python3\", \"m.py\"]\noutputs.y = \"{unit}\"\n[factors.x]\nmin = 20\nmax = 30\n[design]\nbase_samples = 64\n"
        );
        folder.with(
            "m.py",
            "import sys\nsys.stdin.readline()\nfor line in sys.stdin:\n    print(line.strip(), flush=True)\n",
        );
        let path = folder.with("s.toml", study);
        let out = folder.path(&unit.replace('/', "_"));
        succeed(&["run", text(&path), "--out", text(&out)]);
        out.join("s.json")
    };
    let (celsius, kelvin, label) = (result("degC", &folder), result("K", &folder), result("EUR", &folder));
    let out = folder.path("compared");
    succeed(&["compare", text(&celsius), text(&kelvin), "--out", text(&out)]);
    let json = std::fs::read_to_string(
        std::fs::read_dir(&out)
            .unwrap()
            .map(|e| e.unwrap().path())
            .find(|p| p.extension().is_some_and(|e| e == "json"))
            .unwrap(),
    )
    .unwrap();
    let compared: serde_json::Value = serde_json::from_str(&json).unwrap();
    let output = &compared["outputs"][0];
    // 25 degC and 25 K, which is -248.15 degC, and one spread.
    assert!((output["mean"][0].as_f64().unwrap() - 25.0).abs() < 0.05, "{output}");
    assert!((output["mean"][1].as_f64().unwrap() + 248.15).abs() < 0.05, "{output}");
    let sd = |side: usize| output["sd"][side].as_f64().unwrap();
    assert!((sd(0) - sd(1)).abs() < 1e-9, "{output}");
    let refused = apportion(&["compare", text(&celsius), text(&label), "--out", text(&folder.path("none"))]);
    assert_ne!(refused.status.code(), Some(0), "{}", stdout(&refused));
}
