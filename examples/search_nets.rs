//! Searches the generator matrices of `assets/pick-freeze`: nets made for the rows A, B and AB_i of a Saltelli
//! design, for every number of factors.
//!
//!     cargo run --release --example search_nets -- 1 32 > nets.32.txt     # [first d] [last d] [levels]
//!
//! The 2d matrices, in the order A_1 B_1 A_2 B_2 .., are upper triangular with a unit diagonal, so that every coordinate
//! is a (0, 1)-sequence in base 2 (Niederreiter 1987) whatever stands above the diagonal. Level m is column m of all
//! matrices: it turns nets of 2^(m-1) points into nets of 2^m, and is chosen when the levels below are fixed.
//!
//! A dual vector of the net, one that sums rows of its matrices to 0, adds to the variance of a scrambled net for a smooth
//! integrand in proportion to 8^-k, k the sum of its leading places (Owen 1997, Ann. Stat. 25, 1541-1562). What is
//! minimised is the sum of 8^-k over all dual vectors of two to four columns, with weights: pairs 1, but d for (A_i, B_i),
//! which alone ruin the indices of a factor; triples 0.1, but 0.5 for (A_i, B_i, A_k), and 0.05 within A; quadruples 0.03, but
//! 0.09 for (A_i, B_i, A_k, A_l) and (A_i, B_i, A_k, B_k), and 0.015 within A. No dual vector is listed: the sum
//! over those of a set of columns is the mean over the points of the product of phi(leading zeros of the coordinate), as in
//! the worst-case error of digital nets (Dick and Pillichshammer 2010, Digital Nets and Sequences, ch. 12), so that the
//! sum over all sets is the mean of elementary symmetric polynomials.
//!
//! The cost is linear in phi of one column, whose coordinates in the new half of the net are those of the old half plus
//! (without carry) the new direction number. One sum over a binary tree gives the cost of all 2^(m-1) choices, of which
//! the best is taken: coordinate descent over the columns until nothing changes, from several random starts, most of them
//! near the best so far.
//!
//! Additions and multiplications only, in an order that is fixed: the same seed gives the same table on every machine.

use std::io::Write;

/// Levels of the table of `d` factors. Every further level takes as long as all before it: the whole search some two minutes
/// on one core, with 20 levels for all d about ten.
fn levels(d: usize) -> u32 {
    if d <= 12 { 20 } else { 16 }
}

/// Largest number of factors.
const MOST_FACTORS: usize = 64;
/// Seed of the starts.
const SEED: u64 = 14;
/// Weights of triples and of quadruples, and what is added for those that hold (A_i, B_i), or lie within A.
const TRIPLE: f64 = 0.1;
const QUADRUPLE: f64 = 0.03;
const PAIRED_TRIPLE: f64 = 4.0;
const PAIRED_QUADRUPLE: f64 = 2.0;
const WITHIN_A: f64 = -0.5;

/// Starts and most sweeps of level `m` of the table of `d` factors: long nets of many factors cost more, and are less erratic.
fn effort(d: usize, m: u32) -> (u32, u32) {
    match (d, m) {
        (_, 1) => (1, 0),
        (..=20, ..=12) => (24, 20),
        (..=20, 13..=15) => (4, 8),
        (..=20, 16..=17) => (1, 6),
        (21.., ..=10) => (6, 10),
        (21.., 11..=13) => (1, 4),
        _ => (1, 2),
    }
}

/// Random numbers by SplitMix64 (Steele, Lea and Flood 2014, OOPSLA).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// phi(l) for l = 0, 1, ..: the sum of 8^-k wal_h(x) over all h > 0 with k the place of the leading one of h, for an x with
/// l leading zeros.
fn phi() -> [f64; 34] {
    let mut sum = 0.0;
    std::array::from_fn(|l| {
        let next = 0.5 * 0.25f64.powi(l as i32 + 1);
        let value = sum - next;
        sum += next;
        value
    })
}

/// The direction numbers of one column: entry k has bit 31 - k set (place k + 1) and bits above it.
type Column = Vec<u32>;

/// Sums over the factors at every point of the new half of a net.
struct Sums {
    /// Elementary symmetric polynomials e1, e2, e3 of all columns, and of those of A.
    all: [Vec<f64>; 3],
    of_a: [Vec<f64>; 3],
    /// Sum of p_i = a_i b_i, and of p_i (A_1 - a_i), where A_1 is the sum over A.
    pairs: Vec<f64>,
    mixed: Vec<f64>,
}

impl Sums {
    fn new(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        let three = || std::array::from_fn(|_| zeros());
        Self { all: three(), of_a: three(), pairs: zeros(), mixed: zeros() }
    }

    /// With one more factor, whose values are `a` and `b`.
    fn add(&mut self, a: &[f64], b: &[f64]) {
        let Self { all: [e1, e2, e3], of_a: [a1, a2, a3], pairs, mixed } = self;
        for n in 0..a.len() {
            let (u, w) = (a[n], b[n]);
            let (s, p) = (u + w, u * w);
            mixed[n] += p * a1[n] + u * pairs[n];
            pairs[n] += p;
            e3[n] += s * e2[n] + p * e1[n];
            e2[n] += s * e1[n] + p;
            e1[n] += s;
            a3[n] += u * a2[n];
            a2[n] += u * a1[n];
            a1[n] += u;
        }
    }

    /// Without a factor that it has.
    fn remove(&mut self, a: &[f64], b: &[f64]) {
        let Self { all: [e1, e2, e3], of_a: [a1, a2, a3], pairs, mixed } = self;
        for n in 0..a.len() {
            let (u, w) = (a[n], b[n]);
            let (s, p) = (u + w, u * w);
            e1[n] -= s;
            e2[n] -= s * e1[n] + p;
            e3[n] -= s * e2[n] + p * e1[n];
            a1[n] -= u;
            a2[n] -= u * a1[n];
            a3[n] -= u * a2[n];
            pairs[n] -= p;
            mixed[n] -= p * a1[n] + u * pairs[n];
        }
    }

    /// What a factor of values `u`, `w` adds to the cost at point `n`, divided by u (`of_a`) or by w, where `other` is the
    /// other one of them, and but for what does not depend on this one.
    fn slope(&self, n: usize, other: f64, of_a: bool, d: f64) -> f64 {
        let [e1, e2, e3] = [self.all[0][n], self.all[1][n], self.all[2][n]];
        let [a1, a2, a3] = [self.of_a[0][n], self.of_a[1][n], self.of_a[2][n]];
        let (pairs, mixed) = (self.pairs[n], self.mixed[n]);
        let mut triples = other * e1 + e2 + PAIRED_TRIPLE * other * a1;
        let mut quadruples = other * e2 + e3 + PAIRED_QUADRUPLE * other * (a2 + pairs);
        if of_a {
            triples += PAIRED_TRIPLE * pairs + WITHIN_A * a2;
            quadruples += PAIRED_QUADRUPLE * mixed + WITHIN_A * a3;
        }
        e1 + d * other + TRIPLE * triples + QUADRUPLE * quadruples
    }
}

/// The search at one level.
struct Level<'a> {
    m: u32,
    /// Columns of the levels below.
    below: &'a [Column],
    phi: [f64; 34],
    sums: Sums,
    /// Coordinates of a column in the old half, and values of phi in the new one.
    coordinates: Vec<u32>,
    a: Vec<f64>,
    b: Vec<f64>,
    /// Sums over the nodes of a binary tree: node 1 is the root, 2k and 2k + 1 are the halves of k.
    tree: Vec<f64>,
}

impl<'a> Level<'a> {
    fn new(m: u32, below: &'a [Column]) -> Self {
        let n = 1 << (m - 1);
        let zeros = || vec![0.0; n];
        Self {
            m,
            below,
            phi: phi(),
            sums: Sums::new(n),
            coordinates: vec![0; n],
            a: zeros(),
            b: zeros(),
            tree: vec![0.0; 2 * n],
        }
    }

    fn place(&mut self, column: usize) {
        for (k, direction) in self.below[column].iter().enumerate() {
            let (done, rest) = self.coordinates.split_at_mut(1 << k);
            for (new, old) in rest.iter_mut().zip(done) {
                *new = *old ^ direction;
            }
        }
    }

    /// The values of one column of factor `i` in the new half.
    fn value(&mut self, i: usize, side: usize, directions: &[u32]) {
        self.place(2 * i + side);
        let out = if side == 0 { &mut self.a } else { &mut self.b };
        for (x, value) in self.coordinates.iter().zip(out) {
            *value = self.phi[(x ^ directions[2 * i + side]).leading_zeros() as usize];
        }
    }

    /// The values of factor `i` in the new half.
    fn values(&mut self, i: usize, directions: &[u32]) {
        self.value(i, 0, directions);
        self.value(i, 1, directions);
    }

    /// The best direction number of one column of factor `i`, whose values have been taken out of the sums.
    fn best(&mut self, i: usize, side: usize, d: usize) -> u32 {
        self.place(2 * i + side);
        let leaves = self.coordinates.len();
        let others = if side == 0 { &self.b } else { &self.a };
        let shift = 32 - (self.m - 1);
        for (n, x) in self.coordinates.iter().enumerate() {
            // 64 bits: there is no shift by 32 of the one coordinate of level 1.
            let leaf = (u64::from(*x) >> shift) as usize;
            self.tree[leaves + leaf] = self.sums.slope(n, others[n], side == 0, d as f64);
        }
        for node in (1..leaves).rev() {
            self.tree[node] = self.tree[2 * node] + self.tree[2 * node + 1];
        }
        self.tree[1] *= self.phi[0];
        for node in 2..2 * leaves {
            let depth = node.ilog2() as usize;
            self.tree[node] = self.tree[node / 2] + (self.phi[depth] - self.phi[depth - 1]) * self.tree[node];
        }
        let (mut best, mut least) = (0, f64::INFINITY);
        for (leaf, cost) in self.tree[leaves..].iter().enumerate() {
            if *cost < least {
                (best, least) = (leaf, *cost);
            }
        }
        ((best as u64) << shift) as u32 | 1 << (32 - self.m)
    }

    /// Descent from `directions` over all columns, at most `sweeps` times; the cost of the new half.
    fn descend(&mut self, directions: &mut [u32], sweeps: u32) -> f64 {
        let d = directions.len() / 2;
        self.sums = Sums::new(self.coordinates.len());
        for i in 0..d {
            self.values(i, directions);
            self.sums.add(&self.a, &self.b);
        }
        for _ in 0..sweeps {
            let before = directions.to_vec();
            for i in 0..d {
                self.values(i, directions);
                self.sums.remove(&self.a, &self.b);
                for side in 0..2 {
                    directions[2 * i + side] = self.best(i, side, d);
                    self.value(i, side, directions);
                }
                self.sums.add(&self.a, &self.b);
            }
            if directions == before {
                break;
            }
        }
        self.cost(directions)
    }

    /// What the factor of values `a` and `b` adds to the cost at point `n`.
    fn added(&self, n: usize, d: usize) -> f64 {
        let (u, w) = (self.a[n], self.b[n]);
        u * self.sums.slope(n, w, true, d as f64) + w * self.sums.slope(n, 0.0, false, d as f64)
    }

    /// The cost of the new half: factor by factor, what each adds to those before.
    fn cost(&mut self, directions: &[u32]) -> f64 {
        let d = directions.len() / 2;
        self.sums = Sums::new(self.coordinates.len());
        let mut points = vec![0.0; self.coordinates.len()];
        for i in 0..d {
            self.values(i, directions);
            for (n, point) in points.iter_mut().enumerate() {
                *point += self.added(n, d);
            }
            self.sums.add(&self.a, &self.b);
        }
        while points.len() > 1 {
            points = points.chunks(2).map(|pair| pair.iter().sum()).collect();
        }
        points[0]
    }
}

/// The cost of the point 0 of `d` factors.
fn zero_cost(d: usize) -> f64 {
    let mut level = Level::new(1, &[]);
    let value = vec![phi()[33]];
    (level.a, level.b) = (value.clone(), value);
    let mut cost = 0.0;
    for _ in 0..d {
        cost += level.added(0, d);
        level.sums.add(&level.a, &level.b);
    }
    cost
}

/// The columns of a design of `d` factors.
fn search(d: usize, levels: u32) -> Vec<Column> {
    let mut columns = vec![Column::new(); 2 * d];
    let mut random = Random(SEED.wrapping_mul(1 << 32) + d as u64);
    // Of the points of the levels below: at first of the point 0 alone.
    let mut cost = zero_cost(d);
    for m in 1..=levels {
        let (starts, sweeps) = effort(d, m);
        let mut level = Level::new(m, &columns);
        let mut best = (f64::INFINITY, Vec::new());
        for _ in 0..starts {
            let unit = 1u32 << (32 - m);
            // From the best so far, with a random share of the columns drawn anew: at first all.
            let share = if best.1.is_empty() {
                1.0
            } else {
                let u = random.uniform();
                u * u
            };
            let mut draw = |column: usize| {
                let direction = random.next() as u32 & unit.wrapping_neg() | unit;
                if random.uniform() < share { direction } else { best.1[column] }
            };
            let mut directions: Vec<u32> = (0..2 * d).map(&mut draw).collect();
            let cost = level.descend(&mut directions, sweeps);
            if cost < best.0 {
                best = (cost, directions);
            }
        }
        cost += best.0;
        // As a number of dual vectors of weight 1 and leading places m.
        eprintln!("d = {d}, level {m}: {:.4}", cost * 4f64.powi(m as i32));
        for (column, direction) in columns.iter_mut().zip(best.1) {
            column.push(direction);
        }
    }
    columns
}

/// The bits above the diagonal of one column after another, in groups of four.
fn hexadecimal(column: &[u32]) -> String {
    let bits =
        column.iter().enumerate().flat_map(|(k, direction)| (0..k).map(move |place| direction >> (31 - place) & 1));
    let bits: Vec<u32> = bits.collect();
    bits.chunks(4).map(|four| format!("{:x}", (0..4).fold(0, |sum, i| sum << 1 | four.get(i).unwrap_or(&0)))).collect()
}

fn main() -> std::io::Result<()> {
    let numbers: Vec<usize> = std::env::args().skip(1).filter_map(|argument| argument.parse().ok()).collect();
    let (first, last) = (numbers.first().copied().unwrap_or(1), numbers.get(1).copied().unwrap_or(MOST_FACTORS));
    let mut out = std::io::stdout().lock();
    for d in first..=last {
        for factor in search(d, numbers.get(2).map_or(levels(d), |levels| *levels as u32)).chunks(2) {
            writeln!(out, "{} {} {}", d, hexadecimal(&factor[0]), hexadecimal(&factor[1]))?;
        }
    }
    Ok(())
}
