use super::*;

#[test]
fn cells_are_not_read_as_formulas() {
    for (text, field) in [
        ("=HYPERLINK(\"http://x\",\"y\")", "\"'=HYPERLINK(\"\"http://x\"\",\"\"y\"\")\""),
        ("+x", "'+x"),
        ("-a", "'-a"),
        ("@SUM(1)", "'@SUM(1)"),
        ("# 1", "'# 1"),
        ("-1.5e-3", "-1.5e-3"),
        ("+4", "+4"),
        ("a-b", "a-b"),
    ] {
        assert_eq!(csv_field(text), field);
        let inert = inert(text.to_owned());
        assert_eq!(plain_field(&inert), text);
    }
    assert_eq!(plain_field("'quoted'"), "'quoted'");
}

#[test]
fn numbers_are_masked_and_names_are_not() {
    assert_eq!(masked("  no root at t=-1.5e-3, x2 = 7.\n"), "no root at t=#, x2 = #");
    assert_eq!(masked("1.0,2,-3E+5"), "#,#,#");
    assert_eq!(masked("float32 and a1b2"), "float32 and a1b2");
}

#[test]
fn long_words_are_cut_and_stay_on_one_line() {
    let long = shortened(&"wörd\t".repeat(100));
    assert_eq!(long.chars().count(), MAX_LETTERS + 3);
    assert!(!long.contains('\t') && long.ends_with("..."));
}

proptest::proptest! {
    #[test]
    fn no_text_panics(text in proptest::prelude::any::<String>()) {
        let masked = masked(&text);
        proptest::prop_assert!(masked.chars().count() <= MAX_LETTERS + 3 && !masked.chars().any(char::is_control));
    }
}
