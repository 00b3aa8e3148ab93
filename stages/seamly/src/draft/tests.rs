#![allow(clippy::unwrap_used, clippy::panic)]
//! Every tool with an answer that is worked out by hand. Numbers in the file are centimetres, y
//! down; answers are y up.

use super::super::fault::ToolPlace;
use super::super::measure::{Grade, MeasurementTable};
use super::super::source;
use super::super::unit::LengthUnit;
use super::*;
use kurbo::Point;
use std::f64::consts::PI;

/// A to D are the corners of a square of 10 cm, its lower left one at the origin.
const SQUARE: &str = r##"
    <point id="1" name="A" type="single" x="0" y="0"/>
    <point id="2" name="B" type="endLine" basePoint="1" angle="0" length="10"/>
    <point id="3" name="C" type="endLine" basePoint="2" angle="90" length="Line_A_B"/>
    <point id="4" name="D" type="endLine" basePoint="1" angle="AngleLine_B_C" length="10"/>"##;

fn drafted(tools: &str, head: &str) -> Drafting {
    let text = format!(
        "<pattern><unit>cm</unit>{head}<draw name=\"block\"><calculation>{SQUARE}{tools}</calculation></draw></pattern>"
    );
    let measured = "<smis><unit>cm</unit><body-measurements><m name=\"waist_circ\" value=\"72\"/>\
        <m name=\"loop\" value=\"loop + 1\"/></body-measurements></smis>";
    let table =
        MeasurementTable::read(measured.as_bytes(), Grade::default(), LengthUnit::Centimetre).unwrap();
    let tree = source::tree(&text).unwrap();
    let mut values = DraftValues::of(Some(table));
    super::super::head::increments(tree.root_element(), &mut values);
    drawn(tree.root_element(), values).unwrap()
}

/// The point of a tool with the number 50.
fn point(tools: &str) -> Point {
    point_of(&drafted(tools, ""), 50)
}

fn point_of(draft: &Drafting, id: u32) -> Point {
    match draft.objects.get(&id) {
        Some(DraftObject::Point { at, .. }) => *at,
        other => panic!("{other:?}, {:?}", draft.values.faults),
    }
}

fn near(p: Point, x: f64, y: f64) {
    assert!((p - Point::new(x, y)).hypot() < 1e-6, "{p} is not ({x}, {y})");
}

/// The value of a formula once the tools are drawn.
fn value(tools: &str, formula: &str) -> f64 {
    let mut draft = drafted(tools, "");
    let place = ToolPlace { block: String::new(), tool: "test".into(), line: 1 };
    let asked = Asked { place: &place, attribute: "length", formula };
    draft.values.value(asked).unwrap_or_else(|_| panic!("{:?}", draft.values.faults))
}

#[test]
fn points_of_lines() {
    near(point(r#"<point id="50" type="single" x="3" y="4"/>"#), 3.0, -4.0);
    let along = |length: &str| {
        point(&format!(
            r#"<point id="50" type="alongLine" firstPoint="1" secondPoint="3" length="{length}"/>"#
        ))
    };
    near(along("CurrentLength/2"), 5.0, 5.0);
    near(along("-sqrt(2)"), -1.0, -1.0);
    near(along("0"), 0.0, 0.0);
    // To the left of the way from A to B is up.
    let normal = |angle| {
        point(&format!(
            r#"<point id="50" type="normal" firstPoint="1" secondPoint="2" length="3" angle="{angle}"/>"#
        ))
    };
    near(normal("0"), 0.0, 3.0);
    near(normal("-90"), 3.0, 0.0);
    let bisector =
        r#"<point id="50" type="bisector" firstPoint="2" secondPoint="1" thirdPoint="4" length="sqrt(8)"/>"#;
    near(point(bisector), 2.0, 2.0);
    let turned = bisector
        .replace("firstPoint=\"2\"", "firstPoint=\"4\"")
        .replace("thirdPoint=\"4\"", "thirdPoint=\"2\"");
    near(point(&turned), 2.0, 2.0);
    near(point(r#"<point id="50" type="height" basePoint="4" p1Line="1" p2Line="3"/>"#), 5.0, 5.0);
    for kind in ["pointOfIntersection", "intersectXY"] {
        near(point(&format!(r#"<point id="50" type="{kind}" firstPoint="2" secondPoint="4"/>"#)), 10.0, 10.0);
    }
}

#[test]
fn meetings_of_lines() {
    near(
        point(r#"<point id="50" type="lineIntersect" p1Line1="1" p2Line1="3" p1Line2="2" p2Line2="4"/>"#),
        5.0,
        5.0,
    );
    near(
        point(r#"<point id="50" type="lineIntersectAxis" basePoint="1" angle="45" p1Line="2" p2Line="3"/>"#),
        10.0,
        10.0,
    );
    // From A 26 cm away on the line from D through C: x squared is 676 less 100.
    near(
        point(r#"<point id="50" type="shoulder" p1Line="4" p2Line="3" pShoulder="1" length="26"/>"#),
        24.0,
        10.0,
    );
    // The circle over B C is met by the line from A to B at B, by that from A to C at (5, 5) and C.
    near(
        point(r#"<point id="50" type="triangle" axisP1="1" axisP2="4" firstPoint="1" secondPoint="3"/>"#),
        0.0,
        10.0,
    );
}

#[test]
fn meetings_of_circles_and_lines() {
    let contact = |kind: &str, radius: &str| {
        point(&format!(
            r#"<point id="50" type="{kind}" center="1" radius="{radius}" firstPoint="4" secondPoint="3"/>"#
        ))
    };
    for kind in ["contact", "pointOfContact"] {
        near(contact(kind, "sqrt(125)"), 5.0, 10.0);
        near(contact(kind, "10"), 0.0, 10.0);
    }
    let circles = |which| {
        point(&format!(
            r#"<point id="50" type="pointOfIntersectionCircles" c1Center="1" c2Center="2" c1Radius="13"
               c2Radius="13" crossPoint="{which}"/>"#
        ))
    };
    near(circles(1), 5.0, -12.0);
    near(circles(2), 5.0, 12.0);
    // From 10 cm away a circle of 6 cm is touched 8 cm away: 6.4 cm along, 4.8 cm aside.
    let tangent = |which| {
        point(&format!(
            r#"<point id="50" type="pointFromCircleAndTangent" tangent="1" cCenter="2" cRadius="6" crossPoint="{which}"/>"#
        ))
    };
    near(tangent(1), 6.4, -4.8);
    near(tangent(2), 6.4, 4.8);
}

/// Arcs of 13 cm about A and about B, the upper halves.
const ARCS: &str = r#"<arc id="10" type="simple" center="1" radius="13" angle1="0" angle2="180"/>
    <arc id="11" type="simple" center="2" radius="13" angle1="0" angle2="180"/>"#;

#[test]
fn meetings_of_arcs_and_curves() {
    // The first of the two points lies on neither arc.
    near(
        point(&format!(
            r#"{ARCS}<point id="50" type="pointOfIntersectionArcs" firstArc="10" secondArc="11" crossPoint="1"/>"#
        )),
        5.0,
        12.0,
    );
    near(
        point(&format!(
            r#"{ARCS}<point id="50" type="pointOfIntersectionCurves" curve1="10" curve2="11" vCrossPoint="1" hCrossPoint="1"/>"#
        )),
        5.0,
        12.0,
    );
    near(
        point(
            r#"<arc id="10" type="simple" center="2" radius="6" angle1="0" angle2="180"/>
            <point id="50" type="pointFromArcAndTangent" tangent="1" arc="10" crossPoint="1"/>"#,
        ),
        6.4,
        4.8,
    );
    let tools = format!(
        r#"{ARCS}<point id="50" name="T" type="curveIntersectAxis" basePoint="1" curve="11" angle="90"/>"#
    );
    // About B: 13 squared less 10 squared.
    near(point(&tools), 0.0, 69.0_f64.sqrt());
    let draft = drafted(&tools, "");
    assert!(matches!(draft.objects.get(&51), Some(DraftObject::Curve(_))));
}

#[test]
fn arcs_and_what_formulas_know_of_them() {
    let arc = r#"<arc id="12" type="simple" center="1" radius="2" angle1="30" angle2="120"/>"#;
    assert!((value(arc, "Arc_A_12") - PI).abs() < 1e-9);
    assert_eq!(value(arc, "RadiusArc_A_12 + Angle1Arc_A_12 + Angle2Arc_A_12"), 152.0);
    let long = r#"<arc id="12" type="arcWithLength" center="1" radius="2" angle1="0" length="PIPE"/>"#;
    assert!((value(&long.replace("PIPE", "_pi"), "Angle2Arc_A_12") - 90.0).abs() < 1e-9);
    let ellipse = r#"<elArc id="12" type="simple" center="1" radius1="2" radius2="2" angle1="0" angle2="90" rotationAngle="20"/>"#;
    assert!((value(ellipse, "ElArc_A_12") - PI).abs() < 1e-5);
    assert_eq!(value(ellipse, "Radius1ElArc_A_12 + Angle2ElArc_A_12 + RotationElArc_A_12"), 112.0);
    let long = r#"<elArc id="12" type="ellipticalArcWithLength" center="1" radius1="2" radius2="2" angle1="0"
        length="_pi" rotationAngle="0"/>"#;
    assert!((value(long, "Angle2ElArc_A_12") - 90.0).abs() < 1e-3);
    let cut = r#"<arc id="12" type="simple" center="1" radius="2" angle1="0" angle2="180"/>
        <point id="50" name="T" type="cutArc" arc="12" length="CurrentLength/2"/>"#;
    near(point(cut), 0.0, 2.0);
    assert!((value(cut, "Arc_A_51 - Arc_A_52")).abs() < 1e-9);
    assert!((value(cut, "Angle2Arc_A_51") - 90.0).abs() < 1e-9);
}

#[test]
fn splines_old_and_new() {
    let new = r#"<spline id="12" type="simpleInteractive" point1="1" point4="3" angle1="0" length1="5" angle2="270" length2="5"/>"#;
    assert_eq!(value(new, "Angle1Spl_A_C + Angle2Spl_A_C + C1LengthSpl_A_C + C2LengthSpl_A_C"), 280.0);
    // The control lines of a quarter of a circle of 10 cm are 4/3 tan(22.5 degrees) of its radius.
    let old = r#"<spline id="12" type="simple" point1="1" point4="3" angle1="0" angle2="270" kAsm1="1" kAsm2="1" kCurve="1"/>"#;
    let control = 10.0 * 4.0 / 3.0 * (PI / 8.0).tan();
    assert!((value(old, "C1LengthSpl_A_C") - control).abs() < 1e-9);
    assert!((value(old, "Spl_A_C") - 5.0 * PI).abs() < 5e-3);
    let bezier = r#"<spline id="12" type="cubicBezier" point1="1" point2="2" point3="2" point4="3"/>"#;
    assert_eq!(value(bezier, "C1LengthSpl_A_C"), 10.0);
    let straight = r#"<spline id="12" type="cubicBezierPath"><pathPoint pSpline="1"/><pathPoint pSpline="1"/>
        <pathPoint pSpline="2"/><pathPoint pSpline="2"/></spline>"#;
    assert!((value(straight, "SplPath_A_B") - 10.0).abs() < 1e-6);
    let cut = format!(r#"{old}<point id="50" name="T" type="cutSpline" spline="12" length="Spl_A_C/2"/>"#);
    let at = point(&cut);
    assert!((at.x + at.y - 10.0).abs() < 1e-6, "{at}");
    assert!((value(&cut, "Spl_A_T - Spl_T_C")).abs() < 1e-6);
}

#[test]
fn paths_old_and_new() {
    let old = r#"<spline id="12" type="path" kCurve="1"><pathPoint pSpline="1" angle="0" kAsm1="1" kAsm2="1"/>
        <pathPoint pSpline="3" angle="90" kAsm1="1" kAsm2="1"/><pathPoint pSpline="4" angle="180" kAsm1="1" kAsm2="1"/></spline>"#;
    assert!((value(old, "SplPath_A_D_Seg_1") - 5.0 * PI).abs() < 5e-3);
    assert!((value(old, "Angle1SplPath_A_D_Seg_2") - 90.0).abs() < 1e-9);
    let new = r#"<spline id="12" type="pathInteractive">
        <pathPoint pSpline="1" angle1="180" length1="0" angle2="0" length2="3"/>
        <pathPoint pSpline="2" angle1="180" length1="3" angle2="90" length2="3"/>
        <pathPoint pSpline="3" angle1="270" length1="3" angle2="90" length2="0"/></spline>
        <point id="50" name="T" type="cutSplinePath" splinePath="12" length="-4"/>"#;
    assert!((value(new, "SplPath_A_C") - 20.0).abs() < 1e-6);
    // Below 0 the length counts from the end.
    near(point(new), 10.0, 6.0);
    assert!((value(new, "SplPath_T_C") - 4.0).abs() < 1e-6);
}

#[test]
fn operations_move_points_and_curves() {
    let operation = |kind: &str, how: &str| {
        format!(
            r#"<arc id="12" type="simple" center="1" radius="2" angle1="0" angle2="90"/>
            <spline id="13" type="cubicBezier" point1="1" point2="1" point3="2" point4="2"/>
            <operation id="20" type="{kind}" suffix="x" {how}><source><item idObject="2"/><item idObject="12"/>
            <item idObject="13"/></source>
            <destination><item idObject="50"/><item idObject="51"/><item idObject="52"/></destination></operation>"#
        )
    };
    let turned = operation("rotation", r#"center="1" angle="90""#);
    near(point(&turned), 0.0, 10.0);
    assert_eq!(value(&turned, "Line_A_Bx + Angle1Arc_A_51 + AngleLine_A_Bx"), 10.0 + 90.0 + 90.0);
    assert!((value(&turned, "Spl_A_Bx") - 10.0).abs() < 1e-6);
    near(point(&operation("flippingByLine", r#"p1Line="1" p2Line="3""#)), 0.0, 10.0);
    near(point(&operation("flippingByAxis", r#"center="1" axisType="1""#)), -10.0, 0.0);
    near(point(&operation("flippingByAxis", r#"center="4" axisType="2""#)), 10.0, 20.0);
    near(point(&operation("moving", r#"angle="90" length="3""#)), 10.0, 3.0);
    near(point(&operation("moving", r#"angle="90" length="3" rotationAngle="180" center="1""#)), -10.0, -3.0);
    let named = turned.replace("<item idObject=\"2\"/>", "<item idObject=\"2\" name=\"E\"/>");
    assert_eq!(value(&named, "Line_A_E"), 10.0);
}

#[test]
fn darts_get_legs_of_one_length() {
    // A dart from (4, 0) and (6, 0) to its tip (5, 5) in the base line A B, which is straight again
    // when the dart is closed.
    let tools = r#"<point id="21" name="l" type="single" x="4" y="0"/><point id="22" name="t" type="single" x="5" y="-5"/>
        <point id="23" name="r" type="single" x="6" y="0"/>
        <point id="49" type="trueDarts" baseLineP1="1" baseLineP2="2" dartP1="21" dartP2="22" dartP3="23"
        name1="p" name2="q" point1="50" point2="51"/>"#;
    let draft = drafted(tools, "");
    let (p, q) = (point_of(&draft, 50), point_of(&draft, 51));
    let tip = Point::new(5.0, 5.0);
    assert!(((p - tip).hypot() - (q - tip).hypot()).abs() < 1e-9);
    assert!((p.x + q.x - 10.0).abs() < 1e-9 && p.y < 0.0, "{p} {q}");
    // Closed, the base line runs straight through the first point.
    let turn = kurbo::Affine::rotate_about(-2.0 * (1.0_f64 / 5.0).atan(), tip);
    let closed = turn * Point::new(10.0, 0.0);
    assert!(((closed - Point::ORIGIN).cross(p - Point::ORIGIN)).abs() < 1e-9);
    assert!((value(tools, "Line_p_t - Line_q_t")).abs() < 1e-9);
}

#[test]
fn increments_name_measurements_each_other_and_what_is_drawn() {
    let head = r##"<increments><increment name="#half" formula="waist_circ/2"/>
        <increment name="#more" formula="#half + Line_A_B"/><increment name="#old" base="3"/></increments>"##;
    let draft =
        drafted(r##"<point id="50" type="endLine" basePoint="1" angle="0" length="#more + #old"/>"##, head);
    near(point_of(&draft, 50), 49.0, 0.0);
}

fn faults(tools: &str, head: &str) -> Vec<String> {
    drafted(tools, head).values.faults.iter().map(ToString::to_string).collect()
}

#[test]
fn faults_name_block_tool_and_line() {
    let one = |tools: &str| faults(tools, "").join("\n");
    let tool = |rest: &str| format!(r#"<point id="50" name="T" {rest}/>"#);
    let end = |length: &str| tool(&format!(r#"type="endLine" basePoint="1" angle="0" length="{length}""#));
    assert_eq!(
        one(&end("waist_cir/4")),
        "block \"block\", tool 50 \"T\" (point endLine) (line 5): there is no measurement \"waist_cir\" for its \
         \"length\", which is \"waist_cir/4\""
    );
    assert_eq!(
        one(&end("10*(2")),
        "block \"block\", tool 50 \"T\" (point endLine) (line 5): the formula of its \"length\" is wrong at character \
         6: a closing bracket is missing in \"10*(2\""
    );
    assert_eq!(
        one(&end("1/(2-2)")),
        "block \"block\", tool 50 \"T\" (point endLine) (line 5): the formula of its \"length\" has no finite value: \
         \"1/(2-2)\""
    );
    assert_eq!(
        one(&end("loop")),
        "block \"block\", tool 50 \"T\" (point endLine) (line 5): \"loop\" needs itself"
    );
    assert_eq!(
        one(&tool(r#"type="alongLine" firstPoint="1" secondPoint="77" length="1""#)),
        "block \"block\", tool 50 \"T\" (point alongLine) (line 5): its \"secondPoint\" is object 77, which there is \
         none of"
    );
    assert_eq!(
        one(&tool(r#"type="alongLine" firstPoint="1" secondPoint="50" length="1""#)),
        "block \"block\", tool 50 \"T\" (point alongLine) (line 5): its \"secondPoint\" is object 50, which stands \
         after it"
    );
    assert_eq!(
        one(&tool(r#"type="cutSpline" spline="2" length="1""#)),
        "block \"block\", tool 50 \"T\" (point cutSpline) (line 5): its \"spline\" is object 2, which is no curve"
    );
    assert_eq!(
        one(&tool(r#"type="lineIntersect" p1Line1="1" p2Line1="2" p1Line2="4" p2Line2="3""#)),
        "block \"block\", tool 50 \"T\" (point lineIntersect) (line 5): its lines are parallel and do not meet"
    );
    assert_eq!(
        one(r#"<spline id="50" type="parallelCurve" curve="12" width="1"/>"#),
        "block \"block\", tool 50 (spline parallelCurve) (line 5): the tool is not supported"
    );
    assert_eq!(
        one(&tool(r#"type="endLine" basePoint="1" angle="0""#)),
        "block \"block\", tool 50 \"T\" (point endLine) (line 5): it has no \"length\""
    );
    assert_eq!(
        one(r#"<point id="50" type="single" x="ten" y="0"/>"#),
        "block \"block\", tool 50 (point single) (line 5): its \"x\" is \"ten\", which is no number"
    );
}

#[test]
fn increments_in_a_ring_and_what_follows_from_a_fault_are_told_once() {
    let head = r##"<increments><increment name="#a" formula="#b"/><increment name="#b" formula="#a"/></increments>"##;
    let tools = r##"<point id="50" name="T" type="endLine" basePoint="1" angle="0" length="#a"/>
        <point id="51" name="U" type="endLine" basePoint="50" angle="0" length="2"/>
        <point id="52" name="V" type="endLine" basePoint="1" angle="0" length="Line_A_U + #a"/>"##;
    assert_eq!(faults(tools, head), ["increment \"#b\" (line 1): \"#a\" needs itself, by way of \"#b\""]);
}

#[test]
fn more_curves_than_are_worked_out_are_refused_once() {
    let items = |id: u32| format!("<item idObject=\"{id}\"/>").repeat(100_001);
    let tools = format!(
        "<arc id=\"50\" type=\"simple\" center=\"1\" radius=\"2\" angle1=\"0\" angle2=\"90\"/>\
         <operation id=\"51\" type=\"moving\" angle=\"0\" length=\"1\" suffix=\"a\"><source>{}</source>\
         <destination>{}</destination></operation>",
        items(50),
        items(52)
    );
    assert_eq!(faults(&tools, ""), ["it has more than 100000 curves in its tools and pieces"]);
}
