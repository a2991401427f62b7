//! The critical force against one factor, all others at their defaults.

use apportion::space::{Factor, Space};
use apportion_afm::{Fidelity, FrictionLaw, Options, Parameter, Scene, critical_force};
use apportion_base::text::{capitalised, listed};
use apportion_report::chart::{Axis, Chart, Colour, Mark, Panel, Series, Stroke};
use apportion_report::document::Table;
use apportion_report::format::{three_digits as short, unit};
use rayon::prelude::*;

use crate::reproduce::papers::PrintedFigure;
use crate::reproduce::studies::{Effort, FRICTIONS, Friction};
use crate::scene::NANO;

/// Difference from the closed form, as a part of the force's range, from which the quasi-static rung is drawn too.
const VISIBLE: f64 = 5e-3;
/// Relative change of a force below which its size is used as its range.
const FLAT: f64 = 1e-3;

/// A line of a sweep.
struct Line {
    /// The name of its column without the unit, which is its name in `papers.toml`.
    key: &'static str,
    /// Its name in the legend.
    name: String,
    /// Its name in sentences.
    condition: String,
    /// Its style.
    look: (Colour, Stroke),
    scene: Scene,
    options: Options,
}

impl Line {
    fn with_adhesion_in_load(self, condition: &str) -> Self {
        Self {
            name: format!("{} with the adhesion in the load (q = 1)", self.name),
            condition: format!("{condition} with the adhesion in the load"),
            look: (self.look.0, Stroke::Dotted),
            options: Options { adhesion_in_load: true, ..self.options },
            ..self
        }
    }

    /// Returns whether the equations of motion are integrated, and the force is read at the first step past the slip.
    fn is_marched(&self) -> bool {
        self.options.fidelity == Fidelity::FixedStep
    }
}

/// Returns the line `key` of `papers.toml`.
fn line(key: &'static str) -> Line {
    let [coulomb, hk, lugre] = FRICTIONS.map(|Friction { law, name, colour, stroke, .. }| Line {
        key,
        name: name.to_owned(),
        condition: format!(" under {name} friction"),
        // LuGre's other lines are dotted.
        look: (colour, if law == FrictionLaw::LuGre { Stroke::Solid } else { stroke }),
        scene: Scene::default(),
        options: Options { friction: law, ..Options::default() },
    });
    match key {
        "coulomb" => coulomb,
        "hk" => hk,
        "lugre" => lugre,
        "coulomb_adhesion_in_load" => coulomb.with_adhesion_in_load(" under Coulomb friction"),
        "lugre_adhesion_in_load" => lugre.with_adhesion_in_load(""),
        "lugre_viscous" => Line {
            name: "LuGre with viscous friction σ₂ = 0.3 N s/m".to_owned(),
            condition: " with viscous friction of 0.3 N s/m".to_owned(),
            look: (lugre.look.0, Stroke::Dotted),
            scene: Scene { viscous_friction: 0.3, ..lugre.scene },
            ..lugre
        },
        "lugre_fixed_step_14ms" => Line {
            name: "LuGre marched in steps of 14 ms, no event location".to_owned(),
            condition: " when marched in steps of 14 ms without event location".to_owned(),
            look: (Colour::Series(6), Stroke::Solid),
            options: Options { fidelity: Fidelity::FixedStep, step: 14e-3, ..lugre.options },
            ..lugre
        },
        _ => unreachable!("papers.toml is a part of this program, and names no other line"),
    }
}

/// Draws the critical force against `factor` over its range in `space`, with its data as CSV.
pub(super) fn chart(figure: &PrintedFigure, factor: &str, space: &Space, effort: Effort) -> (Chart, String) {
    let points = match effort {
        Effort::Full => 201,
        Effort::Quick => 41,
    };
    let lines: Vec<Line> = figure.lines.iter().map(|key| line(key)).collect();
    // The sawtooth of the fixed-step integration needs a finer grid.
    let is_marched = lines.iter().any(Line::is_marched);
    let points = if is_marched { 4 * points - 3 } else { points };
    let parameter = Parameter::from_name(factor).expect("a parameter of the model");
    let factor = space.factors().iter().find(|other| other.name == factor).expect("a factor of the study");
    let values = factor.distribution().values_over_range(points).expect("a distribution with bounds");
    let swept = Swept { gap: figure.gap, factor, parameter, values };
    let lines: Vec<ComputedLine> = lines.iter().map(|line| swept.line(line)).collect();
    (swept.chart(&lines), swept.csv(&lines))
}

/// A factor with its values.
struct Swept<'a> {
    /// Whether the caption states the distance of the first two lines at either end.
    gap: bool,
    factor: &'a Factor,
    parameter: &'static Parameter,
    /// Values in the factor's unit.
    values: Vec<f64>,
}

/// A computed line, forces in nN; NaN for a missing one.
struct ComputedLine<'a> {
    line: &'a Line,
    force: Vec<f64>,
    /// The same by the quasi-static rung, unless the line has a rung of its own.
    quasi_static: Option<Vec<f64>>,
}

impl Swept<'_> {
    fn line<'a>(&self, line: &'a Line) -> ComputedLine<'a> {
        let quasi_static = Options { fidelity: Fidelity::QuasiStatic, ..line.options };
        let quasi_static = (!line.is_marched()).then(|| self.forces(line.scene, &quasi_static));
        ComputedLine { line, force: self.forces(line.scene, &line.options), quasi_static }
    }

    /// Returns the critical force (nN) at every value; NaN for a missing one.
    fn forces(&self, scene: Scene, options: &Options) -> Vec<f64> {
        let forces = self.values.par_iter().map(|value| {
            let mut scene = scene;
            (self.parameter.set)(&mut scene, self.factor.unit().to_si(*value));
            critical_force(&scene, options).map_or(f64::NAN, |critical| NANO * critical.critical_force)
        });
        forces.collect()
    }

    fn csv(&self, lines: &[ComputedLine]) -> String {
        let unit = self.factor.unit().symbol().replace('/', "_per_");
        let name = format!("{}_{unit}", self.factor.name);
        let mut rows = Table::from_rows("", 0..self.values.len()).file(name, |row| self.values[row]);
        for computed in lines {
            rows = rows.file(format!("{}_nN", computed.line.key), |row| computed.force[row]);
        }
        for computed in lines {
            if let Some(force) = &computed.quasi_static {
                rows = rows.file(format!("{}_quasi_static_nN", computed.line.key), |row| force[row]);
            }
        }
        rows.csv()
    }

    fn chart(&self, lines: &[ComputedLine]) -> Chart {
        let unit = unit(self.factor.unit().symbol());
        let range = range(lines);
        let mut all = Vec::new();
        // Integrated lines scatter around the others, so they are drawn below them.
        let (marched, rest): (Vec<_>, Vec<_>) = lines.iter().partition(|computed| computed.line.is_marched());
        for computed in marched.into_iter().chain(rest) {
            let (colour, stroke) = computed.line.look;
            all.push(Series::new(&computed.line.name, colour).stroke(stroke).line(self.points(&computed.force)));
            if let Some(force) = computed.quasi_static.as_ref().filter(|_| computed.differs(range)) {
                let name = format!("{}, quasi-static", computed.line.name);
                all.push(Series::new(name, colour).stroke(Stroke::Dotted).line(self.points(force)));
            }
        }
        let symbol = self.parameter.symbol.replace("omega", "ω");
        let label = format!("{}, {symbol}", capitalised(self.parameter.description));
        let nominal = Mark::rule(self.factor.nominal, format!("nominal: {} {unit}", self.factor.nominal));
        let panel =
            Panel::new(Axis::new(label, unit), Axis::new("Critical force F_cr", "nN")).with(all).with([nominal]);
        let title = format!("Critical force against {}", self.parameter.description);
        Chart::new(title, self.caption(lines, range)).panels([panel])
    }

    fn points(&self, force: &[f64]) -> Vec<(f64, f64)> {
        self.values.iter().copied().zip(force.iter().copied()).collect()
    }

    fn caption(&self, lines: &[ComputedLine], range: f64) -> String {
        let unit = format!(" {}", unit(self.factor.unit().symbol()));
        let (Some(from), Some(to)) = (self.values.first(), self.values.last()) else { return String::new() };
        let courses = lines.iter().map(|computed| match computed.line.is_marched() {
            true => overshoot(computed, &lines[0]),
            false => course(&self.values, &computed.force, &unit, &computed.line.condition),
        });
        let courses: Vec<String> = courses.collect();
        let mut text = format!(
            "From {from} to {to}{unit} of {}, the critical force {}",
            self.parameter.description,
            listed(&courses)
        );
        if let [one, other, ..] = lines
            && one.line.options.friction != other.line.options.friction
        {
            text.push_str(&self.between(one, other, &unit));
        }
        text.push_str(&agreement(lines, range));
        text.push('.');
        text
    }

    /// Says where two lines meet, and their distance at the ends.
    fn between(&self, one: &ComputedLine, other: &ComputedLine, unit: &str) -> String {
        let gap: Vec<(f64, f64)> =
            self.values.iter().zip(one.force.iter().zip(&other.force)).map(|(x, (a, b))| (*x, a - b)).collect();
        let mut text = String::new();
        if let Some(x) = crossing(&gap, 0.0) {
            text.push_str(&format!("; the two are equal at {}{unit}", short(x)));
        }
        if let (Some(first), Some(last), true) = (gap.first(), gap.last(), self.gap) {
            let verb = if last.1.abs() > first.1.abs() { "diverge" } else { "approach each other" };
            let (first, last) = (short(first.1.abs()), short(last.1.abs()));
            text.push_str(&format!("; the two {verb}, from {first} to {last} nN apart"));
        }
        text
    }
}

impl ComputedLine<'_> {
    /// Returns the forces of the line with those by the quasi-static rung, if it has them.
    fn both(&self) -> impl Iterator<Item = (&f64, &f64)> {
        self.quasi_static.iter().flat_map(|other| self.force.iter().zip(other))
    }

    /// Returns whether the two rungs differ visibly on an axis with this range of forces (nN).
    fn differs(&self, range: f64) -> bool {
        largest(self.both().map(|(formula, geometry)| (formula - geometry).abs())) > VISIBLE * range
    }
}

/// Returns the largest of the finite values, at least 0.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.filter(|value| value.is_finite()).fold(0.0, f64::max)
}

/// Returns the range of force of the lines (nN); their size if they are level.
fn range(lines: &[ComputedLine]) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for force in lines.iter().flat_map(|computed| &computed.force).filter(|force| force.is_finite()) {
        (low, high) = (low.min(*force), high.max(*force));
    }
    if high - low > FLAT * high.abs() { high - low } else { high.abs() }
}

/// Says by how much the fixed-step integration is too high.
fn overshoot(naive: &ComputedLine, right: &ComputedLine) -> String {
    let most = largest(naive.force.iter().zip(&right.force).map(|(a, b)| a - b));
    format!("is read up to {} nN too high{}", short(most), naive.line.condition)
}

/// Compares the quasi-static rung with the closed form if they differ by 0.01 % or more: the page says once that all
/// others agree.
fn agreement(lines: &[ComputedLine], range: f64) -> String {
    let both = lines.iter().flat_map(ComputedLine::both);
    let most = largest(both.map(|(formula, geometry)| (geometry / formula - 1.0).abs()));
    if most < 1e-4 {
        return String::new();
    }
    let dotted = if lines.iter().any(|line| line.differs(range)) { " (dotted)" } else { "" };
    format!("; the quasi-static rung{dotted} differs from the closed forms by at most {} %", short(100.0 * most))
}

/// Relative change below which it is rounding.
const ROUNDING: f64 = 1e-6;
/// Relative change below which it is reported as small.
const SMALL: f64 = 1e-2;
/// Distance from the chord, as a part of the change, up to which a curve is called straight.
const STRAIGHT: f64 = 0.02;

/// Describes a force (nN) over rising `x` (in `x_unit`, with a leading space), such as "falls from 9 to 1 nN (half of the
/// way by 3 um)", for use after the name of the force. A missing force is not finite. `condition`, such as " under Coulomb
/// friction", follows the values.
fn course(x: &[f64], force: &[f64], x_unit: &str, condition: &str) -> String {
    let points = x.iter().copied().zip(force.iter().copied());
    let points: Vec<(f64, f64)> = points.filter(|(_, force)| force.is_finite()).collect();
    let (Some(&(_, first)), Some(&(_, last))) = (points.first(), points.last()) else {
        return format!("does not exist{condition}");
    };
    let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p.1), h.max(p.1)));
    let size = low.abs().max(high.abs());
    if high - low <= ROUNDING * size {
        return format!("stays at {} nN{condition}", short(first));
    }
    let slack = ROUNDING * (high - low);
    let rises = points.windows(2).all(|p| p[1].1 >= p[0].1 - slack);
    let falls = points.windows(2).all(|p| p[1].1 <= p[0].1 + slack);
    let verb = if rises { "rises" } else { "falls" };
    if !rises && !falls {
        return format!("lies between {} and {} nN{condition}", short(low), short(high));
    }
    if high - low <= SMALL * size {
        return format!("{verb} by {} % from {} nN{condition}", short(100.0 * (high - low) / size), short(first));
    }
    format!("{verb} from {} to {} nN{condition}{}", short(first), short(last), shape(&points, x_unit))
}

/// Describes how the change of a monotonic curve is distributed over the points.
fn shape(points: &[(f64, f64)], x_unit: &str) -> String {
    let ((x0, y0), (x1, y1)) = (points[0], points[points.len() - 1]);
    let mut bend = 0.0_f64;
    for (x, y) in points {
        let chord = y0 + (y1 - y0) * (x - x0) / (x1 - x0);
        bend = bend.max(((y - chord) / (y1 - y0)).abs());
    }
    if bend <= ROUNDING {
        return " (in a straight line)".to_owned();
    }
    if bend <= STRAIGHT {
        return format!(" (in a straight line to within {} % of the change)", short(100.0 * bend));
    }
    match crossing(points, 0.5 * (y0 + y1)) {
        Some(x) => format!(" (half of the way by {}{})", short(x), x_unit),
        None => String::new(),
    }
}

/// Returns the first position at which a line through the points has the value `level`.
fn crossing(points: &[(f64, f64)], level: f64) -> Option<f64> {
    points.windows(2).find_map(|pair| {
        let ((xa, a), (xb, b)) = ((pair[0].0, pair[0].1 - level), (pair[1].0, pair[1].1 - level));
        if a == 0.0 {
            return Some(xa);
        }
        (a.signum() != b.signum() && a.is_finite() && b.is_finite()).then(|| xa + (xb - xa) * a / (a - b))
    })
}
