//! The cells of the estimators: indices of outputs that are scaled and shifted, and of designs of any length.

use std::collections::BTreeSet;

use super::ExtremesJob;
use super::indices::{Columns, Indices, difference};
use super::map::{Collector, Example, Finding, Grid, Kind, Outcome};
use crate::analysis::{Analysis, LOST, OutputAnalysis};
use crate::design::{Design, DesignSettings, RowKind, Rows};
use crate::model::{Output, RowFailure, RunContext};
use crate::run::{FailurePolicy, GrowingRun, Job, Piece, RunError, Store};
use crate::study::{AnalysisOptions, Study, SurrogateChoice, Target};

/// Difference of an index from the same estimator in twice the precision above which it is wrong.
const ROUNDING: f64 = 1e-9;
/// Difference that lost digits may make to an index that is called right.
const TOLERANCE: f64 = 1e-3;
/// Powers of ten that outputs are multiplied by.
const SCALES: [i32; 10] = [-300, -200, -150, -100, -50, 50, 100, 150, 200, 300];
/// Powers of ten of standard deviations that are added to outputs.
const OFFSETS: [i32; 8] = [0, 3, 6, 9, 11, 12, 13, 15];
/// Powers of two of base samples.
const LENGTHS: [u32; 18] = [1, 2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30];
/// Base samples whose outputs are scaled and shifted, as far as the runs allow.
const BASE_SAMPLES: u64 = 64;
/// Base points looked at, at each end of a design.
const ENDS: u64 = 4;

/// Looks at the estimators of the study.
pub(super) fn explore(job: &ExtremesJob<'_>, map: &mut Collector) -> Result<(), RunError> {
    transformed(job, map)?;
    long(job, map)
}

/// The study with a design of `base_samples`, all else the same but for surrogates, plain rows and targets.
fn with_length(study: &Study, base_samples: u64) -> Result<Study, crate::design::DesignError> {
    let design = study.design();
    let settings = DesignSettings { base_samples, ..design.settings().clone() };
    let rows = Rows { plain_rows: 0, ..design.asked().clone() };
    Ok(Study {
        design: Design::new(settings, design.factors(), rows)?,
        analysis: AnalysisOptions {
            surrogate: SurrogateChoice::Off,
            failures: FailurePolicy::DropBlock,
            max_failed: 1.0,
            ..study.analysis().clone()
        },
        target: Target::default(),
        ..study.clone()
    })
}

/// What the study makes of the outputs in `store`, and of those that are missing there.
fn analysed(study: &Study, job: &ExtremesJob<'_>, store: &Store) -> Result<Analysis, RunError> {
    let runner = study.runner().threads(job.threads).on_message(job.on_message).store(store);
    match job.stop {
        Some(stop) => runner.stop(stop).run(),
        None => runner.run(),
    }
}

/// The indices of an output in the order of the swaps.
fn of_engine(output: &OutputAnalysis) -> Result<Indices, Finding> {
    let refused = |why: &dyn ToString| Finding::new(Outcome::Refused, why.to_string());
    let indices = output.indices.as_ref().map_err(|why| refused(why))?;
    Ok(indices.effects().map(|effect| [effect.first_order.estimate, effect.total.estimate]).collect())
}

/// Scaled and shifted outputs of a small design.
fn transformed(job: &ExtremesJob<'_>, map: &mut Collector) -> Result<(), RunError> {
    let study = job.study;
    let runs_per_point = study.design().rows_per_point().max(1);
    let fewest = 2 * study.design().settings().replicates;
    let base_samples =
        BASE_SAMPLES.min((job.settings.max_runs / runs_per_point).max(1)).next_power_of_two().max(fewest);
    let Ok(small) = with_length(study, base_samples) else { return Ok(()) };
    let model = small.model();
    let store = Store::new(&small.design, model.as_ref());
    let plain = analysed(&small, job, &store)?;
    let rows: Vec<String> = plain.outputs.iter().map(|output| output.name.replace('_', " ")).collect();
    let columns = |powers: &[i32]| powers.iter().map(ToString::to_string).collect();
    let (scale, offset) =
        ("powers of ten that outputs are multiplied by", "powers of ten of standard deviations added to outputs");
    let grids = [
        map.grid(Grid::new("-scale", "Indices of scaled outputs", scale, rows.clone(), columns(&SCALES))),
        map.grid(Grid::new("-offset", "Indices of shifted outputs", offset, rows, columns(&OFFSETS))),
    ];
    let spreads: Vec<f64> = plain.outputs.iter().map(spread).collect();
    let exact: Vec<Option<Indices>> =
        (0..plain.outputs.len()).map(|output| Columns::new(&small.design, &store, output).indices()).collect();
    let scales = SCALES.iter().enumerate().map(|(column, power)| (Kind::Scale, (grids[0], column), *power));
    let offsets = OFFSETS.iter().enumerate().map(|(column, power)| (Kind::Offset, (grids[1], column), *power));
    for (kind, (grid, column), power) in scales.chain(offsets) {
        let size = 10_f64.powi(power);
        let change = |output: usize, value: f64| match kind {
            Kind::Scale => value * size,
            _ => value + spreads[output] * size,
        };
        let changed = Store::new(&small.design, model.as_ref());
        store.pieces().iter().for_each(|piece| _ = changed.insert(&with_values(piece, store.outputs(), &change)));
        let analysis = analysed(&small, job, &changed)?;
        for (number, output) in analysis.outputs.iter().enumerate() {
            let rounded = Columns::new(&small.design, &changed, number).indices();
            let finding = of_engine(output).map_or_else(
                |refused| refused,
                |found| of_transformed(output, &found, rounded.as_ref(), exact[number].as_ref()),
            );
            let done = if kind == Kind::Scale {
                format!("times 1e{power}")
            } else {
                format!("plus 1e{power} standard deviations")
            };
            let place = format!("{base_samples} base samples, outputs {done}");
            let example = || Example { place, output: output.name.clone(), ..Example::default() };
            map.note(kind, Some((grid, number, column)), finding, example);
        }
    }
    Ok(())
}

/// The standard deviation of an output; 0 if it has none.
fn spread(output: &OutputAnalysis) -> f64 {
    output.values.variance().unwrap_or(0.0).sqrt()
}

fn with_values(piece: &Piece, outputs: usize, change: &dyn Fn(usize, f64) -> f64) -> Piece {
    let mut changed = Piece { values: Vec::new(), ..piece.clone() };
    for (place, &value) in piece.values.iter().enumerate() {
        let (row, output) = (place / outputs, place % outputs);
        let new = change(output, value);
        if value.is_finite() && !new.is_finite() {
            changed.failures.push((row as u32, output as u32, RowFailure::not_finite()));
        }
        changed.values.push(if new.is_finite() { new } else { f64::NAN });
    }
    changed.failures.sort_unstable();
    changed
}

/// Whether the indices `found` of an output are those of its values in more digits, and near those of the values before
/// they were scaled or shifted.
fn of_transformed(
    output: &OutputAnalysis,
    found: &Indices,
    rounded: Option<&Indices>,
    before: Option<&Indices>,
) -> Finding {
    let (Some(rounded), Some(before)) = (rounded, before) else {
        return Finding::new(Outcome::Wrong, "indices where twice the precision finds none");
    };
    // What rounding takes from the outputs it may take from the sums of them as well.
    let rounding = output.error_of_rounding();
    let (arithmetic, off) = (difference(found, rounded), difference(found, before));
    let value = Some(off);
    let is_warned_of = rounding > LOST;
    let finding = match () {
        () if arithmetic > rounding.max(ROUNDING) => {
            Finding::new(Outcome::Wrong, "the indices differ from the same estimator in 106 bits")
        }
        () if output.runs_failed > 0 => {
            Finding::new(Outcome::Flagged, "some of the outputs overflow, and are counted as failed")
        }
        () if off > TOLERANCE && !(is_warned_of && off <= rounding) => Finding::new(
            Outcome::Wrong,
            "the outputs have lost the digits that the indices need, and no warning says so",
        ),
        () if off > TOLERANCE => {
            Finding::new(Outcome::Flagged, "the result warns that the outputs have lost digits that the indices need")
        }
        () if is_warned_of => {
            Finding::new(Outcome::FlaggedConfirmed, "the result warns that the outputs have lost digits")
        }
        () => Finding::new(Outcome::Right, ""),
    };
    Finding { value, reference: Some(0.0), ..finding }
}

/// Designs from 2 to 2^30 base samples: indices as far as the runs allow, and the points, memory and plan of all.
fn long(job: &ExtremesJob<'_>, map: &mut Collector) -> Result<(), RunError> {
    let study = job.study;
    let rows = ["indices", "points", "memory"].map(str::to_owned).to_vec();
    let columns: Vec<String> = LENGTHS.iter().map(ToString::to_string).collect();
    let axis = "base samples, as a power of two";
    let grid = map.grid(Grid::new("-length", "Designs from 2 to 2^30 base samples", axis, rows, columns));
    let outputs = study.model().outputs().to_vec();
    for (column, power) in LENGTHS.into_iter().enumerate() {
        let place = |output: &str| Example {
            place: format!("2^{power} base samples"),
            output: output.to_owned(),
            ..Example::default()
        };
        let (points, memory) = match with_length(study, 1 << power) {
            Ok(long) => {
                for (output, finding) in of_length(&long, job, &outputs)? {
                    map.note(Kind::Length, Some((grid, 0, column)), finding, || place(&output));
                }
                (of_points(&long.design), of_memory(&long, job)?)
            }
            Err(error) => {
                let refused = || Finding::new(Outcome::Refused, error.to_string());
                for output in &outputs {
                    map.note(Kind::Length, Some((grid, 0, column)), refused(), || place(&output.name));
                }
                (refused(), refused())
            }
        };
        map.note(Kind::Points, Some((grid, 1, column)), points, || place(""));
        map.note(Kind::Memory, Some((grid, 2, column)), memory, || place(""));
    }
    Ok(())
}

/// The indices of a design, of every output.
fn of_length(long: &Study, job: &ExtremesJob<'_>, outputs: &[Output]) -> Result<Vec<(String, Finding)>, RunError> {
    let most = job.settings.max_runs;
    let runs = long.design.rows();
    if runs > most {
        // The plan of a study with such a budget.
        let planned = Target::default().max_runs(most).within_max_runs(long.design.clone());
        let finding = || match &planned {
            Ok(design) if design.rows() <= most => Finding::new(
                Outcome::Refused,
                format!("more runs than max_runs = {most} allows: a shorter design is planned"),
            ),
            Ok(_) => Finding::new(Outcome::Wrong, "the plan takes more runs than max_runs allows"),
            Err(_) => Finding::new(Outcome::Refused, format!("no design takes as few runs as max_runs = {most}")),
        };
        return Ok(outputs.iter().map(|output| (output.name.to_string(), finding())).collect());
    }
    let model = long.model();
    let store = Store::new(&long.design, model.as_ref());
    let analysis = analysed(long, job, &store)?;
    let of_output = |(number, output): (usize, &OutputAnalysis)| {
        let exact = Columns::new(&long.design, &store, number).indices();
        let finding = match (of_engine(output), exact) {
            (Err(refused), _) => refused,
            (Ok(_), None) => Finding::new(Outcome::Wrong, "indices where twice the precision finds none"),
            (Ok(found), Some(exact)) => match difference(&found, &exact) {
                off if off > ROUNDING => Finding {
                    value: Some(off),
                    reference: Some(0.0),
                    ..Finding::new(Outcome::Wrong, "the indices differ from the same estimator in 106 bits")
                },
                _ if output.runs_failed > 0 => Finding::new(Outcome::FlaggedConfirmed, "some of the runs failed"),
                _ if !output.warnings.is_empty() => {
                    Finding::new(Outcome::FlaggedConfirmed, "the result warns of its small sample, or of its values")
                }
                _ => Finding::new(Outcome::Right, ""),
            },
        };
        (output.name.clone(), finding)
    };
    Ok(analysis.outputs.iter().enumerate().map(of_output).collect())
}

/// The first and the last points of a design: inside the unit cube, and all different.
fn of_points(design: &Design) -> Finding {
    let per_point = design.rows_per_point();
    let all = design.rows() / per_point;
    let ends = (0..all.min(ENDS)).chain(all.saturating_sub(ENDS).max(ENDS.min(all))..all);
    let mut seen = BTreeSet::new();
    let mut u = vec![0.0; design.factors()];
    for row in ends.flat_map(|point| point * per_point..(point + 1) * per_point) {
        design.point(row, &mut u);
        if !u.iter().all(|&u| u > 0.0 && u < 1.0) {
            return Finding::new(Outcome::Wrong, "a point lies outside of the open unit cube");
        }
        // Others share their columns with these.
        let is_own = matches!(design.locate(row).2, RowKind::A | RowKind::B);
        if is_own && !seen.insert(u.iter().map(|u| u.to_bits()).collect::<Vec<_>>()) {
            return Finding::new(Outcome::Wrong, "two points of the design are the same");
        }
    }
    Finding::new(Outcome::Right, "")
}

/// Whether a run of a design takes the same memory whatever its length, or has room for all of its outputs.
fn of_memory(long: &Study, job: &ExtremesJob<'_>) -> Result<Finding, RunError> {
    if !long.needs_outputs() {
        return Ok(Finding::new(Outcome::Right, ""));
    }
    let (model, context) = (long.model(), RunContext::default());
    let job_of_run = Job { design: &long.design, space: &long.space, model: model.as_ref() };
    let run = GrowingRun::new(job_of_run, &context, job.threads)?.with_outputs_kept(true);
    Ok(match run.room_for(long.design.points_per_replicate()) {
        Ok(()) => Finding::new(Outcome::FlaggedConfirmed, "the outputs of all runs are kept, for which there is room"),
        Err(error) => Finding::new(Outcome::Refused, error.to_string()),
    })
}
