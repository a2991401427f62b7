use super::*;

const PAIR: Pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };

/// By hand: R F/K = 50e-9 * 4.8e-7/60e9 = 4e-25 m^3, and (4e-25)^(1/3) = 7.3680630 nm.
#[test]
fn by_hand() {
    let contact = contact(&PAIR, 4.8e-7).unwrap();
    assert!((contact.radius / 7.368_063_0e-9 - 1.0).abs() < 1e-8);
    assert!((contact.indentation / 1.085_767_1e-9 - 1.0).abs() < 1e-7);
}
