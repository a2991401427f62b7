//! Axes as numbers: from data to a fraction of the axis, and ticks at round values.

use super::style::{TICK, drawable};
use super::text::{minus, power_of_ten, shorten};

/// Minimum gap between the labels of a horizontal axis, px.
const LABEL_GAP: f64 = 6.0;

/// The spacing of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Equal steps for equal differences.
    #[default]
    Linear,
    /// Equal steps for equal ratios; values of zero or below cannot be shown and leave gaps.
    Logarithmic,
}

/// Options of a scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaleOptions {
    pub spacing: Spacing,
    /// Part of the range added at each end of a linear axis that is not zero; a logarithmic axis has its own.
    pub air: f64,
    /// Approximate number of steps between ticks.
    pub steps: usize,
}

/// An axis: its range, its labelled ticks and finer grid lines.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Scale {
    spacing: Spacing,
    low: f64,
    high: f64,
    pub ticks: Vec<Tick>,
    /// Values of grid lines without label.
    pub minor: Vec<f64>,
    /// The tick labels are in units of 10 to this power.
    pub exponent: i32,
}

/// A value with its label.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: String,
}

impl Tick {
    /// Returns whether it is at a power of ten.
    fn is_decade(&self) -> bool {
        let power = libm::log10(self.value);
        (power - power.round()).abs() < 1e-9
    }
}

impl Scale {
    /// Creates a scale for all of `values` that can be shown; 0 to 1 (1 to 10 if logarithmic) if none can.
    pub fn over(values: impl IntoIterator<Item = f64>, options: ScaleOptions) -> Self {
        let shown = values.into_iter().filter(|&v| options.spacing.shows(v));
        let (low, high) = shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        match options.spacing {
            Spacing::Linear if low > high => Self::linear((0.0, 1.0), options),
            Spacing::Linear => Self::linear((low, high), options),
            Spacing::Logarithmic if low > high => Self::logarithmic((1.0, 10.0)),
            Spacing::Logarithmic => Self::logarithmic((low, high)),
        }
    }

    /// Creates a scale of the positions 0, 1, 2 and so on, with their names and half a step of free room at the ends.
    pub fn from_names(names: &[String]) -> Self {
        let ticks = names.iter().enumerate().map(|(place, name)| Tick { value: place as f64, label: name.clone() });
        let (low, high) = (-0.5, names.len().max(1) as f64 - 0.5);
        Self { spacing: Spacing::Linear, low, high, ticks: ticks.collect(), minor: Vec::new(), exponent: 0 }
    }

    /// Shortens the names of an axis `length` px long to the room between two positions.
    pub fn with_names_within(mut self, length: f64) -> Self {
        let room = length / (self.high - self.low) - LABEL_GAP;
        self.ticks.iter_mut().for_each(|tick| tick.label = shorten(&tick.label, room, TICK));
        self
    }

    /// Returns the position of a value: 0 at the low end, 1 at the high end; `None` if it cannot be shown.
    pub fn place(&self, value: f64) -> Option<f64> {
        if !self.spacing.shows(value) {
            return None;
        }
        Some(match self.spacing {
            Spacing::Linear => (value - self.low) / (self.high - self.low),
            Spacing::Logarithmic => {
                let from = libm::log10(self.low);
                (libm::log10(value) - from) / (libm::log10(self.high) - from)
            }
        })
    }

    /// Removes labels that overlap on an axis `length` px long; their grid lines stay. Labels of powers of ten, and of
    /// zero, are removed last.
    pub fn with_room(mut self, length: f64) -> Self {
        if self.has_room(&self.ticks, length) {
            return self;
        }
        let mut ground = match self.spacing {
            Spacing::Linear => Vec::new(),
            Spacing::Logarithmic => self.ticks.iter().filter(|tick| tick.is_decade()).cloned().collect(),
        };
        if ground.is_empty() {
            ground.clone_from(&self.ticks);
        }
        let zero = ground.iter().position(|tick| tick.value == 0.0).unwrap_or(0);
        let mut kept = ground.clone();
        for step in 2..=ground.len() + 1 {
            if self.has_room(&kept, length) {
                break;
            }
            let places = (0..ground.len()).filter(|place| place.abs_diff(zero) % step == 0);
            kept = places.map(|place| ground[place].clone()).collect();
        }
        for Tick { value, .. } in std::mem::take(&mut self.ticks) {
            if kept.iter().all(|tick| tick.value != value) {
                self.minor.push(value);
            }
        }
        self.ticks = kept;
        self
    }

    /// Returns whether these labels do not overlap on an axis `length` px long.
    fn has_room(&self, labelled: &[Tick], length: f64) -> bool {
        labelled.windows(2).all(|pair| {
            let [from, to] = [0, 1].map(|end| self.place(pair[end].value).map_or(f64::NAN, |place| place * length));
            let widths = (TICK.width(&pair[0].label) + TICK.width(&pair[1].label)) / 2.0;
            to - from >= widths + LABEL_GAP
        })
    }

    fn linear(range: (f64, f64), options: ScaleOptions) -> Self {
        let (low, high) = widened(range);
        let air = options.air * (high - low);
        let (low, high) = (if low == 0.0 { low } else { low - air }, if high == 0.0 { high } else { high + air });
        let step = Step::near((high - low) / options.steps.max(1) as f64);
        let first = (low / step.size() - 1e-9).ceil() as i64;
        let last = (high / step.size() + 1e-9).floor() as i64;
        let exponent = common_exponent(low.abs().max(high.abs()));
        let decimals = (exponent - step.exponent).max(0) as usize;
        let ticks = (first..=last)
            .map(|k| {
                let value = step.times(k as f64);
                let shown = k as f64 * step.mantissa * 10f64.powi(step.exponent - exponent);
                Tick { value, label: minus(&format!("{shown:.decimals$}")) }
            })
            .collect();
        Self { spacing: Spacing::Linear, low, high, ticks, minor: Vec::new(), exponent }
    }

    fn logarithmic((low, high): (f64, f64)) -> Self {
        // A little free room, and a third of a decade about a single value. The ratio itself could overflow.
        let span = libm::log10(high) - libm::log10(low);
        let air = if span < 1e-3 { 0.33 } else { (0.03 * span).clamp(0.01, 0.5) };
        let (low, high) = (low / libm::pow(10f64, air), high * libm::pow(10f64, air));
        let (from, to) = (libm::log10(low), libm::log10(high));
        if to - from < 0.8 {
            // Too short for powers of ten: the round steps of a linear axis, spaced by ratio.
            let options = ScaleOptions { spacing: Spacing::Linear, air: 0.0, steps: 4 };
            let linear = Self::linear((low, high), options);
            return Self { spacing: Spacing::Logarithmic, ..linear };
        }
        let decades = from.floor() as i32..=to.floor() as i32;
        let shown = low..=high;
        let labelled: &[i32] = if to - from < 2.0 { &[1, 2, 5] } else { &[1] };
        let every = ((to - from) / 8.0).ceil().max(1.0) as i32;
        let plain = decades.clone().all(|decade| (-3..=4).contains(&decade));
        let ticks = decades
            .clone()
            .filter(|decade| decade.rem_euclid(every) == 0)
            .flat_map(|decade| labelled.iter().map(move |&digit| (decade, digit)))
            .filter(|&(decade, digit)| shown.contains(&decimal(decade, digit)))
            .map(|(decade, digit)| Tick { value: decimal(decade, digit), label: decade_label(decade, digit, plain) })
            .collect();
        // Finer lines only where they are not dense.
        let minor = match every {
            1 if to - from < 3.3 => {
                decades.flat_map(|d| (2..10).map(move |n| decimal(d, n))).filter(|v| shown.contains(v)).collect()
            }
            _ => Vec::new(),
        };
        Self { spacing: Spacing::Logarithmic, low, high, ticks, minor, exponent: 0 }
    }
}

/// A round step: mantissa 1, 2 or 5 and a power of ten.
struct Step {
    mantissa: f64,
    exponent: i32,
}

impl Step {
    /// Returns the round step closest to `raw` by ratio; `raw` is positive and normal.
    fn near(raw: f64) -> Self {
        let exponent = libm::log10(raw).floor() as i32;
        let lead = raw / 10f64.powi(exponent);
        let (mantissa, exponent) = match lead {
            _ if lead < 2f64.sqrt() => (1.0, exponent),
            _ if lead < 10f64.sqrt() => (2.0, exponent),
            _ if lead < 50f64.sqrt() => (5.0, exponent),
            _ => (1.0, exponent + 1),
        };
        Self { mantissa, exponent }
    }

    fn size(&self) -> f64 {
        self.times(1.0)
    }

    /// Returns a multiple of the step, correctly rounded for the usual exponents: a power of ten above one is exact in
    /// f64, below one it is not, hence the division.
    fn times(&self, k: f64) -> f64 {
        match self.exponent {
            0.. => k * self.mantissa * 10f64.powi(self.exponent),
            _ => k * self.mantissa / 10f64.powi(-self.exponent),
        }
    }
}

impl Spacing {
    /// Returns whether a value has a position on an axis.
    pub(super) fn shows(self, value: f64) -> bool {
        // The lower bound keeps the start of the axis, which is a little lower, among the normal numbers.
        drawable(value).is_some() && (self == Self::Linear || value >= 1e-290)
    }
}

/// Widens a range until it can be divided in f64, to at least 1e-9 of its values' magnitude.
fn widened((low, high): (f64, f64)) -> (f64, f64) {
    let magnitude = low.abs().max(high.abs());
    if magnitude < 1e-290 {
        (low, 1.0)
    } else if high - low < 1e-9 * magnitude {
        (low - 0.05 * magnitude, high + 0.05 * magnitude)
    } else {
        (low, high)
    }
}

/// Returns zero for magnitudes that are readable, else the multiple of three that makes them so.
fn common_exponent(magnitude: f64) -> i32 {
    if (1e-2..1e5).contains(&magnitude) { 0 } else { 3 * ((libm::log10(magnitude) + 1e-9) / 3.0).floor() as i32 }
}

fn decimal(decade: i32, digit: i32) -> f64 {
    f64::from(digit) * 10f64.powi(decade)
}

fn decade_label(decade: i32, digit: i32, plain: bool) -> String {
    if plain {
        let decimals = (-decade).max(0) as usize;
        format!("{:.decimals$}", f64::from(digit) * 10f64.powi(decade))
    } else if digit == 1 {
        power_of_ten(decade)
    } else {
        format!("{digit}×{}", power_of_ten(decade))
    }
}
