use proptest::prelude::*;

use super::*;
use crate::exchange::{ReadOptions, table_of_bytes};

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
    // Text and infinities are not missing values.
    assert!(read("a,y\n1,1\nred,1\n", &["y"], &[], Missing::Drop).is_err());
    assert!(read("a,y\n1,inf\n", &["y"], &[], Missing::Drop).is_err());
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
