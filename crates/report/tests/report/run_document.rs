//! The document of a run.

use apportion::Undefined;
use apportion::result::{StudyResult, Warning};
use apportion_report::document::{Document, Part};
use apportion_report::format::PrintedEstimate;
use apportion_report::{Subject, output_document, run_document};

use super::{result, tables};

fn page(result: &StudyResult) -> Document {
    run_document(result)
}

fn titles(page: &Document) -> Vec<&str> {
    page.sections.iter().map(|section| section.title.as_str()).collect()
}

const SMALL: &str = "\n[design]\nbase_samples = 256\n";

#[test]
fn the_leading_factor_is_at_the_top() {
    let result = result(&format!("model = \"linear\"\n[function]\nc = [1.0, 4.0, 2.0]{SMALL}"));
    let page = page(&result);
    assert!(page.lead[0].starts_with("For y, x2 matters most"), "{}", page.lead[0]);
    assert!(page.lead[1].starts_with("After 1280 model runs"), "{}", page.lead[1]);
    let expected = [
        "Indices",
        "Interactions",
        "Convergence",
        "Distribution of the output",
        "Scatter plots",
        "Surrogate",
        "Run time",
    ];
    assert_eq!(titles(&page)[..7], expected);
}

#[test]
fn a_page_can_be_drawn_again_from_the_file() {
    let result = result(&format!("model = \"ishigami\"{SMALL}"));
    let read: StudyResult = serde_json::from_str(&result.json()).unwrap();
    assert_eq!(page(&read).html(), page(&result).html());
}

#[test]
fn degenerate_results_have_pages() {
    let constant = result(&format!("model = \"linear\"\n[function]\nc = [0, 0]{SMALL}"));
    let html = page(&constant).html();
    assert!(html.contains("There are no indices of y") && html.contains("zero variance"), "{html}");
    let single = result(&format!("model = \"linear\"\n[[factor]]\nname = \"x1\"{SMALL}"));
    assert!(page(&single).lead[0].contains("For y, x1 matters most"), "{:?}", page(&single).lead);
    let mut failed = constant;
    let output = &mut failed.outputs[0];
    (output.mean, output.variance, output.distribution) = (None, None, None);
    (output.runs_failed, output.runs_ok, output.base_points_used) = (512, 0, 0);
    output.reason = Some(Undefined::NoRuns);
    let html = page(&failed).html();
    assert!(
        html.contains("fewer than two base points have all of their runs")
            && html.contains("512 of 512 runs (100\u{a0}%) had no value"),
        "{html}"
    );
    assert!(html.contains("There are no values of y"));
    failed.outputs.clear();
    page(&failed).html();
}

#[test]
fn many_factors_are_cut_to_the_largest() {
    let result = result("model = \"sobol-g\"\n[function]\ndimension = 120\n[design]\nbase_samples = 64\n");
    let page = page(&result);
    let tables = tables(&page, "indices");
    assert_eq!(tables[0].printed.as_ref().map(Vec::len), Some(50));
    let csv = page.data_files().into_iter().find(|file| file.name == "small.csv").unwrap();
    assert_eq!(csv.text.lines().count(), 121);
    assert!(tables[0].caption.contains("The 50 largest of 120 factors"));
}

#[test]
fn names_and_titles_cannot_break_out() {
    let evil = "</script><script>alert(1)</script>";
    let mut result = result(&format!("model = \"ishigami\"{SMALL}"));
    result.study.title = Some(evil.to_owned());
    result.study.source = evil.to_owned();
    result.outputs[0].warnings.push(Warning::NoNoise { factor: evil.to_owned() });
    let html = page(&result).html();
    assert!(!html.contains("<script>alert"));
    assert_eq!(html.matches("</script>").count(), 1);
}

/// A surrogate may determine the variance so much better that the variance of the values is outside its interval.
#[test]
fn a_standard_deviation_has_its_error() {
    let mut result = result(&format!("model = \"ishigami\"{SMALL}"));
    let output = &mut result.outputs[0];
    output.variance = Some(4.0);
    output.variance_interval = Some(apportion::uncertainty::Interval { low: 3.96, high: 4.04 });
    let page = page(&result);
    let moments = tables(&page, "distribution");
    let sd = moments[0].rows.iter().find(|row| row[0].text == "standard deviation").unwrap();
    assert!(sd[1].text.starts_with("2.0") && sd[1].text.contains('±'), "{sd:?}");
}

#[test]
fn an_excerpt_numbers_its_figures_through() {
    let document = page(&result(&format!("model = \"ishigami\"{SMALL}"))).excerpt(&["indices", "distribution"]);
    let labels: Vec<&str> =
        document.figures().iter().map(|figure| figure.label.as_str()).filter(|l| !l.is_empty()).collect();
    assert_eq!(labels[..2], ["Figure 1", "Figure 2"]);
    assert_eq!(titles(&document), ["Indices", "Distribution of the output"]);
}

#[test]
fn few_values_have_a_range_and_no_quantiles_of_it() {
    let of = |samples: u32| {
        let result = result(&format!("model = \"ishigami\"\n[design]\nbase_samples = {samples}\nreplicates = 1\n"));
        (page(&result).text(), page(&result).html())
    };
    let (text, html) = of(8);
    assert!(text.contains(", 16 values from ") && !text.contains("95 % of the values"), "{text}");
    assert!(
        html.contains("The 16 values of ") && !html.contains(">2.5 % quantile") && !html.contains("95 % of the 16")
    );
    let (text, html) = of(32);
    assert!(text.contains("95 % of the values from ") && html.contains("95 % of the 64 values"), "{text}");
}

#[test]
fn no_index_of_the_table_has_a_larger_error_than_the_lead() {
    for model in ["linear", "ishigami"] {
        for samples in [64, 256, 1024] {
            let result = result(&format!("model = \"{model}\"\n[design]\nbase_samples = {samples}\n"));
            let lead = page(&result).lead.join(" ");
            let Some((_, said)) = lead.split_once("every index is known to ± ") else { continue };
            let said: f64 = said.split(' ').next().unwrap().parse().unwrap();
            for index in result.outputs[0].indices.iter().flatten() {
                for record in [index.effect.first_order, index.effect.total] {
                    let printed = PrintedEstimate::new(record).half_width().unwrap_or(0.0);
                    assert!(printed <= said, "{model} {samples}: {printed} beside {said}");
                }
            }
        }
    }
}

#[test]
fn one_output_of_several_or_one_series_has_a_document_of_its_own() {
    let text = "model = \"expression\"\noutputs = { y = \"a + b\", still = \"3\", z = \"if(a > 0.9, ln(-1), a)\" }\n\
                [design]\nbase_samples = 64\n[analysis]\nmax_failed = 0.5\nsecond_order = true\n[factors]\n\
                a = { min = 0, max = 1 }\nb = { min = 0, max = 1 }\n";
    let several = result(text);
    for (name, first) in [(None, "y"), (Some("z"), "z"), (Some("nothing"), "y")] {
        let document = output_document(&several, Subject::find(&several, name));
        assert!(document.lead[0].starts_with(&format!("For {first}, ")), "{:?}", document.lead);
        assert_eq!(document.lead.len(), 2);
        assert!(titles(&document).contains(&"Indices"));
    }
    let history = include_str!("../../../../studies/push-history.toml").replace("4096", "64");
    let history = result(&history);
    for name in ["force_history", "position_history"] {
        let document = output_document(&history, Subject::find(&history, Some(name)));
        assert!(document.sections[0].title.starts_with(&name.replace('_', " ")), "{}", document.sections[0].title);
        assert_eq!(document.sections.iter().filter(|section| section.id.starts_with("series-")).count(), 1);
        assert!(document.sections[0].id == "series-1" && document.html().contains("<svg"));
    }
    for name in [None, Some("critical_force")] {
        let Some(Subject::Output(output)) = Subject::find(&history, name) else { panic!("{name:?}") };
        assert_eq!(*output, history.outputs[0]);
    }
}

#[test]
fn warnings_of_a_kind_are_one() {
    let text = "model = \"expression\"\noutputs = { y = \"exp(9*a*a*b)\", z = \"exp(8*a*a*b)\", w = \"a\" }\n[design]\n\
                base_samples = 64\n[factors]\na = { min = 0, max = 1 }\nb = { min = 0, max = 1 }\n";
    let result = result(text);
    let few_rows =
        |place: usize| result.outputs[place].warnings.iter().any(|warning| matches!(warning, Warning::FewRows { .. }));
    assert!(few_rows(0) && few_rows(1) && result.outputs[2].warnings.is_empty());
    let page = page(&result);
    assert_eq!(page.sections[0].id, "warnings");
    let [Part::Notice { texts, .. }] = &page.sections[0].parts[..] else { panic!("{:?}", page.sections[0]) };
    let of_few_rows: Vec<&String> =
        texts.iter().filter(|text| text.contains("ew rows determine the variance")).collect();
    assert!(of_few_rows.len() == 1 && of_few_rows[0].contains("(2 outputs: y and z)"), "{texts:?}");
}

#[test]
fn outputs_of_a_file_that_lack_a_measure_leave_its_columns_empty() {
    let text = "outputs = { y = \"a*b\", z = \"a + b\" }\nmodel = \"expression\"\n[design]\nbase_samples = 64\n\
                [analysis]\nmeasures = [\"pawn_median\", \"pawn_max\"]\n[factors]\n\
                a = { min = 0, max = 1 }\nb = { min = 0, max = 1 }\n";
    let mut result = result(text);
    let measures = result.outputs[1].measures.as_mut().unwrap();
    for factor in &mut measures.factors {
        factor.measures.pop_last();
    }
    let page = page(&result);
    let files = page.data_files();
    let file = files.iter().find(|file| file.name == "small-measures.csv").unwrap();
    let widths: Vec<usize> = file.text.lines().map(|line| line.split(',').count()).collect();
    assert_eq!(widths, [widths[0]; 5], "{}", file.text);
}
