//! The network's file that is part of the program.

use toile_core::artifact::Digester;
use toile_recognise::{DIGEST, FILE, PartsNetwork};

#[test]
fn its_digest_is_the_one_that_is_stated() {
    let found = Digester::new().bytes(FILE).finish().hex();
    assert_eq!(
        found, DIGEST,
        "weights/parts.onnx is another file than src/weights.rs says; if it is the one that is meant, write \
         `pub const DIGEST: &str = \"{found}\";`"
    );
}

#[test]
fn it_is_the_network_that_is_run_here() {
    assert!(PartsNetwork::load_other(FILE).map(drop).is_ok(), "{:?}", PartsNetwork::load_other(FILE).err());
}

#[test]
fn it_is_small() {
    assert!(FILE.len() < 8_000_000, "{} bytes", FILE.len());
}
