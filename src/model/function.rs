//! Functions of the program that uses the library, as models.

use super::{Batch, Model, Output, OutputSeries, RowFailure, RunContext, SeriesAxis, Worker};
use apportion_base::quantity::Unit;

/// A Rust function as a model.
///
/// It receives the values of one row, one per factor, in SI units and in the order of the factors (a factor without a
/// unit is passed as is), and is called from several threads at once. It must return the same numbers for the same
/// values, otherwise results are not repeatable. If it panics, the run ends with that panic.
pub struct FunctionModel<F> {
    outputs: Vec<Output>,
    series: Vec<OutputSeries>,
    function: F,
}

impl FunctionModel<fn(&[f64], &mut [f64]) -> Result<(), RowFailure>> {
    /// Creates a model that runs outside of this program: every row evaluated by it fails. Its outputs are read from a
    /// file, into a [`Store`](crate::run::Store).
    pub(crate) fn elsewhere(outputs: Vec<Output>, series: Vec<OutputSeries>) -> Self {
        const UNREAD: &str = "the model runs outside of this program, and the row's outputs have not been read";
        Self { outputs, series, function: |_, _| Err(RowFailure::new(UNREAD)) }
    }
}

impl<F> FunctionModel<F>
where
    F: Fn(&[f64], &mut [f64]) -> Result<(), RowFailure> + Send + Sync,
{
    /// Creates the model of `function`, which sets the values of all `outputs` of a row, in SI units, or returns why
    /// there are none. A value that is not finite is a failure of that output only.
    ///
    /// ```
    /// use apportion::{FunctionModel, Output, RowFailure};
    /// use apportion::Unit;
    ///
    /// let force = Output::new("force", Unit::parse("nN")?, "force on the spring");
    /// let energy = Output::new("energy", Unit::parse("nJ")?, "energy of the spring");
    /// let spring = FunctionModel::new(vec![force, energy], |x: &[f64], y: &mut [f64]| {
    ///     let (stiffness, way) = (x[0], x[1]);
    ///     if stiffness < 0.0 {
    ///         return Err(RowFailure::new("the stiffness is negative"));
    ///     }
    ///     y[0] = stiffness * way;
    ///     y[1] = stiffness * way * way / 2.0;
    ///     Ok(())
    /// });
    /// # Ok::<(), apportion_base::quantity::UnitError>(())
    /// ```
    pub fn new(outputs: Vec<Output>, function: F) -> Self {
        Self { outputs, series: Vec::new(), function }
    }

    /// Adds an output that is a series: the function sets its values, in SI units, after those of all previous outputs.
    /// They are called `name[0]`, `name[1]` and so on.
    ///
    /// ```
    /// use apportion::{FunctionModel, Model, SeriesAxis, Unit};
    ///
    /// let time = SeriesAxis::even("time", "s", 100, 0.0, 0.1)?;
    /// let positions = time.positions().to_vec();
    /// let cooling = FunctionModel::new(Vec::new(), move |x: &[f64], y: &mut [f64]| {
    ///     y.iter_mut().zip(&positions).for_each(|(y, t)| *y = x[0] * (-t / x[1]).exp());
    ///     Ok(())
    /// });
    /// let cooling = cooling.with_series("temperature", Unit::parse("K")?, time);
    /// assert_eq!((cooling.outputs().len(), &*cooling.outputs()[7].name), (100, "temperature[7]"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_series(mut self, name: &str, unit: Unit, axis: SeriesAxis) -> Self {
        let series = OutputSeries { name: name.to_owned(), first: self.outputs.len(), axis };
        self.outputs.extend(series.outputs(&unit, ""));
        self.series.push(series);
        self
    }
}

/// Creates a model from a function with one dimensionless `output`. A result that is not finite is a failed row.
///
/// ```
/// use apportion::{Model, function_model};
///
/// let product = function_model("y", |x| x[0] * x[1]);
/// assert_eq!(product.outputs()[0].name, "y");
/// ```
pub fn function_model(output: &str, function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> impl Model + 'static {
    let output = Output::new(output.to_owned(), Unit::dimensionless(), "");
    FunctionModel::new(vec![output], move |x: &[f64], y: &mut [f64]| {
        y[0] = function(x);
        Ok(())
    })
}

impl<F> Model for FunctionModel<F>
where
    F: Fn(&[f64], &mut [f64]) -> Result<(), RowFailure> + Send + Sync,
{
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn series(&self) -> &[OutputSeries] {
        &self.series
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(FunctionWorker { function: &self.function, x: Vec::new(), y: vec![f64::NAN; self.outputs.len()] })
    }
}

struct FunctionWorker<'a, F> {
    function: &'a F,
    x: Vec<f64>,
    y: Vec<f64>,
}

impl<F> Worker for FunctionWorker<'_, F>
where
    F: Fn(&[f64], &mut [f64]) -> Result<(), RowFailure> + Send + Sync,
{
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for row in 0..batch.rows() {
            self.x.clear();
            self.x.extend(inputs.iter().map(|column| column[row]));
            // An output that the function does not set has no value.
            self.y.fill(f64::NAN);
            match (self.function)(&self.x, &mut self.y) {
                Ok(()) => self.y.iter().enumerate().for_each(|(output, y)| batch.set(row, output, *y)),
                Err(failure) => batch.fail_row(row, &failure),
            }
        }
    }
}
