//! The small marks of data, the same in a plot and in its legend.

use super::style::{INK, MUTED, PAPER, Role};
use super::svg::{Canvas, Px};

/// The ends of an interval, px.
pub(super) type Ends = Option<(f64, f64)>;

/// Half the diagonal of a diamond, px, where there is room for it.
pub(super) const DIAMOND: f64 = 4.2;

/// Outlines of points as path data about the origin, of about equal area, in the order of roles.
const POINTS: [&str; 4] = [
    "m-2.8 0a2.8 2.8 0 1 0 5.6 0a2.8 2.8 0 1 0 -5.6 0z",
    "m-2.5 -2.5h5v5h-5z",
    "m0 -3.6l3.4 6h-6.8z",
    "m0 -3.6l3.6 3.6l-3.6 3.6l-3.6 -3.6z",
];

impl Canvas {
    /// A hollow diamond, `r` px from its middle to each corner: a value from elsewhere.
    pub fn diamond(&mut self, (x, y): (f64, f64), r: f64) {
        let (left, right, top, bottom) = (Px(x - r), Px(x + r), Px(y - r), Px(y + r));
        let (x, y) = (Px(x), Px(y));
        let d = format!("M{x} {top}L{right} {y}L{x} {bottom}L{left} {y}Z");
        let width = Px((0.3 * r).min(1.2));
        self.leaf("path", &[("d", &d), ("fill", &PAPER), ("stroke", &INK), ("stroke-width", &width)]);
    }

    /// An interval from one height to another, with caps `cap` px wide.
    pub fn whisker(&mut self, x: f64, (from, to): (f64, f64), cap: f64) {
        let (left, right) = (Px(x - cap / 2.0), Px(x + cap / 2.0));
        let (x, from, to) = (Px(x), Px(from), Px(to));
        let d = format!("M{left} {from}H{right}M{x} {from}V{to}M{left} {to}H{right}");
        self.leaf("path", &[("d", &d), ("fill", &"none"), ("stroke", &INK), ("stroke-width", &"1.2")]);
    }

    /// A grey cross: no value.
    pub fn cross(&mut self, (x, y): (f64, f64)) {
        let (left, right, top, bottom) = (Px(x - 3.0), Px(x + 3.0), Px(y - 3.0), Px(y + 3.0));
        let d = format!("M{left} {top}L{right} {bottom}M{left} {bottom}L{right} {top}");
        self.leaf("path", &[("d", &d), ("fill", &"none"), ("stroke", &MUTED), ("stroke-width", &"1.2")]);
    }

    /// A cloud of small dots as one path: each is a line of no length with round ends. Coordinates have one decimal.
    pub fn dots(&mut self, dots: &[(f64, f64)], role: Role) {
        let mut d = String::with_capacity(14 * dots.len());
        for (x, y) in dots {
            let tenth = |v: &f64| Px((10.0 * v).round() / 10.0);
            d.push_str(&format!("M{} {}h0", tenth(x), tenth(y)));
        }
        self.leaf(
            "path",
            &[
                ("class", &"dots"),
                ("d", &d),
                ("fill", &"none"),
                ("stroke", &role.colour()),
                ("stroke-width", &"2.8"),
                ("stroke-linecap", &"round"),
                ("stroke-opacity", &"0.4"),
            ],
        );
    }

    /// Thin lines without caps from a point's interval ends, level and upright.
    pub fn thin_whiskers(&mut self, (x, y): (f64, f64), (level, upright): (Ends, Ends), role: Role) {
        let mut d = String::new();
        if let Some((from, to)) = level {
            d.push_str(&format!("M{} {}H{}", Px(from), Px(y), Px(to)));
        }
        if let Some((from, to)) = upright {
            d.push_str(&format!("M{} {}V{}", Px(x), Px(from), Px(to)));
        }
        if !d.is_empty() {
            let (stroke, class) = (role.colour(), "whisker");
            self.leaf("path", &[("class", &class), ("d", &d), ("fill", &"none"), ("stroke", &stroke)]);
        }
    }

    /// A filled point whose colour and, for print in grey, outline are the role's.
    pub fn point(&mut self, (x, y): (f64, f64), role: Role) {
        let outline = match role {
            Role::Coulomb | Role::Reference => 0,
            Role::HurtadoKim => 1,
            Role::LuGre => 2,
            Role::Other(n) => n % POINTS.len(),
        };
        let d = format!("M{} {}{}", Px(x), Px(y), POINTS[outline]);
        self.leaf("path", &[("class", &"point"), ("d", &d), ("fill", &role.colour())]);
    }
}
