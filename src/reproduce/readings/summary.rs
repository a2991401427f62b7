//! What the readings say, in sentences made from the numbers.

use super::catalogue::{BASE, BOTH, SMALL_SAMPLES, symbol, variant};
use super::nearest::{Joint, joint, name};
use super::{Chance, Effect, Estimators, Reading, Readings, SmallSample, Variant};
use crate::reproduce::{GROUPS, published};
use apportion::model::AfmOutput;
use apportion::report::{capitalised, fixed};

/// Percentage points within which a reading meets a group: three times the rounding of the printed numbers.
const MEETS: f64 = 1.5;

/// What the readings say: the nearest of each group; whether one meets all three; what the printed percentages do not say
/// and where they contradict each other.
pub fn summary(readings: &Readings) -> Vec<String> {
    let mut sentences: Vec<String> = GROUPS.iter().filter_map(|group| nearest(readings, group.key)).collect();
    sentences.extend(all_groups(readings));
    sentences.extend(environment(readings));
    sentences.push(unsaid());
    sentences.extend(contradiction(readings));
    sentences
}

/// The same in short, for a page's top: what the printed percentages do not say, whether one reading meets all groups, and
/// that they contradict each other.
pub fn headline(readings: &Readings) -> Vec<String> {
    let [dimensional, general] = printed_thickness();
    let contradiction = dimensional.zip(general).map(|(dimensional, general)| {
        format!(
            "They contradict each other: of thickness, length and width together, the thickness has {} % in one study and \
             {} % in the other, where a product of powers would give the same.",
            fixed(dimensional, 0),
            fixed(general, 1)
        )
    });
    [unsaid()].into_iter().chain(all_groups(readings)).chain(contradiction).collect()
}

/// The printed percentage of the thickness among thickness, length and width: in the dimensional study, where the height
/// has none, and in the general one.
fn printed_thickness() -> [Option<f64>; 2] {
    let printed = |group: &str, factor: &str| {
        published(group, "lugre").shares.iter().find(|(name, _)| *name == factor).map(|(_, share)| *share)
    };
    let among = || {
        let [t, l, w] = ["thickness", "length", "width"].map(|factor| printed("general", factor));
        Some(100.0 * t? / (t? + l? + w?))
    };
    [printed("dimensional", "thickness"), among()]
}

/// The reading of a group that is nearest to what is printed.
fn nearest(readings: &Readings, group: &str) -> Option<String> {
    let of_group: Vec<&Reading> = readings.rows.iter().filter(|reading| reading.group == group).collect();
    let nearest = of_group.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))?;
    Some(format!(
        "{}: of {} readings the nearest is {}, {} points away: {}.",
        capitalised(group),
        of_group.len(),
        name(nearest),
        fixed(nearest.distance, 1),
        against_printed(nearest)
    ))
}

/// The shares of the printed factors beside the printed ones, such as `thickness 76.8 % (printed 76)`.
fn against_printed(reading: &Reading) -> String {
    let shares = published(reading.group, "lugre").shares.iter().filter_map(|(factor, printed)| {
        let share = reading.shares.iter().find(|share| share.factor == *factor)?;
        Some(format!("{} {} % (printed {printed})", factor.replace('_', " "), fixed(share.share, 1)))
    });
    shares.collect::<Vec<_>>().join(", ")
}

/// Whether one reading meets all groups.
fn all_groups(readings: &Readings) -> Option<String> {
    let joint = joint(readings);
    let meeting: Vec<String> = joint.iter().filter(|reading| reading.largest() <= MEETS).map(Joint::name).collect();
    if !meeting.is_empty() {
        return Some(format!("All three groups are met to {MEETS} points by: {}.", meeting.join("; ")));
    }
    let nearest = joint.iter().min_by(|a, b| a.mean.total_cmp(&b.mean))?;
    let distances: Vec<String> =
        nearest.of_groups.iter().map(|reading| format!("{} {}", reading.group, fixed(reading.distance, 1))).collect();
    Some(format!(
        "No reading meets all three groups to {MEETS} points; the nearest on the mean is {}: {} points.",
        nearest.name(),
        distances.join(", ")
    ))
}

/// What it takes for velocity to act beside the elastic modulus.
fn environment(readings: &Readings) -> Option<String> {
    const GROUP: &str = "environmental";
    let of_group = || readings.rows.iter().filter(|reading| reading.group == GROUP);
    let velocity = |reading: &Reading| reading.shares.iter().find(|s| s.factor == "velocity").map(|s| s.share);
    let of_base = of_group().filter(|reading| reading.variant == BASE).filter_map(velocity).max_by(f64::total_cmp)?;
    let met_by: Vec<&Variant> =
        of_group().filter(|reading| reading.distance <= MEETS).filter_map(|reading| variant(reading.variant)).collect();
    let mut names: Vec<&str> = met_by.iter().map(|variant| variant.name).collect();
    names.dedup();
    let printed = published(GROUP, "lugre").shares.iter().find(|(factor, _)| *factor == "velocity")?.1;
    // The least that is printed as 1 %.
    let of_base = if of_base < 0.5 { "less than 0.5".to_owned() } else { fixed(of_base, 1) };
    let met = match names[..] {
        [] => format!("no reading meets the printed {printed} % to {MEETS} points"),
        _ => format!("the printed {printed} % is met to {MEETS} points by: {}", names.join(", ")),
    };
    let unprinted = ["afm.viscous_friction", "afm.step"];
    let is_assumed = |setting: &&str| unprinted.iter().any(|key| setting.starts_with(key));
    let assumed = !met_by.is_empty() && met_by.iter().all(|variant| variant.settings.iter().any(is_assumed));
    let caution = match assumed {
        true => {
            "; each rests on a number that is not printed (a viscous coefficient, a time step) and shows what could make \
             the percentages, not what did"
        }
        false => "",
    };
    Some(format!(
        "With the printed constants and no error of marching, velocity has {of_base} % of the environmental study; \
         {met}{caution}."
    ))
}

fn unsaid() -> String {
    "LG does not print what the percentages are of: first-order or total indices, of which output, at which sample size, \
     with which error."
        .to_owned()
}

/// The thickness among thickness, length and width, which in a product is the same in both studies.
fn contradiction(readings: &Readings) -> Option<String> {
    let [dimensional, general] = printed_thickness();
    let among = |share: &dyn Fn(&str) -> Option<f64>| -> Option<f64> {
        let [t, l, w] = [share("thickness")?, share("length")?, share("width")?];
        Some(100.0 * t / (t + l + w))
    };
    let ours = |group: &str, effect: Effect, output: AfmOutput| {
        let of = |reading: &&Reading| {
            (reading.group, reading.variant, reading.effect, reading.output) == (group, BASE, effect, output)
        };
        let reading = readings.rows.iter().find(of)?;
        among(&|factor| reading.shares.iter().find(|share| share.factor == factor).map(|share| share.share))
    };
    let both = |effect, output| {
        Some(format!(
            "{} and {}",
            fixed(ours("dimensional", effect, output)?, 1),
            fixed(ours("general", effect, output)?, 1)
        ))
    };
    Some(format!(
        "They contradict each other: where F_cr is a product of powers, thickness has the same part of the percentages of \
         thickness, length and width in the dimensional and in the general study (ours under LuGre: {} % by S1, {} % by \
         ST of F_cr, {} % by S1 of ln F_cr); printed are {} and {} %.",
        both(Effect::FirstOrder, AfmOutput::CriticalForce)?,
        both(Effect::Total, AfmOutput::CriticalForce)?,
        both(Effect::FirstOrder, AfmOutput::LogCriticalForce)?,
        fixed(dimensional?, 0),
        fixed(general?, 1)
    ))
}

/// How probable the printed percentages are in small samples, at most: a sentence for each group and variant.
pub fn chances(readings: &Readings) -> Vec<String> {
    GROUPS.iter().flat_map(|group| chances_of(readings, group.key)).collect()
}

fn chances_of(readings: &Readings, group: &str) -> Vec<String> {
    let mut variants: Vec<&str> = readings.small_samples.iter().map(|sample| sample.variant).collect();
    variants.dedup();
    variants.iter().filter_map(|id| chance_sentence(readings, group, id)).collect()
}

fn chance_sentence(readings: &Readings, group: &str, id: &str) -> Option<String> {
    let of_output = |output: AfmOutput| {
        let samples =
            || readings.small_samples.iter().filter(|s| (s.group, s.variant, s.output) == (group, id, output));
        let one = samples().max_by_key(|sample| sample.within_1.count)?;
        let three = samples().max_by_key(|sample| sample.within_3.count)?;
        Some(format!(
            "of {} to 1 point in {}{}, to 3 points in {}{}",
            symbol(output),
            in_percent(one.within_1),
            circumstances(one, one.within_1),
            in_percent(three.within_3),
            circumstances(three, three.within_3)
        ))
    };
    let outputs: Vec<String> = BOTH.into_iter().filter_map(of_output).collect();
    let repetitions = readings.small_samples.first()?.repetitions;
    Some(format!(
        "Chance, {group} study, {}: over {repetitions} samples of {} to {} random base points each, all printed percentages \
         are met at most: {}.",
        variant(id).map_or(id, |variant| variant.name),
        SMALL_SAMPLES.first()?,
        SMALL_SAMPLES.last()?,
        outputs.join("; ")
    ))
}

fn in_percent(chance: Chance) -> String {
    let Chance { share, low, high, .. } = chance;
    format!("{} % [{}, {}]", fixed(100.0 * share, 1), fixed(100.0 * low, 1), fixed(100.0 * high, 1))
}

/// Where the most of them occurred, if any did.
fn circumstances(sample: &SmallSample, chance: Chance) -> String {
    let estimators = match sample.estimators {
        Estimators::SaltelliJansen => "centred",
        Estimators::SobolHommaSaltelli => "uncentred",
    };
    match chance.count {
        0 => String::new(),
        _ => format!(" ({} at N = {}, {estimators})", sample.effect.symbol(), sample.base_samples),
    }
}
