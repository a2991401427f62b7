use super::*;

#[test]
fn names_are_plain_and_of_bounded_length() {
    for name in ["x1", "Kraft in µN", "力", "a-b_c.d", "=x", "קלט"] {
        assert_eq!(refused_output_name(name), None, "{name}");
    }
    let long = "x".repeat(LONGEST_NAME + 1);
    for name in ["", "  ", "a\nb", "a\u{202e}b", "a\u{200b}", "\u{feff}x", "a\u{2028}b", &long] {
        assert!(refused_name(name).is_some(), "{name:?}");
    }
    for name in ["x/../../evil", "..\\evil", "c:evil"] {
        assert!(refused_name(name).is_none() && refused_output_name(name).is_some(), "{name}");
    }
    assert!(refused_title("two\nlines").is_none() && refused_title(&"t".repeat(LONGEST_TITLE + 1)).is_some());
    assert!(shown(&long).len() < 100);
}

#[test]
fn near_names_are_suggested_and_far_ones_are_not() {
    let known = ["length", "width", "thickness", "height"];
    assert_eq!(nearest("lenght", known).as_deref(), Some("length"));
    assert_eq!(nearest("Width", known).as_deref(), Some("width"));
    assert_eq!(nearest("temperature", known), None);
    // Names of 50,000 letters once took half a minute.
    let long = "x".repeat(50_000);
    assert_eq!(nearest(&long[1..], [long.as_str(), "width"]), None);
    assert_eq!(nearest("widht", [long.as_str(), "width"]).as_deref(), Some("width"));
}
