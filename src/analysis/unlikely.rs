//! Values that may stand for something else: codes for missing ones, and slips.

use super::warning::Warning;
use crate::design::Design;
use crate::model::Output;
use crate::quantity::is_same;
use crate::run::{Piece, Store};
use crate::study::Study;

/// Numbers that programs write where there is none; the last two are the fill values of NetCDF in single and double precision.
const CODES: [f64; 12] = [
    -999.0,
    999.0,
    -9999.0,
    9999.0,
    -99999.0,
    99999.0,
    -999999.0,
    999999.0,
    1e20,
    -1e20,
    9.969_209_968_386_869e36,
    9.96921e36,
];

/// So many times the range of all others an extreme value lies beyond them before it is unlikely by itself.
const FAR: f64 = 1e3;

/// Fewest different values of the others: fewer are steps, of which one may be large.
const MIN_VALUES: usize = 10;

/// A value that may be none of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unlikely {
    /// The value.
    pub value: f64,
    /// How often it occurs.
    pub count: usize,
    /// The first place where it does, from 0.
    pub first: usize,
    /// Number of finite values.
    pub of: usize,
    /// The smallest and the largest of the others.
    pub others: (f64, f64),
}

impl Unlikely {
    /// The smallest or largest of the finite `values`, if it is a known code and stands out or is repeated among values that
    /// differ, or if it lies far beyond all others.
    pub fn find(values: &[f64]) -> Option<Self> {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let range = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (low, high) = range(&mut finite());
        [low, high].into_iter().find_map(|value| {
            let others = range(&mut finite().filter(|other| *other != value));
            let width = others.1 - others.0;
            let gap = (value - others.0).abs().min((value - others.1).abs());
            let is_code = CODES.iter().any(|code| is_same(*code, value));
            if others.0 > others.1 || !(is_code || gap > FAR * width) {
                return None;
            }
            let mut rest: Vec<f64> = finite().filter(|other| *other != value).collect();
            rest.sort_unstable_by(f64::total_cmp);
            let distinct = 1 + rest.windows(2).filter(|pair| pair[0] != pair[1]).count();
            let of = finite().count();
            let count = of - rest.len();
            let stands_out = gap > width || count > 1 && 2 * distinct > rest.len();
            let first = values.iter().position(|other| *other == value)?;
            let is_unlikely = distinct >= MIN_VALUES && 2 * count <= of && stands_out;
            is_unlikely.then_some(Self { value, count, first, of, others })
        })
    }

    /// A sentence on it; `row` is the row of its first place, from 1.
    pub fn words(&self, row: usize) -> String {
        let Self { value, count, of, others: (low, high), .. } = self;
        format!(
            "the value {value:?} stands in {count} of {of} rows (the first is row {row}), and all others lie between {low:?} and \
             {high:?}: if it stands for a missing value, have it read as one (--missing-value={value:?})"
        )
    }
}

/// For each output of `study` a sentence on the unlikely value among those in `store`, if there is one.
pub fn unlikely_outputs(study: &Study, store: &Store) -> Vec<Option<String>> {
    let design = &study.design;
    let rows = design.points_per_replicate() * design.rows_per_point();
    let pieces: Vec<Piece> =
        (0..design.settings().replicates).filter_map(|replicate| store.piece(replicate, 0..rows)).collect();
    let model = study.model();
    let outputs = model.outputs();
    let of_output = |(number, output): (usize, &Output)| {
        let values = pieces.iter().flat_map(|piece| piece.values.iter().skip(number).step_by(outputs.len()));
        let found = Unlikely::find(&values.map(|si| output.unit.from_si(*si)).collect::<Vec<f64>>())?;
        Some(found.words(found.first + 1))
    };
    outputs.iter().enumerate().map(of_output).collect()
}

/// A sentence on the unlikely value among the `samples` of an output: of every replicate of `design` the first rows A and B.
pub(super) fn of_samples(design: &Design, output: &Output, samples: &[Vec<f64>]) -> Option<Warning> {
    let values: Vec<f64> = samples.iter().flatten().map(|si| output.unit.from_si(*si)).collect();
    let found = Unlikely::find(&values)?;
    let (mut place, mut replicate) = (found.first, 0);
    while place >= samples[replicate].len() {
        place -= samples[replicate].len();
        replicate += 1;
    }
    let point = replicate as u64 * design.points_per_replicate() + place as u64 / 2;
    let text = found.words((point * design.rows_per_point()) as usize + place % 2 + 1);
    Some(Warning::Unlikely { text })
}

#[cfg(test)]
mod tests;
