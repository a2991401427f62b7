//! Whether surrogates are used.

use apportion_base::names::named;
use serde::{Deserialize, Serialize};

named! {
    /// Whether indices are corrected by surrogates: polynomials fitted to the runs, whose indices are exact, so
    /// that the runs only need to estimate the remainder ([`crate::surrogate`]).
    #[derive(Default, Serialize, Deserialize)]
    #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
    #[serde(rename_all = "kebab-case")]
    pub enum SurrogateChoice {
        /// Never.
        Off = "off",
        /// For up to 2^16 rows times outputs, and for programs up to 2^22; for up to 2^20 of fast models if a fit to
        /// some of the rows explains so much that more runs in the time of the correction would gain less.
        #[default]
        Auto = "auto",
        /// For every run whose points are Sobol' nets or random, and whose outputs fit into memory.
        On = "on",
    }
}
