//! What the papers print about the shares. LG prints percentages in its text; CHK draws bars without numbers, of which
//! only the order is taken. No definition of "percentage" is printed.

/// A published percentage counts as ours if it lies within one percentage point.
pub(super) const CLOSE: f64 = 1.0;

/// What is published about one study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Published {
    /// Where it stands.
    pub source: &'static str,
    /// The order of the factors, most influential first; a factor that is not named had no visible share.
    pub ranking: &'static [&'static str],
    /// The percentages, where they are printed.
    pub shares: &'static [(&'static str, f64)],
}

impl Published {
    /// The printed percentage of a factor, where there is one.
    pub fn share(&self, factor: &str) -> Option<f64> {
        self.shares.iter().find(|(name, _)| *name == factor).map(|(_, share)| *share)
    }
}

/// The friction model whose percentages are printed.
pub(super) const PRINTED: &str = "lugre";

const DIMENSIONAL: &[&str] = &["thickness", "length", "width", "height"];
const ENVIRONMENTAL: &[&str] = &["elastic_modulus", "velocity", "adhesion"];
const GENERAL: &[&str] = &["thickness", "length", "width", "elastic_modulus", "velocity", "adhesion"];

/// What is published about the study of `group` (`dimensional`, `environmental`, `general`) under `friction`.
pub fn published(group: &str, friction: &str) -> Published {
    let lugre = friction == PRINTED;
    let (ranking, chk, lg, shares): (_, _, _, &[_]) = match group {
        "dimensional" => (DIMENSIONAL, "CHK fig. 10", "LG fig. 4a", &[("thickness", 76.0)]),
        "environmental" => {
            (ENVIRONMENTAL, "CHK fig. 15", "LG fig. 4b", &[("elastic_modulus", 74.0), ("velocity", 26.0)])
        }
        _ => (
            GENERAL,
            "CHK fig. 16",
            "LG fig. 4c",
            &[("thickness", 80.0), ("length", 12.0), ("width", 5.0), ("elastic_modulus", 3.0)],
        ),
    };
    Published { source: if lugre { lg } else { chk }, ranking, shares: if lugre { shares } else { &[] } }
}
