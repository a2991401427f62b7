//! TS04 figure 12: the modes of motion of the particle, against the angle of the force and of the contact.

use apportion_afm::modes::Mode;
use apportion_afm::{Failure, FrictionLaw, Options, Scene, critical_force};
use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Stroke};
use apportion_report::document::Table;
use apportion_report::format::{force, three_digits as short};

use crate::scene::simulation::{pushing, scene_modes};
use crate::scene::{ModeDiagram, ModeLine, NANO, law_colour, mode_axis, mode_diagram_chart};

/// Contact angles: around the nominal 60 degrees.
const CONTACT_ANGLES: (f64, f64) = (40.0, 70.0);
/// Steps between them.
const STEPS: u32 = 120;

/// Draws TS04 figure 12.
pub(super) fn against_force_angle() -> Result<(Chart, String), Failure> {
    let diagram = scene_modes(&Scene::default(), &Options::default())?;
    let mut chart = mode_diagram_chart(&diagram);
    if let Some(statement) = sliding(&diagram) {
        chart.caption = format!("{}; {statement}.", chart.caption.trim_end_matches('.'));
    }
    let rows = Table::from_rows("", 0..diagram.angle.len());
    let mut rows = rows.file("force_angle_deg", |row| diagram.angle[row].to_degrees());
    for line in &diagram.forces {
        let name = format!("{}_nN", line.name.replace('-', "_"));
        rows = rows.file(name, |row| line.force[row].map(|force| NANO * force));
    }
    Ok((chart, rows.csv()))
}

/// Describes how the force of sliding changes with the angle.
fn sliding(diagram: &ModeDiagram) -> Option<String> {
    let line = diagram.forces.iter().find(|line| line.name == Mode::Slide.name())?;
    let points: Vec<(f64, f64)> = diagram
        .angle
        .iter()
        .zip(&line.force)
        .filter_map(|(angle, force)| Some((angle.to_degrees(), (*force)?)))
        .collect();
    let (first, last) = (points.first()?, points.last()?);
    let falls = points.windows(2).all(|pair| pair[1].1 <= pair[0].1);
    let verb = if falls { "falls" } else { "goes" };
    Some(format!(
        "the force of sliding {verb} from {} at {}° to {} at {}°",
        force(first.1),
        short(first.0),
        force(last.1),
        short(last.0)
    ))
}

/// Draws the same against the angle of the contact.
pub(super) fn against_contact_angle() -> Result<(Chart, String), Failure> {
    let (from, to) = CONTACT_ANGLES;
    let degrees: Vec<f64> = (0..=STEPS).map(|i| from + (to - from) * f64::from(i) / f64::from(STEPS)).collect();
    let options = Options::default();
    let psi = critical_force(&Scene::default(), &options)?.force_angle();
    let law = law_colour(FrictionLaw::Coulomb);
    let mut lines = vec![
        line("critical force F_cr of the scene", (law, Stroke::Solid), &degrees, |scene| {
            Ok(Some(critical_force(&scene, &options)?.critical_force))
        })?,
        line("slide, force along the contact (ψ = φ)", (law, Stroke::Dashed), &degrees, |scene| {
            pushing(scene, &options).critical_tip_force(Mode::Slide, scene.contact_angle)
        })?,
    ];
    for (mode, colour) in [(Mode::TipSlip, 1), (Mode::Roll, 4), (Mode::Spin, 5)] {
        let name = format!("{}, force at ψ = {}°", mode.name(), short(psi.to_degrees()));
        lines.push(line(&name, (Colour::Series(colour), Stroke::Solid), &degrees, |scene| {
            pushing(scene, &options).critical_tip_force(mode, psi)
        })?);
    }
    let mut rows = Table::from_rows("", 0..degrees.len()).file("contact_angle_deg", |row| degrees[row]);
    let names = ["critical_force_nN", "slide_along_contact_nN", "tip_slip_nN", "roll_nN", "spin_nN"];
    for (name, line) in names.into_iter().zip(&lines) {
        rows = rows.file(name, |row| line.force[row].map(|force| NANO * force));
    }
    Ok((chart(&degrees, &lines), rows.csv()))
}

/// Computes a line of forces over these contact angles.
fn line(
    name: &str,
    look: (Colour, Stroke),
    degrees: &[f64],
    force: impl Fn(Scene) -> Result<Option<f64>, Failure>,
) -> Result<ModeLine, Failure> {
    let scenes = degrees.iter().map(|angle| Scene { contact_angle: angle.to_radians(), ..Scene::default() });
    Ok(ModeLine { name: name.to_owned(), look, force: scenes.map(force).collect::<Result<_, _>>()? })
}

fn chart(degrees: &[f64], lines: &[ModeLine]) -> Chart {
    let shown = lines.iter().filter(|line| line.force.iter().any(Option::is_some));
    let shown = shown.map(|line| line.mark(degrees.iter().copied()));
    let nominal = Scene::default().contact_angle.to_degrees();
    let x = Axis::new("Angle of the contact between tip and particle from the vertical, φ", "°");
    let panel = Panel::new(x, mode_axis()).with(shown).with([Mark::rule(nominal, format!("nominal: {nominal:.0}°"))]);
    Chart::new("Modes of motion against the contact angle", caption(lines)).panels([panel])
}

/// Describes the first two lines, and names the modes that never occur.
fn caption(lines: &[ModeLine]) -> String {
    let [ends, along_ends] = [0, 1].map(|line| {
        let forces = &lines[line].force;
        Some((forces.first().copied()??, forces.last().copied()??))
    });
    let (Some((first, last)), Some((along_first, along_last))) = (ends, along_ends) else {
        return "The scene has no critical force.".to_owned();
    };
    let (from, to) = CONTACT_ANGLES;
    // 1e-9: rounding; the critical force does not depend on the contact angle.
    let course = if (last / first - 1.0).abs() < 1e-9 {
        format!("stays at {}", force(first))
    } else {
        format!("goes from {} to {}", force(first), force(last))
    };
    let never: Vec<&str> = lines[2..]
        .iter()
        .filter(|line| line.force.iter().all(Option::is_none))
        .map(|line| line.name.split(',').next().unwrap_or_default())
        .collect();
    let never = if never.is_empty() { String::new() } else { format!("; no force sets in: {}", never.join(", ")) };
    format!(
        "From {from}° to {to}° of contact angle the critical force of the scene {course}, while a force along the contact \
         would have to be {} and {} to let the particle slide{never}.",
        force(along_first),
        force(along_last)
    )
}
