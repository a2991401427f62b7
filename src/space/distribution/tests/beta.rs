use super::*;
use crate::space::Distribution;

#[test]
fn a_handful_of_steps_is_enough() {
    let shapes = [1e-3, 0.01, 0.1, 0.5, 1.0, 1.5, 3.0, 10.0, 100.0, 1e3, 1e4, 1e5];
    let mut most = (0, 0.0, 0.0, 0.0);
    for (a, b) in shapes.iter().flat_map(|a| shapes.iter().map(move |b| (*a, *b))) {
        let side = Side::new(a, b);
        let tail = (0..64).map(|power| 0.5f64.powi(power));
        let body = (1..100).map(|step| f64::from(step) / 100.0);
        for part in tail.chain(body).chain([Distribution::LARGEST_U]) {
            let p = part * side.mass;
            if p < Distribution::SMALLEST_U {
                continue;
            }
            let (_, steps) = side.distance(p);
            if steps > most.0 {
                most = (steps, a, b, part);
            }
        }
    }
    assert!(most.0 <= 5, "{most:?}");
}
