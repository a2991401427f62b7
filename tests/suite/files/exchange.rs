//! The three steps joined by files, through the program: `sample`, an external model, `analyze`.

use std::path::{Path, PathBuf};

use apportion::result::{StudyResult, read_result};
use apportion_files::exchange::{ColumnKind, Format, ReadOptions, RowWriter, open_table};

use crate::common::{apportion, files, gap, numbers, stderr, study_path, succeed, text};
use crate::messages::{Messages, messages};

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

    /// `analyze` refuses `data`, at this place.
    #[track_caller]
    pub fn refused(&self, messages: &mut Messages, case: &str, (data, more): (&str, &[&str]), place: &str) {
        let output = self.analyze(data, more);
        messages.ended(case, 2, &output);
        assert!(stderr(&output).contains(place), "{case}: not at {place}: {}", stderr(&output));
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
    let mut writer =
        RowWriter::new(Format::from_path(path).unwrap(), &mut bytes, kinds, columns[0].len() as u64).unwrap();
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
    let mut messages = messages!();
    messages.ended("analyze", 0, &output);
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
        messages.refused(&[&[command, &study], points].concat());
    }
    succeed(&["check", &sampled.name("s.toml")]);
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
    let mut messages = messages!();
    for more in [["--outputs", "energi"], ["--outputs", "a"], ["--units", "energy=nJ"]] {
        sampled.refused(&mut messages, &more.join(" "), ("data.csv", &more), "");
    }
}

#[test]
fn a_file_that_does_not_belong_to_the_design_is_refused_with_the_reason() {
    let sampled = answered();
    let good = sampled.lines("data.csv");
    let mut messages = messages!();
    let mut refused = |case: &str, lines: &[String], place: &str| {
        sampled.write("data.csv", lines);
        sampled.refused(&mut messages, case, ("data.csv", &[]), place);
    };
    let changed = |row: usize, text: &str| {
        let mut lines = good.clone();
        lines[row] = text.to_owned();
        lines
    };
    let rest = |row: usize| good[row].split_once(',').unwrap().1.to_owned();
    refused("another number", &changed(5, &format!("2.0,{}", rest(5))), "row 5, column `a`: ");
    refused("no number", &changed(5, &format!(",{}", rest(5))), "row 5, column `a`: ");
    let other = if good[7].contains("nitride") {
        good[7].replace("\"nitride, doped\"", "silicon")
    } else {
        good[7].replace("silicon", "\"nitride, doped\"")
    };
    refused("another label", &changed(7, &other), "row 7, column `probe`: ");
    refused("no label", &changed(7, &good[7].replace("silicon", "steel").replace("nitride", "steel")), "`probe`");
    let mut swapped = good.clone();
    swapped.swap(5, 17);
    refused("rows in another order", &swapped, "");
    let mut missing = good.clone();
    missing.remove(5);
    refused("a row is missing", &missing, "row 5, column `a`: ");
    refused("the last rows are missing", &good[..good.len() - 2], "");
    let mut repeated = good.clone();
    repeated.insert(9, good[4].clone());
    refused("a row is repeated", &repeated, "");
    refused("more rows", &[&good[..], &[good[1].clone(), good[2].clone()]].concat(), "");
    let without: Vec<String> = good.iter().map(|line| line.rsplit_once(',').unwrap().0.to_owned()).collect();
    refused("no output", &without, "");
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
    sampled.refused(&mut messages!(), "missing", ("data.csv", &[]), "row 3, column `force`: ");
    let output = sampled.analyze("data.csv", &["--missing-as-failed"]);
    assert!(matches!(output.status.code(), Some(0 | 1)), "{}", stderr(&output));
    let result = sampled.result("s");
    assert_eq!((result.outputs[0].runs_failed, result.outputs[0].runs_ok), (3, 317));
}

#[test]
fn rows_in_the_order_in_which_runs_ended_are_sorted_by_their_number() {
    let sampled = answered();
    sampled.analyze("data.csv", &[]);
    let whole = sampled.result("s");
    let lines = sampled.lines("data.csv");
    let count = lines.len() - 1;
    let mut numbered: Vec<String> =
        (0..count).map(|k| (k * 7 + 3) % count).map(|k| format!("{k},{}", lines[k + 1])).collect();
    let design = sampled.name("design.csv");
    let mut messages = messages!();
    for name in ["run_id", ""] {
        sampled.write("numbered.csv", &[vec![format!("{name},{}", lines[0])], numbered.clone()].concat());
        let output = sampled.analyze("numbered.csv", &["--design", &design]);
        messages.ended(name, 0, &output);
        assert_eq!(sampled.result("s").outputs, whole.outputs);
    }
    // Rows that are missing leave out their base points; a number that does not fit is refused.
    numbered.truncate(count - 3);
    sampled.write("numbered.csv", &[vec![format!("run,{}", lines[0])], numbered.clone()].concat());
    let output = sampled.analyze("numbered.csv", &["--design", &design]);
    messages.ended("three rows less", 0, &output);
    assert_eq!(sampled.result("s").outputs[0].runs_failed, 3);
    numbered[5] = numbered[6].clone();
    sampled.write("numbered.csv", &[vec![format!("run,{}", lines[0])], numbered].concat());
    sampled.refused(&mut messages, "twice the same", ("numbered.csv", &["--design", &design]), "numbered.csv");
}

#[test]
fn a_manifest_that_does_not_fit_is_refused() {
    let sampled = answered();
    let manifest = std::fs::read_to_string(sampled.path("data.csv.manifest.json")).unwrap();
    let digest = manifest.rsplit_once("\"sha256\": \"").unwrap().1[..8].to_owned();
    let mut messages = messages!();
    for (from, to) in [
        ("max = 3,", "max = 4,"),
        ("\"seed\": 3", "\"seed\": 4"),
        ("apportion-design", "else"),
        ("\"version\": 1", "\"version\": 2"),
        (&manifest, "{"),
        (&digest, "00000000"),
    ] {
        std::fs::write(sampled.path("data.csv.manifest.json"), manifest.replace(from, to)).unwrap();
        sampled.refused(&mut messages, to, ("data.csv", &[]), "data.csv");
    }
    std::fs::remove_file(sampled.path("data.csv.manifest.json")).unwrap();
    sampled.refused(&mut messages, "no manifest", ("data.csv", &[]), "");
    sampled.refused(&mut messages, "no such manifest", ("data.csv", &["--manifest", &sampled.name("none.json")]), "");
}

#[test]
fn formats_are_known_by_their_endings() {
    let sampled = answered();
    let (mut messages, design) = (messages!(), sampled.name("design.csv"));
    messages.refused(&["sample", &sampled.name("s.toml"), "-o", &sampled.name("d.xlsx")]);
    std::fs::write(sampled.path("data.parquet"), b"PAR1,b\n").unwrap();
    sampled.refused(&mut messages, "a Parquet file", ("data.parquet", &["--design", &design]), "data.parquet");
    write_columns(&sampled.path("data.npy"), &["p", "q"], &[vec![1.0; 320], vec![2.0; 320]]);
    sampled.refused(&mut messages, "two columns of four", ("data.npy", &["--design", &design]), "data.npy");
}

#[test]
fn a_file_without_a_header_is_found_out() {
    let sampled = answered();
    let numbers: Vec<String> = sampled.lines("data.csv")[1..].iter().map(|line| line.replace(' ', "")).collect();
    let forces: Vec<String> = numbers.iter().map(|line| line.rsplit_once(',').unwrap().1.to_owned()).collect();
    sampled.write("data.csv", &forces);
    let mut messages = messages!();
    sampled.refused(&mut messages, "outputs", ("data.csv", &[]), "line 1 ");
    assert_eq!(sampled.analyze("data.csv", &["--no-header"]).status.code(), Some(0));
}

#[test]
fn an_output_has_a_name_that_no_factor_has() {
    let sampled = Sampled::new(OUTSIDE, "design.csv");
    let study = OUTSIDE.replace("outputs.force", "outputs.b");
    std::fs::write(sampled.path("s.toml"), study).unwrap();
    let message = messages!().refused(&["check", &sampled.name("s.toml")]);
    assert!(message.contains("s.toml:7:18: "), "{message}");
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
