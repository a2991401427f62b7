//! The claims of the papers: verdicts, where they hold, and their numbers.

use std::collections::BTreeMap;

use apportion::design::SobolSequence;
use apportion_afm::{FrictionLaw, Options, Parameter, Scene, critical_force};
use serde_json::Value;

use super::{FEW, QUICK, Reproduction};
use crate::common::study_path;

/// Every claim with its verdict. A change of the physics that affects the claims changes this.
#[test]
fn the_verdicts_are_those_reviewed() {
    let claims = QUICK.claims();
    let line = |claim: &csv::StringRecord| format!("{} {}: {}", &claim[0], &claim[1], &claim[3]);
    insta::assert_snapshot!(claims.iter().map(line).collect::<Vec<_>>().join("\n"));
    for claim in &claims {
        let [statement, finding, setting] = [&claim[2], &claim[6], &claim[7]];
        assert!(
            [statement, finding, setting]
                .iter()
                .all(|text| text.ends_with('.') && !text.contains("NaN") && !text.contains(['{', '}'])),
            "{claim:?}"
        );
        assert!(!claim[8].is_empty());
    }
    let json = QUICK.json("claims.json");
    assert_eq!(json["format"], "apportion-claims");
    for (place, verdict) in [(17, "reproduced"), (18, "not-reproduced"), (19, "contradicted")] {
        let claim = &json["claims"][place];
        assert_eq!((claim["verdict"].as_str(), claim.get("own").is_some()), (Some(verdict), verdict == "contradicted"));
    }
}

/// Every claim with the part of the box where it holds, and those on the physics with their numbers: what a verdict is made of.
/// Numbers that are rounding, or the error of a solver, are left out.
#[test]
fn the_findings_are_those_reviewed() {
    let is_error = |word: &str| word.parse::<f64>().is_ok_and(|number| number.abs() < 1e-5 && word.contains('e'));
    let lasting = |text: &str| {
        let words = text.split(' ').map(|word| if is_error(word) { "#" } else { word });
        words.collect::<Vec<_>>().join(" ")
    };
    let line = |claim: &csv::StringRecord| {
        let is_physics = claim[0].parse::<u32>().unwrap() <= 16;
        let finding = if is_physics { format!("\n    {}", lasting(&claim[6])) } else { String::new() };
        format!("{} {}: {}{finding}", &claim[0], &claim[1], &claim[5])
    };
    insta::assert_snapshot!(QUICK.claims().iter().map(line).collect::<Vec<_>>().join("\n"));
}

/// The first claim with this number.
fn claim(found: &Reproduction, number: &str) -> csv::StringRecord {
    found.claims().into_iter().find(|claim| &claim[0] == number).unwrap()
}

fn force(scene: &Scene, friction: FrictionLaw) -> f64 {
    critical_force(scene, &Options { friction, ..Options::default() }).unwrap().critical_force
}

/// A claim is reproduced if it holds at the scene of the paper's figure, even if it does not on most of the box.
#[test]
fn verdicts_use_the_scene_of_the_paper_and_ranges_the_box() {
    let is_less = |scene: &Scene| force(scene, FrictionLaw::HurtadoKim) < force(scene, FrictionLaw::Coulomb);
    let claim = claim(&QUICK, "7");
    assert!(is_less(&Scene::default()) && &claim[3] == "reproduced");
    let study = apportion_files::load_study(&study_path("hk-general"), &[]).unwrap();
    let factors = study.space().factors();
    let sequence = SobolSequence::scrambled(factors.len(), 1, 0);
    let mut scenes = vec![Scene::default(); 4096];
    let (mut u, mut si) = (vec![0.0; scenes.len()], vec![0.0; scenes.len()]);
    for (place, factor) in factors.iter().enumerate() {
        sequence.fill(place, 0, &mut u);
        factor.fill_si(&u, &mut si);
        let parameter = Parameter::from_name(&factor.name).unwrap();
        scenes.iter_mut().zip(&si).for_each(|(scene, value)| (parameter.set)(scene, *value));
    }
    let share = 100.0 * scenes.iter().filter(|scene| is_less(scene)).count() as f64 / scenes.len() as f64;
    let said = claim[5].strip_suffix(" of the box").unwrap();
    let number = |word: &str| word.trim_matches(['[', ']', ',']).parse().ok();
    let [value, low, high] = said.split(' ').filter_map(number).collect::<Vec<f64>>()[..] else { panic!("{said}") };
    assert!(low < value && value < high && high < 50.0, "{said}");
    // Twice the half width: both shares are estimates.
    assert!((share - value).abs() < high - low, "{share}: {said}");
}

/// The shapes of curves of 13 points at the nominal scene.
#[test]
fn shapes_are_those_of_the_physics() {
    let laws = [("Coulomb", FrictionLaw::Coulomb), ("Hurtado-Kim", FrictionLaw::HurtadoKim)];
    let over = |low: f64, high: f64, set: fn(&mut Scene, f64), law| -> Vec<(f64, f64)> {
        let at = |i: u32| {
            let (mut scene, x) = (Scene::default(), low + (high - low) * f64::from(i) / 12.0);
            set(&mut scene, x);
            (x, force(&scene, law))
        };
        (0..=12).map(at).collect()
    };
    for (name, law) in laws {
        let thickness = over(0.25e-6, 2.5e-6, |scene, value| scene.thickness = value, law);
        let power = (thickness[12].1 / thickness[0].1).log10();
        let said = format!("as t^{power:.2} ({name})");
        assert!(claim(&QUICK, "10")[6].contains(&said), "{said}: {}", &claim(&QUICK, "10")[6]);
        // The largest distance from the line of least squares.
        let width = over(5e-6, 80e-6, |scene, value| scene.width = value, law);
        let mean = |of: fn(&(f64, f64)) -> f64| width.iter().map(of).sum::<f64>() / width.len() as f64;
        let (x, y) = (mean(|point| point.0), mean(|point| point.1));
        let slope = width.iter().map(|point| (point.0 - x) * (point.1 - y)).sum::<f64>()
            / width.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>();
        let off = width.iter().map(|point| (point.1 - y - slope * (point.0 - x)).abs()).fold(0.0, f64::max);
        let bend = apportion_report::format::three_digits(100.0 * off / (width[12].1 - width[0].1));
        let said = format!("off a straight line by {bend} % of the rise, R² ");
        assert!(claim(&QUICK, "9")[6].contains(&said), "{said}: {}", &claim(&QUICK, "9")[6]);
    }
}

/// The share in percent from which on a factor counts.
const VISIBLE: f64 = 0.5;

/// What a result says of a published order of its factors, by the intervals of their total shares.
fn order(result: &Value, published: &[&str]) -> String {
    let mut shares: Vec<(&str, f64, [f64; 2])> = Vec::new();
    for index in result["outputs"][0]["indices"].as_array().unwrap() {
        let interval = &index["share_total_interval"];
        let bound = |name: &str, unknown: f64| interval[name].as_f64().unwrap_or(unknown);
        let bounds = [bound("low", f64::NEG_INFINITY), bound("high", f64::INFINITY)];
        shares.push((index["factor"].as_str().unwrap(), index["share_total"].as_f64().unwrap(), bounds));
    }
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    let bounds: BTreeMap<&str, [f64; 2]> = shares.iter().map(|(name, _, bounds)| (*name, *bounds)).collect();
    let is_unseen = |name: &str| bounds[name][1] < VISIBLE;
    let is_before = |one: &str, other: &str| bounds[one][0] > bounds[other][1] && bounds[one][0] >= VISIBLE;
    let (mut broken, mut open, mut is_whole) = (Vec::new(), Vec::new(), true);
    for pair in published.windows(2).map(|pair| [pair[0], pair[1]]) {
        let words = format!("{} before {}", pair[0], pair[1]);
        match pair {
            [one, other] if is_unseen(one) && is_unseen(other) => is_whole = false,
            [one, other] if is_before(one, other) => (),
            [one, other] if is_before(other, one) => broken.push(words),
            _ => open.push(words),
        }
    }
    let others = shares.iter().filter(|(name, _, [low, _])| *low >= VISIBLE && !published.contains(name));
    let others: Vec<&str> = others.map(|(name, ..)| *name).collect();
    let unseen: Vec<&str> = published.iter().copied().filter(|name| is_unseen(name)).collect();
    let mut reasons = Vec::new();
    if !broken.is_empty() {
        reasons.push(format!("not {}", broken.join(" and ")));
    }
    if !others.is_empty() {
        reasons.push(format!("a visible share of {}, which the paper does not rank", others.join(" and ")));
    }
    let said = match (reasons.is_empty(), open.is_empty()) {
        (false, _) => format!("another order: {}", reasons.join(", ")),
        (true, false) => format!("not decided at this sample size: {}", open.join(" and ")),
        (true, true) if is_whole => "the whole order".to_owned(),
        (true, true) => format!("the order of the visible shares, which {} do not have", unseen.join(" and ")),
    };
    said.replace('_', " ")
}

/// Neighbours whose intervals overlap are undecided, shares that are not visible have no order, and other factors must not
/// have a visible one.
#[test]
fn orders_follow_the_intervals_of_the_shares() {
    let mut kinds = BTreeMap::new();
    for found in [&*QUICK, &*FEW] {
        for (number, group, published) in [
            ("17", "dimensional", &["thickness", "length", "width", "height"][..]),
            ("18", "environmental", &["elastic_modulus", "velocity", "adhesion"]),
            ("19", "general", &["thickness", "length", "width", "elastic_modulus", "velocity", "adhesion"]),
        ] {
            let claim = claim(found, number);
            let mut is_whole = true;
            for (key, name) in [("coulomb", "Coulomb"), ("hk", "Hurtado-Kim"), ("lugre", "LuGre")] {
                let expected = order(&found.json(&format!("{key}-{group}.json")), published);
                let said = claim[5].split("; ").map(|part| part.split_once(": ").unwrap());
                let said = said.filter(|(names, _)| names.split(", ").any(|other| other == name));
                assert_eq!(said.map(|(_, phrase)| phrase).collect::<Vec<_>>(), [&expected], "{number} {name}");
                is_whole &= expected == "the whole order";
                *kinds.entry(expected.split([':', ',']).next().unwrap().to_owned()).or_insert(0) += 1;
            }
            assert_eq!(&claim[3] == "reproduced", is_whole, "{number}");
        }
    }
    assert_eq!(kinds.len(), 4, "every kind of phrase: {kinds:?}");
}
