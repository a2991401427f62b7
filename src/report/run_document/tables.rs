//! The tables of one output, and the files of CSV that hold more than they show.

use crate::model::MANY_OUTPUTS;
use crate::report::csv::{Csv, Field, fields};
use crate::report::document::{Cell, Column, Part, Table, Value, csv};
use crate::report::format::{chance, grouped, name, share, two_digits};
use crate::report::leading::{by_total, surely_interact};
use crate::report::result::{
    AggregateIndexRecord, AggregateRecord, EffectRecord, EstimateRecord, EstimatorRecord, IndexRecord, IntervalRecord,
    OtherIndexRecord, OutputRecord, PairRecord, PlayerRecord, ResultFile, StageRecord,
};

/// Most factors in a table; the files have all of them.
pub(super) const FACTORS: usize = 50;
/// Most pairs of factors.
const PAIRS: usize = 20;
/// Most estimators side by side.
const ESTIMATORS: usize = 6;
/// Most factors in a table of estimators.
pub(super) const FACTORS_OF_ESTIMATORS: usize = 20;

/// The places of the columns from the first one on that a table of indices over all outputs leaves out.
const OF_ONE_OUTPUT: usize = 7;

/// `which` of how many are shown, if not all.
pub(super) fn largest(shown: usize, all: usize, what: &str) -> String {
    if shown < all { format!(" The {shown} largest of {all} {what}.") } else { String::new() }
}

/// What the noise of that name is called.
fn of_noise(noise: &str) -> String {
    format!("noise ({})", name(noise))
}

/// The places of the largest, in order.
fn places<T>(order: &[(usize, T)], most: usize) -> Option<Vec<usize>> {
    Some(order.iter().take(most).map(|(place, _)| *place).collect())
}

/// First-order and total indices of the factors, the largest total index first.
pub(super) fn indices(result: &ResultFile, output: &OutputRecord) -> Option<Part> {
    let order = by_total(output)?;
    let indices = output.indices.iter().flatten();
    let rows = indices.map(|index| {
        let mut row = effect_row(&output.name, "factor", name(&index.factor), &index.factor, &index.effect);
        row.extend(of_player(output, &index.factor, std::slice::from_ref(&index.factor)));
        row
    });
    let noise = output.noise.as_ref();
    let noise_row =
        noise.map(|noise| effect_row(&output.name, "noise", of_noise(&noise.name), &noise.name, &noise.effect));
    let sum = |sum: Option<EstimateRecord>| sum.map_or_else(Cell::default, Cell::from);
    let all = if noise.is_some() { "sum of all factors and the noise" } else { "sum of all factors" };
    let mut sums: Vec<Cell> = vec![Cell::default(), Cell::default(), all.into()];
    sums.extend([sum(output.sum_first_order), sum(output.sum_total)]);
    let (what, order_of) = match output.indices.iter().flatten().any(|index| index.effect.dependent.is_some()) {
        true => ("First-order and total indices of dependent factors", "what they are ranked by"),
        false => ("First-order index S_1, total index S_T and their difference", "the total index"),
    };
    let caption = format!(
        "{what}, each with the half width of its 95 % interval, in the order of {order_of}.{}",
        largest(order.len().min(FACTORS), order.len(), "factors, all in the CSV file")
    );
    let mut printed = places(&order, FACTORS);
    if let (Some(printed), Some(_)) = (&mut printed, noise) {
        let weight = noise.map_or(0.0, |noise| noise.effect.weight().estimate);
        let before = order.iter().take(FACTORS).filter(|(_, index)| index.effect.weight().estimate >= weight).count();
        printed.insert(before, order.len());
    }
    let table = with_effects(effect_table(result, caption, "factor"), rows.chain(noise_row));
    match output.sum_first_order.is_some() || output.sum_total.is_some() {
        true => sums.resize(table.columns.len(), Cell::default()),
        // Indices of dependent factors sum to nothing.
        false => sums.clear(),
    }
    Some(Part::Table(Table { printed, sums, ..table }))
}

fn effect_table(result: &ResultFile, caption: String, what: &str) -> Table {
    let above = format!("P(S_T > {})", result.provenance.threshold);
    let in_file = |name: &str| Column::in_file(Field::new(name));
    let estimate = |heading: &str, name: &str| Column::number(heading).named(Field::estimate(name));
    let mut columns = vec![
        in_file("output"),
        in_file("kind"),
        Column::text(what).named(Field::new("name")),
        estimate("S_1", "first_order"),
        estimate("S_T", "total"),
        Column::in_file(Field::estimate("share_first_order")),
        Column::in_file(Field::estimate("share_total")),
        estimate("S_T − S_1", "interaction"),
        Column::number("P(largest)").named(Field::new("probability_first")),
        Column::number(above).named(Field::new("probability_above_threshold")),
    ];
    // All outputs are alike.
    let index = result.outputs.iter().find_map(|output| output.indices.as_ref()?.first());
    if index.is_some_and(|index| index.effect.dependent.is_some()) {
        // Their difference shows no interactions, what exceeds a threshold is not what is ranked, and the page has room for five.
        columns[7..10].iter_mut().for_each(Column::hide);
        columns.push(estimate("S_1 given the others", "independent_first_order"));
        columns.push(estimate("S_T with the others", "full_total"));
    }
    let has_players = result.outputs.iter().any(|output| output.shapley_groups.is_some());
    if has_players || index.is_some_and(|index| index.effect.shapley.is_some()) {
        columns.push(estimate("Shapley effect", "shapley"));
    }
    Table { file: format!("{}.csv", result.study.name), ..Table::new(caption, columns) }
}

/// The Shapley effect of a group, or of a factor without one, where these are the players.
fn of_player(output: &OutputRecord, player: &str, factors: &[String]) -> Option<Cell> {
    let mut players = output.shapley_groups.iter().flatten();
    let found = players.find(|record| record.player == player && record.factors == factors)?;
    Some(found.shapley.into())
}

/// `table` with these rows, each of which may lack indices at its end: who is no player has no Shapley effect.
fn with_effects(table: Table, rows: impl IntoIterator<Item = Vec<Cell>>) -> Table {
    let length = table.columns.len();
    table.with_rows(rows.into_iter().map(|mut row| {
        row.resize_with(length, || None::<EstimateRecord>.into());
        row
    }))
}

fn effect_row(output: &str, kind: &str, label: String, name: &str, effect: &EffectRecord) -> Vec<Cell> {
    let chance = |probability| Cell::valued(chance(probability).replace('-', "–"), probability.into());
    let share = |share: Option<f64>, interval: Option<IntervalRecord>| {
        let bounds =
            |estimate| EstimateRecord { estimate, low: interval.map(|i| i.low), high: interval.map(|i| i.high) };
        Cell::valued("", Value::Estimate(share.map(bounds)))
    };
    let dependent = effect.dependent.map(|dependent| [dependent.independent_first_order, dependent.full_total]);
    let mut row = vec![
        output.into(),
        kind.into(),
        Cell::valued(label, name.into()),
        effect.first_order.into(),
        effect.total.into(),
        share(effect.share_first_order, effect.share_first_order_interval),
        share(effect.share_total, effect.share_total_interval),
        effect.interaction.into(),
        chance(effect.probability_first),
        chance(effect.probability_above_threshold),
    ];
    row.extend(dependent.into_iter().flatten().map(Cell::from));
    row.extend(effect.shapley.map(Cell::from));
    row
}

/// The indices of all outputs, as the tables of each and the aggregated ones have them.
pub(super) fn indices_csv(result: &ResultFile) -> String {
    let table = |part: Part| if let Part::Table(table) = part { Some(table) } else { None };
    let of_output = |output: &OutputRecord, at_end: bool| -> Vec<Table> {
        let parts = indices(result, output).into_iter().chain(joint(result, output));
        parts.filter_map(table).filter(|table| table.at_end == at_end).collect()
    };
    // Each is made when it is written: there may be thousands.
    let pass = |at_end: bool| result.outputs.iter().flat_map(move |output| of_output(output, at_end));
    let aggregate = result.aggregate.iter().filter_map(|record| Some((record, record.indices.as_ref()?)));
    let aggregate = aggregate.filter_map(|(record, indices)| table(aggregate_of(result, record, indices)));
    let series = result.series.iter().filter_map(|series| {
        let indices = series.indices.as_ref()?;
        let (outputs, weighting) = (vec![series.name.clone()], String::new());
        let record = AggregateRecord { outputs, weighting, indices: None, noise: None, reason: None };
        table(aggregate_of(result, &record, indices))
    });
    let header = std::iter::once(effect_table(result, String::new(), ""));
    csv(header.chain(pass(false)).chain(pass(true)).chain(aggregate).chain(series))
}

/// The second-order indices of all outputs.
pub(super) fn pairs_csv(result: &ResultFile) -> String {
    let of_output = |output: &OutputRecord| match pairs(result, output) {
        Some(Part::Table(table)) => Some(table),
        _ => None,
    };
    let header = std::iter::once(pairs_table(result, String::new()));
    csv(header.chain(result.outputs.iter().filter_map(of_output)))
}

/// The file of indices where there are none.
pub(super) fn no_indices_csv(result: &ResultFile) -> String {
    effect_table(result, String::new(), "").csv()
}

/// Shares in percent, the largest share of the total indices first.
pub(super) fn shares(output: &OutputRecord) -> Option<Part> {
    let order = by_total(output)?;
    let shown = &order[..order.len().min(FACTORS)];
    let row = |(_, IndexRecord { factor, effect }): &(usize, &IndexRecord)| -> Vec<Cell> {
        vec![
            name(factor).into(),
            share(effect.share_first_order, effect.share_first_order_interval).into(),
            share(effect.share_total, effect.share_total_interval).into(),
        ]
    };
    let caption = format!(
        "Shares in percent of the sums of the indices of all factors, with their 95 % intervals.{}",
        largest(shown.len(), order.len(), "factors, all in the CSV file")
    );
    let columns = Column::list(1, &["factor", "of the sum of S_1", "of the sum of S_T"]);
    Some(Part::Table(Table::new(caption, columns).with_rows(shown.iter().map(row))))
}

/// Groups, then subsets and the dummy factor.
pub(super) fn joint(result: &ResultFile, output: &OutputRecord) -> Vec<Part> {
    let names = |factors: &[String]| factors.iter().map(|factor| name(factor)).collect::<Vec<_>>().join(" + ");
    let groups = output.groups.iter().flatten().map(|group| {
        let label = format!("{}: {}", name(&group.group), names(&group.factors));
        let mut row = effect_row(&output.name, "group", label, &group.group, &group.effect);
        row.extend(of_player(output, &group.group, &group.factors));
        row
    });
    let subsets = output.subsets.iter().flatten().map(|subset| {
        let in_file = subset.factors.join(" + ");
        effect_row(&output.name, "subset", names(&subset.factors), &in_file, &subset.effect)
    });
    let dummy = "dummy, which does nothing";
    let dummy = output.dummy.iter().map(|e| effect_row(&output.name, "dummy", dummy.to_owned(), "dummy", e));
    let of_subsets = match output.subsets.iter().flatten().count() {
        0 => "Indices of a factor that does nothing, run along: what is not 0 is noise.",
        _ => "Joint indices of subsets of the factors: S_1 includes the interactions inside them.",
    };
    let table = |caption: &str, rows: Vec<Vec<Cell>>| {
        let printed = Some((0..rows.len().min(FACTORS)).collect());
        Table { printed, ..with_effects(effect_table(result, caption.to_owned(), "factors"), rows) }
    };
    let of_groups = "Joint indices of groups of the factors: S_1 includes the interactions inside them.";
    let groups = table(of_groups, groups.collect());
    let others = Table { at_end: true, ..table(of_subsets, subsets.chain(dummy).collect()) };
    [groups, others].into_iter().filter(|table| !table.rows.is_empty()).map(Part::Table).collect()
}

/// The Shapley effects of groups, the largest first.
pub(super) fn players(output: &OutputRecord) -> Option<Part> {
    let players = output.shapley_groups.as_ref().filter(|players| !players.is_empty())?;
    let mut order: Vec<(usize, &PlayerRecord)> = players.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.shapley.estimate.total_cmp(&a.1.shapley.estimate));
    let row = |player: &PlayerRecord| {
        let factors: Vec<String> = player.factors.iter().map(|factor| name(factor)).collect();
        vec![name(&player.player).into(), factors.join(" + ").into(), player.shapley.into()]
    };
    let columns = [Column::text("group"), Column::text("factors"), Column::number("Shapley effect")];
    let caption = format!(
        "Shapley effects of groups of factors.{}",
        largest(order.len().min(FACTORS), order.len(), "groups, all in the CSV file")
    );
    let table = Table::new(caption, columns).with_rows(players.iter().map(row));
    Some(Part::Table(Table { printed: places(&order, FACTORS), ..table }))
}

/// The largest second-order indices.
pub(super) fn pairs(result: &ResultFile, output: &OutputRecord) -> Option<Part> {
    let pairs = output.second_order.as_ref().filter(|pairs| !pairs.is_empty())?;
    let mut order: Vec<(usize, &PairRecord)> = pairs.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.index.estimate.total_cmp(&a.1.index.estimate));
    let row = |(pair, is_sure): (&PairRecord, bool)| {
        let seen = match (pair.index.low, pair.index.high) {
            _ if is_sure => "yes",
            (Some(low), _) if low > 0.0 => "may be chance: one of many pairs",
            (Some(_), Some(high)) if high < 0.0 => "no: below 0 by chance, or too few samples",
            (Some(_), Some(_)) => "no: 0 is within the interval",
            _ => "unknown",
        };
        let [a, b] = &pair.factors;
        let label = format!("{} × {}", name(a), name(b));
        vec![label.into(), seen.into(), Cell::from(&output.name), a.into(), b.into(), pair.index.into()]
    };
    let caption = format!(
        "Second-order indices: what two factors do together beyond what each does alone.{}",
        largest(order.len().min(PAIRS), order.len(), "pairs, all in the CSV file")
    );
    let table = pairs_table(result, caption).with_rows(pairs.iter().zip(surely_interact(pairs)).map(row));
    Some(Part::Table(Table { printed: places(&order, PAIRS), ..table }))
}

fn pairs_table(result: &ResultFile, caption: String) -> Table {
    let columns = [
        Column::text("pair"),
        Column::text("interaction seen"),
        Column::in_file(Field::new("output")),
        Column::in_file(Field::new("factor_1")),
        Column::in_file(Field::new("factor_2")),
        Column::number("S_2").named(Field::estimate("second_order")),
    ];
    let file = format!("{}-second-order.csv", result.study.name);
    Table { file, ..Table::new(caption, columns) }
}

/// The width of the intervals at every stage of the run.
pub(super) fn stages(output: &OutputRecord) -> Option<Part> {
    let row = |stage: &StageRecord| -> Vec<Cell> {
        let width = stage.largest_half_width.map_or_else(|| "–".to_owned(), two_digits);
        vec![grouped(stage.base_samples).into(), grouped(stage.model_runs).into(), width.into()]
    };
    let caption = "Largest half width of all first-order and total indices as the run grew.";
    let table = Table::new(caption, Column::list(0, &["base points", "model runs", "largest half width"]));
    (!output.convergence.is_empty()).then(|| Part::Table(table.with_rows(output.convergence.iter().map(row))))
}

/// First-order, then total indices by the other estimators, beside the default ones.
pub(super) fn estimators(output: &OutputRecord) -> Vec<Part> {
    let (Some(order), false) = (by_total(output), output.estimators.is_empty()) else { return Vec::new() };
    type Of = fn(&OtherIndexRecord) -> Option<EstimateRecord>;
    type Default = fn(&EffectRecord) -> EstimateRecord;
    let kinds: [(&str, Of, Default); 2] = [
        ("First-order indices S_1", |other| other.first_order, |effect| effect.first_order),
        ("Total indices S_T", |other| other.total, |effect| effect.total),
    ];
    let shown = &order[..order.len().min(FACTORS_OF_ESTIMATORS)];
    let mut parts = Vec::new();
    for (what, of, default) in kinds {
        let has = |index: &OtherIndexRecord| of(index).is_some();
        let records: Vec<_> = output.estimators.iter().filter(|record| record.indices.iter().any(has)).collect();
        for few in records.chunks(ESTIMATORS) {
            let mut headings = vec!["factor", "default"];
            headings.extend(few.iter().map(|record| record.estimator.as_str()));
            let row = |&(number, index): &(usize, &IndexRecord)| -> Vec<Cell> {
                let others = few.iter().map(|record| record.indices.get(number).and_then(of));
                let all = [Some(default(&index.effect))].into_iter().chain(others);
                [name(&index.factor).into()].into_iter().chain(all.map(Cell::from)).collect()
            };
            let caption =
                format!("{what} by estimator.{}", largest(shown.len(), order.len(), "factors, all in the CSV file"));
            let table = Table::new(caption, Column::list(1, &headings)).with_rows(shown.iter().map(row));
            parts.push(Part::Table(table));
        }
    }
    let source = |record: &EstimatorRecord| {
        let first = record.first_order_source.iter().map(|source| format!("S_1: {source}"));
        let total = record.total_source.iter().map(|source| format!("S_T: {source}"));
        format!("`{}`: {}", record.estimator, first.chain(total).collect::<Vec<_>>().join("; "))
    };
    parts.push(Part::OnPage(vec![Part::List(output.estimators.iter().map(source).collect())]));
    parts
}

/// Indices over all outputs together.
pub(super) fn aggregate_of(result: &ResultFile, record: &AggregateRecord, indices: &[AggregateIndexRecord]) -> Part {
    // The noise is one more line.
    let noise = record.noise.as_ref();
    let lines = || indices.iter().chain(noise);
    let mut order: Vec<(usize, &AggregateIndexRecord)> = lines().enumerate().collect();
    order.sort_by(|a, b| b.1.total.estimate.total_cmp(&a.1.total.estimate));
    // The names of hundreds, in every line, would be most of the file.
    let outputs = match record.outputs.len() {
        ..MANY_OUTPUTS => record.outputs.join(" + "),
        all if all == result.outputs.len() => "all outputs".to_owned(),
        _ => "all outputs that are no series".to_owned(),
    };
    let row = |index: &AggregateIndexRecord| {
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
    let mut table = with_effects(effect_table(result, caption, "factor"), lines().map(row));
    table.columns[OF_ONE_OUTPUT..].iter_mut().for_each(Column::hide);
    Part::Table(Table { printed: places(&order, FACTORS), at_end: true, ..table })
}

/// The indices by the other estimators: a line per output, estimator and factor, group, subset or dummy.
pub(super) fn estimators_csv(result: &ResultFile) -> String {
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
pub(super) fn convergence_csv(result: &ResultFile) -> String {
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
