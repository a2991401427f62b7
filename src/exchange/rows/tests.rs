use std::sync::Arc;

use parquet::basic::{Encoding, Repetition, Type};
use parquet::data_type::{ByteArray, ByteArrayType, Int64Type};
use parquet::file::properties::{WriterProperties, WriterVersion};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type as SchemaType;
use proptest::prelude::*;

use super::*;

fn written(format: Format, columns: &[ColumnKind], values: &[Vec<f64>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = row_writer(format, &mut bytes, columns.to_vec(), values[0].len() as u64).unwrap();
    let half = values[0].len() / 2;
    for part in [0..half, half..values[0].len()] {
        let slices: Vec<&[f64]> = values.iter().map(|column| &column[part.clone()]).collect();
        writer.write(&slices).unwrap();
    }
    writer.finish().unwrap();
    bytes
}

/// All rows of all columns, in blocks of `block`.
fn read(format: Format, bytes: &[u8], kinds: &[ColumnKind], block: usize) -> Result<Vec<Vec<f64>>, RowsError> {
    let mut reader = rows_of_bytes(format, bytes.to_vec())?;
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
    // A NaN is a missing value, whatever its bits.
    let bits = |value: &f64| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() };
    columns.iter().map(|column| column.iter().map(bits).collect()).collect()
}

fn probe() -> ColumnKind {
    let labels = vec![("silicon, doped".to_owned(), 0.0), ("nitride".to_owned(), 7.5)];
    ColumnKind { labels, ..ColumnKind::numbers("probe") }
}

fn optional(name: &str) -> ColumnKind {
    ColumnKind { optional: true, ..ColumnKind::numbers(name) }
}

#[test]
fn labels_are_text_where_there_is_text() {
    let columns = [probe(), optional("y, \"z\"")];
    let values = [vec![7.5, 0.0], vec![f64::NAN, 1e-300]];
    for format in Format::ALL {
        let bytes = written(format, &columns, &values);
        assert_eq!(bits(&read(format, &bytes, &columns, 5).unwrap()), bits(&values), "{format:?}");
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
    let plain = |bytes: &[u8]| read(Format::Npy, bytes, &[], 2).unwrap();
    let data: Vec<u8> = [1.5f32, -2.0, 3.25, 4.0, 5.0, 6.0].iter().flat_map(|x| x.to_be_bytes()).collect();
    let header = "{\"descr\": \">f4\", 'fortran_order': True, 'shape': (3, 2)}\n";
    assert_eq!(plain(&npy(header, &data)), [[1.5, -2.0, 3.25], [4.0, 5.0, 6.0]]);
    let data: Vec<u8> = [-1i16, 300, 2].iter().flat_map(|x| x.to_le_bytes()).collect();
    assert_eq!(plain(&npy("{'descr': '<i2', 'fortran_order': False, 'shape': (3,), }", &data)), [[-1.0, 300.0, 2.0]]);
    assert_eq!(plain(&npy("{'descr': '|b1', 'fortran_order': False, 'shape': (1, 2), }", &[1, 0])), [[1.0], [0.0]]);
}

#[track_caller]
fn refused(format: Format, bytes: &[u8], expected: &str) {
    let message = read(format, bytes, &[optional("a"), probe()], 9).unwrap_err().to_string();
    assert!(message.contains(expected), "no {expected:?} in {message:?}");
}

#[test]
fn whole_numbers_are_text_that_programs_take_for_integers() {
    let columns = [ColumnKind { whole: true, ..ColumnKind::numbers("layers") }, ColumnKind::numbers("x")];
    let values = [vec![4.0, -1e15], vec![4.0, 1e15]];
    let csv = written(Format::Csv, &columns, &values);
    assert_eq!(String::from_utf8(csv.clone()).unwrap(), "layers,x\n4,4.0\n-1000000000000000,1000000000000000.0\n");
    assert_eq!(bits(&read(Format::Csv, &csv, &columns, 5).unwrap()), bits(&values));
}

#[test]
fn faults_are_named_with_their_place() {
    refused(Format::Csv, b"", "the file is empty");
    refused(Format::Csv, b"a,,b\n", "column 2 has no name");
    refused(
        Format::Csv,
        b",a\n0,1\n",
        "column 1 has no name: if it is the index that pandas writes, leave it out (index=False)",
    );
    refused(Format::Csv, b"a;b\n1,5;0\n", "row 1: column `a`: expected a number with a decimal point, not \"1,5\"");
    refused(
        Format::Csv,
        "a,\u{202e}b\n".as_bytes(),
        "the name of column 2: expected a name without control characters",
    );
    refused(Format::Csv, format!("a,{}\n", "b".repeat(1000)).as_bytes(), "the name of column 2: expected at most 200");
    refused(Format::Csv, b"a,b,a\n", "column 3: `a` is also the name of column 1");
    refused(Format::Csv, b"a,b\n1,0\n\n2\n", "line 4: expected 2 cells as in the header, not 1");
    refused(Format::Csv, b"a,b\n1,0\nred,0\n", "row 2: column `a`: expected a number, not \"red\"");
    refused(Format::Csv, b"a,b\n1,3\n", "row 1: column `b`: expected one of silicon, doped, nitride, not \"3\"");
    refused(Format::Parquet, b"a,b\n1,3\n", "not a Parquet file that can be read");
    refused(Format::Npy, b"a,b\n1,3,4,5\n", "not an NPY file that can be read: it does not begin as one");
    refused(Format::Npy, &npy("{'descr': '<c16', 'fortran_order': False, 'shape': (1,)}", &[]), "numbers are \"<c16\"");
    refused(Format::Npy, &npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 1)}", &[]), "3 dimensions");
    let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (18446744073709551615, 2)}";
    refused(Format::Npy, &npy(header, &[0; 7]), "should follow the header, but 7 bytes do");
    let message = Format::of("a.xlsx".as_ref()).unwrap_err().to_string();
    assert_eq!(message, "the ending of the name tells the format: expected .csv, .parquet or .npy, not .xlsx");
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

#[test]
fn other_separators_and_tables_without_names_are_read() {
    for text in ["a;b\n1;7.5\n2;0\n", "a\tb\n1\t7.5\n2\t0\n", "\"a\";\"b\"\r\n1;7.5\r\n2;0"] {
        assert_eq!(read(Format::Csv, text.as_bytes(), &[], 9).unwrap(), [[1.0, 2.0], [7.5, 0.0]], "{text:?}");
    }
    // A comma in quotes is part of a name.
    let quoted = rows_of_bytes(Format::Csv, b"\"a,x\";b\n1;2\n".to_vec()).unwrap();
    assert_eq!(quoted.names().unwrap(), ["a,x", "b"]);
    let mut columns = vec![Vec::new(); 2];
    let wanted = [(0, optional("a")), (1, optional("b"))];
    let numbers = written(Format::Npy, &[optional("a"), optional("b")], &[vec![1.0, 2.0], vec![7.5, 0.0]]);
    for bytes in ["\u{feff}1,7.5\n2,0\n".as_bytes().to_vec(), b"1;7.5\n2;0".to_vec(), numbers.clone()] {
        let mut rows = table_of_bytes(bytes.clone(), &names(&["a", "b"])).unwrap();
        assert_eq!(rows.names().unwrap(), names(&["a", "b"]));
        assert_eq!(rows.read(&wanted, 5, &mut columns).unwrap(), 2);
        assert_eq!(columns, [[1.0, 2.0], [7.5, 0.0]]);
        let message = table_of_bytes(bytes, &names(&["a"])).err().unwrap().to_string();
        assert_eq!(message, "1 names are given, but it has 2 columns");
    }
    assert!(table_of_bytes(numbers, &[]).unwrap().names().is_none());
    let parquet = written(Format::Parquet, &[optional("a")], &[vec![1.0]]);
    let message = table_of_bytes(parquet, &names(&["b"])).err().unwrap().to_string();
    assert_eq!(message, "it names its columns itself (a): leave --names out");
}

#[test]
fn columns_of_text_are_told_from_those_of_numbers() {
    let csv = b"id,a,b,c\n,1,nan,x\nr2,2,red,\n".to_vec();
    let mut rows = rows_of_bytes(Format::Csv, csv).unwrap();
    assert_eq!(rows.text_columns().unwrap(), [0, 2, 3]);
    // Nothing is lost by looking.
    let mut columns = vec![Vec::new()];
    assert_eq!(rows.read(&[(1, optional("a"))], 9, &mut columns).unwrap(), 2);
    assert_eq!((&columns[0][..], rows.line(1), rows.is_unended()), (&[1.0, 2.0][..], Some(3), false));
    let parquet = written(Format::Parquet, &[optional("a"), probe()], &[vec![1.0], vec![7.5]]);
    assert_eq!(rows_of_bytes(Format::Parquet, parquet).unwrap().text_columns().unwrap(), [1]);
}

#[test]
fn a_text_that_may_have_been_cut_short_is_noticed() {
    for (text, unended) in [("a\n1.25\n", false), ("a\n1.25", true), ("a\n1.25\r\n", false), ("a\n", false)] {
        let mut rows = rows_of_bytes(Format::Csv, text.into()).unwrap();
        let mut columns = vec![Vec::new()];
        while rows.read(&[(0, optional("a"))], 9, &mut columns).unwrap() > 0 {}
        assert_eq!(rows.is_unended(), unended, "{text:?}");
    }
}

#[test]
fn names_that_a_spreadsheet_would_run_are_written_as_text_and_come_back() {
    let labels = vec![("+1".to_owned(), 1.0), ("=1+1".to_owned(), 2.0)];
    let columns = [optional("=cmd()"), ColumnKind { labels, ..ColumnKind::numbers("@b") }];
    let values = [vec![-1.5, 2.0], vec![1.0, 2.0]];
    let csv = written(Format::Csv, &columns, &values);
    assert_eq!(String::from_utf8(csv.clone()).unwrap(), "'=cmd(),'@b\n-1.5,+1\n2.0,'=1+1\n");
    assert_eq!(rows_of_bytes(Format::Csv, csv.clone()).unwrap().names().unwrap(), ["=cmd()", "@b"]);
    assert_eq!(read(Format::Csv, &csv, &columns, 5).unwrap(), values);
}

/// A Parquet file of PyArrow with checksums of its pages: `pq.write_table(pa.table({"a": [k / 7 for k in range(1000)]}), path,
/// write_page_checksum=True, use_dictionary=False, compression="none", store_schema=False)`.
const CHECKSUMS: &[u8] = include_bytes!("checksums.parquet");

#[test]
fn pages_of_parquet_are_read_with_their_checksums() {
    let whole = read(Format::Parquet, CHECKSUMS, &[], 300).unwrap();
    assert!(whole[0].iter().enumerate().all(|(k, value)| *value == k as f64 / 7.0) && whole[0].len() == 1000);
    // Anywhere among the numbers: the page begins with its header and levels.
    for number in 0..12 {
        let mut damaged = CHECKSUMS.to_vec();
        damaged[300 + 600 * number] ^= 1 << (number % 8);
        let refused = read(Format::Parquet, &damaged, &[], 300);
        let message = refused.map(|_| "accepted".to_owned()).unwrap_or_else(|error| error.to_string());
        assert!(message.contains("Page CRC checksum mismatch"), "byte {}: {message}", 300 + 600 * number);
    }
}

/// A Parquet file of whole numbers and of the same ones as text, some of them null, in these encodings.
fn delta_encoded(count: usize, of_text: Encoding, version: WriterVersion) -> Vec<u8> {
    let optional = |name: &str, of: Type| {
        Arc::new(SchemaType::primitive_type_builder(name, of).with_repetition(Repetition::OPTIONAL).build().unwrap())
    };
    let fields = vec![optional("a", Type::INT64), optional("b", Type::BYTE_ARRAY)];
    let schema = Arc::new(SchemaType::group_type_builder("schema").with_fields(fields).build().unwrap());
    let properties = WriterProperties::builder()
        .set_dictionary_enabled(false)
        .set_writer_version(version)
        .set_column_encoding("a".into(), Encoding::DELTA_BINARY_PACKED)
        .set_column_encoding("b".into(), of_text);
    let mut file = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties.build())).unwrap();
    let present: Vec<i16> = (0..count).map(|k| i16::from(k % 5 != 3)).collect();
    let numbers: Vec<i64> = (0..count).filter(|k| k % 5 != 3).map(whole).collect();
    let texts: Vec<ByteArray> = numbers.iter().map(|number| number.to_string().as_str().into()).collect();
    let mut group = file.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<Int64Type>().write_batch(&numbers, Some(&present), None).unwrap();
    column.close().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<ByteArrayType>().write_batch(&texts, Some(&present), None).unwrap();
    column.close().unwrap();
    group.close().unwrap();
    file.into_inner().unwrap()
}

fn whole(k: usize) -> i64 {
    (k as i64 * 7919 % 1000) * 1_000_003
}

#[test]
fn differences_in_parquet_are_read_and_their_damage_is_noticed() {
    for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
        for of_text in [Encoding::DELTA_LENGTH_BYTE_ARRAY, Encoding::DELTA_BYTE_ARRAY] {
            for count in [1, 2, 4, 33, 129, 1000] {
                let bytes = delta_encoded(count, of_text, version);
                let found = read(Format::Parquet, &bytes, &[optional("a"), optional("b")], 300).unwrap();
                for (k, (a, b)) in found[0].iter().zip(&found[1]).enumerate() {
                    let expected = if k % 5 == 3 { f64::NAN } else { whole(k) as f64 };
                    assert_eq!(
                        [a.to_bits(), b.to_bits()],
                        [expected.to_bits(); 2],
                        "{version:?} {of_text} {count} {k}"
                    );
                }
                assert_eq!(found[1].len(), count);
            }
            let bytes = delta_encoded(40, of_text, version);
            for place in 0..bytes.len() {
                for change in [0x80, 0xff, 0x7f] {
                    let mut damaged = bytes.clone();
                    damaged[place] ^= change;
                    // Whatever it says: that it says it, and does not ask for memory by the petabyte.
                    let _ = read(Format::Parquet, &damaged, &[optional("a"), optional("b")], 300);
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_number_comes_back_as_the_same_bits(
        values in prop::collection::vec((any::<f64>(), any::<f64>()), 0..20), block in 1usize..25,
    ) {
        let (a, b): (Vec<f64>, Vec<f64>) = values.into_iter().unzip();
        let columns = [optional("a"), optional("b")];
        for format in Format::ALL {
            let bytes = written(format, &columns, &[a.clone(), b.clone()]);
            prop_assert_eq!(bits(&read(format, &bytes, &columns, block).unwrap()), bits(&[a.clone(), b.clone()]));
        }
    }

    #[test]
    fn no_file_panics(bytes in prop::collection::vec(any::<u8>(), 0..80), near in "[a,b\n\r\"0-9.e-]{0,40}") {
        for format in Format::ALL {
            let _ = (read(format, &bytes, &[], 3), read(format, near.as_bytes(), &[probe()], 3));
        }
    }

    #[test]
    fn no_damaged_file_panics(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let columns = [optional("a"), probe()];
        for format in Format::ALL {
            let mut bytes = written(format, &columns, &[vec![1.0, f64::NAN, 3.0], vec![0.0, 7.5, 0.0]]);
            for (place, byte) in &changes {
                let place = place.index(bytes.len());
                bytes[place] = *byte;
            }
            let _ = read(format, &bytes, &columns, 2);
        }
    }
}
