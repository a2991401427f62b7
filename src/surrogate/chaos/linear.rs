//! Dense linear algebra in panels of eight columns, which compilers turn into the widest registers there are.
//!
//! All sums have one order, whatever the machine and the number of threads: no fused operations, and no version for a
//! processor that differs from the others in more than the width of its registers.

use multiversion::multiversion;

use apportion_base::sum::product;

/// Columns of a panel.
pub const LANES: usize = 8;

/// Rows that are worked on at a time: their sums fit into registers.
pub const HEIGHT: usize = LANES / 2;

/// A row of a panel.
pub type Lane = [f64; LANES];

/// Rows of a tile of two panels.
pub type Tile = [Lane; HEIGHT];

/// A matrix in panels of eight columns, each row by row; columns that fill up the last one are 0.
#[derive(Debug, Clone, Default)]
pub struct Panels {
    pub rows: usize,
    pub columns: usize,
    values: Vec<Lane>,
}

impl Panels {
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![[0.0; LANES]; rows * columns.div_ceil(LANES)] }
    }

    /// Creates a matrix of these columns.
    pub fn from_columns<'a>(rows: usize, columns: impl ExactSizeIterator<Item = &'a [f64]>) -> Self {
        let mut all = Self::zeros(rows, columns.len());
        columns.enumerate().for_each(|(j, column)| all.set_column(j, column.iter().copied()));
        all
    }

    pub fn set_column(&mut self, j: usize, values: impl Iterator<Item = f64>) {
        self.panel_mut(j / LANES).iter_mut().zip(values).for_each(|(row, value)| row[j % LANES] = value);
    }

    /// Creates a matrix of these rows.
    pub fn from_rows<'a>(columns: usize, rows: impl ExactSizeIterator<Item = &'a [f64]>) -> Self {
        let mut all = Self::zeros(rows.len(), columns);
        for (i, row) in rows.enumerate() {
            for (p, part) in row[..columns].chunks(LANES).enumerate() {
                all.panel_mut(p)[i][..part.len()].copy_from_slice(part);
            }
        }
        all
    }

    /// Returns the number of panels.
    pub fn panels(&self) -> usize {
        self.columns.div_ceil(LANES)
    }

    pub fn panel(&self, p: usize) -> &[Lane] {
        &self.values[p * self.rows..(p + 1) * self.rows]
    }

    pub fn panel_mut(&mut self, p: usize) -> &mut [Lane] {
        &mut self.values[p * self.rows..(p + 1) * self.rows]
    }

    pub fn column(&self, j: usize) -> impl Iterator<Item = f64> + '_ {
        self.panel(j / LANES).iter().map(move |row| row[j % LANES])
    }

    /// Multiplies every row by its weight.
    pub fn scale_rows(&mut self, weights: &[f64]) {
        for panel in self.values.chunks_mut(self.rows.max(1)) {
            for (row, weight) in panel.iter_mut().zip(weights) {
                row.iter_mut().for_each(|value| *value *= weight);
            }
        }
    }

    /// Returns the product of a row of weights with the matrix: sums over the rows.
    pub fn weighted_sums(&self, weights: &[f64]) -> Vec<f64> {
        let sums = (0..self.panels()).flat_map(|p| weighted_sum(self.panel(p), weights));
        sums.take(self.columns).collect()
    }

    /// Returns the product of the matrix with a column of weights.
    pub fn combined(&self, weights: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.rows];
        for (p, weights) in weights.chunks(LANES).enumerate() {
            let mut all = [0.0; LANES];
            all[..weights.len()].copy_from_slice(weights);
            combine(self.panel(p), &all, &mut sums);
        }
        sums
    }
}

/// Returns the sum of the rows of a panel, each with its weight.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn weighted_sum(panel: &[Lane], weights: &[f64]) -> Lane {
    let mut sums = [0.0; LANES];
    for (row, weight) in panel.iter().zip(weights) {
        add(&mut sums, *weight, row);
    }
    sums
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn combine(panel: &[Lane], weights: &Lane, sums: &mut [f64]) {
    for (sum, row) in sums.iter_mut().zip(panel) {
        *sum += weights.iter().zip(row).map(|(weight, value)| weight * value).sum::<f64>();
    }
}

/// Adds `weight` times another row. Loops over indices become single instructions, iterators here do not.
#[inline(always)]
#[allow(clippy::needless_range_loop)]
pub fn add(row: &mut Lane, weight: f64, other: &Lane) {
    for l in 0..LANES {
        row[l] += weight * other[l];
    }
}

/// Adds the products of two rows.
#[inline(always)]
#[allow(clippy::needless_range_loop)]
pub fn add_products(row: &mut Lane, a: &Lane, b: &Lane) {
    for l in 0..LANES {
        row[l] += a[l] * b[l];
    }
}

/// Multiplies by another row.
#[inline(always)]
#[allow(clippy::needless_range_loop)]
pub fn multiply(row: &mut Lane, by: &Lane) {
    for l in 0..LANES {
        row[l] *= by[l];
    }
}

/// Returns the inner products of the columns `FIRST` to `FIRST` + 3 of one panel with all of another.
#[inline(always)]
pub fn products<const FIRST: usize>(a: &[Lane], b: &[Lane]) -> Tile {
    let mut sums = [[0.0; LANES]; HEIGHT];
    for (a, b) in a.iter().zip(b) {
        for r in 0..HEIGHT {
            add(&mut sums[r], a[FIRST + r], b);
        }
    }
    sums
}

/// A symmetric matrix: for each panel of eight columns its rows down to the last of these columns.
#[derive(Debug, Clone)]
pub struct Symmetric {
    pub size: usize,
    pub panels: Vec<Vec<Lane>>,
}

impl Symmetric {
    pub fn zeros(size: usize) -> Self {
        let panels = (0..size.div_ceil(LANES)).map(|p| vec![[0.0; LANES]; (p + 1) * LANES]);
        Self { size, panels: panels.collect() }
    }

    /// Returns the products a' b of two matrices whose product is symmetric.
    pub fn products(a: &Panels, b: &Panels) -> Self {
        let panels = (0..b.panels()).map(|p| products_of_panel(a, b, p));
        Self { size: b.columns, panels: panels.collect() }
    }

    pub fn at(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.panels[j / LANES][i][j % LANES]
    }

    /// Adds to the diagonal.
    pub fn add_to_diagonal(&mut self, more: f64) {
        for j in 0..self.size {
            self.panels[j / LANES][j][j % LANES] += more;
        }
    }

    /// Adds `weight` times another matrix of this size.
    pub fn add(&mut self, weight: f64, other: &Self) {
        for (row, other) in self.panels.iter_mut().flatten().zip(other.panels.iter().flatten()) {
            add(row, weight, other);
        }
    }

    /// Returns the rows and columns with these indices.
    pub fn at_rows(&self, rows: &[usize]) -> Self {
        let size = rows.len();
        let mut all = Self::zeros(size);
        for (p, panel) in all.panels.iter_mut().enumerate() {
            for (i, row) in panel.iter_mut().enumerate().take(size) {
                for (l, value) in row.iter_mut().enumerate().take(size - p * LANES) {
                    *value = self.at(rows[i], rows[p * LANES + l]);
                }
            }
        }
        all
    }

    /// Adds `weight` times the products of the entries of `of`.
    pub fn add_outer(&mut self, weight: f64, of: &[f64]) {
        self.each(|i, j, value| *value += weight * of[i] * of[j]);
    }

    /// Multiplies rows and columns by `weights`.
    pub fn scale(&mut self, weights: &[f64]) {
        self.each(|i, j, value| *value *= weights[i] * weights[j]);
    }

    fn each(&mut self, change: impl Fn(usize, usize, &mut f64)) {
        let size = self.size;
        for (p, panel) in self.panels.iter_mut().enumerate() {
            let first = p * LANES;
            for (i, row) in panel.iter_mut().enumerate().take(size) {
                for (l, value) in row.iter_mut().enumerate().take(size - first) {
                    change(i, first + l, value);
                }
            }
        }
    }

    /// Returns the product with a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.size];
        for (p, panel) in self.panels.iter().enumerate() {
            let first = p * LANES;
            for (i, row) in panel.iter().enumerate().take(self.size) {
                for (l, value) in row.iter().enumerate().take(self.size - first) {
                    sums[first + l] += value * x[i];
                    if i < first {
                        sums[i] += value * x[first + l];
                    }
                }
            }
        }
        sums
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn products_of_panel(a: &Panels, b: &Panels, p: usize) -> Vec<Lane> {
    let mut rows = Vec::with_capacity((p + 1) * LANES);
    for q in 0..=p {
        rows.extend(products::<0>(a.panel(q), b.panel(p)));
        rows.extend(products::<HEIGHT>(a.panel(q), b.panel(p)));
    }
    rows
}

/// The lower triangular factor of a symmetric positive definite matrix (Cholesky), four rows at a time, filled up to
/// whole panels by the identity.
#[derive(Debug, Clone)]
pub struct Cholesky {
    pub size: usize,
    filled: usize,
    /// For each four rows their values in every column.
    lower: Vec<[f64; HEIGHT]>,
}

impl Cholesky {
    /// Computes the factor; `None` if the matrix is not positive definite.
    pub fn new(matrix: Symmetric) -> Option<Self> {
        let Symmetric { size, mut panels } = matrix;
        let filled = panels.len() * LANES;
        let mut factor = Self { size, filled, lower: vec![[0.0; HEIGHT]; filled * filled / HEIGHT] };
        let is_definite = panels.iter_mut().enumerate().all(|(p, panel)| factor.extend(p, panel));
        is_definite.then_some(factor)
    }

    /// Adds the rows of one panel.
    fn extend(&mut self, p: usize, panel: &mut [Lane]) -> bool {
        let first = p * LANES;
        for column in self.size.clamp(first, first + LANES)..first + LANES {
            panel.iter_mut().for_each(|row| row[column - first] = 0.0);
            panel[column] = [0.0; LANES];
            panel[column][column - first] = 1.0;
        }
        solve_panel(&self.lower, self.filled, 0, &mut panel[..first]);
        let mut block = [[0.0; LANES]; LANES];
        left_over(&panel[..first], &panel[first..], &mut block);
        if !factor_block(&mut block) {
            return false;
        }
        for (half, rows) in self.lower[first / HEIGHT * self.filled..].chunks_mut(self.filled).take(2).enumerate() {
            let lanes = half * HEIGHT..(half + 1) * HEIGHT;
            for (values, row) in rows.iter_mut().zip(&panel[..first]) {
                values.copy_from_slice(&row[lanes.clone()]);
            }
            for (column, values) in rows[first..].iter_mut().enumerate().take(LANES) {
                *values = std::array::from_fn(|r| block[half * HEIGHT + r][column]);
            }
        }
        true
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.lower[i / HEIGHT * self.filled + j][i % HEIGHT]
    }

    /// Returns the sum of the logarithms of the diagonal.
    pub fn log_diagonal(&self) -> f64 {
        (0..self.size).map(|i| libm::log(self.at(i, i))).sum()
    }

    /// Solves L z = y.
    pub fn forward(&self, y: &[f64]) -> Vec<f64> {
        let panel = y.iter().map(|y| std::array::from_fn(|l| if l == 0 { *y } else { 0.0 })).collect();
        self.solved(0, panel).iter().take(self.size).map(|row| row[0]).collect()
    }

    /// Solves L' x = z.
    pub fn backward(&self, mut z: Vec<f64>) -> Vec<f64> {
        for i in (0..self.size).rev() {
            let x = z[i] / self.at(i, i);
            z[i] = x;
            let rows = &self.lower[i / HEIGHT * self.filled..][..i];
            z.iter_mut().zip(rows).for_each(|(z, values)| *z -= x * values[i % HEIGHT]);
        }
        z
    }

    /// Solves L L' x = y.
    pub fn solve(&self, y: &[f64]) -> Vec<f64> {
        self.backward(self.forward(y))
    }

    /// Solves L X = B for one panel of B from row `first` on: those before are 0.
    fn solved(&self, first: usize, mut panel: Vec<Lane>) -> Vec<Lane> {
        panel.resize(self.filled - first, [0.0; LANES]);
        solve_panel(&self.lower, self.filled, first, &mut panel);
        panel
    }

    /// Returns one panel of the inverse of L from its first row that is not 0 on.
    pub fn inverse_panel(&self, p: usize) -> Vec<Lane> {
        let one = (0..LANES).map(|l| std::array::from_fn(|m| if l == m { 1.0 } else { 0.0 }));
        self.solved(p * LANES, one.collect())
    }

    /// Returns the number of panels.
    pub fn panels(&self) -> usize {
        self.filled / LANES
    }

    /// Returns the diagonal of the inverse of L L'.
    pub fn inverse_diagonal(&self) -> Vec<f64> {
        (0..self.panels()).flat_map(|p| sums_of_squares(&self.inverse_panel(p))).take(self.size).collect()
    }

    /// Returns for every one of some columns f the sum of squares of L^-1 f.
    pub fn whitened_squares(&self, columns: &Panels) -> Vec<f64> {
        let panels = 0..columns.panels();
        let sums = panels.flat_map(|p| sums_of_squares(&self.solved(0, columns.panel(p).to_vec())));
        sums.take(columns.columns).collect()
    }
}

/// Returns the sum of squares of every column of a panel.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn sums_of_squares(panel: &[Lane]) -> Lane {
    let mut sums = [0.0; LANES];
    for row in panel {
        add_products(&mut sums, row, row);
    }
    sums
}

/// Solves L X = B in place for one panel of B, from row `first` on: those before are 0.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn solve_panel(lower: &[[f64; HEIGHT]], stride: usize, first: usize, panel: &mut [Lane]) {
    for start in (0..panel.len()).step_by(HEIGHT) {
        let rows = &lower[(first + start) / HEIGHT * stride + first..][..start + HEIGHT];
        let (before, after) = panel.split_at_mut(start);
        let explained = explained(before, rows);
        for r in 0..HEIGHT {
            let mut sums = after[r];
            add(&mut sums, -1.0, &explained[r]);
            for s in 0..r {
                add(&mut sums, -rows[start + s][r], &after[s]);
            }
            multiply(&mut sums, &[1.0 / rows[start + r][r]; LANES]);
            after[r] = sums;
        }
    }
}

/// Returns the products of four rows of the factor with the rows that are solved.
#[inline(always)]
fn explained(solved: &[Lane], rows: &[[f64; HEIGHT]]) -> Tile {
    let mut sums = [[0.0; LANES]; HEIGHT];
    for (x, row) in solved.iter().zip(rows) {
        for r in 0..HEIGHT {
            add(&mut sums[r], row[r], x);
        }
    }
    sums
}

/// Sets `block` to the rows `of` less the inner products of the columns of `solved`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn left_over(solved: &[Lane], of: &[Lane], block: &mut [Lane; LANES]) {
    let (top, bottom) = (products::<0>(solved, solved), products::<HEIGHT>(solved, solved));
    for (r, sums) in top.iter().chain(&bottom).enumerate() {
        block[r] = of[r];
        add(&mut block[r], -1.0, sums);
    }
}

/// Factors a small symmetric matrix in place into its lower triangle; `false` if it is not positive definite.
fn factor_block(block: &mut [Lane; LANES]) -> bool {
    for i in 0..LANES {
        let (done, rest) = block.split_at_mut(i);
        let row = &mut rest[0];
        for (j, earlier) in done.iter().enumerate() {
            row[j] = (row[j] - product(&row[..j], &earlier[..j])) / earlier[j];
        }
        let left = row[i] - product(&row[..i], &row[..i]);
        if !(left > 0.0 && left.is_finite()) {
            return false;
        }
        row[i] = left.sqrt();
        row[i + 1..].fill(0.0);
    }
    true
}

#[cfg(test)]
#[path = "tests/linear.rs"]
mod tests;
