//! Least squares on the columns of largest coefficients, as many as leave least on rows left out one by one.

use multiversion::multiversion;

use apportion_base::sum::product;

use super::linear::{Cholesky, HEIGHT, LANES, Lane, Panels, Symmetric, add, products, sums_of_squares, weighted_sum};

/// Maximum number of columns, and for each row.
const MAX_COLUMNS: usize = 300;
const COLUMNS_OF_ROW: f64 = 0.6;

/// Rounds, each with the other columns in the order of what is left, up to some number of rows.
const ROUNDS: usize = 4;
const MAX_ROWS_OF_ROUNDS: usize = 600;

/// The ratio of the square left out that counts as less.
const LESS: f64 = 0.5;

/// Mean square that is as good as none.
const NOTHING: f64 = 1e-28;

/// Share of its square that a column must keep in addition to those before it.
const INDEPENDENT: f64 = 1e-13;

/// Columns orthonormalised in their order, in panels, and their triangle: column j of the matrix is the sum of the
/// orthonormal columns with the weights in row j.
#[derive(Debug, Clone)]
pub struct Orthonormal {
    rows: usize,
    panels: Vec<Vec<Lane>>,
    /// For each column of the panels a row of its own weights, without those of the later panels.
    triangle: Vec<Vec<Lane>>,
}

impl Orthonormal {
    pub fn new(columns: &Panels) -> Self {
        let mut all = Self { rows: columns.rows, panels: Vec::new(), triangle: Vec::new() };
        all.extend(columns);
        all
    }

    /// Adds columns: block Gram-Schmidt, twice.
    pub fn extend(&mut self, columns: &Panels) {
        for p in 0..columns.panels() {
            let mut panel = columns.panel(p).to_vec();
            let squares = sums_of_squares(&panel);
            let mut weights: Vec<Lane> = Vec::new();
            for _ in 0..2 {
                let mut more: Vec<Lane> = Vec::with_capacity(self.panels.len() * LANES + LANES);
                for earlier in &self.panels {
                    more.extend(project(earlier, &mut panel));
                }
                let upper = orthonormalise(&mut panel, &squares, weights.is_empty());
                more.extend(upper);
                weights = if weights.is_empty() { more } else { joined(&weights, &more) };
            }
            self.panels.push(panel);
            self.triangle.push(weights);
        }
    }

    /// Forgets all but the first panels.
    pub fn truncate(&mut self, panels: usize) {
        self.panels.truncate(panels);
        self.triangle.truncate(panels);
    }

    /// Returns the products of the orthonormal columns with `y`.
    pub fn scores(&self, y: &[f64]) -> Vec<f64> {
        self.panels.iter().flat_map(|panel| weighted_sum(panel, y)).collect()
    }

    /// Returns the coefficients of the first `count` columns.
    fn coefficients(&self, scores: &[f64], count: usize) -> Vec<f64> {
        let mut b = scores[..count].to_vec();
        for j in (0..count).rev() {
            let weights = &self.triangle[j / LANES];
            b[j] /= weights[j][j % LANES];
            let (before, own) = b.split_at_mut(j);
            before.iter_mut().zip(weights).for_each(|(b, w)| *b -= own[0] * w[j % LANES]);
        }
        b
    }

    /// Returns what the columns of these scores leave of `y`.
    fn residual(&self, scores: &[f64], y: &[f64]) -> Vec<f64> {
        let mut left = y.to_vec();
        for (panel, scores) in self.panels.iter().zip(scores.chunks(LANES)) {
            for (left, row) in left.iter_mut().zip(panel) {
                *left -= product(&row[..scores.len()], scores);
            }
        }
        left
    }

    /// Returns the first `count` orthonormal columns, a column for each of their rows.
    fn transposed(&self, count: usize) -> Panels {
        let columns: Vec<Vec<f64>> =
            (0..self.rows).map(|i| self.panels.iter().flat_map(|panel| panel[i]).take(count).collect()).collect();
        Panels::from_columns(count, columns.iter().map(Vec::as_slice))
    }
}

/// Subtracts from the columns of `panel` their parts along the orthonormal columns `earlier`, and returns these.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn project(earlier: &[Lane], panel: &mut [Lane]) -> [Lane; LANES] {
    let (top, bottom) = (products::<0>(earlier, panel), products::<HEIGHT>(earlier, panel));
    let weights: [Lane; LANES] = std::array::from_fn(|k| if k < HEIGHT { top[k] } else { bottom[k - HEIGHT] });
    for (row, q) in panel.iter_mut().zip(earlier) {
        let mut sums = *row;
        for k in 0..LANES {
            add(&mut sums, -q[k], &weights[k]);
        }
        *row = sums;
    }
    weights
}

/// Orthonormalises the columns of one panel, and returns the upper triangle of their weights. A column that depends on
/// those before it becomes 0.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn orthonormalise(panel: &mut [Lane], squares: &Lane, is_first: bool) -> [Lane; LANES] {
    let (top, bottom) = (products::<0>(panel, panel), products::<HEIGHT>(panel, panel));
    let gram: [Lane; LANES] = std::array::from_fn(|k| if k < HEIGHT { top[k] } else { bottom[k - HEIGHT] });
    let mut upper = [[0.0; LANES]; LANES];
    let mut kept = [1.0; LANES];
    for j in 0..LANES {
        for i in 0..j {
            let explained: f64 = (0..i).map(|k| upper[k][i] * upper[k][j]).sum();
            upper[i][j] = kept[i] * (gram[i][j] - explained) / upper[i][i];
        }
        let left = gram[j][j] - (0..j).map(|k| upper[k][j] * upper[k][j]).sum::<f64>();
        let least = if is_first { INDEPENDENT * squares[j] } else { INDEPENDENT };
        kept[j] = if left > least { 1.0 } else { 0.0 };
        upper[j][j] = if left > least { left.sqrt() } else { 1.0 };
    }
    for row in panel.iter_mut() {
        for j in 0..LANES {
            let mut value = row[j];
            for k in 0..j {
                value -= upper[k][j] * row[k];
            }
            row[j] = kept[j] * value / upper[j][j];
        }
    }
    upper
}

/// Returns the weights of both passes together: those of the first plus those of the second times its triangle.
fn joined(first: &[Lane], second: &[Lane]) -> Vec<Lane> {
    let before = first.len() - LANES;
    let rows = first.iter().zip(second).enumerate().map(|(i, (a, b))| {
        let mut row = if i < before { *a } else { [0.0; LANES] };
        for (b, upper) in b.iter().zip(&first[before..]) {
            add(&mut row, *b, upper);
        }
        row
    });
    rows.collect()
}

/// A least-squares fit.
pub struct Squares {
    pub coefficients: Vec<f64>,
    pub mean: f64,
    /// Mean square of the rows left out one by one.
    pub left: f64,
}

impl Squares {
    /// Fits `y` by `columns`, at first in the order of `sizes`; later the columns that are not chosen have `variances`.
    pub fn new(columns: &Panels, y: &[f64], sizes: &[f64], variances: &[f64]) -> Self {
        let n = y.len();
        let mean = y.iter().sum::<f64>() / n as f64;
        let mut best = Self { coefficients: vec![0.0; sizes.len()], mean, left: f64::INFINITY };
        let mut order: Vec<usize> = (0..sizes.len()).collect();
        order.sort_by(|a, b| sizes[*b].abs().total_cmp(&sizes[*a].abs()).then(a.cmp(b)));
        for _ in 0..ROUNDS {
            let most = ((COLUMNS_OF_ROW * n as f64) as usize).min(MAX_COLUMNS).min(order.len());
            let mut first = Panels::zeros(n, most + 1);
            first.set_column(0, std::iter::repeat_n(1.0, n));
            order[..most].iter().enumerate().for_each(|(k, j)| first.set_column(k + 1, columns.column(*j)));
            let basis = Orthonormal::new(&first);
            let scores = basis.scores(y);
            let (count, left) = fewest_left(&basis, &scores, y, most);
            if count == 0 || left > LESS * best.left {
                break;
            }
            let b = basis.coefficients(&scores, count + 1);
            best = Self { coefficients: vec![0.0; sizes.len()], mean: b[0], left };
            order.iter().zip(&b[1..]).for_each(|(j, b)| best.coefficients[*j] = *b);
            let (chosen, others) = order.split_at(count);
            let mut others = others.to_vec();
            others.sort_unstable();
            if left < NOTHING || others.is_empty() || n > MAX_ROWS_OF_ROUNDS {
                break;
            }
            let chosen = chosen.to_vec();
            let residual = basis.residual(&scores[..=count], y);
            let Some(next) = by_residual(columns, &others, variances, &basis.transposed(count + 1), &residual) else {
                break;
            };
            order = chosen.into_iter().chain(next).collect();
        }
        best
    }
}

/// Returns the number of columns that, with the constant, leave least on rows left out one by one, and that mean square.
fn fewest_left(basis: &Orthonormal, scores: &[f64], y: &[f64], most: usize) -> (usize, f64) {
    let n = y.len();
    let (mut left, mut free) = (y.to_vec(), vec![1.0; n]);
    let mut best = (0, f64::INFINITY);
    for (panel, (p, scores)) in basis.panels.iter().zip(scores[..=most].chunks(LANES).enumerate()) {
        let mut sums = [0.0; LANES];
        for ((left, free), row) in left.iter_mut().zip(&mut free).zip(panel) {
            for ((sum, score), q) in sums.iter_mut().zip(scores).zip(row) {
                *left -= q * score;
                *free -= q * q;
                let out = *left / f64::max(*free, 1e-6);
                *sum += out * out;
            }
        }
        for (l, sum) in sums[..scores.len()].iter().enumerate() {
            if sum / (n as f64) < best.1 {
                best = (p * LANES + l, sum / n as f64);
            }
        }
    }
    best
}

/// Returns columns in the falling order of their posterior means for the residual of least squares.
fn by_residual(
    columns: &Panels,
    others: &[usize],
    variances: &[f64],
    fitted: &Panels,
    residual: &[f64],
) -> Option<Vec<usize>> {
    let n = residual.len();
    let sum: f64 = others.iter().map(|j| variances[*j]).sum();
    let shares: Vec<f64> = others.iter().map(|j| variances[*j] / sum).collect();
    let others_at_rows: Vec<Vec<f64>> = others.iter().map(|j| columns.column(*j).collect()).collect();
    let rows = Panels::from_rows(n, others_at_rows.iter().map(Vec::as_slice));
    let mut scaled = rows.clone();
    scaled.scale_rows(&shares);
    let mut matrix = Symmetric::products(&scaled, &rows);
    matrix.add(1e4, &Symmetric::products(fitted, fitted));
    matrix.add_to_diagonal(1e-6);
    let size = (residual.iter().map(|e| e * e).sum::<f64>() / n as f64).sqrt();
    let scaled_residual: Vec<f64> = residual.iter().map(|e| e / size).collect();
    let weights = Cholesky::new(matrix)?.solve(&scaled_residual);
    let sizes = others_at_rows.iter().zip(&shares).map(|(f, share)| share * product(f, &weights));
    let mut list: Vec<(f64, usize)> = sizes.map(f64::abs).zip(others.iter().copied()).collect();
    list.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    Some(list.into_iter().map(|(_, j)| j).collect())
}

#[cfg(test)]
#[path = "tests/squares.rs"]
mod tests;
