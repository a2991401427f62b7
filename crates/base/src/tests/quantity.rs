use super::*;

#[test]
fn quantities_are_read_and_written() {
    let read = |text: &str| Quantity::parse(text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(read("225um").to_si(), 225e-6);
    assert_eq!(read("-1.5e-3 GPa").to_si(), -1.5e6);
    assert_eq!(read("+.5 %").to_si(), 0.005);
    assert_eq!(read("3").unit.dimension(), Dimension::NUMBER);
    assert_eq!(read("1e-7 m").to_string(), "1e-7 m");
    assert_eq!(read(" 42 ").to_string(), "42");
    for text in ["", "um", "inf m", "nan", "1e999 m", "1,5 mm", "1 2", "- 1 m", "1_0", "."] {
        assert!(Quantity::parse(text).is_err(), "{text}");
    }
}

proptest::proptest! {
    #[test]
    fn no_text_panics(text in proptest::prelude::any::<String>(), near in "[-+.eE0-9]{0,8} ?[munpkMGNPaJradeg0-9 /*^.-]{0,12}") {
        let _ = (Quantity::parse(&text), Quantity::parse(&near));
    }
}
