//! Shipped pipelines, from their files to what they write.

mod by_place;
mod creases;
mod drawn_as_sewn;
mod falls;
mod flat;
mod outputs;
mod photos;
mod published;
mod swapped;
mod turntable;
mod vest;
