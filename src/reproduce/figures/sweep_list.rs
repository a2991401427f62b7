//! Which sweeps the papers draw, and what they say of them.

use crate::reproduce::{COULOMB as COULOMB_COLOUR, HURTADO_KIM, LUGRE as LUGRE_COLOUR};
use apportion::afm::{Fidelity, FrictionLaw, Options, Scene};
use apportion::report::chart::{Colour, Stroke};

/// A figure of the critical force against one factor.
pub(super) struct SweepFigure {
    /// Name of its files.
    pub stem: &'static str,
    /// What the paper calls it.
    pub label: &'static str,
    /// What the paper's figure shows.
    pub theirs: &'static str,
    /// The factor's name in study files.
    pub factor: &'static str,
    /// The lines, those of the paper first.
    pub lines: &'static [Line],
    /// Whether the caption says how far apart the first two lines are at either end.
    pub gap: bool,
}

/// A line of such a figure.
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
    law: FrictionLaw::LuGre,
    variant: Variant::Viscous,
};
const LUGRE_NAIVE: Line = Line {
    key: "lugre_fixed_step_14ms",
    name: "LuGre marched in steps of 14 ms, no event location",
    said: " when marched in steps of 14 ms without event location",
    look: (Colour::Series(6), Stroke::Solid),
    law: FrictionLaw::LuGre,
    variant: Variant::NaiveMarch,
};
const LUGRE_ADHESIVE: Line = Line {
    key: "lugre_adhesion_in_load",
    name: "LuGre with the adhesion in the load (q = 1)",
    said: " with the adhesion in the load",
    look: (LUGRE_COLOUR, Stroke::Dotted),
    law: FrictionLaw::LuGre,
    variant: Variant::AdhesionInLoad,
};
const COULOMB_ADHESIVE: Line = Line {
    key: "coulomb_adhesion_in_load",
    name: "Coulomb with the adhesion in the load (q = 1)",
    said: " under Coulomb friction with the adhesion in the load",
    look: (COULOMB_COLOUR, Stroke::Dotted),
    law: FrictionLaw::Coulomb,
    variant: Variant::AdhesionInLoad,
};

const BOTH: &[Line] = &[COULOMB, HK];
const ALONE: &[Line] = &[LUGRE];

/// The figures, in the order of the papers.
pub(super) const SWEEPS: [SweepFigure; 16] = [
    SweepFigure {
        stem: "chk-6",
        label: "CHK fig. 6",
        theirs: "The critical force falls with the cantilever length, ever more slowly, under both friction models.",
        factor: "length",
        lines: BOTH,
        gap: false,
    },
    SweepFigure {
        stem: "chk-7",
        label: "CHK fig. 7",
        theirs: "The critical force rises linearly with the cantilever width.",
        factor: "width",
        lines: BOTH,
        gap: false,
    },
    SweepFigure {
        stem: "chk-8",
        label: "CHK fig. 8",
        theirs: "The critical force rises steeply with the cantilever thickness.",
        factor: "thickness",
        lines: BOTH,
        gap: false,
    },
    SweepFigure {
        stem: "chk-9",
        label: "CHK fig. 9",
        theirs: "The tip height has no effect on the critical force.",
        factor: "height",
        lines: BOTH,
        gap: false,
    },
    SweepFigure {
        stem: "chk-11",
        label: "CHK fig. 11",
        theirs: "The substrate velocity has no effect on the critical force up to 600 nm/s.",
        factor: "velocity",
        lines: BOTH,
        gap: false,
    },
    SweepFigure {
        stem: "chk-12",
        label: "CHK fig. 12",
        theirs: "The critical force rises linearly with the elastic modulus of the cantilever, and the models diverge.",
        factor: "elastic_modulus",
        lines: BOTH,
        gap: true,
    },
    SweepFigure {
        stem: "chk-13",
        label: "CHK fig. 13",
        theirs: "With the equivalent modulus of the contact the critical force falls under Hurtado-Kim friction, and \
                 stays under Coulomb friction.",
        factor: "equivalent_modulus",
        lines: BOTH,
        gap: false,
    },
    SweepFigure {
        stem: "chk-14",
        label: "CHK fig. 14",
        theirs: "With the work of adhesion the critical force rises under both friction models, which approach each \
                 other.",
        factor: "adhesion",
        lines: &[COULOMB, HK, COULOMB_ADHESIVE],
        gap: true,
    },
    SweepFigure {
        stem: "lg-2a",
        label: "LG fig. 2a",
        theirs: "The critical force falls with the cantilever length, ever more slowly.",
        factor: "length",
        lines: ALONE,
        gap: false,
    },
    SweepFigure {
        stem: "lg-2b",
        label: "LG fig. 2b",
        theirs: "The critical force rises linearly with the cantilever width.",
        factor: "width",
        lines: ALONE,
        gap: false,
    },
    SweepFigure {
        stem: "lg-2c",
        label: "LG fig. 2c",
        theirs: "The critical force rises steeply with the cantilever thickness.",
        factor: "thickness",
        lines: ALONE,
        gap: false,
    },
    SweepFigure {
        stem: "lg-2d",
        label: "LG fig. 2d",
        theirs: "The tip height has no effect on the critical force.",
        factor: "height",
        lines: ALONE,
        gap: false,
    },
    SweepFigure {
        stem: "lg-3a",
        label: "LG fig. 3a",
        theirs: "The substrate velocity has no effect on the critical force up to 600 nm/s; yet LG gives the velocity \
                 26 % of the environmental study.",
        factor: "velocity",
        lines: &[LUGRE, LUGRE_VISCOUS, LUGRE_NAIVE],
        gap: false,
    },
    SweepFigure {
        stem: "lg-3b",
        label: "LG fig. 3b",
        theirs: "The critical force rises linearly with the elastic modulus of the cantilever. LG's own nominal modulus, \
                 102.87 GPa, lies below this range; ours is 169 GPa.",
        factor: "elastic_modulus",
        lines: ALONE,
        gap: false,
    },
    SweepFigure {
        stem: "lg-3c",
        label: "LG fig. 3c",
        theirs: "The equivalent modulus of the contact has no visible effect: LG holds the parameters of the friction \
                 model constant.",
        factor: "equivalent_modulus",
        lines: ALONE,
        gap: false,
    },
    SweepFigure {
        stem: "lg-3d",
        label: "LG fig. 3d",
        theirs: "The work of adhesion has no visible effect: LG holds the parameters of the friction model constant.",
        factor: "adhesion",
        lines: &[LUGRE, LUGRE_ADHESIVE],
        gap: false,
    },
];
