//! How fast do the errors fall with the number of base points, by sampler and by estimator?
//!
//! For functions with exact indices, over many seeds: the root mean square error of the first-order and of the total
//! indices over seeds and factors, at 2^6 to 2^14 base points in one replicate. Written to `docs/accuracy/`: every
//! number (`rmse.csv`), the slopes of the errors (`slopes.csv`) and charts.

mod outputs;

mod accuracy_charts;

use std::path::Path;
use std::time::Instant;

use apportion::design::{DesignSettings, Sampler};
use apportion::estimate::{FirstOrder, Moments, Total, Workspace};
use apportion::model::KnownFunction;
use apportion_report::write_atomically;
use outputs::{Outputs, design, function};
use rayon::prelude::*;

const SEEDS: u64 = 200;

/// Base points are 2 to these powers.
const EXPONENTS: std::ops::RangeInclusive<u32> = 6..=14;

/// Slopes are fitted from 2 to this power on: before, errors of higher order have not died out.
const FITTED_FROM: u32 = 9;

/// Name, and what kind of function it is.
const FUNCTIONS: [(&str, &str); 6] = [
    ("linear", "smooth"),
    ("ishigami", "smooth"),
    ("product", "smooth"),
    ("sobol-g", "kinked"),
    ("g-star", "kinked"),
    ("steps", "discontinuous"),
];

/// Of which indices an estimator is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Formula {
    First(FirstOrder),
    Total(Total),
}

impl Formula {
    fn all() -> Vec<Self> {
        FirstOrder::ALL.into_iter().map(Self::First).chain(Total::ALL.into_iter().map(Self::Total)).collect()
    }

    fn name(self) -> &'static str {
        match self {
            Self::First(estimator) => estimator.name(),
            Self::Total(estimator) => estimator.name(),
        }
    }

    fn index(self) -> &'static str {
        match self {
            Self::First(_) => "first-order",
            Self::Total(_) => "total",
        }
    }

    fn runs_per_point(self, d: u64) -> u64 {
        let needs_ba = match self {
            Self::First(estimator) => estimator.needs_ba(),
            Self::Total(estimator) => estimator.needs_ba(),
        };
        2 + d * if needs_ba { 2 } else { 1 }
    }

    fn estimate(self, moments: &Moments, swap: usize) -> f64 {
        match self {
            Self::First(estimator) => estimator.estimate(moments, swap),
            Self::Total(estimator) => estimator.estimate(moments, swap),
        }
    }
}

/// The errors of one estimator on one function's points.
struct Curve {
    function: &'static str,
    kind: &'static str,
    sampler: Sampler,
    formula: Formula,
    runs_per_point: u64,
    /// Base points and error, in rising order.
    points: Vec<(f64, f64)>,
    slope: Slope,
}

impl Curve {
    fn finest(&self) -> f64 {
        self.points.last().map_or(f64::NAN, |point| point.1)
    }
}

/// Slope of the logarithm of the error over that of the number of base points, from 2 to [`FITTED_FROM`] on.
#[derive(Clone, Copy)]
struct Slope {
    value: f64,
    /// Its standard error, by the jackknife over the seeds.
    error: f64,
}

impl Slope {
    /// `squares` holds the mean square error of every seed and number of base points.
    fn of(squares: &[Vec<f64>]) -> Self {
        let sums = |size: usize| squares.iter().map(|seed| seed[size]).sum::<f64>();
        let all: Vec<f64> = EXPONENTS.enumerate().map(|(size, _)| sums(size)).collect();
        let without = |seed: &Vec<f64>| fitted(&all.iter().zip(seed).map(|(all, seed)| all - seed).collect::<Vec<_>>());
        let slopes: Vec<f64> = squares.iter().map(without).collect();
        let n = slopes.len() as f64;
        let mean = slopes.iter().sum::<f64>() / n;
        let spread: f64 = slopes.iter().map(|slope| (slope - mean).powi(2)).sum();
        Self { value: fitted(&all), error: ((n - 1.0) / n * spread).sqrt() }
    }
}

/// Least-squares slope of half the logarithm of `squares` (of any unit) over that of the number of base points.
fn fitted(squares: &[f64]) -> f64 {
    let points = EXPONENTS.zip(squares).filter(|(exponent, _)| *exponent >= FITTED_FROM);
    let logs: Vec<(f64, f64)> = points.map(|(exponent, square)| (f64::from(exponent), square.log2() / 2.0)).collect();
    let mean = |f: fn(&(f64, f64)) -> f64| logs.iter().map(f).sum::<f64>() / logs.len() as f64;
    let (mx, my) = (mean(|p| p.0), mean(|p| p.1));
    let sums = logs.iter().map(|(x, y)| ((x - mx) * (y - my), (x - mx).powi(2)));
    let (xy, xx) = sums.fold((0.0, 0.0), |(a, b), (xy, xx)| (a + xy, b + xx));
    xy / xx
}

/// Moments at every number of base points.
fn moments_by_size(function: &KnownFunction, sampler: Sampler, seed: u64) -> Vec<Moments> {
    let d = function.inputs().len();
    let mut work = Workspace::default();
    let of = |n: u64| design(DesignSettings { sampler, base_samples: n, replicates: 1, seed }, d, false);
    if sampler == Sampler::LatinHypercube {
        // The points depend on how many there will be.
        let single = |exponent: u32| Outputs::of(function, &of(1 << exponent)).moments(0..1 << exponent, &mut work);
        return EXPONENTS.map(single).collect();
    }
    let design = of(1 << EXPONENTS.end());
    let outputs = Outputs::of(function, &design);
    let mut moments = outputs.moments(0..1 << EXPONENTS.start(), &mut work);
    let mut all = vec![moments.clone()];
    for exponent in EXPONENTS.skip(1) {
        moments.merge(&outputs.moments(1 << (exponent - 1)..1 << exponent, &mut work));
        all.push(moments.clone());
    }
    all
}

/// Errors of all estimators.
fn curves((name, kind): (&'static str, &'static str), sampler: Sampler) -> Vec<Curve> {
    let function = function(name);
    let exact = function.exact().indices.expect("a function that varies");
    let d = exact.total.len();
    let square = |formula: Formula, moments: &Moments| {
        let exact = if matches!(formula, Formula::First(_)) { &exact.first_order } else { &exact.total };
        let squares = exact.iter().enumerate().map(|(j, exact)| (formula.estimate(moments, j) - exact).powi(2));
        squares.sum::<f64>() / d as f64
    };
    let formulas = Formula::all();
    let of_seed = |seed| -> Vec<Vec<f64>> {
        let sizes = moments_by_size(&function, sampler, seed);
        formulas.iter().map(|formula| sizes.iter().map(|moments| square(*formula, moments)).collect()).collect()
    };
    let seeds: Vec<_> = (0..SEEDS).into_par_iter().map(of_seed).collect();
    let curve = |(number, &formula): (usize, &Formula)| {
        let squares: Vec<Vec<f64>> = seeds.iter().map(|seed| seed[number].clone()).collect();
        let error = |size: usize| (squares.iter().map(|seed| seed[size]).sum::<f64>() / SEEDS as f64).sqrt();
        let points = EXPONENTS.enumerate().map(|(size, exponent)| (f64::from(1u32 << exponent), error(size))).collect();
        let runs_per_point = formula.runs_per_point(d as u64);
        Curve { function: name, kind, sampler, formula, runs_per_point, points, slope: Slope::of(&squares) }
    };
    formulas.iter().enumerate().map(curve).collect()
}

fn write(name: &str, bytes: &[u8]) {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join("docs/accuracy");
    write_atomically(&folder.join(name), bytes).expect("docs/accuracy can be written");
}

fn write_tables(all: &[Curve]) {
    let mut errors = "function,sampler,index,estimator,runs_per_point,base_points,rmse\n".to_owned();
    let mut slopes = "function,kind,sampler,index,estimator,rmse_at_16384,slope,slope_error\n".to_owned();
    for curve in all {
        let Curve { function, kind, sampler, formula, runs_per_point, .. } = curve;
        let (sampler, index, name) = (sampler.name(), formula.index(), formula.name());
        for (n, error) in &curve.points {
            errors += &format!("{function},{sampler},{index},{name},{runs_per_point},{n},{error:.3e}\n");
        }
        let (finest, Slope { value, error }) = (curve.finest(), curve.slope);
        slopes += &format!("{function},{kind},{sampler},{index},{name},{finest:.2e},{value:.2},{error:.2}\n");
    }
    write("rmse.csv", errors.as_bytes());
    write("slopes.csv", slopes.as_bytes());
}

/// The default estimators on every function and sampler.
fn print(all: &[Curve]) {
    println!("{SEEDS} seeds; error at 2^14 base points, and slope from 2^{FITTED_FROM} to 2^14");
    for curve in all.iter().filter(|curve| accuracy_charts::is_default(curve.formula)) {
        let Curve { function, kind, sampler, formula, .. } = curve;
        let (index, name, finest) = (formula.index(), formula.name(), curve.finest());
        let Slope { value, error } = curve.slope;
        println!(
            "{function:9} {kind:13} {:15} {index:11} {name:13} {finest:8.1e} {value:6.2} +- {error:.2}",
            sampler.name()
        );
    }
    let smooth = |curve: &&Curve| {
        curve.kind == "smooth" && curve.sampler == Sampler::Sobol && accuracy_charts::is_default(curve.formula)
    };
    let slopes: Vec<Slope> = all.iter().filter(smooth).map(|curve| curve.slope).collect();
    let shallow = slopes.iter().filter(|slope| slope.value > -0.9).count();
    let surely = slopes.iter().filter(|slope| slope.value - 2.0 * slope.error > -0.9).count();
    println!("Sobol' points, smooth functions, default estimators: of {} slopes", slopes.len());
    println!("  {shallow} are less steep than -0.9, {surely} of them by more than two standard errors");
}

fn main() {
    let start = Instant::now();
    let mut all = Vec::new();
    for function in FUNCTIONS {
        for sampler in Sampler::ALL {
            all.extend(curves(function, sampler));
        }
        eprintln!("{} after {:.0} s", function.0, start.elapsed().as_secs_f64());
    }
    write_tables(&all);
    accuracy_charts::write(&all);
    print(&all);
}
