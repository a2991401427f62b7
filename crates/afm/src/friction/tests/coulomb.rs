use super::*;

#[test]
fn load_and_area_add() {
    let scene = Scene { static_friction: 0.5, shear_strength: 4e6, ..Scene::default() };
    let law = Coulomb(&scene);
    assert_eq!(law.capacity(Pressed { load: 3e-7, radius: 0.0 }), 1.5e-7);
    let of_area = law.capacity(Pressed { load: 0.0, radius: 1e-8 });
    assert!((of_area / (4e-10 * PI) - 1.0).abs() < 1e-15);
    assert_eq!(law.capacity(Pressed { load: 3e-7, radius: 1e-8 }), 1.5e-7 + of_area);
}
