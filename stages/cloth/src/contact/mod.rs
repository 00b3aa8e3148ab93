//! What cloth touches: the body and itself.

pub mod body;
pub mod ccd;
pub mod closest;
pub mod facets;
pub mod give_way;
pub mod limit;
pub mod pair;
pub mod past;
pub mod sharp;
pub mod skin;
pub(crate) mod start;
pub mod tree;

#[cfg(test)]
mod tests;
