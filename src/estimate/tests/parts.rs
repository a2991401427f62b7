use super::*;
use crate::estimate::{BlockOutputs, Workspace};

/// Returns the moments of the points `first..last` of an artificial output.
fn moments(first: u64, last: u64) -> Moments {
    let column = |salt: f64| (first..last).map(|i| libm::sin(i as f64 * 0.7 + salt)).collect::<Vec<f64>>();
    let (a, b, ab) = (column(0.0), column(1.0), column(2.0));
    let block = BlockOutputs { a: &a, b: &b, ab: &[&ab], ..BlockOutputs::default() };
    Moments::of_block(block, &mut Workspace::default())
}

/// Returns the points `first..last` in parts of `length`.
fn parts(first: u64, last: u64, length: u64) -> MomentParts {
    let starts = (first..last).step_by(length as usize);
    let shape = PartShape { length, most: MAX_PARTS };
    MomentParts::new(shape, last - first, starts.map(|s| moments(s, (s + length).min(last))).collect())
}

#[test]
fn parts_stay_few_and_equal_and_keep_every_point() {
    let mut all = parts(0, 256, 2);
    assert_eq!((all.parts().len(), all.points()), (64, 256));
    for block in 1..40 {
        all.append(parts(block * 256, (block + 1) * 256, PartShape::of_block(block, 256, 1).length));
        let counts: Vec<u64> = all.parts().iter().map(Moments::count).collect();
        assert!((32..=64).contains(&counts.len()), "{} parts", counts.len());
        let (last, others) = counts.split_last().unwrap();
        assert!(others.iter().all(|n| *n == others[0]) && *last <= others[0]);
        assert_eq!((counts.iter().sum::<u64>(), all.points()), ((block + 1) * 256, (block + 1) * 256));
    }
    assert_eq!(all.prefix(3).points(), 3 * all.parts()[0].count());
    assert_eq!(all.prefix(1000), all);
}

#[test]
fn the_whole_does_not_depend_on_when_parts_were_paired() {
    let fine = parts(0, 1024, 16);
    let mut joined = parts(0, 256, 16);
    joined.append(parts(256, 512, 16));
    let mut right = parts(512, 768, 256);
    right.append(parts(768, 1024, 256));
    assert_eq!(joined.sum(), fine.prefix(32).sum());
    joined.append(parts(512, 1024, 16));
    assert_eq!(joined.sum(), fine.sum());
    assert_eq!(joined.sum().count(), 1024);
}

#[test]
fn nothing_appended_to_nothing() {
    let mut none = MomentParts::default();
    none.append(MomentParts::default());
    assert_eq!(none.sum().count(), 0);
    none.append(parts(0, 10, 4));
    assert_eq!(none, parts(0, 10, 4));
    none.append(MomentParts::default());
    assert_eq!(none, parts(0, 10, 4));
}
