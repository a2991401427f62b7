//! The statements of the papers, read from `papers.toml`: the order and the percentages of the factors' shares, the
//! claims, and the contents of each figure. LG prints percentages in its text; CHK draws bars without numbers, of which
//! only the order is used. The papers do not define "percentage".

use std::sync::LazyLock;

use serde::Deserialize;

/// Maximum difference in percentage points between a published percentage and ours.
pub(super) const CLOSE: f64 = 1.0;

/// The friction model whose percentages are printed.
pub(super) const PRINTED: &str = "lugre";

/// The statements of the papers.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Papers {
    /// The full citations.
    pub cited: &'static str,
    /// Statements on LG's percentages, with names in braces for our numbers.
    pub readings: Vec<String>,
    shares: Vec<GroupShares>,
    pub claims: Vec<PaperClaim>,
    pub constants: Vec<PaperConstant>,
    pub figures: Vec<PrintedFigure>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GroupShares {
    group: &'static str,
    order: Vec<&'static str>,
    printed: Vec<(&'static str, f64)>,
}

/// A claim.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PaperClaim {
    /// Its number, from 1; several claims may share a number.
    pub number: usize,
    /// The name of its check.
    pub check: &'static str,
    /// Its source, such as `CHK fig. 6, LG fig. 2a`.
    pub source: &'static str,
    /// The claim in one sentence.
    pub statement: &'static str,
    /// Our result, in a sentence or two, with names in braces for the computed values.
    pub finding: String,
    /// The setting of the result, likewise.
    pub setting: String,
    /// Stems of its figures.
    pub figures: Vec<&'static str>,
}

/// A constant that a paper prints in another form than it uses, or that no paper prints.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PaperConstant {
    pub name: &'static str,
    /// The printed value and its source.
    pub printed: &'static str,
    /// The value used, with names in braces for values of the scene.
    pub used: &'static str,
    /// The reason.
    pub why: &'static str,
}

/// A figure and the data of ours: a factor and lines, a group of studies, or else a scene.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PrintedFigure {
    /// The name of its files.
    pub stem: &'static str,
    /// Its content.
    pub shows: &'static str,
    /// The factor that the critical force is drawn against.
    pub factor: Option<&'static str>,
    /// The keys of the lines, those of the paper first.
    #[serde(default)]
    pub lines: Vec<&'static str>,
    /// Whether the caption states the distance of the first two lines at either end.
    #[serde(default)]
    pub gap: bool,
    /// The group of studies whose shares are drawn.
    pub shares: Option<&'static str>,
}

/// Returns the statements of the papers.
pub(super) fn papers() -> &'static Papers {
    static PAPERS: LazyLock<Papers> =
        LazyLock::new(|| toml::from_str(include_str!("papers.toml")).expect("a part of this program"));
    &PAPERS
}

/// The published results of one study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Published {
    /// The order of the factors, most influential first; a missing factor had no visible share.
    pub ranking: &'static [&'static str],
    /// The percentages, where they are printed.
    pub shares: &'static [(&'static str, f64)],
}

impl Published {
    /// Returns the printed percentage of a factor, if there is one.
    pub fn share(&self, factor: &str) -> Option<f64> {
        self.shares.iter().find(|(name, _)| *name == factor).map(|(_, share)| *share)
    }
}

/// Returns the published results of the study of `group` (`dimensional`, `environmental`, `general`) under `friction`.
pub fn published(group: &str, friction: &str) -> Published {
    let printed = papers().shares.iter().find(|shares| shares.group == group).expect("a group of the papers");
    Published { ranking: &printed.order, shares: if friction == PRINTED { &printed.printed } else { &[] } }
}
