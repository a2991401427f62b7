//! Minimisation within bounds by limited-memory BFGS (Nocedal 1980) on the free variables, with steps along the
//! projected path (Bertsekas 1982).

/// Number of steps that approximate the curvature.
const MEMORY: usize = 10;

/// Relative decrease of the function that ends the search.
const SMALL_DECREASE: f64 = 2e-9;

/// Largest component of the projected gradient that ends it.
const SMALL_GRADIENT: f64 = 1e-5;

/// Share of the decrease promised by the gradient that is enough (Armijo 1966).
const SUFFICIENT_DECREASE: f64 = 1e-4;

/// Share of the slope that must be gone, else the step is too short (Wolfe 1969).
const FLAT: f64 = 0.9;

/// Maximum number of trials along a direction.
const TRIALS: usize = 20;

/// A function that returns its value and its gradient.
pub type Function<'a> = dyn FnMut(&[f64]) -> (f64, Vec<f64>) + 'a;

/// Lower and upper bound of a variable.
pub type Bounds = (f64, f64);

/// A place with the value and the gradient of the function.
#[derive(Clone)]
struct Place {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
}

/// Minimises `function` from `start` on in at most `iterations` steps.
pub fn minimise(function: &mut Function<'_>, start: &[f64], bounds: &[Bounds], iterations: usize) -> Vec<f64> {
    let mut evaluate = |x: Vec<f64>| {
        let (value, gradient) = function(&x);
        Place { x, value, gradient }
    };
    let mut now = evaluate(projected(start, &vec![0.0; start.len()], 0.0, bounds));
    let mut memory: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    for _ in 0..iterations {
        let free = free(&now, bounds);
        let steepest: Vec<f64> = now.gradient.iter().zip(&free).map(|(g, free)| if *free { -g } else { 0.0 }).collect();
        let to_bounds = projected(&now.x, &steepest, 1.0, bounds);
        if to_bounds.iter().zip(&now.x).all(|(a, b)| (a - b).abs() <= SMALL_GRADIENT) {
            break;
        }
        let mut direction = newton_like(&steepest, &memory, &free);
        if dot(&direction, &now.gradient) >= 0.0 {
            memory.clear();
            direction.clone_from(&steepest);
        }
        let length = if memory.is_empty() { (1.0 / dot(&steepest, &steepest).sqrt()).min(1.0) } else { 1.0 };
        let Some(next) = searched(&mut evaluate, &now, &direction, length, bounds) else {
            if memory.is_empty() {
                break;
            }
            memory.clear();
            continue;
        };
        let step: Vec<f64> = next.x.iter().zip(&now.x).map(|(a, b)| a - b).collect();
        let change: Vec<f64> = next.gradient.iter().zip(&now.gradient).map(|(a, b)| a - b).collect();
        if dot(&step, &change) > 2.2e-16 * dot(&change, &change) {
            memory.push((step, change));
            memory.drain(..memory.len().saturating_sub(MEMORY));
        }
        let decrease = now.value - next.value;
        let size = now.value.abs().max(next.value.abs()).max(1.0);
        now = next;
        if decrease <= SMALL_DECREASE * size {
            break;
        }
    }
    now.x
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns which variables are not held at a bound by the gradient.
fn free(now: &Place, bounds: &[Bounds]) -> Vec<bool> {
    let variables = now.x.iter().zip(&now.gradient).zip(bounds);
    variables.map(|((x, g), (low, high))| !((x <= low && *g > 0.0) || (x >= high && *g < 0.0))).collect()
}

fn projected(x: &[f64], direction: &[f64], length: f64, bounds: &[Bounds]) -> Vec<f64> {
    let variables = x.iter().zip(direction).zip(bounds);
    variables.map(|((x, d), (low, high))| (x + length * d).clamp(*low, *high)).collect()
}

/// Returns the direction of the two loops of Nocedal (1980) for the free variables.
fn newton_like(steepest: &[f64], memory: &[(Vec<f64>, Vec<f64>)], free: &[bool]) -> Vec<f64> {
    let masked = |v: &[f64]| v.iter().zip(free).map(|(v, free)| if *free { *v } else { 0.0 }).collect::<Vec<f64>>();
    let pairs: Vec<(Vec<f64>, Vec<f64>)> = memory.iter().map(|(s, y)| (masked(s), masked(y))).collect();
    let pairs: Vec<_> = pairs.into_iter().filter(|(s, y)| dot(s, y) > 1e-12 * dot(y, y)).collect();
    let mut direction = steepest.to_vec();
    let mut shares = Vec::new();
    for (s, y) in pairs.iter().rev() {
        let share = dot(s, &direction) / dot(s, y);
        direction.iter_mut().zip(y).for_each(|(d, y)| *d -= share * y);
        shares.push(share);
    }
    if let Some((s, y)) = pairs.last() {
        let scale = dot(s, y) / dot(y, y);
        direction.iter_mut().for_each(|d| *d *= scale);
    }
    for ((s, y), share) in pairs.iter().zip(shares.iter().rev()) {
        let back = share - dot(y, &direction) / dot(s, y);
        direction.iter_mut().zip(s).for_each(|(d, s)| *d += back * s);
    }
    direction
}

/// Returns the first place along the projected path that is low enough, and beyond which the function is flat enough.
fn searched(
    evaluate: &mut dyn FnMut(Vec<f64>) -> Place,
    now: &Place,
    direction: &[f64],
    mut length: f64,
    bounds: &[Bounds],
) -> Option<Place> {
    let mut best: Option<Place> = None;
    let (mut shortest, mut longest) = (0.0, f64::INFINITY);
    for _ in 0..TRIALS {
        let next = evaluate(projected(&now.x, direction, length, bounds));
        let moved: Vec<f64> = next.x.iter().zip(&now.x).map(|(a, b)| a - b).collect();
        let promised = dot(&now.gradient, &moved);
        if next.value > now.value + SUFFICIENT_DECREASE * promised || !next.value.is_finite() {
            if best.is_some() {
                return best;
            }
            longest = length;
            // The minimum of the parabola through both values and the slope.
            let parabola = -0.5 * promised / (next.value - now.value - promised);
            let share = if parabola.is_finite() { parabola.clamp(0.1, 0.5) } else { 0.1 };
            length = shortest + share * (length - shortest);
            continue;
        }
        let is_better = best.as_ref().is_none_or(|best| next.value < best.value);
        let is_flat = dot(&next.gradient, &moved) >= FLAT * promised;
        if !is_better {
            return best;
        }
        best = Some(next);
        if is_flat || longest.is_finite() {
            return best;
        }
        shortest = 0.0;
        length *= 3.0;
    }
    best
}

#[cfg(test)]
#[path = "tests/optimise.rs"]
mod tests;
