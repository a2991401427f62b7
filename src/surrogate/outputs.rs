//! Standardised outputs, from which surrogates are fitted.

use crate::estimate::PointOutputs;

/// The outputs of one net.
#[derive(Debug, Clone)]
pub(crate) struct OutputTable {
    /// For each run a column with a value for each base point, which is not finite if the run failed.
    pub runs: Vec<Vec<f64>>,
}

impl OutputTable {
    /// Reads the outputs of every one of `runs` runs.
    fn new(stored: &PointOutputs, runs: usize) -> Self {
        let mut columns = vec![Vec::with_capacity(stored.points() as usize); runs];
        for block in stored.blocks(u64::MAX) {
            for (column, more) in columns.iter_mut().zip(block) {
                column.extend_from_slice(more);
            }
        }
        Self { runs: columns }
    }

    /// Returns the number of base points.
    pub fn points(&self) -> usize {
        self.runs.first().map_or(0, Vec::len)
    }

    /// Returns the base points at which all runs have a value.
    pub fn complete_points(&self) -> Vec<usize> {
        (0..self.points()).filter(|&point| self.runs.iter().all(|run| run[point].is_finite())).collect()
    }

    /// Returns the outputs at some base points.
    pub fn at(&self, points: &[usize]) -> Self {
        Self { runs: self.runs.iter().map(|run| points.iter().map(|&point| run[point]).collect()).collect() }
    }
}

/// The mean and standard deviation by which outputs are scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub mean: f64,
    pub sd: f64,
}

impl Scale {
    /// Computes the scale of `values`; `None` if they are all equal, or there are none.
    fn of_values(values: &[f64]) -> Option<Self> {
        let mean = apportion_base::sum::mean(values);
        let size = values.iter().fold(0.0, |largest: f64, y| largest.max((y - mean).abs()));
        // In units of the largest deviation, so that squares neither underflow nor overflow.
        let squares = values.iter().map(|y| ((y - mean) / size).powi(2)).sum::<f64>();
        let sd = size * (squares / values.len() as f64).sqrt();
        (size > 0.0 && sd.is_finite() && mean.is_finite()).then_some(Self { mean, sd })
    }
}

/// One output at every net, in units of its standard deviation from its mean.
#[derive(Debug, Clone)]
pub(crate) struct ScaledOutput {
    pub nets: Vec<OutputTable>,
    pub scale: Scale,
}

impl ScaledOutput {
    /// Scales the outputs of every replicate and of each of `runs` runs, by their own mean and standard deviation
    /// unless a `scale` is given. `None` if they do not vary.
    pub fn new(replicates: &[&PointOutputs], runs: usize, scale: Option<Scale>) -> Option<Self> {
        let mut nets: Vec<OutputTable> = replicates.iter().map(|stored| OutputTable::new(stored, runs)).collect();
        let scale = scale.or_else(|| {
            let values = nets.iter().flat_map(|net| &net.runs).flatten().copied();
            Scale::of_values(&values.filter(|y| y.is_finite()).collect::<Vec<f64>>())
        })?;
        for y in nets.iter_mut().flat_map(|net| &mut net.runs).flatten() {
            *y = (*y - scale.mean) / scale.sd;
        }
        Some(Self { nets, scale })
    }

    /// Returns the base points of every net at which all runs have a value.
    pub fn complete_points(&self) -> Vec<Vec<usize>> {
        self.nets.iter().map(OutputTable::complete_points).collect()
    }

    /// Returns the outputs at some base points of every net.
    pub fn at(&self, points: &[&[usize]]) -> Self {
        let nets = self.nets.iter().zip(points).map(|(net, points)| net.at(points)).collect();
        Self { nets, scale: self.scale }
    }
}
