//! Families between given bounds with two more parameters: where the bulk lies, and how wide it is.
//!
//! For a given width, one statement determines the place, on which every statistic depends monotonically; the other
//! statement then determines the width.

use super::super::Distribution;
use super::root::{bisected, evenly, first_zero};
use super::{Law, Statement, Statistic, is_as_stated};

/// Numbers of widths that are tried, from narrow to wide.
const WIDTHS: u32 = 100;
/// Numbers of places that are tried where the width is given.
const PLACES: u32 = 400;

pub(super) fn solve(law: Law, stated: &[Statement]) -> Option<Distribution> {
    let value = |statistic| stated.iter().find(|(other, _)| *other == statistic).map(|(_, value)| *value);
    let frame = Frame { law, min: value(Statistic::Min)?, max: value(Statistic::Max)? };
    let free: Vec<Statement> =
        stated.iter().copied().filter(|(s, _)| !matches!(s, Statistic::Min | Statistic::Max)).collect();
    let [first, second] = free[..] else { return None };
    let accept = |found: Option<Distribution>| {
        found.filter(|found| is_as_stated(found, |statistic| frame.statistic(found, statistic), stated))
    };
    let fits = |found: &Distribution, (statistic, value): Statement| {
        frame.statistic(found, statistic).map_or(f64::NAN, |found| found - value)
    };
    match (frame.pinned(first), frame.pinned(second)) {
        (Some(a), Some(b)) => accept(frame.of_pins(a, b)),
        (Some(pin), None) | (None, Some(pin)) => {
            let other = if frame.pinned(first).is_some() { second } else { first };
            let made = |x: f64| frame.of_pin(pin, x);
            let miss = |x: f64| made(x).map_or(f64::NAN, |found| fits(&found, other));
            let (from, to) = frame.range_beside(pin);
            first_zero(evenly(from, to, PLACES), miss, |x| accept(made(x)))
        }
        (None, None) => {
            // The standard deviation does not determine the place, a mode not for every width.
            let rank = |statement: Statement| match statement.0 {
                Statistic::Sd => 2,
                Statistic::Mode => 1,
                _ => 0,
            };
            let (first, second) = if rank(first) <= rank(second) { (first, second) } else { (second, first) };
            let made = |width: f64| match (law, first) {
                (Law::Beta, (Statistic::Mode, mode)) => frame.beta_of_mode(width, mode),
                _ => frame.placed(width, |found| fits(found, first)),
            };
            let miss = |width: f64| made(width).map_or(f64::NAN, |found| fits(&found, second));
            let (from, to) = frame.widths();
            first_zero(evenly(from, to, WIDTHS), miss, |width| accept(made(width)))
        }
    }
}

/// A family and its bounds.
struct Frame {
    law: Law,
    min: f64,
    max: f64,
}

/// A parameter that is stated outright.
#[derive(Clone, Copy)]
enum Pin {
    /// The first one: mean or location before truncation, or alpha.
    Place(f64),
    /// The second one: sd or scale before truncation, or beta.
    Width(f64),
}

impl Frame {
    fn made(&self, first: f64, second: f64) -> Option<Distribution> {
        match self.law {
            Law::Beta => Distribution::beta(first, second, self.min, self.max),
            Law::TruncatedNormal => Distribution::truncated_normal(first, second, self.min, self.max),
            _ => Distribution::truncated_gumbel(first, second, self.min, self.max),
        }
        .ok()
    }

    fn pinned(&self, (statistic, value): Statement) -> Option<Pin> {
        match (self.law, statistic) {
            (Law::Beta, Statistic::Alpha) => Some(Pin::Place(value)),
            (Law::Beta, Statistic::Beta) => Some(Pin::Width(value)),
            (Law::TruncatedNormal, Statistic::Mean | Statistic::Mode) => Some(Pin::Place(value)),
            (Law::TruncatedNormal, Statistic::Sd) => Some(Pin::Width(value)),
            (Law::TruncatedGumbel, Statistic::Location | Statistic::Mode) => Some(Pin::Place(value)),
            (Law::TruncatedGumbel, Statistic::Scale) => Some(Pin::Width(value)),
            _ => None,
        }
    }

    fn of_pins(&self, a: Pin, b: Pin) -> Option<Distribution> {
        match (a, b) {
            (Pin::Place(first), Pin::Width(second)) | (Pin::Width(second), Pin::Place(first)) => {
                self.made(first, second)
            }
            _ => None,
        }
    }

    /// The distribution of the pinned parameter and the other one, which is a logarithm unless it is a place before
    /// truncation.
    fn of_pin(&self, pin: Pin, x: f64) -> Option<Distribution> {
        match (self.law, pin) {
            (_, Pin::Place(first)) => self.made(first, libm::exp(x)),
            (Law::Beta, Pin::Width(second)) => self.made(libm::exp(x), second),
            (_, Pin::Width(second)) => self.made(x, second),
        }
    }

    fn range_beside(&self, pin: Pin) -> (f64, f64) {
        match (self.law, pin) {
            // Narrow for the shape of the other side, as far as that has a meaning.
            (Law::Beta, _) => (libm::log(1e5), libm::log(1e-3)),
            (_, Pin::Place(_)) => self.widths(),
            (_, Pin::Width(width)) => self.places(width),
        }
    }

    /// Logarithms of the widths, from narrow to wide; of the beta distribution, of 1/(alpha + beta).
    fn widths(&self) -> (f64, f64) {
        match self.law {
            Law::Beta => (-libm::log(2e5), -libm::log(2e-3)),
            _ => (libm::log(1e-6 * (self.max - self.min)), libm::log(1e4 * (self.max - self.min))),
        }
    }

    /// The places at which there is something left between the bounds, lowest to highest.
    fn places(&self, width: f64) -> (f64, f64) {
        match self.law {
            Law::Beta => (-12.0, 12.0),
            Law::TruncatedNormal => (self.min - 30.0 * width, self.max + 30.0 * width),
            _ => (self.min - 500.0 * width, self.max + 5.0 * width),
        }
    }

    /// The distribution of this width (its logarithm) whose place makes `miss`, which rises with it, vanish.
    fn placed(&self, width: f64, miss: impl Fn(&Distribution) -> f64) -> Option<Distribution> {
        let at = |place: f64| match self.law {
            Law::Beta => {
                let (sum, odds) = (libm::exp(-width), libm::exp(place));
                self.made(sum * odds / (1.0 + odds), sum / (1.0 + odds))
            }
            _ => self.made(place, libm::exp(width)),
        };
        let missed = |place: f64| at(place).map_or(f64::NAN, |found| miss(&found));
        let (from, to) = self.places(libm::exp(width));
        let (mut low, mut high) = (None, None);
        for place in evenly(from, to, 25) {
            let y = missed(place);
            if y <= 0.0 {
                low = Some((place, y));
            } else if y > 0.0 {
                high = Some(place);
                break;
            }
        }
        at(bisected(low?, high?, &missed))
    }

    /// The beta distribution of this width whose highest density is at `mode`.
    fn beta_of_mode(&self, width: f64, mode: f64) -> Option<Distribution> {
        let part = (mode - self.min) / (self.max - self.min);
        let beyond = libm::exp(-width) - 2.0;
        if beyond > 0.0 { self.made(1.0 + part * beyond, 1.0 + (1.0 - part) * beyond) } else { None }
    }

    fn statistic(&self, found: &Distribution, statistic: Statistic) -> Option<f64> {
        let parameters = found.parameters();
        let parameter = |place: usize| match parameters.get(place) {
            Some((_, super::super::Parameter::Number(number))) => Some(*number),
            _ => None,
        };
        let (first, second) = (parameter(0)?, parameter(1)?);
        Some(match (self.law, statistic) {
            (Law::Beta, Statistic::Alpha)
            | (Law::TruncatedNormal, Statistic::Mean)
            | (Law::TruncatedGumbel, Statistic::Location) => first,
            (Law::Beta, Statistic::Beta)
            | (Law::TruncatedNormal, Statistic::Sd)
            | (Law::TruncatedGumbel, Statistic::Scale) => second,
            // Shapes up to 1 have their highest density at a bound.
            (Law::Beta, Statistic::Mode) if first > 1.0 && second > 1.0 => {
                self.min + (self.max - self.min) * ((first - 1.0) / (first + second - 2.0))
            }
            (Law::Beta, Statistic::Mode) => return None,
            (_, Statistic::Mode) => Some(first).filter(|mode| (self.min..=self.max).contains(mode))?,
            (_, Statistic::Mean) => found.mean(),
            (_, Statistic::Sd) => found.sd(),
            (_, other) => found.quantile(other.probability()?),
        })
    }
}
