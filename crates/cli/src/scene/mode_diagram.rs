//! The mode diagram: the force of each mode of motion of the particle, against the angle of the force.

use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Spacing, Stroke};
use apportion_report::format::{force, three_digits as short};

/// The forces at which the modes begin, against the angle of the tip force (TS04 figure 12).
#[derive(Clone, Debug, PartialEq)]
pub struct ModeDiagram {
    /// Angles psi of the tip force from the vertical, rising (rad). The caption names the modes at the angle nearest to
    /// that of `current`, which should be among them.
    pub angle: Vec<f64>,
    /// The modes.
    pub forces: Vec<ModeLine>,
    /// Angle (rad) and tip force (N) of the scene when it slips.
    pub current: (f64, f64),
}

/// The force at which a mode begins.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeLine {
    /// Name of the mode, such as "sliding".
    pub mode: String,
    /// Its colour.
    pub colour: Colour,
    /// One force (N) for each angle; `None` if no force starts it.
    pub force: Vec<Option<f64>>,
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// Draws the diagram, forces on a logarithmic axis.
pub fn mode_diagram_chart(diagram: &ModeDiagram) -> Chart {
    let scene = Series::new("this scene at its slip", Colour::Reference).stroke(Stroke::Points);
    let (angle, force) = diagram.current;
    let scene = scene.line(vec![(DEGREES * angle, 1e9 * force)]);
    let x = Axis::new("Angle of the tip force from the vertical, ψ", "°");
    let y = Axis::new("Force at which the mode sets in", "nN").spaced(Spacing::Logarithmic);
    let lines = diagram.forces.iter().map(|line| mode_line(diagram, line));
    Chart::new("Modes of motion", caption(diagram)).panels([Panel::new(x, y).with(lines).with([scene])])
}

fn mode_line(diagram: &ModeDiagram, line: &ModeLine) -> Mark {
    let forces = line.force.iter().map(|force| 1e9 * force.unwrap_or(f64::NAN));
    Series::new(&line.mode, line.colour).line(diagram.angle.iter().map(|angle| DEGREES * angle).zip(forces).collect())
}

/// Says which modes begin at the scene's own angle, the one of the smallest force first.
fn caption(diagram: &ModeDiagram) -> String {
    let (angle, scene_force) = diagram.current;
    let Some(place) = nearest(&diagram.angle, angle) else { return "The diagram has no angles.".to_owned() };
    let mut modes: Vec<(&str, f64)> = diagram.forces.iter().filter_map(|line| at(line, place)).collect();
    modes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let said: Vec<String> = modes.iter().map(|(mode, least)| format!("{mode} at {}", force(*least))).collect();
    let here = short(DEGREES * diagram.angle[place]);
    let modes = if said.is_empty() { "no mode".to_owned() } else { said.join(", ") };
    format!("At {here}° set in: {modes}; the scene slips at {}° and {}.", short(DEGREES * angle), force(scene_force))
}

/// Returns a mode with its force at a position, if it has one.
fn at(line: &ModeLine, place: usize) -> Option<(&str, f64)> {
    let force = line.force.get(place).copied().flatten().filter(|force| force.is_finite())?;
    Some((&line.mode, force))
}

/// Returns the position of the number nearest to `value`.
fn nearest(numbers: &[f64], value: f64) -> Option<usize> {
    (0..numbers.len()).min_by(|&a, &b| (numbers[a] - value).abs().total_cmp(&(numbers[b] - value).abs()))
}

#[cfg(test)]
mod tests {
    use resvg::usvg::roxmltree::Document;

    use super::*;

    fn diagram() -> ModeDiagram {
        let angle: Vec<f64> = (0..=90).map(|degree| f64::from(degree).to_radians()).collect();
        // TS04: F*_ss = tau A / (sin psi - mu cos psi), where tan psi > mu.
        let sliding = |psi: &f64| {
            let lever = libm::sin(*psi) - 0.8 * libm::cos(*psi);
            (lever > 0.0).then(|| 7.3e-9 / lever)
        };
        let sliding = angle.iter().map(sliding).collect();
        let rolling = angle.iter().map(|psi| Some(9e-16 / (50e-9 * libm::sin(psi - 0.5).abs()))).collect();
        ModeDiagram {
            forces: vec![
                ModeLine { mode: "sliding".to_owned(), colour: Colour::Series(0), force: sliding },
                ModeLine { mode: "rolling".to_owned(), colour: Colour::Series(1), force: rolling },
            ],
            angle,
            current: (39.2_f64.to_radians(), 631e-9),
        }
    }

    #[test]
    fn the_diagram_is_drawn_with_a_caption() {
        let svg = mode_diagram_chart(&diagram()).svg();
        Document::parse(&svg).unwrap();
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        let said = caption(&diagram());
        assert!(
            said.starts_with(
                "At 39.0° set in: rolling at 100 nN, sliding at 960 nN; the scene slips at 39.2° and 631 nN."
            ),
            "{said}"
        );
    }

    #[test]
    fn an_empty_diagram_is_drawn() {
        let empty = ModeDiagram { angle: Vec::new(), forces: Vec::new(), current: (0.1, f64::NAN) };
        assert!(!mode_diagram_chart(&empty).svg().contains("NaN"));
    }
}
