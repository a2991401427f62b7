//! Inner products of many columns, and greedy least squares on them. Sums have a fixed order for any number of threads.

use multiversion::multiversion;

use apportion_base::sum::product;

/// Rows whose products are summed before they are added to the total: two panels of them fit into a cache.
const CHUNK: usize = 256;

/// Columns of a panel.
const WIDTH: usize = 8;

/// Columns of one panel that are multiplied with those of another at a time: the sums fit into registers.
const HEIGHT: usize = WIDTH / 2;

/// Share of its square that a column must keep in addition to those chosen before it.
const INDEPENDENT: f64 = 1e-6;

/// Gain in the sum of squares below which no further column is chosen, for outputs scaled to standard deviation 1.
const MIN_GAIN: f64 = 1e-26;

/// A square matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Square {
    pub size: usize,
    values: Vec<f64>,
}

impl Square {
    /// Creates a matrix of zeros.
    pub fn zeros(size: usize) -> Self {
        Self { size, values: vec![0.0; size * size] }
    }

    /// Returns the value in row `i` and column `j`.
    #[inline(always)]
    pub fn at(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.size + j]
    }

    /// Returns a row.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.size..(i + 1) * self.size]
    }

    /// Adds another matrix of the same size.
    pub fn add(&mut self, other: &Self) {
        add_scaled(&mut self.values, 1.0, &other.values);
    }

    /// Adds the inner products of `columns`, one for each row of the matrix.
    pub fn add_products(&mut self, columns: &[Vec<f64>]) {
        add_products(self, columns);
        for i in 0..self.size {
            for j in 0..i {
                self.values[j * self.size + i] = self.values[i * self.size + j];
            }
        }
    }
}

/// Adds the inner products of `columns` on and below the diagonal, and some above it. Each version does the same
/// operations in the same order: wider registers change the time but no bit.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn add_products(sums: &mut Square, columns: &[Vec<f64>]) {
    let (size, rows) = (sums.size, columns.first().map_or(0, Vec::len));
    let mut panels: Vec<Vec<[f64; WIDTH]>> = vec![vec![[0.0; WIDTH]; CHUNK]; size.div_ceil(WIDTH)];
    for start in (0..rows).step_by(CHUNK) {
        let part = start..rows.min(start + CHUNK);
        for (column, values) in columns.iter().enumerate() {
            let panel = &mut panels[column / WIDTH];
            panel.iter_mut().zip(&values[part.clone()]).for_each(|(row, value)| row[column % WIDTH] = *value);
        }
        for i in 0..panels.len() {
            for j in 0..=i {
                let (a, b) = (&panels[i][..part.len()], &panels[j][..part.len()]);
                for (first, tile) in [(i * WIDTH, products::<0>(a, b)), (i * WIDTH + HEIGHT, products::<HEIGHT>(a, b))]
                {
                    for (row, products) in (first..size).zip(tile) {
                        let sums = &mut sums.values[row * size + j * WIDTH..(row + 1) * size];
                        for (sum, product) in sums.iter_mut().zip(products) {
                            *sum += product;
                        }
                    }
                }
            }
        }
    }
}

/// Computes the products of the columns `FIRST`, `FIRST` + 1, ... of one panel with all of another one.
#[inline(always)]
fn products<const FIRST: usize>(a: &[[f64; WIDTH]], b: &[[f64; WIDTH]]) -> [[f64; WIDTH]; HEIGHT] {
    let mut sums = [[0.0; WIDTH]; HEIGHT];
    for (a, b) in a.iter().zip(b) {
        for i in 0..HEIGHT {
            for j in 0..WIDTH {
                sums[i][j] += a[FIRST + i] * b[j];
            }
        }
    }
    sums
}

/// Adds `weight` times `other` to `column`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub(crate) fn add_scaled(column: &mut [f64], weight: f64, other: &[f64]) {
    for (value, other) in column.iter_mut().zip(other) {
        *value += weight * other;
    }
}

/// Subtracts four columns one after the other, in one pass.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn subtract_four(factor: &mut [f64], [w0, w1, w2, w3]: [f64; 4], [e0, e1, e2, e3]: [&[f64]; 4]) {
    let earlier = e0.iter().zip(e1).zip(e2.iter().zip(e3));
    for (value, ((e0, e1), (e2, e3))) in factor.iter_mut().zip(earlier) {
        *value = (((*value - w0 * e0) - w1 * e1) - w2 * e2) - w3 * e3;
    }
}

/// Sets the reduction of the sum of squares by each column; -1 if at most `fewest` of its square is left.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn set_gains(gains: &mut [f64], squares: &[f64], left: &[f64], fewest: &[f64]) {
    for ((gain, square), (left, fewest)) in gains.iter_mut().zip(squares).zip(left.iter().zip(fewest)) {
        let gained = square / left;
        *gain = if left > fewest { gained } else { -1.0 };
    }
}

/// Subtracts `score` times `factor` from `rest`, and adds the squares of the remainder to `squares`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn take_off(rest: &mut [f64], score: f64, factor: &[f64], squares: &mut [f64]) {
    for ((rest, factor), square) in rest.iter_mut().zip(factor).zip(squares) {
        *rest -= factor * score;
        *square += *rest * *rest;
    }
}

/// Columns chosen one by one to reduce the sum of squares of all outputs most, orthonormalised in this order.
pub struct Path {
    /// The indices of the columns, in the order in which they were chosen.
    pub chosen: Vec<usize>,
    /// For each output the coefficient of each in the orthonormal system.
    scores: Vec<Vec<f64>>,
    /// The orthonormal column k in terms of the chosen ones: row k has k + 1 values.
    inverse: Vec<Vec<f64>>,
}

impl Path {
    /// Chooses up to `most` columns of those with the inner products `gram`, whose products with each output are
    /// `right`. The first column is always chosen first. Of equal gains, the column that comes first is chosen.
    pub fn new(gram: &Square, right: Vec<Vec<f64>>, most: usize) -> Self {
        let size = gram.size;
        let diagonal: Vec<f64> = (0..size).map(|j| gram.at(j, j)).collect();
        let (mut left, mut rest) = (diagonal.clone(), right);
        let mut squares = vec![0.0; size];
        for rest in &rest {
            for (sum, rest) in squares.iter_mut().zip(rest) {
                *sum += rest * rest;
            }
        }
        let least = MIN_GAIN * rest.len() as f64;
        let mut fewest: Vec<f64> = diagonal.iter().map(|square| INDEPENDENT * square).collect();
        let mut gains = vec![0.0; size];
        let mut factors: Vec<Vec<f64>> = Vec::new();
        let (mut chosen, mut scores): (Vec<usize>, Vec<Vec<f64>>) = (Vec::new(), vec![Vec::new(); rest.len()]);
        while chosen.len() < most.min(size) {
            let mut next = 0;
            if !chosen.is_empty() {
                set_gains(&mut gains, &squares, &left, &fewest);
                next = (1..size).fold(0, |best, j| if gains[j] > gains[best] { j } else { best });
                if gains[next] <= least {
                    break;
                }
            }
            let root = left[next].sqrt();
            let mut factor: Vec<f64> = gram.row(next).to_vec();
            let (fours, others) = factors.as_chunks::<4>();
            for four in fours {
                subtract_four(&mut factor, four.each_ref().map(|e| e[next]), four.each_ref().map(Vec::as_slice));
            }
            for earlier in others {
                add_scaled(&mut factor, -earlier[next], earlier);
            }
            factor.iter_mut().for_each(|value| *value /= root);
            for (left, factor) in left.iter_mut().zip(&factor) {
                *left -= factor * factor;
            }
            squares.fill(0.0);
            for (rest, scores) in rest.iter_mut().zip(&mut scores) {
                let score = rest[next] / root;
                take_off(rest, score, &factor, &mut squares);
                scores.push(score);
            }
            // No column is chosen twice.
            fewest[next] = f64::INFINITY;
            chosen.push(next);
            factors.push(factor);
        }
        let lower = chosen.iter().enumerate();
        let lower = lower.map(|(i, &row)| factors[..=i].iter().map(|factor| factor[row]).collect());
        let inverse = inverse(&lower.collect::<Vec<Vec<f64>>>());
        Self { chosen, scores, inverse }
    }

    /// Returns the coefficients of the first `size` chosen columns for output number `output`.
    pub fn coefficients(&self, output: usize, size: usize) -> Vec<f64> {
        let mut all = vec![0.0; size];
        for (score, row) in self.scores[output].iter().zip(&self.inverse).take(size) {
            add_scaled(&mut all, *score, row);
        }
        all
    }

    /// Returns the sums of squared residuals of other rows for 1, 2, ... chosen columns, given the inner products
    /// `gram`, and for each output the products `right` and the sum of squares in `squares`.
    pub fn held_out(&self, gram: &Square, right: &[Vec<f64>], squares: &[f64]) -> Vec<Vec<f64>> {
        let of_chosen: Vec<Vec<f64>> =
            self.chosen.iter().map(|&i| self.chosen.iter().map(|&j| gram.at(i, j)).collect()).collect();
        // The products of every orthonormal column with all chosen ones.
        let mut columns = vec![vec![0.0; self.chosen.len()]; self.inverse.len()];
        for (column, row) in columns.iter_mut().zip(&self.inverse) {
            for (weight, of_chosen) in row.iter().zip(&of_chosen) {
                add_scaled(column, *weight, of_chosen);
            }
        }
        let lengths: Vec<f64> = self.inverse.iter().zip(&columns).map(|(row, column)| product(row, column)).collect();
        let mut all = Vec::with_capacity(self.scores.len());
        for ((scores, right), square) in self.scores.iter().zip(right).zip(squares) {
            let right: Vec<f64> = self.chosen.iter().map(|&column| right[column]).collect();
            // The products of the fit so far with all chosen columns.
            let mut products = vec![0.0; self.chosen.len()];
            let mut error = *square;
            let mut errors = Vec::with_capacity(self.chosen.len());
            for (k, (score, row)) in scores.iter().zip(&self.inverse).enumerate() {
                error += score * score * lengths[k] + 2.0 * score * (product(row, &products) - product(row, &right));
                errors.push(error);
                add_scaled(&mut products, *score, &columns[k]);
            }
            all.push(errors);
        }
        all
    }
}

/// Returns the inverse of a lower triangular matrix.
pub fn inverse(lower: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(lower.len());
    for (i, row) in lower.iter().enumerate() {
        let mut new = vec![0.0; i + 1];
        for (weight, earlier) in row.iter().zip(&rows) {
            add_scaled(&mut new, -weight, earlier);
        }
        new[i] = 1.0;
        new.iter_mut().for_each(|value| *value /= row[i]);
        rows.push(new);
    }
    rows
}

/// Returns the lower triangular factor of `gram`, with a ridge at the size of rounding (Cholesky).
pub fn lower_factor(gram: &Square) -> Vec<Vec<f64>> {
    let size = gram.size;
    let trace: f64 = (0..size).map(|i| gram.at(i, i)).sum();
    let ridge = 1e-12 * trace / size.max(1) as f64;
    let mut lower: Vec<Vec<f64>> = Vec::with_capacity(size);
    for i in 0..size {
        let mut row: Vec<f64> = gram.row(i)[..=i].to_vec();
        row[i] += ridge;
        for j in 0..=i {
            let explained: f64 = if j < i {
                row[..j].iter().zip(&lower[j]).map(|(a, b)| a * b).sum()
            } else {
                row[..i].iter().map(|a| a * a).sum()
            };
            row[j] -= explained;
            if j < i {
                row[j] /= lower[j][j];
            }
        }
        row[i] = row[i].max(f64::MIN_POSITIVE).sqrt();
        lower.push(row);
    }
    lower
}

/// Solves G x = `right` by least squares, using only the first columns; `lower` is the first rows of the factor of G.
pub fn solve(lower: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let size = lower.len();
    let mut x = right[..size].to_vec();
    for i in 0..size {
        let sum: f64 = lower[i][..i].iter().zip(&x).map(|(a, b)| a * b).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    for i in (0..size).rev() {
        let sum: f64 = (i + 1..size).map(|j| lower[j][i] * x[j]).sum();
        x[i] = (x[i] - sum) / lower[i][i];
    }
    x
}

#[cfg(test)]
mod tests;
