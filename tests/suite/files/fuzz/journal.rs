//! Journals of runs.

use std::path::Path;

use apportion::run::journal::{JournalProblem, read_journal};

/// The header of a journal without anything in it.
const HEADER: &[u8] = b"apportion journal\x01\0\0\0\x02\0\0\0\x43\xbf\xa6\xa3{}";

/// Bytes are refused with the file and a reason, or every block that is read is complete. They are read as a journal, and as
/// the body of a record with the right checksum, which no fuzzer would find.
pub fn run(bytes: &[u8]) {
    read(bytes);
    let length = (bytes.len() as u32).to_le_bytes();
    let checksum = crc32([&length, bytes].concat().as_slice()).to_le_bytes();
    let whole = [HEADER, &length, &checksum, bytes].concat();
    assert_eq!(crc32(b"{}").to_le_bytes(), HEADER[25..29], "the header is right");
    read(&whole);
}

fn read(bytes: &[u8]) {
    match read_journal(Path::new("fuzz.journal"), bytes) {
        Err(error) => {
            assert!(!matches!(error.problem, JournalProblem::InUse));
            assert!(error.to_string().starts_with("fuzz.journal: "), "{error}");
        }
        Ok(contents) => {
            assert_eq!(contents.length + contents.cut_off, bytes.len() as u64);
            for block in &contents.blocks {
                assert!(block.first.checked_add(block.rows(1)).is_some());
            }
        }
    }
}

/// CRC-32 bit by bit, as ISO 3309 has it.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0_u32, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}
