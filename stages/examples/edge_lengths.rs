//! Lengths of the edges of pattern files, one per line: file, piece, edge, metres, separated by
//! tabs; to hold them against another program's.
//!
//!     cargo run --release --example edge_lengths -- shirt_specification.json ...
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::sync::Arc;
use toile_core::Cancel;
use toile_core::prelude::*;
use toile_stages::pattern::GarmentCode;

fn main() -> Result<(), Box<dyn Error>> {
    for file in std::env::args().skip(1) {
        let cx = Context::new("GarmentCode", Path::new("."), Cancel::new(), Arc::new(()));
        let (pattern, _, _) = GarmentCode { file: file.clone() }.run(&cx)?;
        for piece in &pattern.pieces {
            for (k, edge) in piece.outer.edges.iter().enumerate() {
                println!("{file}\t{}\t{}\t{:.12}", piece.name, edge.name, piece.outer.path(k).length());
            }
        }
    }
    Ok(())
}
