//! The verdicts as they stand, and that they change with the physics.

use super::bench::{Bench, Physics};
use super::*;
use crate::afm::history::{History, history};
use crate::afm::modes::{ModeConstants, Pushing};
use crate::afm::{Critical, FrictionLaw, Options, Scene, critical_force};
use crate::reproduce::studies;

/// The nine studies at 4096 base points: enough to decide every order, and soon done.
fn nine_studies() -> Vec<Reproduced> {
    let studies = studies(&["design.base_samples=4096".to_owned()]).unwrap();
    let run =
        |(group, friction, study)| Reproduced { group, friction, result: crate::analyse(&study, 0, &|_| ()).unwrap() };
    studies.into_iter().map(run).collect()
}

/// Every claim with its verdict. A change of the physics that changes what is true of the papers changes this.
#[test]
fn the_verdicts_are_those_reviewed() {
    let studies = nine_studies();
    let claims = claims(&studies, Effort::Quick).unwrap();
    if std::env::var_os("SHOW").is_some() {
        for c in &claims {
            println!(
                "{} [{}] {}\n   => {}\n   F: {}\n   S: {}\n",
                c.number, c.source, c.statement, c.verdict, c.finding, c.setting
            );
        }
    }
    let lines: Vec<String> =
        claims.iter().map(|claim| format!("{} {}: {}", claim.number, claim.source, claim.verdict.word())).collect();
    insta::assert_snapshot!(lines.join("\n"));
}
