use super::*;

#[test]
fn shear_modulus_follows_young_unless_given() {
    let scene = Scene::default();
    // 169 GPa / 2.54, by hand.
    assert!((scene.effective_shear_modulus() / 66.535_433e9 - 1.0).abs() < 1e-8);
    let given = Scene { shear_modulus: Some(40.5e9), ..scene };
    assert_eq!(given.effective_shear_modulus(), 40.5e9);
}
