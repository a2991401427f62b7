//! Numbers and units as people read them.

use apportion_report::fixed;
use apportion_report::format::{
    chance, change, count, force, grouped, short, short_among, short_with_unit, significant, three_digits, unit, value,
};

#[test]
fn numbers_read_as_people_write_them() {
    assert_eq!(significant(489.404_123), "489.404");
    assert_eq!(significant(0.0), "0");
    assert_eq!(significant(1.5e-9), "1.5e-9");
    assert_eq!(significant(-12_345_678.0), "-12345678");
    assert_eq!(significant(100.0), "100");
    assert_eq!(significant(0.001), "0.001");
    assert_eq!(fixed(-0.00001, 4), "0.0000");
    assert_eq!(fixed(-0.5, 1), "-0.5");
    let chances = [None, Some(0.0), Some(1e-5), Some(0.25), Some(0.9999), Some(1.0)].map(chance);
    assert_eq!(chances, ["-", "< 0.001", "< 0.001", "0.250", "> 0.999", "> 0.999"]);
}

#[test]
fn values_in_tables_and_sentences() {
    assert_eq!(short(1234.567), "1235");
    assert_eq!(short_with_unit(-0.012_346, "nN"), "-0.01235 nN");
    assert_eq!(value(-0.012_346, "nN"), "−0.01235 nN");
    assert_eq!(short(0.0), "0");
    assert_eq!((short(3.072e-5), short(-1e-12)), ("0.00003072".to_owned(), "-1e-12".to_owned()));
    assert_eq!(short_with_unit(2.5, "1"), "2.5");
    assert_eq!([1_000.000_123, 1_000.000_987].map(|x| short_among(x, 8.64e-4)), ["1000.000123", "1000.000987"]);
    assert_eq!((short_among(1234.567, 900.0), short_among(5.0, 0.0)), ("1235".to_owned(), "5".to_owned()));
    assert_eq!(grouped(655_360), "655\u{202f}360");
    assert_eq!((grouped(1024), grouped(1_048_576)), ("1024".to_owned(), "1\u{202f}048\u{202f}576".to_owned()));
    assert_eq!((count(1, "run", "runs"), count(2, "run", "runs")), ("one run".to_owned(), "2 runs".to_owned()));
}

#[test]
fn three_digits_are_three() {
    let cases = [
        (0.0, "0"),
        (-0.0, "0"),
        (0.131_27, "0.131"),
        (630.96, "631"),
        (-26.9, "\u{2212}26.9"),
        (9.996, "10.0"),
        (123_456.0, "123456"),
        (1.5e-7, "1.50e-7"),
        (1e300, "1.00e300"),
        (f64::NAN, "\u{2013}"),
    ];
    for (value, text) in cases {
        assert_eq!(three_digits(value), text, "{value}");
    }
    assert_eq!(force(631.2e-9), "631 nN");
    assert_eq!(change(0.0123).as_deref(), Some("+1.23 %"));
    assert_eq!(change(-0.5).as_deref(), Some("\u{2212}50.0 %"));
    assert_eq!(change(-5e-7).as_deref(), Some("less than 0.001 % (down)"));
    assert_eq!(change(f64::NAN), None);
}

#[test]
fn units_are_those_of_print() {
    let cases = [
        ("um", "µm"),
        ("um/s", "µm/s"),
        ("J/m2", "J/m²"),
        ("g/cm^3", "g/cm³"),
        ("N*m", "N·m"),
        ("s^-1", "s⁻¹"),
        ("deg", "°"),
        ("degC", "°C"),
        ("1", "1"),
        ("", ""),
        ("%", "%"),
        ("umbrellas2", "umbrellas2"),
    ];
    for (typed, printed) in cases {
        assert_eq!(unit(typed), printed, "{typed}");
    }
}
