//! A map of extremes as a document.

use super::charts::charts;
use super::map::{Extremes, Outcome};
use super::record::{ExtremesFile, KindRecord, ReasonRecord, TallyRecord};
use crate::report::csv::Field;
use crate::report::document::{Cell, Column, DataFile, Document, Figure, Mark, OnPhone, Part, Section, Table, Value};
use crate::report::format::{grouped, short};
use crate::report::{capitalised, inputs, json, study_section};
use crate::text::csv_field;

/// The document of a map.
pub fn extremes_document(map: &Extremes, file: &ExtremesFile) -> Document {
    let study = &file.study.name;
    let headline = file.study.headline();
    let figures = charts(headline, map).into_iter().zip(&map.grids).enumerate().map(|(place, (chart, grid))| {
        let stem = format!("{study}-extremes{}", grid.suffix);
        Figure::new(place + 1, chart, stem, format!("{study}-extremes.csv")).below(headline)
    });
    let wrong = wrong(file);
    let mut parts: Vec<Part> = wrong.into_iter().collect();
    parts.push(counts(file).into());
    parts.push(Part::Text(how(file)));
    parts.push(Part::List(Outcome::ALL.into_iter().map(explained).collect()));
    parts.extend(figures.map(Part::from));
    let mut sections = vec![Section::new("map", "The map", parts)];
    if !file.reasons.is_empty() {
        sections.push(Section::new("reasons", "Reasons", vec![reasons(file).into()]));
    }
    sections.push(study_section(&file.study));
    let provenance = Part::OnPage(vec![provenance(file)]);
    sections.push(Section::new("provenance", "Provenance", vec![provenance]));
    Document {
        name: format!("{study}-extremes"),
        kicker: "A study at its extremes".to_owned(),
        title: headline.to_owned(),
        lead: vec![lead(&file.counts)],
        sections,
        footer: format!("Made by apportion {}.", file.provenance.apportion_version),
        files: vec![
            DataFile::new(format!("{study}-extremes.json"), json(file)),
            DataFile::new(format!("{study}-extremes-points.csv"), points(file)),
        ],
        ..Document::default()
    }
}

fn lead(counts: &TallyRecord) -> String {
    let total: u64 = Outcome::ALL.iter().map(|outcome| counts.of(*outcome)).sum();
    let flagged = counts.flagged + counts.flagged_confirmed;
    let wrong = match counts.wrong {
        0 => "none is wrong without a word".to_owned(),
        wrong => format!("{} WRONG without a word", grouped(wrong)),
    };
    format!(
        "Of {} numbers at the extremes, {} are finite and right, {} finite and flagged ({} of which a second calculation \
         confirms), {} refused with a reason; {wrong}.",
        grouped(total),
        grouped(counts.right),
        grouped(flagged),
        grouped(counts.flagged_confirmed),
        grouped(counts.refused)
    )
}

fn wrong(file: &ExtremesFile) -> Option<Part> {
    let wrong = file.counts.wrong;
    let texts = vec![format!(
        "{} numbers are wrong without a word. The first reasons of the table below tell which: please report them with the study.",
        grouped(wrong)
    )];
    (wrong > 0).then(|| Part::Notice { mark: Mark::Bad, kind: "Wrong".to_owned(), texts })
}

fn how(file: &ExtremesFile) -> String {
    let by = match (&file.provenance.second_calculation, &file.provenance.unchecked) {
        (Some(second), _) => format!("The model was checked by {second}."),
        (None, Some(why)) => format!("The model was checked by nothing: {why}. Its finite numbers count as flagged."),
        (None, None) => String::new(),
    };
    format!("{by} The indices were checked by the same estimators in 106 bits.")
}

fn explained(outcome: Outcome) -> String {
    let meaning = match outcome {
        Outcome::Right => "a second calculation agrees",
        Outcome::FlaggedConfirmed => {
            "an assumption is strained, and a second calculation agrees with the number all the same"
        }
        Outcome::Flagged => {
            "something is strained, or the error that is stated is large, or there is nothing to check it by"
        }
        Outcome::Refused => "there is no number, and it is said why",
        Outcome::Wrong => "a second calculation disagrees by more than is stated: this must not occur",
    };
    format!("{} – {}: {meaning}.", outcome.letter(), outcome.words())
}

/// The numbers by kind and outcome.
fn counts(file: &ExtremesFile) -> Table {
    let outcomes = Outcome::ALL.map(|outcome| {
        let heading = match outcome {
            Outcome::Right => "right",
            Outcome::FlaggedConfirmed => "flagged, confirmed",
            Outcome::Flagged => "flagged",
            Outcome::Refused => "refused",
            Outcome::Wrong => "wrong",
        };
        Column::number(heading)
    });
    let cells = |tally: &TallyRecord| {
        Outcome::ALL.map(|outcome| {
            let mark = if outcome == Outcome::Wrong && tally.wrong > 0 { Mark::Bad } else { Mark::Plain };
            Cell::marked(grouped(tally.of(outcome)), mark)
        })
    };
    let row = |kind: &KindRecord| {
        let words = Cell::from(capitalised(&kind.description));
        std::iter::once(words).chain(cells(&kind.counts)).collect()
    };
    let columns = std::iter::once(Column::text("where")).chain(outcomes);
    let caption = "Numbers at the extremes, by where they were looked at and what became of them.";
    Table {
        sums: std::iter::once(Cell::from("All")).chain(cells(&file.counts)).collect(),
        ..Table::new(caption, columns).with_rows(file.kinds.iter().map(row))
    }
}

/// Why numbers are flagged, refused or wrong, each with its first example.
fn reasons(file: &ExtremesFile) -> Table {
    let columns = [
        Column::text("what").named(Field::new("outcome")),
        Column::text("where").named(Field::new("kind")),
        Column::text("why").named(Field::new("reason")),
        Column::number("numbers").named(Field::new("numbers")),
        Column::text("first").named(Field::new("place")),
        Column::in_file(Field::new("output")),
        Column::in_file(Field::new("value")),
        Column::in_file(Field::new("reference")),
    ];
    let row = |reason: &ReasonRecord| {
        let mark = if reason.outcome == "wrong" { Mark::Bad } else { Mark::Plain };
        let said = [("", reason.value), ("second calculation ", reason.reference)];
        let said = said.into_iter().filter_map(|(what, value)| Some(format!("{what}{}", short(value?))));
        let numbers: Vec<String> = said.collect();
        let note = match (&*reason.output, inputs(&reason.inputs)) {
            ("", inputs) => inputs,
            (output, inputs) => format!("{output} {}; {inputs}", numbers.join(", ")),
        };
        vec![
            Cell { mark, value: (&reason.outcome).into(), ..Cell::from(reason.outcome.replace('-', ", ")) },
            Cell::from(&reason.kind),
            Cell::from(&reason.reason),
            Cell::valued(grouped(reason.count), reason.count.into()),
            Cell { note: note.trim_end_matches("; ").to_owned(), ..Cell::from(&reason.place) },
            Cell::from(&reason.output),
            Cell::valued("", reason.value.map_or(Value::Empty, Value::from)),
            Cell::valued("", reason.reference.map_or(Value::Empty, Value::from)),
        ]
    };
    let caption = format!(
        "Why numbers are flagged, refused or wrong, with the first of each; `apportion evaluate` reads the inputs of these from \
         {}-extremes-points.csv.",
        file.study.name
    );
    Table {
        file: format!("{}-extremes.csv", file.study.name),
        on_phone: OnPhone::StackLabelled,
        ..Table::new(caption, columns).with_rows(file.reasons.iter().map(row))
    }
}

/// The inputs of the examples, for `apportion evaluate`: a column for each factor.
fn points(file: &ExtremesFile) -> String {
    let names: Vec<&str> = file.study.factors.iter().map(|factor| factor.name.as_str()).collect();
    let mut text = names.iter().map(|name| csv_field(name)).collect::<Vec<_>>().join(",") + "\n";
    for reason in file.reasons.iter().filter(|reason| !reason.inputs.is_empty()) {
        let number = |name: &&str| reason.inputs.get(*name).map(ToString::to_string).unwrap_or_default();
        text.push_str(&(names.iter().map(number).collect::<Vec<_>>().join(",") + "\n"));
    }
    text
}

/// How the answer came about.
fn provenance(file: &ExtremesFile) -> Part {
    let provenance = &file.provenance;
    let rows = vec![
        ("program", format!("apportion {}", provenance.apportion_version)),
        ("points", grouped(provenance.points)),
        ("most runs of one design", grouped(provenance.max_runs)),
        ("seed", provenance.seed.to_string()),
        ("study file, SHA-256", format!("`{}`", file.study.sha256)),
    ];
    Table::pairs("How the answer came about.", rows).into()
}
