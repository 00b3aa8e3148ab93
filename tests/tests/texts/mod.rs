//! What is written for people: documentation, catalogue, messages.

mod catalogue;
mod docs;
mod error_codes;
mod messages;
mod proposals;
mod typos;
