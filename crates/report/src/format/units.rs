//! Units as printed: `µm` and `J/m²` for the typed `um` and `J/m2`.

use apportion_base::quantity::Unit;

/// Formats a unit with its printed letters and powers: `um` is `µm`, `J/m2` and `J/m^2` are `J/m²`. Other text is kept.
///
/// ```
/// use apportion_report::format::unit;
/// assert_eq!((unit("um"), unit("mJ/m2"), unit("furlong2")), ("µm".into(), "mJ/m²".into(), "furlong2".into()));
/// ```
pub fn unit(text: &str) -> String {
    if Unit::known(text).is_none() {
        return text.to_owned();
    }
    let mut printed = String::with_capacity(text.len() + 4);
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if c.is_alphabetic() {
            let end = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
            printed.push_str(&symbol(&rest[..end]));
            let (power, after) = power(&rest[end..]);
            printed.push_str(&power);
            rest = after;
        } else {
            printed.push(if c == '*' { '·' } else { c });
            rest = &rest[c.len_utf8()..];
        }
    }
    printed
}

/// Returns a symbol with a true micro sign, if `u` is its prefix.
fn symbol(text: &str) -> String {
    match text.strip_prefix('u').filter(|bare| !bare.is_empty() && Unit::known(bare).is_some()) {
        Some(bare) => format!("µ{bare}"),
        None => match text {
            "deg" => "°".to_owned(),
            "degC" => "°C".to_owned(),
            "degF" => "°F".to_owned(),
            "ohm" => "Ω".to_owned(),
            _ => text.to_owned(),
        },
    }
}

/// Splits off the power that `text` begins with, raised, and returns the rest with it.
fn power(text: &str) -> (String, &str) {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let typed = text.strip_prefix("**").or(text.strip_prefix('^')).unwrap_or(text);
    let digits = typed.strip_prefix('-').unwrap_or(typed);
    let end = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
    if end == 0 {
        return (String::new(), text);
    }
    let sign = if typed.starts_with('-') { "⁻" } else { "" };
    let raised = digits[..end].chars().filter_map(|c| c.to_digit(10)).map(|digit| RAISED[digit as usize]);
    (sign.chars().chain(raised).collect(), &digits[end..])
}
