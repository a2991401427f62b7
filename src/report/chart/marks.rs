//! The small marks of data, the same in a plot and in its legend.

use super::style::{INK, MUTED, PAPER, Role};
use super::svg::{Canvas, Px};

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
