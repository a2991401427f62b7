//! Morris's measures from the elementary effects of one factor on one output.

use serde::{Deserialize, Serialize};

use crate::uncertainty::{Estimate, jackknife};
use apportion_base::sum::{centred_product, mean};

/// The interpretation of sigma / mu* (Garcia Sanchez, Lacarriere, Musy and Bourges 2014, Energy and Buildings 68,
/// 741-750).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reading {
    /// Below 0.1: almost linear.
    Linear,
    /// From 0.1 to 0.5: monotone.
    Monotone,
    /// From 0.5 to 1: almost monotone.
    AlmostMonotone,
    /// From 1: non-linear, not monotone, or interacting with other factors.
    NonLinearOrInteracting,
}

impl Reading {
    /// All variants, in ascending order of sigma / mu*.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Monotone, Self::AlmostMonotone, Self::NonLinearOrInteracting];

    /// Returns the reading of a ratio sigma / mu*.
    pub(super) fn from_ratio(ratio: f64) -> Self {
        match ratio {
            r if r < 0.1 => Self::Linear,
            r if r < 0.5 => Self::Monotone,
            r if r < 1.0 => Self::AlmostMonotone,
            _ => Self::NonLinearOrInteracting,
        }
    }

    /// Returns its description.
    pub fn words(self) -> &'static str {
        match self {
            Self::Linear => "almost linear",
            Self::Monotone => "monotone",
            Self::AlmostMonotone => "almost monotone",
            Self::NonLinearOrInteracting => "non-linear or interacting",
        }
    }
}

/// Computes mu (the mean of the elementary effects, Morris 1991), mu* (that of their absolute values, Campolongo,
/// Cariboni and Saltelli 2007), sigma (their standard deviation, with n - 1) and sigma / mu*, which is not finite if mu*
/// is 0, from `effects` (NaN if missing), which consist of `parts` independent parts of equal length; `None` with fewer
/// than two effects, or if they overflow.
///
/// Intervals are the delete-one jackknife over the parts with Student's t, for mu and mu* the classical t-interval of a
/// mean if no effect is missing; there is none if leaving out a part leaves too few effects.
pub(super) fn measures(effects: &[f64], parts: usize) -> Option<[Estimate; 4]> {
    let estimates = quantities(effects.iter().copied())?;
    let part = effects.len() / parts.max(1);
    let rests = (0..parts).map(|p| effects[..p * part].iter().chain(&effects[(p + 1) * part..]).copied());
    let without_parts: Option<Vec<_>> = rests.map(|rest| Some(quantities(rest)?.to_vec())).collect();
    jackknife(&estimates, &without_parts.unwrap_or_default()).try_into().ok()
}

/// Computes mu, mu*, sigma and sigma / mu*, the last NaN if mu* is 0; `None` for too few effects or overflow.
fn quantities(effects: impl Iterator<Item = f64>) -> Option<[f64; 4]> {
    let effects: Vec<f64> = effects.filter(|effect| effect.is_finite()).collect();
    if effects.len() < 2 {
        return None;
    }
    let sizes: Vec<f64> = effects.iter().map(|effect| effect.abs()).collect();
    let (mu, mu_star) = (mean(&effects), mean(&sizes));
    // In units of mu*, so that squares neither underflow nor overflow.
    let ratio = if mu_star > 0.0 {
        let scaled: Vec<f64> = effects.iter().map(|effect| effect / mu_star).collect();
        let centre = mean(&scaled);
        (centred_product((&scaled, centre), (&scaled, centre)) / (effects.len() - 1) as f64).sqrt()
    } else {
        f64::NAN
    };
    let sigma = if mu_star > 0.0 { ratio * mu_star } else { 0.0 };
    [mu, mu_star, sigma].iter().all(|number| number.is_finite()).then_some([mu, mu_star, sigma, ratio])
}
