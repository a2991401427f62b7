//! Readings over all groups, in the order of their distances.

use super::catalogue::{symbol, variant};
use super::{Reading, Readings};
use crate::reproduce::GROUPS;

/// Readings all of whose percentages differ by less than this, in percentage points, are alike: as LG prints, in whole
/// percent, they would hardly be told apart.
pub(super) const ALIKE: f64 = 0.5;

/// One reading in every group.
#[derive(Debug, Clone)]
pub(in crate::reproduce) struct Joint<'a> {
    /// One entry per group, in the order of [`GROUPS`].
    pub of_groups: Vec<&'a Reading>,
    /// Mean distance over the groups.
    pub mean: f64,
    /// Later readings of the catalogue that are alike; of no account before [`distinct`].
    pub alike: Vec<String>,
}

impl Joint<'_> {
    /// A short name, such as `LuGre: S1, ln F_cr`.
    pub fn name(&self) -> String {
        self.of_groups.first().map_or_else(String::new, |reading| name(reading))
    }

    /// How far off the mean distance is at most while every share lies in its interval; `None` for shares without.
    pub fn mean_error(&self) -> Option<f64> {
        let errors: Vec<f64> = self.of_groups.iter().map(|reading| reading.distance_error).collect::<Option<_>>()?;
        Some(errors.iter().sum::<f64>() / errors.len() as f64)
    }

    /// The largest distance of any group.
    pub fn largest(&self) -> f64 {
        self.of_groups.iter().map(|reading| reading.distance).fold(0.0, f64::max)
    }

    fn is_like(&self, other: &Self) -> bool {
        let shares = |joint: &Self| -> Vec<f64> {
            joint.of_groups.iter().flat_map(|reading| &reading.shares).map(|share| share.share).collect()
        };
        shares(self).iter().zip(shares(other)).all(|(mine, theirs)| (mine - theirs).abs() < ALIKE)
    }
}

/// A short name of a reading, whatever its group.
pub(super) fn name(reading: &Reading) -> String {
    let [friction, output, measure] = words(reading);
    format!("{friction}: {measure}, {output}")
}

/// The parts of the name: which friction (or what else is different), of which output, by which measure.
pub(in crate::reproduce) fn words(reading: &Reading) -> [&'static str; 3] {
    let variant = variant(reading.variant).map_or(reading.variant, |variant| variant.name);
    [variant, symbol(reading.output), reading.effect.symbol()]
}

/// All readings in the order of the catalogue.
pub(in crate::reproduce) fn joint(readings: &Readings) -> Vec<Joint<'_>> {
    readings
        .rows
        .chunks(GROUPS.len())
        .map(|of_groups| Joint {
            mean: of_groups.iter().map(|reading| reading.distance).sum::<f64>() / of_groups.len() as f64,
            of_groups: of_groups.iter().collect(),
            alike: Vec::new(),
        })
        .collect()
}

/// Readings that differ, the nearest on the mean of the groups first; each stands for the later ones of the catalogue that
/// are alike.
pub(super) fn distinct(readings: &Readings) -> Vec<Joint<'_>> {
    let mut distinct: Vec<Joint<'_>> = Vec::new();
    for reading in joint(readings) {
        match distinct.iter_mut().find(|known| known.is_like(&reading)) {
            Some(known) => known.alike.push(reading.name()),
            None => distinct.push(reading),
        }
    }
    distinct.sort_by(|a, b| a.mean.total_cmp(&b.mean));
    distinct
}
