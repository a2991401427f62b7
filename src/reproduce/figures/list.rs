//! What our figures of the papers are made of: the lines of sweeps, and the scenes.

use super::{Drawn, FiguresError, history, modes};
use crate::reproduce::{COULOMB as COULOMB_COLOUR, HURTADO_KIM, LUGRE as LUGRE_COLOUR};
use apportion::afm::{Fidelity, FrictionLaw, Options, Scene};
use apportion::report::chart::{Colour, Stroke};

/// Draws a figure.
type Draw = fn() -> Result<Drawn, FiguresError>;

/// The figures of the nominal scene by their stems.
pub(super) const SCENES: [(&str, Draw); 8] = [
    ("chk-5", history::two_laws),
    ("ts04-8", history::forces_in_time),
    ("ts04-9", history::tip_force),
    ("ts04-10", history::displacement),
    ("ts04-11", history::coefficients),
    ("ts04-12", modes::against_force_angle),
    ("ts04-12-contact-angle", modes::against_contact_angle),
    ("ts04-13", history::contact_areas),
];

/// A line of a sweep.
pub(super) struct Line {
    /// Its column's name without the unit, and its name in `papers.toml`.
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

/// All lines.
pub(super) const LINES: [Line; 7] = [COULOMB, HK, LUGRE, LUGRE_VISCOUS, LUGRE_NAIVE, LUGRE_ADHESIVE, COULOMB_ADHESIVE];
