//! The nine studies of the papers: three groups of factors, each under three friction models.

use apportion::result::StudyResult;
use apportion::study::Study;
use apportion_afm::FrictionLaw;
use apportion_files::StudyError;
use apportion_report::chart::{Colour, Stroke};

use crate::scene::law_colour;

/// How much is computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Effort {
    /// The sizes that the conclusions are based on.
    #[default]
    Full,
    /// The same with fewer points, for a quick look.
    Quick,
}

/// A friction model of the papers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Friction {
    /// The law.
    pub law: FrictionLaw,
    /// Its name in study files.
    pub key: &'static str,
    /// Its name for people.
    pub name: &'static str,
    /// Its colour in charts.
    pub colour: Colour,
    /// Its lines, and the hatches of its bars.
    pub stroke: Stroke,
}

impl Friction {
    const fn new(law: FrictionLaw, name: &'static str, stroke: Stroke) -> Self {
        Self { law, key: law.name(), name, colour: law_colour(law), stroke }
    }
}

/// The friction models, in the order of the papers' charts.
pub const FRICTIONS: [Friction; 3] = [
    Friction::new(FrictionLaw::Coulomb, "Coulomb", Stroke::Solid),
    Friction::new(FrictionLaw::HurtadoKim, "Hurtado-Kim", Stroke::Dashed),
    Friction::new(FrictionLaw::LuGre, "LuGre", Stroke::Dotted),
];

/// A group of studies: the same factors under each friction model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StudyGroup {
    /// Its name in file names.
    pub key: &'static str,
    /// The figures of the papers that it reproduces.
    pub figures: &'static str,
    /// The varied factors.
    pub title: &'static str,
}

/// The groups, in the order of the papers.
pub const GROUPS: [StudyGroup; 3] = [
    StudyGroup { key: "dimensional", figures: "CHK fig. 10, LG fig. 4a", title: "the cantilever's dimensions" },
    StudyGroup { key: "environmental", figures: "CHK fig. 15, LG fig. 4b", title: "the environment" },
    StudyGroup { key: "general", figures: "CHK fig. 16, LG fig. 4c", title: "all eight factors" },
];

/// The study files, by name: embedded in the program, so that it can reproduce the papers anywhere.
const STUDIES: [(&str, &str); 9] = [
    ("coulomb-dimensional", include_str!("../../../../studies/coulomb-dimensional.toml")),
    ("hk-dimensional", include_str!("../../../../studies/hk-dimensional.toml")),
    ("lugre-dimensional", include_str!("../../../../studies/lugre-dimensional.toml")),
    ("coulomb-environmental", include_str!("../../../../studies/coulomb-environmental.toml")),
    ("hk-environmental", include_str!("../../../../studies/hk-environmental.toml")),
    ("lugre-environmental", include_str!("../../../../studies/lugre-environmental.toml")),
    ("coulomb-general", include_str!("../../../../studies/coulomb-general.toml")),
    ("hk-general", include_str!("../../../../studies/hk-general.toml")),
    ("lugre-general", include_str!("../../../../studies/lugre-general.toml")),
];

/// The settings of every study in a quick reproduction, unless the overrides say otherwise.
pub const QUICK: [&str; 1] = ["design.base_samples=2048"];

/// A study with its result.
#[derive(Debug, Clone)]
pub struct Reproduced {
    /// Its friction model.
    pub friction: Friction,
    /// Its group.
    pub group: StudyGroup,
    /// Its result.
    pub result: StudyResult,
}

/// Returns the nine studies, read and checked, after applying `overrides` to each; group by group. The overrides should
/// only change the design: with others they are no longer the papers' studies.
///
/// # Errors
/// [`StudyError`] if an override is invalid.
pub fn studies(overrides: &[String]) -> Result<Vec<(StudyGroup, Friction, Study)>, StudyError> {
    let all = GROUPS.into_iter().flat_map(|group| FRICTIONS.map(|friction| (group, friction)));
    all.map(|(group, friction)| Ok((group, friction, study(friction.key, group.key, overrides)?))).collect()
}

/// Returns the study of a group under a friction model, by their keys.
pub(super) fn study(friction: &str, group: &str, overrides: &[String]) -> Result<Study, StudyError> {
    let name = format!("{friction}-{group}");
    let text = STUDIES.iter().find(|(study, _)| *study == name).map_or("", |(_, text)| text);
    apportion_files::parse_study(text, format!("studies/{name}.toml").as_ref(), overrides)
}

/// Returns the study that has all factors with their ranges.
pub fn general_study() -> Study {
    study("coulomb", "general", &[]).expect("a part of this program")
}
