//! Main directions of a series: its principal components over the rows A and B, whose scores are outputs like others.

use nalgebra::{DMatrix, SymmetricEigen};

use super::finished_run::{FinishedRun, outputs_kept};
use super::output::OutputAnalysis;
use crate::estimate::{PointOutputs, Workspace, part_length};
use crate::model::{ExternalModel, Output, OutputSeries};
use crate::run::{BLOCK, BlockPlace, OutputTotals, Place, Totals};

/// Directions are taken until they have so much of the variance,
const SHARE: f64 = 0.95;
/// and at most so many.
const MOST: usize = 5;
/// Share of the variance below which a direction is rounding.
const LEAST: f64 = 1e-12;
/// Rows that the directions are found from where neither these nor the values are fewer: an eigenproblem of this size takes
/// about a second. The scores and their shares are those of all rows.
const ROWS: usize = 1024;

/// A main direction of a series: a principal component over the rows A and B.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Direction {
    /// Its share of the variance of all values together, from 0 to 1.
    pub share: f64,
    /// What one standard deviation of the score adds to every value, in SI units.
    pub loadings: Vec<f64>,
    /// The score, how far a run goes in the direction (in SI units), as an output with indices of its own.
    pub score: OutputAnalysis,
}

/// Why a series has no main directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoDirections {
    /// The outputs of the runs are not there any more.
    #[error(
        "they need the outputs of every run, and this run kept sums alone: fewer base samples or values keep the outputs, or \
         `surrogate = \"on\"`"
    )]
    NotKept,
    /// There are not enough rows.
    #[error("fewer than two runs have all of its values")]
    FewRuns,
    /// There is nothing to see.
    #[error("none of its values varies, or one is beyond double precision")]
    NoVariance,
}

/// The results for all outputs of a run, of which the totals hold the counts over all replicates.
pub(super) type OutputAnalyses<'a> = &'a dyn Fn(&FinishedRun<'_>, &Totals) -> Vec<OutputAnalysis>;

/// The outputs of a series at consecutive base points: by value, then by run.
struct Block<'a> {
    values: Vec<Vec<&'a [f64]>>,
    points: usize,
}

/// The main directions of `series`.
pub(super) fn directions(
    run: &FinishedRun<'_>,
    series: &OutputSeries,
    whole: &Totals,
    analyses: OutputAnalyses<'_>,
) -> Result<Vec<Direction>, NoDirections> {
    let kept: Vec<Vec<&PointOutputs>> = series.places().map(|place| outputs_kept(run.replicates, place)).collect();
    if kept.iter().flatten().any(|outputs| outputs.points() == 0) {
        return Err(NoDirections::NotKept);
    }
    let replicates: Vec<Vec<Block<'_>>> = (0..run.replicates.len()).map(|replicate| blocks(&kept, replicate)).collect();
    let found = components(&centred_rows(replicates.iter().flatten(), series.places().len())?)?;
    let derived: Vec<Totals> =
        replicates.iter().zip(0..).map(|(blocks, replicate)| scores(run, blocks, replicate, &found)).collect();
    let unit = &run.model.outputs()[series.first].unit;
    let names = (1..=found.vectors.len()).map(|number| format!("{}, direction {number}", series.name));
    let model = ExternalModel::new(names.map(|name| Output::new(name, unit.clone(), "a score")).collect());
    // That of all rows A and B, as the variances of the scores are.
    let variance: f64 = series.places().filter_map(|place| whole.outputs[place].values.variance()).sum();
    let scores = FinishedRun { model: &model, replicates: &derived, lows: &[], surrogates: None, ..*run };
    let mut counts = Totals::none(&model);
    derived.iter().for_each(|totals| counts.add_counts(totals));
    let direction = |(score, vector): (OutputAnalysis, &Vec<f64>)| {
        let of_score = score.values.variance().unwrap_or(0.0);
        let sd = of_score.sqrt();
        Direction { share: of_score / variance, loadings: vector.iter().map(|v| sd * v).collect(), score }
    };
    Ok(analyses(&scores, &counts).into_iter().zip(&found.vectors).map(direction).collect())
}

/// The blocks of one replicate of outputs, of which `kept` has every replicate.
fn blocks<'a>(kept: &[Vec<&'a PointOutputs>], replicate: usize) -> Vec<Block<'a>> {
    let mut blocks: Vec<Block<'a>> = Vec::new();
    for of_value in kept {
        for (number, runs) in of_value[replicate].blocks(u64::MAX).enumerate() {
            if number == blocks.len() {
                blocks.push(Block { values: Vec::with_capacity(kept.len()), points: runs[0].len() });
            }
            blocks[number].values.push(runs);
        }
    }
    blocks
}

/// Rows of A and B that have all values, each less the mean: a column of values for each row, and the means.
struct Centred {
    columns: DMatrix<f64>,
    means: Vec<f64>,
}

fn centred_rows<'a>(blocks: impl Iterator<Item = &'a Block<'a>>, values: usize) -> Result<Centred, NoDirections> {
    let mut rows: Vec<f64> = Vec::new();
    for block in blocks {
        for run in 0..2 {
            for point in 0..block.points {
                let start = rows.len();
                rows.extend(block.values.iter().map(|runs| runs[run][point]));
                if rows[start..].iter().any(|value| !value.is_finite()) {
                    rows.truncate(start);
                }
            }
        }
    }
    let mut columns = DMatrix::from_vec(values, rows.len() / values, rows);
    let count = columns.ncols();
    if count < 2 {
        return Err(NoDirections::FewRuns);
    }
    // About the first row, so that a large mean costs no digits.
    let first: Vec<f64> = columns.column(0).iter().copied().collect();
    let mut means = vec![0.0; values];
    for row in columns.column_iter() {
        means.iter_mut().zip(row.iter().zip(&first)).for_each(|(mean, (y, first))| *mean += (y - first) / count as f64);
    }
    means.iter_mut().zip(&first).for_each(|(mean, first)| *mean += first);
    for mut row in columns.column_iter_mut() {
        row.iter_mut().zip(&means).for_each(|(y, mean)| *y -= mean);
    }
    if columns.iter().any(|y| !y.is_finite()) {
        return Err(NoDirections::NoVariance);
    }
    Ok(Centred { columns, means })
}

/// Unit vectors, and the means that scores are counted from.
struct Components {
    vectors: Vec<Vec<f64>>,
    means: Vec<f64>,
}

/// The principal components with the largest shares of the variance.
fn components(centred: &Centred) -> Result<Components, NoDirections> {
    let Centred { columns, means } = centred;
    let (values, rows) = columns.shape();
    let size = columns.amax();
    if size == 0.0 {
        return Err(NoDirections::NoVariance);
    }
    let step = if values.min(rows) > ROWS { rows.div_ceil(ROWS) } else { 1 };
    // Relative to the largest, so that squares neither overflow nor vanish.
    let scaled = DMatrix::from_fn(values, rows.div_ceil(step), |value, row| columns[(value, row * step)] / size);
    let transposed = scaled.transpose();
    let is_gram = scaled.ncols() < values;
    let products = if is_gram { &transposed * &scaled } else { &scaled * &transposed };
    let all = products.trace();
    let eigen = SymmetricEigen::new(products);
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let (mut vectors, mut so_far) = (Vec::new(), 0.0);
    for place in order.into_iter().take(MOST) {
        let share = eigen.eigenvalues[place] / all;
        if so_far >= SHARE || share.is_nan() || share <= LEAST {
            break;
        }
        so_far += share;
        let vector = eigen.eigenvectors.column(place).into_owned();
        let vector = if is_gram { &scaled * vector } else { vector };
        let largest = vector.iter().copied().fold(0.0, |most: f64, v| if v.abs() > most.abs() { v } else { most });
        // The largest entry is positive.
        let length = vector.norm().copysign(largest);
        vectors.push(vector.iter().map(|v| v / length).collect());
    }
    if vectors.is_empty() {
        return Err(NoDirections::NoVariance);
    }
    Ok(Components { vectors, means: means.clone() })
}

/// The totals of the scores of all rows of one replicate.
fn scores(run: &FinishedRun<'_>, blocks: &[Block<'_>], replicate: u64, found: &Components) -> Totals {
    let runs = run.design.runs().len();
    let mut totals = Totals {
        runs: 0,
        failed_runs: 0,
        outputs: vec![OutputTotals::default(); found.vectors.len()],
        flags: Vec::new(),
        counts: Default::default(),
    };
    let (mut first, mut work) = (0, Workspace::default());
    for block in blocks {
        let place = BlockPlace {
            first: Place { replicate, point: first, run: 0 },
            part_length: part_length(first / BLOCK, BLOCK),
            sampled: 0,
            keeps_outputs: true,
        };
        totals.runs += (runs * block.points) as u64;
        for (vector, of_score) in found.vectors.iter().zip(&mut totals.outputs) {
            let of_run = |run: usize| {
                let mut scores = vec![0.0; block.points];
                for ((values, weight), mean) in block.values.iter().zip(vector).zip(&found.means) {
                    scores.iter_mut().zip(values[run]).for_each(|(score, y)| *score += weight * (y - mean));
                }
                scores
            };
            let columns: Vec<Vec<f64>> = (0..runs).map(of_run).collect();
            let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            let mut of_block = OutputTotals::default();
            of_block.set_sums(run.design, &columns, place, &mut work);
            of_block.runs_failed =
                columns.iter().flat_map(|column| column.iter()).filter(|y| !y.is_finite()).count() as u64;
            of_score.append(&of_block);
        }
        first += block.points as u64;
    }
    totals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_the_same_by_either_product() {
        // Three values in two directions: (1, 1, 0) with four times the variance of (0, 0, 1).
        let rows = [[2.0, 2.0, 1.0], [-2.0, -2.0, 1.0], [2.0, 2.0, -1.0], [-2.0, -2.0, -1.0]];
        let columns = |rows: &[[f64; 3]]| DMatrix::from_fn(3, rows.len(), |value, row| rows[row][value]);
        let found =
            |rows: &[[f64; 3]]| components(&Centred { columns: columns(rows), means: vec![0.0; 3] }).unwrap().vectors;
        let expected = [[0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0], [0.0, 0.0, 1.0]];
        let half = [rows[0], [-2.0, -2.0, -1.0]];
        let many = found(&rows);
        for (vector, expected) in many.iter().zip(expected) {
            assert!(vector.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{many:?}");
        }
        // Fewer rows than values: one direction has all.
        let few = found(&half);
        assert!(
            few.len() == 1 && few[0].iter().zip([2.0, 2.0, 1.0]).all(|(a, b)| (a - b / 3.0).abs() < 1e-14),
            "{few:?}"
        );
    }

    #[test]
    fn the_size_of_values_does_not_matter() {
        for size in [1e-200, 1.0, 1e200] {
            let columns = DMatrix::from_row_slice(2, 3, &[size, 0.0, -size, size, 0.0, -size]);
            let found = components(&Centred { columns, means: vec![0.0; 2] }).unwrap().vectors;
            assert!(
                found.len() == 1 && found[0].iter().all(|v| (v - 0.5_f64.sqrt()).abs() < 1e-14),
                "{size}: {found:?}"
            );
        }
        let still = Centred { columns: DMatrix::zeros(2, 3), means: vec![0.0; 2] };
        assert!(components(&still).is_err());
    }
}
