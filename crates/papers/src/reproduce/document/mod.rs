//! The document of the reproduction: verdicts, figures, percentages, tables and provenance.

mod answers;
mod figures;
mod verdicts;

use apportion_afm::Scene;
use apportion_afm::modes::ModeConstants;
use apportion_report::document::{DataFile, Document, Part, Report, Section, Table};
use apportion_report::{grouped, with_unit};

use super::claims::claims_json;
use super::figures::{ANIMATION_STEM, chart_file};
use super::papers::papers;
use super::percentages::{self, percentages_csv};
use super::reproduction::Reproduction;
use super::shares::shares_table;
use super::studies::{Effort, Reproduced, general_study};
use super::words::{Words, filled};
use crate::scene::{player_page, scene_json, scene_table};

/// Builds the document about `reproduction`; missing parts are omitted. Except for the times in the results, its files
/// are the same for every run of the same version.
pub fn document(reproduction: &Reproduction) -> Document {
    let (studies, claims) = (&reproduction.studies, &reproduction.claims);
    let mut then = vec![
        figures::overview(&reproduction.figures),
        Section::new("answers", "Which factor matters most", answers::parts(studies)),
        constants(),
    ];
    if !claims.is_empty() {
        let parts = vec![verdicts::table(claims), verdicts::details(claims, &reproduction.figures)];
        then.push(Section::new("claims", "Are the papers right?", parts));
    }
    then.extend(figures::sections(reproduction));
    let rows = &reproduction.percentages;
    if !rows.is_empty() {
        let parts = vec![Part::List(percentages::summary(rows)), percentages::table(rows)];
        then.push(Section::new("percentages", "The percentages that LG prints", parts));
    }
    then.push(Section::new("shares", "All indices and shares", shares(studies)));
    then.push(Section::new("papers", "The papers", vec![Part::Text(papers().cited.to_owned())]));
    let report = Report {
        name: "index".to_owned(),
        kicker: "Reproduction of three papers",
        title: "Which factor decides the force that pushes a nanoparticle?".to_owned(),
        lead: answers::lead(studies).into_iter().chain(verdicts::sentence(claims)).collect(),
        then,
        provenance: provenance(reproduction),
        ..Report::default()
    };
    Document { charts: figures::files(&reproduction.figures), files: files(reproduction), ..report.document() }
}

/// Builds the data files: results, claims and percentages, and the numbers of every figure. Two tables of the page are
/// files too: the claims and the shares.
fn files(reproduction: &Reproduction) -> Vec<DataFile> {
    let mut files = Vec::new();
    for study in &reproduction.studies {
        files.push((format!("{}-{}.json", study.friction.key, study.group.key), study.result.json()));
    }
    if !reproduction.claims.is_empty() {
        files.push(("claims.json".to_owned(), claims_json(&reproduction.claims)));
        files.push(("percentages.csv".to_owned(), percentages_csv(&reproduction.percentages)));
    }
    if let Some(story) = &reproduction.animation {
        files.push((chart_file(ANIMATION_STEM, "html"), player_page(story)));
        files.push((chart_file(ANIMATION_STEM, "csv"), scene_table(story).csv()));
        files.push((chart_file(ANIMATION_STEM, "json"), scene_json(story)));
    }
    files.extend(reproduction.figures.iter().map(|figure| (chart_file(figure.stem, "csv"), figure.csv.clone())));
    files.into_iter().map(|(name, text)| DataFile { name, text }).collect()
}

/// Builds the tables of all indices, then the warnings.
fn shares(studies: &[Reproduced]) -> Vec<Part> {
    let table = shares_table(&studies.iter().collect::<Vec<&Reproduced>>());
    let table = Table { file: "shares.csv".to_owned(), ..table };
    let mut parts = vec![details("The indices and shares of every study", table.into())];
    let validity = answers::validity(studies);
    parts.extend(validity.map(|table| details("How many runs lie outside the range of a theory", table)));
    let cautions = answers::cautions(studies);
    parts.extend((!cautions.is_empty()).then_some(Part::List(cautions)));
    parts
}

fn details(summary: &str, part: Part) -> Part {
    Part::Details { summary: summary.to_owned(), parts: vec![part] }
}

/// Describes designs, estimators, intervals and cost.
fn provenance(reproduction: &Reproduction) -> Vec<(&'static str, String)> {
    let effort = match reproduction.effort {
        Effort::Full => "full",
        Effort::Quick => "quick: fewer points and repetitions, wider intervals",
    };
    let numbers = "the same on every machine and for any number of threads; only the times differ";
    let first = &reproduction.studies[0].result.provenance;
    let design = format!(
        "{} points, {} base samples in {} replicates, seed {}",
        first.sampler.name(),
        first.base_samples,
        first.replicates,
        first.seed
    );
    let mut rows = vec![
        ("effort", effort.to_owned()),
        ("numbers", numbers.to_owned()),
        ("design", design),
        ("first-order estimator", first.first_order_estimator.clone()),
        ("total estimator", first.total_estimator.clone()),
    ];
    rows.extend(first.interval().map(|words| ("95 % intervals", words)));
    let overrides = &reproduction.studies[0].result.study.overrides;
    if !overrides.is_empty() {
        rows.push(("changes on the command line", overrides.join(", ")));
    }
    let (mut runs, mut seconds) = (0, 0.0);
    for study in &reproduction.studies {
        runs += study.result.provenance.model_runs;
        seconds += study.result.provenance.wall_seconds;
    }
    let cost = format!("{} model runs in {seconds:.2} s on {} threads", grouped(runs), first.threads);
    rows.push(("cost of the studies", cost));
    rows
}

/// Returns the values of the scene that the studies use.
fn used() -> Words {
    let (scene, modes) = (Scene::default(), ModeConstants::default());
    vec![
        ("shear_strength", with_unit(scene.shear_strength / 1e6, "MPa")),
        ("shear_modulus", in_gpa(scene.effective_shear_modulus())),
        ("elastic_modulus", in_gpa(scene.elastic_modulus)),
        ("viscous_friction", format!("{:e}", scene.viscous_friction)),
        ("tip_friction", modes.tip_friction.to_string()),
        ("rolling_shift", with_unit(modes.rolling_shift * 1e9, "nm")),
        ("offset", with_unit((modes.offset * 1e10).round() / 10.0, "nm")),
        ("particle_ratio", scene.particle_poisson_ratio.to_string()),
        ("substrate_ratio", scene.substrate_poisson_ratio.to_string()),
    ]
}

/// Formats a modulus (Pa) to a hundredth of a GPa.
fn in_gpa(pascals: f64) -> String {
    with_unit((pascals / 1e7).round() / 100.0, "GPa")
}

/// Builds the section of the constants that the papers print, those that are used, and the reasons; and the ranges.
fn constants() -> Section {
    let caption = "Constants whose printed and used values differ, or that no paper prints. All others are \
                   used as printed.";
    let words = used();
    let constants = Table::from_rows(caption, &papers().constants)
        .text("constant", |constant| constant.name)
        .text("printed", |constant| constant.printed)
        .text("used", |constant| filled(constant.used, &words))
        .text("why", |constant| constant.why);
    let caption = "The ranges of the factors, uniform, as CHK prints them in its tables 1 to 3.";
    let study = general_study();
    let ranges = Table::from_rows(caption, study.space().factors())
        .text("factor", |factor| factor.name.replace('_', " "))
        .text("range", |factor| {
            let (low, high) = factor.distribution().support();
            format!("{low} to {high} {}", factor.unit())
        })
        .text("group", |factor| factor.group.as_deref().unwrap_or_default());
    let parts = vec![constants.into(), details("The ranges of the factors", ranges.into())];
    Section::new("constants", "Constants: printed, used, and why", vec![Part::OnPage(parts)])
}
