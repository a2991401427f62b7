//! Outputs in SALib's order, as the runs of a study.

use std::sync::Arc;

use super::{SalibLayout, SalibProblem};
use crate::design::{Design, RowKind, Sampler};
use crate::given::Column;
use crate::model::{FunctionModel, Output, RowFailure};
use crate::run::{RowBlock, Store};
use crate::space::Distribution;
use crate::study::{AnalysisOptions, BuildError, ExternalSubject, Study, SurrogateChoice};
use crate::uncertainty::IntervalMethod;
use apportion_base::quantity::Unit;

/// Returns the study called `name` of an external model with these outputs, in SALib's order, and its runs: a
/// [`Runner`](crate::Runner) with that [store](crate::Runner::store) computes indices by SALib's formulas, with
/// warnings. Outputs that are not finite are failed runs.
///
/// Intervals are percentiles of `resamples` resamples of the base points, with random streams of `seed`; if `resamples`
/// is 0 they are those of the delta method. Both are valid for random points; for Sobol' points they are too wide. The
/// study has a factor for every input or group; the points are unknown, and the distributions have no meaning.
///
/// ```
/// use apportion::given::Column;
/// use apportion::salib::{SalibLayout, SalibProblem, salib_study};
///
/// // y = x1 + 2 x2 at two base points: rows A, AB_1, AB_2, B of each.
/// let values = vec![0.1 + 0.4, 0.9 + 0.4, 0.1 + 1.2, 0.9 + 1.2, 0.7 + 1.6, 0.3 + 1.6, 0.7 + 0.2, 0.3 + 0.2];
/// let problem = SalibProblem::of_inputs(vec!["x1".to_owned(), "x2".to_owned()])?;
/// let outputs = [Column { name: "y".to_owned(), values }];
/// let (study, store) = salib_study("sum", &problem, &outputs, SalibLayout::FirstOrder, (0, 0))?;
/// let result = study.runner().store(&store).run()?;
/// assert_eq!(result.outputs[0].indices.as_ref().unwrap().len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`BuildError`] if there are fewer than two base points, or a name is not valid for a factor, output or study.
pub fn salib_study(
    name: &str,
    problem: &SalibProblem,
    outputs: &[Column],
    layout: SalibLayout,
    (resamples, seed): (usize, u64),
) -> Result<(Study, Store), BuildError> {
    let d = problem.members.len();
    let step = layout.rows_per_point(d);
    let rows = outputs.first().map_or(0, |output| output.values.len());
    let columns = outputs.iter();
    let stated: Vec<Output> =
        columns.map(|column| Output::new(column.name.clone(), Unit::dimensionless(), "read from a file")).collect();
    let mut analysis = AnalysisOptions {
        second_order: layout == SalibLayout::SecondOrder,
        salib: true,
        surrogate: SurrogateChoice::Off,
        intervals: IntervalMethod::Delta,
        ..AnalysisOptions::for_sampler(Sampler::Random)
    };
    if resamples > 0 {
        (analysis.intervals, analysis.resamples) = (IntervalMethod::Percentile, resamples);
    }
    let builder = Study::builder(name, FunctionModel::elsewhere(stated.clone(), Vec::new()))
        .sampler(Sampler::Random)
        .base_samples((rows / step) as u64)
        .replicates(1)
        .seed(seed)
        .analysis(analysis);
    // Any distribution works: the outputs are given, and no point is ever computed.
    let any = Distribution::uniform(0.0, 1.0).expect("0 is below 1");
    let builder = problem.members.iter().fold(builder, |builder, (member, _)| builder.factor(member, any.clone()));
    let mut study = builder.build()?;
    study.title = Some("Points made by SALib".to_owned());
    study.subject = Arc::new(ExternalSubject { outputs: stated, series: Vec::new() });
    let places = places(&study.design, layout, d);
    let points = rows / step;
    let mut block = RowBlock::default();
    let reason = RowFailure::new("the table has no finite number for it");
    for row in (0..points).flat_map(|point| places.iter().map(move |place| point * step + place)) {
        for (number, column) in outputs.iter().enumerate() {
            let value = column.values[row];
            if !value.is_finite() {
                block.failures.push(((block.values.len() / outputs.len()) as u32, number as u32, reason.clone()));
            }
            block.values.push(if value.is_finite() { value } else { f64::NAN });
        }
    }
    let store = Store::new(study.model().as_ref());
    store.insert(&block);
    Ok((study, store))
}

/// Returns for each row of a base point of `design` the index of SALib's row.
fn places(design: &Design, layout: SalibLayout, d: usize) -> Vec<usize> {
    let places = design.runs().iter().map(|run| match run.kind {
        RowKind::A => 0,
        RowKind::Ab(swap) => 1 + swap,
        RowKind::Ba(swap) => 1 + d + swap,
        _ => layout.rows_per_point(d) - 1,
    });
    places.collect()
}
