//! The scene in time: CHK figure 5 and the histories of TS04.

use super::table::Table;
use super::{FiguresError, PaperFigure};
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

/// CHK figure 5 and TS04 figures 8 to 11 and 13.
pub(super) fn histories() -> Result<Vec<PaperFigure>, FiguresError> {
    let coulomb = story(FrictionLaw::Coulomb, |_| ())?;
    let printed = story(FrictionLaw::Coulomb, |scene| scene.shear_modulus = Some(PRINTED_SHEAR_MODULUS))?;
    Ok(vec![
        two_laws(&coulomb)?,
        PaperFigure {
            stem: "ts04-8",
            label: "TS04 fig. 8",
            theirs: "The lateral force grows, the normal force stays nearly constant, and the tip force rises to the \
                     critical force and stays there.",
            chart: forces(&coulomb),
            csv: table(&coulomb, &[TIP_FORCE, LATERAL_FORCE, NORMAL_FORCE]).csv(),
        },
        PaperFigure {
            stem: "ts04-9",
            label: "TS04 fig. 9",
            theirs: "The pushing force rises to the critical force and stays there.",
            chart: pushing(&coulomb),
            csv: table(&coulomb, &[TIP_FORCE])
                .with("critical_force_nN", coulomb.samples.iter().map(|_| NANO * coulomb.critical.critical_force))
                .csv(),
        },
        PaperFigure {
            stem: "ts04-10",
            label: "TS04 fig. 10",
            theirs: "The particle rides on the substrate, slips near 0.2 s, and stands 21 nm behind it after 0.4 s.",
            chart: with_printed(&coulomb, &printed),
            csv: positions_csv(&coulomb, &printed),
        },
        coefficients()?,
        PaperFigure {
            stem: "ts04-13",
            label: "TS04 fig. 13",
            theirs: "While the particle is pushed, contact area and indentation grow at the tip and shrink at the \
                     substrate.",
            chart: contacts(&coulomb),
            csv: table(&coulomb, &[TIP_RADIUS, SUBSTRATE_RADIUS, TIP_INDENTATION, SUBSTRATE_INDENTATION]).csv(),
        },
    ])
}

/// A column's name with its unit, and what stands in it.
type Column = (&'static str, fn(&SceneSample) -> f64);

const TIP_FORCE: Column = ("tip_force_nN", |s| NANO * s.tip_force);
const LATERAL_FORCE: Column = ("lateral_force_nN", |s| NANO * s.lateral_force);
const NORMAL_FORCE: Column = ("normal_force_nN", |s| NANO * s.normal_force);
const SUBSTRATE: Column = ("substrate_position_nm", |s| NANO * s.substrate_position);
const PARTICLE: Column = ("particle_position_nm", |s| NANO * s.particle_position);
const RELATIVE: Column = ("relative_position_nm", |s| NANO * s.relative_position);
const BASE: Column = ("tip_base_position_nm", |s| NANO * s.base_lateral);
const TIP_RADIUS: Column = ("tip_contact_radius_nm", |s| NANO * s.tip_contact_radius);
const SUBSTRATE_RADIUS: Column = ("substrate_contact_radius_nm", |s| NANO * s.substrate_contact_radius);
const TIP_INDENTATION: Column = ("tip_indentation_nm", |s| NANO * s.tip_indentation);
const SUBSTRATE_INDENTATION: Column = ("substrate_indentation_nm", |s| NANO * s.substrate_indentation);

fn table(story: &SceneStory, columns: &[Column]) -> Table {
    let start = Table::default().with("time_s", story.samples.iter().map(|sample| sample.time));
    columns.iter().fold(start, |table, (name, read)| table.with(name, story.samples.iter().map(read)))
}

/// Stories one below the other, told apart by their first column.
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
    format!("after {}", time(story.critical.time))
}

/// CHK figure 5.
fn two_laws(coulomb: &SceneStory) -> Result<PaperFigure, FiguresError> {
    let hk = story(FrictionLaw::HurtadoKim, |_| ())?;
    let softer = |law| story(law, |scene| scene.shear_modulus = Some(PRINTED_SHEAR_MODULUS));
    let printed = [softer(FrictionLaw::HurtadoKim)?, softer(FrictionLaw::Coulomb)?];
    let laws = [(coulomb, "Coulomb", Stroke::Solid), (&hk, "Hurtado-Kim", Stroke::Dashed)];
    let tip_force = |&(story, name, stroke): &(&SceneStory, &str, Stroke)| {
        line(format!("{name}, tip force"), (story.colour, stroke), curve(story, TIP_FORCE.1))
    };
    let level = |&(story, name, _): &(&SceneStory, &str, Stroke)| {
        let critical = NANO * story.critical.critical_force;
        line(format!("{name}, critical force"), (story.colour, Stroke::Dotted), curve(story, |_| critical))
    };
    let lines = laws.iter().map(tip_force).chain(laws.iter().map(level));
    let rules = laws.iter().map(|(story, name, _)| Mark::rule(story.critical.time, format!("slip, {name}")));
    let panel = Panel::new(Axis::new("Time", "s"), Axis::new("Tip force F_T", "nN")).with(lines).with(rules);
    let reached = |story: &SceneStory, law: &str| {
        format!("{} {} under {law} friction", force(story.critical.critical_force), slip(story))
    };
    let caption = format!(
        "The tip force rises from {} until the particle slips, at {} and at {}; with the shear modulus of {} GPa that \
         the papers print it slips {} and {}.",
        coulomb.samples.first().map_or_else(String::new, |start| force(start.tip_force)),
        reached(&hk, "Hurtado-Kim"),
        reached(coulomb, "Coulomb"),
        PRINTED_SHEAR_MODULUS / 1e9,
        slip(&printed[0]),
        slip(&printed[1]),
    );
    let both = [("coulomb".to_owned(), coulomb), ("hk".to_owned(), &hk)];
    Ok(PaperFigure {
        stem: "chk-5",
        label: "CHK fig. 5",
        theirs: "The tip force rises to the critical force and then stays; the critical force is lower under Hurtado-Kim \
                 than under Coulomb friction.",
        chart: Chart::new("Tip force against time", caption).panels([panel]),
        csv: stacked("friction", &both, &[TIP_FORCE, LATERAL_FORCE, NORMAL_FORCE]),
    })
}

/// TS04 figure 10, with the relative position at the printed shear modulus beside ours.
fn with_printed(story: &SceneStory, printed: &SceneStory) -> Chart {
    let ours = positions(story);
    let modulus = PRINTED_SHEAR_MODULUS / 1e9;
    let look = (Colour::Series(4), Stroke::Dashed);
    let other = line(format!("the same with G = {modulus} GPa as printed"), look, curve(printed, RELATIVE.1));
    let end = printed.samples.last().map_or(f64::NAN, |end| end.relative_position);
    let caption = format!(
        "{}, and {} if the shear modulus is the {modulus} GPa that the papers print, with which it slips {}.",
        ours.caption().trim_end_matches('.'),
        length(end),
        slip(printed)
    );
    let mut panels = ours.all_panels().to_vec();
    if let Some(panel) = panels.first_mut() {
        // After its own line, the third of the chart.
        panel.marks.insert(panel.marks.len().min(3), other);
    }
    Chart::new(ours.title(), caption).panels(panels)
}

fn positions_csv(story: &SceneStory, printed: &SceneStory) -> String {
    let both = [("E/(2(1+nu))".to_owned(), story), (format!("{} GPa", PRINTED_SHEAR_MODULUS / 1e9), printed)];
    stacked("shear_modulus", &both, &[SUBSTRATE, PARTICLE, RELATIVE, BASE])
}

/// TS04 figure 11.
fn coefficients() -> Result<PaperFigure, FiguresError> {
    // All follow one line until they slip: in this order each is seen.
    let told = COEFFICIENTS.map(|coefficient| story(FrictionLaw::Coulomb, |scene| scene.static_friction = coefficient));
    let told = told.into_iter().collect::<Result<Vec<_>, _>>()?;
    let nominal = Scene::default().static_friction;
    let others = [1, 4, 5, 6].map(Colour::Series);
    let panel = |label: &str, unit: &str, read: fn(&SceneSample) -> f64| {
        let each = told.iter().zip(COEFFICIENTS).zip(others);
        let lines = each.map(|((story, coefficient), other)| {
            let colour = if coefficient == nominal { story.colour } else { other };
            line(format!("μ_s = {coefficient}"), (colour, Stroke::Solid), curve(story, read))
        });
        Panel::new(Axis::new("Time", "s"), Axis::new(label, unit)).with(lines)
    };
    let panels = [panel("Tip force F_T", "nN", TIP_FORCE.1), panel("Position on the substrate", "nm", RELATIVE.1)];
    let mut times: Vec<(f64, f64)> =
        COEFFICIENTS.into_iter().zip(&told).map(|(mu, story)| (mu, story.critical.time)).collect();
    times.reverse();
    let slips: Vec<String> = times.iter().map(|(mu, at)| format!("{} at {mu}", time(*at))).collect();
    let later = times.windows(2).all(|pair| pair[1].1 > pair[0].1);
    let seen = if later {
        "The larger the coefficient of static friction, the later the particle slips"
    } else {
        "The particle slips"
    };
    let stories: Vec<(String, &SceneStory)> = COEFFICIENTS.iter().map(|mu| mu.to_string()).zip(&told).collect();
    Ok(PaperFigure {
        stem: "ts04-11",
        label: "TS04 fig. 11",
        theirs: "A higher coefficient of friction delays the slip.",
        chart: Chart::new("Effect of the coefficient of friction", format!("{seen}: after {}.", listed(&slips)))
            .panels(panels),
        csv: stacked("static_friction", &stories, &[TIP_FORCE, RELATIVE]),
    })
}
