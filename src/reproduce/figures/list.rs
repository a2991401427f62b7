//! The figures of the papers: what each shows, and what ours is made of.

use super::{Drawn, FiguresError, history, modes};
use crate::reproduce::{COULOMB as COULOMB_COLOUR, HURTADO_KIM, LUGRE as LUGRE_COLOUR};
use apportion::afm::{Fidelity, FrictionLaw, Options, Scene};
use apportion::report::chart::{Colour, Stroke};

/// What a figure of ours is made of.
pub(super) enum Ours {
    /// The critical force against one factor.
    Sweep(SweepFigure),
    /// The nominal scene.
    Scene(fn() -> Result<Drawn, FiguresError>),
    /// The studies of the group with that key, under the friction models for whose key this holds.
    Shares(&'static str, fn(&str) -> bool),
}

/// The critical force against one factor.
pub(super) struct SweepFigure {
    /// The factor's name in study files.
    pub factor: &'static str,
    /// The lines, those of the paper first.
    pub lines: &'static [Line],
    /// Whether the caption says how far apart the first two lines are at either end.
    pub gap: bool,
}

const fn sweep(factor: &'static str, lines: &'static [Line]) -> Ours {
    Ours::Sweep(SweepFigure { factor, lines, gap: false })
}

/// A sweep whose caption says how far apart the first two lines are.
const fn sweep_with_gap(factor: &'static str, lines: &'static [Line]) -> Ours {
    Ours::Sweep(SweepFigure { factor, lines, gap: true })
}

/// A line of a sweep.
pub(super) struct Line {
    /// Its column's name, without the unit.
    pub key: &'static str,
    /// Its name in the legend.
    pub name: &'static str,
    /// How a sentence calls it.
    pub said: &'static str,
    /// Its look.
    pub look: (Colour, Stroke),
    /// The law of friction.
    pub law: FrictionLaw,
    /// What differs from the papers' defaults.
    pub variant: Variant,
}

/// What differs from the papers' defaults.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Variant {
    /// Nothing.
    None,
    /// Viscous friction sigma2 = 0.3 N s/m.
    Viscous,
    /// Friction feels the pull-off force too.
    AdhesionInLoad,
    /// The equations of motion marched in steps of 14 ms, the force read at the first step past the slip.
    NaiveMarch,
}

impl Variant {
    /// The scene and the options of a line.
    pub fn apply(self, law: FrictionLaw) -> (Scene, Options) {
        let (mut scene, mut options) = (Scene::default(), Options { friction: law, ..Options::default() });
        match self {
            Self::None => (),
            Self::Viscous => scene.viscous_friction = 0.3,
            Self::AdhesionInLoad => options.adhesion_in_load = true,
            Self::NaiveMarch => (options.fidelity, options.step) = (Fidelity::FixedStep, 14e-3),
        }
        (scene, options)
    }
}

const COULOMB: Line = Line {
    key: "coulomb",
    name: "Coulomb",
    said: " under Coulomb friction",
    look: (COULOMB_COLOUR, Stroke::Solid),
    law: FrictionLaw::Coulomb,
    variant: Variant::None,
};
const HK: Line = Line {
    key: "hk",
    name: "Hurtado-Kim",
    said: " under Hurtado-Kim friction",
    look: (HURTADO_KIM, Stroke::Solid),
    law: FrictionLaw::HurtadoKim,
    variant: Variant::None,
};
const LUGRE: Line = Line {
    key: "lugre",
    name: "LuGre",
    said: " under LuGre friction",
    look: (LUGRE_COLOUR, Stroke::Solid),
    law: FrictionLaw::LuGre,
    variant: Variant::None,
};
const LUGRE_VISCOUS: Line = Line {
    key: "lugre_viscous",
    name: "LuGre with viscous friction σ₂ = 0.3 N s/m",
    said: " with viscous friction of 0.3 N s/m",
    look: (LUGRE_COLOUR, Stroke::Dotted),
    variant: Variant::Viscous,
    ..LUGRE
};
const LUGRE_NAIVE: Line = Line {
    key: "lugre_fixed_step_14ms",
    name: "LuGre marched in steps of 14 ms, no event location",
    said: " when marched in steps of 14 ms without event location",
    look: (Colour::Series(6), Stroke::Solid),
    variant: Variant::NaiveMarch,
    ..LUGRE
};
const LUGRE_ADHESIVE: Line = Line {
    key: "lugre_adhesion_in_load",
    name: "LuGre with the adhesion in the load (q = 1)",
    said: " with the adhesion in the load",
    look: (LUGRE_COLOUR, Stroke::Dotted),
    variant: Variant::AdhesionInLoad,
    ..LUGRE
};
const COULOMB_ADHESIVE: Line = Line {
    key: "coulomb_adhesion_in_load",
    name: "Coulomb with the adhesion in the load (q = 1)",
    said: " under Coulomb friction with the adhesion in the load",
    look: (COULOMB_COLOUR, Stroke::Dotted),
    variant: Variant::AdhesionInLoad,
    ..COULOMB
};

const BOTH: &[Line] = &[COULOMB, HK];
const ALONE: &[Line] = &[LUGRE];

/// The figures in the order of the papers: CHK, LG, TS04, then the friction models side by side. Each has the name of its
/// files, what ours is made of, and what the paper's shows.
pub(super) static FIGURES: [(&str, Ours, &str); 33] = [
    (
        "chk-5",
        Ours::Scene(history::two_laws),
        "The tip force rises to the critical force and then stays; the critical force is lower under Hurtado-Kim \
         than under Coulomb friction.",
    ),
    (
        "chk-6",
        sweep("length", BOTH),
        "The critical force falls with the cantilever length, ever more slowly, under both friction models.",
    ),
    ("chk-7", sweep("width", BOTH), "The critical force rises linearly with the cantilever width."),
    ("chk-8", sweep("thickness", BOTH), "The critical force rises steeply with the cantilever thickness."),
    ("chk-9", sweep("height", BOTH), "The tip height has no effect on the critical force."),
    (
        "chk-10",
        Ours::Shares("dimensional", is_chk),
        "Bars without numbers: thickness before length before width before height under both friction models.",
    ),
    ("chk-11", sweep("velocity", BOTH), "The substrate velocity has no effect on the critical force up to 600 nm/s."),
    (
        "chk-12",
        sweep_with_gap("elastic_modulus", BOTH),
        "The critical force rises linearly with the elastic modulus of the cantilever, and the models diverge.",
    ),
    (
        "chk-13",
        sweep("equivalent_modulus", BOTH),
        "With the equivalent modulus of the contact the critical force falls under Hurtado-Kim friction, and \
         stays under Coulomb friction.",
    ),
    (
        "chk-14",
        sweep_with_gap("adhesion", &[COULOMB, HK, COULOMB_ADHESIVE]),
        "With the work of adhesion the critical force rises under both friction models, which approach each \
         other.",
    ),
    (
        "chk-15",
        Ours::Shares("environmental", is_chk),
        "Bars without numbers: elastic modulus before velocity before adhesion under both friction models.",
    ),
    (
        "chk-16",
        Ours::Shares("general", is_chk),
        "Bars without numbers: thickness before length, width, elastic modulus, velocity and adhesion under both \
         friction models.",
    ),
    ("lg-2a", sweep("length", ALONE), "The critical force falls with the cantilever length, ever more slowly."),
    ("lg-2b", sweep("width", ALONE), "The critical force rises linearly with the cantilever width."),
    ("lg-2c", sweep("thickness", ALONE), "The critical force rises steeply with the cantilever thickness."),
    ("lg-2d", sweep("height", ALONE), "The tip height has no effect on the critical force."),
    (
        "lg-3a",
        sweep("velocity", &[LUGRE, LUGRE_VISCOUS, LUGRE_NAIVE]),
        "The substrate velocity has no effect on the critical force up to 600 nm/s; yet LG gives the velocity 26 \
         % of the environmental study.",
    ),
    (
        "lg-3b",
        sweep("elastic_modulus", ALONE),
        "The critical force rises linearly with the elastic modulus of the cantilever. LG's own nominal modulus, \
         102.87 GPa, lies below this range; ours is 169 GPa.",
    ),
    (
        "lg-3c",
        sweep("equivalent_modulus", ALONE),
        "The equivalent modulus of the contact has no visible effect: LG holds the parameters of the friction \
         model constant.",
    ),
    (
        "lg-3d",
        sweep("adhesion", &[LUGRE, LUGRE_ADHESIVE]),
        "The work of adhesion has no visible effect: LG holds the parameters of the friction model constant.",
    ),
    (
        "lg-4a",
        Ours::Shares("dimensional", is_lg),
        "Thickness before length before width before height; the text gives the thickness 76 %.",
    ),
    (
        "lg-4b",
        Ours::Shares("environmental", is_lg),
        "Elastic modulus before velocity before adhesion; the text gives 74 % and 26 % to the first two.",
    ),
    (
        "lg-4c",
        Ours::Shares("general", is_lg),
        "Thickness before length, width and elastic modulus; the text gives them 80, 12, 5 and 3 %.",
    ),
    (
        "ts04-8",
        Ours::Scene(history::forces_in_time),
        "The lateral force grows, the normal force stays nearly constant, and the tip force rises to the \
         critical force and stays there.",
    ),
    ("ts04-9", Ours::Scene(history::tip_force), "The pushing force rises to the critical force and stays there."),
    (
        "ts04-10",
        Ours::Scene(history::displacement),
        "The particle rides on the substrate, slips near 0.2 s, and stands 21 nm behind it after 0.4 s.",
    ),
    ("ts04-11", Ours::Scene(history::coefficients), "A higher coefficient of friction delays the slip."),
    (
        "ts04-12",
        Ours::Scene(modes::against_force_angle),
        "A larger contact angle lowers the force at which the particle slides.",
    ),
    (
        "ts04-12-contact-angle",
        Ours::Scene(modes::against_contact_angle),
        "A larger contact angle lowers the force at which the particle slides.",
    ),
    (
        "ts04-13",
        Ours::Scene(history::contact_areas),
        "While the particle is pushed, contact area and indentation grow at the tip and shrink at the substrate.",
    ),
    ("dimensional", Ours::Shares("dimensional", |_| true), "The papers show them in separate figures."),
    ("environmental", Ours::Shares("environmental", |_| true), "The papers show them in separate figures."),
    ("general", Ours::Shares("general", |_| true), "The papers show them in separate figures."),
];

fn is_chk(friction: &str) -> bool {
    friction != "lugre"
}

fn is_lg(friction: &str) -> bool {
    friction == "lugre"
}
