#![allow(clippy::unwrap_used)]
use super::super::{Drafted, DraftedPiece, PieceFold, SeamlyFault, drafted};
use kurbo::{Point, Vec2};

/// A square of 10 cm with a curve over its upper edge that bows up, and what modeling has of it.
fn pattern(piece: &str, more: &str) -> String {
    format!(
        r#"<pattern><version>0.6.8</version><unit>cm</unit><draftBlock name="front"><calculation>
        <point id="1" name="A" type="single" x="0" y="0"/>
        <point id="2" name="B" type="endLine" basePoint="1" angle="0" length="10"/>
        <point id="3" name="C" type="endLine" basePoint="2" angle="90" length="10"/>
        <point id="4" name="D" type="endLine" basePoint="1" angle="90" length="10"/>
        <spline id="5" type="simpleInteractive" point1="3" point4="4" angle1="135" length1="3" angle2="45" length2="3"/>
        <point id="6" name="E" type="cutSpline" spline="5" length="CurrentLength/2"/>
        <point id="9" name="F" type="alongLine" firstPoint="1" secondPoint="2" length="4"/></calculation>
        <modeling><point id="11" idObject="1" type="modeling"/><point id="12" idObject="2" type="modeling"/>
        <point id="13" idObject="3" type="modeling"/><point id="14" idObject="4" type="modeling"/>
        <spline id="15" idObject="5" type="modelingSpline"/><point id="16" idObject="6" type="modeling"/>
        <point id="19" idObject="9" type="modeling"/>
        <path id="30" name="pocket" type="1"><nodes><node idObject="11" type="NodePoint"/><node idObject="13" type="NodePoint"/></nodes></path>
        {more}</modeling><pieces>{piece}</pieces></draftBlock></pattern>"#
    )
}

fn read(piece: &str, more: &str) -> Result<Drafted, Vec<SeamlyFault>> {
    drafted(pattern(piece, more).as_bytes(), None)
}

fn one(piece: &str) -> DraftedPiece {
    read(piece, "").unwrap().pieces.remove(0)
}

const NODES: &str = r#"<nodes><node idObject="11" type="NodePoint"/><node idObject="19" type="NodePoint" notch="true"/>
    <node idObject="12" type="NodePoint"/><node idObject="15" type="NodeSpline" reverse="0"/></nodes>"#;

fn starts(piece: &DraftedPiece) -> Vec<&str> {
    piece.outline.parts.iter().map(|p| p.from.as_str()).collect()
}

#[test]
fn an_outline_goes_through_points_and_along_curves() {
    let piece =
        one(&format!(r#"<piece id="40" name="Front" seamAllowance="true" width="1.5">{NODES}</piece>"#));
    assert_eq!(starts(&piece), ["A", "F", "B", "C", "D"]);
    let curved: Vec<bool> = piece.outline.parts.iter().map(|p| p.stroke.is_some()).collect();
    assert_eq!(curved, [false, false, false, true, false]);
    assert_eq!(piece.outline.parts[4].end, Point::ORIGIN);
    assert_eq!((piece.notches.len(), piece.allowance, piece.quantity), (1, Some(1.5), 1));
    assert!((piece.notches[0] - Point::new(4.0, 0.0)).hypot() < 1e-9);
    assert_eq!((piece.name.as_str(), piece.fold, piece.grain), ("Front", PieceFold::None, None));
}

#[test]
fn a_curve_begins_at_a_neighbour_that_lies_on_it() {
    let nodes = r#"<nodes><node idObject="11" type="NodePoint"/><node idObject="16" type="NodePoint"/>
        <node idObject="15" type="NodeSpline" reverse="0"/></nodes>"#;
    let piece = one(&format!(r#"<piece id="40" name="Half">{nodes}</piece>"#));
    assert_eq!(starts(&piece), ["A", "E", "D"]);
    assert!((piece.outline.parts[0].end.x - 5.0).abs() < 1e-6);
    let turned = nodes.replace("reverse=\"0\"", "reverse=\"1\"");
    assert_eq!(starts(&one(&format!(r#"<piece id="40" name="Half">{turned}</piece>"#))), ["A", "E", "C"]);
}

#[test]
fn a_point_beside_the_end_of_a_curve_makes_no_spike() {
    // From the end of the curve the path runs to D, up to G and back along the edge.
    let more = r#"<point id="17" idObject="8" type="modeling"/>"#;
    let nodes = NODES.replace(
        "</nodes>",
        r#"<node idObject="14" type="NodePoint"/><node idObject="17" type="NodePoint"/></nodes>"#,
    );
    let spike = r#"<point id="8" name="G" type="endLine" basePoint="4" angle="90" length="0.2"/>"#;
    let piece = format!(r#"<piece id="40" name="P">{nodes}</piece>"#);
    let text = pattern(&piece, more).replace("</calculation>", &format!("{spike}</calculation>"));
    let drafted = drafted(text.as_bytes(), None).unwrap();
    assert_eq!(starts(&drafted.pieces[0]), ["A", "F", "B", "C", "D"]);
    assert_eq!(
        drafted.warnings,
        [
            "block \"front\", piece \"P\" (line 14): its outline crosses itself: 1 loops of up to 4.0 mm are left out"
        ]
    );
}

#[test]
fn nodes_that_are_excluded_are_left_out() {
    let nodes = NODES.replace(
        "idObject=\"12\" type=\"NodePoint\"",
        "idObject=\"12\" type=\"NodePoint\" excluded=\"true\"",
    );
    assert_eq!(starts(&one(&format!(r#"<piece id="40" name="P">{nodes}</piece>"#))), ["A", "F", "C", "D"]);
}

#[test]
fn grain_fold_quantity_and_inner_paths_are_read() {
    let piece = one(&format!(
        r#"<piece id="40" name="Front" forbidFlipping="true" seamAllowanceBuiltIn="true">
        <data quantity="2" onFold="true"/><grainline visible="true" rotation="180"/>{NODES}
        <iPaths><record path="30"/></iPaths></piece>"#
    ));
    assert_eq!((piece.grain, piece.quantity), (Some(Vec2::new(-1.0, 0.0)), 2));
    assert_eq!((piece.fold, piece.turns, piece.built_in), (PieceFold::Unsaid, false, true));
    assert_eq!((piece.inner[0].name.as_str(), piece.inner[0].path.parts.len()), ("pocket", 1));
    let newer = one(&format!(
        r#"<piece id="40" name="Front"><grainline enabled="true" visible="false" topPin="14" bottomPin="11" rotation="0"/>
        {NODES}<mirrorLine p1="14" p2="11"/></piece>"#
    ));
    assert_eq!(newer.grain, Some(Vec2::new(0.0, 10.0)));
    assert!(matches!(newer.fold, PieceFold::Line([a, b]) if a.y > 9.0 && b == Point::ORIGIN));
    let older = one(&format!(
        r#"<piece id="40" name="Front"><data><mcp cutNumber="4" material="0" placement="1"/></data>{NODES}</piece>"#
    ));
    assert_eq!((older.quantity, older.fold), (4, PieceFold::Unsaid));
}

#[test]
fn the_oldest_pieces_have_their_nodes_without_a_list() {
    let text = pattern("", "").replace("<pieces></pieces>", &format!(
        "<details><detail id=\"40\" name=\"Old\" supplement=\"1\" width=\"10\" closed=\"1\">{}</detail></details>",
        NODES.replace("<nodes>", "").replace("</nodes>", "")
    ));
    let text = text.replace("draftBlock", "draw");
    let piece = drafted(text.as_bytes(), None).unwrap().pieces.remove(0);
    assert_eq!((starts(&piece), piece.allowance), (vec!["A", "F", "B", "C", "D"], Some(10.0)));
}

#[test]
fn pieces_that_are_not_laid_out_are_left_out() {
    let both = format!(
        r#"<piece id="40" name="Front">{NODES}</piece><piece id="41" name="Lining" inLayout="false">{NODES}</piece>"#
    );
    let drafted = read(&both, "").unwrap();
    assert_eq!(drafted.pieces.len(), 1);
    assert_eq!(drafted.notes, ["pieces that are not laid out are left out: \"Lining\""]);
}

#[test]
fn what_is_not_read_of_pieces_is_named() {
    let nodes = NODES.replace("notch=\"true\"", "notch=\"true\" notchLength=\"0.5\" angle=\"2\"");
    let piece = format!(
        r#"<piece id="40" name="Front"><data letter="A" visible="true"/><csa/><pins><record>11</record></pins><glue size="1"/>{nodes}</piece>"#
    );
    assert_eq!(
        read(&piece, "").unwrap().notes,
        [
            "left out: corners of seam allowances of \"Front\"; depth and form of notches of \"Front\"; elements \"glue\" of \"Front\"; labels of \"Front\"; pins of \"Front\""
        ]
    );
}

#[test]
fn faults_name_the_piece() {
    let faults = |piece: &str, more: &str| {
        let all = read(piece, more).unwrap_err();
        all.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(faults("", ""), "there are no pieces: it holds draft blocks alone");
    let line = r#"<nodes><node idObject="11" type="NodePoint"/></nodes>"#;
    assert_eq!(
        faults(&format!("<piece id=\"40\" name=\"Front\">{line}</piece>"), ""),
        "block \"front\", piece \"Front\" (line 14): its nodes draw no closed line"
    );
    let unknown = r#"<nodes><node idObject="99" type="NodePoint"/></nodes>"#;
    assert_eq!(
        faults(&format!("<piece id=\"40\" name=\"Front\">{unknown}</piece>"), ""),
        "block \"front\", piece \"Front\" (line 14): its \"idObject\" is object 99, which there is none of"
    );
    let lost = format!(r#"<piece id="40" name="Front">{NODES}<iPaths><record path="31"/></iPaths></piece>"#);
    assert_eq!(
        faults(&lost, ""),
        "block \"front\", piece \"Front\" (line 14): its \"path\" is object 31, which there is none of"
    );
    let union = r#"<tools id="50" type="unionDetails"><children><nodes><child>60</child></nodes></children></tools>
        <point id="61" idObject="60" type="modeling"/>"#;
    let united = r#"<nodes><node idObject="61" type="NodePoint"/></nodes>"#;
    assert_eq!(
        faults(&format!("<piece id=\"40\" name=\"Whole\">{united}</piece>"), union),
        "block \"front\", piece \"Whole\" (unionDetails) (line 15): the tool is not supported"
    );
}

#[test]
fn a_fault_that_no_piece_needs_is_told_and_refuses_nothing() {
    let text = pattern(&format!(r#"<piece id="40" name="Front">{NODES}</piece>"#), "")
        .replace("</calculation>", "<point id=\"70\" name=\"Z\" type=\"endLine\" basePoint=\"1\" angle=\"0\" length=\"bust\"/></calculation>");
    let drafted = drafted(text.as_bytes(), None).unwrap();
    assert_eq!(
        drafted.warnings,
        [
            "tools that no piece needs could not be worked out: block \"front\", tool 70 \"Z\" (point endLine) (line 8): \
          there is no measurement \"bust\" for its \"length\", which is \"bust\""
        ]
    );
}
