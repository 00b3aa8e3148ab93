//! The texts before and after the present one.

use std::collections::VecDeque;

/// The most steps that are kept.
const MOST_STEPS: usize = 1000;
/// The most bytes of text that are kept.
const MOST_BYTES: usize = 32 << 20;

/// A step: what was done, and the text on its other side.
#[derive(Debug, Clone, PartialEq, Eq)]
struct UndoStep {
    words: String,
    text: String,
    /// True of a text on its way: the next one with the same words is the same step.
    draft: bool,
}

/// What can be undone and done again.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct UndoSteps {
    past: VecDeque<UndoStep>,
    future: Vec<UndoStep>,
}

impl UndoSteps {
    /// Notes an edit; `before` is the text that it changed.
    pub(super) fn push(&mut self, words: &str, before: &str, draft: bool) {
        self.future.clear();
        let goes_on = |last: &UndoStep| last.draft && last.words == words;
        if let Some(last) = self.past.back_mut().filter(|last| goes_on(last)) {
            last.draft = draft;
            return;
        }
        self.past.push_back(UndoStep { words: words.to_owned(), text: before.to_owned(), draft });
        let bytes = |past: &VecDeque<UndoStep>| past.iter().map(|s| s.text.len()).sum::<usize>();
        while self.past.len() > MOST_STEPS || self.past.len() > 1 && bytes(&self.past) > MOST_BYTES {
            self.past.pop_front();
        }
    }

    /// Goes back over the last edit, from the present text.
    pub(super) fn undo(&mut self, text: &str) {
        if let Some(step) = self.past.pop_back() {
            self.future.push(UndoStep { words: step.words, text: text.to_owned(), draft: false });
        }
    }

    /// Goes over the last edit that was undone, from the present text.
    pub(super) fn redo(&mut self, text: &str) {
        if let Some(step) = self.future.pop() {
            self.past.push_back(UndoStep { words: step.words, text: text.to_owned(), draft: false });
        }
    }

    /// The text that an undo gives, and what it takes back.
    pub(super) fn before(&self) -> Option<(String, String)> {
        self.past.back().map(|s| (s.words.clone(), s.text.clone()))
    }

    /// The text that a redo gives, and what it makes again.
    pub(super) fn after(&self) -> Option<(String, String)> {
        self.future.last().map(|s| (s.words.clone(), s.text.clone()))
    }

    pub(super) fn can_undo(&self) -> Option<&str> {
        self.past.back().map(|s| s.words.as_str())
    }

    pub(super) fn can_redo(&self) -> Option<&str> {
        self.future.last().map(|s| s.words.as_str())
    }
}
