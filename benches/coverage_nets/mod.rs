//! Few nets with searched generator matrices against several nets of the Sobol' sequence: errors and coverage at equal
//! numbers of base samples, on the functions of the other tables and on random ones.

use std::fmt::Write as _;

use apportion::uncertainty::IntervalMethod;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Case, KNOWN, Sample, UNSEEN, case, sample};

/// Base samples in all are 2 to these powers.
const SIZES: [u32; 3] = [8, 10, 12];

/// What is compared, with the reference first: a name, the sampler, the kind of interval, the number of nets.
const DESIGNS: [(&str, &str, IntervalMethod, u64); 6] = [
    ("1 net, Sobol'", "sobol", IntervalMethod::Nets, 1),
    ("2 nets, Sobol'", "sobol", IntervalMethod::Nets, 2),
    ("4 nets, Sobol' (default)", "sobol", IntervalMethod::Nets, 4),
    ("1 net, searched", "sobol-pick-freeze", IntervalMethod::Nets, 1),
    ("2 nets, searched", "sobol-pick-freeze", IntervalMethod::Nets, 2),
    ("4 nets, searched", "sobol-pick-freeze", IntervalMethod::Nets, 4),
];

/// Numbers of factors of the random functions.
const RANDOM_FACTORS: [usize; 10] = [2, 3, 4, 5, 6, 8, 10, 12, 15, 20];

/// Functions of one uniform factor of mean 0 and variance 1, `#` for the factor: a formula, and the variance that it has
/// before it is divided by the standard deviation.
fn parts() -> [(&'static str, f64); 7] {
    let e = std::f64::consts::E;
    [
        ("(#-0.5)", 1.0 / 12.0),
        ("(#^2-1/3)", 4.0 / 45.0),
        ("(exp(#)-1.718281828459045)", (e * e - 1.0) / 2.0 - (e - 1.0).powi(2)),
        ("sin(6.283185307179586*#)", 0.5),
        ("cos(9.42477796076938*#)", 0.5),
        ("(abs(#-0.5)-0.25)", 1.0 / 48.0),
        ("(if(# > 0.3, 1, 0)-0.7)", 0.21),
    ]
}

/// A random function of `d` factors: every factor by itself, d random pairs, half as many triples and a quadruple, each a
/// product of random [`parts`] with a random coefficient. The products are orthogonal, so that their variances add up.
fn random_case(d: usize) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(1000 + d as u64);
    let mut terms: Vec<Vec<usize>> = (0..d).map(|i| vec![i]).collect();
    for (size, count) in [(2, d), (3, d / 2), (4, 1)].into_iter().filter(|(size, _)| *size <= d) {
        for _ in 0..count {
            let mut term: Vec<usize> = Vec::new();
            while term.len() < size {
                let i = rng.random_range(0..d as u64) as usize;
                if !term.contains(&i) {
                    term.push(i);
                }
            }
            term.sort_unstable();
            if !terms.contains(&term) {
                terms.push(term);
            }
        }
    }
    let (mut first, mut total, mut sum) = (vec![0.0; d], vec![0.0; d], 0.0);
    let mut formula = Vec::new();
    for term in terms {
        // Between 0 and 1 for main effects, their squares to be uneven; half as much for every further factor.
        let size = rng.random::<f64>().powi(2) * 0.5f64.powi(term.len() as i32 - 1);
        let mut factors = vec![format!("{size}")];
        for i in &term {
            let (part, variance) = parts()[rng.random_range(0..7u64) as usize];
            factors.push(format!("{}*{}", part.replace('#', &format!("x{}", i + 1)), 1.0 / variance.sqrt()));
        }
        formula.push(factors.join("*"));
        sum += size * size;
        term.iter().for_each(|i| total[*i] += size * size);
        if let [i] = term[..] {
            first[i] += size * size;
        }
    }
    first.iter_mut().chain(&mut total).for_each(|index| *index /= sum);
    let factors: String = (1..=d).map(|i| format!("[[factor]]\nname = \"x{i}\"\nmin = 0\nmax = 1\n")).collect();
    let formula = formula.join(" + ");
    Case { text: format!("model = \"expression\"\n[expression]\noutputs.y = \"{formula}\"\n{factors}"), first, total }
}

/// Root mean square error and coverage of the first-order or of the total indices.
struct Cell {
    design: usize,
    shipped: bool,
    total: bool,
    /// Error over that of the reference.
    error: f64,
    coverage: f64,
    /// Mean width of the intervals over that of the ideal ones of the reference.
    width: f64,
}

/// Root mean square error, coverage and mean width, of first-order and of total indices.
fn errors(sample: &Sample, exact: &[f64]) -> [[f64; 3]; 2] {
    [0, 1].map(|offset| {
        let (mut square, mut held, mut width, mut count) = (0.0, 0.0, 0.0, 0.0);
        for row in &sample.rows {
            for k in (offset..exact.len()).step_by(2) {
                let [estimate, low, high] = row[k];
                square += (estimate - exact[k]).powi(2);
                held += f64::from(u8::from(low - 1e-8 <= exact[k] && exact[k] <= high + 1e-8));
                width += high - low;
                count += 1.0;
            }
        }
        [f64::sqrt(square / count), held / count, width / count]
    })
}

/// Measures all designs with `seeds` seeds each, on the functions whose names begin with `prefix`, and prints every cell
/// and the summary.
pub fn measure(seeds: u64, prefix: &str) {
    let shipped = KNOWN.into_iter().chain(UNSEEN).map(|name| (name.to_owned(), true, case(name)));
    let random = RANDOM_FACTORS.into_iter().map(|d| (format!("random, d = {d}"), false, random_case(d)));
    let mut cells = Vec::new();
    for (name, shipped, case) in shipped.chain(random).filter(|(name, ..)| name.starts_with(prefix)) {
        let active = case.first.iter().zip(&case.total).filter(|(_, total)| **total > 1e-12);
        let exact: Vec<f64> = active.flat_map(|(first, total)| [*first, *total]).collect();
        for m in SIZES {
            let all = DESIGNS.map(|design| errors(&sample(&case, design, m, seeds), &exact));
            for (kind, index) in ["S1", "ST"].into_iter().enumerate() {
                let reference = all[0][kind][0];
                let mut line = format!("{name:18} {:5} {index}", 1u64 << m);
                for (design, measured) in all.iter().enumerate() {
                    let [rmse, coverage, width] = measured[kind];
                    let (error, width) = (rmse / reference, width / (2.0 * 1.96 * reference));
                    let _ = write!(line, "  {error:.2} {coverage:.3} {width:.2}");
                    // An index that every design finds without an error has no ratio.
                    if reference > 1e-12 {
                        cells.push(Cell { design, shipped, total: kind == 1, error, coverage, width });
                    }
                }
                println!("{line}");
            }
        }
    }
    println!("{}", summary(&cells, seeds));
}

fn summary(cells: &[Cell], seeds: u64) -> String {
    let sizes = SIZES.map(|m| (1u64 << m).to_string()).join(", ");
    let mut text = format!(
        "Written by `cargo bench --bench coverage -- nets {seeds}`: {seeds} seeds, N = {sizes} base samples in all, no \
         surrogates; a cell is a function at an N and a kind of index. RMSE: root mean square error over that of one net of the \
         Sobol' sequence, geometric mean of the cells, S / ST; worst: its largest cell; coverage of the nominal 95 % interval: \
         mean and least cell, and the shares of the cells within and below 92-98 %; width: of the intervals over 2 x 1.96 x the RMSE of one net of the \
         Sobol' sequence, geometric mean.\n"
    );
    for (title, shipped) in [("Functions of the project", true), ("Random functions", false)] {
        if !cells.iter().any(|cell| cell.shipped == shipped) {
            continue;
        }
        let _ = write!(
            text,
            "\n**{title}**\n\n| design | RMSE S / ST | worst S / ST | coverage mean, least | cells in .92-.98 | cells < .92 | width |\n\
             |---|---|---|---|---|---|---|\n"
        );
        for (number, (name, ..)) in DESIGNS.iter().enumerate() {
            let own: Vec<&Cell> =
                cells.iter().filter(|cell| cell.design == number && cell.shipped == shipped).collect();
            let of = |total: bool| own.iter().filter(move |cell| cell.total == total).map(|cell| cell.error);
            let mean = |total: bool| {
                let logs: Vec<f64> = of(total).map(f64::ln).collect();
                (logs.iter().sum::<f64>() / logs.len() as f64).exp()
            };
            let worst = |total: bool| of(total).fold(0.0, f64::max);
            let share = |within: fn(f64) -> bool| {
                100.0 * own.iter().filter(|cell| within(cell.coverage)).count() as f64 / own.len() as f64
            };
            let coverage = own.iter().map(|cell| cell.coverage).sum::<f64>() / own.len() as f64;
            let least = own.iter().map(|cell| cell.coverage).fold(1.0, f64::min);
            let _ = writeln!(
                text,
                "| {name} | {:.2} / {:.2} | {:.1} / {:.1} | {coverage:.3}, {least:.3} | {:.0} % | {:.0} % | {:.2} |",
                mean(false),
                mean(true),
                worst(false),
                worst(true),
                share(|c| (0.92..=0.98).contains(&c)),
                share(|c| c < 0.92),
                (own.iter().map(|cell| cell.width.ln()).sum::<f64>() / own.len() as f64).exp()
            );
        }
    }
    text
}
