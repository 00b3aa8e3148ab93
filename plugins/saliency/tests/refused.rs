//! What is refused, word for word.

use crate::kit::{digest, given, run, tiny};
use crate::onnx::Net;
use toile_core::{ErrorCode, testkit};
use toile_saliency::Saliency;

/// Code, message, hint and parameter of the refusal.
fn refusal(stage: &Saliency, dir: &std::path::Path) -> (ErrorCode, String, String, &'static str) {
    let e = run(stage, &testkit::photo(), dir).0.unwrap_err();
    (e.code, e.message, e.hint.unwrap(), e.param.unwrap())
}

#[test]
fn no_file_is_named() {
    let (code, message, hint, param) = refusal(&Saliency::default(), ".".as_ref());
    assert_eq!(code, ErrorCode::InvalidParameter);
    assert_eq!(message, "no file is named to read the network from");
    assert_eq!(
        hint,
        "write `weights: \"u2netp.onnx\"`; plugins/saliency/README.md says where to get the file"
    );
    assert_eq!(param, "weights");
}

#[test]
fn the_file_is_not_there() {
    let (dir, stage) = given(&tiny().file());
    let gone = Saliency { weights: "gone.onnx".into(), ..stage };
    let (code, message, hint, param) = refusal(&gone, dir.path());
    assert_eq!(code, ErrorCode::PatternLoading);
    assert_eq!(message, "cannot read \"gone.onnx\": no such file");
    assert_eq!(
        hint,
        "paths are relative to the pipeline file; plugins/saliency/README.md says where to get the file"
    );
    assert_eq!(param, "weights");
}

#[test]
fn a_folder_is_no_file() {
    let (dir, stage) = given(&tiny().file());
    let (_, message, ..) = refusal(&Saliency { weights: ".".into(), ..stage }, dir.path());
    assert_eq!(message, "cannot read \".\": it is not a file");
}

#[test]
fn no_digest_is_given() {
    let bytes = tiny().file();
    let (dir, stage) = given(&bytes);
    let (code, message, hint, param) = refusal(&Saliency { digest: String::new(), ..stage }, dir.path());
    assert_eq!((code, param), (ErrorCode::InvalidParameter, "digest"));
    assert_eq!(message, "no digest is given for \"tiny.onnx\"");
    assert_eq!(hint, format!("write `digest: \"{}\"` if this is the file that you mean", digest(&bytes)));
}

#[test]
fn the_digest_is_none() {
    let (dir, stage) = given(&tiny().file());
    let (_, message, _, param) = refusal(&Saliency { digest: "8e83ca70".into(), ..stage }, dir.path());
    assert_eq!(message, "`digest` must be 64 hexadecimal digits, found \"8e83ca70\"");
    assert_eq!(param, "digest");
}

#[test]
fn the_file_is_another_one() {
    let bytes = tiny().file();
    let (dir, stage) = given(&bytes);
    let meant = "0123456789abcdef".repeat(4);
    let (code, message, hint, param) = refusal(&Saliency { digest: meant.clone(), ..stage }, dir.path());
    let found = digest(&bytes);
    assert_eq!((code, param), (ErrorCode::InvalidParameter, "digest"));
    assert_eq!(
        message,
        format!("\"tiny.onnx\" is not the file that is meant: its digest is {found}, `digest` says {meant}")
    );
    assert_eq!(
        hint,
        format!("get the file again, or write `digest: \"{found}\"` if this is the file that you mean")
    );
}

#[test]
fn the_digest_may_be_written_in_capitals() {
    let (dir, stage) = given(&tiny().file());
    let loud = Saliency { digest: stage.digest.to_uppercase(), ..stage };
    assert!(run(&loud, &testkit::photo(), dir.path()).0.is_ok());
}

/// What is said of a file of those bytes.
fn unfit(bytes: &[u8]) -> (String, String) {
    let (dir, stage) = given(bytes);
    let (code, message, hint, param) = refusal(&stage, dir.path());
    assert_eq!((code, param), (ErrorCode::PatternLoading, "weights"));
    let start = "\"tiny.onnx\" is not a network that finds objects in photos: ";
    (message.strip_prefix(start).unwrap().to_owned(), hint)
}

const OTHER_FILE: &str =
    "name the network's ONNX file itself: not an archive, a web page or a file of another format";
const GET_AGAIN: &str = "get the file again; networks other than U2-Net and U2-Net-p do not fit";
const OTHER_SHAPE: &str = "use U2-Net or U2-Net-p as exported for photos of 320 x 320 pixels";

#[test]
fn it_is_no_onnx_file() {
    for bytes in [&b""[..], b"<!DOCTYPE html><html>", b"PK\x03\x04 an archive", &[0; 4096], b"RTEN...."] {
        assert_eq!(unfit(bytes), ("it is no ONNX file".to_owned(), OTHER_FILE.to_owned()), "{bytes:?}");
    }
}

#[test]
fn it_was_cut_short() {
    let bytes = tiny().file();
    let (message, hint) = unfit(&bytes[..20]);
    assert_eq!(message, "it is damaged or cut short");
    assert_eq!(hint, GET_AGAIN);
}

#[test]
fn it_uses_an_operator_that_is_not_known() {
    let net = Net { nodes: vec![("Conv", vec!["slopes", "shift"]), ("Erf", vec![])], ..tiny() };
    let (message, hint) = unfit(&net.file());
    assert_eq!(
        message,
        "it cannot be read: in node \"node1\": operator error: Erf operator not supported or not enabled"
    );
    assert_eq!(hint, GET_AGAIN);
}

#[test]
fn it_takes_something_else() {
    let takes = |sides: &[u64]| unfit(&Net { takes: sides.to_vec(), ..tiny() }.file());
    let wrong = |found: &str| {
        (format!("it takes {found}, where 1 x 3 x 320 x 320 is needed"), OTHER_SHAPE.to_owned())
    };
    assert_eq!(takes(&[1, 3, 1024, 1024]), wrong("1 x 3 x 1024 x 1024"));
    assert_eq!(takes(&[0, 1, 28, 28]), wrong("? x 1 x 28 x 28"));
    assert_eq!(takes(&[3, 320, 320]), wrong("3 x 320 x 320"));
    assert_eq!(unfit(&Net { spare: 1, ..tiny() }.file()), wrong("2 inputs"));
}

#[test]
fn it_gives_something_else() {
    let wrong = |found: &str| {
        (format!("it gives {found}, where 1 x 1 x 320 x 320 is needed"), OTHER_SHAPE.to_owned())
    };
    let mut two = tiny();
    two.constants[0] = ("slopes", vec![2, 3, 1, 1], vec![0.1; 6]);
    two.constants[1] = ("shift", vec![2], vec![0.0; 2]);
    assert_eq!(unfit(&two.file()), wrong("1 x 2 x 320 x 320"));
    // Where it does not say, it is seen when it has run.
    let found = Net { gives: None, nodes: vec![("Relu", vec![])], constants: vec![], ..tiny() };
    assert_eq!(unfit(&found.file()), wrong("1 x 3 x 320 x 320"));
    let flat = Net { gives: None, nodes: vec![("Shape", vec![])], constants: vec![], ..tiny() };
    assert_eq!(unfit(&flat.file()), wrong("4"));
}

#[test]
fn a_side_that_is_left_open_fits() {
    let net = Net { takes: vec![0, 3, 320, 320], gives: None, ..tiny() };
    let (dir, stage) = given(&net.file());
    assert!(run(&stage, &testkit::photo(), dir.path()).0.is_ok());
}

#[test]
fn it_breaks_off() {
    let mut net = tiny();
    net.constants[0] = ("slopes", vec![1, 2, 1, 1], vec![0.1; 2]);
    let (message, hint) = unfit(&net.file());
    let why = "incompatible input shapes: Input channels (per group) does not match kernel input channels";
    assert_eq!(message, format!("it cannot be run: operator \"node0\" failed: {why}"));
    assert_eq!(hint, GET_AGAIN);
}

#[test]
fn it_gives_no_numbers() {
    let mut net = tiny();
    net.constants[1].2 = vec![f32::NAN];
    assert_eq!(unfit(&net.file()), ("it gives values that are no numbers".to_owned(), GET_AGAIN.to_owned()));
}
