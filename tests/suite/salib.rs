//! Tables in the layouts of SALib, through `analyze`.

use apportion::result::{StudyResult, read_result};

use crate::common::stderr;
use crate::exchange::answered;
use crate::messages::messages;

/// A table of SALib's layout of two inputs with y = x1 + 2 x2 + x1 x2; twelve rows of each pattern.
fn salib_table(second_order: bool) -> Vec<String> {
    let mut lines = vec!["x1,x2,y".to_owned()];
    let points = if second_order { 8 } else { 12 };
    let value = |k: usize| (k as f64 * 0.618_033_988_749).fract();
    for point in 0..points {
        let (a, b) = ([value(4 * point), value(4 * point + 1)], [value(4 * point + 2), value(4 * point + 3)]);
        let ab = [[b[0], a[1]], [a[0], b[1]]];
        let ba = [[a[0], b[1]], [b[0], a[1]]];
        let rows = if second_order { [&[a][..], &ab, &ba, &[b]].concat() } else { [&[a][..], &ab, &[b]].concat() };
        lines.extend(rows.iter().map(|[x, z]| format!("{x},{z},{}", x + 2.0 * z + x * z)));
    }
    lines
}

#[test]
fn tables_of_salib_are_recognised_checked_and_analysed() {
    let (sampled, mut messages) = (answered(), messages!());
    let salib = ["--layout", "salib", "--outputs", "y", "--resamples", "100"];
    for second_order in [true, false] {
        let lines = salib_table(second_order);
        sampled.write("t.csv", &lines);
        let output = sampled.analyze("t.csv", &salib);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let result = read_result(&sampled.path("out").join("t.json")).unwrap();
        assert_eq!(result.outputs[0].second_order.as_ref().map(Vec::len), second_order.then_some(1));
        assert!(result.outputs[0].scatter.is_none());
        let index = result.outputs[0].indices.as_ref().unwrap()[1].effect.first_order;
        assert!(index.interval.unwrap().low < index.estimate && index.estimate < index.interval.unwrap().high);
        // Only the outputs: 48 rows are both 12 times 4 and 8 times 6.
        let alone: Vec<String> = lines.iter().map(|line| line.rsplit_once(',').unwrap().1.to_owned()).collect();
        sampled.write("y.csv", &alone);
        let names = ["--layout", "salib", "--names", "x1,x2", "--resamples", "100"];
        sampled.refused(&mut messages, "read in two ways", ("y.csv", &names), "y.csv");
        let option = if second_order { "--second-order" } else { "--first-order-only" };
        assert_eq!(sampled.analyze("y.csv", &[&names[..], &[option]].concat()).status.code(), Some(0));
        let again = read_result(&sampled.path("out").join("y.json")).unwrap();
        let estimates = |result: &StudyResult| -> Vec<f64> {
            let indices = result.outputs[0].indices.iter().flatten();
            indices.flat_map(|i| [i.effect.first_order.estimate, i.effect.total.estimate]).collect()
        };
        assert_eq!(estimates(&again), estimates(&result));
    }
    let mut shuffled = salib_table(true);
    shuffled.swap(8, 12);
    sampled.write("t.csv", &shuffled);
    sampled.refused(&mut messages, "two rows swapped", ("t.csv", &salib), "row 8 ");
    sampled.write("t.csv", &salib_table(true)[..48]);
    sampled.refused(&mut messages, "47 rows", ("t.csv", &salib), "t.csv");
    let mut missing = salib_table(true);
    let (inputs, _) = missing[1].rsplit_once(',').unwrap();
    missing[1] = format!("{inputs},nan");
    sampled.write("t.csv", &missing);
    let output = sampled.analyze("t.csv", &salib);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let result = read_result(&sampled.path("out").join("t.json")).unwrap();
    assert_eq!((result.outputs[0].runs_failed, result.outputs[0].base_points_used), (1, 7));
    sampled.refused(&mut messages, "no outputs", ("t.csv", &["--layout", "salib"]), "t.csv");
    std::fs::write(sampled.path("p.json"), "{\"names\": [\"x1\"], \"num_vars\": 2}").unwrap();
    let problem = sampled.name("p.json");
    let salib = ["--layout", "salib", "--problem", &problem];
    sampled.refused(&mut messages, "a problem of two numbers", ("t.csv", &salib), "p.json");
}
