//! Words of other programs for the names in a study.

use apportion_base::names::nearest;

/// Returns our word, or two of them, for a term of SciPy, SALib, UQLab and everyday language.
fn of_others(term: &str) -> &'static [&'static str] {
    // The compiler refuses a term that is listed twice: one with two meanings would be a guess.
    match term {
        // Keys of a factor.
        "dist" | "distr" | "law" | "type" | "pdf" => &["distribution"],
        "bounds" | "bound" | "range" | "limits" | "interval" => &["min", "max"],
        "low" | "lower" | "lo" | "lb" | "from" | "lower_bound" | "minimum" => &["min"],
        "high" | "upper" | "hi" | "ub" | "to" | "upper_bound" | "maximum" => &["max"],
        "mu" | "average" | "avg" => &["mean"],
        "std" | "sigma" | "stdev" | "stddev" | "std_dev" | "standard_deviation" => &["sd"],
        "loc" => &["location"],
        "peak" | "most_likely" => &["mode"],
        "dof" | "nu" | "degrees_of_freedom" => &["df"],
        "bins" | "bin_edges" | "breaks" => &["edges"],
        "truncated" | "truncation" | "trunc" => &["truncate"],
        "erlang" => &["gamma"],
        "expon" | "exp" => &["exponential"],
        "t" | "student" | "student_t" | "studentt" => &["student-t"],
        "rv_histogram" | "piecewise" | "piecewise-uniform" | "cumulative" | "percentiles" => &["histogram"],
        "pois" => &["poisson"],
        "median" => &["p50"],
        "default" | "reference" => &["nominal"],
        "categories" | "levels" | "choices" => &["labels"],
        "p" => &["probability"],
        // Keys of the design and of the analysis.
        "n" | "samples" | "n_samples" | "nsamples" | "num_samples" | "sample_size" => &["base_samples"],
        "method" | "sampling" | "sequence" => &["sampler"],
        "n_runs" | "evaluations" => &["runs"],
        "max_evaluations" | "max_evals" => &["max_runs"],
        "budget" | "time_limit" => &["max_time"],
        "target" | "half_width" => &["accuracy"],
        "repeats" | "repeat" => &["repetitions"],
        "calc_second_order" | "interactions" => &["second_order"],
        // Samplers.
        "saltelli" | "qmc" | "quasi-random" => &["sobol"],
        "lhs" | "latin_hypercube" => &["latin-hypercube"],
        "mc" | "monte-carlo" | "monte_carlo" => &["random"],
        // Tables and keys of the study itself.
        "parameter" | "parameters" | "params" | "inputs" | "variables" | "variable" | "input" => &["factor"],
        "program" | "executable" | "cmd" | "script" => &["command"],
        "formula" | "formulas" | "expressions" => &["expression"],
        // Distributions.
        "norm" | "gauss" | "gaussian" => &["normal"],
        "unif" | "rectangular" => &["uniform"],
        "lognorm" | "logn" => &["log-normal"],
        "logunif" | "reciprocal" => &["log-uniform"],
        "triang" | "tri" => &["triangular"],
        "truncnorm" | "tnorm" | "truncated normal" => &["truncated-normal"],
        "weibull_min" => &["weibull"],
        "gumbel_r" | "extreme" => &["gumbel"],
        "bool" | "bernoulli" => &["boolean"],
        "int" | "randint" => &["integer"],
        "choice" | "category" => &["categorical"],
        "fixed" | "const" => &["constant"],
        "data" | "measured" => &["empirical"],
        _ => &[],
    }
}

/// Suggests what `name` may mean where only the names `valid` are: the synonym in our words, or the nearest spelling.
/// Two suggested names are joined by "and".
pub(super) fn suggestion_for(name: &str, valid: &[&str]) -> Option<String> {
    let ours = of_others(&name.to_lowercase());
    let is_valid = !ours.is_empty() && ours.iter().all(|name| valid.contains(name));
    if is_valid { Some(ours.join(" and ")) } else { nearest(name, valid.iter().copied()) }
}
