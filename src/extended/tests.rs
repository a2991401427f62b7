//! Against values of mpmath 1.3 at 1400 bits, each the sum of two doubles, and identities.

use super::*;

/// 2^-94: the least accurate, the logarithm near 1, is within 2^-95.
const CLOSE: f64 = 5e-29;

fn close(found: Extended, high: f64, low: f64) {
    let expected = Extended::from(high) + low.into();
    let off = ((found - expected) / expected).abs().value();
    assert!(off < CLOSE, "{} + {}: off by {off:e}", found.value(), (found - found.value().into()).value());
}

fn of(x: f64) -> Extended {
    x.into()
}

#[test]
fn functions_have_31_digits_less_a_few() {
    close(of(0.7).exp(), 2.0137527074704766, -2.0058243549764793e-16);
    close(of(-40.3).exp(), 3.1472582402307286e-18, -1.238307780579342e-34);
    close(of(300.0).exp(), 1.9424263952412558e+130, 1.1143145370175699e+114);
    close(of(1e-09).exp_m1(), 1.0000000005000001e-09, -7.443897403844588e-26);
    close(of(0.3).exp_m1(), 0.3498588075760031, 1.6549155728191776e-17);
    close(of(-20.0).exp_m1(), -0.9999999979388464, 4.1293110494709923e-17);
    close(of(1.0025100392162891).ln(), 0.0025068943292826493, 1.5631536447816544e-19);
    close(of(1e-300).ln(), -690.7755278982137, -2.3670096176709832e-14);
    close(of(7.0).ln(), 1.9459101490553132, 7.323586207904907e-17);
    close(of(1e-12).ln_1p(), 9.999999999995e-13, 2.4217940103012377e-29);
    close(of(0.108).ln_1p(), 0.10255658832509207, -2.9111631870831515e-18);
    close(of(0.5).sin(), 0.479425538604203, -5.103969860556013e-18);
    close(of(1e+22).sin(), -0.8522008497671888, -6.7806825896773284e-18);
    close(of(-7.040359239218146e+216).sin(), -0.27941281771841914, 1.3493030503613074e-17);
    close(of(3.0).cos(), -0.9899924966004454, -4.2060261566099734e-17);
    close(of(1e+300).cos(), -0.5753861119575491, 2.6770761918787068e-17);
    close(of(1.5).tan(), 14.101419947171719, 6.270315165067482e-16);
    close(of(0.3).atan(), 0.2914567944778671, -1.6448555435075034e-17);
    close(of(-1e+20).atan(), -std::f64::consts::FRAC_PI_2, -6.122233995736766e-17);
    close(of(0.9).asin(), 1.1197695149986342, 4.092642558112641e-17);
    close(of(-0.2).acos(), 1.7721542475852274, -1.584909262850069e-17);
    close(of(1e-05).sinh(), 1.0000000000166668e-05, -6.182319396196156e-22);
    close(of(3.0).sinh(), 10.017874927409903, -6.97789774734877e-16);
    close(of(2.0).cosh(), 3.7621956910836314, 7.146584908813439e-17);
    close(of(0.4).tanh(), 0.3799489622552249, 6.3008573143723185e-18);
    close(of(3.0).sqrt(), 1.7320508075688772, 1.0035084221806903e-16);
    close(of(5e-324).sqrt(), 2.2227587494850775e-162, 0.0);
    close(of(10.0).cbrt(), 2.154434690031884, -9.273902111110189e-17);
    close(of(3.0).log2(), 1.584962500721156, 1.0579781240112554e-16);
    close(of(3.0).log10(), 0.47712125471966244, 1.8999057013019158e-18);
    close(of(0.3).powf(of(2.7)), 0.038746045822494066, 2.3072809349773345e-18);
    close(atan2(of(-2.0), of(-3.0)), -2.5535900500422257, 3.5886651473917e-17);
    close(of(1.0) / of(3.0), 0.3333333333333333, 1.850371707708594e-17);
}

#[test]
fn nothing_over_or_underflows_on_the_way() {
    let huge = of(1e300).powi(7);
    assert_eq!((huge.value(), (huge / of(1e300).powi(6)).value()), (f64::INFINITY, 1e300));
    let tiny = of(1e-300).powi(5);
    assert_eq!(tiny.value(), 0.0);
    assert!((tiny * of(1e300).powi(5) - Extended::ONE).abs().value() < 1e-15);
    assert_eq!(of(5e-324).value(), 5e-324);
    assert_eq!((of(5e-324) * of(0.75)).value(), 5e-324);
    assert_eq!(of(f64::MAX).value(), f64::MAX);
    assert_eq!((of(1e5).exp() * of(-1e5).exp()).value(), 1.0);
}

#[test]
fn what_has_no_value_is_not_a_number() {
    for none in [of(-1.0).sqrt(), of(-1.0).ln(), of(-2.0).powf(of(0.5)), Extended::INFINITY - Extended::INFINITY] {
        assert!(none.is_nan() && none.value().is_nan());
    }
    assert_eq!(of(0.0).ln().value(), f64::NEG_INFINITY);
    assert_eq!((Extended::ONE / Extended::ZERO).value(), f64::INFINITY);
    assert!(Extended::NAN.partial_cmp(&Extended::ONE).is_none() && Extended::NAN != Extended::NAN);
    assert!(of(1e-300) < of(1e300) && of(-1.0) < Extended::ZERO && of(2.0) == of(2.0));
}

#[test]
fn whole_numbers_are_found_below_above_and_beside() {
    let cases = [
        (2.5, 2.0, 3.0, 3.0, 2.0),
        (-2.5, -3.0, -2.0, -3.0, -2.0),
        (0.25, 0.0, 1.0, 0.0, 0.0),
        (7.0, 7.0, 7.0, 7.0, 7.0),
    ];
    for (x, floor, ceil, round, even) in cases {
        let found = [of(x).floor(), of(x).ceil(), of(x).round(), of(x).round_ties_even()].map(Extended::value);
        assert_eq!(found, [floor, ceil, round, even], "{x}");
    }
    assert_eq!(of(1e300).floor().value(), 1e300);
}

#[test]
fn bounds_hold_what_rounding_does() {
    // 1e16 + 1 - 1e16 is 0 in doubles: 1 off, and no more than the bound says.
    let [large, one] = [1e16, 1.0].map(Bounded::from);
    let difference = large + one - large;
    assert_eq!(difference.value.value(), 1.0);
    assert!((1.0..8.0).contains(&difference.error.value()));
    // (1e-200)^2 underflows, and 1e300 times it would be 1e-100.
    let small = Bounded::from(1e-200).powi(2) * Bounded::from(1e300);
    assert!((small.value.value() / 1e-100 - 1.0).abs() < 1e-12 && small.error.value() > 1e-100);
    // An overflow leaves no bound, whatever comes after it.
    let over = Bounded::from(1e200).powi(2);
    assert!(!(Bounded::from(1.0) / over).error.is_finite() && !(over - over).error.is_finite());
    // Rounding may turn a comparison of sums, not of inputs.
    let sum = Bounded::from(0.1) + Bounded::from(0.2);
    assert!(!(sum - Bounded::from(0.3)).decides(true).error.is_finite());
    assert!(Bounded::from(0.1).decides(true).error.is_zero());
}
