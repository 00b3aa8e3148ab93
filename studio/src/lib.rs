//! `toile studio`: a page in the browser on which a pipeline is edited while it runs.
//!
//! ```text
//! page <--HTTP, events--> server --> studio --> project   (text, undo, journal, files)
//!                                          \--> live      (runs, what they have made so far)
//!                                                \--> show (artifacts as JSON, pictures, meshes)
//! ```
//!
//! The interface is described in `docs/reference/studio.md`. [`StudioProject`] is the text with its
//! history; every edit of it is on the disk before it is answered. [`Studio`] joins it to the runs
//! and answers every request; the server adds HTTP, and nothing else.
//!
//! Cost: a run goes on in one thread of its own with rayon's pool, so requests are answered
//! meanwhile. Limits: one project a server, and one server a folder.

mod fault;
mod live;
mod page;
mod project;
mod pulse;
mod server;
mod show;
mod studio;

pub use fault::{FaultPlace, StudioFault};
pub use project::StudioProject;
pub use project::change::StudioChange;
pub use server::StudioServer;
pub use studio::{Studio, StudioOptions};
