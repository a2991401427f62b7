//! What has indices in a study, by name.

use super::Study;
use crate::effect::Effect;
use crate::model::Model;
use crate::space::Group;

/// An effect with its name and its factors.
pub(crate) struct StudyEffect {
    pub effect: Effect,
    /// The factor, the group, the factors of the subset joined by " + ", or "dummy".
    pub name: String,
    /// The indices of its factors, ascending.
    pub factors: Vec<usize>,
}

impl Study {
    /// Returns everything that has indices, in the order of the swaps of the design: factors (or groups in their place),
    /// further groups, subsets, dummy.
    pub(crate) fn effects(&self) -> Vec<StudyEffect> {
        let noise = self.space.noise();
        let mut effects = Vec::new();
        for (number, Group { name, factors }) in self.analysis.members(&self.space).into_iter().enumerate() {
            let effect = if noise == Some(number) { Effect::Noise } else { Effect::Factor(number) };
            effects.push(StudyEffect { effect, name, factors });
        }
        for (number, Group { name, factors }) in self.analysis.further_groups(&self.space).into_iter().enumerate() {
            effects.push(StudyEffect { effect: Effect::Group(number), name, factors });
        }
        for (number, factors) in self.analysis.subsets.iter().enumerate() {
            let names: Vec<&str> = factors.iter().map(|&factor| self.space.factors()[factor].name.as_str()).collect();
            let name = names.join(" + ");
            effects.push(StudyEffect { effect: Effect::Subset(number), name, factors: factors.clone() });
        }
        if self.analysis.dummy {
            effects.push(StudyEffect { effect: Effect::Dummy, name: "dummy".to_owned(), factors: Vec::new() });
        }
        effects
    }

    /// Returns whether each effect certainly leaves output number `output` of `model` unchanged: the model does not read its
    /// factors, or they are constants.
    pub(crate) fn unread(&self, model: &dyn Model, output: usize) -> Vec<bool> {
        let mut unread = Vec::new();
        for effect in self.effects() {
            unread.push(
                effect
                    .factors
                    .iter()
                    .all(|&factor| self.space.factors()[factor].is_constant() || !model.reads(output, factor)),
            );
        }
        unread
    }

    /// Returns whether `effect` certainly is everything that output number `output` of `model` depends on.
    pub(crate) fn is_everything(&self, effect: &StudyEffect, model: &dyn Model, output: usize) -> bool {
        let is_independent = self.space.copula().is_none();
        self.space.factors().iter().enumerate().all(|(number, factor)| {
            let is_unread = factor.is_constant() || is_independent && !model.reads(output, number);
            is_unread || effect.factors.contains(&number)
        })
    }
}
