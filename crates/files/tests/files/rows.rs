//! Rows of tables in files: what is written is read back, and what other programs write is understood.

use apportion_files::exchange::{ColumnKind, Format, ReadOptions, RowWriter, TableError, table_of_bytes};
use proptest::prelude::*;

fn written(format: Format, columns: &[ColumnKind], values: &[Vec<f64>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = RowWriter::new(format, &mut bytes, columns.to_vec(), values[0].len() as u64).unwrap();
    let half = values[0].len() / 2;
    for part in [0..half, half..values[0].len()] {
        let slices: Vec<&[f64]> = values.iter().map(|column| &column[part.clone()]).collect();
        writer.write(&slices).unwrap();
    }
    writer.finish().unwrap();
    bytes
}

/// All rows of all columns, in blocks of `block`.
fn read(bytes: &[u8], kinds: &[ColumnKind], block: usize) -> Result<Vec<Vec<f64>>, TableError> {
    let mut reader = table_of_bytes(bytes.to_vec(), &ReadOptions::default())?;
    let width = reader.width();
    let kind = |place: usize| kinds.get(place).cloned().unwrap_or_default();
    let wanted: Vec<_> = (0..width).map(|place| (place, kind(place))).collect();
    let (mut all, mut part) = (vec![Vec::new(); width], vec![Vec::new(); width]);
    while reader.read(&wanted, block, &mut part)? > 0 {
        all.iter_mut().zip(&part).for_each(|(all, part)| all.extend_from_slice(part));
    }
    Ok(all)
}

fn bits(columns: &[Vec<f64>]) -> Vec<Vec<u64>> {
    // A NaN of any bits is a missing value.
    let bits = |value: &f64| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() };
    columns.iter().map(|column| column.iter().map(bits).collect()).collect()
}

fn probe() -> ColumnKind {
    let labels = vec![("silicon, doped".to_owned(), 0.0), ("nitride".to_owned(), 7.5)];
    ColumnKind { labels, ..ColumnKind::numbers("probe") }
}

#[test]
fn labels_are_text_where_there_is_text() {
    let columns = [probe(), ColumnKind::numbers("y, \"z\"")];
    let values = [vec![7.5, 0.0], vec![f64::NAN, 1e-300]];
    for format in Format::ALL {
        let bytes = written(format, &columns, &values);
        assert_eq!(bits(&read(&bytes, &columns, 5).unwrap()), bits(&values), "{format:?}");
        let has_text = String::from_utf8_lossy(&bytes).contains("nitride");
        assert_eq!(has_text, format != Format::Npy, "{format:?}");
    }
    let csv = written(Format::Csv, &columns, &values);
    assert_eq!(String::from_utf8(csv).unwrap(), "probe,\"y, \"\"z\"\"\"\nnitride,\n\"silicon, doped\",1e-300\n");
}

/// A file of NumPy with this dictionary and data.
fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x02\x00".to_vec();
    bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
    bytes.extend_from_slice(header.as_bytes());
    bytes.extend_from_slice(data);
    bytes
}

#[test]
fn arrays_of_other_types_and_orders_are_read() {
    let plain = |bytes: &[u8]| read(bytes, &[], 2).unwrap();
    let data: Vec<u8> = [1.5f32, -2.0, 3.25, 4.0, 5.0, 6.0].iter().flat_map(|x| x.to_be_bytes()).collect();
    let header = "{\"descr\": \">f4\", 'fortran_order': True, 'shape': (3, 2)}\n";
    assert_eq!(plain(&npy(header, &data)), [[1.5, -2.0, 3.25], [4.0, 5.0, 6.0]]);
    let data: Vec<u8> = [-1i16, 300, 2].iter().flat_map(|x| x.to_le_bytes()).collect();
    assert_eq!(plain(&npy("{'descr': '<i2', 'fortran_order': False, 'shape': (3,), }", &data)), [[-1.0, 300.0, 2.0]]);
    assert_eq!(plain(&npy("{'descr': '|b1', 'fortran_order': False, 'shape': (1, 2), }", &[1, 0])), [[1.0], [0.0]]);
}

#[test]
fn whole_numbers_are_text_that_programs_take_for_integers() {
    let columns = [ColumnKind { whole: true, ..ColumnKind::numbers("layers") }, ColumnKind::numbers("x")];
    let values = [vec![4.0, -1e15], vec![4.0, 1e15]];
    let csv = written(Format::Csv, &columns, &values);
    assert_eq!(String::from_utf8(csv.clone()).unwrap(), "layers,x\n4,4.0\n-1000000000000000,1000000000000000.0\n");
    assert_eq!(bits(&read(&csv, &columns, 5).unwrap()), bits(&values));
}

#[test]
fn faults_are_named_with_their_place() {
    let refused = |bytes: &[u8]| read(bytes, &[ColumnKind::numbers("a"), probe()], 9).unwrap_err();
    let mut messages: Vec<String> = [
        &b""[..],
        b"a,,b\n",
        "a,\u{202e}b\n".as_bytes(),
        b"a,b,a\n",
        b"a,b\n1,0\n\n2\n",
        b"PAR1,b\n1,3\n",
        b"PK\x03\x04\x14",
        b"1,2\n3,4\n",
        b"# a comment\na,1.5\n3,4\n",
    ]
    .map(|bytes| refused(bytes).to_string())
    .to_vec();
    for (text, column) in [("a,b\nred,0\n", 1), ("a;b\n1,5;0\n", 1), ("a,b\n1,3\n", 2)] {
        let TableError::WrongCell { row: 1, line: Some(2), column: at, .. } = refused(text.as_bytes()) else {
            panic!("{text:?}")
        };
        assert_eq!(at, column);
    }
    for header in [
        "{'descr': '<c16', 'fortran_order': False, 'shape': (1,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (18446744073709551615, 2)}",
    ] {
        messages.push(refused(&npy(header, &[0; 7])).to_string());
    }
    for name in ["a.xlsx", "a.parquet", "a"] {
        messages.push(Format::from_path(name.as_ref()).unwrap_err().to_string());
    }
    insta::assert_snapshot!(messages.join("\n"));
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

#[test]
fn other_separators_and_tables_without_names_are_read() {
    for text in ["a;b\n1;7.5\n2;0\n", "a\tb\n1\t7.5\n2\t0\n", "\"a\";\"b\"\r\n1;7.5\r\n2;0"] {
        assert_eq!(read(text.as_bytes(), &[], 9).unwrap(), [[1.0, 2.0], [7.5, 0.0]], "{text:?}");
    }
    // A comma in quotes is part of a name.
    let quoted = table_of_bytes(b"\"a,x\";b\n1;2\n".to_vec(), &ReadOptions::default()).unwrap();
    assert_eq!(quoted.names().unwrap(), ["a,x", "b"]);
    let mut columns = vec![Vec::new(); 2];
    let wanted = [(0, ColumnKind::numbers("a")), (1, ColumnKind::numbers("b"))];
    let numbers =
        written(Format::Npy, &[ColumnKind::numbers("a"), ColumnKind::numbers("b")], &[vec![1.0, 2.0], vec![7.5, 0.0]]);
    let named = |list: &[&str]| ReadOptions { names: names(list), ..ReadOptions::default() };
    for bytes in ["\u{feff}1,7.5\n2,0\n".as_bytes().to_vec(), b"1;7.5\n2;0".to_vec(), numbers.clone()] {
        let mut rows = table_of_bytes(bytes.clone(), &named(&["a", "b"])).unwrap();
        assert_eq!(rows.names().unwrap(), names(&["a", "b"]));
        assert_eq!(rows.read(&wanted, 5, &mut columns).unwrap(), 2);
        assert_eq!(columns, [[1.0, 2.0], [7.5, 0.0]]);
        assert!(matches!(table_of_bytes(bytes, &named(&["a"])), Err(TableError::Refused(_))));
    }
    assert!(table_of_bytes(numbers, &ReadOptions::default()).unwrap().names().is_none());
    let twice = table_of_bytes(b"a,b\n1,2\n".to_vec(), &named(&["a", "b"]));
    assert!(matches!(twice, Err(TableError::Refused(_))));
    let without = ReadOptions { no_header: true, ..ReadOptions::default() };
    let rows = table_of_bytes(b"steel,2\n".to_vec(), &without).unwrap();
    assert_eq!((rows.names(), rows.width()), (None, 2));
}

/// The table `a,b\n1,7.5\n2,0\n`, compressed by Python's gzip.
const GZIP: &[u8] = b"\x1f\x8b\x08\0\0\0\0\0\x02\x03K\xd4I\xe22\xd41\xd73\xe52\xd21\xe0\x02\0m\x11\xf4v\x0e\0\0\0";

#[test]
fn texts_of_other_programs_are_read() {
    let utf16 = |text: &str, big: bool| -> Vec<u8> {
        let bytes = |unit: u16| if big { unit.to_be_bytes() } else { unit.to_le_bytes() };
        "\u{feff}".encode_utf16().chain(text.encode_utf16()).flat_map(bytes).collect()
    };
    for text in [
        &b"sep=;\na;b\n1;7.5\n2;0\n"[..],
        b"sep=\t\r\na\tb\r\n1\t7.5\r\n2\t0\r\n",
        // numpy.savetxt with a header, and one with formats of a width.
        b"# a b\n1.000000000000000000e+00 7.500000000000000000e+00\n2.0e+00 0.0e+00\n",
        b"# made by hand\n#a,b\n1,7.5\n# half\n2,0\n",
        b"  a    b\n  1  7.5\n  2  0.0\n",
        b"a,b\n0.1D+01,7.5d0\n2,0\n",
        // A line of units.
        b"a,b\nm,EUR\n1,7.5\n2,0\n",
        b"a b\n[-] [kWh/day]\n1 7.5\n2 0\n",
        b"\"BehaviorSpace results (NetLogo 6.4.0)\"\n\"my wolf sheep.nlogo\"\n\"experiment\"\n\"04/12/2021 10:11:12:345 +0200\"\n\
          \"min-pxcor\",\"max-pxcor\"\n\"-16\",\"16\"\n\"a\",\"b\"\n\"1\",\"7.5\"\n\"2\",\"0\"\n",
        GZIP,
        &utf16("a,b\r\n1,7.5\r\n2,0\r\n", false),
        &utf16("a;b\n1;7.5\n2;0\n", true),
    ] {
        let mut rows = table_of_bytes(text.to_vec(), &ReadOptions::default()).unwrap();
        let name = String::from_utf8_lossy(text);
        assert_eq!(rows.names().unwrap(), ["a", "b"], "{name}");
        let (wanted, mut columns) = ([0, 1].map(|place| (place, ColumnKind::default())), [Vec::new(), Vec::new()]);
        rows.read(&wanted, 9, &mut columns).unwrap();
        assert_eq!(columns, [[1.0, 2.0], [7.5, 0.0]], "{name}");
    }
    // Text that is no line of units: labels in all rows, and a failed run.
    for text in ["a,b\nm,7\ns,8\n", "a,b\nfailed,failed\n1,2\n", "a,b\nA,m\nC,s\n"] {
        let mut rows = table_of_bytes(text.into(), &ReadOptions::default()).unwrap();
        assert_eq!(rows.read(&[], 9, &mut []).unwrap(), 2, "{text}");
    }
    // One column whose name has a blank.
    let rows = table_of_bytes(b"contact force\n1\n".to_vec(), &ReadOptions::default()).unwrap();
    assert_eq!(rows.names().unwrap(), ["contact force"]);
}

#[test]
fn missing_values_and_words_of_yes_and_no_are_numbers() {
    let cells = ["", "#N/A", "#DIV/0!", ".", "NA", "-999", "null"];
    let text = format!("a,b\n{}", cells.map(|cell| format!("1,{cell}\n")).concat());
    let options = ReadOptions { missing: vec![-999.0], ..ReadOptions::default() };
    let mut columns = [Vec::new()];
    let mut rows = table_of_bytes(text.into(), &options).unwrap();
    assert_eq!(rows.read(&[(1, ColumnKind::default())], 99, &mut columns).unwrap(), cells.len());
    assert!(columns[0].iter().all(|value| value.is_nan()));
    assert_eq!(read(b"a\ntrue\nFalse\n", &[], 9).unwrap(), [[1.0, 0.0]]);
    let labels = vec![("false".to_owned(), 0.0), ("true".to_owned(), 1.0)];
    let boolean = ColumnKind { labels, ..ColumnKind::numbers("a") };
    assert_eq!(read(b"a\ntrue\nFALSE\n1\n", &[boolean], 9).unwrap(), [[1.0, 0.0, 1.0]]);
}

#[test]
fn text_columns_are_distinguished_from_number_columns() {
    let csv = b"id,a,b,c\n,1,nan,x\nr2,2,red,\n".to_vec();
    let mut rows = table_of_bytes(csv, &ReadOptions::default()).unwrap();
    let text = rows.text_columns().unwrap();
    assert_eq!(text.iter().map(|(place, _)| *place).collect::<Vec<_>>(), [0, 2, 3]);
    // Detecting the format loses no rows.
    let mut columns = vec![Vec::new()];
    assert_eq!(rows.read(&[(1, ColumnKind::numbers("a"))], 9, &mut columns).unwrap(), 2);
    assert_eq!((&columns[0][..], rows.line(1), rows.is_unended()), (&[1.0, 2.0][..], Some(3), false));
}

#[test]
fn a_text_that_may_have_been_cut_short_is_noticed() {
    for (text, unended) in [("a\n1.25\n", false), ("a\n1.25", true), ("a\n1.25\r\n", false), ("a\n", false)] {
        let mut rows = table_of_bytes(text.into(), &ReadOptions::default()).unwrap();
        let mut columns = vec![Vec::new()];
        while rows.read(&[(0, ColumnKind::numbers("a"))], 9, &mut columns).unwrap() > 0 {}
        assert_eq!(rows.is_unended(), unended, "{text:?}");
    }
}

#[test]
fn names_that_a_spreadsheet_would_run_are_written_as_text_and_come_back() {
    let labels = vec![("+1".to_owned(), 1.0), ("=1+1".to_owned(), 2.0)];
    let columns = [ColumnKind::numbers("=cmd()"), ColumnKind { labels, ..ColumnKind::numbers("@b") }];
    let values = [vec![-1.5, 2.0], vec![1.0, 2.0]];
    let csv = written(Format::Csv, &columns, &values);
    assert_eq!(String::from_utf8(csv.clone()).unwrap(), "'=cmd(),'@b\n-1.5,+1\n2.0,'=1+1\n");
    assert_eq!(table_of_bytes(csv.clone(), &ReadOptions::default()).unwrap().names().unwrap(), ["=cmd()", "@b"]);
    assert_eq!(read(&csv, &columns, 5).unwrap(), values);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_number_comes_back_as_the_same_bits(
        values in prop::collection::vec((any::<f64>(), any::<f64>()), 0..20), block in 1usize..25,
    ) {
        let (a, b): (Vec<f64>, Vec<f64>) = values.into_iter().unzip();
        let columns = [ColumnKind::numbers("a"), ColumnKind::numbers("b")];
        for format in Format::ALL {
            let bytes = written(format, &columns, &[a.clone(), b.clone()]);
            prop_assert_eq!(bits(&read(&bytes, &columns, block).unwrap()), bits(&[a.clone(), b.clone()]));
        }
    }

    #[test]
    fn no_file_panics(bytes in prop::collection::vec(any::<u8>(), 0..80), near in "[a,b\n\r\"0-9.e-]{0,40}") {
        let npy = [&b"\x93NUMPY"[..], &bytes].concat();
        let _ = (read(&bytes, &[], 3), read(near.as_bytes(), &[probe()], 3), read(&npy, &[], 3));
    }

    #[test]
    fn no_damaged_file_panics(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let columns = [ColumnKind::numbers("a"), probe()];
        for format in Format::ALL {
            let mut bytes = written(format, &columns, &[vec![1.0, f64::NAN, 3.0], vec![0.0, 7.5, 0.0]]);
            for (place, byte) in &changes {
                let place = place.index(bytes.len());
                bytes[place] = *byte;
            }
            let _ = read(&bytes, &columns, 2);
        }
    }
}
