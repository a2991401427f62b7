//! Claims about the shares of the variance: 17 to 20. They depend on the nine studies.

use anyhow::anyhow;
use apportion::EffectEstimates;
use apportion::result::Named;
use apportion_afm::{Failure, FrictionLaw, Scene};
use apportion_report::{fixed, give_or_take, share};

use super::context::{ClaimContext, closed};
use super::dimensions::NO_EFFECT;
use super::judge::{Answer, change, nano};
use super::verdict::Verdict;
use crate::reproduce::order::{OrderCheck, OrderVerdict, VISIBLE, order_of, outweighing};
use crate::reproduce::papers::{CLOSE, PRINTED, published};
use crate::reproduce::percentages::thickness_part;
use crate::reproduce::studies::{FRICTIONS, Friction, GROUPS, Reproduced};
use crate::reproduce::words::named_together;

/// Maximum relative deviation of F_cr from a product of a function of the dimensions and one of the environment: a
/// thousandth changes no percentage by more than a tenth.
const PRODUCT: f64 = 1e-3;

/// Share of the box from which on a rule holds everywhere: the rest is a corner that no chart of the papers shows.
const EVERYWHERE: f64 = 0.999;

/// Rounding error of a percentage in whole numbers.
const ROUNDED: f64 = 0.5;

/// Returns the study of a group under a friction model, with its indices.
fn study<'a>(
    context: &ClaimContext<'a>,
    group: &'static str,
    friction: Friction,
) -> anyhow::Result<(&'a Reproduced, &'a [Named<EffectEstimates>])> {
    let study = context.studies.iter().find(|study| study.group.key == group && study.friction == friction);
    let with_indices = study.and_then(|study| Some((study, study.result.outputs.first()?.indices.as_deref()?)));
    with_indices.ok_or_else(|| no_indices(group, friction))
}

fn no_indices(group: &str, friction: Friction) -> anyhow::Error {
    anyhow!("claims 17 to 20 need the {group} study under {} friction, with its indices", friction.name)
}

/// Returns the study of a group whose percentages are printed, with its indices.
fn printed<'a>(
    context: &ClaimContext<'a>,
    group: &'static str,
) -> anyhow::Result<(&'a Reproduced, &'a [Named<EffectEstimates>])> {
    study(context, group, FRICTIONS.into_iter().find(|friction| friction.key == PRINTED).expect("a friction model"))
}

/// Returns the studies of a group and their design.
fn studies(context: &ClaimContext<'_>, group: &'static str) -> anyhow::Result<(&'static str, String)> {
    let (study, _) = study(context, group, FRICTIONS[0])?;
    let provenance = &study.result.provenance;
    let figures = GROUPS.iter().find(|other| other.key == group).map_or("", |other| other.figures);
    let words = format!(
        "The {group} studies ({figures}), {} base points, sampler {}, seed {}, 95 % intervals;",
        provenance.base_samples,
        provenance.sampler.name(),
        provenance.seed
    );
    Ok(("studies", words))
}

/// Checks the first halves of claims 17 to 19: an order of factors.
pub(super) fn order(context: &ClaimContext<'_>, group: &'static str) -> anyhow::Result<Answer> {
    let (mut phrases, mut shares, mut is_same) = (Vec::new(), Vec::new(), true);
    for friction in FRICTIONS {
        let (study, indices) = study(context, group, friction)?;
        let order = order_of(study);
        is_same &= order.is_kept(false);
        phrases.push((verdict_of_order(&order), friction.name));
        shares.push(format!("under {} friction {}", friction.name, shares_in_words(indices, &order)));
    }
    let phrases = named_together(phrases).into_iter();
    let phrases: Vec<String> = phrases.map(|(phrase, names)| format!("{}: {phrase}", names.join(", "))).collect();
    Ok(Answer {
        verdict: Verdict::reproduced_if(is_same),
        range: phrases.join("; "),
        words: vec![("shares", shares.join("; ")), studies(context, group)?, ("visible", VISIBLE.to_string())],
    })
}

/// Says in a phrase how an order agrees with the published one.
fn verdict_of_order(order: &OrderVerdict<'_>) -> String {
    let broken = order.pairs_that_are(OrderCheck::Broken).join(" and ");
    let intruders = order.intruders.join(" and ");
    let of_intruders = format!("a visible share of {intruders}, which the paper does not rank");
    let phrase = match (&*broken, &*intruders) {
        ("", "") if order.is_kept(false) => "the whole order".to_owned(),
        ("", "") if order.is_kept(true) => {
            format!("the order of the visible shares, which {} do not have", order.unseen.join(" and "))
        }
        ("", "") => {
            let pairs = order.pairs_that_are(OrderCheck::Undecided).join(" and ");
            format!("not decided at this sample size: {pairs}")
        }
        ("", _) => format!("another order: {of_intruders}"),
        (_, "") => format!("another order: not {broken}"),
        _ => format!("another order: not {broken}, {of_intruders}"),
    };
    phrase.replace('_', " ")
}

/// Lists the visible total shares with their intervals, the largest first, those by first order in parentheses.
fn shares_in_words(indices: &[Named<EffectEstimates>], order: &OrderVerdict<'_>) -> String {
    let mut visible = Vec::new();
    for name in &order.ours {
        for Named { name: factor, effect, .. } in indices.iter().filter(|index| index.name == *name) {
            let first = effect.share_first_order.map_or_else(|| "-".to_owned(), |share| fixed(share, 1));
            visible.push(format!("{} {} % ({first} %)", factor.replace('_', " "), share(effect.total_percent())));
        }
    }
    let rest = match order.unseen[..] {
        [] => String::new(),
        _ => format!(", {} below {VISIBLE} %", order.unseen.join(" and ").replace('_', " ")),
    };
    format!("{}{rest}", visible.join(", "))
}

/// Checks a claim about printed percentages, such as the second half of claim 17: all must agree with ours under one
/// meaning. A statement of the same paper may contradict the others.
pub(super) fn printed_percentages(
    context: &ClaimContext<'_>,
    group: &'static str,
    contradicted_by: Option<String>,
) -> anyhow::Result<Answer> {
    let (_, indices) = printed(context, group)?;
    let (mut by_first_order, mut by_total, mut shares) = (true, true, Vec::new());
    for (factor, percent) in published(group, PRINTED).shares {
        let effect = indices.iter().find(|index| index.name == *factor).map(|index| index.effect);
        let first_order = effect.and_then(|effect| effect.share_first_order).unwrap_or(f64::NAN);
        let total = effect.and_then(|effect| effect.share_total).unwrap_or(f64::NAN);
        by_first_order &= (first_order - percent).abs() <= CLOSE;
        by_total &= (total - percent).abs() <= CLOSE;
        let (factor, first_order, total) = (factor.replace('_', " "), fixed(first_order, 1), fixed(total, 1));
        shares.push(format!("{factor} {first_order} and {total} % ({percent} % printed)"));
    }
    let range = match (by_first_order, by_total) {
        (true, true) => "as shares by first-order and by total index",
        (true, false) => "as shares by first-order index, not by total index",
        (false, true) => "as shares by total index, not by first-order index",
        (false, false) => "neither as shares by first-order nor by total index",
    };
    let verdict = match (by_first_order || by_total, contradicted_by) {
        (false, Some(by)) => Verdict::Contradicted { by },
        (agrees, _) => Verdict::reproduced_if(agrees),
    };
    let words = vec![("shares", shares.join(", ")), studies(context, group)?, ("close", CLOSE.to_string())];
    Ok(Answer { verdict, range: range.to_owned(), words })
}

/// Checks LG's statement on the width in claim 17. A printed percentage above half is that of the main factor.
pub(super) fn most_effective(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let (study, indices) = printed(context, "dimensional")?;
    let order = order_of(study);
    let printed = published("dimensional", PRINTED);
    let most = printed.shares.iter().find(|(factor, percent)| *percent > 50.0 && *factor != "width");
    Ok(Answer {
        verdict: match most {
            Some((factor, percent)) => {
                Verdict::Contradicted { by: format!("{percent} % for the {factor} (LG fig. 4a)") }
            }
            None => Verdict::reproduced_if(order.ours.first() == Some(&"width")),
        },
        range: format!("ours: {}", order.ours.join(" > ")),
        words: vec![("shares", shares_in_words(indices, &order)), studies(context, "dimensional")?],
    })
}

/// Checks the second half of claim 18.
pub(super) fn environmental_percentages(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let (nominal, options) = (Scene::default(), closed(FrictionLaw::LuGre));
    let [modulus, velocity] = ["elastic_modulus", "velocity"].map(|name| -> Result<_, Failure> {
        let percent = published("environmental", PRINTED).share(name).unwrap_or(f64::NAN);
        let curve = context.curve(&context.over(name), &nominal, &options)?;
        Ok((percent, (curve.last() - curve.first()).abs()))
    });
    let ((modulus_percent, by_modulus), (velocity_percent, by_velocity)) = (modulus?, velocity?);
    // The variances of straight lines have the ratios of the squares of their rises.
    let needed = by_modulus * (velocity_percent / modulus_percent).sqrt();
    let is_visible = needed / context.force(&nominal, &options)? > NO_EFFECT;
    let contradiction = is_visible.then(|| "figure 3a, in which the velocity has no effect".to_owned());
    let mut answer = printed_percentages(context, "environmental", contradiction)?;
    let forces = [("by_modulus", by_modulus), ("needed", needed), ("by_velocity", by_velocity)];
    answer.words.extend(forces.map(|(name, force)| (name, nano(force, "N"))));
    Ok(answer)
}

/// Returns whether F_cr under LuGre friction is a product of a function of the dimensions and one of the others: with
/// the others at the nominal scene, or the dimensions, or both, the product of two forces equals that of the other two.
fn is_product(context: &ClaimContext<'_>) -> Result<bool, Failure> {
    let options = closed(FrictionLaw::LuGre);
    let nominal = Scene::default();
    let share = context.share(None, context.sizes.points, |scene| {
        let &Scene { length, width, thickness, height, .. } = scene;
        let dimensions = Scene { length, width, thickness, height, ..nominal };
        let Scene { length, width, thickness, height, .. } = nominal;
        let environment = Scene { length, width, thickness, height, ..*scene };
        let by_environment = context.force(scene, &options)? / context.force(&dimensions, &options)?;
        let ratio = by_environment * (context.force(&nominal, &options)? / context.force(&environment, &options)?);
        Ok((ratio - 1.0).abs() <= PRODUCT)
    })?;
    Ok(share.value >= EVERYWHERE)
}

/// Checks the second half of claim 19.
pub(super) fn general_percentages(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let alone = published("dimensional", PRINTED).share("thickness").unwrap_or(f64::NAN);
    // As printed for the general study, and its bounds by rounding.
    let printed = published("general", PRINTED);
    let [among, low, high] = [0.0, -ROUNDED, ROUNDED].map(|by| {
        thickness_part(|factor| Some(printed.share(factor)? + if factor == "thickness" { by } else { -by }))
            .unwrap_or(f64::NAN)
    });
    let is_product = is_product(context)?;
    let is_apart = low > alone + ROUNDED || high < alone - ROUNDED;
    let contradiction = format!("{alone} % for the thickness among the dimensions (LG fig. 4a)");
    let consequence = if is_product {
        format!(
            "F_cr is a product of a function of the dimensions and one of the other factors, to {} of it, so that the share \
             of the thickness among thickness, length and width must be that of the dimensional study: printed are {} % \
             ({} to {} % before rounding) and {alone} %",
            change(PRODUCT),
            fixed(among, 1),
            fixed(low, 1),
            fixed(high, 1)
        )
    } else {
        "F_cr is not a product of a function of the dimensions and one of the other factors".to_owned()
    };
    let mut answer = printed_percentages(context, "general", (is_product && is_apart).then_some(contradiction))?;
    answer.words.push(("consequence", consequence));
    Ok(answer)
}

/// Checks claim 20.
pub(super) fn outweigh(context: &ClaimContext<'_>) -> anyhow::Result<Answer> {
    let (mut holds, mut each, mut totals) = (true, Vec::new(), Vec::new());
    for friction in FRICTIONS {
        let (study, _) = study(context, "general", friction)?;
        let (dimensional, environmental, check) = outweighing(study).ok_or_else(|| no_indices("general", friction))?;
        holds &= check == OrderCheck::Kept;
        let word = match check {
            OrderCheck::Kept => "so",
            OrderCheck::Broken => "the other way round",
            OrderCheck::Undecided | OrderCheck::Unseen => "not decided at this sample size",
        };
        each.push(format!("{}: {word}", friction.name));
        let [ours, others] = [dimensional, environmental].map(give_or_take);
        totals.push(format!("{ours} against {others} ({})", friction.name));
    }
    Ok(Answer {
        verdict: Verdict::reproduced_if(holds),
        range: each.join("; "),
        words: vec![("totals", totals.join(", ")), studies(context, "general")?],
    })
}
