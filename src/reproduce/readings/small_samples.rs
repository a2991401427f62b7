//! What chance does to the percentages of small samples.

use serde::Serialize;

use super::catalogue::{BOTH, SMALL_SAMPLES};
use super::shares::printed;
use super::{Effect, ReadingsError, output_name};
use crate::reproduce::Effort;
use apportion::design::{BasePoints, Design, DesignSettings, Rows, Sampler};
use apportion::estimate::{BlockOutputs, FirstOrder, Moments, Total, Workspace, shares};
use apportion::model::{AfmOutput, Batch, Model, Worker};
use apportion::report::distribution::quantile;
use apportion::run::run_each;
use apportion::study::Study;

/// Probabilities of the quantiles that sum up the repetitions.
pub(super) const QUANTILES: [f64; 5] = [0.025, 0.25, 0.5, 0.75, 0.975];

/// A pair of estimators, as scripts use them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Estimators {
    /// First order by Saltelli et al. (2010), centred; total by Jansen (1999): today's usual pair.
    SaltelliJansen,
    /// First order by Sobol' (1993), total by Homma and Saltelli (1996), neither centred: the pair of scripts that
    /// follow the first papers. Their error grows with the mean of the output against its spread.
    SobolHommaSaltelli,
}

impl Estimators {
    /// Both.
    pub const ALL: [Self; 2] = [Self::SaltelliJansen, Self::SobolHommaSaltelli];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::SaltelliJansen => "saltelli-jansen",
            Self::SobolHommaSaltelli => "sobol-homma-saltelli",
        }
    }

    fn indices(self, moments: &Moments, effect: Effect) -> Vec<f64> {
        let index = |swap| match (self, effect) {
            (Self::SaltelliJansen, Effect::FirstOrder) => FirstOrder::Saltelli2010.estimate(moments, swap),
            (Self::SaltelliJansen, _) => Total::Jansen1999.estimate(moments, swap),
            (Self::SobolHommaSaltelli, Effect::FirstOrder) => FirstOrder::Sobol1993.estimate(moments, swap),
            (Self::SobolHommaSaltelli, _) => Total::HommaSaltelli1996.estimate(moments, swap),
        };
        (0..moments.swaps()).map(index).collect()
    }
}

/// The distribution of the percentages of one study over repetitions with plain random points.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SmallSample {
    /// The version of the study, [`super::Variant::id`].
    pub variant: &'static str,
    /// Which study.
    pub group: &'static str,
    /// Base samples N of each repetition, which takes N (2 + d) model runs for d factors.
    pub base_samples: u64,
    /// The estimators.
    pub estimators: Estimators,
    /// What is shared out, [`Effect::FirstOrder`] or [`Effect::Total`].
    pub effect: Effect,
    /// Of which output.
    #[serde(serialize_with = "output_name")]
    pub output: AfmOutput,
    /// Repetitions.
    pub repetitions: u64,
    /// Those that have percentages: the indices of the others sum to zero or less.
    pub with_shares: u64,
    /// In the order of the study.
    pub factors: Vec<SmallSampleFactor>,
    /// How often all printed percentages of the group are met to 1 percentage point.
    pub within_1: Chance,
    /// The same to 3 percentage points.
    pub within_3: Chance,
}

/// The distribution of one factor's percentage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SmallSampleFactor {
    /// The factor.
    pub factor: String,
    /// Quantiles of probability 0.025, 0.25, 0.5, 0.75 and 0.975; `None` without any repetition that has percentages.
    pub quantiles: Option<[f64; 5]>,
    /// The printed percentage, where there is one.
    pub published: Option<f64>,
    /// The share of the repetitions with a percentage below the printed one, plus half of those equal to it, 0 to 1.
    pub published_quantile: Option<f64>,
}

/// A share of the repetitions with its 95 % interval by Wilson (1927, J. Am. Stat. Assoc. 22, 209-212).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Chance {
    /// Repetitions in which it happened.
    pub count: u64,
    /// Their share of all, 0 to 1.
    pub share: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

impl Chance {
    /// `count` of `all` repetitions, at least one.
    ///
    /// ```
    /// use apportion::reproduce::readings::Chance;
    ///
    /// // None of 1000: the upper bound is about 3.84/1003.84.
    /// let none = Chance::of(0, 1000);
    /// assert_eq!((none.share, none.low), (0.0, 0.0));
    /// assert!((none.high - 0.003_827).abs() < 1e-6);
    /// ```
    pub fn of(count: u64, all: u64) -> Self {
        /// Quantile 0.975 of the standard normal distribution.
        const Z: f64 = 1.959_963_984_540_054;
        let (k, n) = (count as f64, all as f64);
        let (centre, scale) = (k + Z * Z / 2.0, n + Z * Z);
        let half = Z * (k * (n - k) / n + Z * Z / 4.0).sqrt();
        // The bounds at none and at all are 0 and 1 but for rounding.
        let low = if count == 0 { 0.0 } else { (centre - half) / scale };
        let high = if count == all { 1.0 } else { (centre + half) / scale };
        Self { count, share: k / n, low, high }
    }
}

/// The distributions of the percentages of `study`, `variant` and `group` by name, for every sample size, pair of
/// estimators, output and effect. Every repetition has a random stream of its own, and smaller samples are the beginnings
/// of larger ones.
pub(super) fn of_study(
    study: &Study,
    variant: &'static str,
    group: &'static str,
    effort: Effort,
    threads: usize,
) -> Result<Vec<SmallSample>, ReadingsError> {
    let repetitions: u64 = match effort {
        Effort::Full => 1000,
        Effort::Quick => 100,
    };
    let factors = study.space().factors().len();
    let longest = SMALL_SAMPLES.into_iter().max().unwrap_or(0);
    let (sampler, seed) = (Sampler::Random, 0);
    let settings = DesignSettings { sampler, base_samples: longest * repetitions, replicates: repetitions, seed };
    let design = Design::new(settings, factors, Rows::plain((0..factors).map(|factor| vec![factor]).collect()))?;
    let model = study.model();
    let moments: Vec<[SampleMoments; SMALL_SAMPLES.len()]> =
        run_each(model.as_ref(), threads, repetitions, |worker, number| {
            repetition(study, model.as_ref(), worker, &design.replicate(number))
        })?;
    let of_size = |(size, &base_samples): (usize, &u64)| {
        let moments: Vec<&SampleMoments> = moments.iter().map(|sizes| &sizes[size]).collect();
        Sample { study, variant, group, base_samples }.of_moments(&moments)
    };
    Ok(SMALL_SAMPLES.iter().enumerate().flat_map(of_size).collect())
}

/// Moments of one sample, for each of [`BOTH`].
type SampleMoments = [Moments; BOTH.len()];

/// The moments of one repetition at every size of [`SMALL_SAMPLES`].
fn repetition(
    study: &Study,
    model: &dyn Model,
    worker: &mut dyn Worker,
    points: &BasePoints,
) -> [SampleMoments; SMALL_SAMPLES.len()] {
    let factors = study.space().factors();
    let (mut batch, mut work) = (Batch::new(model), Workspace::default());
    let mut so_far = [(); BOTH.len()].map(|()| Moments::empty(factors.len()));
    let mut first = 0;
    SMALL_SAMPLES.map(|size| {
        let length = (size - first) as usize;
        let mut unit = vec![vec![0.0; length]; 2 * factors.len()];
        points.fill(first, &mut unit);
        let mut si = unit.clone();
        for (column, (u, si)) in unit.iter().zip(&mut si).enumerate() {
            factors[column % factors.len()].fill_si(u, si);
        }
        let (a, b) = si.split_at(factors.len());
        let mut run = |swap: Option<usize>, from: &[Vec<f64>]| -> Vec<Vec<f64>> {
            let column = |(number, own)| if Some(number) == swap { &b[number][..] } else { own };
            let inputs: Vec<&[f64]> = from.iter().map(Vec::as_slice).enumerate().map(column).collect();
            batch.reset(length);
            worker.run(&inputs, &mut batch);
            (0..BOTH.len()).map(|output| batch.column(output).to_vec()).collect()
        };
        let (y_a, y_b) = (run(None, a), run(None, b));
        let y_ab: Vec<Vec<Vec<f64>>> = (0..factors.len()).map(|factor| run(Some(factor), a)).collect();
        for (output, moments) in so_far.iter_mut().enumerate() {
            let ab: Vec<&[f64]> = y_ab.iter().map(|outputs| &outputs[output][..]).collect();
            let block = BlockOutputs { a: &y_a[output], b: &y_b[output], ab: &ab, ..BlockOutputs::default() };
            moments.merge(&Moments::of_block(block, &mut work));
        }
        first = size;
        so_far.clone()
    })
}

#[derive(Clone, Copy)]
struct Sample<'a> {
    study: &'a Study,
    variant: &'static str,
    group: &'static str,
    base_samples: u64,
}

impl Sample<'_> {
    /// From the moments of every repetition.
    fn of_moments(self, repetitions: &[&SampleMoments]) -> Vec<SmallSample> {
        let mut samples = Vec::new();
        for estimators in Estimators::ALL {
            for (number, &output) in BOTH.iter().enumerate() {
                for effect in [Effect::FirstOrder, Effect::Total] {
                    let percents: Vec<Vec<f64>> = repetitions
                        .iter()
                        .filter_map(|moments| shares(&estimators.indices(&moments[number], effect)))
                        .collect();
                    samples.push(self.distribution(estimators, output, effect, &percents, repetitions.len() as u64));
                }
            }
        }
        samples
    }

    fn distribution(
        self,
        estimators: Estimators,
        output: AfmOutput,
        effect: Effect,
        percents: &[Vec<f64>],
        repetitions: u64,
    ) -> SmallSample {
        let Self { study, variant, group, base_samples } = self;
        let names: Vec<&str> = study.space().factors().iter().map(|factor| factor.name.as_str()).collect();
        let met = |within: f64| {
            let near = |share: &[f64]| {
                names.iter().zip(share).all(|(name, share)| {
                    printed(group, name).is_none_or(|published| (share - published).abs() <= within)
                })
            };
            Chance::of(percents.iter().filter(|share| near(share)).count() as u64, repetitions)
        };
        let factor = |(number, name): (usize, &&str)| {
            let mut column: Vec<f64> = percents.iter().map(|shares| shares[number]).collect();
            column.sort_unstable_by(f64::total_cmp);
            let published = printed(group, name);
            let place = |published: f64| {
                let (below, up_to) =
                    (column.partition_point(|&x| x < published), column.partition_point(|&x| x <= published));
                (below + up_to) as f64 / 2.0 / column.len() as f64
            };
            let any = !column.is_empty();
            SmallSampleFactor {
                factor: (*name).to_owned(),
                quantiles: any.then(|| QUANTILES.map(|p| quantile(&column, p))),
                published,
                published_quantile: published.filter(|_| any).map(place),
            }
        };
        SmallSample {
            variant,
            group,
            base_samples,
            estimators,
            effect,
            output,
            repetitions,
            with_shares: percents.len() as u64,
            factors: names.iter().enumerate().map(factor).collect(),
            within_1: met(1.0),
            within_3: met(3.0),
        }
    }
}
