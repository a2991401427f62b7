//! The chart of `docs/accuracy/surrogate.md`.

use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Spacing, Stroke};

use super::{Cell, KINDS, METHODS};

/// The errors of these methods over those of one net.
const SHOWN: [(&str, &str, usize, Stroke); 3] = [
    ("corrected", "four nets with surrogates (the default)", 0, Stroke::SolidWithPoints),
    ("plain", "four nets without surrogates", 1, Stroke::Dashed),
    ("before", "four nets by the formulas of 2010 and 1999", 4, Stroke::Dotted),
];

fn place(method: &str) -> usize {
    METHODS.iter().position(|name| *name == method).expect("a method of the table")
}

/// By N, ratios of the errors of a method to those of one net: the least, the geometric mean and the largest over the functions;
/// for sizes at which all of them were measured.
fn ratios(cells: &[&Cell], method: &str) -> Vec<(f64, [f64; 3])> {
    let mut sizes: Vec<u64> = cells.iter().map(|cell| cell.size).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let measured = |size: u64| cells.iter().filter(|cell| cell.size == size).count();
    let most = sizes.iter().map(|size| measured(*size)).max();
    sizes.retain(|size| Some(measured(*size)) == most);
    let of_size = |size: u64| {
        let here = cells.iter().filter(|cell| cell.size == size);
        let all: Vec<f64> = here.map(|cell| cell.rmse[place(method)] / cell.rmse[place("one_net")]).collect();
        let mean = (all.iter().map(|ratio| ratio.ln()).sum::<f64>() / all.len() as f64).exp();
        let end = |pick: fn(f64, f64) -> f64| all.iter().copied().reduce(pick).expect("a function");
        (size as f64, [end(f64::min), mean, end(f64::max)])
    };
    sizes.into_iter().map(of_size).collect()
}

fn marks(cells: &[&Cell], (method, name, colour, stroke): (&str, &str, usize, Stroke)) -> Vec<Mark> {
    let ratios = ratios(cells, method);
    let line = Series::new(name, Colour::Series(colour)).stroke(stroke);
    let line = line.line(ratios.iter().map(|(size, [_, mean, _])| (*size, *mean)).collect());
    if method != "corrected" {
        return vec![line];
    }
    let band = Series::new(name, Colour::Series(colour));
    vec![band.band(ratios.iter().map(|(size, [least, _, most])| (*size, *least, *most)).collect()), line]
}

/// Errors over those of one net against the number of base samples, by kind of function.
pub fn errors(cells: &[Cell]) -> Chart {
    let panel = |(kind, _): &(&str, &[&str])| {
        let of_kind: Vec<&Cell> = cells.iter().filter(|cell| cell.kind == *kind).collect();
        let axis = |label: &str| Axis::new(label, "").spaced(Spacing::Logarithmic);
        Panel::new(axis("Base samples"), axis("RMSE / RMSE of one net"))
            .titled(format!("{kind} functions"))
            .with(SHOWN.into_iter().flat_map(|shown| marks(&of_kind, shown)))
    };
    let caption = "Root mean square errors of all first-order and total indices over those of one Saltelli net by the formulas of \
                   Saltelli 2010 and Jansen 1999, at equal runs: geometric means over the functions of each kind. The band is \
                   that of the default, from the best function to the worst.";
    Chart::new("Errors with surrogates, and without", caption).panels(KINDS.iter().map(panel))
}

/// The chart as a file.
pub fn file(cells: &[Cell]) -> (&'static str, Vec<u8>) {
    ("surrogate.svg", errors(cells).svg().into_bytes())
}
