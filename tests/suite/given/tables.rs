//! Tables in every format that `evaluate` and `given-data` read, with skipped columns and warnings.

use apportion::given::Column;
use apportion_files::exchange::{
    ColumnKind, DroppedRows, Format, Missing, ReadOptions, RowWriter, Selection, Table, TableError, read_table,
    table_of_bytes,
};
use apportion_report::given::GivenFile;
use proptest::prelude::*;

use crate::common::{Folder, apportion, stderr, succeed, text};
use crate::engine::points::random;
use crate::messages::messages;

const STUDY: &str = "model = \"ishigami\"\n[design]\nbase_samples = 64\nsampler = \"random\"\n";

#[test]
fn points_of_every_format_give_the_same_outputs() {
    let folder = Folder::new();
    let study = folder.with("s.toml", STUDY);
    for name in ["p.csv", "p.npy"] {
        succeed(&["sample", text(&study), "-o", text(&folder.path(name))]);
    }
    let plain = std::fs::read_to_string(folder.path("p.csv")).unwrap();
    let bare = plain.split_once('\n').unwrap().1;
    folder.with("semicolons.txt", plain.replace(',', ";"));
    folder.with("tabs.tsv", plain.replace(',', "\t"));
    folder.with("bare.csv", bare);
    folder.with("bare.dat", bare.replace(',', ";"));
    let labelled = plain.lines().enumerate().map(|(k, line)| match k {
        0 => format!("id,{line},when\n"),
        _ => format!("run {k},{line},2026-01-{:02}\n", k % 28 + 1),
    });
    folder.with("labelled.csv", labelled.collect::<String>());
    let evaluate = |points: &str, more: &[&str]| {
        let (points, out) = (folder.path(points), folder.path("out.csv"));
        let output =
            apportion(&[&["evaluate", text(&study), text(&points), "--force", "-o", text(&out)], more].concat());
        (output.status.code(), stderr(&output), std::fs::read_to_string(out).unwrap_or_default())
    };
    let (_, _, expected) = evaluate("p.csv", &[]);
    assert_eq!(expected.lines().count(), 64 * 5 + 1);
    let names = ["--names", "x1, x2, x3"];
    for (points, more) in
        [("p.npy", &names[..]), ("semicolons.txt", &[]), ("tabs.tsv", &[]), ("bare.csv", &names), ("bare.dat", &names)]
    {
        let (code, said, outputs) = evaluate(points, more);
        assert_eq!(code, Some(0), "{points}: {said}");
        assert!(outputs == expected && !said.contains("warning"), "{points}: {said}");
    }
    // What is missing is asked for; a number of what was cut short may have lost its end.
    folder.with("cut.csv", &plain[..plain.len() - 3]);
    let mut messages = messages!();
    for (points, more, expected_code) in [
        ("labelled.csv", &[][..], 0),
        ("p.npy", &[], 2),
        ("bare.csv", &[], 2),
        ("bare.csv", &["--names", "x1,x2"], 2),
        ("p.csv", &names, 2),
        ("cut.csv", &[], 0),
    ] {
        let (code, said, outputs) = evaluate(points, more);
        assert_eq!(code, Some(expected_code), "{points}: {said}");
        assert!(points != "labelled.csv" || outputs == expected);
        messages.add(&format!("{points} {}", more.join(" ")), &said);
    }
}

#[test]
fn tables_of_every_format_give_the_same_indices() {
    let folder = Folder::new();
    let mut columns = random(3, 200, 1);
    columns.push((0..200).map(|k| columns[0][k] + 2.0 * columns[1][k] * columns[2][k]).collect());
    let kinds = ["x1", "x2", "x3", "y"].map(ColumnKind::numbers).to_vec();
    for format in Format::ALL {
        let mut bytes = Vec::new();
        let mut writer = RowWriter::new(format, &mut bytes, kinds.clone(), 200).unwrap();
        writer.write(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>()).unwrap();
        writer.finish().unwrap();
        folder.with(&format!("t.{}", format.name()), bytes);
    }
    let plain = std::fs::read_to_string(folder.path("t.csv")).unwrap();
    folder.with("t.txt", plain.replace(',', ";"));
    folder.with("bare.csv", plain.split_once('\n').unwrap().1);
    let kinds = plain
        .lines()
        .enumerate()
        .map(|(k, line)| format!("{}\t{}\n", if k == 0 { "kind" } else { "wet" }, line.replace(',', "\t")));
    folder.with("kinds.tsv", kinds.collect::<String>());
    let given = |table: &str, more: &[&str]| {
        let out = folder.path(&format!("given {table}"));
        let path = folder.path(table);
        let arguments = [&["given-data", text(&path), "--outputs", "y", "--out", text(&out)], more].concat();
        let output = apportion(&arguments);
        let stem = table.split('.').next().unwrap();
        let json = std::fs::read(out.join(format!("{stem}.json"))).unwrap_or_default();
        (output.status.code(), stderr(&output), serde_json::from_slice::<GivenFile>(&json).ok())
    };
    let expected = given("t.csv", &[]).2.unwrap();
    let (names, mut messages) = (["--names", "x1,x2,x3,y"], messages!());
    for (table, more) in [("t.npy", &names[..]), ("t.txt", &[]), ("bare.csv", &names), ("kinds.tsv", &[])] {
        let (code, said, result) = given(table, more);
        assert_eq!(code, Some(0), "{table}: {said}");
        let result = result.unwrap();
        assert!(result.outputs == expected.outputs && result.inputs == expected.inputs, "{table}");
        messages.add(table, &said);
    }
    for table in ["t.npy", "bare.csv"] {
        let (code, said, _) = given(table, &[]);
        assert_eq!(code, Some(2), "{table}: {said}");
        messages.add(&format!("{table} without names"), &said);
    }
}

#[test]
fn outputs_that_may_have_been_cut_short_are_doubted() {
    let folder = Folder::new();
    let study = folder.with("s.toml", STUDY);
    let (design, outputs) = (folder.path("d.csv"), folder.path("y.csv"));
    succeed(&["sample", text(&study), "-o", text(&design)]);
    succeed(&["evaluate", text(&study), text(&design), "-o", text(&outputs)]);
    let whole = std::fs::read_to_string(&outputs).unwrap();
    let analyze = |content: &str| {
        let data = folder.with("cut.csv", content);
        let out = folder.path("out");
        let output = apportion(&["analyze", text(&data), "--design", text(&design), "--out", text(&out)]);
        (output.status.code(), stderr(&output))
    };
    let (code, said) = analyze(&whole);
    assert!(code == Some(0) && !said.contains("warning"), "{said}");
    let last = whole.trim_end().rfind('\n').unwrap();
    let mut messages = messages!();
    for (case, end, expected) in [
        ("within the last number", whole.len() - 4, 0),
        ("before it", last + 1, 2),
        ("within a row", last - 2, 2),
        ("in the middle", whole.len() / 2, 2),
    ] {
        let (code, said) = analyze(&whole[..end]);
        assert_eq!(code, Some(expected), "{case}: {said}");
        messages.add(case, &said);
    }
}

/// The result of `given-data` on a table with an output `y`.
fn given(folder: &Folder, table: &str, more: &[&str]) -> GivenFile {
    let (path, out) = (folder.path(table), folder.path("out"));
    succeed(&[&["given-data", text(&path), "--outputs", "y", "--out", text(&out)], more].concat());
    let stem = table.split('.').next().unwrap();
    serde_json::from_slice(&std::fs::read(out.join(format!("{stem}.json"))).unwrap()).unwrap()
}

#[test]
fn labels_that_evaluate_wrote_are_read_by_the_study() {
    let folder = Folder::new();
    let study = "model = \"expression\"\noutputs.y = \"a + wet + 2*probe\"\n[factors]\na = { min = 0, max = 1 }\n\
                 wet = { distribution = \"boolean\" }\nprobe = { distribution = \"categorical\", labels = [\"steel\", \"#2, brass\"] }\n";
    let study = folder.with("s.toml", study);
    let (rows, table) = (folder.path("rows.csv"), folder.path("table.csv"));
    succeed(&["sample", text(&study), "--runs", "400", "-o", text(&rows)]);
    succeed(&["evaluate", text(&study), text(&rows), "--with-points", "-o", text(&table)]);
    let result = given(&folder, "table.csv", &["--study", text(&study)]);
    let inputs: Vec<&str> = result.inputs.iter().map(|input| input.name.as_str()).collect();
    assert_eq!(inputs, ["a", "wet", "probe"]);
    assert_eq!((result.inputs[2].min, result.inputs[2].max), (0.0, 1.0));
    // V = 1/12 + 1/4 + 1: the probe has 3/4 of it.
    let index = result.outputs[0].indices.as_ref().unwrap()[2].binned;
    assert!((index.estimate.estimate - 0.75).abs() < 0.05, "{:?}", index.estimate);
    let without = given(&folder, "table.csv", &[]);
    assert_eq!(without.table.columns_left_out[0].name, "probe");
}

#[test]
fn codes_for_missing_values_are_warned_of_and_left_out_if_asked() {
    let folder = Folder::new();
    let columns = random(2, 300, 3);
    let row = |k: usize| {
        format!("{},{},{}\n", columns[0][k], columns[1][k], if k % 60 == 7 { -999.0 } else { columns[0][k] })
    };
    folder.with("codes.csv", format!("a,b,y\n{}", (0..300).map(row).collect::<String>()));
    let result = given(&folder, "codes.csv", &[]);
    messages!().add("-999 in 5 rows", &result.warnings[0]);
    let result = given(&folder, "codes.csv", &["--missing-value=-999", "--drop-missing"]);
    assert_eq!((result.table.rows, result.table.rows_dropped), (295, 5));
    assert_eq!(result.outputs[0].warnings, [""; 0]);
}

fn read(text: &str, outputs: &[&str], inputs: &[&str], missing: Missing) -> Result<Table, TableError> {
    let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let (outputs, inputs) = (owned(outputs), owned(inputs));
    let mut rows = table_of_bytes(text.as_bytes().to_vec(), &ReadOptions::default())?;
    read_table(rows.as_mut(), &Selection { outputs: &outputs, inputs: &inputs, missing, kinds: &[] })
}

#[test]
fn columns_come_in_the_order_asked_for() {
    let text = "\u{feff}a, note ,y,b\r\n1,hello,2,3\r\n\r\n-4e-3,\"x, y\",5,6";
    let table = read(text, &["y"], &["b", "a"], Missing::Refuse).unwrap();
    assert_eq!(table.inputs[0], Column { name: "b".to_owned(), values: vec![3.0, 6.0] });
    assert_eq!(table.inputs[1].values, [1.0, -4e-3]);
    assert_eq!(table.outputs[0].values, [2.0, 5.0]);
    let table = read("a,y,b\n1,2,3\n", &["y"], &[], Missing::Refuse).unwrap();
    assert_eq!((table.inputs.len(), table.inputs[1].name.as_str(), table.dropped), (2, "b", None));
}

#[test]
fn faults_are_named_with_their_place() {
    let cases: [(&str, &[&str], &str); 11] = [
        ("\n\n", &[], ""),
        ("y\n1\n", &[], ""),
        ("a,y\n", &["y"], "`y`"),
        ("a,force\n", &[], ""),
        ("a,y\n1,2\n3,nan\n", &[], "line 3: column 2 (`y`): "),
        ("a,y\n1,2\n,2\n", &[], "line 3: column 1 (`a`): "),
        ("# a\na,y\n1,#N/A\n", &[], "line 3: column 2 (`y`): "),
        ("a,y\n1,2\nred,2\n", &[], "line 3: column 1 (`a`): "),
        ("a;y\n2;2\n1,5;2\n", &["a"], "line 3: column 1 (`a`): "),
        ("a,y\n1,2\n1,inf\n", &["a"], "line 3: column 2 (`y`): "),
        ("a;b;y\n1,5;red;2\n", &[], ""),
    ];
    let messages = cases.map(|(text, inputs, place)| {
        let message = read(text, &["y"], inputs, Missing::Refuse).unwrap_err().to_string();
        assert!(message.starts_with(place), "{message}");
        message
    });
    insta::assert_snapshot!(messages.join("\n"));
}

#[test]
fn columns_of_text_are_skipped_and_named() {
    let text = "id;a;when;y\nr1;;2026-01-01;2\nr2;0.5;2026-01-02;4\n";
    let table = read(text, &["y"], &[], Missing::Drop).unwrap();
    let skipped: Vec<_> = table.skipped.iter().map(|column| (&*column.name, column.example.as_deref())).collect();
    assert_eq!((table.inputs.len(), &table.inputs[0].values), (1, &vec![0.5]));
    assert_eq!(skipped, [("id", Some("r1")), ("when", Some("2026-01-01"))]);
    // A requested column is not skipped.
    assert!(read(text, &["y"], &["id"], Missing::Drop).is_err());
    let tabs = read("a\ty\n1\t2\n", &["y"], &[], Missing::Refuse).unwrap();
    assert_eq!((tabs.inputs[0].values[0], tabs.outputs[0].values[0]), (1.0, 2.0));
}

#[test]
fn rows_without_a_value_are_dropped_and_counted_if_asked() {
    let text = "a,y,z\n1,2,\n,2,3\n3,NaN,3\n4,5,6\n";
    let table = read(text, &["y"], &["a"], Missing::Drop).unwrap();
    assert_eq!(table.inputs[0].values, [1.0, 4.0]);
    assert_eq!(table.dropped, Some(DroppedRows { rows: 2, first_line: 3 }));
    // Infinities are missing values, text is not.
    assert!(read("a,y\n1,1\nred,1\n", &["y"], &[], Missing::Drop).is_err());
    assert_eq!(read("a,y\n1,inf\n2,3\n", &["y"], &["a"], Missing::Drop).unwrap().dropped.map(|of| of.rows), Some(1));
}

proptest! {
    #[test]
    fn no_file_panics(bytes in prop::collection::vec(any::<u8>(), 0..60), near in "[a,y\n\r\"0-9.e-]{0,40}") {
        let outputs = ["y".to_owned()];
        for missing in [Missing::Refuse, Missing::Drop] {
            let selection = Selection { outputs: &outputs, inputs: &[], missing, kinds: &[] };
            for bytes in [&bytes[..], near.as_bytes()] {
                if let Ok(mut rows) = table_of_bytes(bytes.to_vec(), &ReadOptions::default()) {
                    let _ = read_table(rows.as_mut(), &selection);
                }
            }
        }
    }
}
