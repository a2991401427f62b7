//! `--set KEY=VALUE`: changes to a study file from the command line, applied to its text before it is read.

use toml_edit::{DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::error::OverrideProblem;
use crate::model::ModelKind;
use crate::names::nearest;

/// Applies `overrides` in order. A key is a path of names joined by dots; `factor.NAME.KEY` reaches the factor of that
/// name, and `factor.NAME` is all of it: a table takes the place of what it was, a value fixes it. A value is TOML if it reads as
/// TOML, else a string: `afm.friction=hk` needs no quotes.
///
/// `None` if the text is not TOML: the reader will say so, with the place.
pub(super) fn apply(text: &str, overrides: &[String]) -> Result<Option<String>, (String, OverrideProblem)> {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return Ok(None) };
    for text in overrides {
        set(document.as_table_mut(), text).map_err(|problem| (text.clone(), problem))?;
    }
    Ok(Some(document.to_string()))
}

/// Most parts of a key. Those of a study have up to four; tables inside each other by the thousand take the reader's time
/// and stack.
const PARTS: usize = 16;

fn set(root: &mut Table, text: &str) -> Result<(), OverrideProblem> {
    let (key, value) = text.split_once('=').ok_or(OverrideProblem::NoEquals)?;
    let names: Vec<&str> = key.split('.').map(str::trim).collect();
    if names.iter().any(|name| name.is_empty()) {
        return Err(OverrideProblem::EmptyKey(key.trim().to_owned()));
    }
    if names.len() > PARTS {
        return Err(OverrideProblem::TooDeep(names.len()));
    }
    let value = value.trim();
    let value: Value = value.parse().unwrap_or_else(|_| Value::from(value));
    remove_others(root, &names.join("."));
    match names[..] {
        ["factor" | "factors", factor, ref rest @ ..] if !rest.is_empty() => {
            set_in(find_factor(root, factor)?, rest, value)
        }
        ["factor" | "factors", factor] => match value {
            Value::InlineTable(table) => {
                replace(find_factor(root, factor)?, &table);
                Ok(())
            }
            value => fix(root, factor, value),
        },
        ["outputs"] if root.get("outputs").is_some_and(Item::is_table_like) => Err(OverrideProblem::OutputsTable),
        _ => set_in(root, &names, value),
    }
}

/// Keys that decide the size of a run in different ways, each with those that it takes the place of.
const INSTEAD: [(&str, &[&str]); 5] = [
    (
        "accuracy",
        &["design.base_samples", "design.plain_rows", "design.budget_runs", "design.target", "fidelity.base_samples"],
    ),
    ("design.budget_runs", &["accuracy", "design.base_samples", "design.plain_rows"]),
    ("design.base_samples", &["accuracy", "design.budget_runs"]),
    ("design.plain_rows", &["accuracy", "design.budget_runs"]),
    ("design.target", &["accuracy"]),
];

/// Removes what `key` takes the place of.
fn remove_others(root: &mut Table, key: &str) {
    let others =
        INSTEAD.iter().filter(|(own, _)| key == *own || key.strip_prefix(own).is_some_and(|k| k.starts_with('.')));
    for other in others.flat_map(|(_, others)| *others) {
        match other.split_once('.') {
            Some((table, key)) => {
                root.get_mut(table).and_then(Item::as_table_like_mut).and_then(|table| table.remove(key));
            }
            None => drop(root.remove(other)),
        }
    }
}

fn find_factor<'a>(root: &'a mut Table, name: &str) -> Result<&'a mut dyn TableLike, OverrideProblem> {
    fn factor_name(table: &dyn TableLike) -> Option<&str> {
        table.get("name").and_then(Item::as_str)
    }
    fn named<'a>(tables: impl Iterator<Item = &'a mut dyn TableLike>) -> Vec<(String, &'a mut dyn TableLike)> {
        tables.filter_map(|table| Some((factor_name(table)?.to_owned(), table))).collect()
    }
    let key = if root.contains_key("factor") { "factor" } else { "factors" };
    let mut factors: Vec<(String, &mut dyn TableLike)> = match root.get_mut(key) {
        Some(Item::ArrayOfTables(tables)) => named(tables.iter_mut().map(|table| table as &mut dyn TableLike)),
        Some(Item::Value(Value::Array(values))) => {
            let tables = values.iter_mut().filter_map(Value::as_inline_table_mut);
            named(tables.map(|table| table as &mut dyn TableLike))
        }
        // The only factor, or one table for each by its name.
        Some(item) => match item.as_table_like_mut() {
            Some(table) if factor_name(table).is_some() => named(std::iter::once(table)),
            Some(table) => {
                let entries = table.iter_mut().map(|(name, item)| (name.get().to_owned(), item));
                entries.filter_map(|(name, item)| Some((name, item.as_table_like_mut()?))).collect()
            }
            None => Vec::new(),
        },
        None => Vec::new(),
    };
    let Some(place) = factors.iter().position(|(found, _)| found == name) else {
        let nearest = nearest(name, factors.iter().map(|(name, _)| name.as_str()));
        return Err(OverrideProblem::NoFactor { name: name.to_owned(), nearest });
    };
    Ok(factors.swap_remove(place).1)
}

/// Gives a factor the keys of `table`. It keeps its name.
fn replace(factor: &mut dyn TableLike, table: &InlineTable) {
    let keys: Vec<String> = factor.iter().map(|(key, _)| key.to_owned()).filter(|key| key != "name").collect();
    for key in keys {
        factor.remove(&key);
    }
    for (key, value) in table.iter().filter(|(key, _)| *key != "name") {
        let mut value = value.clone();
        value.decor_mut().clear();
        factor.insert(key, Item::Value(value));
    }
}

/// Takes the factor called `name` out of the study, and gives the input of that name one `value`.
fn fix(root: &mut Table, name: &str, value: Value) -> Result<(), OverrideProblem> {
    find_factor(root, name)?;
    let model = match root.get("model") {
        Some(model) => model.as_str().unwrap_or_default(),
        None if root.contains_key(ModelKind::EXPRESSION.name) => ModelKind::EXPRESSION.name,
        None => ModelKind::DEFAULT.name,
    };
    let path: &[&str] = match ModelKind::from_name(model) {
        Some(kind) if kind == ModelKind::AFM => &[kind.table, name],
        Some(kind) if kind == ModelKind::EXPRESSION => &[kind.table, "constants", name],
        _ => return Err(OverrideProblem::NotFixed { name: name.to_owned(), model: model.to_owned() }),
    };
    let others = dependent_on(root, name);
    if !others.is_empty() {
        return Err(OverrideProblem::Dependent { name: name.to_owned(), others });
    }
    remove_from_subsets(root, name);
    let key = if root.contains_key("factor") { "factor" } else { "factors" };
    let is_named = |table: &dyn TableLike| table.get("name").and_then(Item::as_str) == Some(name);
    match root.get_mut(key) {
        Some(Item::ArrayOfTables(tables)) => tables.retain(|table| !is_named(table)),
        Some(Item::Value(Value::Array(values))) => {
            values.retain(|value| !value.as_inline_table().is_some_and(|table| is_named(table)));
        }
        Some(item) => match item.as_table_like_mut() {
            Some(table) if !is_named(table) => drop(table.remove(name)),
            _ => drop(root.remove(key)),
        },
        None => (),
    }
    // A study without any factor is refused in other words than a factor without a name.
    if root.get(key).and_then(Item::as_table_like).is_some_and(TableLike::is_empty) {
        root.remove(key);
    }
    set_in(root, path, value)
}

/// The factors of `[[dependence]]` tables that hold `name`, other than it.
fn dependent_on(root: &Table, name: &str) -> Vec<String> {
    let tables: Vec<&dyn TableLike> = match root.get("dependence") {
        Some(Item::ArrayOfTables(tables)) => tables.iter().map(|table| table as &dyn TableLike).collect(),
        Some(Item::Value(Value::Array(values))) => {
            values.iter().filter_map(Value::as_inline_table).map(|table| table as &dyn TableLike).collect()
        }
        Some(item) => item.as_table_like().into_iter().collect(),
        None => Vec::new(),
    };
    let names = |table: &dyn TableLike| -> Vec<String> {
        let names = table.get("factors").and_then(Item::as_array);
        names.into_iter().flatten().filter_map(|name| name.as_str().map(str::to_owned)).collect()
    };
    let holding = tables.into_iter().map(names).filter(|names| names.iter().any(|other| other == name));
    holding.flatten().filter(|other| other != name).collect()
}

/// Takes `name` out of the subsets whose indices are asked for. A subset that is left empty, or like another one, goes.
fn remove_from_subsets(root: &mut Table, name: &str) {
    let analysis = root.get_mut("analysis").and_then(Item::as_table_like_mut);
    let Some(subsets) = analysis.and_then(|table| table.get_mut("subsets")).and_then(Item::as_array_mut) else {
        return;
    };
    let mut seen: Vec<Vec<String>> = vec![Vec::new()];
    let is_new: Vec<bool> = subsets
        .iter_mut()
        .map(|subset| {
            let Some(names) = subset.as_array_mut() else { return true };
            names.retain(|other| other.as_str() != Some(name));
            names.fmt();
            let mut left: Vec<String> = names.iter().filter_map(|name| name.as_str().map(str::to_owned)).collect();
            left.sort_unstable();
            let is_new = !seen.contains(&left);
            seen.push(left);
            is_new
        })
        .collect();
    let mut is_new = is_new.into_iter();
    subsets.retain(|_| is_new.next().unwrap_or(true));
    subsets.fmt();
}

fn set_in(table: &mut dyn TableLike, names: &[&str], value: Value) -> Result<(), OverrideProblem> {
    let Some((last, path)) = names.split_last() else { return Ok(()) };
    let mut table = table;
    for name in path {
        let next = table.entry(name).or_insert_with(|| Item::Table(Table::new()));
        table = next.as_table_like_mut().ok_or_else(|| OverrideProblem::NotATable((*name).to_owned()))?;
    }
    table.insert(last, Item::Value(value));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const STUDY: &str =
        "outputs = ['y'] # kept\n[afm]\nfriction = \"coulomb\"\n[[factor]]\nname = \"length\"\nmin = 1\n";

    fn applied(text: &str) -> Result<String, OverrideProblem> {
        let applied = apply(STUDY, &[text.to_owned()]).map_err(|(_, problem)| problem);
        applied.map(|text| text.expect("the study is TOML"))
    }

    #[test]
    fn values_are_replaced_in_place_and_new_ones_added() {
        assert_eq!(applied("afm.friction=hk"), Ok(STUDY.replace("\"coulomb\"", "\"hk\"")));
        assert_eq!(applied("factor.length.min=2.5"), Ok(STUDY.replace("min = 1", "min = 2.5")));
        assert!(applied("design.base_samples = 64").unwrap().contains("[design]\nbase_samples = 64"));
        assert!(applied("outputs=[\"a\", \"b\"]").unwrap().contains("[\"a\", \"b\"]"));
        assert!(applied("afm.preload_angle=0.5 deg").unwrap().contains("preload_angle = \"0.5 deg\""));
    }

    #[test]
    fn a_factor_is_replaced_or_fixed() {
        let replaced = applied("factor.length={ distribution = 'normal', mean = 3, name = 'no' }").unwrap();
        assert!(replaced.ends_with("[[factor]]\nname = \"length\"\ndistribution = 'normal'\nmean = 3\n"), "{replaced}");
        let fixed = applied("factor.length=450 um").unwrap();
        assert_eq!(fixed, "outputs = ['y'] # kept\n[afm]\nfriction = \"coulomb\"\nlength = \"450 um\"\n");
        for text in
            ["[factor.a]\nmin = 1\n[factor.b]\nmin = 2\n", "factors = [{ name = 'a', min = 1 }, { name = 'b' }]\n"]
        {
            let text = format!("model = \"expression\"\n{text}");
            let fixed = apply(&text, &["factor.a=0.5".to_owned()]).unwrap().unwrap();
            assert!(fixed.contains("[expression.constants]\na = 0.5"), "{fixed}");
            assert!(!fixed.contains("min = 1") && fixed.contains('b'), "{fixed}");
        }
        let of_function = apply("model = 'ishigami'\n[factor.x1]\nmin = 0\n", &["factor.x1=0.5".to_owned()]);
        assert!(matches!(of_function, Err((_, OverrideProblem::NotFixed { .. }))));
        assert!(matches!(applied("factor.width=1"), Err(OverrideProblem::NoFactor { .. })));
    }

    #[test]
    fn a_fixed_factor_leaves_the_subsets_and_no_empty_table() {
        let fixed = |text: &str, name: &str| apply(text, &[format!("factor.{name}=1")]);
        let subsets = "model = 'expression'\n[analysis]\nsubsets = [['a', 'b'], ['b'], ['a'], ['b', 'c']]\n\
                       [factors]\na = { min = 1 }\nb = { min = 2 }\n";
        assert!(fixed(subsets, "a").unwrap().unwrap().contains("subsets = [['b'], ['b', 'c']]"));
        let last = fixed("model = 'expression'\n[factors]\na = { min = 1 }\n", "a").unwrap().unwrap();
        assert!(!last.contains("factors"), "{last}");
        for form in ["[[dependence]]\n", "[dependence]\n"] {
            let text =
                format!("model = 'expression'\n[factors]\na = {{}}\nb = {{}}\nc = {{}}\n{form}factors = ['a', 'b']\n");
            let others = vec!["b".to_owned()];
            assert_eq!(fixed(&text, "a").unwrap_err().1, OverrideProblem::Dependent { name: "a".to_owned(), others });
            assert!(fixed(&text, "c").is_ok());
        }
    }

    #[test]
    fn a_factor_is_found_in_every_form() {
        for (text, from, to) in [
            ("[factor.a]\nmin = 1\n[factor.b]\nmin = 2\n", "min = 2", "min = 5"),
            ("[factors]\na = { min = 1 }\nb = { min = 2 }\n", "min = 2", "min = 5"),
            ("factor.a.min = 1\nfactor.b.min = 2\n", "min = 2", "min = 5"),
            ("factors = [{ name = 'b', min = 2 }]\n", "min = 2", "min = 5"),
            ("[factor]\nname = 'b'\nmin = 2\n", "min = 2", "min = 5"),
        ] {
            let applied = apply(text, &["factor.b.min=5".to_owned()]).unwrap();
            assert_eq!(applied.as_deref(), Some(text.replace(from, to).as_str()));
            assert!(matches!(apply(text, &["factor.c.min=5".to_owned()]), Err((_, OverrideProblem::NoFactor { .. }))));
        }
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        assert_eq!(applied("afm.friction"), Err(OverrideProblem::NoEquals));
        let formulas = apply("outputs.y = 'x1'\n", &["outputs=['y']".to_owned()]);
        assert_eq!(formulas.unwrap_err().1, OverrideProblem::OutputsTable);
        assert_eq!(applied("=3"), Err(OverrideProblem::EmptyKey(String::new())));
        assert_eq!(applied("afm.friction.x=3"), Err(OverrideProblem::NotATable("friction".to_owned())));
        // 30,000 parts once took more than a minute.
        let deep = format!("{}=1", ["a"; 30_000].join("."));
        assert_eq!(applied(&deep), Err(OverrideProblem::TooDeep(30_000)));
        let missing = OverrideProblem::NoFactor { name: "lenght".to_owned(), nearest: Some("length".to_owned()) };
        assert_eq!(applied("factor.lenght.min=3"), Err(missing));
    }
}
