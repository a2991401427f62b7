//! The scene in time: CHK figure 5 and the histories of TS04.

use apportion_afm::{Failure, FrictionLaw, Options, Scene};
use apportion_base::text::listed;
use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Stroke};
use apportion_report::document::{Rows, Table};
use apportion_report::format::{force, length, time};

use crate::scene::charts::{contacts, forces, positions, pushing};
use crate::scene::simulation::scene_story;
use crate::scene::{NANO, SceneSample, SceneStory, scene_number};

/// Duration of the scene in the papers (s).
pub const DURATION: f64 = 0.4;
/// The shear modulus of the cantilever that the papers print (Pa); ours is that of an isotropic solid, E/(2 (1 + nu)).
pub const PRINTED_SHEAR_MODULUS: f64 = 40.5e9;
/// Coefficients of static friction in TS04 figure 11: around the nominal one.
const COEFFICIENTS: [f64; 4] = [1.0, 0.8, 0.6, 0.4];

/// Returns the nominal scene under `law` for [`DURATION`], changed by `change`.
pub(super) fn story(law: FrictionLaw, change: impl FnOnce(&mut Scene)) -> Result<SceneStory, Failure> {
    let mut scene = Scene::default();
    change(&mut scene);
    let options = Options { friction: law, ..Options::default() };
    scene_story("Pushing a gold particle on silicon oxide".to_owned(), &scene, &options, DURATION)
}

/// Returns the nominal scene under Coulomb friction, also the animation of TS04 figure 14.
///
/// # Errors
/// [`Failure`] if the scene has no solution.
pub fn coulomb() -> Result<SceneStory, Failure> {
    story(FrictionLaw::Coulomb, |_| ())
}

/// Returns the same with the shear modulus that the papers print.
fn printed(law: FrictionLaw) -> Result<SceneStory, Failure> {
    story(law, |scene| scene.shear_modulus = Some(PRINTED_SHEAR_MODULUS))
}

/// The forces on the tip, as column names of scenes.
const FORCES: [&str; 3] = ["tip_force_nN", "lateral_force_nN", "normal_force_nN"];
/// The column of the relative position.
const RELATIVE: &str = "relative_position_nm";

/// Draws TS04 figure 8.
pub(super) fn forces_in_time() -> Result<(Chart, String), Failure> {
    let story = coulomb()?;
    Ok((forces(&story), table("", &[("", &story)], &FORCES).csv()))
}

/// Draws TS04 figure 9.
pub(super) fn tip_force() -> Result<(Chart, String), Failure> {
    let story = coulomb()?;
    let critical = NANO * story.critical.critical_force;
    Ok((pushing(&story), table("", &[("", &story)], &FORCES[..1]).file("critical_force_nN", |_| critical).csv()))
}

/// Draws TS04 figure 13.
pub(super) fn contact_areas() -> Result<(Chart, String), Failure> {
    let story = coulomb()?;
    let columns =
        ["tip_contact_radius_nm", "substrate_contact_radius_nm", "tip_indentation_nm", "substrate_indentation_nm"];
    Ok((contacts(&story), table("", &[("", &story)], &columns).csv()))
}

/// Stacks these columns of stories; the column `first` names the story if there are several.
fn table<'a>(first: &str, stories: &[(&'a str, &'a SceneStory)], columns: &[&str]) -> Rows<(&'a str, &'a SceneSample)> {
    let rows = stories.iter().flat_map(|&(name, story)| story.samples.iter().map(move |sample| (name, sample)));
    let rows = Table::from_rows("", rows);
    let rows = if first.is_empty() { rows } else { rows.file(first, |(name, _)| name) };
    let columns = ["time_s"].iter().chain(columns);
    columns.fold(rows, |rows, name| rows.file(*name, |(_, sample)| scene_number(name, sample)))
}

fn line(name: String, look: (Colour, Stroke), points: Vec<(f64, f64)>) -> Mark {
    Series::new(name, look.0).stroke(look.1).line(points)
}

fn curve(story: &SceneStory, column: &str) -> Vec<(f64, f64)> {
    story.samples.iter().map(|sample| (sample.time, scene_number(column, sample))).collect()
}

/// Formats the time of the slip in s.
fn slip(story: &SceneStory) -> String {
    format!("after {}", time(story.critical_time))
}

/// Draws CHK figure 5.
pub(super) fn two_laws() -> Result<(Chart, String), Failure> {
    let (coulomb, hk) = (coulomb()?, story(FrictionLaw::HurtadoKim, |_| ())?);
    let printed = [printed(FrictionLaw::HurtadoKim)?, printed(FrictionLaw::Coulomb)?];
    let (mut tip_forces, mut levels, mut rules) = (Vec::new(), Vec::new(), Vec::new());
    for (story, name, stroke) in [(&coulomb, "Coulomb", Stroke::Solid), (&hk, "Hurtado-Kim", Stroke::Dashed)] {
        tip_forces.push(line(format!("{name}, tip force"), (story.colour, stroke), curve(story, FORCES[0])));
        let critical = NANO * story.critical.critical_force;
        let level = story.samples.iter().map(|sample| (sample.time, critical)).collect();
        levels.push(line(format!("{name}, critical force"), (story.colour, Stroke::Dotted), level));
        rules.push(Mark::rule(story.critical_time, format!("slip, {name}")));
    }
    let marks = tip_forces.into_iter().chain(levels).chain(rules);
    let panel = Panel::new(Axis::new("Time", "s"), Axis::new("Tip force F_T", "nN")).with(marks);
    let caption = format!(
        "The tip force rises from {} until the particle slips, at {} {} under Hurtado-Kim friction and at {} {} under \
         Coulomb friction; with the shear modulus of {} GPa that the papers print it slips {} and {}.",
        force(coulomb.start().tip_force),
        force(hk.critical.critical_force),
        slip(&hk),
        force(coulomb.critical.critical_force),
        slip(&coulomb),
        PRINTED_SHEAR_MODULUS / 1e9,
        slip(&printed[0]),
        slip(&printed[1]),
    );
    let both = [("coulomb", &coulomb), ("hk", &hk)];
    let chart = Chart::new("Tip force against time", caption).panels([panel]);
    Ok((chart, table("friction", &both, &FORCES).csv()))
}

/// Draws TS04 figure 10, with the relative position at the printed shear modulus in addition to ours.
pub(super) fn displacement() -> Result<(Chart, String), Failure> {
    let (story, printed) = (coulomb()?, printed(FrictionLaw::Coulomb)?);
    let ours = positions(&story);
    let modulus = PRINTED_SHEAR_MODULUS / 1e9;
    let look = (Colour::Series(4), Stroke::Dashed);
    let other = line(format!("the same with G = {modulus} GPa as printed"), look, curve(&printed, RELATIVE));
    let caption = format!(
        "{}, and {} if the shear modulus is the {modulus} GPa that the papers print, with which it slips {}.",
        ours.caption.trim_end_matches('.'),
        length(printed.end().relative),
        slip(&printed)
    );
    let mut panels = ours.panels;
    if let Some(panel) = panels.first_mut() {
        // After our line, the third of the chart.
        panel.marks.insert(panel.marks.len().min(3), other);
    }
    let as_printed = format!("{modulus} GPa");
    let both = [("E/(2(1+nu))", &story), (&as_printed, &printed)];
    let rows = table("shear_modulus", &both, &["substrate_position_nm", "particle_position_nm", RELATIVE]);
    let rows = rows.file("tip_base_position_nm", |(_, sample)| NANO * sample.lateral_deflection);
    Ok((Chart::new(ours.title, caption).panels(panels), rows.csv()))
}

/// Draws TS04 figure 11.
pub(super) fn coefficients() -> Result<(Chart, String), Failure> {
    // All follow one line until they slip: in this order each is visible.
    let runs = COEFFICIENTS.map(|coefficient| story(FrictionLaw::Coulomb, |scene| scene.static_friction = coefficient));
    let runs = runs.into_iter().collect::<Result<Vec<_>, _>>()?;
    let nominal = Scene::default().static_friction;
    let others = [1, 4, 5, 6].map(Colour::Series);
    let axes = [("Tip force F_T", "nN", FORCES[0]), ("Position on the substrate", "nm", RELATIVE)];
    let panels = axes.map(|(label, unit, column)| {
        let lines = runs.iter().zip(COEFFICIENTS).zip(others).map(|((story, coefficient), other)| {
            let colour = if coefficient == nominal { story.colour } else { other };
            line(format!("μ_s = {coefficient}"), (colour, Stroke::Solid), curve(story, column))
        });
        Panel::new(Axis::new("Time", "s"), Axis::new(label, unit)).with(lines)
    });
    let runs_by_coefficient = COEFFICIENTS.into_iter().zip(&runs).rev();
    let slips: Vec<String> =
        runs_by_coefficient.map(|(mu, story)| format!("{} at {mu}", time(story.critical_time))).collect();
    let is_later = runs.windows(2).all(|pair| pair[0].critical_time > pair[1].critical_time);
    let statement = if is_later {
        "The larger the coefficient of static friction, the later the particle slips"
    } else {
        "The particle slips"
    };
    let names = COEFFICIENTS.map(|coefficient| coefficient.to_string());
    let stories: Vec<(&str, &SceneStory)> = names.iter().map(String::as_str).zip(&runs).collect();
    let chart = Chart::new("Effect of the coefficient of friction", format!("{statement}: after {}.", listed(&slips)));
    Ok((chart.panels(panels), table("static_friction", &stories, &[FORCES[0], RELATIVE]).csv()))
}

/// Name of the animation's files without extension.
pub const ANIMATION_STEM: &str = "ts04-14-animation";
