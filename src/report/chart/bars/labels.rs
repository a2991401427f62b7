//! Places for value labels: above their bars, never over another mark or label.

/// How far a label may rise above its bar to clear a neighbour, px.
const RISE: f64 = 24.0;
/// Gap between a label and what is below it, px.
const GAP: f64 = 3.0;

/// A rectangle in px; `top < bottom`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Area {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
}

impl Area {
    /// Half a width to both sides of `x`, between two heights in any order.
    pub fn about(x: f64, half: f64, (from, to): (f64, f64)) -> Self {
        Self { left: x - half, right: x + half, top: from.min(to), bottom: from.max(to) }
    }

    /// Whether the two have a point in common inside both.
    pub fn overlaps(&self, other: &Area) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }
}

/// A label that wants to stand centred above a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wanted {
    pub middle: f64,
    /// Upper end of the bar and its interval.
    pub above: f64,
    pub width: f64,
    pub height: f64,
}

/// A place for each label in turn, `None` where none is free below `ceiling`.
pub(super) fn place(wanted: &[Wanted], marks: &[Area], ceiling: f64) -> Vec<Option<Area>> {
    let mut taken = marks.to_vec();
    let mut places = Vec::with_capacity(wanted.len());
    for label in wanted {
        let start = label.above - GAP;
        let mut area = Area {
            left: label.middle - label.width / 2.0,
            right: label.middle + label.width / 2.0,
            top: start - label.height,
            bottom: start,
        };
        // Each round rises over the obstacle that reaches highest, so it ends.
        while let Some(top) = taken.iter().filter(|a| a.overlaps(&area)).map(|a| a.top).reduce(f64::min) {
            (area.top, area.bottom) = (top - GAP - label.height, top - GAP);
            if start - area.bottom > RISE {
                break;
            }
        }
        let found = (area.top >= ceiling && start - area.bottom <= RISE).then_some(area);
        taken.extend(found);
        places.push(found);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn wanted(middle: f64, above: f64) -> Wanted {
        Wanted { middle, above, width: 20.0, height: 8.0 }
    }

    #[test]
    fn a_label_rises_over_a_mark_but_not_far() {
        let mark = |top: f64| Area { left: 5.0, right: 15.0, top, bottom: 98.0 };
        let free = place(&[wanted(10.0, 100.0)], &[], 0.0)[0].unwrap();
        assert_eq!((free.top, free.bottom, free.left, free.right), (89.0, 97.0, 0.0, 20.0));
        assert_eq!(place(&[wanted(10.0, 100.0)], &[mark(90.0)], 0.0)[0].unwrap().bottom, 87.0);
        assert_eq!(place(&[wanted(10.0, 100.0)], &[mark(60.0)], 0.0), [None]);
        assert_eq!(place(&[wanted(10.0, 100.0)], &[], 90.0), [None]);
    }

    proptest! {
        #[test]
        fn labels_touch_nothing(
            labels in prop::collection::vec((0.0..200.0, 20.0..200.0), 1..20),
            marks in prop::collection::vec((0.0..200.0, 0.0..200.0, 1.0..30.0, 1.0..90.0), 0..20),
        ) {
            let labels: Vec<_> = labels.into_iter().map(|(x, y)| wanted(x, y)).collect();
            let marks: Vec<_> = marks
                .into_iter()
                .map(|(left, top, w, h): (f64, f64, f64, f64)| Area { left, top, right: left + w, bottom: top + h })
                .collect();
            let placed: Vec<_> = place(&labels, &marks, 10.0).into_iter().flatten().collect();
            for (i, label) in placed.iter().enumerate() {
                prop_assert!(label.top >= 10.0);
                prop_assert!(!marks.iter().chain(&placed[..i]).any(|other| other.overlaps(label)));
            }
        }
    }
}
