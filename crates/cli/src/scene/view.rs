//! The magnification in the animation: motions of nanometres next to bodies of micrometres would be invisible.

use serde_json::{Value, json};

use super::{SceneSample, SceneStory};

/// The factors by which displacements are drawn larger (above 1) or smaller (below 1) than the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct View {
    /// Twist and lateral displacement in the picture of the probe.
    pub probe: f64,
    /// Travel of particle and substrate in the picture of the particle.
    pub travel: f64,
}

impl View {
    /// Chooses factors with which the probe leans by at most 0.25 rad (or a quarter of its height) and the particle
    /// moves at most 0.8 of its radius.
    pub fn new(story: &SceneStory) -> Self {
        let largest = |read: fn(&SceneSample) -> f64| {
            let sizes = story.samples.iter().map(|sample| read(sample).abs()).filter(|size| size.is_finite());
            sizes.fold(0.0, f64::max)
        };
        let lean = largest(|s| s.twist).max(largest(|s| s.lateral_deflection) / story.scene.height);
        let particle = largest(|s| s.particle);
        let travel = if particle > 0.0 { particle } else { largest(|s| s.substrate) };
        Self { probe: round_below(0.25 / lean), travel: round_below(0.8 * story.scene.particle_radius / travel) }
    }

    /// Returns the factors for the page's script.
    pub fn value(self) -> Value {
        json!({ "probe_factor": self.probe, "travel_factor": self.travel })
    }

    /// States the factors in a sentence.
    pub fn sentence(self) -> String {
        format!(
            "Bodies are drawn to scale in each picture; twist and displacements of the probe are {}, the travel of particle \
             and substrate is {}.",
            factor(self.probe),
            factor(self.travel)
        )
    }
}

fn factor(factor: f64) -> String {
    let times = |times: f64| if times < 1e6 { format!("{times} times") } else { format!("{times:e} times") };
    if factor == 1.0 {
        "to scale".to_owned()
    } else if factor > 1.0 {
        format!("exaggerated {}", times(factor))
    } else {
        format!("reduced {}", times((1.0 / factor).round()))
    }
}

/// Returns the largest of 1, 2, 5, 10, 20, ... (or their inverses) not above `limit`; 1 if the limit is not positive.
fn round_below(limit: f64) -> f64 {
    // Beyond these powers nothing is visible, and products with coordinates could overflow.
    let decade = libm::log10(limit).floor();
    if !(-100.0..=100.0).contains(&decade) {
        return 1.0;
    }
    // 1, 2 and 5, or one over 5, 2 and 1 of the next decade: both have round inverses.
    let power = 10f64.powi(decade as i32);
    let step = [5.0, 2.0].into_iter().find(|step| step * power <= limit).unwrap_or(1.0);
    step * power
}

#[cfg(test)]
mod tests {
    use super::super::nominal_story;
    use super::*;

    #[test]
    fn factors_are_round_and_below_their_limit() {
        for (limit, factor) in [(247.0, 200.0), (3.05, 2.0), (1.0, 1.0), (0.7, 0.5), (0.02, 0.02), (9.99, 5.0)] {
            assert!((round_below(limit) / factor - 1.0).abs() < 1e-12, "{limit}: {}", round_below(limit));
        }
        for limit in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200] {
            assert_eq!(round_below(limit), 1.0, "{limit}");
        }
    }

    #[test]
    fn the_nominal_scene_is_seen() {
        let view = View::new(&nominal_story());
        assert_eq!(view, View { probe: 200.0, travel: 2.0 });
        assert!(view.sentence().contains("exaggerated 200 times"), "{}", view.sentence());
        assert_eq!(factor(0.02), "reduced 50 times");
        assert_eq!(factor(2e9), "exaggerated 2e9 times");
    }
}
