//! The result file of outputs at the points of SALib.

use serde::{Deserialize, Serialize};

use crate::given::{Column, NoVariance};
use crate::quantity::Unit;
use crate::report::distribution::OutputDistribution;
use crate::report::result::{EstimateRecord, estimate_record};
use crate::salib::{SalibIndex, SalibIndices, SalibLayout};

/// A result at the points of SALib, as described in `docs/exchange-formats.md`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SalibFile {
    /// `"apportion-salib-layout"`.
    pub format: String,
    /// 1.
    pub version: u32,
    /// How the numbers came about.
    pub provenance: SalibProvenance,
    /// The table.
    pub table: SalibTableRecord,
    /// What the indices are of: inputs, or groups of them.
    pub inputs: Vec<String>,
    /// The outputs.
    pub outputs: Vec<SalibOutputRecord>,
    /// What a careful reader should know, in sentences.
    pub notes: Vec<String>,
}

/// How the numbers came about.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SalibProvenance {
    /// Version of this program.
    pub apportion_version: String,
    /// What the estimates are.
    pub estimators: Vec<String>,
    /// What the intervals are; `null` if there are none.
    pub interval: Option<String>,
    /// Resamples of the bootstrap.
    pub resamples: u64,
    /// Its seed.
    pub seed: u64,
}

/// The table that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SalibTableRecord {
    /// Its file, as named by the user.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Its rows.
    pub rows: u64,
    /// `"first-order"` or `"second-order"`.
    pub layout: String,
    /// Rows of a base point.
    pub rows_per_point: u64,
    /// Base points.
    pub base_samples: u64,
    /// Whether the file holds the points, and they are laid out so.
    pub points_checked: bool,
}

/// An output.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SalibOutputRecord {
    /// Its column.
    pub name: String,
    /// Its distribution over all rows.
    pub distribution: Option<OutputDistribution>,
    /// One entry per input or group; `null` if there are no indices.
    pub indices: Option<Vec<SalibIndexRecord>>,
    /// One entry per pair; `null` without second order.
    pub second_order: Option<Vec<SalibPairRecord>>,
    /// Why there are no indices.
    pub reason: Option<String>,
}

/// The indices of one input or group.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SalibIndexRecord {
    /// Its name.
    pub input: String,
    /// S1.
    pub first_order: EstimateRecord,
    /// ST.
    pub total: EstimateRecord,
}

/// The second-order index of a pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SalibPairRecord {
    /// Both names.
    pub inputs: (String, String),
    /// S2.
    pub second_order: EstimateRecord,
}

/// What the result says besides the indices.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SalibFacts {
    /// The table's file, as named by the user.
    pub file: String,
    /// Its SHA-256.
    pub sha256: String,
    /// The layout.
    pub layout: SalibLayout,
    /// Whether the points were checked.
    pub points_checked: bool,
    /// Resamples and seed of the bootstrap.
    pub bootstrap: (usize, u64),
}

/// The result file for the `outputs` with their indices of `inputs`.
pub fn build_salib(
    inputs: &[String],
    outputs: &[(Column, Result<SalibIndices, NoVariance>)],
    facts: &SalibFacts,
) -> SalibFile {
    let rows = outputs.first().map_or(0, |(column, _)| column.values.len());
    let step = facts.layout.rows_per_point(inputs.len());
    let (resamples, seed) = facts.bootstrap;
    let second = (facts.layout == SalibLayout::SecondOrder).then(|| "second order: Saltelli 2002".to_owned());
    let estimators = ["first order: Saltelli 2010", "total: Jansen 1999"].map(str::to_owned);
    let interval = "95 %, percentiles of a bootstrap over base points: for random points; too wide for Sobol' points";
    let mut notes = vec![
        "indices are those of SALib's analyze.sobol; its intervals (S1_conf, ST_conf, S2_conf) are drawn at random and \
         are not repeated here"
            .to_owned(),
    ];
    if !facts.points_checked {
        notes.push("the file holds no points: its rows are taken in the order in which SALib makes them".to_owned());
    }
    SalibFile {
        format: "apportion-salib-layout".to_owned(),
        version: 1,
        provenance: SalibProvenance {
            apportion_version: env!("CARGO_PKG_VERSION").to_owned(),
            estimators: estimators.into_iter().chain(second).collect(),
            interval: (resamples > 1).then(|| interval.to_owned()),
            resamples: resamples as u64,
            seed,
        },
        table: SalibTableRecord {
            file: facts.file.clone(),
            sha256: facts.sha256.clone(),
            rows: rows as u64,
            layout: facts.layout.name().to_owned(),
            rows_per_point: step as u64,
            base_samples: (rows / step) as u64,
            points_checked: facts.points_checked,
        },
        inputs: inputs.to_vec(),
        outputs: outputs.iter().map(|(column, indices)| output_record(inputs, column, indices)).collect(),
        notes,
    }
}

fn output_record(inputs: &[String], column: &Column, indices: &Result<SalibIndices, NoVariance>) -> SalibOutputRecord {
    let index = |(input, index): (&String, &SalibIndex)| SalibIndexRecord {
        input: input.clone(),
        first_order: estimate_record(index.first_order),
        total: estimate_record(index.total),
    };
    let pairs = |indices: &SalibIndices| {
        let pair = |pair: &crate::salib::PairIndex| SalibPairRecord {
            inputs: (inputs[pair.pair.0].clone(), inputs[pair.pair.1].clone()),
            second_order: estimate_record(pair.second_order),
        };
        (!indices.pairs.is_empty()).then(|| indices.pairs.iter().map(pair).collect())
    };
    let known = indices.as_ref();
    SalibOutputRecord {
        name: column.name.clone(),
        distribution: OutputDistribution::of(&column.values, &Unit::dimensionless()).ok(),
        indices: known.ok().map(|known| inputs.iter().zip(&known.indices).map(index).collect()),
        second_order: known.ok().and_then(pairs),
        reason: known.err().map(ToString::to_string),
    }
}
