//! The scene in time: CHK figure 5 and the histories of TS04.

use super::table::Table;
use super::{Drawn, FiguresError};
use crate::scene::charts::{contacts, forces, positions, pushing};
use crate::scene::simulation::scene_story;
use crate::scene::{SceneSample, SceneStory};
use apportion::afm::{Failure, FrictionLaw, Options, Scene};
use apportion::report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Stroke};
use apportion::report::format::{force, length, time};
use apportion::report::listed;

/// How long the papers follow the scene (s).
pub(super) const DURATION: f64 = 0.4;
/// The shear modulus of the cantilever that the papers print (Pa); ours is that of an isotropic solid, E/(2 (1 + nu)).
const PRINTED_SHEAR_MODULUS: f64 = 40.5e9;
/// Coefficients of static friction in TS04 figure 11: about the nominal one.
const COEFFICIENTS: [f64; 4] = [1.0, 0.8, 0.6, 0.4];
const NANO: f64 = 1e9;

/// The nominal scene under `law` for [`DURATION`], changed by `change`.
pub(super) fn story(law: FrictionLaw, change: impl FnOnce(&mut Scene)) -> Result<SceneStory, Failure> {
    let mut scene = Scene::default();
    change(&mut scene);
    let options = Options { friction: law, ..Options::default() };
    scene_story("Pushing a gold particle on silicon oxide".to_owned(), &scene, &options, DURATION)
}

fn coulomb() -> Result<SceneStory, Failure> {
    story(FrictionLaw::Coulomb, |_| ())
}

/// The same with the shear modulus that the papers print.
fn printed(law: FrictionLaw) -> Result<SceneStory, Failure> {
    story(law, |scene| scene.shear_modulus = Some(PRINTED_SHEAR_MODULUS))
}

/// TS04 figure 8.
pub(super) fn forces_in_time() -> Result<Drawn, FiguresError> {
    let story = coulomb()?;
    Ok((forces(&story), table(&story, &[TIP_FORCE, LATERAL_FORCE, NORMAL_FORCE]).csv()))
}

/// TS04 figure 9.
pub(super) fn tip_force() -> Result<Drawn, FiguresError> {
    let story = coulomb()?;
    let critical = story.samples.iter().map(|_| NANO * story.critical.critical_force);
    Ok((pushing(&story), table(&story, &[TIP_FORCE]).with("critical_force_nN", critical).csv()))
}

/// TS04 figure 13.
pub(super) fn contact_areas() -> Result<Drawn, FiguresError> {
    let story = coulomb()?;
    let columns = [TIP_RADIUS, SUBSTRATE_RADIUS, TIP_INDENTATION, SUBSTRATE_INDENTATION];
    Ok((contacts(&story), table(&story, &columns).csv()))
}

/// A column's name with its unit, and what stands in it.
type Column = (&'static str, fn(&SceneSample) -> f64);

const TIP_FORCE: Column = ("tip_force_nN", |s| NANO * s.tip_force);
const LATERAL_FORCE: Column = ("lateral_force_nN", |s| NANO * s.lateral_force);
const NORMAL_FORCE: Column = ("normal_force_nN", |s| NANO * s.normal_force);
const SUBSTRATE: Column = ("substrate_position_nm", |s| NANO * s.substrate);
const PARTICLE: Column = ("particle_position_nm", |s| NANO * s.particle);
const RELATIVE: Column = ("relative_position_nm", |s| NANO * s.relative);
const BASE: Column = ("tip_base_position_nm", |s| NANO * s.lateral_deflection);
const TIP_RADIUS: Column = ("tip_contact_radius_nm", |s| NANO * s.tip_contact_radius());
const SUBSTRATE_RADIUS: Column = ("substrate_contact_radius_nm", |s| NANO * s.substrate_contact.radius);
const TIP_INDENTATION: Column = ("tip_indentation_nm", |s| NANO * s.tip_indentation());
const SUBSTRATE_INDENTATION: Column = ("substrate_indentation_nm", |s| NANO * s.substrate_contact.indentation);

fn table(story: &SceneStory, columns: &[Column]) -> Table {
    let start = Table::default().with("time_s", story.samples.iter().map(|sample| sample.time));
    columns.iter().fold(start, |table, (name, read)| table.with(name, story.samples.iter().map(read)))
}

/// Stories one below the other, distinguished by their first column.
fn stacked(first: &str, stories: &[(String, &SceneStory)], columns: &[Column]) -> String {
    let samples = || stories.iter().flat_map(|(_, story)| &story.samples);
    let names = stories.iter().flat_map(|(name, story)| story.samples.iter().map(move |_| name.as_str()));
    let start = Table::default().with_words(first, names).with("time_s", samples().map(|sample| sample.time));
    columns.iter().fold(start, |table, (name, read)| table.with(name, samples().map(read))).csv()
}

fn line(name: String, look: (Colour, Stroke), points: Vec<(f64, f64)>) -> Mark {
    Series::new(name, look.0).stroke(look.1).line(points)
}

fn curve(story: &SceneStory, read: impl Fn(&SceneSample) -> f64) -> Vec<(f64, f64)> {
    story.samples.iter().map(|sample| (sample.time, read(sample))).collect()
}

/// When the particle slips, said in s.
fn slip(story: &SceneStory) -> String {
    format!("after {}", time(story.critical_time))
}

/// CHK figure 5.
pub(super) fn two_laws() -> Result<Drawn, FiguresError> {
    let (coulomb, hk) = (coulomb()?, story(FrictionLaw::HurtadoKim, |_| ())?);
    let printed = [printed(FrictionLaw::HurtadoKim)?, printed(FrictionLaw::Coulomb)?];
    let laws = [(&coulomb, "Coulomb", Stroke::Solid), (&hk, "Hurtado-Kim", Stroke::Dashed)];
    let tip_force = |&(story, name, stroke): &(&SceneStory, &str, Stroke)| {
        line(format!("{name}, tip force"), (story.colour, stroke), curve(story, TIP_FORCE.1))
    };
    let level = |&(story, name, _): &(&SceneStory, &str, Stroke)| {
        let critical = NANO * story.critical.critical_force;
        line(format!("{name}, critical force"), (story.colour, Stroke::Dotted), curve(story, |_| critical))
    };
    let lines = laws.iter().map(tip_force).chain(laws.iter().map(level));
    let rules = laws.iter().map(|(story, name, _)| Mark::rule(story.critical_time, format!("slip, {name}")));
    let panel = Panel::new(Axis::new("Time", "s"), Axis::new("Tip force F_T", "nN")).with(lines).with(rules);
    let reached = |story: &SceneStory, law: &str| {
        format!("{} {} under {law} friction", force(story.critical.critical_force), slip(story))
    };
    let caption = format!(
        "The tip force rises from {} until the particle slips, at {} and at {}; with the shear modulus of {} GPa that \
         the papers print it slips {} and {}.",
        coulomb.samples.first().map_or_else(String::new, |start| force(start.tip_force)),
        reached(&hk, "Hurtado-Kim"),
        reached(&coulomb, "Coulomb"),
        PRINTED_SHEAR_MODULUS / 1e9,
        slip(&printed[0]),
        slip(&printed[1]),
    );
    let both = [("coulomb".to_owned(), &coulomb), ("hk".to_owned(), &hk)];
    let chart = Chart::new("Tip force against time", caption).panels([panel]);
    Ok((chart, stacked("friction", &both, &[TIP_FORCE, LATERAL_FORCE, NORMAL_FORCE])))
}

/// TS04 figure 10, with the relative position at the printed shear modulus beside ours.
pub(super) fn displacement() -> Result<Drawn, FiguresError> {
    let (story, printed) = (coulomb()?, printed(FrictionLaw::Coulomb)?);
    let ours = positions(&story);
    let modulus = PRINTED_SHEAR_MODULUS / 1e9;
    let look = (Colour::Series(4), Stroke::Dashed);
    let other = line(format!("the same with G = {modulus} GPa as printed"), look, curve(&printed, RELATIVE.1));
    let end = printed.samples.last().map_or(f64::NAN, |end| end.relative);
    let caption = format!(
        "{}, and {} if the shear modulus is the {modulus} GPa that the papers print, with which it slips {}.",
        ours.caption().trim_end_matches('.'),
        length(end),
        slip(&printed)
    );
    let mut panels = ours.all_panels().to_vec();
    if let Some(panel) = panels.first_mut() {
        // After its own line, the third of the chart.
        panel.marks.insert(panel.marks.len().min(3), other);
    }
    let both = [("E/(2(1+nu))".to_owned(), &story), (format!("{modulus} GPa"), &printed)];
    let csv = stacked("shear_modulus", &both, &[SUBSTRATE, PARTICLE, RELATIVE, BASE]);
    Ok((Chart::new(ours.title(), caption).panels(panels), csv))
}

/// TS04 figure 11.
pub(super) fn coefficients() -> Result<Drawn, FiguresError> {
    // All follow one line until they slip: in this order each is seen.
    let runs = COEFFICIENTS.map(|coefficient| story(FrictionLaw::Coulomb, |scene| scene.static_friction = coefficient));
    let runs = runs.into_iter().collect::<Result<Vec<_>, _>>()?;
    let nominal = Scene::default().static_friction;
    let others = [1, 4, 5, 6].map(Colour::Series);
    let panel = |label: &str, unit: &str, read: fn(&SceneSample) -> f64| {
        let each = runs.iter().zip(COEFFICIENTS).zip(others);
        let lines = each.map(|((story, coefficient), other)| {
            let colour = if coefficient == nominal { story.colour } else { other };
            line(format!("μ_s = {coefficient}"), (colour, Stroke::Solid), curve(story, read))
        });
        Panel::new(Axis::new("Time", "s"), Axis::new(label, unit)).with(lines)
    };
    let panels = [panel("Tip force F_T", "nN", TIP_FORCE.1), panel("Position on the substrate", "nm", RELATIVE.1)];
    let mut times: Vec<(f64, f64)> =
        COEFFICIENTS.into_iter().zip(&runs).map(|(mu, story)| (mu, story.critical_time)).collect();
    times.reverse();
    let slips: Vec<String> = times.iter().map(|(mu, at)| format!("{} at {mu}", time(*at))).collect();
    let later = times.windows(2).all(|pair| pair[1].1 > pair[0].1);
    let seen = if later {
        "The larger the coefficient of static friction, the later the particle slips"
    } else {
        "The particle slips"
    };
    let stories: Vec<(String, &SceneStory)> = COEFFICIENTS.iter().map(|mu| mu.to_string()).zip(&runs).collect();
    let chart = Chart::new("Effect of the coefficient of friction", format!("{seen}: after {}.", listed(&slips)));
    Ok((chart.panels(panels), stacked("static_friction", &stories, &[TIP_FORCE, RELATIVE])))
}
