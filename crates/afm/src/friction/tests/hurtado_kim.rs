use super::*;

/// The published form, M log10(abar) + B, in full; 1e-14 because its logarithms cancel.
#[test]
fn agrees_with_the_published_line() {
    let (t1, t2, a1, a2) = (SMALL_STRENGTH, LARGE_STRENGTH, SMALL_RADIUS, LARGE_RADIUS);
    let span = libm::log10(a2 / a1);
    let slope = -libm::log10(t1 / t2) / span;
    let intercept = (libm::log10(t1) * libm::log10(a2) - libm::log10(t2) * libm::log10(a1)) / span;
    assert!((SLOPE - slope).abs() < 1e-15);
    for radius in [28.001, 31.57, 100.0, 1e3, 1e4, 7.99e4] {
        let published = libm::pow(10.0, slope * libm::log10(radius) + intercept);
        assert!((strength(radius) / published - 1.0).abs() < 1e-14, "{radius}");
    }
}

/// Across a breakpoint the strength may change only by rounding: 1e-15 through a power of about one unit roundoff.
#[test]
fn is_continuous_at_both_breakpoints() {
    for edge in [SMALL_RADIUS, LARGE_RADIUS] {
        let (below, above) = (strength(edge.next_down()), strength(edge.next_up()));
        assert!((below / above - 1.0).abs() < 1e-15, "{below} {above}");
    }
}

/// By hand: G* = 2 * 27 * 31.2/58.2 GPa.
#[test]
fn effective_modulus_of_gold_on_oxide() {
    assert!((HurtadoKim(&Scene::default()).shear_modulus() / (1684.8e9 / 58.2) - 1.0).abs() < 1e-15);
}
