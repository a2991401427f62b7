//! The percentages that LG prints, compared with ours under each plausible meaning.
//!
//! LG does not define its percentages. [`percentages()`] computes our shares by first-order and by total index, of the
//! critical force and of its logarithm, under each friction model and under LuGre friction with the viscous coefficient
//! that brings the velocity to its printed share. Nothing is tuned beyond that one coefficient.

use apportion::EffectEstimates;
use apportion::result::OutputResult;
use apportion::run::RunError;
use apportion_report::document::{Part, Table};
use apportion_report::fixed;
use apportion_report::format::words;

use super::papers::{PRINTED, papers, published};
use super::studies::{Effort, FRICTIONS, GROUPS, StudyGroup, study};
use super::words::{Words, filled};

/// Distance in percentage points up to which a percentage agrees: three times the rounding of the printed numbers.
const MET: f64 = 1.5;

/// The viscous coefficient at which the velocity has its printed share, in place of the printed 1e-7 N s/m.
const VISCOUS: &str = "afm.viscous_friction=0.3 N s/m";

/// The outputs and their symbols.
const OUTPUTS: [(&str, &str); 2] = [("critical_force", "F_cr"), ("log_critical_force", "ln F_cr")];

/// A kind of share: its symbol, and its value for an effect.
type Measure = (&'static str, fn(&EffectEstimates) -> Option<f64>);

const MEASURES: [Measure; 2] = [("S_1", |effect| effect.share_first_order), ("S_T", |effect| effect.share_total)];

/// Our percentages in the three studies under one friction model, by one measure of one output.
#[derive(Debug, Clone, PartialEq)]
pub struct Percentages {
    /// The friction model.
    pub friction: &'static str,
    /// `S_1` or `S_T`, divided by the sum over the factors.
    pub measure: &'static str,
    /// `F_cr` or `ln F_cr`.
    pub output: &'static str,
    /// One entry per study, in the order of [`GROUPS`].
    pub studies: Vec<StudyShares>,
}

/// The percentages of one study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyShares {
    /// The study's group.
    pub group: &'static str,
    /// Each factor with its share in percent, in the order of the study.
    pub shares: Vec<(String, f64)>,
    /// Distance to the printed percentages in percentage points, see [`distance`].
    pub distance: f64,
}

impl StudyShares {
    /// Returns the shares of an output.
    fn new(group: &'static str, output: &OutputResult, share: fn(&EffectEstimates) -> Option<f64>) -> Self {
        let indices = output.indices.iter().flatten();
        // The design does not depend on the user: with it every output of these studies has shares.
        let shares = indices.map(|i| (i.name.clone(), share(&i.effect).expect("a study with shares")));
        let shares: Vec<(String, f64)> = shares.collect();
        let distance = distance(group, shares.iter().map(|(factor, share)| (factor.as_str(), *share)));
        Self { group, shares, distance }
    }

    fn share(&self, factor: &str) -> Option<f64> {
        self.shares.iter().find(|(name, _)| name == factor).map(|(_, share)| *share)
    }
}

impl Percentages {
    fn mean_distance(&self) -> f64 {
        self.studies.iter().map(|study| study.distance).sum::<f64>() / self.studies.len() as f64
    }
}

/// Returns the part of the thickness among thickness, length and width, in percent.
pub(super) fn thickness_part(share: impl Fn(&str) -> Option<f64>) -> Option<f64> {
    let [t, l, w] = ["thickness", "length", "width"].map(share);
    Some(100.0 * t? / (t? + l? + w?))
}

/// Returns the printed percentage of a factor in the study of `group`, if there is one.
fn printed(group: &str, factor: &str) -> Option<f64> {
    published(group, PRINTED).share(factor)
}

/// Returns the distance of `shares`, percentages of all factors of the study `group`, to those of LG, in percentage
/// points: the root mean square of the differences over the printed factors and, as one more, the sum of all other
/// factors, which is printed implicitly as what remains to 100. A printed factor without a share counts as one of 0.
pub fn distance<'a>(group: &str, shares: impl IntoIterator<Item = (&'a str, f64)>) -> f64 {
    let printed = published(group, PRINTED).shares;
    let rest = 100.0 - printed.iter().map(|(_, share)| share).sum::<f64>();
    let mut differences: Vec<f64> = printed.iter().map(|(_, share)| -share).chain([-rest]).collect();
    for (factor, share) in shares {
        differences[printed.iter().position(|(name, _)| *name == factor).unwrap_or(printed.len())] += share;
    }
    (differences.iter().map(|x| x * x).sum::<f64>() / differences.len() as f64).sqrt()
}

/// Runs the studies of the three groups under each friction model and the viscous variant, and computes the shares of
/// both outputs by both measures.
///
/// # Errors
/// [`RunError`] if a study cannot be run.
pub fn percentages(effort: Effort, threads: usize) -> Result<Vec<Percentages>, RunError> {
    let viscous = ("viscous LuGre", PRINTED, &[VISCOUS][..]);
    let models = FRICTIONS.iter().map(|friction| (friction.name, friction.key, &[][..])).chain([viscous]);
    let mut rows = Vec::new();
    for (friction, key, settings) in models {
        let names = OUTPUTS.map(|(output, _)| format!("{output:?}")).join(", ");
        let mut overrides = vec![format!("outputs=[{names}]"), "analysis.convergence=false".to_owned()];
        overrides.extend(settings.iter().map(|setting: &&str| (*setting).to_owned()));
        if effort == Effort::Quick {
            // Within half a percentage point of those of the full effort.
            overrides.push("design.base_samples=512".to_owned());
        }
        let studies = GROUPS.map(|group| study(key, group.key, &overrides).expect("a part of this program"));
        let results =
            studies.iter().map(|study| study.runner().threads(threads).run()).collect::<Result<Vec<_>, _>>()?;
        for (place, (_, output)) in OUTPUTS.into_iter().enumerate() {
            for (measure, share) in MEASURES {
                let studies = GROUPS.iter().zip(&results);
                let studies =
                    studies.map(|(group, result)| StudyShares::new(group.key, &result.outputs[place], share)).collect();
                rows.push(Percentages { friction, measure, output, studies });
            }
        }
    }
    Ok(rows)
}

/// Summarises the percentages: LG does not define its own and they contradict each other; which of ours are nearest;
/// and what the share of the velocity requires.
pub fn summary(rows: &[Percentages]) -> Vec<String> {
    let words = in_words(rows).unwrap_or_default();
    papers().readings.iter().filter(|_| !words.is_empty()).map(|text| filled(text, &words)).collect()
}

fn in_words(rows: &[Percentages]) -> Option<Words> {
    let [dimensional, environmental, general] = GROUPS.map(|group| group.key);
    let [ours, viscous] = ["LuGre", "viscous LuGre"].map(|friction| {
        let row = rows.iter().find(|row| (row.friction, row.measure, row.output) == (friction, "S_1", "F_cr"));
        row.map(|row| &row.studies[..])
    });
    let (ours, viscous) = (ours?, viscous?);
    let nearest = rows.iter().min_by(|a, b| a.mean_distance().total_cmp(&b.mean_distance()))?;
    let meets_all = nearest.studies.iter().all(|study| study.distance <= MET);
    let distances = nearest.studies.iter().map(|study| format!("{} {}", study.group, fixed(study.distance, 1)));
    Some(vec![
        ("dimensional", fixed(printed(dimensional, "thickness")?, 0)),
        ("general", fixed(thickness_part(|factor| printed(general, factor))?, 1)),
        ("ours_dimensional", fixed(thickness_part(|factor| ours[0].share(factor))?, 1)),
        ("ours_general", fixed(thickness_part(|factor| ours[2].share(factor))?, 1)),
        ("meets", if meets_all { "One reading meets" } else { "No reading meets" }.to_owned()),
        ("met", MET.to_string()),
        ("nearest", format!("{} of {} under {} friction", nearest.measure, nearest.output, nearest.friction)),
        ("distances", distances.collect::<Vec<_>>().join(", ")),
        ("velocity", printed(environmental, "velocity")?.to_string()),
        ("viscous", fixed(viscous[1].share("velocity")?, 1)),
        ("lugre", fixed(ours[1].share("velocity")?, 1)),
    ])
}

/// Builds the table of the page: the printed percentages, then a row for each friction model, output and measure.
pub fn table(rows: &[Percentages]) -> Part {
    let caption = "Our shares in percent under each reading, and their distance to the printed percentages of each study: \
                   the root mean square, in percentage points, over the factors with a printed percentage and all others \
                   taken together.";
    let mut table = Table::from_rows(caption, std::iter::once(None).chain(rows.iter().map(Some)))
        .text("friction", |row| row.map_or("printed", |row| row.friction))
        .text("output", |row| row.map_or("", |row| row.output))
        .text("share of the sum of", |row| row.map_or("", |row| row.measure));
    for (place, StudyGroup { key, .. }) in GROUPS.into_iter().enumerate() {
        for (factor, percent) in published(key, PRINTED).shares {
            table = table.number(format!("{key}: {}", words(factor)), |row| {
                one_decimal(row.map_or(Some(*percent), |row| row.studies[place].share(factor)))
            });
        }
        table = table.number(format!("{key}: distance"), |row| one_decimal(row.map(|row| row.studies[place].distance)));
    }
    table.into()
}

fn one_decimal(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| fixed(value, 1))
}

/// Formats one line per friction model, output, measure, study and factor; percentages and distances as in [`table`].
pub fn percentages_csv(rows: &[Percentages]) -> String {
    let studies = rows.iter().flat_map(|row| row.studies.iter().map(move |study| (row, study)));
    let all = studies.flat_map(|(row, study)| study.shares.iter().map(move |share| (row, study, share)));
    Table::from_rows("", all)
        .file("friction", |(row, ..)| row.friction)
        .file("output", |(row, ..)| row.output)
        .file("measure", |(row, ..)| row.measure)
        .file("group", |(_, study, _)| study.group)
        .file("factor", |(.., (factor, _))| factor)
        .file("share", |(.., (_, share))| *share)
        .file("published", |(_, study, (factor, _))| printed(study.group, factor))
        .file("distance", |(_, study, _)| study.distance)
        .csv()
}
