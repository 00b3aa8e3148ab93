//! Stages that do what plugins must not do, and a few that do what they must: the tests of the
//! plugin border load them, and the program must live on with a clear word.
#![allow(clippy::panic)]

mod collider;
mod param;
mod run;

pub use collider::{PushesOut, Sphere, TrapCollider};
pub use param::{PanicsInCreate, Trap};
pub use run::{
    Forgets, GivesBadTriangles, GivesNan, Loops, NeverStops, PanicsInDrop, PanicsInLoop, PanicsInRun, Shades,
    Tints, TurnsCloth, TurnsOver,
};

toile_core::plugin!(
    PanicsInCreate,
    PanicsInRun,
    PanicsInDrop,
    PanicsInLoop,
    GivesNan,
    GivesBadTriangles,
    TurnsOver,
    TurnsCloth,
    NeverStops,
    Forgets,
    Loops,
    Shades,
    Tints,
    Sphere,
    TrapCollider,
    PushesOut,
);
