//! The animation on paper: a film strip of the scene at a few instants (TS04 figure 14).

use std::f64::consts::PI;

use super::charts::SUBSTRATE;
use super::view::View;
use super::{SceneGeometry, SceneSample, SceneStory};
use apportion::report::chart::{Chart, Colour, FilmStrip, Look, Sketch};
use apportion::report::format::{force, length, time};

/// A film strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The drawn frames.
    pub chart: Chart,
    /// What each shows: the state of the scene at its instant.
    pub frames: Vec<SceneSample>,
}

const EDGE: &str = "#4a5560";
const PROBE: Look = Look { fill: "#e6eaee", stroke: EDGE, width: 1.2, dash: "none" };
const GOLD: Look = Look { fill: "#f1e6c8", stroke: "#8a6d1f", width: 1.2, dash: "none" };
const GROUND: Look = Look::area("#ececec");
const SURFACE: Look = Look::line("#6d6d6d", 1.2);
const GHOST: Look = Look { fill: "none", stroke: "#9a9a9a", width: 1.0, dash: "3 3" };
const INK: &str = "#222222";
/// Height of the picture of the probe, as a part of a frame's width.
const PROBE_PART: f64 = 0.36;
/// Height of the picture of the particle, likewise.
const PARTICLE_PART: f64 = 0.62;

/// Draws the story at six instants: at its start, half way to the slip, at the slip, and thrice after it; at equal
/// distances in time if it holds no slip. Each frame shows the end of the probe from the front and, below, the particle
/// under the tip with the tip force; motions are exaggerated as in the animation, which the caption states.
pub fn film_strip(story: &SceneStory) -> Film {
    let instants = instants(story);
    let frames: Vec<SceneSample> = instants.iter().filter_map(|(at, _)| state(story, *at)).collect();
    let view = View::of(story);
    let heads = frames.iter().zip(&instants).map(|(frame, (_, what))| {
        let moved = frame.relative_position;
        let moved = if moved == 0.0 { String::new() } else { format!(", moved {}", length(moved)) };
        (format!("{}: {what}", time(frame.time)), format!("F_T = {}{moved}", force(frame.tip_force)))
    });
    let strip = FilmStrip {
        title: "The scene in motion".to_owned(),
        caption: caption(story, view),
        description: "Frames with the end of the cantilever seen from the front, its tip, and below them the particle \
                      between tip and substrate with an arrow for the tip force."
            .to_owned(),
        frames: heads.collect(),
        columns: (3, 2),
        aspect: PROBE_PART + PARTICLE_PART,
    };
    let strongest = story.samples.iter().map(|s| s.tip_force).filter(|f| f.is_finite()).fold(0.0, f64::max);
    let stage = Stage { geometry: &story.geometry, view, push: story.colour.hex(), strongest };
    let chart = strip.chart(|number, sketch| {
        let (width, height) = (sketch.width, sketch.height);
        let split = (height * PROBE_PART / (PROBE_PART + PARTICLE_PART)).round();
        sketch.window((0.0, 0.0), (width, split - 4.0), |sketch| stage.probe(&frames[number], number == 0, sketch));
        sketch.window((0.0, split), (width, height - split), |sketch| {
            stage.particle(&frames[number], number == 0, sketch)
        });
    });
    Film { chart, frames }
}

/// When the frames are taken, and what each shows.
fn instants(story: &SceneStory) -> Vec<(f64, &'static str)> {
    let (Some(first), Some(last)) = (story.samples.first(), story.samples.last()) else { return Vec::new() };
    let (start, end) = (first.time, last.time);
    match slip_sample(story).map(|sample| sample.time) {
        Some(slip) => {
            let after = |part: f64| slip + part * (end - slip);
            vec![
                (start, "the start"),
                (0.5 * (start + slip), "sticking"),
                (slip, "the slip"),
                (after(1.0 / 3.0), "slipping"),
                (after(2.0 / 3.0), "slipping"),
                (end, "slipping"),
            ]
        }
        None => (0..6).map(|i| (start + f64::from(i) / 5.0 * (end - start), "sticking")).collect(),
    }
}

/// The last sample that sticks, if the story goes on to slip.
fn slip_sample(story: &SceneStory) -> Option<&SceneSample> {
    story.slip().and_then(|_| story.samples.iter().rfind(|sample| !sample.slipping))
}

/// The state at a time between the first and the last sample, straight between neighbours, of whose flags it has those
/// of the earlier; at a time with two samples the first.
fn state(story: &SceneStory, at: f64) -> Option<SceneSample> {
    let after = story.samples.iter().position(|sample| sample.time >= at)?;
    let b = story.samples[after];
    let a = story.samples[after.saturating_sub(1)];
    let share = if b.time > a.time { (at - a.time) / (b.time - a.time) } else { 1.0 };
    let mix = |read: fn(&SceneSample) -> f64| {
        // At either end its very value.
        if share == 1.0 { read(&b) } else { read(&a) + share * (read(&b) - read(&a)) }
    };
    Some(SceneSample {
        time: at,
        lateral_force: mix(|s| s.lateral_force),
        normal_force: mix(|s| s.normal_force),
        tip_force: mix(|s| s.tip_force),
        force_angle: mix(|s| s.force_angle),
        twist: mix(|s| s.twist),
        base_lateral: mix(|s| s.base_lateral),
        deflection: mix(|s| s.deflection),
        substrate_position: mix(|s| s.substrate_position),
        particle_position: mix(|s| s.particle_position),
        relative_position: mix(|s| s.relative_position),
        substrate_contact_radius: mix(|s| s.substrate_contact_radius),
        substrate_indentation: mix(|s| s.substrate_indentation),
        tip_contact_radius: mix(|s| s.tip_contact_radius),
        tip_indentation: mix(|s| s.tip_indentation),
        ..if share == 1.0 { b } else { a }
    })
}

fn caption(story: &SceneStory, view: View) -> String {
    let exaggeration = view.clause();
    let (Some(first), Some(last)) = (story.samples.first(), story.samples.last()) else {
        return "The story holds no sample.".to_owned();
    };
    match slip_sample(story) {
        Some(slip) => format!(
            "Particle and tip ride on the substrate for {} until the slip, then stand still while it moves on by {}; \
             bodies are to scale in each picture, {exaggeration}.",
            length(slip.particle_position - first.particle_position),
            length(slip.relative_position - last.relative_position),
        ),
        None => format!(
            "Particle and tip ride on the substrate for {} without a slip; bodies are to scale in each picture, \
             {exaggeration}.",
            length(last.particle_position - first.particle_position),
        ),
    }
}

/// What all frames share.
struct Stage<'a> {
    geometry: &'a SceneGeometry,
    view: View,
    push: &'static str,
    /// The largest tip force (N).
    strongest: f64,
}

impl Stage<'_> {
    /// The end of the cantilever from the front.
    fn probe(&self, frame: &SceneSample, named: bool, sketch: &mut Sketch) {
        let (width, height) = (sketch.width, sketch.height);
        let &SceneGeometry { height: tall, width: wide, thickness, .. } = self.geometry;
        let ground = height - 10.0;
        // The end of a bar that leans by a quarter of a radian, the most there is, stays in the picture too.
        let scale = ((ground - 10.0) / (tall + thickness + 0.25 * 0.5 * wide)).min(0.86 * width / wide);
        let (tall, half, thick) = (tall * scale, 0.5 * wide * scale, (thickness * scale).max(2.0));
        sketch.path(&[(0.0, ground), (width, ground), (width, height), (0.0, height)], true, GROUND);
        sketch.path(&[(0.0, ground), (width, ground)], false, SURFACE);
        let f = self.view.probe;
        let base = (0.5 * width + f * scale * frame.base_lateral, ground - 3.0);
        // About the apex's height at the start, so that a twist lifts nothing off the ground.
        let angle = f * frame.twist;
        let base = (base.0, base.1 - tall * libm::cos(angle));
        let placed = |points: &[(f64, f64)], (x0, y0): (f64, f64), angle: f64| -> Vec<(f64, f64)> {
            let (sin, cos) = libm::sincos(angle);
            points.iter().map(|(x, y)| (x0 + x * cos + y * sin, y0 - x * sin + y * cos)).collect()
        };
        let bar = [(-half, -thick), (half, -thick), (half, 0.0), (-half, 0.0)];
        let foot = 0.25 * tall;
        let cone = [(-foot, 0.0), (foot, 0.0), (0.8, tall), (-0.8, tall)];
        let rest = (0.5 * width, ground - 3.0 - tall);
        for shape in [&bar, &cone] {
            sketch.path(&placed(shape, rest, 0.0), true, GHOST);
        }
        for shape in [&cone, &bar] {
            sketch.path(&placed(shape, base, angle), true, PROBE);
        }
        // Too small to be to scale.
        let apex = (base.0 + tall * libm::sin(angle), ground - 2.5);
        sketch.circle((apex.0 - 2.5, apex.1), 2.5, GOLD);
        if named {
            sketch.text("cantilever, from the front", (0.5 * width, 11.0), true);
        }
    }

    /// The particle between tip and substrate.
    fn particle(&self, frame: &SceneSample, named: bool, sketch: &mut Sketch) {
        let (width, height) = (sketch.width, sketch.height);
        let &SceneGeometry { particle_radius, tip_radius, contact_angle, .. } = self.geometry;
        let (ground, x0) = (height - 32.0, 0.34 * width);
        let radius = 0.185 * width;
        let scale = radius / particle_radius;
        let travel = self.view.travel * scale;
        let (x, substrate) = (x0 + travel * frame.particle_position, x0 + travel * frame.substrate_position);
        // Beyond these the theories are stretched further than a picture can be.
        let depth = |metres: f64| scale * metres.min(0.3 * particle_radius).max(0.0);
        let centre = (x, ground - radius + depth(frame.substrate_indentation));
        let (sin, cos) = libm::sincos(contact_angle);

        sketch.circle((x0, ground - radius), radius, GHOST);
        self.tip(tip_radius * scale, centre, (radius - depth(frame.tip_indentation), (sin, cos)), sketch);
        sketch.path(&[(0.0, ground), (width, ground), (width, height), (0.0, height)], true, GROUND);
        self.marks(substrate, ground, sketch);
        sketch.path(&[(0.0, ground), (width, ground)], false, SURFACE);
        sketch.circle(centre, radius, GOLD);

        let grip = if frame.slipping { Colour::Series(1).hex() } else { INK };
        let half = (scale * frame.substrate_contact_radius).min(radius);
        sketch.path(&[(x - half, ground), (x + half, ground)], false, Look::line(grip, 4.0));
        let contact = (centre.0 + radius * sin, centre.1 - radius * cos);
        let k = 1.25 * radius / self.strongest;
        let push = (-k * frame.lateral_force, k * frame.normal_force);
        sketch.arrow(contact, push, self.push);
        let start = [(substrate, ground + 1.0), (substrate - 4.0, ground + 9.0), (substrate + 4.0, ground + 9.0)];
        sketch.path(&start, true, Look::area(INK));
        sketch.arrow((substrate, ground + 17.0), (x - substrate, 0.0), Colour::Series(1).hex());
        if named {
            sketch.text("F_T", (contact.0 + push.0 - 26.0, contact.1 + 0.62 * push.1), false);
            sketch.text("tip", (contact.0 + 0.18 * width, contact.1 - 4.0), false);
            sketch.text("particle", (x, ground - 0.24 * radius), true);
            sketch.text("substrate", (0.66 * width, ground + 24.0), false);
            sketch.arrow((0.66 * width, ground + 10.0), (40.0, 0.0), SUBSTRATE.hex());
        }
    }

    /// The apex at its place on the particle, `reach` px from the particle's centre to the contact.
    fn tip(&self, radius: f64, centre: (f64, f64), (reach, (sin, cos)): (f64, (f64, f64)), sketch: &mut Sketch) {
        // The cone of the picture: 14 degrees from its axis; a real one is not better known.
        const SLOPE: f64 = 14.0 * PI / 180.0;
        let radius = radius.clamp(1.5, 4000.0);
        let apex = (centre.0 + (reach + radius) * sin, centre.1 - (reach + radius) * cos);
        // From the flank on the left along the underside to the one on the right.
        let mut outline: Vec<(f64, f64)> = (0..=24)
            .map(|i| {
                let angle = SLOPE + (PI - 2.0 * SLOPE) * f64::from(i) / 24.0;
                (apex.0 - radius * libm::cos(angle), apex.1 + radius * libm::sin(angle))
            })
            .collect();
        let long = 4000.0;
        let (left, right) = (outline[0], outline[24]);
        outline.push((right.0 + long * libm::sin(SLOPE), right.1 - long * libm::cos(SLOPE)));
        outline.insert(0, (left.0 - long * libm::sin(SLOPE), left.1 - long * libm::cos(SLOPE)));
        sketch.path(&outline, true, PROBE);
    }

    /// Hatches on the substrate, which travel with it.
    fn marks(&self, substrate: f64, ground: f64, sketch: &mut Sketch) {
        let gap = 15.0;
        let shift = substrate.rem_euclid(gap);
        let count = (sketch.width / gap).ceil() as i32 + 2;
        for i in 0..count {
            let x = shift + gap * f64::from(i - 1);
            sketch.path(&[(x, ground), (x - 6.0, ground + 8.0)], false, Look::line("#a8a8a8", 1.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use resvg::usvg::roxmltree::Document;

    use super::super::fixture;
    use super::*;
    use apportion::report::chart::{ChartWidth, png};

    #[test]
    fn frames_are_states_of_the_story() {
        let story = fixture::story();
        let film = film_strip(&story);
        let times: Vec<f64> = film.frames.iter().map(|frame| frame.time).collect();
        assert_eq!((times.len(), times[0], times[2], times[5]), (6, 0.0, 0.131, 0.4));
        // The story is a straight line before the slip: half of the way, half of the force. 1e-12: rounding.
        let (half, slip) = (&film.frames[1], &film.frames[2]);
        assert!((half.lateral_force / slip.lateral_force - 0.5).abs() < 1e-12);
        assert_eq!(film.frames[5].relative_position, story.samples.last().unwrap().relative_position);
        assert!(!slip.slipping && film.frames[3].slipping);
    }

    #[test]
    fn both_widths_are_drawn_and_the_exaggeration_is_stated() {
        let film = film_strip(&fixture::story());
        for svg in [ChartWidth::Wide, ChartWidth::Narrow].map(|width| film.chart.svg_at(width).unwrap()) {
            assert!(!svg.contains("NaN") && !svg.contains("inf"));
            Document::parse(&svg).unwrap();
            assert!(png(&svg).unwrap().missing.is_empty());
            assert!(svg.contains("0.131 s: the slip"));
        }
        let caption = film.chart.caption();
        assert!(caption.contains("for 13.1 nm until the slip") && caption.contains("by 26.9 nm"), "{caption}");
        assert!(caption.contains("exaggerated 200 times"), "{caption}");
    }

    #[test]
    fn degenerate_stories_are_drawn() {
        let whole = fixture::story();
        for count in 0..3 {
            let mut story = whole.clone();
            story.samples.truncate(count);
            story.critical.time = None;
            story.geometry.particle_radius = f64::NAN;
            let film = film_strip(&story);
            assert!(!film.chart.svg().unwrap().contains("NaN"), "{count}");
            Document::parse(&film.chart.inline(ChartWidth::Narrow).unwrap()).unwrap();
        }
    }
}
