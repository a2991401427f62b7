//! The charts of shares, from the studies that were run.

use super::PaperFigure;
use crate::reproduce::{GROUPS, Reproduced, StudyGroup, published, shares_csv};
use apportion::report::chart::{Chart, Series};
use apportion::report::{SharesSeries, capitalised, listed, shares_chart};

/// For each group, in the order of [`GROUPS`]: the figure of CHK and that of LG.
const PAPERS: [[Paper; 2]; 3] = [
    [
        Paper {
            stem: "chk-10",
            label: "CHK fig. 10",
            theirs: "Bars without numbers: thickness before length before width before height under both friction models.",
        },
        Paper {
            stem: "lg-4a",
            label: "LG fig. 4a",
            theirs: "Thickness before length before width before height; the text gives the thickness 76 %.",
        },
    ],
    [
        Paper {
            stem: "chk-15",
            label: "CHK fig. 15",
            theirs: "Bars without numbers: elastic modulus before velocity before adhesion under both friction models.",
        },
        Paper {
            stem: "lg-4b",
            label: "LG fig. 4b",
            theirs: "Elastic modulus before velocity before adhesion; the text gives 74 % and 26 % to the first two.",
        },
    ],
    [
        Paper {
            stem: "chk-16",
            label: "CHK fig. 16",
            theirs: "Bars without numbers: thickness before length, width, elastic modulus, velocity and adhesion under both \
                     friction models.",
        },
        Paper {
            stem: "lg-4c",
            label: "LG fig. 4c",
            theirs: "Thickness before length, width and elastic modulus; the text gives them 80, 12, 5 and 3 %.",
        },
    ],
];

/// What one paper shows of a group.
struct Paper {
    stem: &'static str,
    label: &'static str,
    theirs: &'static str,
}

/// The charts of the papers, then those with all friction models side by side; none of a group without studies.
pub(super) fn shares(studies: &[Reproduced]) -> Vec<PaperFigure> {
    let mut figures = Vec::new();
    let members = |group: StudyGroup, of: fn(&str) -> bool| -> Vec<&Reproduced> {
        studies.iter().filter(|study| study.group == group && of(study.friction.key)).collect()
    };
    for (group, papers) in GROUPS.into_iter().zip(&PAPERS) {
        let own: [fn(&str) -> bool; 2] = [|friction| friction != "lugre", |friction| friction == "lugre"];
        for (paper, of) in papers.iter().zip(own) {
            figures.extend(figure(paper, group, &members(group, of)));
        }
    }
    for group in GROUPS {
        let paper = Paper {
            stem: group.key,
            label: "All friction models",
            theirs: "The papers show them in separate figures.",
        };
        figures.extend(figure(&paper, group, &members(group, |_| true)));
    }
    figures
}

fn figure(paper: &Paper, group: StudyGroup, members: &[&Reproduced]) -> Option<PaperFigure> {
    (!members.is_empty()).then(|| PaperFigure {
        stem: paper.stem,
        label: paper.label,
        theirs: paper.theirs,
        chart: group_chart(group, members),
        csv: shares_csv(members.iter().copied()),
    })
}

/// The shares of all factors in the studies `members` of one group, side by side.
pub(in crate::reproduce) fn group_chart(group: StudyGroup, members: &[&Reproduced]) -> Chart {
    let factors: Vec<&str> =
        members.first().map_or_else(Vec::new, |m| m.result.factors.iter().map(|f| f.name.as_str()).collect());
    let series: Vec<SharesSeries<'_>> = members
        .iter()
        .map(|member| SharesSeries {
            series: Series::new(member.friction.name, member.friction.colour),
            output: &member.result.outputs[0],
            published: published(group.key, member.friction.key).shares.to_vec(),
        })
        .collect();
    let title = format!("Which factor decides the critical force: {} study", group.key);
    shares_chart(&title, &caption(group, members), &factors, &series).published_name("published (LuGre)")
}

/// The factor with the largest total index, with its shares of the first-order and of the total indices (%).
struct Leader<'a> {
    factor: &'a str,
    shares: (f64, f64),
    friction: &'static str,
}

fn leader(member: &Reproduced) -> Option<Leader<'_>> {
    let indices = member.result.outputs.first()?.indices.as_ref()?;
    let first = indices.iter().max_by(|a, b| a.effect.total.estimate.total_cmp(&b.effect.total.estimate))?;
    Some(Leader {
        factor: &first.factor,
        shares: (first.effect.share_first_order?, first.effect.share_total?),
        friction: member.friction.name,
    })
}

/// What is seen, in one sentence.
fn caption(group: StudyGroup, members: &[&Reproduced]) -> String {
    let leaders: Vec<Leader<'_>> = members.iter().filter_map(|member| leader(member)).collect();
    let shares =
        |l: &Leader<'_>| format!("{:.0} % of the first-order and {:.0} % of the total indices", l.shares.0, l.shares.1);
    let seen = match &leaders[..] {
        [] => "No factor has a share".to_owned(),
        [one] => format!("The largest share is that of {}: {}", words(one.factor), shares(one)),
        [one, rest @ ..] if rest.iter().all(|other| other.factor == one.factor) => {
            let each: Vec<String> = leaders.iter().map(|l| format!("{:.0} %, {}", l.shares.1, l.friction)).collect();
            let every = if leaders.len() > 2 { "every friction model" } else { "both friction models" };
            format!("The largest total share under {every} is that of {} ({})", words(one.factor), each.join("; "))
        }
        _ => {
            let each: Vec<String> = leaders
                .iter()
                .map(|l| format!("{} under {} ({:.0} %)", words(l.factor), l.friction, l.shares.1))
                .collect();
            capitalised(&format!("the largest total share belongs to {}", each.join(", ")))
        }
    };
    let printed = |member: &&Reproduced| {
        let shares = published(group.key, member.friction.key).shares;
        let each: Vec<String> =
            shares.iter().map(|(factor, share)| format!("{share} % for {}", words(factor))).collect();
        (!each.is_empty()).then(|| format!("; printed for {} (diamonds) are {}", member.friction.name, listed(&each)))
    };
    format!("{seen}{}.", members.iter().filter_map(printed).collect::<String>())
}

fn words(name: &str) -> String {
    name.replace('_', " ")
}
