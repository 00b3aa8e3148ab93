//! One decision, and the words of its parts.

use serde::{Deserialize, Serialize};

/// What became of a part of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Done, where it usually is not.
    On,
    /// Left out.
    Off,
    /// Done with less.
    Simplified,
}

impl State {
    /// In one word.
    pub fn as_str(self) -> &'static str {
        match self {
            State::On => "on",
            State::Off => "off",
            State::Simplified => "simplified",
        }
    }
}

/// How much turning a decision round may change.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Tolerance {
    /// No bit of the garment.
    SameBits,
    /// 95 % of the garment's outline lie within so many metres.
    Outline(f64),
    /// So many grey levels of the texture, root mean square; no bit of the garment.
    Texture(f64),
    /// 95 % of the draped surface lie within so many metres.
    Distance(f64),
}

impl std::fmt::Display for Tolerance {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Tolerance::SameBits => write!(f, "same bits"),
            Tolerance::Outline(m) => write!(f, "outline {} mm", shown(m * 1e3)),
            Tolerance::Texture(levels) => write!(f, "texture {} levels", shown(*levels)),
            Tolerance::Distance(m) => write!(f, "surface {} mm", shown(m * 1e3)),
        }
    }
}

/// Without the digits that the product of a unit leaves behind.
fn shown(x: f64) -> f64 {
    (x * 1e6).round() / 1e6
}

/// What a decision saves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Saves {
    /// What the cost model says of the pipeline with it and without it: the sizes at its stages
    /// differ.
    Modelled,
    /// This share of its stage's time as it would be without it, measured on the shipped pipelines.
    Share(f64),
}

/// How a decision is reversed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Turn {
    /// By a value of a parameter of its stage.
    Param {
        /// The parameter.
        name: String,
        /// The value as it stands in a pipeline file.
        value: String,
    },
    /// By asking for the stage: `--also STAGE`.
    Also,
}

/// What is done because of a fact of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// The rule, one word or a few with hyphens: `texture-size`.
    pub rule: String,
    /// What became of the part of the work that it is about.
    pub state: State,
    /// The part of the work that it is about, in words.
    pub what: String,
    /// The fact of the scene, in words, with its figures.
    pub fact: String,
    /// What turning it round may change.
    pub tolerance: Tolerance,
    /// What it saves.
    pub saves: Saves,
    /// Where the rule comes from: author and year, or a page of this product.
    pub source: String,
    /// How it is reversed.
    pub turn: Turn,
}
