//! Descriptions of curves.

use apportion_report::format::three_digits as short;

/// Relative change below which it is rounding.
const ROUNDING: f64 = 1e-6;
/// Relative change below which it is reported as small.
const SMALL: f64 = 1e-2;
/// Distance from the chord, as a part of the change, up to which a curve is called straight.
const STRAIGHT: f64 = 0.02;

/// Describes a force (nN) over rising `x` (in `x_unit`, with a leading space), such as "falls from 9 to 1 nN (half of the
/// way by 3 um)", for use after the name of the force. A missing force is not finite. `whom`, such as " under Coulomb
/// friction", follows the values.
pub(super) fn course(x: &[f64], force: &[f64], x_unit: &str, whom: &str) -> String {
    let points = x.iter().copied().zip(force.iter().copied());
    let points: Vec<(f64, f64)> = points.filter(|(_, force)| force.is_finite()).collect();
    let (Some(&(_, first)), Some(&(_, last))) = (points.first(), points.last()) else {
        return format!("does not exist{whom}");
    };
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.1), h.max(p.1)));
    let size = low.abs().max(high.abs());
    if high - low <= ROUNDING * size {
        return format!("stays at {} nN{whom}", short(first));
    }
    let slack = ROUNDING * (high - low);
    let rises = points.windows(2).all(|p| p[1].1 >= p[0].1 - slack);
    let falls = points.windows(2).all(|p| p[1].1 <= p[0].1 + slack);
    let verb = if rises { "rises" } else { "falls" };
    if !rises && !falls {
        return format!("lies between {} and {} nN{whom}", short(low), short(high));
    }
    if high - low <= SMALL * size {
        return format!("{verb} by {} % from {} nN{whom}", short(100.0 * (high - low) / size), short(first));
    }
    format!("{verb} from {} to {} nN{whom}{}", short(first), short(last), shape(&points, x_unit))
}

/// Describes how the change of a monotonic curve is distributed over the points.
fn shape(points: &[(f64, f64)], x_unit: &str) -> String {
    let ((x0, y0), (x1, y1)) = (points[0], points[points.len() - 1]);
    let chord = |x: f64| y0 + (y1 - y0) * (x - x0) / (x1 - x0);
    let bend = points.iter().map(|(x, y)| ((y - chord(*x)) / (y1 - y0)).abs()).fold(0.0, f64::max);
    if bend <= ROUNDING {
        return " (in a straight line)".to_owned();
    }
    if bend <= STRAIGHT {
        return format!(" (in a straight line to within {} % of the change)", short(100.0 * bend));
    }
    match crossing(points, 0.5 * (y0 + y1)) {
        Some(x) => format!(" (half of the way by {}{})", short(x), x_unit),
        None => String::new(),
    }
}

/// Returns the first position at which a line through the points has the value `level`.
pub(super) fn crossing(points: &[(f64, f64)], level: f64) -> Option<f64> {
    points.windows(2).find_map(|pair| {
        let ((xa, a), (xb, b)) = ((pair[0].0, pair[0].1 - level), (pair[1].0, pair[1].1 - level));
        if a == 0.0 {
            return Some(xa);
        }
        (a.signum() != b.signum() && a.is_finite() && b.is_finite()).then(|| xa + (xb - xa) * a / (a - b))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(f: impl Fn(f64) -> f64) -> String {
        let x: Vec<f64> = (0..=1000).map(|i| 1.0 + f64::from(i) / 1000.0).collect();
        let y: Vec<f64> = x.iter().map(|x| f(*x)).collect();
        super::course(&x, &y, " um", "")
    }

    #[test]
    fn curves_are_described_by_their_course() {
        assert_eq!(course(|x| 100.0 * x), "rises from 100 to 200 nN (in a straight line)");
        // Half of the change: x^3 from 1 to 8 at 4.5^(1/3) = 1.651; x^-2 from 1 to 1/4 at 1/sqrt(0.625) = 1.265.
        assert_eq!(course(|x| x.powi(3)), "rises from 1.00 to 8.00 nN (half of the way by 1.65 um)");
        assert_eq!(course(|x| x.powi(-2)), "falls from 1.00 to 0.250 nN (half of the way by 1.26 um)");
        assert_eq!(course(|_| 631.0), "stays at 631 nN");
        assert_eq!(course(|x| 100.0 + 0.5 * x), "rises by 0.495 % from 100 nN");
        assert_eq!(course(|x| libm::sin(6.0 * x)), "lies between \u{2212}1.00 and 1.00 nN");
        assert_eq!(course(|_| f64::NAN), "does not exist");
        assert!(course(|x| x + 0.02 * x * x).contains("in a straight line to within 0.472 % of the change"));
    }

    #[test]
    fn crossings_and_lists() {
        assert_eq!(crossing(&[(0.0, 1.0), (2.0, 3.0)], 2.0), Some(1.0));
        assert_eq!(crossing(&[(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0)], 2.0), None);
    }
}
