//! Simulation of one scene of a study in time, and of the diagram of other motions of the particle.

use apportion::study::Study;
use apportion_afm::history::{Sample, history};
use apportion_afm::modes::{Mode, Pushing, TipForce};
use apportion_afm::{AfmSubject, Failure, Fidelity, Options, Parameter, Scene, critical_force, edge_unit};
use apportion_report::chart::{Colour, Stroke};
use apportion_report::with_unit;
use thiserror::Error;

use super::charts::law_colour;
use super::mode_diagram::{ModeDiagram, ModeLine};
use super::story::{SceneSample, SceneStory};

/// Why a study cannot be simulated in time.
#[derive(Debug, Error)]
pub enum SceneError {
    /// The study has another model.
    #[error(
        "only the nanoparticle model (model = \"afm\") has a scene in time, but the model of this study is `{model}`"
    )]
    OtherModel {
        /// The name of that model.
        model: String,
    },
    /// The scene has no solution, as at velocity 0.
    #[error("the scene cannot be simulated: {0}")]
    Failed(#[from] Failure),
}

/// Returns the scene of a study: its constants, with every factor at its nominal value.
fn scene_of(study: &Study) -> Result<(Scene, Options), SceneError> {
    let other_model = || SceneError::OtherModel { model: study.subject().name().to_owned() };
    let afm = study.subject().downcast_ref::<AfmSubject>().ok_or_else(other_model)?;
    let mut scene = afm.scene;
    for factor in study.space().factors() {
        if let Some(parameter) = Parameter::from_name(&factor.name) {
            (parameter.set)(&mut scene, factor.unit().to_si(factor.nominal));
        }
    }
    Ok((scene, afm.options))
}

/// Simulates the scene of `study`, for `duration` seconds; by default for twice the critical time.
///
/// # Errors
/// [`SceneError`] if the study has no scene, or the scene no solution.
pub fn simulate(study: &Study, duration: Option<f64>) -> Result<SceneStory, SceneError> {
    let (scene, options) = scene_of(study)?;
    let quasi_static = Options { fidelity: Fidelity::QuasiStatic, ..options };
    let duration = match duration {
        Some(duration) => duration,
        None => 2.0 * critical_force(&scene, &quasi_static)?.critical_time?,
    };
    let title = study.title().unwrap_or(study.name()).to_owned();
    Ok(scene_story(title, &scene, &options, duration)?)
}

/// Simulates a scene, for `duration` seconds, by the quasi-static rung for any fidelity of the options.
///
/// # Errors
/// Those of [`history`].
pub fn scene_story(title: String, scene: &Scene, options: &Options, duration: f64) -> Result<SceneStory, Failure> {
    let outcome = history(scene, options, duration)?;
    let pushing = pushing(*scene, options);
    let samples = outcome.samples.iter().map(|sample| scene_sample(sample, &pushing)).collect::<Result<_, _>>()?;
    Ok(SceneStory {
        title,
        setting: setting(scene, options),
        scene: *scene,
        critical: outcome.critical,
        critical_time: outcome.critical.critical_time?,
        colour: law_colour(options.friction),
        samples,
    })
}

/// Returns the possible motions of the particle of a scene under its options, with the default constants of the modes.
pub(crate) fn pushing(scene: Scene, options: &Options) -> Pushing {
    Pushing { theory: options.contact, adhesion_in_load: options.adhesion_in_load, ..Pushing::new(scene) }
}

fn scene_sample(sample: &Sample, pushing: &Pushing) -> Result<SceneSample, Failure> {
    let force = TipForce { normal: sample.normal_force, lateral: sample.lateral_force };
    let [tip_slip, rolling, spin] =
        [Mode::TipSlip, Mode::Roll, Mode::Spin].map(|mode| match pushing.balance(mode, force) {
            Ok(balance) => Ok(balance.moves()),
            // A contact that is pulled apart cannot slip, roll or spin.
            Err(Failure::BeyondPullOff) => Ok(false),
            Err(failure) => Err(failure),
        });
    Ok(SceneSample { state: *sample, tip_slip: tip_slip?, rolling: rolling?, spin: spin? })
}

fn setting(scene: &Scene, options: &Options) -> Vec<(String, String)> {
    let choices = [
        ("friction", options.friction.name()),
        ("contact", options.contact.name()),
        ("torsion", options.torsion.name()),
        ("adhesion in load", if options.adhesion_in_load { "yes" } else { "no" }),
        // The history is quasi-static for any fidelity of the study's critical forces.
        ("motion", Fidelity::QuasiStatic.name()),
    ];
    let mut setting = choices.map(|(label, choice)| (label.to_owned(), choice.to_owned())).to_vec();
    for parameter in Parameter::ALL {
        let unit = edge_unit(parameter);
        let value = with_unit(unit.from_si((parameter.get)(scene)), unit.symbol());
        setting.push((parameter.name.replace('_', " "), value));
    }
    setting
}

/// Number of angles in the mode diagram.
const ANGLES: usize = 180;

/// Returns for every mode of motion the tip force at which the particle of `study` begins it, against the force's angle
/// from the vertical (Tafazzoli and Sitti 2004, fig. 12).
///
/// # Errors
/// [`SceneError`] if the study has no scene, or the scene no solution.
pub fn mode_diagram(study: &Study) -> Result<ModeDiagram, SceneError> {
    let (scene, options) = scene_of(study)?;
    Ok(scene_modes(&scene, &options)?)
}

/// Returns the mode diagram of a scene, like [`mode_diagram`] for a study.
///
/// # Errors
/// Those of [`critical_force`] and of [`Pushing::balance`].
pub fn scene_modes(scene: &Scene, options: &Options) -> Result<ModeDiagram, Failure> {
    let pushing = pushing(*scene, options);
    let critical = critical_force(scene, options)?;
    // The scene's angle is included, so that its slip can be read from the steep curves.
    let grid = (1..ANGLES).map(|i| std::f64::consts::FRAC_PI_2 * i as f64 / ANGLES as f64);
    let mut angle: Vec<f64> = grid.chain([critical.force_angle()]).collect();
    angle.sort_by(f64::total_cmp);
    let colours = [law_colour(options.friction), Colour::Series(1), Colour::Series(4), Colour::Series(5)];
    let mut forces = Vec::new();
    for (&mode, colour) in Mode::ALL.iter().zip(colours) {
        let force = angle.iter().map(|psi| pushing.critical_tip_force(mode, *psi)).collect::<Result<_, Failure>>()?;
        forces.push(ModeLine { name: mode.name().to_owned(), look: (colour, Stroke::Solid), force });
    }
    Ok(ModeDiagram { angle, forces, slip: (critical.force_angle(), critical.critical_force) })
}
