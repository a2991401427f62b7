use std::collections::HashSet;

use super::*;

#[test]
fn the_main_factors_come_first() {
    let symbols: Vec<_> = Parameter::ALL[..8].iter().map(|parameter| parameter.symbol).collect();
    assert_eq!(symbols, ["L", "w", "t", "H", "V", "E", "K", "omega"]);
}

#[test]
fn names_and_symbols_are_unique() {
    let names: HashSet<_> = Parameter::ALL.iter().map(|parameter| parameter.name).collect();
    let symbols: HashSet<_> = Parameter::ALL.iter().map(|parameter| parameter.symbol).collect();
    assert_eq!((names.len(), symbols.len()), (Parameter::ALL.len(), Parameter::ALL.len()));
}

#[test]
fn set_then_get_gives_the_value_back_and_moves_nothing_else() {
    // Those with a derived value are fixed first, since they follow others unless set.
    let before = Scene { shear_modulus: Some(1.0), tip_mass: Some(1.0), tip_inertia: Some(1.0), ..Scene::default() };
    for parameter in Parameter::ALL {
        let mut scene = before;
        (parameter.set)(&mut scene, 0.123);
        let moved: Vec<_> =
            Parameter::ALL.iter().filter(|p| (p.get)(&scene) != (p.get)(&before)).map(|p| p.name).collect();
        assert_eq!(moved, [parameter.name]);
        assert_eq!((parameter.get)(&scene), 0.123);
    }
}

/// Each parameter alone, set to each value outside its domain: this also proves that the quick check covers the
/// table.
#[test]
fn every_parameter_is_checked_and_named() {
    for parameter in Parameter::ALL {
        let outside = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 0.6, 2.0];
        for value in outside.into_iter().filter(|&value| !parameter.domain.contains(value)) {
            let mut scene = Scene::default();
            (parameter.set)(&mut scene, value);
            let expected = Failure::OutOfDomain { parameter: parameter.name, domain: parameter.domain };
            assert_eq!(scene.check(), Err(expected), "{} = {value}", parameter.name);
        }
    }
}

#[test]
fn nothing_inside_a_domain_is_refused() {
    for parameter in Parameter::ALL {
        for value in [0.0, 1e-300, 0.4, 0.5, 1.5, 1e300].into_iter().filter(|&v| parameter.domain.contains(v)) {
            let mut scene =
                Scene { shear_modulus: Some(1.0), tip_mass: Some(1.0), tip_inertia: Some(1.0), ..Scene::default() };
            (parameter.set)(&mut scene, value);
            assert_eq!(scene.check(), Ok(()), "{} = {value}", parameter.name);
        }
    }
}
