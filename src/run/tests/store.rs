use proptest::prelude::*;

use super::*;
use crate::model::{CounterKind, Output, RunContext};
use apportion_base::quantity::Unit;

/// Two outputs, one validity flag; never run.
struct Described([Output; 2], [crate::model::Flag; 1]);

impl Model for Described {
    fn outputs(&self) -> &[Output] {
        &self.0
    }

    fn flags(&self) -> &[crate::model::Flag] {
        &self.1
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn crate::model::Worker + 'a> {
        unreachable!("only described")
    }
}

fn described() -> Described {
    let output = |name| Output::new(name, Unit::dimensionless(), "");
    let flag = crate::model::Flag { name: "odd".into(), description: "".into(), warns: false };
    Described([output("y"), output("z")], [flag])
}

/// Outputs that identify their row; every 7th row fails in its second output, with a flag for every row.
fn block(rows: Range<u64>) -> RowBlock {
    let values = |row: u64| [row as f64, if row.is_multiple_of(7) { f64::NAN } else { -(row as f64) }];
    let failed = rows.clone().filter(|row| row.is_multiple_of(7));
    let failures = failed.map(|row| ((row - rows.start) as u32, 1, RowFailure::new("a multiple of 7"))).collect();
    let flags = vec![rows.end - rows.start];
    RowBlock { first: rows.start, values: rows.flat_map(values).collect(), failures, flags, ..RowBlock::default() }
}

#[track_caller]
fn assert_same(found: &RowBlock, expected: &RowBlock) {
    let bits = |block: &RowBlock| block.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!((found.first, bits(found)), (expected.first, bits(expected)));
    assert_eq!((&found.failures, &found.flags), (&expected.failures, &expected.flags));
}

proptest! {
    /// For any blocks the stored rows are returned, and the others are missing.
    #[test]
    fn pieces_of_any_size_come_back(cuts in prop::collection::btree_set(1_u64..4000, 0..12), lost in 0_usize..13) {
        let store = Store::new(&described());
        let ends: Vec<u64> = cuts.iter().copied().chain([4000]).collect();
        let mut first = 0;
        let blocks: Vec<Range<u64>> = ends.iter().map(|end| std::mem::replace(&mut first, *end)..*end).collect();
        for (number, rows) in blocks.iter().enumerate() {
            if number != lost {
                prop_assert_eq!(store.insert(block(rows.clone())), rows.end - rows.start);
            }
        }
        let missing = store.missing(0, 0..4000);
        match blocks.get(lost) {
            Some(rows) => {
                prop_assert_eq!(missing.iter().map(|range| range.end - range.start).sum::<u64>(), rows.end - rows.start);
                prop_assert_eq!((missing[0].start, missing[missing.len() - 1].end), (rows.start, rows.end));
                prop_assert!(store.block(0, 0..4000).is_none());
                prop_assert_eq!(store.count(0, 0..4000).0, 4000 - (rows.end - rows.start));
            }
            None => {
                prop_assert!(missing.is_empty());
                assert_same(&store.block(0, 0..4000).unwrap(), &block(0..4000));
                prop_assert_eq!(store.count(0, 0..4000), (4000, 572));
            }
        }
    }
}

#[test]
fn the_runs_of_base_points_are_recalled_as_batches() {
    let (store, model) = (Store::new(&described()), described());
    store.insert(block(0..2000));
    let mut batches = vec![Batch::new(&model); 5];
    // Base points 100 to 110 are rows 500 to 550.
    batches.iter_mut().for_each(|batch| batch.reset(10));
    assert!(store.recall(0, 100, &mut batches));
    for (run, batch) in batches.iter().enumerate() {
        let rows: Vec<u64> = (100..110).map(|point| point * 5 + run as u64).collect();
        assert!(batch.column(0).iter().zip(&rows).all(|(value, row)| *value == *row as f64));
        let failed: Vec<usize> = batch.failures().iter().map(|(_, row, _)| *row).collect();
        let expected: Vec<usize> = (0..10).filter(|at| rows[*at].is_multiple_of(7)).collect();
        assert_eq!(failed, expected);
    }
    // Flags belong to the base points at which their block began.
    assert_eq!(batches[0].flags(), [0]);
    batches.iter_mut().for_each(|batch| batch.reset(256));
    assert!(store.recall(0, 0, &mut batches));
    assert_eq!(batches[0].flags(), [2000]);
    assert!(!store.recall(0, 256, &mut batches), "rows 2000 on are missing");
    assert!(!store.recall(1, 0, &mut batches));
}

#[test]
fn failures_can_be_forgotten_and_rows_replaced() {
    let store = Store::new(&described());
    store.insert(RowBlock { flags: vec![0], ..block(1270..1300) });
    let failing: Vec<u64> = (1270..1300).filter(|row| row % 7 == 0).collect();
    assert_eq!(store.forget_failures(), failing.len() as u64);
    assert_eq!(store.forget_failures(), 0);
    let missing: Vec<u64> = store.missing(0, 1270..1300).into_iter().flatten().collect();
    assert_eq!(missing, failing);
    for row in &missing {
        let values = vec![1.0, 2.0];
        assert_eq!(store.insert(RowBlock { first: *row, values, flags: vec![0], ..RowBlock::default() }), 1);
    }
    assert_eq!(store.count(0, 1270..1300), (30, 0));
    // An existing row is replaced, with its failure.
    assert_eq!(store.insert(block(1274..1276)), 0);
    assert_eq!(store.count(0, 1270..1300), (30, 1));
}

/// Counts of a block cannot be divided: they are dropped with the first of its rows that is replaced or removed.
#[test]
fn every_row_is_counted_once() {
    let raised = |store: &Store| store.blocks().iter().flat_map(|block| block.flags.clone()).sum::<u64>();
    let store = Store::new(&described());
    // The second block has no row that fails.
    for rows in [0..100, 100..104, 104..300] {
        store.insert(block(rows));
    }
    assert_eq!(store.forget_failures(), 43);
    assert_eq!((store.count(0, 0..u64::MAX).0, raised(&store)), (4, 4));
    assert_eq!(store.missing(0, 0..300), [0..100, 104..300]);
    for _ in 0..2 {
        for rows in [0..100, 104..300] {
            store.insert(block(rows));
        }
        assert_eq!((store.count(0, 0..u64::MAX).0, raised(&store)), (300, 300));
    }
    // As in journals of earlier versions: the failed rows, one by one, after the blocks that contain them.
    store.insert(block(0..300));
    (0..300).step_by(7).for_each(|row| _ = store.insert(block(row..row + 1)));
    assert_eq!((store.count(0, 0..u64::MAX).0, raised(&store), store.count(0, 0..300).1), (43, 43, 43));
    // Over the end of a block, and by a block over which nothing was counted.
    let store = Store::new(&described());
    store.insert(block(1200..1400));
    let alone = RowBlock { first: 1390, values: vec![1.0, 2.0], ..RowBlock::default() };
    store.insert(alone.clone());
    assert_eq!((store.count(0, 0..u64::MAX).0, raised(&store), store.count(0, 1200..1400)), (1, 0, (1, 0)));
}

#[test]
fn counts_of_pieces_without_flags_are_added() {
    let store = Store::new(&described());
    for first in [0, 2] {
        let counts = Counts(vec![(CounterKind::Sum, 2.0), (CounterKind::Maximum, first as f64)]);
        store.insert(RowBlock { first, values: vec![0.0; 4], counts, ..RowBlock::default() });
    }
    let counts = store.block(0, 0..4).unwrap().counts;
    assert_eq!(counts, Counts(vec![(CounterKind::Sum, 4.0), (CounterKind::Maximum, 2.0)]));
}
