//! Tables: of inputs and outputs, and of points.

use std::path::Path;
use std::sync::LazyLock;

use apportion::given::{analyse, surrogate_indices};
use apportion::study::Study;
use apportion_files::exchange::{
    Missing, ReadOptions, RowReader, Selection, Table, evaluate, read_table, table_of_bytes,
};
use apportion_report::given::{GivenFacts, build_given, given_document};

/// A study with a factor of every kind.
static STUDY: LazyLock<Study> = LazyLock::new(|| {
    let text = r#"model = "expression"
        outputs = { y = "a + b + c + d", z = "ln(a)" }
        factor = [
            { name = "a", min = 0, max = 1, unit = "um" },
            { name = "b", distribution = "integer", min = 1, max = 6 },
            { name = "c", distribution = "boolean" },
            { name = "d", distribution = "categorical", labels = ["steel", "brass, 1"], values = [2, 1] },
        ]"#;
    apportion_files::parse_study(text, Path::new("points.toml"), &[]).expect("the study is right")
});

/// Cells up to which a table is analysed too.
const CELLS: usize = 4096;

/// The first line says which columns are outputs and, after `|`, which are inputs; the table follows.
pub fn run(bytes: &[u8]) {
    let (head, csv) = match bytes.iter().position(|byte| *byte == b'\n') {
        Some(end) => (&bytes[..end], &bytes[end + 1..]),
        None => (&b"y"[..], bytes),
    };
    let head = String::from_utf8_lossy(head);
    let (outputs, inputs) = head.split_once('|').unwrap_or((&head, ""));
    // As on the command line.
    let names = |text: &str| -> Vec<String> {
        text.split(',').map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned).collect()
    };
    let (outputs, inputs) = (names(outputs), names(inputs));
    for missing in [Missing::Refuse, Missing::Drop] {
        let selection = Selection { outputs: &outputs, inputs: &inputs, missing, kinds: &[] };
        let Some(mut rows) = rows(csv, &[]) else { continue };
        if let Ok(table) = read_table(rows.as_mut(), &selection) {
            analysed(&table);
        }
    }
    // With the header, and with names from elsewhere.
    let given = ["a", "b", "c", "d"].map(str::to_owned);
    for names in [&given[..0], &given] {
        let Some(mut rows) = rows(csv, names) else { continue };
        let mut values = Vec::new();
        let evaluated = STUDY
            .runner()
            .run_table(Default::default(), None, |run| evaluate(run, STUDY.space(), rows.as_mut(), &mut values, false));
        let Ok(evaluated) = evaluated else { continue };
        // A header, and a line for each point.
        let lines = values.iter().filter(|byte| **byte == b'\n').count() as u64;
        assert_eq!(lines, evaluated.points + 1);
    }
}

fn rows(bytes: &[u8], names: &[String]) -> Option<Box<dyn RowReader>> {
    table_of_bytes(bytes.to_vec(), &ReadOptions { names: names.to_vec(), ..ReadOptions::default() }).ok()
}

fn analysed(table: &Table) {
    let Table { inputs, outputs, dropped, .. } = table;
    let rows = inputs.iter().chain(outputs).map(|column| column.values.len()).max().unwrap_or(0);
    assert!(inputs.iter().chain(outputs).all(|column| column.values.len() == rows));
    if outputs.is_empty() || rows * (inputs.len() + outputs.len()) > CELLS {
        return;
    }
    let Ok(indices) = analyse(inputs, outputs, 0) else { return };
    let facts = GivenFacts {
        file: "table.csv".to_owned(),
        sha256: String::new(),
        dropped: dropped.map(|dropped| (dropped.rows, dropped.first_line)),
        seed: 0,
    };
    let surrogates = surrogate_indices(inputs, outputs, &indices, None);
    let result = build_given(&indices, &surrogates, inputs, outputs, &facts);
    super::result::written(&given_document(&result, "table"));
}
