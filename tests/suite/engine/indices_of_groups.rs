//! Indices and Shapley effects of groups in place of their factors.

use ::apportion::space::IndicesOf;
use ::apportion::{
    AnalysisOptions, BuildError, Dependence, Distribution, Estimate, Factor, Sampler, Study, SurrogateChoice, Unit,
    function_model,
};

use crate::common::{Folder, effects, succeed, text};
use crate::engine::dependent::{Linear, correlations, shapley};
use crate::messages::messages;

fn factor(name: &str, law: Distribution, group: Option<&str>) -> Factor {
    let mut factor = Factor::new(name, Unit::dimensionless(), law).unwrap();
    factor.group = group.map(str::to_owned);
    factor
}

/// A linear output and the groups of its factors.
struct Grouped {
    linear: Linear,
    /// Of each factor.
    groups: Vec<Option<&'static str>>,
}

impl Grouped {
    /// The groups, and the factors without one, in the order of their first factors.
    fn members(&self) -> Vec<Vec<usize>> {
        let mut members: Vec<Vec<usize>> = Vec::new();
        for (j, group) in self.groups.iter().enumerate() {
            match members.iter_mut().find(|member| group.is_some() && self.groups[member[0]] == *group) {
                Some(member) => member.push(j),
                None => members.push(vec![j]),
            }
        }
        members
    }

    /// From c(u) = E Var(Y | all factors outside the groups u)/V of all sets u of groups, which normal factors have in closed form.
    fn exact(&self) -> Vec<f64> {
        let members = self.members();
        shapley(members.len(), &|mask| {
            let set = (0..members.len()).filter(|member| mask >> member & 1 == 1);
            let factors: Vec<usize> = set.flat_map(|member| members[member].clone()).collect();
            self.linear.total(&factors)
        })
    }

    fn study(&self, base_samples: u64, seed: u64) -> Study {
        let b = self.linear.b.clone();
        let model = function_model("y", move |x: &[f64]| x.iter().zip(&b).map(|(x, b)| b * x).sum());
        let options = AnalysisOptions {
            indices_of: IndicesOf::Groups,
            shapley: Some(true),
            surrogate: SurrogateChoice::Off,
            ..AnalysisOptions::for_sampler(Sampler::Sobol)
        };
        let mut builder = Study::builder("linear", model).base_samples(base_samples).seed(seed).analysis(options);
        let names: Vec<String> = self.linear.all().into_iter().map(|j| format!("x{}", j + 1)).collect();
        for (j, name) in names.iter().enumerate() {
            builder = builder.with_factor(factor(
                name,
                Distribution::normal(3.0, self.linear.sd[j]).unwrap(),
                self.groups[j],
            ));
        }
        if self.linear.r.iter().flatten().any(|r| *r != 0.0 && *r != 1.0) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            builder = builder.dependence(Dependence::new(&names, self.linear.r.clone()));
        }
        builder.build().unwrap()
    }

    /// The effects of the groups, from a run.
    fn found(&self, base_samples: u64, seed: u64) -> Vec<Estimate> {
        let result = self.study(base_samples, seed).run().unwrap();
        effects(result.output("y").unwrap()).iter().map(|effect| effect.shapley.unwrap()).collect()
    }
}

/// Independent factors; tied within a group; tied across groups; both, with a factor that has no group; more of them than
/// have effects by default.
fn cases() -> Vec<Grouped> {
    let (g, h) = (Some("g"), Some("h"));
    let five = |upper: &[f64]| Linear {
        b: vec![1.0, -2.0, 0.5, 0.0, 1.5],
        sd: vec![1.0, 1.0, 3.0, 1.0, 0.5],
        r: correlations(5, upper),
    };
    let groups = || vec![g, h, g, h, None];
    let of = |linear: Linear, groups| Grouped { linear, groups };
    let mut ten = correlations(10, &[0.0; 45]);
    for (i, j, value) in [(0, 1, 0.7), (1, 2, -0.5), (2, 3, 0.3), (5, 6, 0.9), (5, 8, -0.4), (6, 8, -0.2)] {
        (ten[i][j], ten[j][i]) = (value, value);
    }
    let b = vec![1.0, -2.0, 0.5, 1.5, 0.0, 1.0, 1.0, -0.3, 2.0, 0.7];
    let ten = Linear { b, sd: vec![1.0, 1.0, 3.0, 1.0, 0.5, 2.0, 1.0, 1.0, 0.5, 1.0], r: ten };
    vec![
        of(five(&[0.0; 10]), groups()),
        of(five(&[0.0, 0.6, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0]), groups()),
        of(five(&[0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0]), groups()),
        of(five(&[0.5, 0.0, 0.3, 0.0, 0.0, -0.4, 0.0, 0.2, 0.0, 0.6]), groups()),
        of(ten, vec![g, g, h, h, None, None, Some("i"), Some("i"), None, g]),
    ]
}

#[test]
fn linear_outputs_have_closed_forms() {
    for (number, case) in cases().into_iter().enumerate() {
        let exact = case.exact();
        let found = case.found(1 << 12, 1);
        assert_eq!(found.len(), exact.len());
        for (found, exact) in found.iter().zip(&exact) {
            assert!((found.estimate - exact).abs() < 6e-3, "case {number}: {found:?}, {exact}");
        }
        let sum: f64 = found.iter().map(|effect| effect.estimate).sum();
        assert!((sum - 1.0).abs() < 1e-12, "case {number}: {sum}");
    }
    // Of independent factors and an additive output, the effect of a group is the sum of those of its factors.
    let (exact, parts) = (cases()[0].exact(), [1.0, 4.0, 2.25, 0.0, 0.5625]);
    let all: f64 = parts.iter().sum();
    for (exact, part) in exact.iter().zip([parts[0] + parts[2], parts[1] + parts[3], parts[4]]) {
        assert!((exact - part / all).abs() < 1e-14);
    }
}

/// The product of a, b and c, of which a and b are a group, with indices of factors or groups.
fn product(indices_of: IndicesOf, options: AnalysisOptions) -> Study {
    let model = function_model("y", |x: &[f64]| x[0] * x[1] * x[2]);
    let mut builder = Study::builder("product", model).base_samples(1 << 12);
    for (name, group) in [("a", Some("g")), ("b", Some("g")), ("c", None)] {
        builder = builder.with_factor(factor(name, Distribution::uniform(-1.0, 2.0).unwrap(), group));
    }
    builder.analysis(AnalysisOptions { indices_of, ..options }).build().unwrap()
}

/// The plain indices of a group are the same numbers as in addition to those of its factors, from fewer runs.
#[test]
fn groups_in_place_of_factors_have_their_joint_indices() {
    let options = AnalysisOptions { surrogate: SurrogateChoice::Off, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    let [alone, all] = [IndicesOf::Groups, IndicesOf::Factors].map(|of| product(of, options.clone()));
    assert_eq!([&alone, &all].map(|study| study.design().rows_per_point()), [2 + 2, 2 + 3 + 1]);
    let [alone, all] = [alone, all].map(|study| study.run().unwrap());
    let [alone, all] = [&alone, &all].map(|result| result.output("y").unwrap());
    assert_eq!(effects(alone).len(), 2);
    let pairs =
        [(alone.factor("g").unwrap(), all.group("g").unwrap()), (alone.factor("c").unwrap(), all.factor("c").unwrap())];
    for (alone, all) in pairs {
        assert_eq!(
            [alone.first_order.estimate, alone.total.estimate],
            [all.first_order, all.total].map(|of| of.estimate)
        );
    }
}

/// With m = 1/2 and v = 3/4 of every factor, E x^2 = 1: V(a b) = 1 - m^4, and the interaction of g and c is V(a b) v.
#[test]
fn interactions_of_groups_are_known_exactly() {
    let [m, v] = [0.5f64, 0.75];
    let of_g = 1.0 - m.powi(4);
    let (first, joint) = ([of_g * m * m, v * m.powi(4)], of_g * v);
    let variance = 1.0 - m.powi(6);
    for (surrogate, bound) in [(SurrogateChoice::Off, 0.01), (SurrogateChoice::On, 1e-6)] {
        let options = AnalysisOptions { second_order: true, surrogate, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
        let result = product(IndicesOf::Groups, options).run().unwrap();
        let output = result.output("y").unwrap();
        for (effect, first) in effects(output).iter().zip(first) {
            assert!((effect.first_order.estimate - first / variance).abs() < bound, "{effect:?}");
            assert!((effect.total.estimate - (first + joint) / variance).abs() < bound, "{effect:?}");
        }
        let [pair] = &output.second_order.as_ref().unwrap()[..] else { panic!("one pair of two") };
        assert_eq!(pair.factors, ["g", "c"]);
        assert!((pair.index.estimate - joint / variance).abs() < bound, "{pair:?}");
    }
}

/// Two groups divide their interaction equally, for any number of factors in them; single factors would not.
#[test]
fn a_group_counts_once() {
    let options = AnalysisOptions { shapley: Some(true), ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    let result = product(IndicesOf::Groups, options.clone()).run().unwrap();
    let [g, c] =
        effects(result.output("y").unwrap()).iter().map(|effect| effect.shapley.unwrap()).collect::<Vec<_>>()[..]
    else {
        panic!("two groups")
    };
    // S_g + S_gc/2 and S_c + S_gc/2.
    assert!((g.estimate - (0.234_375 + 0.703_125 / 2.0) / 0.984_375).abs() < 0.01, "{g:?}");
    assert!((g.estimate + c.estimate - 1.0).abs() < 1e-12);
    let result = product(IndicesOf::Factors, options).run().unwrap();
    assert!(result.output("y").unwrap().group("g").unwrap().shapley.is_none());
}

/// Groups of one factor each are those factors, to the last bit.
#[test]
fn groups_of_one_are_their_factors() {
    let mut case = cases().swap_remove(3);
    case.groups = vec![Some("a"), Some("b"), Some("c"), Some("d"), Some("e")];
    let of_groups = case.found(256, 3);
    let options = AnalysisOptions {
        shapley: Some(true),
        surrogate: SurrogateChoice::Off,
        ..AnalysisOptions::for_sampler(Sampler::Sobol)
    };
    let analysis = case.linear.study_with(256, 3, options).run().unwrap();
    let factors = effects(analysis.output("y").unwrap());
    let of_factors: Vec<f64> = factors.iter().map(|factor| factor.shapley.unwrap().estimate).collect();
    let of_groups: Vec<f64> = of_groups.iter().map(|effect| effect.estimate).collect();
    assert_eq!(of_groups, of_factors);
}

/// Share of 95 % intervals that contain the exact value; more seeds with `SEEDS=200 cargo test --release --test suite -- --nocapture
/// intervals_of_groups`.
#[test]
fn intervals_of_groups_hold_the_truth() {
    let seeds: u64 = std::env::var("SEEDS").map_or(25, |seeds| seeds.parse().unwrap());
    for base_samples in [256, 1024] {
        let (mut held, mut all) = (0, 0);
        for case in cases() {
            let exact = case.exact();
            for seed in 0..seeds {
                for (found, exact) in case.found(base_samples, seed).iter().zip(&exact) {
                    let interval = found.interval.unwrap();
                    held += usize::from(interval.low - 1e-12 <= *exact && *exact <= interval.high + 1e-12);
                    all += 1;
                }
            }
        }
        let share = held as f64 / all as f64;
        println!("N = {base_samples}: {share:.3} of {all}");
        assert!(share > 0.88, "N = {base_samples}: {share:.3}");
    }
}

/// Twelve factors in groups of four, three and four, and one without a group.
fn twelve() -> String {
    let group = |k: usize| match k {
        1..=4 => "group = \"load\"\n",
        5..=7 => "group = \"soil\"\n",
        8..=11 => "group = \"shape\"\n",
        _ => "",
    };
    let factor = |k: usize| format!("[[factor]]\nname = \"x{k}\"\nmin = -1\nmax = 2\n{}", group(k));
    "model = \"expression\"\noutputs.y = \"x1 + 2*x2*x6 + x4^2 - x12*x5\"\n[design]\nbase_samples = 512\n\
     [analysis]\nindices_of = \"groups\"\nshapley = true\n"
        .to_owned()
        + &(1..=12).map(factor).collect::<String>()
}

#[test]
fn the_program_describes_groups() {
    let (folder, mut messages) = (Folder::new(), messages!());
    for (kind, dependence) in
        [("plain", ""), ("tied", "[[dependence]]\nfactors = [\"x1\", \"x5\", \"x12\"]\ncorrelation = 0.4\n")]
    {
        let file = folder.with(&format!("{kind}.toml"), twelve() + dependence);
        let out = folder.path(kind);
        messages.add_printed(&format!("check {kind}"), &succeed(&["check", text(&file)]));
        messages.add_printed(&format!("run {kind}"), &succeed(&["run", text(&file), "--out", text(&out)]));
        let json: serde_json::Value =
            serde_json::from_slice(&std::fs::read(out.join(format!("{kind}.json"))).unwrap()).unwrap();
        let output = &json["outputs"][0];
        let indices = output["indices"].as_array().unwrap();
        let names: Vec<&str> = indices.iter().map(|index| index["factor"].as_str().unwrap()).collect();
        assert_eq!(names, ["load", "soil", "shape", "x12"]);
        let sum: f64 = indices.iter().map(|index| index["shapley"]["estimate"].as_f64().unwrap()).sum();
        assert!((sum - 1.0).abs() < 1e-12 && indices[1]["shapley"]["low"].is_number());
        let idle = &indices[2]["shapley"];
        assert!(idle["estimate"].as_f64().unwrap().abs() < 0.05, "nothing of the shape is in the formula: {idle}");
        let lines = std::fs::read_to_string(out.join(format!("{kind}.csv"))).unwrap();
        let commas = |line: &str| line.matches(',').count();
        let first = lines.lines().next().unwrap();
        assert!(first.contains("shapley") && lines.lines().all(|line| commas(line) == commas(first)), "{lines}");
        let page = std::fs::read_to_string(out.join(format!("{kind}.html"))).unwrap();
        let again = folder.path(&format!("again-{kind}"));
        succeed(&["report", text(&out.join(format!("{kind}.json"))), "--out", text(&again)]);
        assert_eq!(page, std::fs::read_to_string(again.join(format!("{kind}.html"))).unwrap());
    }
}

#[test]
fn groups_work_for_many_factors_and_invalid_settings_are_refused() {
    let folder = Folder::new();
    let file = folder.with("twelve.toml", twelve());
    let alone: Vec<String> = twelve().lines().filter(|line| !line.starts_with("group")).map(str::to_owned).collect();
    let lone = folder.with("lone.toml", alone.join("\n"));
    let mut messages = messages!();
    for (file, change) in
        [(&file, "analysis.indices_of=\"teams\""), (&file, "noise=\"x13\""), (&lone, "analysis.shapley=true")]
    {
        messages.refused(&["check", text(file), "--set", change]);
    }
    let many = |asked: &str| {
        let factor = |k: usize| format!("[[factor]]\nname = \"x{k}\"\nmin = 0\nmax = 1\ngroup = \"g{}\"\n", k % 8);
        let factors: String = (0..200).map(factor).collect();
        let text =
            format!("model = \"expression\"\noutputs.y = \"x1 + x2\"\ndesign.base_samples = 8\n[analysis]\n{asked}\n");
        folder.with("many.toml", text + &factors)
    };
    messages.refused_as("200 factors", &["check", text(&many("shapley = true"))]);
    messages.add_printed("8 groups", &succeed(&["check", text(&many("indices_of = \"groups\"\nshapley = true"))]));
    let build = |options: AnalysisOptions| {
        let builder = Study::builder("sum", function_model("y", |x: &[f64]| x.iter().sum()));
        builder.factor("x", Distribution::uniform(0.0, 1.0).unwrap()).analysis(options).build().map(|_| ())
    };
    let options = AnalysisOptions { indices_of: IndicesOf::Groups, ..AnalysisOptions::for_sampler(Sampler::Sobol) };
    assert!(matches!(build(options), Err(BuildError::Wrong { key: "indices_of", .. })));
}
