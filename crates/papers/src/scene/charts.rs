//! The charts of a scene in time, after the figures of Tafazzoli & Sitti 2004: quantities against time with the slip
//! marked. Each caption states the result in one sentence.

use apportion_afm::FrictionLaw;
use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Shape, Stroke};
use apportion_report::format::{change, force, length, three_digits as short, time};

use super::story::{NANO, SceneSample, SceneStory};

/// The colours of the quantities, also in the animation: the pushing force has that of the friction law.
pub(super) const LATERAL: Colour = Colour::Series(4);
pub(super) const NORMAL: Colour = Colour::Series(6);
pub(super) const SUBSTRATE: Colour = Colour::Series(6);
const PARTICLE: Colour = Colour::Series(1);
const RELATIVE: Colour = Colour::Series(4);
const TIP: Colour = Colour::Series(5);

/// A quantity in a chart: its name, colour, and a function for its value in the chart's unit.
struct Curve<'a> {
    name: &'a str,
    look: (Colour, Stroke),
    read: &'a dyn Fn(&SceneSample) -> f64,
}

fn panel(story: &SceneStory, y: Axis, curves: &[Curve<'_>]) -> Panel {
    let lines = curves.iter().map(|Curve { name, look: (colour, stroke), read }| {
        let points = story.samples.iter().map(|sample| (sample.time, read(sample)));
        Series::new(*name, *colour).stroke(*stroke).line(points.collect())
    });
    let rule = story.slip().map(|t| Mark::rule(t, format!("slip at {}", time(t))));
    Panel::new(Axis::new("Time", "s"), y).with(lines).with(rule)
}

/// Draws quantities of one unit.
fn chart(story: &SceneStory, [title, caption]: [&str; 2], [label, unit]: [&str; 2], curves: &[Curve<'_>]) -> Chart {
    Chart::new(title, caption).panels([panel(story, Axis::new(label, unit), curves)])
}

/// Returns the colour of a friction law, the same in all charts of scenes.
pub const fn law_colour(law: FrictionLaw) -> Colour {
    match law {
        FrictionLaw::Coulomb => Colour::Series(0),
        FrictionLaw::HurtadoKim => Colour::Series(8),
        FrictionLaw::LuGre => Colour::Series(2),
        _ => Colour::Series(1),
    }
}

/// Draws TS04 figure 8, CHK figure 5.
pub(crate) fn forces(story: &SceneStory) -> Chart {
    let curves = [
        Curve { name: "tip force F_T", look: (story.colour, Stroke::Solid), read: &|s| NANO * s.tip_force },
        Curve { name: "lateral force F_Y", look: (LATERAL, Stroke::Dashed), read: &|s| NANO * s.lateral_force },
        Curve { name: "normal force F_Z", look: (NORMAL, Stroke::Dotted), read: &|s| NANO * s.normal_force },
    ];
    chart(story, ["Forces on the tip", &forces_caption(story)], ["Force", "nN"], &curves)
}

fn forces_caption(story: &SceneStory) -> String {
    let first = story.start();
    let normal = story.samples.iter().map(|s| s.normal_force / first.normal_force - 1.0);
    let normal = changes("; the normal force changes", normal);
    let begins = format!("The tip force goes from {} to", force(first.tip_force));
    let Some(slip) = story.slip() else {
        return format!("{begins} {} without a slip in the time shown{normal}.", force(story.end().tip_force));
    };
    let critical = story.critical.critical_force;
    let after = story.samples.iter().filter(|s| s.time > slip).map(|s| s.tip_force / critical - 1.0);
    let after = changes(", and then differs from it", after);
    let (critical, slip) = (force(critical), time(slip));
    format!("{begins} {critical}, at which the particle slips after {slip}{after}{normal}.")
}

/// Draws TS04 figure 9.
pub(crate) fn pushing(story: &SceneStory) -> Chart {
    let critical = NANO * story.critical.critical_force;
    let curves = [
        Curve { name: "pushing force F_T", look: (story.colour, Stroke::Solid), read: &|s| NANO * s.tip_force },
        Curve { name: "critical force F_cr", look: (Colour::Reference, Stroke::Dashed), read: &|_| critical },
    ];
    let largest = story.samples.iter().map(|s| s.tip_force).fold(f64::NAN, f64::max);
    let (largest, at) = (force(largest), force(story.critical.critical_force));
    let caption = match story.slip().map(time) {
        Some(slip) => format!("The pushing force reaches the critical force of {at} after {slip}."),
        None => format!("The pushing force is at most {largest} in the time shown; the critical force is {at}."),
    };
    chart(story, ["Pushing force against critical force", &caption], ["Force", "nN"], &curves)
}

/// Draws TS04 figure 10.
pub(crate) fn positions(story: &SceneStory) -> Chart {
    let curves = [
        Curve { name: "substrate", look: (SUBSTRATE, Stroke::Dashed), read: &|s| NANO * s.substrate },
        Curve { name: "particle", look: (PARTICLE, Stroke::Solid), read: &|s| NANO * s.particle },
        Curve { name: "particle relative to substrate", look: (RELATIVE, Stroke::Solid), read: &|s| NANO * s.relative },
        Curve { name: "tip base y_P", look: (TIP, Stroke::Dotted), read: &|s| NANO * s.lateral_deflection },
    ];
    chart(story, ["Positions", &positions_caption(story)], ["Position", "nm"], &curves)
}

fn positions_caption(story: &SceneStory) -> String {
    let last = story.end();
    let (at, travelled, moved) = (time(last.time), length(last.substrate), length(last.relative));
    match story.slip() {
        Some(_) => format!(
            "Substrate and particle travel together for {}; at {at} the particle is {moved} from its start on the \
             substrate.",
            length(story.held().substrate)
        ),
        None => format!(
            "At {at} the substrate has travelled {travelled}, and the particle is {moved} from its start on it."
        ),
    }
}

/// Draws TS04 figure 13.
pub(crate) fn contacts(story: &SceneStory) -> Chart {
    let radii: [Read; 2] = [|s| s.tip_contact_radius(), |s| s.substrate_contact.radius];
    let depths: [Read; 2] = [|s| s.tip_indentation(), |s| s.substrate_contact.indentation];
    let mut panels = vec![
        both_contacts(story, Axis::new("Contact radius", "nm"), radii, &|sample, read| NANO * read(sample)),
        both_contacts(story, Axis::new("Indentation", "nm"), depths, &|sample, read| NANO * read(sample)),
        both_contacts(story, Axis::new("Change of radius", "%"), radii, &|sample, read| {
            100.0 * change_since_start(story, sample, read)
        }),
        both_contacts(story, Axis::new("Change of indentation", "%"), depths, &|sample, read| {
            100.0 * change_since_start(story, sample, read)
        }),
    ];
    // One label of the slip is enough for a chart.
    for mark in panels[1..].iter_mut().flat_map(|panel| &mut panel.marks) {
        if let Shape::Rule(_, label) = &mut mark.shape {
            label.clear();
        }
    }
    Chart::new("Contacts at tip and substrate", contacts_caption(story)).panels(panels)
}

type Read = fn(&SceneSample) -> f64;

/// Draws a quantity of the contacts at the tip and at the substrate, in the unit of `scaled`.
fn both_contacts(
    story: &SceneStory,
    axis: Axis,
    [tip, substrate]: [Read; 2],
    scaled: &dyn Fn(&SceneSample, Read) -> f64,
) -> Panel {
    let curves = [
        Curve { name: "at the tip", look: (story.colour, Stroke::Solid), read: &|s| scaled(s, tip) },
        Curve { name: "at the substrate", look: (SUBSTRATE, Stroke::Dashed), read: &|s| scaled(s, substrate) },
    ];
    panel(story, axis, &curves)
}

/// Returns the relative change of a quantity since the first sample; NaN if it does not exist.
fn change_since_start(story: &SceneStory, sample: &SceneSample, read: Read) -> f64 {
    read(sample) / read(story.start()) - 1.0
}

fn contacts_caption(story: &SceneStory) -> String {
    let end = story.held();
    let reads: [Read; 4] = [
        |s| s.tip_contact_radius(),
        |s| s.substrate_contact.radius,
        |s| s.tip_indentation(),
        |s| s.substrate_contact.indentation,
    ];
    let [tip_radius, radius, tip_indentation, indentation] =
        reads.map(|read| change(change_since_start(story, end, read)).unwrap_or_else(|| short(f64::NAN)));
    format!(
        "From the start to {}, the contact radius changes by {tip_radius} at the tip and {radius} at the substrate, the \
         indentation by {tip_indentation} and {indentation}.",
        time(end.time)
    )
}

/// Says by how much a quantity changes, at most; nothing if no relative change is finite.
fn changes(what: &str, parts: impl Iterator<Item = f64>) -> String {
    match parts.map(f64::abs).filter(|size| size.is_finite()).reduce(f64::max) {
        None => String::new(),
        Some(size) if size < 1e-4 => format!("{what} by less than 0.01 %"),
        Some(size) => format!("{what} by at most {} %", short(100.0 * size)),
    }
}
