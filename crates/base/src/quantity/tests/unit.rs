//! Tests of units.

use proptest::prelude::*;

use super::*;
use crate::quantity::symbols::{Symbol, spellings};

fn unit(text: &str) -> Unit {
    Unit::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_usual_unit_has_its_factor_and_dimension() {
    let expected = [
        (Dimension::LENGTH, 1.0, "m"),
        (Dimension::LENGTH, 1e-3, "mm"),
        (Dimension::LENGTH, 1e-6, "um"),
        (Dimension::LENGTH, 1e-6, "\u{b5}m"),
        (Dimension::LENGTH, 1e-6, "\u{3bc}m"),
        (Dimension::LENGTH, 1e-9, "nm"),
        (Dimension::LENGTH, 1e-12, "pm"),
        (Dimension::SPEED, 1e-9, "nm/s"),
        (Dimension::SPEED, 1e-6, "um/s"),
        (Dimension::SPEED, 1e-3, "mm/s"),
        (Dimension::SPEED, 1.0, "m s^-1"),
        (Dimension::PRESSURE, 1e9, "GPa"),
        (Dimension::PRESSURE, 1e6, "MPa"),
        (Dimension::PRESSURE, 1e3, "kPa"),
        (Dimension::PRESSURE, 1.0, "Pa"),
        (Dimension::PRESSURE, 1.0, "N/m2"),
        (Dimension::PRESSURE, 1.0, "kg/m/s^2"),
        (Dimension::STIFFNESS, 1.0, "J/m2"),
        (Dimension::STIFFNESS, 1.0, "J/m^2"),
        (Dimension::STIFFNESS, 1.0, "J/m**2"),
        (Dimension::STIFFNESS, 1.0, "J/m\u{b2}"),
        (Dimension::STIFFNESS, 1.0, "J m\u{207b}\u{b2}"),
        (Dimension::STIFFNESS, 1e-3, "mJ/m2"),
        (Dimension::STIFFNESS, 1.0, "N/m"),
        (Dimension::STIFFNESS, 1e-3, "mN/m"),
        (Dimension::STIFFNESS, 1.0, "nN/nm"),
        (Dimension::FORCE, 1e-12, "pN"),
        (Dimension::FORCE, 1e-9, " nN "),
        (Dimension::FORCE, 1e-6, "uN"),
        (Dimension::FORCE, 1.0, "N"),
        (Dimension::DAMPING, 1.0, "N s/m"),
        (Dimension::DAMPING, 1.0, "N*s/m"),
        (Dimension::DAMPING, 1.0, "N \u{b7} s / m"),
        (Dimension::DAMPING, 1.0, "N.s/m"),
        (Dimension::DAMPING, 1.0, "Ns/m"),
        (Dimension::DAMPING, 1e-9, "uN ms/m"),
        (Dimension::VISCOSITY, 1e-3, "mPas"),
        (Dimension::ENERGY, 1e-9, "nNm"),
        (Dimension::ANGLE, 1.0, "rad"),
        (Dimension::ANGLE, 1e-3, "mrad"),
        (Dimension::ANGLE, std::f64::consts::PI / 180.0, "deg"),
        (Dimension::ANGLE, std::f64::consts::PI / 180.0, "\u{b0}"),
        (Dimension::DENSITY, 1.0, "kg/m3"),
        (Dimension::DENSITY, 1.0, "kg/m^3"),
        (Dimension::DENSITY, 1e3, "g/cm3"),
        (Dimension::TIME, 1.0, "s"),
        (Dimension::TIME, 1e-3, "ms"),
        (Dimension::TIME, 1e-6, "us"),
        (Dimension::FREQUENCY, 1.0, "1/s"),
        (Dimension::FREQUENCY, 1e3, "kHz"),
        (Dimension::VOLTAGE, 1e-3, "mV"),
        (Dimension::POWER, 1.0, "V A"),
        (Dimension::CURRENT, 1e-12, "pA"),
        (Dimension::CHARGE, 1.0, "A s"),
        (Dimension::RESISTANCE, 1e3, "kohm"),
        (Dimension::RESISTANCE, 1.0, "\u{2126}"),
        (Dimension::VOLTAGE, 1.0, "A \u{3a9}"),
        (Dimension::CAPACITANCE, 1e-9, "nF"),
        (Dimension::CHARGE, 1.0, "F V"),
        (Dimension::FLUX_DENSITY, 1.0, "V s/m2"),
        (Dimension::TEMPERATURE, 1.0, "K"),
        (Dimension::AMOUNT, 1e-3, "mmol"),
        (Dimension::VOLUME, 1e-6, "ml"),
        (Dimension::VOLUME, 1e-3, "L"),
        (Dimension::PRESSURE, 1e5, "bar"),
        (Dimension::PRESSURE, 1e2, "mbar"),
        (Dimension::NUMBER, 1.0, "1"),
        (Dimension::NUMBER, 1.0, ""),
        (Dimension::NUMBER, 1e-2, "%"),
        (Dimension::NUMBER, 1e-6, "um/m"),
        (Dimension::NUMBER, 1e-6, "ppm"),
        (Dimension::NUMBER, 1e-9, "ppb"),
    ];
    for (dimension, factor, text) in expected {
        assert_eq!(unit(text).dimension(), dimension, "{text}");
        assert_eq!(unit(text).to_si(1.0), factor, "{text}");
    }
    let expected = [
        (Dimension::TIME, 60.0, "min"),
        (Dimension::TIME, 3600.0, "h"),
        (Dimension::TIME, 86400.0, "d"),
        (Dimension::TIME, 86400.0, "day"),
        (Dimension::TIME, 31557600.0, "year"),
        (Dimension::SPEED, 1000.0 / 3600.0, "km/h"),
        (Dimension::LENGTH, 1e-10, "angstrom"),
        (Dimension::LENGTH, 1e-10, "\u{212b}"),
        (Dimension::LENGTH, 0.0254, "inch"),
        (Dimension::LENGTH, 0.3048, "ft"),
        (Dimension::VOLUME, 0.028316846592, "ft3"),
        (Dimension::PRESSURE, 6894.757293168361, "psi"),
        (Dimension::PRESSURE, 101325.0, "atm"),
        (Dimension::ENERGY, 3.6e6, "kWh"),
        (Dimension::ENERGY, 1.602176634e-19, "eV"),
        (Dimension::ENERGY, 1.602176634e-22, "meV"),
        // In a product of units a degree is a difference, without an offset.
        (Dimension::TEMPERATURE, 1.0, "degC m/m"),
    ];
    for (dimension, factor, text) in expected {
        assert_eq!(unit(text).dimension(), dimension, "{text}");
        // A product, a quotient and a shift, each rounded.
        assert!((unit(text).to_si(1.0) / factor - 1.0).abs() <= 2.0 * f64::EPSILON, "{text}");
        assert!((unit(text).from_si(factor) - 1.0).abs() <= 2.0 * f64::EPSILON, "{text}");
    }
    assert!(!unit("deg").compatible(&unit("m")));
    assert!(!unit("rad").compatible(&unit("1")));
}

/// The values by definition: 0 degC = 273.15 K = 32 degF, 100 degC = 212 degF.
#[test]
fn degrees_celsius_have_an_offset_but_their_differences_do_not() {
    for (symbol, cases) in [
        ("degC", [(0.0, 273.15), (20.0, 293.15), (-273.15, 0.0), (20.1, 293.25), (100.0, 373.15)]),
        ("\u{b0}F", [(32.0, 273.15), (212.0, 373.15), (-459.67, 0.0), (68.0, 293.15), (-40.0, 233.15)]),
    ] {
        for (value, kelvin) in cases {
            // The zero and the product are each rounded, to half an ulp of numbers up to 700.
            assert!((unit(symbol).to_si(value) - kelvin).abs() <= 2e-13, "{value} {symbol}");
            assert_eq!(unit(symbol).from_si(unit(symbol).to_si(value)), value, "{value} {symbol}");
        }
        assert_eq!(unit(symbol).span_to_si(0.0), 0.0);
        assert!(unit(symbol).compatible(&unit("K")));
    }
    assert_eq!(unit("degC").span_to_si(3.5), 3.5);
    assert_eq!((unit("degF").span_to_si(9.0), unit("degF").span_from_si(5.0)), (5.0, 9.0));
    for text in ["W/m2/degC", "degC/h", "1/degF", "degC2", "degC degC-1 K", "K"] {
        assert!(!unit(text).has_offset(), "{text}");
        assert_eq!(unit(text).to_si(0.0), 0.0, "{text}");
    }
    assert_eq!(unit("kWh/degC").to_si(2.0), 7.2e6);
}

#[test]
fn a_label_is_any_text_and_a_known_unit_stays_one() {
    let label = Unit::label(" EUR/kWh ");
    assert_eq!((label.symbol(), label.to_si(0.3), label.from_si(-2.0)), ("EUR/kWh", 0.3, -2.0));
    assert!(label.compatible(&Unit::label("EUR/kWh")));
    assert!(!label.compatible(&Unit::label("USD")) && !label.compatible(&unit("1")) && !unit("").compatible(&label));
    assert_eq!(Unit::label("nN"), unit("nN"));
    assert_eq!(Unit::label("nN").dimension(), Dimension::FORCE);
}

#[test]
fn unknown_units_are_named_and_corrected() {
    let messages = ["gpa", "nm/fortnight", "Mpa", "furlong/s", "EUR", "N/m s"]
        .map(|input| Unit::parse(input).expect_err(input).to_string());
    insta::assert_snapshot!(messages.join("\n"));
    let odd = [
        "/",
        "m/",
        "/s",
        "m//s",
        "m^",
        "m^x",
        "m0",
        "m^10",
        "2m",
        "10",
        "^2",
        "m\u{2075}",
        "\u{1f41f}",
        "nn",
        "N%",
        "NV",
        "PaS",
        "JK",
        "mmm",
    ];
    for input in odd.into_iter().chain([
        "km9 km9 km9 km9",
        "m-",
        "-",
        "1e3",
        "m^2.5",
        "m9*m9*m9*m9*m9*m9*m9*m9*m9*m9*m9*m9*m9*m9*m9",
    ]) {
        assert!(Unit::parse(input).is_err(), "{input}");
    }
}

#[test]
fn conversions_end_at_the_range_of_numbers() {
    assert_eq!(unit("GPa").to_si(f64::MAX), f64::INFINITY);
    assert_eq!(unit("pm").to_si(f64::NEG_INFINITY), f64::NEG_INFINITY);
    assert!(unit("um").from_si(f64::NAN).is_nan());
    assert_eq!(unit("nm").to_si(5e-324), 0.0);
    assert_eq!(unit("um").to_si(-0.0).to_bits(), (-0.0f64).to_bits());
}

#[test]
fn dimensions_name_themselves() {
    assert_eq!(unit("nm").dimension().to_string(), "a length");
    assert_eq!(unit("mN/m").dimension().to_string(), "a stiffness or surface energy");
    assert_eq!(unit("J s/m4").dimension().to_string(), "a quantity in m^-2 kg s^-1");
    assert_eq!(unit("W/m/K").dimension().to_string(), "a quantity in m kg s^-3 K^-1");
    assert_eq!(unit("uV").dimension().to_string(), "a voltage");
}

#[test]
fn a_unit_survives_json() {
    let typed = unit("\u{b5}m");
    let json = serde_json::to_string(&typed).expect("a string");
    assert_eq!(json, "\"\u{b5}m\"");
    assert_eq!(serde_json::from_str::<Unit>(&json).expect("a unit"), typed);
    assert_eq!(serde_json::from_str::<Unit>("\"parsec\"").expect("a label"), Unit::label("parsec"));
}

proptest! {
    /// The decimal text with the prefix written as an exponent, as the parser reads it, is the exact answer.
    #[test]
    fn typed_numbers_become_the_nearest_and_come_back(digits in 1u64..1_000_000_000_000_000, places in 0i32..30) {
        let value: f64 = format!("{digits}e-{places}").parse().expect("a number");
        for (symbol, decade) in [("pm", -12), ("nm", -9), ("um", -6), ("mm", -3), ("GPa", 9), ("g/cm3", 3)] {
            let nearest: f64 = format!("{digits}e{}", decade - places).parse().expect("a number");
            prop_assert_eq!(unit(symbol).to_si(value), nearest);
            prop_assert_eq!(unit(symbol).from_si(nearest), value);
            prop_assert_eq!(unit(symbol).to_si(-value), -nearest);
        }
    }

    /// Two results rounded to half an ulp, and the decimal number that the first is taken for is as far from it.
    #[test]
    fn conversion_to_si_and_back_is_exact_to_rounding(value in -1e12f64..1e12) {
        for symbol in ["pm", "um", "GPa", "g/cm3", "%", "deg", "mdeg/s"] {
            let unit = unit(symbol);
            let back = unit.from_si(unit.to_si(value));
            prop_assert!((back - value).abs() <= 1.5 * f64::EPSILON * value.abs(), "{} {}", value, symbol);
        }
        // A product and a quotient more each way.
        for symbol in ["h", "km/h", "psi", "eV", "ft3", "degC", "degF"] {
            let unit = unit(symbol);
            let (back, size) = (unit.from_si(unit.to_si(value)), value.abs() + 500.0 * f64::from(unit.has_offset()));
            prop_assert!((back - value).abs() <= 4.0 * f64::EPSILON * size, "{} {}", value, symbol);
            let span = unit.span_from_si(unit.span_to_si(value));
            prop_assert!((span - value).abs() <= 4.0 * f64::EPSILON * value.abs(), "{} {}", value, symbol);
        }
    }

    #[test]
    fn no_text_panics(text in any::<String>(), near in "[munpkMGNPaJradeg0-9 /*^.-]{0,12}") {
        let _ = (Unit::parse(&text), Unit::parse(&near));
    }
}

#[test]
fn every_spelling_is_looked_up_as_the_first_symbol_that_has_it() {
    let mut first: Vec<(String, &Symbol, i32)> = Vec::new();
    for (spelling, symbol, decade) in spellings() {
        if !first.iter().any(|(earlier, ..)| *earlier == spelling) {
            first.push((spelling, symbol, decade));
        }
    }
    for (spelling, symbol, decade) in first {
        let found = lookup(&spelling).unwrap();
        assert!(std::ptr::eq(found[0].0, symbol) || found[0].0.name == symbol.name, "{spelling}");
        assert_eq!(found[0].1, decade, "{spelling}");
    }
}
