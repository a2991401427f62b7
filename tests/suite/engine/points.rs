//! Points of many kinds in the unit cube, as columns: independent ones, and others that only look independent.

use apportion::design::{Design, DesignSettings, Rows, Sampler, SobolSequence};

pub type Columns = Vec<Vec<f64>>;

/// Points by number of inputs, number of rows, and seed.
pub type Sample = fn(usize, usize, u64) -> Columns;

pub fn random(d: usize, n: usize, seed: u64) -> Columns {
    sampled(Sampler::Random, d, n, seed)
}

pub fn latin(d: usize, n: usize, seed: u64) -> Columns {
    sampled(Sampler::LatinHypercube, d, n, seed)
}

/// The matrix A of a design.
fn sampled(sampler: Sampler, d: usize, n: usize, seed: u64) -> Columns {
    let settings = DesignSettings { sampler, base_samples: n.max(2) as u64, replicates: 1, seed };
    let mut columns = vec![vec![0.0; n]; d];
    Design::new(settings, d, Rows::default()).unwrap().replicate(0).fill(0, &mut columns);
    columns
}

pub fn sobol(d: usize, n: usize, seed: u64) -> Columns {
    fill(&SobolSequence::scrambled(d, seed, 0), d, n)
}

pub fn sobol_plain(d: usize, n: usize, _: u64) -> Columns {
    fill(&SobolSequence::plain(d), d, n)
}

fn fill(sequence: &SobolSequence, d: usize, n: usize) -> Columns {
    let mut columns = vec![vec![0.0; n]; d];
    for (dimension, column) in columns.iter_mut().enumerate() {
        sequence.fill(dimension, 0, column);
    }
    columns
}

const PRIMES: [usize; 10] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29];

/// The Halton sequence from an index that depends on the seed.
pub fn halton(d: usize, n: usize, seed: u64) -> Columns {
    let inverse = |mut k: usize, base: usize| {
        let (mut value, mut digit) = (0.0, 1.0 / base as f64);
        while k > 0 {
            value += (k % base) as f64 * digit;
            k /= base;
            digit /= base as f64;
        }
        value
    };
    let from = 1 + 97 * seed as usize;
    PRIMES[..d].iter().map(|&base| (from..from + n).map(|k| inverse(k, base)).collect()).collect()
}

/// The Kronecker sequence of the square roots of primes, shifted.
pub fn kronecker(d: usize, n: usize, seed: u64) -> Columns {
    let shift = &random(d, 1, seed);
    let column = |j: usize| (0..n).map(move |k| (k as f64 * (PRIMES[j] as f64).sqrt() + shift[j][0]).fract());
    (0..d).map(|j| column(j).collect()).collect()
}

/// A shifted rank-1 lattice of Korobov's form, generator 1, a, a^2, ... (a near 0.38 n, odd).
pub fn lattice(d: usize, n: usize, seed: u64) -> Columns {
    let shift = &random(d, 1, seed);
    let a = (0.38 * n as f64) as usize | 1;
    let powers: Vec<usize> = (0..d).scan(1, |z, _| Some(std::mem::replace(z, *z * a % n))).collect();
    let column = |j: usize| {
        let z = powers[j];
        (0..n).map(move |k| ((k * z % n) as f64 / n as f64 + shift[j][0]).fract())
    };
    (0..d).map(|j| column(j).collect()).collect()
}

/// The rows A, B and AB_j of every base point, one after the other.
pub fn saltelli(d: usize, base: u64, sampler: Sampler, seed: u64) -> Columns {
    let settings = DesignSettings { sampler, base_samples: base, replicates: 1, seed };
    let design = Design::new(settings, d, Rows::plain((0..d).map(|j| vec![j]).collect())).unwrap();
    let mut row = vec![0.0; d];
    let mut columns = vec![Vec::new(); d];
    for k in 0..design.rows() {
        design.point(k, &mut row);
        columns.iter_mut().zip(&row).for_each(|(column, u)| column.push(*u));
    }
    columns
}

/// Every combination of `levels` values.
pub fn grid(d: usize, levels: usize) -> Columns {
    let n = levels.pow(d as u32);
    (0..d).map(|j| (0..n).map(|k| (k / levels.pow(j as u32) % levels) as f64).collect()).collect()
}

/// Trajectories of `d + 1` rows on a grid of `levels` values, each row one step in one input from the row before.
pub fn trajectories(d: usize, count: usize, levels: usize, seed: u64) -> Columns {
    let mut columns = vec![Vec::new(); d];
    let draws = random(d, count, seed);
    for t in 0..count {
        let mut row: Vec<usize> = draws[..d].iter().map(|draw| (draw[t] * levels as f64) as usize).collect();
        for step in 0..=d {
            if step > 0 {
                row[step - 1] = (row[step - 1] + levels / 2) % levels;
            }
            columns.iter_mut().zip(&row).for_each(|(column, level)| column.push(*level as f64));
        }
    }
    columns
}

/// The same rows in a random order.
pub fn shuffled(columns: Columns, seed: u64) -> Columns {
    let keys = &random(1, columns[0].len(), seed ^ 0x5eed)[0];
    let mut rows: Vec<usize> = (0..keys.len()).collect();
    rows.sort_by(|&a, &b| keys[a].total_cmp(&keys[b]));
    columns.into_iter().map(|column| rows.iter().map(|&row| column[row]).collect()).collect()
}
