use super::*;

#[test]
fn a_stream_is_read_to_its_end_and_not_further_than_it_may() {
    let mut bytes = Vec::new();
    read_at_most(&mut &b"abc"[..], 3, &mut bytes).unwrap();
    assert_eq!(bytes, b"abc");
    let error = read_at_most(&mut std::io::repeat(0), 3 << 20, &mut Vec::new()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::FileTooLarge);
    assert!(error.to_string().contains("exceeds 3 MiB or has no end"), "{error}");
}

#[test]
fn files_are_read_completely_and_text_must_be_utf_8() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("text");
    std::fs::write(&path, "µ").unwrap();
    assert_eq!(read_text(&path).unwrap(), "µ");
    std::fs::write(&path, b"\xff").unwrap();
    assert_eq!(read_text(&path).unwrap_err().kind(), ErrorKind::InvalidData);
    std::fs::write(&path, b"a\nb\nc\xff\n").unwrap();
    assert_eq!(read_text(&path).unwrap_err().to_string(), "line 3 is not text in UTF-8: save it as UTF-8");
    assert_eq!(read_whole(&path).unwrap(), b"a\nb\nc\xff\n");
    assert!(read_whole(folder.path()).is_err());
    assert_eq!(read_whole(&folder.path().join("none")).unwrap_err().kind(), ErrorKind::NotFound);
}
