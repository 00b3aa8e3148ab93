#![allow(clippy::unwrap_used)]
use super::*;

fn individual(body: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><smis><version>0.3.4</version><unit>cm</unit>\
         <body-measurements>{body}</body-measurements></smis>"
    )
}

fn table(text: &str, grade: Grade, unit: LengthUnit) -> MeasurementTable {
    MeasurementTable::read(text.as_bytes(), grade, unit).unwrap()
}

#[test]
fn measurements_of_a_person_are_numbers_and_formulas_in_the_unit_of_the_pattern() {
    let text = individual(
        "<m name=\"waist_circ\" value=\"72\"/><m name=\"waist_arc_f\" value=\"waist_circ/2 + 1\"/>\
         <m name=\"@slope\" value=\"21\" specialUnits=\"true\"/><m name=\"empty\" value=\"\"/>",
    );
    let mut cm = table(&text, Grade::default(), LengthUnit::Centimetre);
    assert_eq!(cm.value("waist_arc_f"), Ok(37.0));
    let mut mm = table(&text, Grade::default(), LengthUnit::Millimetre);
    assert_eq!((mm.value("waist_circ"), mm.value("@slope")), (Ok(720.0), Ok(21.0)));
    assert_eq!(mm.value("empty"), Err(UnknownMeasure::None));
}

#[test]
fn faults_of_measurements_stay_with_those_that_need_them() {
    let text = individual(
        "<m name=\"a\" value=\"b+1\"/><m name=\"b\" value=\"a\"/><m name=\"c\" value=\"2*(3\"/>\
         <m name=\"d\" value=\"1/0\"/><m name=\"e\" value=\"nobody\"/><m name=\"f\" value=\"7\"/>",
    );
    let mut all = table(&text, Grade::default(), LengthUnit::Centimetre);
    assert_eq!(all.value("f"), Ok(7.0));
    assert_eq!(all.value("a"), Err(UnknownMeasure::Ring(vec!["a".into(), "b".into(), "a".into()])));
    let mut what = |name: &str| match all.value(name) {
        Err(UnknownMeasure::Wrong { name, what }) => (name, what),
        other => unreachable!("{other:?}"),
    };
    assert_eq!(what("c"), ("c".into(), "a closing bracket is missing at character 5 of \"2*(3\"".into()));
    assert_eq!(what("d"), ("d".into(), "\"1/0\" has no finite value".into()));
    assert_eq!(what("e"), ("e".into(), "there is no measurement \"nobody\" for \"nobody\"".into()));
}

const SIZES: &str = "<smms><unit>cm</unit><size base=\"50\"/><height base=\"176\"/><body-measurements>\
    <m name=\"bust_circ\" base=\"100\" size_increase=\"4\" height_increase=\"0.5\"/></body-measurements></smms>";

#[test]
fn several_sizes_grow_by_steps_of_2_and_6_cm() {
    let value = |grade: Grade| table(SIZES, grade, LengthUnit::Centimetre).value("bust_circ").unwrap();
    assert_eq!(value(Grade::default()), 100.0);
    assert_eq!(value(Grade { size: Some(54.0), height: Some(182.0), ..Grade::default() }), 108.5);
    assert_eq!(value(Grade { kept: [Some(46.0), None], ..Grade::default() }), 92.0);
    let mut all = table(SIZES, Grade { size: Some(48.0), ..Grade::default() }, LengthUnit::Millimetre);
    assert_eq!((all.value("size"), all.value("height")), (Ok(480.0), Ok(1760.0)));
    let refused = |text: &str, grade| {
        let fault = MeasurementTable::read(text.as_bytes(), grade, LengthUnit::Centimetre).unwrap_err();
        (fault.to_string(), fault.remedy())
    };
    assert_eq!(
        refused(SIZES, Grade { size: Some(90.0), ..Grade::default() }),
        (
            "the measurements have no size 90: it goes from 22 to 72".into(),
            "`--set pattern.size=22` takes the least".into()
        )
    );
    assert_eq!(
        refused(&individual(""), Grade { height: Some(170.0), ..Grade::default() }),
        (
            "a height is asked for, but the measurements have one size".into(),
            "leave `height` out, or name a file of several sizes as `measurements`".into()
        )
    );
}

#[test]
fn newer_files_have_dimensions_with_their_own_steps_and_corrections() {
    let text = "<vst><version>0.6.2</version><unit>cm</unit><dimensions>\
        <dimension type=\"x\" base=\"170\" min=\"158\" max=\"182\" step=\"6\"/>\
        <dimension type=\"y\" base=\"96\" min=\"80\" max=\"120\" step=\"4\"/></dimensions>\
        <body-measurements><m name=\"bust_circ\" base=\"96\" shiftA=\"0\" shiftB=\"4\"><corrections>\
        <correction coordinates=\"170;104;0\" correction=\"0.5\"/></corrections></m></body-measurements></vst>";
    let value = |size| {
        let grade = Grade { size: Some(size), ..Grade::default() };
        table(text, grade, LengthUnit::Centimetre).value("bust_circ").unwrap()
    };
    assert_eq!((value(100.0), value(104.0)), (100.0, 104.5));
}

#[test]
fn files_of_something_else_are_refused() {
    let refused = |text: &str| {
        let read = MeasurementTable::read(text.as_bytes(), Grade::default(), LengthUnit::Centimetre);
        read.unwrap_err().to_string()
    };
    assert_eq!(refused("<pattern/>"), "its first element is \"pattern\", not \"smis, smms, vit or vst\"");
    assert_eq!(
        refused("<vit><version>0.2.0</version><unit>cm</unit><waist_girth value=\"70\"/></vit>"),
        "its measurements are in the form of version 0.2.0, which Valentina wrote before 2015"
    );
    assert_eq!(
        refused("<smis><unit>km</unit></smis>"),
        "its unit is \"km\", which is none of mm, cm and inch"
    );
    assert!(refused("<smis").starts_with("it is no XML at line 1 column "));
}

#[test]
fn measurements_that_are_no_numbers_are_told() {
    let text = SIZES.replace(
        "<body-measurements>",
        "<body-measurements><m name=\"neck\" base=\"wide\"/><m name=\"arm\" base=\"60\" size_increase=\"a bit\"/>\
         <m name=\"none\"/>",
    );
    let table = table(&text, Grade::default(), LengthUnit::Centimetre);
    assert_eq!(
        table.notes[1..],
        ["measurements whose base or growth is no number are left out: \"neck\", \"arm\""]
    );
}
