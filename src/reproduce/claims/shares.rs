//! Claims about the shares of the variance: 17 to 20. They rest on the nine studies.

use super::bench::{Bench, Region, closed};
use super::dimensions::NO_EFFECT;
use super::numbers::{change, nano};
use super::{Claim, ClaimsError, Verdict};
use crate::reproduce::order::{Agreement, OrderVerdict, Standing, VISIBLE, order_of, outweighing};
use crate::reproduce::published::{CLOSE, PRINTED};
use crate::reproduce::{FRICTIONS, Friction, GROUPS, Published, Reproduced, named_together, published};
use apportion::afm::{Failure, FrictionLaw, Scene};
use apportion::report::{fixed, give_or_take, share};
use apportion::result::IndexRecord;
use apportion::{EffectEstimates, Estimate};

/// F_cr counts as a product of a function of the dimensions and one of the environment if it is one to this: a
/// thousandth moves no percentage by more than a tenth.
const PRODUCT: f64 = 1e-3;

/// What a percentage in whole numbers may have been before rounding.
const ROUNDED: f64 = 0.5;

pub(super) fn claims(bench: &Bench<'_>, studies: &[Reproduced]) -> Result<Vec<Claim>, ClaimsError> {
    let studies = Studies(studies);
    Ok(vec![
        studies.order(Order {
            number: 17,
            group: "dimensional",
            statement: "Of the dimensions, the thickness has the largest share, then length, width and height.",
            source: "CHK fig. 10, LG fig. 4a",
            figures: &["chk-10", "lg-4a", "dimensional"],
        })?,
        dimensional_percentage(&studies)?,
        most_effective(&studies)?,
        studies.order(Order {
            number: 18,
            group: "environmental",
            statement: "Of the environmental factors, Young's modulus has the largest share, then velocity and adhesion.",
            source: "CHK fig. 15, LG fig. 4b",
            figures: &["chk-15", "lg-4b", "environmental"],
        })?,
        environmental_percentages(bench, &studies)?,
        studies.order(Order {
            number: 19,
            group: "general",
            statement: "Of all factors, the thickness has the largest share, then length, width, Young's modulus, velocity \
                        and adhesion.",
            source: "CHK fig. 16, LG fig. 4c",
            figures: &["chk-16", "lg-4c", "general"],
        })?,
        general_percentages(bench, &studies)?,
        outweigh(&studies)?,
    ])
}

struct Studies<'a>(&'a [Reproduced]);

/// A claim about an order of factors.
struct Order {
    number: usize,
    group: &'static str,
    statement: &'static str,
    source: &'static str,
    figures: &'static [&'static str],
}

impl<'a> Studies<'a> {
    /// The study of a group under a friction model, with its indices.
    fn find(
        &self,
        group: &'static str,
        friction: Friction,
    ) -> Result<(&'a Reproduced, &'a [IndexRecord]), ClaimsError> {
        let missing = ClaimsError::NoIndices { group, friction: friction.name };
        let study = self.0.iter().find(|study| study.group.key == group && study.friction == friction);
        let indices = |study: &'a Reproduced| Some((study, study.result.outputs.first()?.indices.as_deref()?));
        study.and_then(indices).ok_or(missing)
    }

    fn printed(&self, group: &'static str) -> Result<(&'a Reproduced, &'a [IndexRecord]), ClaimsError> {
        let friction = FRICTIONS.into_iter().find(|friction| friction.key == PRINTED);
        self.find(group, friction.ok_or(ClaimsError::NoIndices { group, friction: PRINTED })?)
    }

    fn setting(&self, group: &'static str) -> Result<String, ClaimsError> {
        let (study, _) = self.find(group, FRICTIONS[0])?;
        let provenance = &study.result.provenance;
        let figures = GROUPS.iter().find(|known| known.key == group).map_or("", |known| known.figures);
        Ok(format!(
            "The {group} studies ({figures}), {} base points, sampler {}, seed {}, 95 % intervals;",
            provenance.base_samples, provenance.sampler, provenance.seed
        ))
    }

    /// The first halves of claims 17 to 19.
    fn order(&self, claim: Order) -> Result<Claim, ClaimsError> {
        let mut phrases = Vec::new();
        let mut agreements = Vec::new();
        let mut findings = Vec::new();
        for friction in FRICTIONS {
            let (study, indices) = self.find(claim.group, friction)?;
            let order = order_of(study);
            agreements.push(order.agreement());
            phrases.push((stands(&order), friction.name));
            findings.push(format!("under {} friction {}", friction.name, shares_in_words(indices, &order)));
        }
        let same = agreements.iter().all(|agreement| *agreement == Agreement::Same);
        let each = named_together(phrases).into_iter();
        let each = each.map(|(phrase, names)| format!("{}: {phrase}", names.join(", ")));
        Ok(Claim {
            number: claim.number,
            source: claim.source,
            statement: claim.statement,
            verdict: if same { Verdict::Reproduced } else { Verdict::NotReproduced },
            range: each.collect::<Vec<_>>().join("; "),
            finding: format!(
                "Shares by total index, with those by first order in parentheses: {}.",
                findings.join("; ")
            ),
            setting: format!(
                "{} order by total shares; a factor is before the next where their intervals are apart, and has a visible \
                 share from {VISIBLE} % on.",
                self.setting(claim.group)?
            ),
            figures: claim.figures,
        })
    }
}

/// How an order stands to the published one, in a phrase.
fn stands(order: &OrderVerdict<'_>) -> String {
    let pairs = |wanted| {
        let words = order.pairs_that_are(wanted).into_iter().map(|(one, other)| format!("{one} before {other}"));
        words.collect::<Vec<_>>().join(" and ")
    };
    let phrase = match order.agreement() {
        Agreement::Same => "the whole order".to_owned(),
        Agreement::Beginning => {
            format!("the order as far as there are visible shares, which {} lack", order.unseen.join(" and "))
        }
        Agreement::Undecided => format!("not decided at this sample size: {}", pairs(Standing::Undecided)),
        Agreement::Other => {
            let broken = Some(pairs(Standing::Broken)).filter(|text| !text.is_empty());
            let broken = broken.map(|text| format!("not {text}"));
            let intruders = Some(order.intruders.join(" and ")).filter(|text| !text.is_empty());
            let intruders = intruders.map(|text| format!("a visible share of {text}, which the paper does not rank"));
            format!("another order: {}", broken.into_iter().chain(intruders).collect::<Vec<_>>().join(", "))
        }
    };
    phrase.replace('_', " ")
}

/// The visible total shares with their intervals, the largest first, those by first order in parentheses.
fn shares_in_words(indices: &[IndexRecord], order: &OrderVerdict<'_>) -> String {
    let of = |name: &str| indices.iter().find(|index| index.factor == name);
    let one = |index: &IndexRecord| {
        let first = index.effect.share_first_order.map_or_else(|| "-".to_owned(), |share| fixed(share, 1));
        format!("{} {} % ({first} %)", index.factor.replace('_', " "), share(index.effect.total_percent()))
    };
    let visible: Vec<String> = order.ours.iter().filter_map(|name| of(name)).map(one).collect();
    let rest = match order.unseen[..] {
        [] => String::new(),
        _ => format!(", {} below {VISIBLE} %", order.unseen.join(" and ").replace('_', " ")),
    };
    format!("{}{rest}", visible.join(", "))
}

/// The verdict on printed percentages and under which reading it stands: all have to be ours under one reading.
fn percentages(indices: &[IndexRecord], printed: &Published) -> (Verdict, String) {
    let close = |reading: fn(&EffectEstimates) -> Option<f64>| {
        printed.shares.iter().all(|(factor, percent)| {
            let ours = indices.iter().find(|index| index.factor == *factor).and_then(|index| reading(&index.effect));
            ours.is_some_and(|ours| (ours - percent).abs() <= CLOSE)
        })
    };
    let reading = match (close(|effect| effect.share_first_order), close(|effect| effect.share_total)) {
        (true, true) => "as shares by first-order and by total index",
        (true, false) => "as shares by first-order index, not by total index",
        (false, true) => "as shares by total index, not by first-order index",
        (false, false) => {
            return (Verdict::NotReproduced, "neither as shares by first-order nor by total index".to_owned());
        }
    };
    (Verdict::Reproduced, reading.to_owned())
}

/// The printed percentages beside ours.
fn side_by_side(indices: &[IndexRecord], printed: &Published) -> String {
    let each = printed.shares.iter().filter_map(|(factor, percent)| {
        let effect = &indices.iter().find(|index| index.factor == *factor)?.effect;
        let (first, total) = (fixed(effect.share_first_order?, 1), fixed(effect.share_total?, 1));
        Some(format!("{} {first} and {total} % ({percent} % printed)", factor.replace('_', " ")))
    });
    each.collect::<Vec<_>>().join(", ")
}

/// The setting of claims about percentages.
fn percentage_setting(studies: &Studies<'_>, group: &'static str) -> Result<String, ClaimsError> {
    Ok(format!(
        "{} LuGre friction; percentages are the same if within {CLOSE} percentage point, under one reading for all factors. \
         The paper does not say what its percentages are of.",
        studies.setting(group)?
    ))
}

/// Claim 17, second half.
fn dimensional_percentage(studies: &Studies<'_>) -> Result<Claim, ClaimsError> {
    let (_, indices) = studies.printed("dimensional")?;
    let printed = published("dimensional", PRINTED);
    let (verdict, range) = percentages(indices, &printed);
    Ok(Claim {
        number: 17,
        source: "LG fig. 4a",
        statement: "Under LuGre friction the thickness has a share of 76 % among the dimensions.",
        verdict,
        range,
        finding: format!("Our shares by first order and by total index: {}.", side_by_side(indices, &printed)),
        setting: percentage_setting(studies, "dimensional")?,
        figures: &["lg-4a", "dimensional"],
    })
}

/// Claim 17, what LG's text says of the width. A printed percentage above half is that of the most effective factor.
fn most_effective(studies: &Studies<'_>) -> Result<Claim, ClaimsError> {
    let (study, indices) = studies.printed("dimensional")?;
    let order = order_of(study);
    let most =
        published("dimensional", PRINTED).shares.iter().find(|(factor, percent)| *percent > 50.0 && *factor != "width");
    let verdict = match most {
        Some((factor, percent)) => Verdict::Contradicted { own: format!("{percent} % for the {factor} (LG fig. 4a)") },
        None if order.ours.first() == Some(&"width") => Verdict::Reproduced,
        None => Verdict::NotReproduced,
    };
    Ok(Claim {
        number: 17,
        source: "LG, text",
        statement: "The width is the most effective dimension.",
        verdict,
        range: format!("ours: {}", order.ours.join(" > ")),
        finding: format!(
            "Shares by total index, with those by first-order index in parentheses: {}.",
            shares_in_words(indices, &order)
        ),
        setting: format!("{} LuGre friction.", studies.setting("dimensional")?),
        figures: &["lg-4a", "dimensional"],
    })
}

/// Claim 18, second half.
fn environmental_percentages(bench: &Bench<'_>, studies: &Studies<'_>) -> Result<Claim, ClaimsError> {
    let (_, indices) = studies.printed("environmental")?;
    let printed = published("environmental", PRINTED);
    let percent = |name: &str| printed.share(name).unwrap_or(f64::NAN);
    let (nominal, options) = (Scene::default(), closed(FrictionLaw::LuGre));
    let over = |name: &str| -> Result<f64, ClaimsError> {
        let curve = bench.curve(&bench.over(name)?, &nominal, &options)?;
        Ok((curve.last() - curve.first()).abs())
    };
    let (by_modulus, by_velocity) = (over("elastic_modulus")?, over("velocity")?);
    // Variances of straight lines are to each other as the squares of their rises.
    let needed = by_modulus * (percent("velocity") / percent("elastic_modulus")).sqrt();
    let (verdict, range) = percentages(indices, &printed);
    let visible = needed / bench.force(&nominal, &options)? > NO_EFFECT;
    let verdict = match verdict {
        Verdict::NotReproduced if visible => {
            Verdict::Contradicted { own: "figure 3a, in which the velocity has no effect".to_owned() }
        }
        verdict => verdict,
    };
    Ok(Claim {
        number: 18,
        source: "LG fig. 4b",
        statement: "Under LuGre friction Young's modulus has a share of 74 % and the velocity one of 26 %.",
        verdict,
        range,
        finding: format!(
            "Our shares by first order and by total index: {}. Over its range Young's modulus changes F_cr by {}; for the \
             printed ratio the velocity would have to change it by about {}, and changes it by {}.",
            side_by_side(indices, &printed),
            nano(by_modulus, "N"),
            nano(needed, "N"),
            nano(by_velocity, "N")
        ),
        setting: percentage_setting(studies, "environmental")?,
        figures: &["lg-4b", "environmental"],
    })
}

/// Whether F_cr under LuGre friction is a product of a function of the dimensions and one of the other factors: with the
/// others at the nominal scene, or the dimensions, or both, the product of two forces is that of the other two.
fn is_product(bench: &Bench<'_>) -> Result<bool, Failure> {
    let options = closed(FrictionLaw::LuGre);
    let nominal = Scene::default();
    let force = |scene: &Scene| bench.force(scene, &options);
    let rule = |scene: &Scene| {
        let &Scene { length, width, thickness, height, .. } = scene;
        let dimensions = Scene { length, width, thickness, height, ..nominal };
        let Scene { length, width, thickness, height, .. } = nominal;
        let environment = Scene { length, width, thickness, height, ..*scene };
        let ratio = force(scene)? / force(&dimensions)? * (force(&nominal)? / force(&environment)?);
        Ok((ratio - 1.0).abs() <= PRODUCT)
    };
    Ok(bench.share(Region::General, bench.sizes.points, &rule)?.everywhere())
}

/// Share in percent of the thickness among thickness, length and width, as printed for the general study, and between
/// which values rounding leaves it.
fn thickness_among(printed: &Published) -> (f64, (f64, f64)) {
    let percent = |name: &str| printed.share(name).unwrap_or(0.0);
    let (thickness, others) = (percent("thickness"), percent("length") + percent("width"));
    let share = |by: f64| 100.0 * (thickness + by) / ((thickness + by) + (others - 2.0 * by));
    (share(0.0), (share(-ROUNDED), share(ROUNDED)))
}

/// Claim 19, second half.
fn general_percentages(bench: &Bench<'_>, studies: &Studies<'_>) -> Result<Claim, ClaimsError> {
    let (_, indices) = studies.printed("general")?;
    let printed = published("general", PRINTED);
    let alone = published("dimensional", PRINTED).share("thickness").unwrap_or(f64::NAN);
    let (among, (low, high)) = thickness_among(&printed);
    let product = is_product(bench)?;
    let apart = low > alone + ROUNDED || high < alone - ROUNDED;
    let (verdict, range) = percentages(indices, &printed);
    let verdict = match verdict {
        Verdict::NotReproduced if product && apart => {
            Verdict::Contradicted { own: format!("{alone} % for the thickness among the dimensions (LG fig. 4a)") }
        }
        verdict => verdict,
    };
    let consequence = if product {
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
    Ok(Claim {
        number: 19,
        source: "LG fig. 4c",
        statement: "Under LuGre friction the shares of all factors are 80 % for the thickness, 12 % for the length, 5 % for \
                    the width and 3 % for Young's modulus.",
        verdict,
        range,
        finding: format!(
            "Our shares by first order and by total index: {}. {consequence}.",
            side_by_side(indices, &printed)
        ),
        setting: format!(
            "{} Whether F_cr is a product is asked at {} points of the general study's box.",
            percentage_setting(studies, "general")?,
            bench.sizes.points
        ),
        figures: &["lg-4c", "general", "lg-4a"],
    })
}

/// Claim 20.
fn outweigh(studies: &Studies<'_>) -> Result<Claim, ClaimsError> {
    let mut standings: Vec<(&str, Standing)> = Vec::new();
    let mut findings = Vec::new();
    for friction in FRICTIONS {
        let (study, _) = studies.find("general", friction)?;
        let missing = ClaimsError::NoIndices { group: "general", friction: friction.name };
        let (dimensional, environmental, standing) = outweighing(study).ok_or(missing)?;
        standings.push((friction.name, standing));
        let total = |record: Estimate| give_or_take(record);
        findings.push(format!("{} against {} ({})", total(dimensional), total(environmental), friction.name));
    }
    let all = standings.iter().all(|(_, standing)| *standing == Standing::Kept);
    let word = |standing: &Standing| match standing {
        Standing::Kept => "so",
        Standing::Broken => "the other way round",
        Standing::Undecided | Standing::Unseen => "not decided at this sample size",
    };
    let each = standings.iter().map(|(name, standing)| format!("{name}: {}", word(standing)));
    Ok(Claim {
        number: 20,
        source: "CHK fig. 16, LG fig. 4c",
        statement: "The dimensions of the cantilever outweigh the environment.",
        verdict: if all { Verdict::Reproduced } else { Verdict::NotReproduced },
        range: each.collect::<Vec<_>>().join("; "),
        finding: format!(
            "Total indices of the dimensional against the environmental factors: {}.",
            findings.join(", ")
        ),
        setting: format!(
            "{} each group of four factors by its joint total index; one outweighs the other where the intervals are apart.",
            studies.setting("general")?
        ),
        figures: &["chk-16", "lg-4c", "general"],
    })
}
