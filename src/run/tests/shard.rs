use super::*;
use crate::design::{DesignSettings, Rows};

#[test]
fn the_parts_are_the_whole_and_none_is_in_two() {
    let settings = DesignSettings { base_samples: 100, replicates: 4, ..DesignSettings::default() };
    let design = Design::new(settings, 2, Rows::plain(vec![vec![0], vec![1]])).unwrap();
    for count in [1, 2, 3, 7, 100, 150] {
        let mut rows: Vec<(u64, u64)> = Vec::new();
        let mut sizes = Vec::new();
        for number in 1..=count {
            let part = Shard { number, count }.rows(&design);
            sizes.push(part.iter().map(|(_, rows)| rows.end - rows.start).sum::<u64>());
            rows.extend(part.into_iter().flat_map(|(replicate, rows)| rows.map(move |row| (replicate, row))));
        }
        let all: Vec<(u64, u64)> = (0..4).flat_map(|replicate| (0..100).map(move |row| (replicate, row))).collect();
        assert_eq!(rows, all, "{count} parts");
        assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= design.rows_per_point());
    }
}

#[test]
fn only_parts_of_a_whole_are_parts() {
    for text in ["", "1", "0/3", "4/3", "1/0", "-1/3", "1/3/4", "a/b", "1/1000001", "1 / 3"] {
        assert!(text.parse::<Shard>().is_err(), "{text}");
    }
    assert_eq!("2/3".parse::<Shard>().unwrap().to_string(), "2/3");
}
