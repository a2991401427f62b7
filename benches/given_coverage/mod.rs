//! How often the intervals of first-order indices hold: twenty-six functions, four kinds of inputs, three numbers of rows.

use std::f64::consts::PI;
use std::fmt::Write as _;

use apportion::Distribution;
use apportion::given::{Column, analyse};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const ROWS: [usize; 3] = [200, 1000, 10_000];
/// Nodes of the quadrature of moments.
const NODES: usize = 40_000;
/// Normal scores beyond this are left out of it.
const FARTHEST: f64 = 14.0;

type Part = fn(f64) -> f64;
/// A coefficient and a function of each of three inputs, which are multiplied.
type Term = (f64, [Part; 3]);

fn one(_: f64) -> f64 {
    1.0
}
fn id(x: f64) -> f64 {
    x
}
fn square(x: f64) -> f64 {
    x * x
}
fn root(x: f64) -> f64 {
    x.abs().sqrt()
}
fn step(x: f64) -> f64 {
    f64::from(x > 0.7)
}
fn rare(x: f64) -> f64 {
    f64::from(x > 0.9)
}
fn half(x: f64) -> f64 {
    f64::from(x > 0.5)
}
fn centre(x: f64) -> f64 {
    x - 0.5
}
fn wave(x: f64) -> f64 {
    (2.0 * PI * x).sin()
}
fn half_wave(x: f64) -> f64 {
    (PI * x).cos()
}
fn kink(x: f64) -> f64 {
    (x - 0.5).abs()
}
fn bell(x: f64) -> f64 {
    (-(2.0 * x - 1.0).powi(2)).exp()
}
fn logarithm(x: f64) -> f64 {
    (1.0 + x.abs()).ln()
}
fn bent(x: f64) -> f64 {
    (3.0 * x - 1.0).tanh()
}

fn functions() -> Vec<(&'static str, Vec<Term>)> {
    vec![
        ("3a + b", vec![(3.0, [id, one, one]), (1.0, [one, id, one])]),
        ("a + b + c", vec![(1.0, [id, one, one]), (1.0, [one, id, one]), (1.0, [one, one, id])]),
        ("10a + b", vec![(10.0, [id, one, one]), (1.0, [one, id, one])]),
        ("a b", vec![(1.0, [id, id, one])]),
        ("a + b c", vec![(1.0, [id, one, one]), (1.0, [one, id, id])]),
        ("a^2 + b", vec![(1.0, [square, one, one]), (1.0, [one, id, one])]),
        ("a^2 b", vec![(1.0, [square, id, one])]),
        ("sqrt a + b", vec![(1.0, [root, one, one]), (1.0, [one, id, one])]),
        ("step a + b", vec![(1.0, [step, one, one]), (1.0, [one, id, one])]),
        ("step a step b + c", vec![(1.0, [step, step, one]), (1.0, [one, one, id])]),
        ("sin 2 pi a + b", vec![(1.0, [wave, one, one]), (1.0, [one, id, one])]),
        ("sin 2 pi a cos pi b + c", vec![(1.0, [wave, half_wave, one]), (1.0, [one, one, id])]),
        ("|a - 0.5| + b", vec![(1.0, [kink, one, one]), (1.0, [one, id, one])]),
        ("|a - 0.5| |b - 0.5|", vec![(1.0, [kink, kink, one])]),
        ("bell a + bell b", vec![(1.0, [bell, one, one]), (1.0, [one, bell, one])]),
        ("bell a b", vec![(1.0, [bell, id, one])]),
        ("log a + log b", vec![(1.0, [logarithm, one, one]), (1.0, [one, logarithm, one])]),
        ("log a b + c", vec![(1.0, [logarithm, id, one]), (1.0, [one, one, id])]),
        ("tanh a + 0.2 b", vec![(1.0, [bent, one, one]), (0.2, [one, id, one])]),
        ("rare a rare b", vec![(1.0, [rare, rare, one])]),
        ("5 rare a rare b + a + c", vec![(5.0, [rare, rare, one]), (1.0, [id, one, one]), (1.0, [one, one, id])]),
        ("10 half a + b", vec![(10.0, [half, one, one]), (1.0, [one, id, one])]),
        ("2 step a + b", vec![(2.0, [step, one, one]), (1.0, [one, id, one])]),
        ("step a step b step c", vec![(1.0, [step, step, step])]),
        ("(a - 0.5) (b - 0.5)", vec![(1.0, [centre, centre, one])]),
        ("tanh a tanh b + 0.2 c", vec![(1.0, [bent, bent, one]), (0.2, [one, one, id])]),
    ]
}

/// The mean of `of` over a distribution: over normal scores, so that long tails count.
fn mean(law: &Distribution, of: impl Fn(f64) -> f64) -> f64 {
    if let Some(levels) = law.levels() {
        return levels.iter().map(|(value, _)| of(*value)).sum::<f64>() / levels.len() as f64;
    }
    let score = |k: usize| FARTHEST * ((2 * k + 1) as f64 / NODES as f64 - 1.0);
    let width = 2.0 * FARTHEST / NODES as f64;
    let weight = |z: f64| (-z * z / 2.0).exp() / (2.0 * PI).sqrt() * width;
    let value = |z: f64| match law.name() {
        "normal" => z,
        "log-normal" => z.exp(),
        _ => law.quantile(0.5 * (1.0 + z / FARTHEST)),
    };
    // A uniform input is even in itself, the others in their scores.
    let weight = |z: f64| if law.name() == "uniform" { 1.0 / NODES as f64 } else { weight(z) };
    (0..NODES).map(score).map(|z| weight(z) * of(value(z))).sum()
}

/// First-order indices of a sum of products.
fn exact(terms: &[Term], law: &Distribution) -> [f64; 3] {
    let means: Vec<[f64; 3]> = terms.iter().map(|(_, parts)| parts.map(|part| mean(law, part))).collect();
    let mut variance = 0.0;
    let mut of_input = [0.0; 3];
    for (t, (c, parts)) in terms.iter().enumerate() {
        for (s, (d, others)) in terms.iter().enumerate() {
            let products: [f64; 3] = std::array::from_fn(|i| mean(law, |x| parts[i](x) * others[i](x)));
            let squares: [f64; 3] = std::array::from_fn(|i| means[t][i] * means[s][i]);
            variance += c * d * (products.iter().product::<f64>() - squares.iter().product::<f64>());
            for (j, index) in of_input.iter_mut().enumerate() {
                let rest: f64 = (0..3).filter(|i| *i != j).map(|i| squares[i]).product();
                *index += c * d * (products[j] - squares[j]) * rest;
            }
        }
    }
    of_input.map(|part| part / variance)
}

#[derive(Default)]
struct Held {
    held: f64,
    count: f64,
    squares: f64,
    widths: f64,
}

/// The table, of `seeds` tables for each cell.
pub fn table(seeds: u64) -> String {
    let laws = [
        ("uniform", Distribution::uniform(0.0, 1.0)),
        ("normal", Distribution::normal(0.0, 1.0)),
        ("log-normal", Distribution::log_normal_of_logs(0.0, 1.0)),
        ("six values", Distribution::integer(0.0, 5.0)),
    ];
    let mut text =
        "| inputs | rows | ranks: coverage / half width / error | bins: the same | the one shown | below 90 %: ranks; bins; shown |\n\
                    |---|---|---|---|---|---|\n"
            .to_owned();
    for (kind, law) in laws {
        let law = law.expect("a distribution");
        let cases: Vec<_> = functions().into_iter().map(|(name, terms)| (name, exact(&terms, &law), terms)).collect();
        for rows in ROWS {
            let (mut all, mut missed): ([Held; 3], [Vec<String>; 3]) = Default::default();
            for (name, exact, terms) in &cases {
                let mut own: [Held; 3] = Default::default();
                for seed in 0..seeds {
                    let mut rng = ChaCha8Rng::seed_from_u64(seed);
                    let mut column =
                        || (0..rows).map(|_| law.quantile(rng.random_range(1e-12..1.0))).collect::<Vec<f64>>();
                    let columns = [column(), column(), column()];
                    let value = |k: usize| {
                        let term = |(c, parts): &Term| c * (0..3).map(|i| parts[i](columns[i][k])).product::<f64>();
                        terms.iter().map(term).sum::<f64>()
                    };
                    let y = Column { name: "y".to_owned(), values: (0..rows).map(value).collect() };
                    let named = columns.iter().zip(["a", "b", "c"]);
                    let inputs: Vec<Column> =
                        named.map(|(values, name)| Column { name: name.to_owned(), values: values.clone() }).collect();
                    let Ok(result) = analyse(&inputs, &[y], seed) else { continue };
                    // Inputs that act.
                    for (index, exact) in
                        result.outputs[0].indices.iter().flatten().zip(exact).filter(|of| *of.1 > 1e-9)
                    {
                        let estimates = [index.rank, Some(index.binned.estimate), Some(index.leading())];
                        for (held, estimate) in own.iter_mut().zip(estimates) {
                            let Some((estimate, interval)) = estimate.and_then(|e| Some((e.estimate, e.interval?)))
                            else {
                                continue;
                            };
                            held.count += 1.0;
                            held.held += f64::from(interval.low <= *exact && *exact <= interval.high);
                            held.squares += (estimate - exact).powi(2);
                            held.widths += (interval.high - interval.low) / 2.0;
                        }
                    }
                }
                for ((own, all), missed) in own.iter().zip(&mut all).zip(&mut missed) {
                    all.count += own.count;
                    all.held += own.held;
                    all.squares += own.squares;
                    all.widths += own.widths;
                    if own.held < 0.9 * own.count {
                        missed.push(format!("{name} {:.0} %", 100.0 * own.held / own.count));
                    }
                }
            }
            let [ranks, bins, shown] = all.map(|held| {
                let error = (held.squares / held.count).sqrt();
                format!("{:.1} % / {:.3} / {error:.3}", 100.0 * held.held / held.count, held.widths / held.count)
            });
            let lists = missed.map(|list| if list.is_empty() { "–".to_owned() } else { list.join(", ") }).join("; ");
            let _ = writeln!(text, "| {kind} | {rows} | {ranks} | {bins} | {shown} | {lists} |");
        }
    }
    text
}
