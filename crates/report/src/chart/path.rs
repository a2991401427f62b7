//! Point sequences as SVG paths: broken at gaps, thinned where points are dense.

use super::svg::Px;

/// A point in px.
pub(super) type Point = (f64, f64);

/// Columns this many px wide hold at most four points of a run.
const COLUMN: f64 = 0.5;
/// Points closer than this to the line through their neighbours are omitted, px.
const VISIBLE: f64 = 0.05;

/// Returns the unbroken runs of a sequence with gaps.
pub(super) fn runs<T: Copy>(points: impl IntoIterator<Item = Option<T>>) -> Vec<Vec<T>> {
    let points: Vec<Option<T>> = points.into_iter().collect();
    let runs = points.split(Option::is_none).filter(|run| !run.is_empty());
    runs.map(|run| run.iter().copied().flatten().collect()).collect()
}

/// Removes points that make no visible difference to the line through a run.
pub(super) fn thin(run: &[Point]) -> Vec<Point> {
    straighten(&uncrowd(run))
}

/// Keeps, of neighbours in one column, the first, the lowest, the highest and the last: the line through them covers
/// the same pixels. It bounds the work of [`straighten`].
fn uncrowd(run: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for crowd in run.chunk_by(|a, b| (a.0 / COLUMN).floor() == (b.0 / COLUMN).floor()) {
        if crowd.len() <= 4 {
            kept.extend_from_slice(crowd);
            continue;
        }
        let (mut lowest, mut highest) = (0, 0);
        for (place, point) in crowd.iter().enumerate() {
            if point.1.total_cmp(&crowd[lowest].1).is_lt() {
                lowest = place;
            }
            if point.1.total_cmp(&crowd[highest].1).is_ge() {
                highest = place;
            }
        }
        let mut at = [0, lowest, highest, crowd.len() - 1];
        at.sort_unstable();
        kept.extend(at.iter().enumerate().filter(|&(i, k)| i == 0 || at[i - 1] != *k).map(|(_, &k)| crowd[k]));
    }
    kept
}

/// Returns the points needed to stay within [`VISIBLE`] of the run (Douglas and Peucker, 1973).
fn straighten(run: &[Point]) -> Vec<Point> {
    if run.len() < 3 {
        return run.to_vec();
    }
    let mut needed = vec![false; run.len()];
    let mut open = vec![(0, run.len() - 1)];
    while let Some((from, to)) = open.pop() {
        (needed[from], needed[to]) = (true, true);
        let distances = (from + 1..to).map(|k| (k, distance(run[k], (run[from], run[to]))));
        let worst = distances.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((k, _)) = worst.filter(|(_, distance)| *distance > VISIBLE) {
            open.extend([(from, k), (k, to)]);
        }
    }
    run.iter().zip(needed).filter(|(_, needed)| *needed).map(|(&point, _)| point).collect()
}

/// Returns the distance of a point from a segment.
fn distance(p: Point, (a, b): (Point, Point)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 { ((p.0 - a.0) * dx + (p.1 - a.1) * dy) / length } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    libm::hypot(p.0 - a.0 - along * dx, p.1 - a.1 - along * dy)
}

/// Formats a run as path data.
pub(super) fn open(run: &[Point]) -> String {
    let mut data = String::new();
    for (i, &(x, y)) in run.iter().enumerate() {
        data.push_str(&format!("{}{} {}", if i == 0 { "M" } else { "L" }, Px(x), Px(y)));
    }
    data
}

/// Formats the area between two runs over the same abscissae as path data.
pub(super) fn closed(lower: &[Point], upper: &[Point]) -> String {
    let around: Vec<Point> = lower.iter().chain(upper.iter().rev()).copied().collect();
    open(&around) + "Z"
}
