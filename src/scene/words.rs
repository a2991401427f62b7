//! Numbers in sentences.

/// A number with three significant digits and a typographic minus; a dash if it is not finite.
pub(crate) fn short(value: f64) -> String {
    const DIGITS: i32 = 3;
    if !value.is_finite() {
        return "\u{2013}".to_owned();
    }
    // The exponent after rounding: 9.996 is 10.0, not 10.00.
    let scientific = format!("{value:.*e}", DIGITS as usize - 1);
    let exponent = scientific.split_once('e').and_then(|(_, e)| e.parse::<i32>().ok()).unwrap_or(0);
    let text = match exponent {
        _ if value == 0.0 => "0".to_owned(),
        -3..=5 => format!("{value:.*}", (DIGITS - 1 - exponent).max(0) as usize),
        _ => scientific,
    };
    text.replace('-', "\u{2212}")
}

/// A time in s.
pub(crate) fn time(seconds: f64) -> String {
    format!("{} s", short(seconds))
}

/// A force in N, said in nN.
pub(crate) fn force(newtons: f64) -> String {
    format!("{} nN", short(newtons * 1e9))
}

/// A length in m, said in nm.
pub(crate) fn length(metres: f64) -> String {
    format!("{} nm", short(metres * 1e9))
}

/// A change as a part, said in percent with its sign; its direction alone where it is too small to be read; `None` if it is
/// not finite.
pub(super) fn change(part: f64) -> Option<String> {
    const LEAST: f64 = 1e-3;
    let percent = 100.0 * part;
    if percent != 0.0 && percent.abs() < LEAST {
        return Some(format!("less than {LEAST} % ({})", if percent > 0.0 { "up" } else { "down" }));
    }
    let sign = if part > 0.0 { "+" } else { "" };
    part.is_finite().then(|| format!("{sign}{} %", short(percent)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (0.131_27, "0.131"),
            (630.96, "631"),
            (-26.9, "\u{2212}26.9"),
            (9.996, "10.0"),
            (123_456.0, "123456"),
            (1.5e-7, "1.50e\u{2212}7"),
            (1e300, "1.00e300"),
            (f64::NAN, "\u{2013}"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text, "{value}");
        }
        assert_eq!(force(631.2e-9), "631 nN");
        assert_eq!(change(0.0123).as_deref(), Some("+1.23 %"));
        assert_eq!(change(-0.5).as_deref(), Some("\u{2212}50.0 %"));
        assert_eq!(change(-5e-7).as_deref(), Some("less than 0.001 % (down)"));
        assert_eq!(change(f64::NAN), None);
    }
}
