use std::path::Path;

use apportion::result::{OutputResult, StudyResult};
use resvg::usvg::roxmltree::Document;

use super::*;
use crate::chart::{Chart, ChartWidth};

type Draw = fn(&StudyResult, &OutputResult) -> Chart;

const CHARTS: [Draw; 5] = [indices_chart, pairs_chart, scatter_chart, distribution_chart, convergence_chart];

fn analysed(text: &str) -> StudyResult {
    let study =
        apportion_files::parse_study(text, Path::new("charts.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    study.run().expect("a run")
}

#[test]
fn charts_of_any_result_are_drawn_from_its_json_alone() {
    let holes = "model = \"expression\"\noutputs.y = \"x1 + x2*sqrt(3 - abs(x3))\"\n[factors]\n\
         x1 = { min = 0, max = 1 }\nx2 = { min = 0, max = 1 }\nx3 = { min = -3.14159, max = 3.14159 }\n\
         [design]\nbase_samples = 256\n[analysis]\nmax_failed = ";
    let studies = [
        "model = \"ishigami\"\n[design]\nbase_samples = 256".to_owned(),
        "model = \"ishigami\"\n[design]\nbase_samples = 256\n[analysis]\nsecond_order = true".to_owned(),
        "model = \"linear\"\n[function]\nc = [0, 0]\n[design]\nbase_samples = 256".to_owned(),
        "model = \"linear\"\n[[factor]]\nname = \"x1\"\n[design]\nbase_samples = 256".to_owned(),
        "model = \"sobol-g\"\n[function]\ndimension = 100\n[design]\nbase_samples = 256".to_owned(),
        format!("{holes}0.1"),
        format!("{holes}0.0"),
        "model = \"ishigami\"\n[design]\nbase_samples = 2\nreplicates = 1".to_owned(),
    ];
    for text in &studies {
        let result = analysed(text);
        let read: StudyResult = serde_json::from_str(&result.json()).expect("our own JSON");
        for draw in CHARTS {
            let chart = draw(&result, &result.outputs[0]);
            assert!(chart.caption.ends_with('.'), "{}", chart.caption);
            assert_eq!(draw(&read, &read.outputs[0]).caption, chart.caption);
            for width in [ChartWidth::Wide, ChartWidth::Narrow] {
                let svg = chart.svg_at(width);
                assert_eq!(draw(&read, &read.outputs[0]).svg_at(width), svg);
                Document::parse(&svg).expect("well-formed");
                assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{svg}");
            }
        }
    }
}

#[test]
fn pairs_stand_below_the_diagonal_in_the_order_of_all_charts() {
    // S_13 = 0.2437; the order by S_T is x1, x2, x3.
    let result = analysed("model = \"ishigami\"\n[design]\nbase_samples = 4096\n[analysis]\nsecond_order = true");
    let chart = pairs_chart(&result, &result.outputs[0]);
    let panel = &chart.panels[0];
    assert_eq!(panel.y.names, ["x1 (1)", "x2 (2)", "x3 (3)"]);
    let tiles: Vec<(usize, usize, &str, &str)> = panel
        .marks
        .iter()
        .filter_map(|mark| match &mark.shape {
            crate::chart::Shape::Tile(tile) => {
                Some((tile.row, tile.column, tile.letter.as_str(), mark.series.name.as_str()))
            }
            _ => None,
        })
        .collect();
    assert_eq!(tiles.len(), 6);
    assert!(tiles.contains(&(0, 0, ".31", "0.3 to 0.5")) && tiles.contains(&(1, 1, ".44", "0.3 to 0.5")), "{tiles:?}");
    assert!(tiles.contains(&(2, 0, ".24", "0.2 to 0.3")), "{tiles:?}");
    assert!(tiles.contains(&(2, 1, "0", "below 0.01, or may be 0")), "{tiles:?}");
}
