//! Pieces whose rows are pending: kept back until they stand, or evaluated again.

use std::collections::VecDeque;

use crate::model::Standing;

/// Pieces of work `W` with what has come of them, `P`.
pub(super) struct Held<W, P> {
    pending: Vec<(W, P)>,
    again: VecDeque<W>,
}

impl<W, P> Held<W, P> {
    pub fn new() -> Self {
        Self { pending: Vec::new(), again: VecDeque::new() }
    }

    pub fn is_empty(&self) -> bool {
        self.pending.is_empty()
    }

    /// The pieces that are kept back.
    pub fn pending(&self) -> impl Iterator<Item = &W> {
        self.pending.iter().map(|(work, _)| work)
    }

    /// The next piece that is to be evaluated again.
    pub fn next_again(&mut self) -> Option<W> {
        self.again.pop_front()
    }

    /// Takes a piece that has been evaluated.
    pub fn push(&mut self, work: W, product: P) {
        self.pending.push((work, product));
    }

    /// What may be handed over, now that the last piece has this standing. Pieces that are revoked come again, in order.
    pub fn settle(&mut self, standing: Standing) -> Vec<P> {
        match standing {
            Standing::Final => self.pending.drain(..).map(|(_, product)| product).collect(),
            Standing::Pending => Vec::new(),
            Standing::Revoked => {
                self.pending.drain(..).rev().for_each(|(work, _)| self.again.push_front(work));
                Vec::new()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn revoked_pieces_come_again_before_those_that_wait() {
        let mut held = Held::new();
        held.push(1, 'a');
        assert!(held.settle(Standing::Pending).is_empty());
        held.push(2, 'b');
        assert_eq!(held.settle(Standing::Final), ['a', 'b']);
        for work in 3..6 {
            held.push(work, 'c');
        }
        assert!(held.settle(Standing::Revoked).is_empty() && held.is_empty());
        assert_eq!(held.next_again(), Some(3));
        held.push(3, 'd');
        assert!(held.settle(Standing::Revoked).is_empty());
        assert_eq!(std::iter::from_fn(|| held.next_again()).collect::<Vec<_>>(), [3, 4, 5]);
    }
}
