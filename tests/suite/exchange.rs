//! The three steps joined by files, through the program: `sample`, an external model, `analyze`.

use std::path::{Path, PathBuf};

use apportion::result::{StudyResult, read_result};
use apportion_files::exchange::{ColumnKind, Format, ReadOptions, open_table, row_writer};

use crate::common::{apportion, files, gap, numbers, stderr, study_path, succeed, text};

/// A folder with the design of a small study.
pub struct Sampled {
    folder: tempfile::TempDir,
}

impl Sampled {
    fn new(study: &str, design: &str) -> Self {
        let sampled = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(sampled.path("s.toml"), study).unwrap();
        succeed(&["sample", &sampled.name("s.toml"), "-o", &sampled.name(design)]);
        sampled
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn name(&self, name: &str) -> String {
        text(&self.path(name)).to_owned()
    }

    /// `analyze` of `data` in the folder.
    pub fn analyze(&self, data: &str, more: &[&str]) -> std::process::Output {
        let (data, out) = (self.name(data), self.name("out"));
        apportion(&[&["analyze", &data, "--out", &out], more].concat())
    }

    fn result(&self, name: &str) -> StudyResult {
        read_result(&self.path("out").join(format!("{name}.json"))).unwrap()
    }

    #[track_caller]
    pub fn refused(&self, data: &str, more: &[&str], expected: &str) {
        let output = self.analyze(data, more);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "no {expected:?} in {message:?}");
    }

    /// The lines of a CSV file.
    fn lines(&self, name: &str) -> Vec<String> {
        std::fs::read_to_string(self.path(name)).unwrap().lines().map(str::to_owned).collect()
    }

    pub fn write(&self, name: &str, lines: &[String]) {
        std::fs::write(self.path(name), lines.join("\n") + "\n").unwrap();
    }
}

/// An external model of two factors: 2 base points in each of 4 replicates, 4 rows each.
const OUTSIDE: &str = r#"
    model = "external"
    outputs.force = "nN"
    design = { base_samples = 64, seed = 3 }
    factor = [
        { name = "a", min = 1, max = 3, unit = "um" },
        { name = "b", min = -1, max = 1 },
        { name = "probe", distribution = "categorical", labels = ["silicon", "nitride, doped"] },
    ]
"#;

/// The design of [`OUTSIDE`] with force = a + 2 b + 1 for the second probe, as `data.csv`.
pub fn answered() -> Sampled {
    let sampled = Sampled::new(OUTSIDE, "design.csv");
    let mut lines = sampled.lines("design.csv");
    for (row, line) in lines.iter_mut().enumerate() {
        let numbers: Vec<&str> = line.split(',').collect();
        let force = match numbers[0].parse::<f64>() {
            Ok(a) => (a + 2.0 * numbers[1].parse::<f64>().unwrap() + f64::from(u8::from(line.contains("nitride"))))
                .to_string(),
            Err(_) => "force".to_owned(),
        };
        assert_eq!(row == 0, force == "force");
        *line = format!("{line},{force}");
    }
    sampled.write("data.csv", &lines);
    std::fs::copy(sampled.path("design.csv.manifest.json"), sampled.path("data.csv.manifest.json")).unwrap();
    sampled
}

/// Reads all columns of a file of numbers.
fn columns(path: &Path) -> Vec<Vec<f64>> {
    let mut reader = open_table(path, &ReadOptions::default()).unwrap();
    let wanted: Vec<_> = (0..reader.width()).map(|place| (place, ColumnKind::numbers(""))).collect();
    let mut columns = vec![Vec::new(); wanted.len()];
    reader.read(&wanted, usize::MAX >> 8, &mut columns).unwrap();
    columns
}

fn write_columns(path: &Path, names: &[&str], columns: &[Vec<f64>]) {
    let mut bytes = Vec::new();
    let kinds = names.iter().map(|name| ColumnKind::numbers(name)).collect();
    let mut writer = row_writer(Format::from_path(path).unwrap(), &mut bytes, kinds, columns[0].len() as u64).unwrap();
    writer.write(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>()).unwrap();
    writer.finish().unwrap();
    std::fs::write(path, bytes).unwrap();
}

#[test]
fn three_steps_give_the_bits_of_one_run_in_every_format() {
    let study = study_path("ishigami");
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    succeed(&["run", text(&study), "--base-samples", "512", "--no-journal", "--out", text(&at("run"))]);
    let whole = read_result(&at("run").join("ishigami.json")).unwrap();
    succeed(&["sample", text(&study), "--base-samples", "512", "-o", text(&at("design.csv"))]);
    succeed(&["evaluate", text(&study), text(&at("design.csv")), "-o", text(&at("y.csv"))]);
    let (points, y) = (columns(&at("design.csv")), columns(&at("y.csv")));
    for format in Format::ALL {
        let ending = format.name();
        let (design, outputs) = (at(&format!("d.{ending}")), at(&format!("outputs.{ending}")));
        succeed(&["sample", text(&study), "--base-samples", "512", "-o", text(&design)]);
        assert_eq!(columns(&design), points, "{format:?}");
        // Only outputs, then the design with the outputs in it.
        write_columns(&outputs, &["y"], &y);
        let out = at("analyzed");
        succeed(&["analyze", text(&outputs), "--design", text(&design), "--out", text(&out)]);
        assert_eq!(read_result(&out.join("ishigami.json")).unwrap().outputs, whole.outputs, "{format:?}");
        assert_eq!(files(&out), files(&at("run")));
        let names = ["x1", "x2", "x3", "y"];
        write_columns(&design, &names, &[points.clone(), y.clone()].concat());
        succeed(&["analyze", text(&design), "--out", text(&out)]);
        assert_eq!(read_result(&out.join("ishigami.json")).unwrap().outputs, whole.outputs, "{format:?}");
    }
}

#[test]
fn a_model_outside_is_sampled_and_analyzed_but_not_run() {
    let sampled = answered();
    let output = sampled.analyze("data.csv", &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("the points in the file are those of the design"), "{}", stderr(&output));
    let result = sampled.result("s");
    assert_eq!(result.outputs[0].name, "force");
    // The same model, run by the program.
    let formula = "outputs.force = { formula = \"1e-9*(1e6*a + 2*b + probe)\", unit = \"nN\" }";
    let inside = OUTSIDE.replace("outputs.force = \"nN\"", formula).replace("external", "expression");
    std::fs::write(sampled.path("inside.toml"), inside).unwrap();
    succeed(&["run", &sampled.name("inside.toml"), "--out", &sampled.name("out")]);
    let (found, expected) = (numbers(&result.outputs[0]), numbers(&sampled.result("inside").outputs[0]));
    // Values of size 1, rounded once for the file and once in the formula.
    assert!(gap(&found.0, &expected.0) < 1e-13 && gap(&found.1, &expected.1) < 1e-13, "{found:?} {expected:?}");
    for command in ["run", "screen", "evaluate"] {
        let study = sampled.name("s.toml");
        let points: &[&str] = if command == "evaluate" { &["points.csv", "-o", "y.csv"] } else { &[] };
        let output = apportion(&[&[command, &study], points].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("its model runs outside this program"), "{}", stderr(&output));
    }
    assert!(succeed(&["check", &sampled.name("s.toml")]).contains("model runs, outside this program"));
}

#[test]
fn names_and_units_of_outputs_can_be_chosen() {
    let sampled = answered();
    let lines = sampled.lines("data.csv");
    let twice: Vec<String> = lines.iter().map(|line| format!("{line},{}", line.rsplit(',').next().unwrap())).collect();
    let header = "a,b,probe,force,energy".to_owned();
    sampled.write("data.csv", &[&[header], &twice[1..]].concat());
    let output = sampled.analyze("data.csv", &["--outputs", "energy,force", "--units", "energy=nJ"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let found: Vec<(String, String)> =
        sampled.result("s").outputs.iter().map(|o| (o.name.clone(), o.unit.clone())).collect();
    assert_eq!(found, [("energy".to_owned(), "nJ".to_owned()), ("force".to_owned(), "nN".to_owned())]);
    sampled.refused("data.csv", &["--outputs", "energi"], "no column is called `energi`: did you mean `energy`?");
    sampled.refused("data.csv", &["--outputs", "a"], "`a` is a factor, not an output");
    sampled.refused("data.csv", &["--units", "energy=nJ"], "a unit is given for `energy`, which is not an output");
}

#[test]
fn a_file_that_does_not_belong_to_the_design_is_refused_with_the_reason() {
    let sampled = answered();
    let good = sampled.lines("data.csv");
    let refused = |lines: &[String], expected: &str| {
        sampled.write("data.csv", lines);
        sampled.refused("data.csv", &[], expected);
    };
    let changed = |row: usize, text: &str| {
        let mut lines = good.clone();
        lines[row] = text.to_owned();
        lines
    };
    let rest = |row: usize| good[row].split_once(',').unwrap().1.to_owned();
    refused(&changed(5, &format!("2.0,{}", rest(5))), "row 5, column `a`: found 2, but the design has");
    refused(&changed(5, &format!(",{}", rest(5))), "row 5, column `a`: found nothing, but the design has");
    let other = if good[7].contains("nitride") {
        good[7].replace("\"nitride, doped\"", "silicon")
    } else {
        good[7].replace("silicon", "\"nitride, doped\"")
    };
    refused(&changed(7, &other), "row 7, column `probe`: ");
    refused(
        &changed(7, &good[7].replace("silicon", "steel").replace("nitride", "steel")),
        "expected one of silicon, nitride, doped, not",
    );
    let mut swapped = good.clone();
    swapped.swap(5, 17);
    refused(&swapped, "rows are missing, repeated or in another order");
    let mut missing = good.clone();
    missing.remove(5);
    refused(&missing, "row 5, column `a`: ");
    refused(&good[..good.len() - 2], "the file has 318 rows, but the design has 320");
    let mut repeated = good.clone();
    repeated.insert(9, good[4].clone());
    refused(&repeated, "rows are missing, repeated or in another order");
    let more = [&good[..], &[good[1].clone(), good[2].clone()]].concat();
    refused(&more, "the file has 322 rows, but the design has 320");
    refused(
        &good.iter().map(|line| line.rsplit_once(',').unwrap().0.to_owned()).collect::<Vec<_>>(),
        "no column is called `force`",
    );
}

#[test]
fn values_that_another_program_printed_are_the_same_values() {
    let sampled = answered();
    let lines = sampled.lines("data.csv");
    let printed = |line: &String| {
        let (a, rest) = line.split_once(',').unwrap();
        a.parse::<f64>().map_or_else(|_| line.clone(), |a| format!("{a:.11e},{rest}"))
    };
    sampled.write("data.csv", &lines.iter().map(printed).collect::<Vec<_>>());
    let output = sampled.analyze("data.csv", &[]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn rows_without_an_output_are_refused_or_counted_as_failed() {
    let sampled = answered();
    let mut lines = sampled.lines("data.csv");
    for (row, word) in [(3, ""), (9, "NaN"), (20, "inf")] {
        lines[row] = format!("{},{word}", lines[row].rsplit_once(',').unwrap().0);
    }
    sampled.write("data.csv", &lines);
    sampled.refused("data.csv", &[], "row 3, column `force`: the value is missing; --missing-as-failed");
    let output = sampled.analyze("data.csv", &["--missing-as-failed"]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let result = sampled.result("s");
    assert_eq!((result.outputs[0].runs_failed, result.outputs[0].runs_ok), (3, 317));
}

#[test]
fn a_manifest_that_does_not_fit_is_refused() {
    let sampled = answered();
    let manifest = std::fs::read_to_string(sampled.path("data.csv.manifest.json")).unwrap();
    let refused = |text: &str, expected: &str| {
        std::fs::write(sampled.path("data.csv.manifest.json"), text).unwrap();
        sampled.refused("data.csv", &[], expected);
    };
    refused(&manifest.replace("max = 3,", "max = 4,"), "the study in the manifest was changed");
    refused(&manifest.replace("\"seed\": 3", "\"seed\": 4"), "the design of the manifest is not that of its study");
    refused(&manifest.replace("apportion-design", "else"), "its format is \"else\"");
    refused(&manifest.replace("\"version\": 1", "\"version\": 2"), "format version 2 of the manifest is unknown");
    refused("{", "not a manifest of a design");
    let digest = manifest.rsplit_once("\"sha256\": \"").unwrap().1[..8].to_owned();
    refused(&manifest.replace(&digest, "00000000"), "the points of this manifest are not those that version");
    std::fs::remove_file(sampled.path("data.csv.manifest.json")).unwrap();
    sampled.refused("data.csv", &[], "there is no ");
    sampled.refused("data.csv", &["--manifest", &sampled.name("none.json")], "cannot read the manifest");
}

#[test]
fn formats_are_known_by_their_endings() {
    let sampled = answered();
    let output = apportion(&["sample", &sampled.name("s.toml"), "-o", &sampled.name("d.xlsx")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("expected .csv or .npy"), "{}", stderr(&output));
    std::fs::write(sampled.path("data.parquet"), b"PAR1,b\n").unwrap();
    sampled.refused("data.parquet", &["--design", &sampled.name("design.csv")], "it is a Parquet file");
    write_columns(&sampled.path("data.npy"), &["p", "q"], &[vec![1.0; 320], vec![2.0; 320]]);
    let expected =
        "the file has 2 columns, without names: expected 1 (the outputs) or 4 (the 3 factors, then the outputs)";
    sampled.refused("data.npy", &["--design", &sampled.name("design.csv")], expected);
}

#[test]
fn a_file_without_a_header_is_found_out() {
    let sampled = answered();
    let numbers: Vec<String> = sampled.lines("data.csv")[1..].iter().map(|line| line.replace(' ', "")).collect();
    let forces: Vec<String> = numbers.iter().map(|line| line.rsplit_once(',').unwrap().1.to_owned()).collect();
    sampled.write("data.csv", &forces);
    sampled.refused("data.csv", &[], "line 1 has numbers");
    assert_eq!(sampled.analyze("data.csv", &["--no-header"]).status.code(), Some(0));
    sampled.write("y.csv", &forces[..48]);
    sampled.refused("y.csv", &["--layout", "salib", "--names", "x1,x2"], "line 1 has numbers");
}

#[test]
fn an_output_has_a_name_that_no_factor_has() {
    let sampled = Sampled::new(OUTSIDE, "design.csv");
    let study = OUTSIDE.replace("outputs.force", "outputs.b");
    std::fs::write(sampled.path("s.toml"), study).unwrap();
    let output = apportion(&["check", &sampled.name("s.toml")]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("s.toml:7:18: factor or output `b` is listed twice"), "{}", stderr(&output));
}

#[test]
fn whole_numbers_of_a_design_have_no_decimal_point() {
    let layers = r#"{ name = "layers", distribution = "integer", min = 1, max = 4 }"#;
    let sampled = Sampled::new(&OUTSIDE.replace("{ name = \"b\", min = -1, max = 1 }", layers), "design.csv");
    for line in &sampled.lines("design.csv")[1..] {
        assert!(["1", "2", "3", "4"].contains(&line.split(',').nth(1).unwrap()), "{line}");
    }
}

#[test]
fn points_and_outputs_of_a_run_are_saved_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let study = study_path("ishigami");
    let mut all = Vec::new();
    for format in Format::ALL {
        let saved = folder.path().join(format!("saved.{}", format.name()));
        let out = folder.path().join("out");
        let journal: &[&str] = if format == Format::Csv { &["--no-journal"] } else { &[] };
        let run = ["run", text(&study), "--base-samples", "256", "--out", text(&out), "--save-outputs", text(&saved)];
        succeed(&[&run[..], journal].concat());
        all.push(columns(&saved));
    }
    assert!(all.iter().all(|columns| *columns == all[0]));
    let points = folder.path().join("points.csv");
    write_columns(&points, &["x1", "x2", "x3"], &all[0][..3]);
    let y = folder.path().join("y.csv");
    succeed(&["evaluate", text(&study), text(&points), "-o", text(&y)]);
    assert_eq!(columns(&y)[0], all[0][3]);
}
