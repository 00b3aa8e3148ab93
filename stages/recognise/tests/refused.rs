//! What is refused, word for word.

use crate::kit::{boxed, tiny, values};
use crate::onnx::{Net, Node};
use image::RgbImage;
use toile_core::artifact::Digester;
use toile_recognise::{DIGEST, FILE, PartsNetwork, RecogniseError, SIDE, see};

/// What is said of a network of that file when it is loaded, or run where it is loaded.
fn refusal(file: &[u8]) -> String {
    let photo = boxed(50, 40, (10, 10, 30, 30));
    let made = PartsNetwork::load_other(file).and_then(|network| network.see(&photo, 1));
    made.unwrap_err().to_string()
}

#[test]
fn a_photo_has_pixels() {
    for (width, height) in [(0, 0), (0, 5), (5, 0)] {
        let refused = see(&RgbImage::new(width, height), 1).unwrap_err();
        assert_eq!(refused, RecogniseError::NoPixels);
        assert_eq!(refused.to_string(), "the photo has no pixels");
    }
}

#[test]
fn the_file_is_another_one() {
    let file = tiny().file();
    let found = Digester::new().bytes(&file).finish().hex();
    let refused = PartsNetwork::load(&file).unwrap_err();
    assert_eq!(
        refused.to_string(),
        format!("the network's file has the digest {found}, where {DIGEST} is needed")
    );
    let mut spoilt = FILE.to_vec();
    let at = spoilt.len() / 2;
    spoilt[at] ^= 1;
    assert!(matches!(PartsNetwork::load(&spoilt), Err(RecogniseError::OtherFile { .. })));
}

#[test]
fn it_is_no_onnx_file() {
    for bytes in [&b""[..], b"<!DOCTYPE html><html>", b"PK\x03\x04 an archive", &[0; 4096], b"RTEN...."] {
        assert_eq!(refusal(bytes), "the network's file is no ONNX file", "{bytes:?}");
    }
}

#[test]
fn a_length_that_leads_back_is_refused() {
    // A field that nothing knows, of length 2^64 - 11: that of its own key and length.
    let back = [0x7a, 0xf5, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01];
    let version = [0x08, 0x08];
    for bytes in [&back[..], &[&version[..], &back].concat()] {
        assert_eq!(refusal(bytes), "the network's file is no ONNX file", "{bytes:?}");
    }
}

#[test]
fn it_was_cut_short() {
    assert_eq!(refusal(&FILE[..FILE.len() / 2]), "the network's file is damaged or cut short");
}

#[test]
fn it_uses_an_operator_that_is_not_known() {
    let mut net = tiny();
    net.nodes[3].operator = "Erf";
    assert_eq!(
        refusal(&net.file()),
        "the network's file cannot be read: in node \"flat_node\": operator error: Erf operator not supported or \
         not enabled"
    );
}

#[test]
fn it_takes_something_else() {
    let wanted = format!("where 1 x 3 x {SIDE} x {SIDE} is needed");
    let takes =
        |shape: &[u64]| refusal(&Net { takes: vec![("photo", Some(shape.to_vec()))], ..tiny() }.file());
    assert_eq!(takes(&[1, 3, 1024, 1024]), format!("the network takes 1 x 3 x 1024 x 1024, {wanted}"));
    assert_eq!(takes(&[0, 1, 28, 28]), format!("the network takes ? x 1 x 28 x 28, {wanted}"));
    assert_eq!(takes(&[3, 192, 192]), format!("the network takes 3 x 192 x 192, {wanted}"));
    let mut two = tiny();
    two.takes.push(("spare", Some(vec![1])));
    assert_eq!(refusal(&two.file()), format!("the network takes 2 inputs, {wanted}"));
}

#[test]
fn it_gives_something_else() {
    let mut net = tiny();
    net.gives[3].1 = Some(vec![1, 13]);
    net.constants.iter_mut().filter(|constant| constant.0.starts_with("kinds")).for_each(|constant| {
        *constant.1.last_mut().unwrap() = 13;
        constant.2 = vec![0.0; constant.1.iter().product::<u64>() as usize];
    });
    assert_eq!(refusal(&net.file()), "the network gives 1 x 13 as \"kinds\", where 1 x 12 is needed");
    // Where it does not say, it is seen when it has run.
    let mut net = tiny();
    net.gives[5].1 = None;
    net.constants.iter_mut().filter(|constant| constant.0.starts_with("flags")).for_each(|constant| {
        *constant.1.last_mut().unwrap() = 1;
        constant.2.truncate(constant.1.iter().product::<u64>() as usize);
    });
    assert_eq!(refusal(&net.file()), "the network gives 1 x 1 as \"flags\", where 1 x 3 is needed");
    let mut flat = tiny();
    flat.gives[2].1 = None;
    flat.nodes[4] = Node { operator: "Identity", takes: vec!["photo"], gives: "presence", steps: 1 };
    let found = format!("1 x 3 x {SIDE} x {SIDE}");
    let said = format!("the network gives {found} as \"presence\", where 1 x 20 is needed");
    assert_eq!(refusal(&flat.file()), said);
}

#[test]
fn it_gives_too_little() {
    let mut net = tiny();
    net.gives.remove(4);
    assert_eq!(refusal(&net.file()), "the network gives no \"lies\"");
}

#[test]
fn sides_that_are_left_open_fit() {
    let mut net = tiny();
    net.takes[0].1 = Some(vec![1, 3, 0, 0]);
    net.gives.iter_mut().for_each(|gives| gives.1 = None);
    let network = PartsNetwork::load_other(&net.file()).unwrap();
    assert!(network.see(&boxed(50, 40, (10, 10, 30, 30)), 1).is_ok());
}

#[test]
fn it_breaks_off() {
    let mut net = tiny();
    let shift = net.constants.iter_mut().find(|constant| constant.0 == "part_slopes").unwrap();
    (shift.1, shift.2) = (vec![11, 2, 4, 4], vec![0.1; 352]);
    let why = "incompatible input shapes: Input channels (per group) does not match kernel input channels";
    assert_eq!(
        refusal(&net.file()),
        format!("the network cannot be run: operator \"parts_node\" failed: {why}")
    );
}

#[test]
fn it_gives_no_numbers() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (constant, output) in
            [("part_shift", "parts"), ("mark_shift", "landmarks"), ("kinds_shift", "kinds")]
        {
            let mut net = tiny();
            values(&mut net, constant)[1] = bad;
            let said = format!("the network gives values as \"{output}\" that are no numbers");
            assert_eq!(refusal(&net.file()), said);
        }
    }
}
