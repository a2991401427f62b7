//! Moments as sums over base points, for resampling and influences.
//!
//! All of [`Moments`] follow from sums over the base points of products of two centred outputs. Weighting the points,
//! as a bootstrap does, weights the sums: the moments of a resample follow by a matrix product.

use super::pair_moments::PairMoments;
use super::swap_moments::BaMoments;
use super::workspace::{Differences, difference};
use super::{BaseMoments, BlockOutputs, Moments, SwapMoments};

/// The letters that form products: 1 at a base point that counts, and the outputs and differences of [`SwapMoments`]
/// minus their means over all points. All are 0 at a base point that does not count.
const ONE: usize = 0;
const A: usize = 1;
const B: usize = 2;
const D: usize = 3;
const E: usize = 4;
const LETTERS: usize = 5;

type Product = (usize, usize);

/// Products of the rows A and B; the first counts the points.
const BASE: [Product; 6] = [(ONE, ONE), (A, ONE), (B, ONE), (A, A), (B, B), (A, B)];
/// Products that the rows AB and BA of a swap add.
const WITH_AB: [Product; 4] = [(D, ONE), (D, D), (A, D), (B, D)];
const WITH_BA: [Product; 5] = [(E, ONE), (E, E), (A, E), (B, E), (D, E)];

/// The products of the outputs at a base point from which the moments are computed.
///
/// A swap that lost points of A and B has its own count and its own products of A and B over them; so does a pair.
#[derive(Debug, Clone)]
pub struct Products {
    /// The moments of all points; the products are centred on their means.
    all: Moments,
    /// Whether each swap counts its own points.
    own: Vec<bool>,
    /// The products that each swap adds to those of the base.
    of_swap: Vec<Product>,
    /// Ordered pairs of swaps whose sums are kept, and whether each counts its own points.
    pairs: Vec<(usize, usize, bool)>,
    columns: usize,
}

/// Buffers of [`Products::fill`].
#[derive(Debug, Default)]
pub struct ProductWork {
    base: [Vec<f64>; LETTERS],
    swap: [Vec<f64>; LETTERS],
    /// Those of every swap, for pairs, not centred.
    differences: Vec<Differences>,
}

impl Products {
    /// Creates the products that lead to `all`, the moments of all base points.
    pub fn new(all: Moments) -> Self {
        let mut of_swap = WITH_AB.to_vec();
        if all.has_ba() {
            of_swap.extend(WITH_BA);
        }
        let count = all.count();
        let own: Vec<bool> = (0..all.swaps()).map(|swap| all.swap(swap).base.n != count).collect();
        let paired = all.pairs().map_or(&[][..], PairMoments::swaps);
        let ordered = paired.iter().flat_map(|&j| paired.iter().filter(move |k| **k != j).map(move |&k| (j, k)));
        let mut pairs = Vec::new();
        for (j, k) in ordered {
            let points = all.pairs().and_then(|pairs| pairs.mean(j, k)).map_or(0, |(_, points)| points);
            pairs.push((j, k, points != count));
        }
        let columns = BASE.len()
            + own.iter().map(|own| of_swap.len() + if *own { BASE.len() } else { 0 }).sum::<usize>()
            + pairs.iter().map(|(_, _, own)| 1 + usize::from(*own)).sum::<usize>();
        Self { all, own, of_swap, pairs, columns }
    }

    /// Returns the number of products at each base point.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns for each product the index of the one that counts its base points; for those that count, their own.
    pub fn counts(&self) -> Vec<usize> {
        let mut counts = vec![0; BASE.len()];
        for own in &self.own {
            let (first, length) = (counts.len(), self.of_swap.len());
            let (count, more) = if *own { (first, BASE.len()) } else { (0, 0) };
            counts.extend(std::iter::repeat_n(count, length + more));
        }
        for (_, _, own) in &self.pairs {
            let first = counts.len();
            counts.extend(if *own { vec![first; 2] } else { vec![0] });
        }
        counts
    }

    /// Writes the products of the base points of `block`: product c of point i to `out[c * stride + i]`.
    pub fn fill(&self, block: &BlockOutputs<'_>, out: &mut [f64], stride: usize, work: &mut ProductWork) {
        let ProductWork { base: letters, swap: of_swap, differences } = work;
        let points = block.a.len();
        let mut columns = out.chunks_mut(stride).map(|column| &mut column[..points]);
        let mut put = |letters: &[Vec<f64>; LETTERS], products: &[Product]| {
            for (column, &(x, y)) in columns.by_ref().take(products.len()).zip(products) {
                column.iter_mut().zip(&letters[x]).zip(&letters[y]).for_each(|((out, x), y)| *out = x * y);
            }
        };
        let base = self.all.base();
        set_mask(&mut letters[ONE], points, &[block.a, block.b]);
        set_centred(letters, A, block.a, None, base.mean_a);
        set_centred(letters, B, block.b, None, base.mean_b);
        put(letters, &BASE);
        for (swap, own) in self.own.iter().enumerate() {
            let moments = self.all.swap(swap);
            let rows = [block.ab, block.ba].map(|rows| rows.get(swap).copied());
            let letters = if *own {
                let asked: Vec<&[f64]> = [block.a, block.b].into_iter().chain(rows.into_iter().flatten()).collect();
                set_mask(&mut of_swap[ONE], points, &asked);
                set_centred(of_swap, A, block.a, None, moments.base.mean_a);
                set_centred(of_swap, B, block.b, None, moments.base.mean_b);
                put(of_swap, &BASE);
                &mut *of_swap
            } else {
                &mut *letters
            };
            let mean_e = moments.ba.map_or(0.0, |ba| ba.mean_e);
            let [ab, ba] = rows;
            for (letter, row, origin, mean) in [(D, ab, block.a, moments.mean_d), (E, ba, block.b, mean_e)] {
                if let Some(row) = row {
                    set_centred(letters, letter, row, Some(origin), mean);
                }
            }
            put(letters, &self.of_swap);
        }
        self.fill_pairs(block, &letters[ONE], differences, &mut columns);
    }

    /// Writes the products of pairs to the next columns.
    fn fill_pairs<'c>(
        &self,
        block: &BlockOutputs<'_>,
        mask: &[f64],
        differences: &mut Vec<Differences>,
        columns: &mut impl Iterator<Item = &'c mut [f64]>,
    ) {
        if self.pairs.is_empty() {
            return;
        }
        differences.resize_with(self.own.len(), Default::default);
        for (swap, Differences { d, e }) in differences.iter_mut().enumerate() {
            for (into, row, origin) in [(d, block.ab[swap], block.a), (e, block.ba[swap], block.b)] {
                difference(row, origin, into);
            }
        }
        for (j, k, own) in &self.pairs {
            let product = |i: usize| differences[*j].e[i] * differences[*k].d[i];
            let counts = |i: usize| if *own { product(i).is_finite() } else { mask[i] > 0.0 };
            if *own && let Some(column) = columns.next() {
                column.iter_mut().enumerate().for_each(|(i, out)| *out = f64::from(u8::from(counts(i))));
            }
            if let Some(column) = columns.next() {
                column.iter_mut().enumerate().for_each(|(i, out)| *out = if counts(i) { product(i) } else { 0.0 });
            }
        }
    }

    /// Computes the moments of weighted base points from the weighted sums of their products.
    pub fn moments(&self, sums: &[f64]) -> Moments {
        let mut sums = sums.iter().copied();
        let mut next = move || sums.next().unwrap_or(f64::NAN);
        let base = base_moments(&mut next, self.all.base());
        let swaps = self.own.iter().enumerate().map(|(swap, own)| {
            let all = self.all.swap(swap);
            let (moments, gaps) = if *own { base_moments(&mut next, &all.base) } else { base };
            swap_moments(&mut next, (moments, gaps), all)
        });
        let swaps = swaps.collect();
        let pairs = self.all.pairs().map(|all| {
            let means = self.pairs.iter().map(|(_, _, own)| {
                let n = if *own { next().round() } else { base.0.n as f64 };
                (if n > 0.0 { next() / n } else { next() * 0.0 }, n as u64)
            });
            PairMoments::from_means(all.swaps(), means)
        });
        Moments::from_sums(base.0, swaps, pairs)
    }
}

/// Sets `mask` to 1 where all of `columns` are finite, 0 elsewhere.
fn set_mask(mask: &mut Vec<f64>, points: usize, columns: &[&[f64]]) {
    mask.clear();
    mask.resize(points, 1.0);
    for column in columns {
        mask.iter_mut().zip(*column).filter(|(_, y)| !y.is_finite()).for_each(|(mask, _)| *mask = 0.0);
    }
}

/// Sets a letter to `y`, or `y` minus `origin`, minus `mean`; 0 where the mask is 0.
fn set_centred(letters: &mut [Vec<f64>; LETTERS], letter: usize, y: &[f64], origin: Option<&[f64]>, mean: f64) {
    let (mask, rest) = letters.split_at_mut(1);
    let (mask, into) = (&mask[0], &mut rest[letter - 1]);
    into.clear();
    match origin {
        None => into.extend(y.iter().map(|y| y - mean)),
        Some(origin) => into.extend(y.iter().zip(origin).map(|(y, origin)| y - origin - mean)),
    }
    into.iter_mut().zip(mask).filter(|(_, mask)| **mask == 0.0).for_each(|(x, _)| *x = 0.0);
}

/// Sums of the centred outputs A and B, if they are about other means than their own.
type Gaps = (f64, f64);

/// Moves a sum of products to new means: nothing large is subtracted: the means differ by about a standard error.
fn recentred(product: f64, x: f64, y: f64, n: f64) -> f64 {
    product - x * (y / n)
}

/// Moves a sum of squares; the remainder of a resample without variance is rounding, and set to 0.
fn recentred_square(square: f64, x: f64, n: f64) -> f64 {
    const ROUNDING: f64 = 64.0 * f64::EPSILON;
    let left = recentred(square, x, x, n);
    if left <= ROUNDING * square { 0.0 } else { left }
}

fn base_moments(next: &mut impl FnMut() -> f64, all: &BaseMoments) -> (BaseMoments, Gaps) {
    let [n, a, b, aa, bb, ab] = std::array::from_fn(|_| next());
    let points = n.round();
    if points <= 0.0 {
        return (BaseMoments::default(), (0.0, 0.0));
    }
    let base = BaseMoments {
        n: points as u64,
        mean_a: all.mean_a + a / points,
        mean_b: all.mean_b + b / points,
        aa: recentred_square(aa, a, points),
        bb: recentred_square(bb, b, points),
        ab: recentred(ab, a, b, points),
    };
    (base, (a, b))
}

fn swap_moments(next: &mut impl FnMut() -> f64, (base, (a, b)): (BaseMoments, Gaps), all: &SwapMoments) -> SwapMoments {
    let n = if base.n == 0 { 1.0 } else { base.n as f64 };
    let [d, dd, ad, bd] = std::array::from_fn(|_| next());
    let ba = all.ba.map(|ba| {
        let [e, ee, ae, be, de] = std::array::from_fn(|_| next());
        BaMoments {
            mean_e: ba.mean_e + e / n,
            ee: recentred_square(ee, e, n),
            ae: recentred(ae, a, e, n),
            be: recentred(be, b, e, n),
            de: recentred(de, d, e, n),
        }
    });
    SwapMoments {
        base,
        mean_d: all.mean_d + d / n,
        dd: recentred_square(dd, d, n),
        ad: recentred(ad, a, d, n),
        bd: recentred(bd, b, d, n),
        ba,
    }
}
