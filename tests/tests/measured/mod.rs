//! What commands measure: accuracy against time, costs, decisions.

mod ablation;
mod costs;
mod decisions;
mod qualities;
mod repeatable;
mod trade;
