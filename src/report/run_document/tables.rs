//! The tables of one output, and the files of CSV that hold more than they show.

use crate::model::MANY_OUTPUTS;
use crate::report::csv::{Csv, Field, fields};
use crate::report::document::{Cell, Column, Part, Table, Value, csv};
use crate::report::format::{chance, name, share};
use crate::report::leading::{by_total, surely_interact};
use crate::result::{
    AggregateRecord, IndexRecord, OtherIndexRecord, OutputResult, PairRecord, PlainIndexRecord, PlayerRecord,
    StudyResult,
};
use crate::uncertainty::{EffectEstimates, Estimate};

/// Factors in a table; the files have all of them.
pub(super) const FACTORS: usize = 50;
/// The same with what the caption says of the others.
pub(super) const IN_CSV: (usize, &str) = (FACTORS, "factors, all in the CSV file");
/// Pairs of factors in a table.
const PAIRS: usize = 20;
/// Factors in a table of estimators.
pub(super) const FACTORS_OF_ESTIMATORS: usize = 20;

/// `which` of how many are shown, if not all.
pub(super) fn largest(shown: usize, all: usize, what: &str) -> String {
    if shown < all { format!(" The {shown} largest of {all} {what}.") } else { String::new() }
}

/// A table of the first rows, which are at most `most`; the caption says how many there are of `what`.
pub(super) fn first_rows(
    caption: &str,
    columns: Vec<Column>,
    rows: impl ExactSizeIterator<Item = Vec<Cell>>,
    (most, what): (usize, &str),
) -> Table {
    let caption = format!("{caption}{}", largest(rows.len().min(most), rows.len(), what));
    Table::new(caption, columns).with_rows(rows.take(most))
}

/// What the noise of that name is called.
fn of_noise(noise: &str) -> String {
    format!("noise ({})", name(noise))
}

/// The places of the largest, in order.
fn places<T>(order: &[(usize, T)], count: usize) -> Option<Vec<usize>> {
    Some(order.iter().take(count).map(|(place, _)| *place).collect())
}

/// First-order and total indices of the factors, the largest total index first.
pub(super) fn indices(result: &StudyResult, output: &OutputResult) -> Option<Table> {
    let order = by_total(output)?;
    let rows = output.indices.iter().flatten().map(|index| {
        let mut row = effect_row(&output.name, "factor", name(&index.factor), &index.factor, &index.effect);
        row.extend(of_player(output, &index.factor, std::slice::from_ref(&index.factor)));
        row
    });
    let noise = output.noise.iter();
    let noise = noise.map(|noise| effect_row(&output.name, "noise", of_noise(&noise.name), &noise.name, &noise.effect));
    let caption = format!(
        "First-order index S_1 and total index S_T, each with the half width of its 95 % interval, the largest S_T first.{}",
        largest(order.len().min(FACTORS), order.len(), "factors, all in the CSV file")
    );
    let mut printed = places(&order, FACTORS)?;
    printed.extend(output.noise.iter().map(|_| order.len()));
    let table = with_effects(effect_table(result, caption, "factor", true), rows.chain(noise));
    // Indices of dependent factors sum to nothing.
    let sums = output.sum_first_order.zip(output.sum_total).map(|(first_order, total)| {
        let sums = [Cell::default(), Cell::default(), "sum of all factors".into(), first_order.into(), total.into()];
        let rest = (sums.len()..table.columns.len()).map(|_| Cell::default());
        sums.iter().cloned().chain(rest).collect()
    });
    Some(Table { printed: Some(printed), sums: sums.unwrap_or_default(), ..table })
}

/// A table of indices, of which those over several outputs together show the first two only.
fn effect_table(result: &StudyResult, caption: String, what: &str, is_of_one: bool) -> Table {
    // All outputs are alike.
    let index = result.outputs.iter().find_map(|output| output.indices.as_ref()?.first());
    let is_dependent = index.is_some_and(|index| index.effect.dependent.is_some());
    let column = |heading: &str, field: Field, is_printed: bool| match is_printed {
        true => Column::number(heading).named(field),
        false => Column::in_file(field),
    };
    // The difference of indices of dependent factors shows no interactions, and what exceeds a threshold is not what is ranked.
    let is_independent = is_of_one && !is_dependent;
    let mut columns = vec![
        Column::in_file(Field::new("output")),
        Column::in_file(Field::new("kind")),
        Column::text(what).named(Field::new("name")),
        column("S_1", Field::estimate("first_order"), true),
        column("S_T", Field::estimate("total"), true),
        column("", Field::estimate("share_first_order"), false),
        column("", Field::estimate("share_total"), false),
        column("S_T − S_1", Field::estimate("interaction"), is_independent),
        column("P(largest)", Field::new("probability_first"), is_independent),
        column(
            &format!("P(S_T > {})", result.provenance.threshold),
            Field::new("probability_above_threshold"),
            is_independent,
        ),
    ];
    if is_dependent {
        columns.push(column("S_1 given the others", Field::estimate("independent_first_order"), is_of_one));
        columns.push(column("S_T with the others", Field::estimate("full_total"), is_of_one));
    }
    let has_players = result.outputs.iter().any(|output| output.shapley_groups.is_some());
    if has_players || index.is_some_and(|index| index.effect.shapley.is_some()) {
        columns.push(column("Shapley effect", Field::estimate("shapley"), is_of_one));
    }
    Table::new(caption, columns)
}

/// The Shapley effect of a group, or of a factor without one, where these are the players.
fn of_player(output: &OutputResult, player: &str, factors: &[String]) -> Option<Cell> {
    let mut players = output.shapley_groups.iter().flatten();
    let found = players.find(|record| record.player == player && record.factors == factors)?;
    Some(found.shapley.into())
}

/// `table` with these rows, each of which may lack indices at its end: one that is no player has no Shapley effect.
fn with_effects(table: Table, rows: impl IntoIterator<Item = Vec<Cell>>) -> Table {
    let length = table.columns.len();
    table.with_rows(rows.into_iter().map(|mut row| {
        row.resize_with(length, || None::<Estimate>.into());
        row
    }))
}

fn effect_row(output: &str, kind: &str, label: String, name: &str, effect: &EffectEstimates) -> Vec<Cell> {
    let chance = |probability| Cell::valued(chance(probability).replace('-', "–"), probability.into());
    let share = |share: Option<Estimate>| Cell::valued("", Value::Estimate(share));
    let dependent = effect.dependent.map(|dependent| [dependent.independent_first_order, dependent.full_total]);
    let mut row = vec![
        output.into(),
        kind.into(),
        Cell::valued(label, name.into()),
        effect.first_order.into(),
        effect.total.into(),
        share(effect.first_order_percent()),
        share(effect.total_percent()),
        effect.interaction.into(),
        chance(effect.probability_first),
        chance(effect.probability_above_threshold),
    ];
    row.extend(dependent.into_iter().flatten().map(Cell::from));
    row.extend(effect.shapley.map(Cell::from));
    row
}

/// The indices of all outputs: of factors and groups, then of subsets and the dummy factor, then those of several together.
pub(super) fn indices_csv(result: &StudyResult) -> String {
    // Each table is made when it is written: there may be thousands.
    let outputs = || result.outputs.iter();
    let first = outputs().flat_map(|output| indices(result, output).into_iter().chain(groups(result, output)));
    let then = outputs().filter_map(|output| subsets(result, output));
    let aggregate = result.aggregate.iter().filter_map(|record| Some((record, record.indices.as_ref()?)));
    let aggregate = aggregate.map(|(record, indices)| aggregate_of(result, record, indices));
    let series = result.series.iter().filter_map(|series| {
        let indices = series.indices.as_ref()?;
        let (outputs, weighting) = (vec![series.name.clone()], String::new());
        let record = AggregateRecord { outputs, weighting, indices: None, noise: None, reason: None };
        Some(aggregate_of(result, &record, indices))
    });
    let header = std::iter::once(effect_table(result, String::new(), "", true));
    csv(header.chain(first).chain(then).chain(aggregate).chain(series))
}

/// The second-order indices of all outputs.
pub(super) fn pairs_csv(result: &StudyResult) -> String {
    let header = std::iter::once(pairs_table(String::new()));
    csv(header.chain(result.outputs.iter().filter_map(pairs)))
}

/// Shares in percent, the largest share of the total indices first.
pub(super) fn shares(output: &OutputResult) -> Option<Part> {
    let order = by_total(output)?;
    let row = |(_, IndexRecord { factor, effect }): &(usize, &IndexRecord)| -> Vec<Cell> {
        let shares = [effect.first_order_percent(), effect.total_percent()].map(share);
        [name(factor)].into_iter().chain(shares).map(Cell::from).collect()
    };
    let caption = "Shares in percent of the sums of the indices of all factors, with their 95 % intervals.";
    let columns = Column::list(1, &["factor", "of the sum of S_1", "of the sum of S_T"]);
    Some(first_rows(caption, columns, order.iter().map(row), IN_CSV).into())
}

/// Joint indices of groups of factors.
pub(super) fn groups(result: &StudyResult, output: &OutputResult) -> Option<Table> {
    let rows = output.groups.iter().flatten().map(|group| {
        let label = format!("{}: {}", name(&group.group), joined(&group.factors));
        let mut row = effect_row(&output.name, "group", label, &group.group, &group.effect);
        row.extend(of_player(output, &group.group, &group.factors));
        row
    });
    joint(result, "Joint indices of groups of the factors: S_1 includes the interactions inside them.", rows.collect())
}

/// Joint indices of subsets of factors, and those of the dummy factor.
pub(super) fn subsets(result: &StudyResult, output: &OutputResult) -> Option<Table> {
    let rows = output.subsets.iter().flatten().map(|subset| {
        let in_file = subset.factors.join(" + ");
        effect_row(&output.name, "subset", joined(&subset.factors), &in_file, &subset.effect)
    });
    let label = || "dummy, which does nothing".to_owned();
    let dummy = output.dummy.iter().map(|effect| effect_row(&output.name, "dummy", label(), "dummy", effect));
    let caption = match output.dummy {
        Some(_) => "Joint indices of subsets, and of a factor that does nothing: what is not 0 there is error.",
        None => "Joint indices of subsets of the factors: S_1 includes the interactions inside them.",
    };
    joint(result, caption, rows.chain(dummy).collect())
}

fn joined(factors: &[String]) -> String {
    factors.iter().map(|factor| name(factor)).collect::<Vec<_>>().join(" + ")
}

fn joint(result: &StudyResult, caption: &str, rows: Vec<Vec<Cell>>) -> Option<Table> {
    let printed = Some((0..rows.len().min(FACTORS)).collect());
    let table = with_effects(effect_table(result, caption.to_owned(), "factors", true), rows);
    (!table.rows.is_empty()).then_some(Table { printed, ..table })
}

/// The Shapley effects of groups, the largest first.
pub(super) fn players(output: &OutputResult) -> Option<Part> {
    let players = output.shapley_groups.as_ref().filter(|players| !players.is_empty())?;
    let mut order: Vec<&PlayerRecord> = players.iter().collect();
    order.sort_by(|a, b| b.shapley.estimate.total_cmp(&a.shapley.estimate));
    let row = |player: &&PlayerRecord| {
        vec![name(&player.player).into(), joined(&player.factors).into(), player.shapley.into()]
    };
    let columns = Column::list(2, &["group", "factors", "Shapley effect"]);
    let shown = (FACTORS, "groups, all in the CSV file");
    Some(first_rows("Shapley effects of groups of factors.", columns, order.iter().map(row), shown).into())
}

/// The largest second-order indices.
pub(super) fn pairs(output: &OutputResult) -> Option<Table> {
    let pairs = output.second_order.as_ref().filter(|pairs| !pairs.is_empty())?;
    let mut order: Vec<(usize, &PairRecord)> = pairs.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.index.estimate.total_cmp(&a.1.index.estimate));
    let row = |(pair, is_sure): (&PairRecord, bool)| {
        let seen = match pair.index.interval {
            _ if is_sure => "yes",
            Some(interval) if interval.low > 0.0 => "may be chance: one of many pairs",
            Some(_) => "no",
            None => "unknown",
        };
        let [a, b] = &pair.factors;
        let label = format!("{} × {}", name(a), name(b));
        vec![label.into(), seen.into(), Cell::from(&output.name), a.into(), b.into(), pair.index.into()]
    };
    let caption = format!(
        "Second-order indices: what two factors do together beyond what each does alone.{}",
        largest(order.len().min(PAIRS), order.len(), "pairs, all in the CSV file")
    );
    let table = pairs_table(caption).with_rows(pairs.iter().zip(surely_interact(pairs)).map(row));
    Some(Table { printed: places(&order, PAIRS), ..table })
}

fn pairs_table(caption: String) -> Table {
    let columns = [
        Column::text("pair"),
        Column::text("interaction seen"),
        Column::in_file(Field::new("output")),
        Column::in_file(Field::new("factor_1")),
        Column::in_file(Field::new("factor_2")),
        Column::number("S_2").named(Field::estimate("second_order")),
    ];
    Table::new(caption, columns)
}

/// First-order, then total indices by the other estimators, with the default ones.
pub(super) fn estimators(output: &OutputResult) -> Vec<Part> {
    let Some(order) = by_total(output) else { return Vec::new() };
    type Of = fn(&OtherIndexRecord) -> Option<Estimate>;
    type Default = fn(&EffectEstimates) -> Estimate;
    let kinds: [(&str, Of, Default); 2] = [
        ("First-order indices S_1", |other| other.first_order, |effect| effect.first_order),
        ("Total indices S_T", |other| other.total, |effect| effect.total),
    ];
    let mut parts = Vec::new();
    for (what, of, default) in kinds {
        let has = |index: &OtherIndexRecord| of(index).is_some();
        let records: Vec<_> = output.estimators.iter().filter(|record| record.indices.iter().any(has)).collect();
        if records.is_empty() {
            continue;
        }
        let mut headings = vec!["factor", "default"];
        headings.extend(records.iter().map(|record| record.estimator.as_str()));
        let row = |&(number, index): &(usize, &IndexRecord)| -> Vec<Cell> {
            let others = records.iter().map(|record| record.indices.get(number).and_then(of));
            let all = [Some(default(&index.effect))].into_iter().chain(others);
            [name(&index.factor).into()].into_iter().chain(all.map(Cell::from)).collect()
        };
        let (caption, shown) = (format!("{what} by estimator."), (FACTORS_OF_ESTIMATORS, IN_CSV.1));
        parts.push(first_rows(&caption, Column::list(1, &headings), order.iter().map(row), shown).into());
    }
    parts
}

/// Indices over all outputs together.
pub(super) fn aggregate_of(result: &StudyResult, record: &AggregateRecord, indices: &[PlainIndexRecord]) -> Table {
    // The noise is one more line.
    let noise = record.noise.as_ref();
    let lines = || indices.iter().chain(noise);
    let mut order: Vec<(usize, &PlainIndexRecord)> = lines().enumerate().collect();
    order.sort_by(|a, b| b.1.total.estimate.total_cmp(&a.1.total.estimate));
    // The names of hundreds, in every line, would be most of the file.
    let outputs = match record.outputs.len() {
        ..MANY_OUTPUTS => record.outputs.join(" + "),
        all if all == result.outputs.len() => "all outputs".to_owned(),
        _ => "all outputs that are no series".to_owned(),
    };
    let row = |index: &PlainIndexRecord| {
        let nothing = || Cell::valued("", Value::Empty);
        let none = || Cell::valued("", Value::Estimate(None));
        let label = match noise == Some(index) {
            true => of_noise(&index.factor),
            false => name(&index.factor),
        };
        let label = Cell::valued(label, (&index.factor).into());
        let estimates = [index.first_order.into(), index.total.into(), none(), none(), none(), nothing(), nothing()];
        [outputs.as_str().into(), "aggregate".into(), label].into_iter().chain(estimates).collect()
    };
    let caption = format!(
        "Aggregated indices of all outputs.{}",
        largest(order.len().min(FACTORS), order.len(), "factors, all in the CSV file")
    );
    let table = with_effects(effect_table(result, caption, "factor", false), lines().map(row));
    Table { printed: places(&order, FACTORS), ..table }
}

/// The indices by the other estimators: a line per output, estimator and factor, group, subset or dummy.
pub(super) fn estimators_csv(result: &StudyResult) -> String {
    let mut csv = Csv::new(fields(&["output", "estimator", "name"], &["first_order", "total"]));
    for output in &result.outputs {
        for record in &output.estimators {
            for index in &record.indices {
                let texts = [&output.name, &record.estimator, &index.name].map(Value::from);
                csv.row(texts.into_iter().chain([index.first_order.into(), index.total.into()]));
            }
        }
    }
    csv.text()
}

/// The indices at every stage of the run: a line per output, number of base samples and factor.
pub(super) fn convergence_csv(result: &StudyResult) -> String {
    let names = ["output", "base_samples", "model_runs", "factor"];
    let mut csv = Csv::new(fields(&names, &["first_order", "total"]));
    for output in &result.outputs {
        for stage in &output.convergence {
            for index in &stage.indices {
                let about: [Value; 4] =
                    [(&output.name).into(), stage.base_samples.into(), stage.model_runs.into(), (&index.factor).into()];
                csv.row(about.into_iter().chain([index.first_order.into(), index.total.into()]));
            }
        }
    }
    csv.text()
}
