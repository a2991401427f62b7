//! What the papers say, read from `papers.toml`: the order and the percentages of the factors' shares, the claims, and what
//! each figure shows. LG prints percentages in its text; CHK draws bars without numbers, of which only the order is taken. No
//! definition of "percentage" is printed.

use std::sync::LazyLock;

use serde::Deserialize;

/// A published percentage counts as ours if it lies within one percentage point.
pub(super) const CLOSE: f64 = 1.0;

/// The friction model whose percentages are printed.
pub(super) const PRINTED: &str = "lugre";

/// What the papers say.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Papers {
    /// The papers in full.
    pub cited: &'static str,
    /// What LG's percentages say, with names in braces for numbers of ours.
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
    /// Its number, from 1; a number that holds several claims comes several times.
    pub number: usize,
    /// The name of the check that answers it.
    pub check: &'static str,
    /// Where it stands, such as `CHK fig. 6, LG fig. 2a`.
    pub source: &'static str,
    /// What is claimed, in one sentence.
    pub statement: &'static str,
    /// Our figures, in a sentence or two, with names in braces for what the check computes.
    pub finding: String,
    /// The setting in which they hold, likewise.
    pub setting: String,
    /// Stems of the figures that show it.
    pub figures: Vec<&'static str>,
}

/// A constant that a paper prints in another way than it is used, or that no paper prints.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PaperConstant {
    pub name: &'static str,
    /// What is printed, and where.
    pub printed: &'static str,
    /// What is used, with names in braces for values of the scene.
    pub used: &'static str,
    /// Why.
    pub why: &'static str,
}

/// What was computed, in words, by the names in braces that stand for it.
pub(super) type Words = Vec<(&'static str, String)>;

/// `text` with `words` in the place of names in braces.
pub(super) fn filled(text: &str, words: &Words) -> String {
    words.iter().fold(text.to_owned(), |text, (name, word)| text.replace(&format!("{{{name}}}"), word))
}

/// A figure, and what ours is made of: a factor and lines, a group of studies, or else a scene.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PrintedFigure {
    /// The name of its files.
    pub stem: &'static str,
    /// What it shows.
    pub shows: &'static str,
    /// The factor that the critical force is drawn against.
    pub factor: Option<&'static str>,
    /// The keys of the lines, those of the paper first.
    #[serde(default)]
    pub lines: Vec<&'static str>,
    /// Whether the caption says how far apart the first two lines are at either end.
    #[serde(default)]
    pub gap: bool,
    /// The group of studies whose shares are drawn.
    pub shares: Option<&'static str>,
}

/// What the papers say.
pub(super) fn papers() -> &'static Papers {
    static PAPERS: LazyLock<Papers> =
        LazyLock::new(|| toml::from_str(include_str!("papers.toml")).expect("a part of this program"));
    &PAPERS
}

/// What is published about one study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Published {
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

/// What is published about the study of `group` (`dimensional`, `environmental`, `general`) under `friction`.
pub fn published(group: &str, friction: &str) -> Published {
    let found = papers().shares.iter().find(|shares| shares.group == group).expect("a group of the papers");
    Published { ranking: &found.order, shares: if friction == PRINTED { &found.printed } else { &[] } }
}
