//! The network itself. Its weights are no part of the repository: `TOILE_SALIENCY_WEIGHTS` names
//! the file `u2netp.onnx`; without it these tests say "skipped".

use crate::kit::{digest, given, overlap, run};
use toile_core::artifact::Artifact;
use toile_core::testkit::{Trial, check, shapes};
use toile_core::{Contract, StageType};
use toile_saliency::{Guide, Network, Saliency};

/// The file's bytes, or nothing where it is not named.
fn weights() -> Option<Vec<u8>> {
    let Some(file) = std::env::var_os("TOILE_SALIENCY_WEIGHTS") else {
        println!("skipped: TOILE_SALIENCY_WEIGHTS is not set");
        return None;
    };
    Some(std::fs::read(file).unwrap())
}

#[test]
fn the_readme_and_the_card_state_its_digest() {
    let Some(bytes) = weights() else { return };
    let digest = digest(&bytes);
    let readme = concat!(env!("CARGO_MANIFEST_DIR"), "/README.md");
    assert!(std::fs::read_to_string(readme).unwrap().contains(&digest), "{digest}");
    assert!(Saliency::type_card().example.contains(&digest), "{digest}");
}

#[test]
fn it_finds_a_drawn_shirt() {
    let Some(bytes) = weights() else { return };
    let (photo, truth) = shapes::photo_of(&shapes::tshirt());
    let (dir, stage) = given(&bytes);
    let found = overlap(&run(&stage, &photo, dir.path()).0.unwrap(), &truth);
    assert!(found > 0.95, "{found}");
}

#[test]
fn it_gives_the_same_bits_for_any_number_of_threads() {
    let Some(bytes) = weights() else { return };
    let network = Network::load(bytes).unwrap();
    let photo = Guide::of(&shapes::noisy_photo(320, 320).pixels);
    let bits = |threads| {
        let map = network.map(&photo, threads).unwrap();
        map.values().iter().map(|v| v.to_bits()).collect::<Vec<u32>>()
    };
    let first = bits(1);
    assert!([1, 2, 3, 5].into_iter().all(|threads| bits(threads) == first));
}

#[test]
fn it_stops_when_it_is_asked_to() {
    let Some(bytes) = weights() else { return };
    let (dir, stage) = given(&bytes);
    let trial = Trial { stage: &stage, folder: dir.path() };
    assert!(check(trial, Some(&stage), Contract::Cancellable).is_ok());
}

#[test]
fn a_spoilt_file_is_refused_in_words_or_gives_a_sound_mask() {
    let Some(bytes) = weights() else { return };
    let (photo, _) = shapes::photo_of(&shapes::tshirt());
    let answers = |bytes: &[u8]| {
        let (dir, stage) = given(bytes);
        match run(&stage, &photo, dir.path()).0 {
            Ok(mask) => assert_eq!(mask.check(), Ok(())),
            Err(e) => assert!(e.message.starts_with("\"tiny.onnx\" is not a network"), "{e}"),
        }
    };
    for share in 1..16 {
        answers(&bytes[..bytes.len() * share / 16]);
    }
    for at in [3, 40, 5000, bytes.len() / 2, bytes.len() - 700] {
        let mut spoilt = bytes.clone();
        spoilt[at] ^= 0x55;
        answers(&spoilt);
    }
}
