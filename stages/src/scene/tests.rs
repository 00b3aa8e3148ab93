//! Scenes from files.
