use super::*;
use crate::correction::EstimateWithInfluences;
use crate::design::{DesignSettings, Rows};
use crate::space::Distribution;
use crate::surrogate::stepped::Knot;

/// Returns outputs of every run and point of each replicate of `design`.
fn kept(design: &Design, f: impl Fn(&[f64]) -> f64) -> Vec<PointOutputs> {
    let of_replicate = |replicate: u64| {
        let points = design.points_per_replicate();
        let of_run = |run: u64| -> Vec<f64> {
            let at = |point: u64| {
                let mut u = vec![0.0; design.factors()];
                design.point((replicate * points + point) * design.rows_per_point() + run, &mut u);
                f(&u)
            };
            (0..points).map(at).collect()
        };
        let columns: Vec<Vec<f64>> = (0..design.rows_per_point()).map(of_run).collect();
        PointOutputs::of_block(&columns.iter().map(Vec::as_slice).collect::<Vec<_>>())
    };
    (0..design.settings().replicates).map(of_replicate).collect()
}

#[test]
fn outputs_that_share_their_terms_are_as_accurate_as_alone() {
    let settings = DesignSettings { base_samples: 96, ..DesignSettings::default() };
    let design = Design::new(settings, 3, Rows::plain((0..3).map(|factor| vec![factor]).collect())).unwrap();
    let layout = Layout::plain(3);
    let uniform = Distribution::uniform(0.0, 1.0).unwrap();
    let families = vec![Family::new(&uniform); 3];
    let time = |k: usize| k as f64 / 40.0;
    let outputs: Vec<Vec<PointOutputs>> = (0..40)
        .map(|k| kept(&design, |u| libm::exp(1.0 + u[0] * time(k)) * (1.0 + u[1]) + u[2] * u[2] * (1.0 - time(k))))
        .collect();
    let refs: Vec<Vec<&PointOutputs>> = outputs.iter().map(|of| of.iter().collect()).collect();
    let together = surrogates_together(&design, &families, &layout, &refs, &[None; 40]);
    for (k, (of, together)) in refs.iter().zip(&together).enumerate().step_by(13) {
        let alone = surrogate_estimates(&design, &families, &layout, of, None).unwrap();
        let together = together.as_ref().unwrap();
        assert!(together.explained > 1.0 - 1e-9, "{k}: {} {}", together.explained, alone.explained);
        for (a, b) in alone.effects.iter().zip(&together.effects) {
            let (a, b) = (a.total.estimate, b.total.estimate);
            assert!((a - b).abs() < 1e-6, "{k}: {a} {b}");
        }
    }
    // Up to 32 outputs are fitted one by one, to the same bits.
    let few = surrogates_together(&design, &families, &layout, &refs[..3], &[None; 3]);
    assert_eq!(few[1], surrogate_estimates(&design, &families, &layout, &refs[1], None));
}

#[test]
fn steps_and_kinks_are_located() {
    let settings = DesignSettings { base_samples: 512, ..DesignSettings::default() };
    let design = Design::new(settings, 3, Rows::plain((0..3).map(|factor| vec![factor]).collect())).unwrap();
    let (layout, families) = (Layout::plain(3), vec![Family::Legendre; 3]);
    let estimates = |design: &Design, kept: &[PointOutputs], known: Option<&CrossFitted>| {
        surrogate_estimates(design, &families, &layout, &kept.iter().collect::<Vec<_>>(), known).unwrap()
    };
    let rough = kept(&design, |u| if u[0] > 0.37 { 1.0 + u[1] } else { 0.0 } + 4.0 * (u[2] - 0.6).abs());
    let corrected = estimates(&design, &rough, None);
    // With p = .63: a product of independent parts, and the moments of 4 |u - .6|.
    let p: f64 = 0.63;
    let parts = [p * (1.0 - p) * 2.25, p * p / 12.0, 16.0 * ((0.216 + 0.064) / 3.0 - 0.26 * 0.26)];
    let both = p * (1.0 - p) / 12.0;
    let variance = parts.iter().sum::<f64>() + both;
    for (factor, part) in parts.iter().enumerate() {
        let total = part + if factor < 2 { both } else { 0.0 };
        let error = |of: &EstimateWithInfluences, exact: f64| (of.estimate - exact / variance).abs();
        let errors =
            [error(&corrected.effects[factor].first_order, *part), error(&corrected.effects[factor].total, total)];
        assert!(errors.iter().all(|error| *error < 1e-3), "{factor}: {errors:?}");
    }
    let fitted = corrected.fitted.unwrap();
    let knots_of = |factor: usize| -> Vec<(Knot, f64)> {
        match &fitted.families[factor] {
            Family::Stepped(stepped) => stepped.knots.iter().copied().zip(stepped.widths.clone()).collect(),
            _ => Vec::new(),
        }
    };
    let ([(step, width)], [], kinks) = (&knots_of(0)[..], &knots_of(1)[..], &knots_of(2)[..]) else {
        panic!("{:?}", fitted.families)
    };
    assert!(!step.is_kink && (step.u - 0.37).abs() <= *width, "{step:?}");
    // Some hinges around it are a kink between rows.
    assert!(
        !kinks.is_empty() && kinks.iter().all(|(kink, _)| kink.is_kink && (kink.u - 0.6).abs() < 0.05),
        "{kinks:?}"
    );
    // Some of the rows, by the same surrogates.
    let half = design.with_points(64).unwrap();
    let first: Vec<PointOutputs> = rough.iter().map(|kept| kept.prefix(64)).collect();
    let of_half = estimates(&half, &first, Some(&fitted));
    assert!(of_half.explained > 0.99, "{}", of_half.explained);
    // There are no steps where the output is smooth, and surrogates of few rows are as exact at all, in their own units.
    let smooth = kept(&design, |u| libm::exp(u[0]) * libm::sin(9.0 * u[1]) + u[2]);
    let first: Vec<PointOutputs> = smooth.iter().map(|kept| kept.prefix(64)).collect();
    let fitted = estimates(&half, &first, None).fitted.unwrap();
    assert_eq!(fitted.families, families);
    let of_all = estimates(&design, &smooth, Some(&fitted));
    assert!(of_all.explained > 1.0 - 1e-9 && of_all.growth < 1.1, "{} {}", of_all.explained, of_all.growth);
}
