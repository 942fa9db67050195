//! Earlier queries change no answer: one engine that keeps its memory, beside a fresh one.

use std::fmt::Debug;

/// An engine that has answered earlier queries, and one that has answered none.
pub struct WarmAndFresh<E> {
    pub warm: E,
    pub fresh: E,
}

impl<E: Clone> WarmAndFresh<E> {
    /// Starts from an engine that has answered nothing.
    pub fn new(fresh: E) -> Self {
        Self { warm: fresh.clone(), fresh }
    }

    /// Changes both in the same way. Returns what the change of the warm engine returned.
    pub fn change<R>(&mut self, change: impl Fn(&mut E) -> R) -> R {
        change(&mut self.fresh);
        change(&mut self.warm)
    }

    /// Asks both the same question. Asserts that the answers are equal to the last bit, and returns
    /// the answer. `context` says what was asked.
    #[track_caller]
    pub fn ask<A: Debug, C: Debug>(&mut self, context: C, question: impl Fn(&mut E) -> A) -> A {
        let found = question(&mut self.warm);
        let expected = question(&mut self.fresh.clone());
        // Printed numbers tell all bits, and 0 from -0.
        assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{context:?}");
        found
    }
}
