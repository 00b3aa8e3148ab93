//! The samples of our own, read through the stage; every refusal word for word.
#![allow(clippy::unwrap_used, clippy::panic)]

use super::*;
use std::path::Path as FilePath;
use std::sync::Arc;
use toile_core::Cancel;

const SKIRT: &str = include_str!("../../../../../pipelines/samples/pattern/skirt.sm2d");
const SEAMS: &str = include_str!("../../../../../pipelines/samples/pattern/skirt_seams.ron");
const BODICE: &str = include_str!("../../../../../pipelines/samples/pattern/bodice.val");
const BODY: &str = include_str!("../../../../../pipelines/samples/pattern/body.smis");

/// What the stage makes of files in a folder, with what it tells.
fn run(files: &[(&str, &str)], stage: &SeamlyPattern) -> Result<(Pattern, OutputFiles, Remarks), StageError> {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    read(dir.path(), stage)
}

fn read(folder: &FilePath, stage: &SeamlyPattern) -> Result<(Pattern, OutputFiles, Remarks), StageError> {
    let cx = Context::new("SeamlyPattern", folder, Cancel::new(), Arc::new(()));
    let (pattern, _, _, files) = stage.run(&cx)?;
    Ok((pattern, files, cx.take_remarks()))
}

fn of(file: &str) -> SeamlyPattern {
    SeamlyPattern { file: file.into(), ..SeamlyPattern::default() }
}

/// The error with its hint.
fn refused(files: &[(&str, &str)], stage: &SeamlyPattern) -> (String, String) {
    let e = run(files, stage).err().unwrap();
    (e.message.clone(), e.hint.clone().unwrap_or_default())
}

fn names(p: &Piece) -> Vec<&str> {
    p.outer.edges.iter().map(|e| e.name.as_str()).collect()
}

#[test]
fn the_skirt_is_drafted_to_the_measurements_that_it_names() {
    let (pattern, files, told) =
        run(&[("skirt.sm2d", SKIRT), ("body.smis", BODY)], &of("skirt.sm2d")).unwrap();
    let pieces: Vec<&str> = pattern.pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(pieces, ["front", "back", "waistband"]);
    let front = &pattern.pieces[0];
    let mut own = names(front);
    own.sort_unstable();
    assert_eq!(own, ["A_G", "E_C", "G_E", "G_E_m"]);
    let length = |piece: &Piece, edge: &str| piece.path(edge).unwrap().length();
    // A quarter of 96 + 2 cm, 7 cm of flare, on both sides of the fold.
    assert!((length(front, "E_C") - 0.63).abs() < 1e-9);
    let waist = length(front, "A_G") + length(&pattern.pieces[1], "Ab_Gb");
    assert!((length(&pattern.pieces[2], "P_Q") - waist).abs() < 1e-6);
    assert_eq!(front.notches.len(), 2);
    assert!((front.notches[0].along - front.notches[1].along).abs() < 0.7);
    assert!(told.notes.contains(&"the pattern says that its units are centimetres".to_owned()), "{told:?}");
    assert!(told.notes.contains(
        &"outlines are seam lines; seam allowances are left out, give them to the writer as `seam_allowance` and `hem_allowance`: 10.0 mm of \"front\"; 10.0 mm of \"back\"; 10.0 mm of \"waistband\""
            .to_owned()
    ));
    assert_eq!(files.0.len(), 1);
}

#[test]
fn the_skirt_is_sewn_by_a_file_of_seams() {
    let stage = SeamlyPattern { seams: "seams.ron".into(), ..of("skirt.sm2d") };
    let files = [("skirt.sm2d", SKIRT), ("body.smis", BODY), ("seams.ron", SEAMS)];
    let (pattern, _, told) = run(&files, &stage).unwrap();
    assert_eq!((pattern.seams.len(), told.warnings), (4, Vec::<String>::new()));
    for s in &pattern.seams {
        let [a, b] = [0, 1].map(|k| pattern.side_length(&s.sides[k]));
        assert!((a - b).abs() < 1e-6, "{}: {a} {b}", s.name);
    }
}

#[test]
fn the_bodice_of_valentina_is_unfolded_at_its_mirror_line() {
    let (pattern, _, _) = run(&[("bodice.val", BODICE), ("body.smis", BODY)], &of("bodice.val")).unwrap();
    let front = pattern.piece("front").unwrap();
    let mut own = names(front);
    own.sort_unstable();
    assert_eq!(own, ["H_W", "N_S", "S_T", "S_T_m", "T_U", "T_U_m", "U_H", "U_H_m"]);
    // A quarter of 96 + 8 cm, twice.
    assert!((front.path("H_W").unwrap().length() - 0.52).abs() < 1e-9);
    assert_eq!(front.notches.iter().filter(|n| n.edge.starts_with("T_U")).count(), 2);
    let [low, high] = front.grain.unwrap();
    assert!(high.y > low.y && (high.x - low.x).abs() < 1e-12);
}

#[test]
fn measurements_of_several_sizes_are_taken_in_one() {
    let sizes = "<smms><unit>cm</unit><size base=\"50\"/><height base=\"176\"/><body-measurements>\
        <m name=\"waist_circ\" base=\"70\" size_increase=\"4\" height_increase=\"0\"/>\
        <m name=\"hip_circ\" base=\"96\" size_increase=\"4\" height_increase=\"0\"/>\
        <m name=\"waist_to_hip_side\" base=\"20\" size_increase=\"0\" height_increase=\"1\"/></body-measurements></smms>";
    let stage = |size| SeamlyPattern { size, measurements: "sizes.smms".into(), ..of("skirt.sm2d") };
    let files = [("skirt.sm2d", SKIRT), ("sizes.smms", sizes)];
    let hem = |size| {
        let (pattern, _, _) = run(&files, &stage(size)).unwrap();
        pattern.pieces[0].path("E_C").unwrap().length()
    };
    // Two steps of 4 cm around the hip, of which the front has half.
    assert!((hem(54.0) - hem(0.0) - 0.04).abs() < 1e-9);
    assert_eq!(
        refused(&files, &stage(500.0)),
        (
            "\"sizes.smms\": the measurements have no size 500: it goes from 22 to 72".into(),
            "`--set pattern.size=22` takes the least".into()
        )
    );
    assert_eq!(
        refused(&[("skirt.sm2d", SKIRT)], &SeamlyPattern { size: 50.0, ..of("skirt.sm2d") }),
        (
            "\"skirt.sm2d\": a size is asked for, but the measurements have one size".into(),
            "leave `size` out, or name a file of several sizes as `measurements`".into()
        )
    );
}

#[test]
fn measurements_that_are_not_there_are_asked_for() {
    let (message, hint) = refused(&[("skirt.sm2d", SKIRT)], &of("skirt.sm2d"));
    for name in ["waist_circ", "waist_to_hip_side"] {
        let said = format!("there is no measurement \"{name}\" for its ");
        assert!(message.contains(&said), "{message}");
    }
    assert!(
        hint.starts_with(
            "1. the pattern names \"body.smis\" for its measurements, which is not there; give the file with the \
             measurements: `--set 'pattern.measurements=\"body.smis\"'`"
        ),
        "{hint}"
    );
    let body = BODY.replace("\"waist_circ\"", "\"waist_circumference\"");
    let (message, hint) = refused(&[("skirt.sm2d", SKIRT), ("body.smis", &body)], &of("skirt.sm2d"));
    assert_eq!(
        message,
        "\"skirt.sm2d\": block \"front\", tool 6 \"F\" (point endLine) (line 24): there is no measurement \"waist_circ\" \
         for its \"length\", which is \"(waist_circ + #ease)/4\""
    );
    assert!(hint.ends_with("add \"waist_circ\" to the measurements in SeamlyMe or Tape"), "{hint}");
    let stage = SeamlyPattern { measurements: "mine.smis".into(), ..of("skirt.sm2d") };
    let (message, _) = refused(&[("skirt.sm2d", SKIRT)], &stage);
    assert!(message.contains("mine.smis"), "{message}");
    assert_eq!(
        refused(&[("skirt.sm2d", SKIRT), ("mine.smis", "<pattern/>")], &stage).0,
        "\"mine.smis\": its first element is \"pattern\", not \"smis, smms, vit or vst\""
    );
}

/// A rectangle of 30 by 40 cm, as one piece with those words in its element and within.
fn rectangle(words: &str, inner: &str) -> String {
    format!(
        r#"<pattern><unit>cm</unit><draftBlock name="b"><calculation>
        <point id="1" name="A" type="single" x="0" y="0"/>
        <point id="2" name="B" type="endLine" basePoint="1" angle="0" length="30"/>
        <point id="3" name="C" type="endLine" basePoint="2" angle="90" length="40"/>
        <point id="4" name="D" type="endLine" basePoint="1" angle="90" length="40"/>
        </calculation><modeling/><pieces><piece id="9" name="p.1" {words}>{inner}<nodes>
        <node type="NodePoint" idObject="1"/><node type="NodePoint" idObject="2"/>
        <node type="NodePoint" idObject="3"/><node type="NodePoint" idObject="4"/></nodes></piece></pieces></draftBlock></pattern>"#
    )
}

fn one(text: &str) -> (Vec<Piece>, Remarks) {
    let (pattern, _, told) = run(&[("p.sm2d", text)], &of("p.sm2d")).unwrap();
    (pattern.pieces, told)
}

#[test]
fn pairs_are_mirrored_and_grain_is_turned_up() {
    let (pieces, _) = one(&rectangle("", r#"<data quantity="2"/><grainline visible="true" rotation="0"/>"#));
    let called: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(called, ["p_1", "p_1_mirrored"]);
    // What lay along x runs up now.
    let a_b = pieces[0].path("A_B").unwrap();
    assert!((a_b.at(a_b.length()) - a_b.at(0.0)).y.abs() > 0.299);
    let (pieces, _) = one(&rectangle(r#"forbidFlipping="true""#, r#"<data quantity="2"/>"#));
    assert_eq!(pieces[1].name, "p_1_2");
}

#[test]
fn a_fold_that_is_not_said_lies_along_the_grain() {
    let (pieces, told) =
        one(&rectangle("", r#"<data onFold="true"/><grainline visible="true" rotation="90"/>"#));
    assert_eq!(
        told.warnings[0],
        "piece \"p_1\" is cut on the fold, and the pattern does not say at which edge: \"D_A\" is taken, not \"B_C\""
    );
    assert!((polygon_area(&pieces[0].outer.points().0) - 0.24).abs() < 1e-9);
    let slanted = rectangle("", r#"<data onFold="true"/><grainline visible="true" rotation="45"/>"#);
    assert_eq!(
        refused(&[("p.sm2d", &slanted)], &of("p.sm2d")),
        (
            "\"p.sm2d\": block \"b\", piece \"p.1\" (line 6): it is cut on the fold, and no straight edge of it runs along its grain"
                .into(),
            "take \"place on fold\" out of the piece's label, or turn its grain line along the fold".into()
        )
    );
}

#[test]
fn outlines_that_cross_and_sizes_that_no_one_wears_are_refused() {
    let crossed = rectangle("", "").replace(
        r#"length="40"/>
        <point id="4""#,
        r#"length="-40"/>
        <point id="4""#,
    );
    assert_eq!(
        refused(&[("p.sm2d", &crossed)], &of("p.sm2d")).1,
        "let the piece's nodes follow each other around it, and its curves run in their direction"
    );
    let (message, hint) =
        refused(&[("p.sm2d", &rectangle("", "").replace("<unit>cm", "<unit>mm"))], &of("p.sm2d"));
    assert_eq!(
        message,
        "\"p.sm2d\": no one wears a garment of that size: its largest piece, \"p_1\", would be 4.0 cm long, as the pattern \
         says that its units are millimetres"
    );
    assert!(hint.starts_with("`--set pattern.unit=Centimetres` makes it 40 cm long"), "{hint}");
    let stage = SeamlyPattern { unit: DrawingUnit::Centimetres, ..of("p.sm2d") };
    assert!(run(&[("p.sm2d", &rectangle("", "").replace("<unit>cm", "<unit>mm"))], &stage).is_ok());
}

#[test]
fn seam_allowances_at_nodes_are_told_by_edge() {
    let words = |first: &str, second: &str| {
        let text = rectangle(r#"seamAllowance="true" width="1""#, "")
            .replace(r#"idObject="1"/><node"#, &format!(r#"idObject="1" {first}/><node"#))
            .replace(
                r#"type="NodePoint" idObject="2"/>"#,
                &format!(r#"type="NodePoint" idObject="2" {second}/>"#),
            );
        let (_, told) = one(&text);
        let begin = "outlines are seam lines; seam allowances are left out, give them to the writer as \
                     `seam_allowance` and `hem_allowance`: ";
        told.notes.iter().find_map(|n| n.strip_prefix(begin)).unwrap().to_owned()
    };
    assert_eq!(words("", ""), "10.0 mm of \"p_1\"");
    assert_eq!(words(r#"after="3""#, r#"before="3""#), "10.0 mm of \"p_1\", 30.0 mm at its \"A_B\"");
    assert_eq!(
        words(r#"after="CurrentSeamAllowance * 2" before="-1""#, r#"after="0""#),
        "10.0 mm of \"p_1\", 20.0 to 10.0 mm at its \"A_B\", 0.0 to 10.0 mm at its \"B_C\""
    );
    assert_eq!(words(r#"before="CurrentSeamAllowance""#, ""), "10.0 mm of \"p_1\"");
}

#[test]
fn tools_that_are_not_supported_are_named_where_a_piece_needs_them() {
    let text = rectangle("", "").replace("type=\"endLine\" basePoint=\"1\" angle=\"90\"", "type=\"spiral\"");
    assert_eq!(
        refused(&[("p.sm2d", &text)], &of("p.sm2d")),
        (
            "\"p.sm2d\": block \"b\", tool 4 \"D\" (point spiral) (line 5): the tool is not supported".into(),
            "draw its result with points and curves, or export the pieces as DXF and read them with `DxfPattern`"
                .into()
        )
    );
}
