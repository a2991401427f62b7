//! `apportion models`: lists the models.

use apportion::estimate::{Estimator, FirstOrder, Total};
use apportion::model::{Basis, Choice, Exact, Input, KnownAnswer, KnownFunction};
use apportion_base::names::nearest;
use apportion_files::{ModelKind, Problem, model_guide};
use apportion_report::{significant, table};

use super::print;
use crate::failure::bad_input;

#[derive(clap::Args)]
pub struct Arguments {
    /// Show this model in full: inputs, outputs, choices; for a function its formula, source and exact indices
    name: Option<String>,
    /// List the estimators of indices instead: quantity, cost, source
    #[arg(long, conflicts_with = "name")]
    estimators: bool,
}

pub fn models(arguments: &Arguments) -> anyhow::Result<()> {
    if arguments.estimators {
        return print(&estimators());
    }
    let Some(name) = &arguments.name else { return print(&list()) };
    let kind = find_model(name)?;
    print(&match (model_guide(kind), kind.known) {
        (Some(guide), _) => guide,
        (None, Some(answer)) => function(answer),
        (None, None) => inputs_and_outputs(kind),
    })
}

/// Every estimator with its cost; the sources under the table, since they are long.
fn estimators() -> String {
    const FACTORS: u64 = 8;
    let header = ["estimator", "first order", "total", "runs per base sample", "for d = 8"];
    let mut rows = table(&header, &[0, 1, 2, 3]);
    let mut sources = String::new();
    for estimator in Estimator::ALL {
        let (first_order, total) = estimator.formulas();
        let (count, times) = if estimator.needs_ba() { (2, "2 ") } else { (1, "") };
        let (first, all) = match estimator {
            Estimator::Default => (FirstOrder::default_for(false).name(), Total::default_for(false).name()),
            _ => (first_order.map_or("-", FirstOrder::name), total.map_or("-", Total::name)),
        };
        let cost = (2 + FACTORS * count).to_string();
        rows.add_row([estimator.name(), first, all, &format!("2 + {times}d"), &cost]);
        let named = match (first_order.map(FirstOrder::source), total.map(Total::source)) {
            (Some(first), Some(total)) if first != total => format!("{first}; total: {total}"),
            (Some(source), _) | (None, Some(source)) => source.to_owned(),
            (None, None) => {
                let (first, total) = (FirstOrder::default_for(true), Total::default_for(true));
                format!(
                    "{}; {}. With rows BA, which second order and some estimators need: {} and {}",
                    FirstOrder::SaltelliPooled.source(),
                    Total::JansenPooled.source(),
                    first.name(),
                    total.name()
                )
            }
        };
        sources.push_str(&format!("{}: {named}\n", estimator.name()));
    }
    format!(
        "{rows}\nd is the number of factors, groups, subsets and the dummy. Request estimators in a study with [analysis] estimators = \
         [\"azzini\", \"jansen\"]; the default ones are always included.\n\n{sources}"
    )
}

/// The model of that name, or the names that there are.
pub fn find_model(name: &str) -> anyhow::Result<ModelKind> {
    ModelKind::from_name(name).ok_or_else(|| {
        let names = ModelKind::all().into_iter().map(|kind| kind.name);
        let problem = Problem::UnknownName {
            what: "model",
            name: name.to_owned(),
            nearest: nearest(name, names.clone()),
            expected: names.map(str::to_owned).collect(),
        };
        let help = problem.help().map(|help| format!("\n{help}")).unwrap_or_default();
        bad_input(format!("{problem}{help}"))
    })
}

fn list() -> String {
    let mut models = table(&["model", "inputs", "what it is"], &[0, 2]);
    for kind in ModelKind::all() {
        let inputs = if kind.is_users_own() { "any".to_owned() } else { kind.inputs().len().to_string() };
        models.add_row([kind.name, &inputs, kind.description]);
    }
    format!("{models}\n\n`apportion models NAME` shows one in full.\n")
}

fn inputs_and_outputs(kind: ModelKind) -> String {
    let mut text = format!("{}: {}\n\n", kind.name, kind.description);
    for Choice { key, scope, values } in kind.choices() {
        let scope = if scope.is_empty() { String::new() } else { format!(" ({scope})") };
        text.push_str(&format!("  {key}{scope}: {}\n", values.join(", ")));
    }
    let mut inputs = table(&["factor", "symbol", "nominal", "unit", "must be", "meaning"], &[0, 1, 3, 4, 5]);
    for input in kind.inputs() {
        let (nominal, unit, domain) = (significant(input.nominal), input.unit.to_string(), domain(&input));
        inputs.add_row([&*input.name, &input.symbol, &nominal, &unit, &domain, &input.description]);
    }
    text.push_str(&format!("{inputs}\n"));
    let mut outputs = table(&["output", "unit", "meaning"], &[0, 1, 2]);
    for output in kind.outputs() {
        outputs.add_row([&*output.name, &output.unit.to_string(), &output.description]);
    }
    text.push_str(&format!("{outputs}\n"));
    text
}

fn domain(input: &Input) -> String {
    input.domain.map_or_else(|| "any number".to_owned(), |domain| domain.to_string())
}

fn function(answer: &'static KnownAnswer) -> String {
    let function = answer.default_function();
    let mut text =
        format!("{}: {}\n\n  y = {}\n\n  source: {}\n", answer.name, answer.description, answer.formula, answer.source);
    if !answer.parameters.is_empty() {
        let mut parameters = table(&["[function]", "meaning [default]"], &[0, 1]);
        for parameter in answer.parameters {
            parameters.add_row([parameter.name, parameter.description]);
        }
        text.push_str(&format!("\n{parameters}\n"));
    }
    let mut inputs =
        table(&["factor", "distribution", "mean", "sd", "where no factor", "must be", "meaning"], &[0, 1, 5, 6]);
    for input in function.model_inputs() {
        let Some(law) = &input.distribution else { continue };
        inputs.add_row([
            input.name.clone(),
            law.name().to_owned(),
            significant(law.mean()),
            significant(law.sd()),
            significant(input.nominal),
            domain(&input),
            input.description.clone(),
        ]);
    }
    text.push_str(&format!("\n{inputs}\n{}", exact(&function)));
    text
}

fn exact(function: &KnownFunction) -> String {
    let Exact { mean, variance, indices, basis } = function.exact();
    let basis = match basis {
        Basis::ClosedForm => "by formula".to_owned(),
        Basis::Quadrature { error } => format!("by quadrature, error {error:e} of the variance"),
    };
    let mut text = format!("\nmean {mean}, variance {variance} ({basis})\n");
    let Some(indices) = indices else { return text + "no indices: the variance is 0\n" };
    let mut rows = table(&["factor", "first order S", "total ST"], &[0]);
    for (input, (first, total)) in function.model_inputs().iter().zip(indices.first_order.iter().zip(&indices.total)) {
        rows.add_row([input.name.clone(), significant(*first), significant(*total)]);
    }
    text.push_str(&format!("{rows}\n"));
    text
}
