use super::*;

#[test]
fn every_name_has_its_place() {
    let noise = NoiseLayout::new(0, &[vec![0], vec![1], vec![0, 1]]);
    let layout = Layout {
        dummy: true,
        estimators: vec![Estimator::Jansen, Estimator::Azzini],
        second_order: true,
        noise: Some(noise),
        shapley: true,
        ..Layout::plain(3)
    };
    let all = [&layout, &Layout::plain(2), &Layout { noise: None, ..layout.clone() }];
    for layout in all {
        for (place, name) in layout.names().into_iter().enumerate() {
            assert_eq!(layout.place(name), place, "{name:?}");
        }
    }
}
