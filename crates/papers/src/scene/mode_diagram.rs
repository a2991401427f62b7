//! The mode diagram: the force of each mode of motion of the particle, against the angle of the force.

use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Spacing, Stroke};
use apportion_report::format::{force, three_digits as short};

/// The forces at which the modes begin, against the angle of the tip force (TS04 figure 12).
#[derive(Clone, Debug, PartialEq)]
pub struct ModeDiagram {
    /// Angles psi of the tip force from the vertical, rising (rad); that of the slip is among them.
    pub angle: Vec<f64>,
    /// The modes.
    pub forces: Vec<ModeLine>,
    /// Angle (rad) and tip force (N) of the scene when it slips.
    pub slip: (f64, f64),
}

/// The force at which a mode begins, over some angle.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeLine {
    /// Name of the mode, such as "slide".
    pub name: String,
    /// Its style.
    pub look: (Colour, Stroke),
    /// One force (N) for each angle; `None` if no force starts it.
    pub force: Vec<Option<f64>>,
}

impl ModeLine {
    /// Draws the line over these angles.
    pub fn mark(&self, degrees: impl IntoIterator<Item = f64>) -> Mark {
        let forces = self.force.iter().map(|force| 1e9 * force.unwrap_or(f64::NAN));
        Series::new(&self.name, self.look.0).stroke(self.look.1).line(degrees.into_iter().zip(forces).collect())
    }
}

/// Returns the axis of the forces.
pub fn mode_axis() -> Axis {
    Axis::new("Force at which the mode sets in", "nN").spaced(Spacing::Logarithmic)
}

/// Draws the diagram, forces on a logarithmic axis.
pub fn mode_diagram_chart(diagram: &ModeDiagram) -> Chart {
    let scene = Series::new("this scene at its slip", Colour::Reference).stroke(Stroke::Points);
    let (angle, force) = diagram.slip;
    let scene = scene.line(vec![(angle.to_degrees(), 1e9 * force)]);
    let x = Axis::new("Angle of the tip force from the vertical, ψ", "°");
    let lines = diagram.forces.iter().map(|line| line.mark(diagram.angle.iter().map(|angle| angle.to_degrees())));
    let panel = Panel::new(x, mode_axis()).with(lines).with([scene]);
    Chart::new("Modes of motion", caption(diagram)).panels([panel])
}

/// Says which modes begin at the scene's angle, the one of the smallest force first.
fn caption(diagram: &ModeDiagram) -> String {
    let (slip_angle, slip_force) = diagram.slip;
    let slip = diagram.angle.iter().position(|angle| *angle == slip_angle);
    let mut modes: Vec<(&str, f64)> =
        diagram.forces.iter().filter_map(|line| Some((line.name.as_str(), line.force[slip?]?))).collect();
    modes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let modes: Vec<String> = modes.iter().map(|(mode, least)| format!("{mode} at {}", force(*least))).collect();
    let modes = if modes.is_empty() { "no mode".to_owned() } else { modes.join(", ") };
    let angle = short(slip_angle.to_degrees());
    format!("At {angle}° set in: {modes}; the scene slips at {angle}° and {}.", force(slip_force))
}
