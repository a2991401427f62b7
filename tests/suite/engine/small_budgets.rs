//! Small budgets: plain rows as a table for `given-data`.

use apportion_report::given::GivenFile;

use crate::common::{Folder, succeed, text};
use crate::messages::messages;

const STUDY: &str = "model = \"expression\"\noutputs.y = \"a + 2 * b + a * b\"\n[factors.a]\nmin = -1\nmax = 1\n\
                     [factors.b]\nmin = -100\nmax = 100\nunit = \"cm\"\n";

/// Formulas are in SI, so b is between -1 and 1: the parts of y have the variances 1/3, 4/3 and 1/9.
#[test]
fn plain_rows_of_a_study_are_a_table_of_given_data() {
    let folder = Folder::new();
    let study = folder.with("s.toml", STUDY);
    let (rows, table) = (folder.path("rows.csv"), folder.path("table.csv"));
    succeed(&["sample", text(&study), "--runs", "64", "-o", text(&rows)]);
    succeed(&["evaluate", text(&study), text(&rows), "--with-points", "-o", text(&table)]);
    let (points, both) = (std::fs::read_to_string(&rows).unwrap(), std::fs::read_to_string(&table).unwrap());
    assert_eq!((points.lines().count(), both.lines().next()), (65, Some("a,b,y")));
    for (point, line) in points.lines().zip(both.lines()) {
        assert!(line.starts_with(&format!("{point},")), "{point} in {line}");
    }
    let out = folder.path("out");
    let study = text(&study);
    succeed(&["given-data", text(&table), "--outputs", "y", "--study", study, "--out", text(&out)]);
    let result: GivenFile = serde_json::from_slice(&std::fs::read(out.join("table.json")).unwrap()).unwrap();
    let found = result.outputs[0].surrogate.as_ref().unwrap();
    let all = 1.0 / 3.0 + 4.0 / 3.0 + 1.0 / 9.0;
    for (index, [first, total]) in found.indices.iter().zip([[1.0 / 3.0, 4.0 / 9.0], [4.0 / 3.0, 13.0 / 9.0]]) {
        // The surrogate has these polynomials.
        assert!((index.first_order.estimate - first / all).abs() < 1e-9, "{index:?}");
        assert!((index.total.estimate - total / all).abs() < 1e-9, "{index:?}");
    }
}

#[test]
fn too_few_runs_are_refused() {
    let folder = Folder::new();
    let study = folder.with("s.toml", STUDY);
    messages!().refused(&["run", text(&study), "--runs", "20"]);
}
