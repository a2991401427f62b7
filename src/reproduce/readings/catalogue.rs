//! The catalogue of readings: every one is stated here, before anything is computed.

use serde::Serialize;

use apportion::model::AfmOutput;

/// What "percentage of a factor" could mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Effect {
    /// 100 S_i / sum S_j.
    FirstOrder,
    /// 100 ST_i / sum ST_j.
    Total,
    /// 100 S_i.
    PlainFirstOrder,
    /// 100 ST_i.
    PlainTotal,
    /// 100 V_i / sum V_j, V_i the variance when factor i varies alone.
    VarianceAlone,
    /// 100 R_i / sum R_j, R_i the largest minus the smallest output when factor i varies alone.
    RangeAlone,
}

impl Effect {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::FirstOrder, Self::Total, Self::PlainFirstOrder, Self::PlainTotal, Self::VarianceAlone, Self::RangeAlone];

    /// The name in tables and in the ids of readings.
    pub fn name(self) -> &'static str {
        match self {
            Self::FirstOrder => "first-order",
            Self::Total => "total",
            Self::PlainFirstOrder => "plain-first-order",
            Self::PlainTotal => "plain-total",
            Self::VarianceAlone => "variance-alone",
            Self::RangeAlone => "range-alone",
        }
    }

    /// The symbol in charts.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::FirstOrder => "S1",
            Self::Total => "ST",
            Self::PlainFirstOrder => "100 S1",
            Self::PlainTotal => "100 ST",
            Self::VarianceAlone => "variance alone",
            Self::RangeAlone => "range alone",
        }
    }

    /// What it says of a factor, and why it is among the readings.
    pub fn statement(self) -> &'static str {
        match self {
            Self::FirstOrder => {
                "first-order indices, divided by their sum: what each factor does by itself; percentages that sum to 100, \
                 as the printed ones of each group do"
            }
            Self::Total => {
                "total indices, divided by their sum: what each factor does by itself and together with others; the \
                 measure that Sobol' studies rank factors by"
            }
            Self::PlainFirstOrder => {
                "first-order indices in percent of the variance, not divided by their sum: what the definition gives; they \
                 sum to less than 100 where factors interact"
            }
            Self::PlainTotal => {
                "total indices in percent of the variance, not divided by their sum; they sum to more than 100 where \
                 factors interact"
            }
            Self::VarianceAlone => {
                "the variance when one factor varies and the others stand at their nominal values, divided by the sum of \
                 these: one factor at a time, as in the papers' sweeps"
            }
            Self::RangeAlone => {
                "the range of the output when one factor varies and the others stand at their nominal values, divided by \
                 the sum of these: the heights of the papers' sweeps"
            }
        }
    }

    /// The effects that are the percentages of one study whatever its variant.
    pub(super) const NORMALISED: &[Self] = &[Self::FirstOrder, Self::Total];
}

/// What varies against the base reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The friction law and its constants.
    Friction,
    /// How much of the mechanics is kept, and how it is marched.
    Fidelity,
    /// The theory of the contacts, and whether adhesion presses on the substrate.
    Adhesion,
    /// The probe.
    Probe,
}

/// A version of the three LuGre studies: a line of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// Its name in tables.
    pub id: &'static str,
    /// Its name in charts.
    pub name: &'static str,
    /// What varies against the base.
    pub axis: Axis,
    /// What it is, and why it is among the readings: one sentence.
    pub statement: &'static str,
    /// Changes to the LuGre studies, as of `--set`; one that fixes a factor of the study is left out there.
    pub settings: &'static [&'static str],
    /// The effects read from it.
    pub effects: &'static [Effect],
    /// The outputs whose effects are read.
    pub outputs: &'static [AfmOutput],
    /// Base samples of the full effort; a sixteenth of them of the quick one.
    pub base_samples: u64,
}

/// F_cr alone.
const FORCE: &[AfmOutput] = &[AfmOutput::CriticalForce];
/// F_cr and ln F_cr: the logarithm turns the products of the model into sums, and its shares into those of the factors'
/// powers; scripts that take logarithms of forces over decades are common.
pub(super) const BOTH: [AfmOutput; 2] = [AfmOutput::CriticalForce, AfmOutput::LogCriticalForce];

/// Base samples where a run takes less than a microsecond. Readings of as many have the same points, so that what does
/// not act has the same percentages.
const MANY: u64 = 1 << 15;

/// The base reading: LuGre friction with the printed constants, JKR contacts, closed formulas.
pub const BASE: &str = "lugre";

const fn friction(id: &'static str, name: &'static str, statement: &'static str) -> Variant {
    let (axis, effects, outputs) = (Axis::Friction, Effect::NORMALISED, &BOTH);
    Variant { id, name, axis, statement, settings: &[], effects, outputs, base_samples: MANY }
}

const fn adhesion(id: &'static str, name: &'static str, statement: &'static str) -> Variant {
    let (axis, effects, outputs) = (Axis::Adhesion, Effect::NORMALISED, FORCE);
    Variant { id, name, axis, statement, settings: &[], effects, outputs, base_samples: MANY }
}

const fn fidelity(id: &'static str, name: &'static str, statement: &'static str) -> Variant {
    let (axis, effects, outputs) = (Axis::Fidelity, Effect::NORMALISED, FORCE);
    Variant { id, name, axis, statement, settings: &[], effects, outputs, base_samples: 1 << 12 }
}

/// LuGre friction in motion this slow (V at most 8e-4 of v_s) holds F_S = mu_s F_Z to a part in 10^6, which is Coulomb
/// friction without adhesive shear: the same force for a hundredth of the time of the bristles' ramp.
macro_rules! held {
    ($($setting:literal),+) => { &["afm.friction=coulomb", "afm.shear_strength=0 Pa", $($setting),+] };
}

/// Every version of the studies that is read, stated.
pub const VARIANTS: &[Variant] = &[
    Variant {
        effects: &Effect::ALL,
        ..friction(
            BASE,
            "LuGre",
            "LuGre friction with LG's constants, frozen at the nominal modulus and adhesion as LG says; JKR contacts, \
             closed formulas, adhesion not in the load: the base reading",
        )
    },
    Variant {
        settings: &["afm.friction=coulomb"],
        ..friction(
            "coulomb",
            "Coulomb",
            "Coulomb friction with adhesive shear, as in CHK: the percentages might be its",
        )
    },
    Variant {
        settings: &["afm.friction=hk"],
        ..friction("hk", "Hurtado-Kim", "Hurtado-Kim friction, as in CHK: the percentages might be its")
    },
    Variant {
        settings: &["afm.viscous_friction=0.3 N s/m"],
        ..friction(
            "lugre-viscous",
            "viscous LuGre",
            "LuGre friction with a viscous coefficient of 0.3 N s/m instead of 1e-7: the size at which velocity acts \
             beside the elastic modulus, as LG prints it",
        )
    },
    Variant {
        settings: &["afm.lugre_parameters=contact"],
        ..friction(
            "lugre-contact",
            "contact LuGre",
            "LuGre friction whose bristles have the stiffness of the contact instead of the frozen one: modulus and \
             adhesion would act through them if they could",
        )
    },
    Variant {
        settings: held!("afm.fidelity=quasi-static"),
        base_samples: MANY,
        ..fidelity(
            "quasi-static",
            "exact geometry",
            "exact geometry instead of small angles, LuGre friction holding mu_s F_Z: what the closed formulas leave out",
        )
    },
    Variant {
        settings: held!("afm.fidelity=fixed-step", "afm.step=1 ms"),
        base_samples: 1 << 10,
        ..fidelity(
            "step-1",
            "steps of 1 ms",
            "the motion marched in steps of 1 ms without locating the slip, as a simple script would",
        )
    },
    Variant {
        settings: held!("afm.fidelity=fixed-step", "afm.step=2 ms"),
        base_samples: 1 << 11,
        ..fidelity("step-2", "steps of 2 ms", "the same march in steps of 2 ms")
    },
    Variant {
        settings: held!("afm.fidelity=fixed-step", "afm.step=5 ms"),
        ..fidelity("step-5", "steps of 5 ms", "the same march in steps of 5 ms")
    },
    Variant {
        settings: held!("afm.fidelity=fixed-step", "afm.step=10 ms"),
        ..fidelity("step-10", "steps of 10 ms", "the same march in steps of 10 ms")
    },
    Variant {
        settings: held!("afm.fidelity=fixed-step", "afm.step=14 ms"),
        ..fidelity("step-14", "steps of 14 ms", "the same march in steps of 14 ms")
    },
    Variant {
        settings: held!("afm.fidelity=fixed-step", "afm.step=20 ms"),
        ..fidelity("step-20", "steps of 20 ms", "the same march in steps of 20 ms")
    },
    Variant {
        settings: &["afm.contact=hertz"],
        ..adhesion("hertz", "Hertz", "Hertz contacts, without adhesion, instead of JKR")
    },
    Variant { settings: &["afm.contact=dmt"], ..adhesion("dmt", "DMT", "DMT contacts instead of JKR") },
    Variant {
        settings: &["afm.contact=maugis-dugdale"],
        ..adhesion("maugis-dugdale", "Maugis-Dugdale", "Maugis-Dugdale contacts instead of JKR")
    },
    Variant {
        settings: &["afm.contact=cos"],
        ..adhesion("cos", "COS", "contacts by Carpick, Ogletree and Salmeron instead of JKR")
    },
    Variant {
        settings: &["afm.contact=auto"],
        ..adhesion("auto", "by Tabor", "the contact theory chosen in every run by its Tabor parameter")
    },
    Variant {
        settings: &["afm.adhesion_in_load=true"],
        ..adhesion("jkr-load", "JKR in load", "the pull-off force of JKR contacts presses on the substrate too")
    },
    Variant {
        settings: &["afm.contact=hertz", "afm.adhesion_in_load=true"],
        ..adhesion("hertz-load", "Hertz in load", "the same with Hertz contacts, which have no pull-off force")
    },
    Variant {
        settings: &["afm.contact=dmt", "afm.adhesion_in_load=true"],
        ..adhesion("dmt-load", "DMT in load", "the same with DMT contacts")
    },
    Variant {
        settings: &["afm.contact=maugis-dugdale", "afm.adhesion_in_load=true"],
        ..adhesion("maugis-dugdale-load", "Maugis-Dugdale in load", "the same with Maugis-Dugdale contacts")
    },
    Variant {
        settings: &["afm.contact=cos", "afm.adhesion_in_load=true"],
        ..adhesion("cos-load", "COS in load", "the same with contacts by Carpick, Ogletree and Salmeron")
    },
    Variant {
        settings: &["afm.contact=auto", "afm.adhesion_in_load=true"],
        ..adhesion("auto-load", "by Tabor in load", "the same with the contact theory chosen by the Tabor parameter")
    },
    Variant {
        axis: Axis::Probe,
        settings: held!("afm.fidelity=quasi-static", "afm.elastic_modulus=102.87 GPa", "afm.shear_modulus=40.5 GPa"),
        base_samples: MANY,
        ..fidelity(
            "lg-probe",
            "LG's probe",
            "LG's own probe, E = 102.87 GPa where E is no factor and G = 40.5 GPa throughout, with exact geometry since \
             the closed formulas feel no G",
        )
    },
];

/// The variants whose percentages are also computed from small samples: the base, and the one that comes nearest to the
/// printed environmental percentages by construction.
pub const SMALL_SAMPLE_VARIANTS: [&str; 2] = [BASE, "lugre-viscous"];

/// Base samples of the small samples.
pub const SMALL_SAMPLES: [u64; 4] = [100, 200, 500, 1000];

/// The variant of that id.
pub(super) fn variant(id: &str) -> Option<&'static Variant> {
    VARIANTS.iter().find(|variant| variant.id == id)
}

/// An output's symbol in charts.
pub(super) fn symbol(output: AfmOutput) -> &'static str {
    match output {
        AfmOutput::CriticalForce => "F_cr",
        AfmOutput::LogCriticalForce => "ln F_cr",
        other => other.name(),
    }
}
