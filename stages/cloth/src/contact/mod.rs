//! What cloth touches: the body and itself.

pub mod body;
pub mod friction;
pub mod give_way;
pub mod limit;
pub mod past;
pub mod skin;
pub(crate) mod start;

#[cfg(test)]
mod tests;
