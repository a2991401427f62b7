//! Functions with known indices at the rows of a design: the outputs that the estimators are fed with.

use std::ops::Range;

use apportion::design::{Design, DesignSettings, Rows};
use apportion::estimate::{BlockOutputs, Moments, Workspace};
use apportion::model::{KnownAnswer, KnownFunction};

/// A function of the list, with its default parameters.
pub fn function(name: &str) -> KnownFunction {
    KnownAnswer::from_name(name).expect("a function of the list").default_function()
}

/// A design of one factor a swap over `factors` factors, with rows BA.
pub fn design(settings: DesignSettings, factors: usize, second_order: bool) -> Design {
    let swaps = (0..factors).map(|j| vec![j]).collect();
    Design::new(settings, factors, Rows { swaps, ba: true, second_order, ..Rows::default() }).expect("a design")
}

/// The inputs at the points of the first replicate, in columns: those of the matrix A, then B.
pub fn inputs(function: &KnownFunction, design: &Design) -> Vec<Vec<f64>> {
    let mut columns = vec![vec![0.0; design.points_per_replicate() as usize]; design.columns()];
    design.replicate(0).fill(0, &mut columns);
    let distributions: Vec<_> = function.inputs().iter().map(|input| input.distribution.clone()).collect();
    for (distribution, column) in distributions.iter().cycle().zip(&mut columns) {
        column.iter_mut().for_each(|u| *u = distribution.quantile(*u));
    }
    columns
}

/// A function's values at all rows of the first replicate.
pub struct Outputs<'a> {
    design: &'a Design,
    /// The values in columns, in the order of [`Design::runs`].
    pub runs: Vec<Vec<f64>>,
}

impl<'a> Outputs<'a> {
    /// Of all base points.
    pub fn of(function: &KnownFunction, design: &'a Design) -> Self {
        let (d, n) = (design.factors(), design.points_per_replicate() as usize);
        let inputs = inputs(function, design);
        let values = |run: &apportion::design::Run| {
            let matrix = |j: usize| if run.columns.contains(&j) { run.from } else { run.base };
            let columns: Vec<&[f64]> = (0..d).map(|j| &inputs[design.first_column(matrix(j)) + j][..]).collect();
            let mut x = vec![0.0; d];
            let value = |i: usize| {
                x.iter_mut().zip(&columns).for_each(|(x, column)| *x = column[i]);
                function.value(&x)
            };
            (0..n).map(value).collect()
        };
        let runs = design.runs().iter().map(values).collect();
        Self { design, runs }
    }

    /// The moments of some of the base points.
    pub fn moments(&self, points: Range<usize>, work: &mut Workspace) -> Moments {
        let column = |run: &usize| &self.runs[*run][points.clone()];
        let of = |runs: &[usize]| runs.iter().map(column).collect::<Vec<_>>();
        let design = self.design;
        let outputs = BlockOutputs {
            a: column(&0),
            b: column(&1),
            ab: &of(design.ab_runs()),
            ba: &of(design.ba_runs()),
            paired: design.paired(),
        };
        Moments::of_block(outputs, work)
    }
}
