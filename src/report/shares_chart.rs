//! The chart of percentages: first-order and total shares of every factor, studies side by side.

use super::chart::{Bar, Chart, GroupedBars, Panel, Role, Series};
use super::format::the;
use super::result::{EffectRecord, IntervalRecord, OutputRecord, ResultFile};

/// One study in a chart of shares.
#[derive(Debug, Clone)]
pub struct SharesSeries<'a> {
    /// Its name in the legend.
    pub name: String,
    /// Its colour.
    pub role: Role,
    /// The output whose shares are drawn.
    pub output: &'a OutputRecord,
    /// Published percentages by factor; they stand in both panels, since their definition is not published.
    pub published: Vec<(&'a str, f64)>,
}

/// The words of a chart of shares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SharesWords {
    /// Headline.
    pub title: String,
    /// One sentence under the chart.
    pub caption: String,
    /// What the legend calls the published percentages; of no account where there are none.
    pub published: &'static str,
}

/// The shares of `factors` in each of `series`: first order on the left, total on the right.
pub fn shares_chart(words: SharesWords, factors: &[&str], series: &[SharesSeries<'_>]) -> Chart {
    let panel = |title: &str, share: ShareOf| Panel {
        title: title.to_owned(),
        categories: factors.iter().map(|factor| label(factor)).collect(),
        series: series.iter().map(|s| chart_series(s, factors, share)).collect(),
    };
    Chart::Bars(GroupedBars {
        title: words.title,
        caption: words.caption,
        y_label: "share of the sum of indices (%)".to_owned(),
        interval_label: "95 % interval".to_owned(),
        published_label: words.published.to_owned(),
        panels: vec![
            panel("First-order indices", |e| (e.share_first_order, e.share_first_order_interval)),
            panel("Total indices", |e| (e.share_total, e.share_total_interval)),
        ],
    })
}

/// The chart of one output of a single study.
pub fn study_chart(result: &ResultFile, output: &OutputRecord) -> Chart {
    let factors: Vec<&str> = result.factors.iter().map(|factor| factor.name.as_str()).collect();
    let friction = result.study.settings.get("friction").and_then(serde_json::Value::as_str);
    let words = SharesWords {
        title: result.study.title.clone().unwrap_or_else(|| result.study.name.clone()),
        caption: caption(output),
        published: "",
    };
    let name = output.name.replace('_', " ");
    let role = friction.map_or(Role::Other(0), friction_role);
    shares_chart(words, &factors, &[SharesSeries { name, role, output, published: Vec::new() }])
}

/// What is seen, in one sentence.
fn caption(output: &OutputRecord) -> String {
    let name = the(&output.name);
    let largest =
        output.indices.iter().flatten().max_by(|a, b| a.effect.total.estimate.total_cmp(&b.effect.total.estimate));
    match (largest, &output.reason) {
        (Some(index), _) => format!(
            "Of all factors, {} has the largest total effect on {name}: its total index is {:.3}.",
            label(&index.factor),
            index.effect.total.estimate
        ),
        (None, Some(reason)) => format!("No shares of {name}: {reason}."),
        (None, None) => format!("No shares of {name}."),
    }
}

/// The fixed colour of a friction law, by its name in study files.
pub fn friction_role(friction: &str) -> Role {
    match friction {
        "coulomb" => Role::Coulomb,
        "hk" => Role::HurtadoKim,
        "lugre" => Role::LuGre,
        _ => Role::Other(0),
    }
}

type ShareOf = fn(&EffectRecord) -> (Option<f64>, Option<IntervalRecord>);

fn chart_series(series: &SharesSeries<'_>, factors: &[&str], share: ShareOf) -> Series {
    let indices = series.output.indices.as_deref().unwrap_or_default();
    let bar = |factor: &&str| {
        let index = indices.iter().find(|index| index.factor == *factor)?;
        let (value, interval) = share(&index.effect);
        Some(Bar { value: value?, interval: interval.map(|i| (i.low, i.high)) })
    };
    let published = |factor: &&str| series.published.iter().find(|(name, _)| name == factor).map(|(_, share)| *share);
    Series {
        name: series.name.clone(),
        role: series.role,
        values: factors.iter().map(bar).collect(),
        published: if series.published.is_empty() { Vec::new() } else { factors.iter().map(published).collect() },
    }
}

/// A factor's name as words.
pub(super) fn label(factor: &str) -> String {
    factor.replace('_', " ")
}
