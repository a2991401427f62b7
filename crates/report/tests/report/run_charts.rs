//! The charts of a run.

use apportion::Unit;
use apportion::result::{OutputDistribution, OutputResult, StudyResult};
use apportion::uncertainty::Estimate;
use apportion_report::chart::{Chart, ChartWidth, Colour, Mark, Shape, Tile, png};
use apportion_report::{convergence_chart, distribution_chart, indices_chart, pairs_chart, scatter_chart};
use resvg::usvg::roxmltree::Document;

use super::{of_factors, result};

type Draw = fn(&StudyResult, &OutputResult) -> Chart;

const CHARTS: [Draw; 5] = [indices_chart, pairs_chart, scatter_chart, distribution_chart, convergence_chart];

/// The cells of a map with their marks.
fn tiles(chart: &Chart) -> Vec<(&Mark, &Tile)> {
    let marks = chart.panels[0].marks.iter();
    marks.filter_map(|mark| if let Shape::Tile(tile) = &mark.shape { Some((mark, tile)) } else { None }).collect()
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
        let result = result(text);
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
    let result = result("model = \"ishigami\"\n[design]\nbase_samples = 4096\n[analysis]\nsecond_order = true");
    let chart = pairs_chart(&result, &result.outputs[0]);
    let panel = &chart.panels[0];
    assert_eq!(panel.y.names, ["x1 (1)", "x2 (2)", "x3 (3)"]);
    let tiles: Vec<(usize, usize, &str, &str)> = tiles(&chart)
        .into_iter()
        .map(|(mark, tile)| (tile.row, tile.column, tile.letter.as_str(), mark.series.name.as_str()))
        .collect();
    assert_eq!(tiles.len(), 6);
    assert!(tiles.contains(&(0, 0, ".31", "0.3 to 0.5")) && tiles.contains(&(1, 1, ".44", "0.3 to 0.5")), "{tiles:?}");
    assert!(tiles.contains(&(2, 0, ".24", "0.2 to 0.3")), "{tiles:?}");
    assert!(tiles.contains(&(2, 1, "0", "below 0.01, or may be 0")), "{tiles:?}");
}

#[test]
fn classes_cover_every_index() {
    let classes = [(-0.2, 0), (0.0, 0), (0.01, 1), (0.15, 3), (0.9, 8), (1.3, 8)];
    let letters = [(0.001, "0"), (0.344, ".34"), (0.999, "1.00"), (-0.02, "\u{2212}0.02"), (1.2, "1.20")];
    let values: Vec<f64> = classes.iter().map(|(value, _)| *value).chain(letters.map(|(value, _)| value)).collect();
    let mut result = of_factors(values.len());
    for (place, index) in result.outputs[0].indices.iter_mut().flatten().enumerate() {
        // In this order.
        index.effect.total = Estimate::alone(1.0 - 0.01 * place as f64);
        index.effect.first_order = Estimate::alone(values[place]);
    }
    let chart = pairs_chart(&result, &result.outputs[0]);
    let mut tiles = tiles(&chart);
    tiles.sort_by_key(|(_, tile)| tile.row);
    assert!(tiles.len() == values.len() && tiles.iter().all(|(_, tile)| tile.row == tile.column), "{tiles:?}");
    for ((mark, _), (value, class)) in tiles.iter().zip(classes) {
        assert_eq!(mark.series.colour, Colour::Shade(class), "{value}");
    }
    assert_eq!(tiles[4].0.series.name, "0.9 or more");
    assert_eq!(
        tiles[6..].iter().map(|(_, tile)| tile.letter.as_str()).collect::<Vec<_>>(),
        letters.map(|(_, text)| text)
    );
}

/// The middles of slices of equal probability of a normal distribution.
fn normal() -> Vec<f64> {
    let law = apportion::Distribution::normal(0.0, 1.0).unwrap();
    (0..500).map(|k| law.quantile((f64::from(k) + 0.5) / 500.0)).collect()
}

#[test]
fn charts_draw_every_kind_of_sample() {
    let mut result = of_factors(1);
    result.outputs[0].name = "force".to_owned();
    let mut draw = |values: &[f64]| {
        result.outputs[0].distribution = OutputDistribution::from_values(values, &Unit::dimensionless());
        distribution_chart(&result, &result.outputs[0]).svg()
    };
    let cases = [normal(), vec![1e300, -1e300, 3e299], vec![2e-300, 1e-300], vec![0.0; 9], vec![7.0]];
    for values in cases {
        let svg = draw(&values);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(png(&svg).is_ok());
    }
    let svg = draw(&normal());
    for text in ["2.5 % \u{2212}1.9", "median", "mean", "97.5 % 1.9", "95 % of the 500 values of force lie between"] {
        assert!(svg.contains(text), "{text}");
    }
}
