//! The numbers in results of claims.

use apportion_report::format::minus;
use apportion_report::{fixed, significant, with_unit};

/// Rounds to three significant digits: the scene's constants justify no more.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Formats an SI value in nano-units, with the unit: `631 nN`.
pub(super) fn nano(value: f64, unit: &str) -> String {
    number(value * 1e9, &format!("n{unit}"))
}

/// Formats a plain number to three significant digits, with its unit if any; a tiny one to two as a power of ten.
pub(super) fn number(value: f64, unit: &str) -> String {
    const TINY: f64 = 1e-4;
    if value != 0.0 && value.abs() < TINY {
        return minus(format!("{value:.1e} {unit}").trim_end());
    }
    minus(&with_unit(rounded(value), unit))
}

/// Formats a share in percent without the sign, to one decimal; two if it is close to 0 or 100 but neither.
pub(super) fn percent_of(share: f64) -> String {
    let close = share > 0.0 && share < 1.0 && !(0.01..=0.99).contains(&share);
    significant(fixed(100.0 * share, if close { 2 } else { 1 }).parse().unwrap_or(f64::NAN))
}

/// Formats a relative change in percent, `1.9 %`; as a power of ten if it is too small.
pub(super) fn change(relative: f64) -> String {
    let percent = 100.0 * relative;
    if percent != 0.0 && percent.abs() < 1e-3 {
        minus(&format!("{percent:.0e} %"))
    } else {
        minus(&with_unit(rounded(percent), "%"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_have_few_digits() {
        assert_eq!(nano(631.3456e-9, "N"), "631 nN");
        assert_eq!(nano(-19.044e-9, "m"), "−19 nm");
        assert_eq!(number(0.209_47, "s"), "0.209 s");
        assert_eq!((number(2.99, ""), number(3.0411e-5, "nN")), ("2.99".into(), "3.0e-5 nN".into()));
        assert_eq!(
            (percent_of(0.8324), percent_of(0.99951), percent_of(1.0)),
            ("83.2".into(), "99.95".into(), "100".into())
        );
        assert_eq!((change(0.019_04), change(0.0), change(3.2e-9)), ("1.9 %".into(), "0 %".into(), "3e-7 %".into()));
    }
}
