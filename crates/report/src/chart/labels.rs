//! Positions for the labels of points: next to them, else a little off, never over another label or point.

/// Distances from a point to its label, px, in the order they are tried.
const DISTANCES: [f64; 7] = [6.0, 11.0, 17.0, 25.0, 35.0, 48.0, 64.0];
/// Distance from which on a thin line joins point and label.
const LEADER: f64 = 11.0;
/// Half the size of a point, px.
const POINT: f64 = 4.5;
/// Free margin around a label, px.
const AIR: f64 = 1.5;
/// Directions in the order of trial: the four sides and the four corners, right first, then those between.
const DIRECTIONS: [(f64, f64); 16] = [
    (1.0, 0.0),
    (0.7, -0.7),
    (0.7, 0.7),
    (0.0, -1.0),
    (0.0, 1.0),
    (-1.0, 0.0),
    (-0.7, -0.7),
    (-0.7, 0.7),
    (0.9, -0.4),
    (0.4, -0.9),
    (0.9, 0.4),
    (0.4, 0.9),
    (-0.9, -0.4),
    (-0.4, -0.9),
    (-0.9, 0.4),
    (-0.4, 0.9),
];

/// A rectangle in px; `top < bottom`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

impl Area {
    /// Creates the area from one x to another and from one y to another, in any order.
    pub fn between(x: (f64, f64), y: (f64, f64)) -> Self {
        Self { left: x.0.min(x.1), right: x.0.max(x.1), top: y.0.min(y.1), bottom: y.0.max(y.1) }
    }

    /// Creates the area of a point.
    fn around((x, y): (f64, f64)) -> Self {
        Self::between((x - POINT, x + POINT), (y - POINT, y + POINT))
    }

    fn is_inside(&self, bounds: &Area) -> bool {
        self.left >= bounds.left && self.right <= bounds.right && self.top >= bounds.top && self.bottom <= bounds.bottom
    }

    /// Returns whether the two have a common interior point.
    pub fn overlaps(&self, other: &Area) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }
}

/// A point with the size of its label.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Label {
    pub at: (f64, f64),
    pub width: f64,
    pub height: f64,
}

/// The position of a label and the ends of its thin line, if it has one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub area: Area,
    pub leader: Option<[(f64, f64); 2]>,
}

/// Finds a position inside `bounds` for each label in turn; `None` if there is no room.
pub(super) fn place(wanted: &[Label], bounds: Area) -> Vec<Option<Place>> {
    let points: Vec<Area> = wanted.iter().map(|label| Area::around(label.at)).collect();
    let mut places: Vec<Option<Place>> = Vec::with_capacity(wanted.len());
    for (label, point) in wanted.iter().zip(&points) {
        let taken: Vec<Place> = places.iter().copied().flatten().collect();
        // A point that covers the label's point cannot be avoided.
        let others: Vec<&Area> = points.iter().filter(|area| !area.overlaps(point)).collect();
        let mut candidates = DISTANCES
            .iter()
            .flat_map(|distance| DIRECTIONS.iter().map(|direction| label_place(label, *distance, *direction)));
        places.push(candidates.find(|Place { area, leader }| {
            area.is_inside(&bounds)
                && !points.iter().any(|other| other.overlaps(area))
                && !taken.iter().any(|other| other.area.overlaps(area))
                && !taken.iter().filter_map(|other| other.leader).any(|leader| crosses(leader, area))
                && leader.is_none_or(|leader| {
                    !others.iter().any(|other| crosses(leader, other))
                        && !taken.iter().any(|other| crosses(leader, &other.area))
                })
        }));
    }
    places
}

/// Returns where a label of this size begins, relative to the end of its line in a direction.
fn shift(direction: f64, size: f64) -> f64 {
    match direction {
        part if part > 0.0 => 0.0,
        part if part < 0.0 => -size,
        _ => -size / 2.0,
    }
}

/// Places the label at a distance in a direction; its near edge or corner touches the end of the line.
fn label_place(label: &Label, distance: f64, (dx, dy): (f64, f64)) -> Place {
    let (x, y) = (label.at.0 + dx * distance, label.at.1 + dy * distance);
    let (left, top) = (x + shift(dx, label.width), y + shift(dy, label.height));
    let area =
        Area { left: left - AIR, right: left + label.width + AIR, top: top - AIR, bottom: top + label.height + AIR };
    let start = (label.at.0 + dx * POINT, label.at.1 + dy * POINT);
    Place { area, leader: (distance >= LEADER).then_some([start, (x - dx * AIR, y - dy * AIR)]) }
}

/// Returns whether a short line crosses an area, tested in steps of a few px; it may touch the margin.
fn crosses([from, to]: [(f64, f64); 2], area: &Area) -> bool {
    const STEPS: u32 = 16;
    (0..=STEPS).any(|step| {
        let part = f64::from(step) / f64::from(STEPS);
        let (x, y) = (from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1));
        area.left + AIR < x && x < area.right - AIR && area.top + AIR < y && y < area.bottom - AIR
    })
}
