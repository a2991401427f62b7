//! Words of other programs for the names in a study.

use apportion::names::nearest;

/// Our word, or two of them, and the terms of SciPy, SALib, UQLab and everyday language.
const SYNONYMS: [(&[&str], &[&str]); 47] = [
    // Keys of a factor.
    (&["distribution"], &["dist", "distr", "law", "type", "pdf"]),
    (&["min", "max"], &["bounds", "bound", "range", "limits", "interval"]),
    (&["min"], &["low", "lower", "lo", "lb", "from", "lower_bound", "minimum"]),
    (&["max"], &["high", "upper", "hi", "ub", "to", "upper_bound", "maximum"]),
    (&["mean"], &["mu", "average", "avg"]),
    (&["sd"], &["std", "sigma", "stdev", "stddev", "std_dev", "standard_deviation"]),
    (&["location"], &["loc"]),
    (&["mode"], &["peak", "most_likely"]),
    (&["df"], &["dof", "nu", "degrees_of_freedom"]),
    (&["edges"], &["bins", "bin_edges", "breaks"]),
    (&["truncate"], &["truncated", "truncation", "trunc"]),
    (&["gamma"], &["erlang"]),
    (&["exponential"], &["expon", "exp"]),
    (&["student-t"], &["t", "student", "student_t", "studentt"]),
    (&["histogram"], &["rv_histogram", "piecewise", "piecewise-uniform", "cumulative", "percentiles"]),
    (&["poisson"], &["pois"]),
    (&["p50"], &["median"]),
    (&["nominal"], &["default", "reference"]),
    (&["labels"], &["categories", "levels", "choices"]),
    (&["probability"], &["p"]),
    // Keys of the design and of the analysis.
    (&["base_samples"], &["n", "samples", "n_samples", "nsamples", "num_samples", "sample_size"]),
    (&["sampler"], &["method", "sampling", "sequence"]),
    (&["runs"], &["budget_runs", "plain_rows", "n_runs", "evaluations"]),
    (&["max_runs"], &["max_evaluations", "max_evals"]),
    (&["max_time"], &["budget", "time_limit"]),
    (&["accuracy"], &["target", "half_width"]),
    (&["repetitions"], &["repeats", "repeat"]),
    (&["second_order"], &["calc_second_order", "interactions"]),
    // Samplers.
    (&["sobol"], &["saltelli", "qmc", "quasi-random"]),
    (&["latin-hypercube"], &["lhs", "latin_hypercube"]),
    (&["random"], &["mc", "monte-carlo", "monte_carlo"]),
    // Tables and keys of the study itself.
    (&["factor"], &["parameter", "parameters", "params", "inputs", "variables", "variable", "input"]),
    (&["command"], &["program", "executable", "cmd", "script"]),
    (&["expression"], &["formula", "formulas", "expressions"]),
    // Distributions.
    (&["normal"], &["norm", "gauss", "gaussian"]),
    (&["uniform"], &["unif", "rectangular"]),
    (&["log-normal"], &["lognorm", "logn"]),
    (&["log-uniform"], &["logunif", "reciprocal"]),
    (&["triangular"], &["triang", "tri"]),
    (&["truncated-normal"], &["truncnorm", "tnorm", "truncated normal"]),
    (&["weibull"], &["weibull_min"]),
    (&["gumbel"], &["gumbel_r", "extreme"]),
    (&["boolean"], &["bool", "bernoulli"]),
    (&["integer"], &["int", "randint"]),
    (&["categorical"], &["choice", "category"]),
    (&["constant"], &["fixed", "const"]),
    (&["empirical"], &["data", "measured"]),
];

/// Suggests what `name` may mean where only `known` names are valid: the synonym in our words, or the nearest spelling.
/// Two suggested names are joined by "and".
pub(in crate::study) fn meant<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let known: Vec<&str> = known.into_iter().collect();
    let word = name.to_lowercase();
    let ours = SYNONYMS.iter().filter(|(_, words)| words.contains(&word.as_str()));
    let ours = ours.map(|(ours, _)| ours).find(|ours| ours.iter().all(|name| known.contains(name)));
    ours.map(|ours| ours.join(" and ")).or_else(|| nearest(name, known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_other_programs_are_known_where_the_keyword_is_allowed() {
        let factor = ["name", "distribution", "min", "max", "mean", "sd"];
        assert_eq!(meant("dist", factor).as_deref(), Some("distribution"));
        assert_eq!(meant("sigma", factor).as_deref(), Some("sd"));
        assert_eq!(meant("bounds", factor).as_deref(), Some("min and max"));
        assert_eq!(meant("N", ["sampler", "base_samples"]).as_deref(), Some("base_samples"));
        assert_eq!(meant("norm", ["uniform", "normal"]).as_deref(), Some("normal"));
        assert_eq!(meant("lhs", ["sobol", "latin-hypercube"]).as_deref(), Some("latin-hypercube"));
        assert_eq!(meant("N", factor), None);
        assert_eq!(meant("mim", factor).as_deref(), Some("min"));
    }

    /// A word with two meanings at one position would be a guess.
    #[test]
    fn no_word_is_listed_twice() {
        let mut words: Vec<&str> = SYNONYMS.iter().flat_map(|(_, words)| words.iter().copied()).collect();
        let all = words.len();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), all);
    }
}
