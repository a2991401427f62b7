use std::path::Path;

use resvg::usvg::roxmltree::Document;

use super::*;
use crate::report::chart::{Chart, ChartWidth};
use crate::report::result_json;
use crate::study::Study;

type Draw = fn(&ResultFile, &OutputRecord) -> Chart;

const CHARTS: [Draw; 6] =
    [indices_chart, interactions_chart, pairs_chart, scatter_chart, distribution_chart, convergence_chart];

fn analysed(text: &str) -> ResultFile {
    let study = Study::parse(text, Path::new("charts.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    ResultFile::new(&study, &study.run().expect("a run"))
}

#[test]
fn charts_of_any_result_are_drawn_from_its_json_alone() {
    let holes = "model = \"ishigami-holes\"\n[design]\nbase_samples = 256\n[analysis]\nmax_failed = ";
    let studies = [
        "model = \"ishigami\"\n[design]\nbase_samples = 256".to_owned(),
        "model = \"ishigami\"\n[design]\nbase_samples = 256\n[analysis]\nsecond_order = true".to_owned(),
        "model = \"constant\"\n[design]\nbase_samples = 256".to_owned(),
        "model = \"linear\"\n[[factor]]\nname = \"x1\"\n[design]\nbase_samples = 256".to_owned(),
        "model = \"sobol-g\"\n[function]\ndimension = 100\n[design]\nbase_samples = 256".to_owned(),
        format!("{holes}0.1"),
        format!("{holes}0.0"),
        "model = \"ishigami\"\n[design]\nbase_samples = 2\nreplicates = 1".to_owned(),
    ];
    for text in &studies {
        let result = analysed(text);
        let read: ResultFile = serde_json::from_str(&result_json(&result)).expect("our own JSON");
        for draw in CHARTS {
            let chart = draw(&result, &result.outputs[0]);
            assert!(chart.caption().ends_with('.'), "{}", chart.caption());
            assert_eq!(draw(&read, &read.outputs[0]).caption(), chart.caption());
            for width in [ChartWidth::Wide, ChartWidth::Narrow] {
                let svg = chart.svg_at(width).expect("a chart");
                assert_eq!(draw(&read, &read.outputs[0]).svg_at(width).expect("a chart"), svg);
                Document::parse(&svg).expect("well-formed");
                assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{svg}");
            }
        }
    }
}

#[test]
fn results_of_before_have_no_scatter_and_say_so() {
    let mut value =
        serde_json::to_value(analysed("model = \"ishigami\"\n[design]\nbase_samples = 256")).expect("plain data");
    value["outputs"][0].as_object_mut().expect("an output").remove("scatter");
    let result: ResultFile = serde_json::from_value(value).expect("a result of an earlier version");
    let chart = scatter_chart(&result, &result.outputs[0]);
    assert!(chart.svg().expect("a chart").contains("no value"));
    assert!(chart.caption().starts_with("No scatter of ") && chart.caption().ends_with("holds none."));
}

#[test]
fn captions_say_who_acts_alone_and_who_together() {
    // S1 = 0.3139, 0.4424, 0 and ST = 0.5576, 0.4424, 0.2437.
    let result = analysed("model = \"ishigami\"");
    let output = &result.outputs[0];
    let interactions = interactions_chart(&result, output);
    assert_eq!(
        interactions.caption(),
        "For y, x2 acts almost only alone; x1 acts partly alone, partly together with others; x3 acts mostly together with \
         others."
    );
    let indices = indices_chart(&result, output);
    assert!(indices.caption().starts_with("For y, x1 decides most: alone S_1 is 0.31"), "{}", indices.caption());
    assert!(indices.caption().contains("all its interactions S_T is 0.55"), "{}", indices.caption());
    let scatter = scatter_chart(&result, output);
    assert!(scatter.caption().starts_with("Over the range of x1 the mean of "), "{}", scatter.caption());
    let result = analysed("model = \"sobol-g\"\n[function]\ndimension = 100\n[design]\nbase_samples = 1024");
    let output = &result.outputs[0];
    let all = [indices_chart, interactions_chart].map(|draw: Draw| draw(&result, output).caption().to_owned());
    let left_out = "Of 100 factors, the 20 with the largest total indices";
    assert!(all[0].ends_with(&format!("{left_out} have bars, and the 80 others one of their sums.")), "{all:?}");
    assert!(all[1].ends_with(&format!("{left_out} are drawn.")), "{all:?}");
    assert!(all[1].contains("98 others have a total index of at most 0.05"), "{}", all[1]);
    assert!(scatter_chart(&result, output).caption().contains("Of 100 factors, the 6 with the largest"));
}

#[test]
fn a_study_in_which_nothing_stands_out_says_so() {
    let result = analysed("model = \"constant\"");
    for draw in [indices_chart, interactions_chart, scatter_chart] as [Draw; 3] {
        let caption = draw(&result, &result.outputs[0]).caption().to_owned();
        assert!(caption.contains("zero variance"), "{caption}");
    }
}

#[test]
fn pairs_stand_below_the_diagonal_in_the_order_of_all_charts() {
    // S_13 = 0.2437; the order by S_T is x1, x2, x3.
    let result = analysed("model = \"ishigami\"\n[design]\nbase_samples = 4096\n[analysis]\nsecond_order = true");
    let chart = pairs_chart(&result, &result.outputs[0]);
    assert!(
        chart.caption().starts_with("The largest interaction of two is that of x1 and x3: 24."),
        "{}",
        chart.caption()
    );
    let panel = &chart.all_panels()[0];
    assert_eq!(panel.y.names, ["x1 (1)", "x2 (2)", "x3 (3)"]);
    let tiles: Vec<(usize, usize, &str, &str)> = panel
        .marks
        .iter()
        .filter_map(|mark| match &mark.shape {
            crate::report::chart::Shape::Tile(tile) => {
                Some((tile.row, tile.column, tile.letter.as_str(), mark.series.name.as_str()))
            }
            _ => None,
        })
        .collect();
    assert_eq!(tiles.len(), 6);
    assert!(tiles.contains(&(0, 0, ".31", "0.3 to 0.5")) && tiles.contains(&(1, 1, ".44", "0.3 to 0.5")), "{tiles:?}");
    assert!(tiles.contains(&(2, 0, ".24", "0.2 to 0.3")), "{tiles:?}");
    assert!(tiles.contains(&(2, 1, "0", "below 0.01, or may be 0")), "{tiles:?}");
    let without = analysed("model = \"ishigami\"\n[design]\nbase_samples = 256");
    assert!(pairs_chart(&without, &without.outputs[0]).caption().starts_with("No second-order indices of y: "));
}

#[test]
fn captions_name_no_winner_of_a_tie_as_the_lead_does() {
    let text = |formula: &str, samples: u32| {
        format!(
            "model = \"expression\"\n[expression]\noutputs = {{ y = \"{formula}\" }}\n[factors]\na = {{ min = 0, max = 1 }}\nb = {{ \
             min = 0, max = 1 }}\nc = {{ min = 0, max = 1 }}\n[design]\nbase_samples = {samples}\n[analysis]\nsecond_order = true\n\
             surrogate = \"off\"\n"
        )
    };
    for formula in ["a + b + 0*c", "a*b + 0*c", "sin(40*a)*sin(50*b) + c"] {
        for samples in [16, 64, 256] {
            let result = analysed(&text(formula, samples));
            let output = &result.outputs[0];
            let lead = &crate::report::run_document(&result).lead[0];
            let is_tied = lead.contains("cannot be told apart, by the total index");
            let shares = crate::report::study_chart(&result, output).caption().to_owned();
            let indices = indices_chart(&result, output).caption().to_owned();
            assert_eq!(shares.contains("cannot be told"), is_tied, "{formula} {samples}: {shares} {lead}");
            assert_eq!(indices.contains("cannot be told apart"), is_tied, "{formula} {samples}: {indices} {lead}");
            // What may exceed the threshold is not said to be below it.
            let interactions = interactions_chart(&result, output).caption().to_owned();
            for index in output.indices.as_ref().unwrap() {
                let Some(chance) = index.effect.probability_above_threshold else { continue };
                let below = interactions.split("; ").find(|part| part.contains("total index of at most"));
                let named = below.and_then(|part| part.split_once(" a total index").map(|(names, _)| names));
                let is_said = named.is_some_and(|names| names.split([' ', ',']).any(|word| word == index.factor));
                assert!(!is_said || chance < 0.05, "{formula} {samples}: {interactions} {chance}");
            }
        }
    }
}
