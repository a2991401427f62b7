//! A screening as a document.

use super::charts::leader;
use super::{ScreeningFile, screening_charts};
use crate::report::csv::Field;
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Mark, Part, Section, Table, Value};
use crate::report::format::{grouped, heading, index, name, short, words};
use crate::report::leading::first_answers;
use crate::report::study_sections::{failures, inputs, study_section, validity_section};
use crate::report::{capitalised, listed, validity};
use crate::result::json;
use crate::screening::{FIXABLE, ScreenedFactor, ScreenedOutput};
use crate::uncertainty::Estimate;

/// The document of a screening.
pub fn screening_document(file: &ScreeningFile) -> Document {
    let study = &file.study.name;
    let mut of_outputs = Vec::new();
    let names = (study.as_str(), file.study.headline());
    let mut figures = Figure::numbered(screening_charts(file), names, &format!("{study}-screen.csv")).into_iter();
    for output in &file.outputs {
        let mut parts: Vec<Part> = Part::warnings(&output.warnings).into_iter().collect();
        let failed = output.failures.iter();
        parts.extend(failures(failed.map(|f| (&*f.reason, inputs(&f.first_inputs), f.runs))));
        parts.push(Part::Table(effects(file, output)));
        // Two charts for each output: mu* against sigma, and mu* with its intervals.
        parts.extend(figures.by_ref().take(2).map(Part::from));
        of_outputs.push((heading(&output.name, &output.unit), parts));
    }
    let mut sections = Document::sections_of_outputs(of_outputs);
    let answers = file.outputs.iter().map(|output| format!("{} {}", leader(output), fixable(output)));
    let mut lead = first_answers(answers.collect());
    lead.extend(validity::sentence(&file.validity));
    lead.extend(validity::of_failures(file.provenance.failed_runs, file.provenance.model_runs));
    if !file.notes.is_empty() {
        let texts = file.notes.iter().map(|note| format!("{}.", capitalised(note))).collect();
        let note = Part::Notice { mark: Mark::Plain, kind: "Note".to_owned(), texts };
        sections.push(Section::new("notes", "Notes", vec![note]));
    }
    sections.extend(validity_section(&file.validity));
    sections.push(study_section(&file.study, &file.study.factors));
    sections.push(Section::new("provenance", "Provenance", vec![Part::OnPage(vec![provenance(file)])]));
    Document {
        name: format!("{study}-screen"),
        kicker: "Screening of a study".to_owned(),
        title: file.study.headline().to_owned(),
        lead,
        sections,
        footer: format!("Made by apportion {}.", file.provenance.apportion_version),
        files: vec![DataFile::new(format!("{study}-screen.json"), json(file))],
        ..Document::default()
    }
}

/// The factors of an output by rank.
fn effects(file: &ScreeningFile, output: &ScreenedOutput) -> Table {
    let estimate = |heading: &str, name: &str| Column::number(heading).named(Field::estimate(name));
    let in_file = |name: &str| Column::in_file(Field::new(name));
    let is_derivative = file.provenance.derivative_step.is_some();
    let mut columns = vec![
        in_file("output"),
        in_file("unit"),
        Column::text("factor").named(Field::new("factor")),
        in_file("rank"),
        estimate("μ*", "mu_star"),
        estimate("μ", "mu"),
        estimate("σ", "sigma"),
        estimate("σ/μ*", "ratio"),
        Column::text("reading").named(Field::new("reading")),
        Column::text("could be fixed").named(Field::new("could_be_fixed")),
        in_file("effects"),
        in_file("dropped"),
    ];
    if is_derivative {
        let own = [estimate("ν", "nu"), estimate("S_T at most", "total_bound")];
        columns.splice(COLUMNS_BEFORE_NU..COLUMNS_BEFORE_NU, own);
    }
    let plain = |estimate: Option<Estimate>| {
        Cell::valued(estimate.map_or_else(|| "–".to_owned(), |e| short(e.estimate)), Value::Estimate(estimate))
    };
    let row = |factor: &ScreenedFactor| {
        let reading = factor.reading.map(|reading| reading.words());
        let fixed = factor.could_be_fixed.map_or("–", |fixed| if fixed { "yes" } else { "no" });
        let mu_star = factor.mu_star.map_or_else(|| "–".to_owned(), index);
        let mut row = vec![
            Cell::from(&output.name),
            Cell::from(&output.unit),
            Cell::valued(name(&factor.factor), (&factor.factor).into()),
            Cell::valued("", (factor.rank as u64).into()),
            Cell::valued(mu_star, Value::Estimate(factor.mu_star)),
            plain(factor.mu),
            plain(factor.sigma),
            plain(factor.ratio),
            Cell::valued(reading.unwrap_or("–"), reading.map_or(Value::Empty, Value::from)),
            Cell::valued(fixed, factor.could_be_fixed.into()),
            Cell::valued("", factor.effects.into()),
            Cell::valued("", factor.dropped.into()),
        ];
        if is_derivative {
            let bound = factor.total_bound.map_or_else(|| "–".to_owned(), index);
            let bound = Cell::valued(bound, Value::Estimate(factor.total_bound));
            row.splice(COLUMNS_BEFORE_NU..COLUMNS_BEFORE_NU, [plain(factor.nu), bound]);
        }
        row
    };
    let mut ranked: Vec<usize> = (0..output.factors.len()).collect();
    ranked.sort_by_key(|&place| output.factors[place].rank);
    let output_name = name(&output.name);
    let measures = "mean size μ* with its 95 % interval, mean μ, standard deviation σ";
    let bound = "; ν, the mean square of the derivative per unit of the factor, and what the total index S_T is at most by \
                 Poincaré's inequality";
    let caption = if is_derivative {
        format!("Derivatives of {output_name}, times the range of each factor: {measures}{bound}.")
    } else {
        format!("Elementary effects on {output_name} per full range of each factor: {measures}.")
    };
    Table {
        printed: Some(ranked),
        file: format!("{}-screen.csv", file.study.name),
        ..Table::new(caption, columns).with_rows(output.factors.iter().map(row))
    }
}

/// The columns before those of derivatives: up to σ/μ*.
const COLUMNS_BEFORE_NU: usize = 8;

/// Which factors could be fixed, and by which rule.
fn fixable(output: &ScreenedOutput) -> String {
    let fixable = output.factors.iter().filter(|f| f.could_be_fixed == Some(true)).map(|f| words(&f.factor));
    let fixable: Vec<String> = fixable.collect();
    let names = if fixable.is_empty() { "none".to_owned() } else { listed(&fixable) };
    format!(
        "Could be fixed for {}: {names} (the upper bound of μ* below {} % of the largest μ*, by at least half of the effects).",
        name(&output.name),
        100.0 * FIXABLE
    )
}

/// How the answer came about.
fn provenance(file: &ScreeningFile) -> Part {
    let provenance = &file.provenance;
    let mut rows =
        vec![("program", format!("apportion {}", provenance.apportion_version)), ("design", provenance.design.clone())];
    rows.extend(provenance.sampler.iter().map(|sampler| ("sampler", sampler.clone())));
    rows.extend(
        provenance.derivative_step.iter().map(|step| ("step", format!("{} of the range, or less", short(*step)))),
    );
    rows.extend(provenance.levels.iter().map(|levels| ("levels", levels.to_string())));
    rows.extend([
        ("trajectories", grouped(provenance.trajectories)),
        ("seed", provenance.seed.to_string()),
        ("model runs", grouped(provenance.model_runs)),
        ("runs that failed", grouped(provenance.failed_runs)),
        ("threads", provenance.threads.to_string()),
        ("time", format!("{} s", short(provenance.wall_seconds))),
        ("intervals", provenance.interval.clone()),
        ("study file, SHA-256", format!("`{}`", file.study.sha256)),
    ]);
    Table::pairs("How the answer came about.", rows).into()
}
