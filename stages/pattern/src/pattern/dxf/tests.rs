//! Files of our own making: a tank of two half pieces, a pair of legs with a waistband; every
//! refusal word for word.
#![allow(clippy::unwrap_used, clippy::panic)]

use super::super::propose;
use super::*;
use std::fmt::Write;
use std::path::Path as FilePath;
use std::sync::Arc;
use toile_core::Cancel;

/// A file under construction.
#[derive(Default)]
struct Dxf(String);

impl Dxf {
    fn tag(&mut self, code: i32, value: impl std::fmt::Display) -> &mut Self {
        let _ = writeln!(self.0, "{code:3}\n{value}");
        self
    }

    fn block(&mut self, name: &str, size: &str, quantity: Option<&str>) -> &mut Self {
        self.tag(0, "BLOCK").tag(8, 0).tag(2, format!("{name}_{size}"));
        self.text(&format!("Piece Name: {name}")).text(&format!("Size: {size}"));
        if let Some(q) = quantity {
            self.text(&format!("Quantity: {q}"));
        }
        self
    }

    fn text(&mut self, text: &str) -> &mut Self {
        self.tag(0, "TEXT").tag(8, 1).tag(10, 0.0).tag(20, 0.0).tag(1, text)
    }

    fn poly(&mut self, layer: i32, points: &[[f64; 2]]) -> &mut Self {
        self.tag(0, "POLYLINE").tag(8, layer).tag(66, 1).tag(70, 0);
        for [x, y] in points {
            self.tag(0, "VERTEX").tag(8, layer).tag(10, x).tag(20, y);
        }
        self.tag(0, "SEQEND").tag(8, layer)
    }

    fn line(&mut self, layer: i32, a: [f64; 2], b: [f64; 2]) -> &mut Self {
        self.tag(0, "LINE").tag(8, layer).tag(10, a[0]).tag(20, a[1]).tag(11, b[0]).tag(21, b[1])
    }

    fn point(&mut self, layer: i32, [x, y]: [f64; 2], depth: f64) -> &mut Self {
        self.tag(0, "POINT").tag(8, layer).tag(10, x).tag(20, y).tag(39, depth)
    }

    fn end(&mut self) -> &mut Self {
        self.tag(0, "ENDBLK")
    }

    fn bytes(&self, units: Option<&str>) -> Vec<u8> {
        let mut all = Dxf::default();
        all.tag(0, "SECTION").tag(2, "BLOCKS");
        all.0 += &self.0;
        all.tag(0, "ENDSEC").tag(0, "SECTION").tag(2, "ENTITIES");
        all.text("Sample Size: M");
        if let Some(units) = units {
            all.text(&format!("Units: {units}"));
        }
        all.tag(0, "ENDSEC").tag(0, "EOF");
        all.0.into_bytes()
    }
}

/// The right half of a piece lying on its side, grain along x: neck at the right, hem at the left,
/// its middle above.
fn half(d: &mut Dxf, name: &str, size: &str, scale: f64, neck: f64) {
    let s = |x: f64, y: f64| [x * scale, y * scale];
    d.block(name, size, (size == "M").then_some("1"));
    d.poly(1, &[s(600.0 - neck, 0.0), s(600.0, -80.0)]);
    d.poly(1, &[s(600.0, -80.0), s(560.0, -190.0)]);
    d.poly(1, &[s(560.0, -190.0), s(470.0, -180.0), s(380.0, -240.0)]);
    d.poly(1, &[s(380.0, -240.0), s(200.0, -230.0), s(0.0, -250.0)]);
    d.poly(1, &[s(0.0, -250.0), s(0.0, 0.0)]);
    d.poly(1, &[s(0.0, 0.0), s(600.0 - neck, 0.0)]);
    d.line(7, s(100.0, -100.0), s(300.0, -100.0));
    d.line(6, s(0.0, 0.0), s(600.0 - neck, 0.0));
    d.point(4, s(200.0, -230.0), 4.0 * scale);
    d.point(13, s(300.0, -50.0), 0.0);
    d.line(8, s(100.0, -20.0), s(200.0, -20.0));
    d.end();
}

fn tank() -> Dxf {
    let mut d = Dxf::default();
    for (size, scale) in [("S", 0.9), ("M", 1.0)] {
        half(&mut d, "FRONT", size, scale, 150.0);
        half(&mut d, "BACK", size, scale, 30.0);
    }
    d
}

/// The pieces and the remarks on them, warnings first; of several faults the first. The unit is not
/// looked at.
fn asked(size: &str, unit: DrawingUnit) -> DxfPattern {
    DxfPattern { size: size.into(), unit, ..DxfPattern::default() }
}

fn read(bytes: &[u8], size: &str) -> Result<(Vec<Piece>, Vec<String>), DxfDamage> {
    let mut told = Remarks::default();
    let pieces = pieces_of(bytes, &asked(size, DrawingUnit::Millimetres), &mut told);
    pieces.map(|p| (p, [told.warnings, told.notes].concat())).map_err(|mut all| all.remove(0))
}

/// The same in the unit that the file says.
fn in_own_unit(bytes: &[u8]) -> Result<(Vec<Piece>, Remarks), DxfDamage> {
    let mut told = Remarks::default();
    let pieces = pieces_of(bytes, &asked("", DrawingUnit::Auto), &mut told);
    pieces.map(|p| (p, told)).map_err(|mut all| all.remove(0))
}

fn names(p: &Piece) -> Vec<&str> {
    p.outer.edges.iter().map(|e| e.name.as_str()).collect()
}

#[test]
fn half_pieces_are_turned_unfolded_and_scaled() {
    let (pieces, told) = read(&tank().bytes(Some("METRIC")), "m").unwrap();
    assert_eq!(
        told,
        ["piece \"FRONT\" is unfolded at its mirror line", "piece \"BACK\" is unfolded at its mirror line"]
    );
    let front = &pieces[0];
    assert_eq!(names(front).len(), 9);
    let length = |name: &str| front.path(name).unwrap().length();
    // Neck and hem run through the middle; the V of the neck stays two edges.
    assert!((length("edge_4") - 0.5).abs() < 1e-9, "{:?}", names(front));
    for (name, image) in [("edge_1", "edge_1_m"), ("edge_2", "edge_2_m"), ("edge_3", "edge_3_m")] {
        assert!((length(name) - length(image)).abs() < 1e-9);
    }
    let exact = (180.0_f64.hypot(10.0) + 200.0_f64.hypot(20.0)) * 1e-3;
    assert!((length("edge_3") - exact).abs() < 1e-9);
    // The grain runs up, the hem lies below.
    let [a, b] = front.grain.unwrap();
    assert!((b.y - a.y - 0.2).abs() < 1e-12 && (b.x - a.x).abs() < 1e-12);
    let hem = front.path("edge_4").unwrap();
    assert!(hem.points().iter().all(|p| p.y.abs() < 1e-9));
    assert!(polygon_area(&front.outer.points().0) > 0.0);
    assert_eq!((front.notches.len(), front.drill_holes.len(), front.lines.len()), (2, 2, 2));
    let notch = front.notches.iter().find(|n| n.edge == "edge_3").unwrap();
    assert!((notch.depth - 0.004).abs() < 1e-12);
    let at = front.path("edge_3").unwrap().at(notch.along);
    assert!((at.y - 0.2).abs() < 1e-9, "{at}");
    let (small, _) = read(&tank().bytes(Some("METRIC")), "S").unwrap();
    assert!((small[0].path("edge_4").unwrap().length() - 0.45).abs() < 1e-9);
}

#[test]
fn units_and_sizes_that_are_not_given_are_found_and_told() {
    let (pieces, told) = in_own_unit(&tank().bytes(None)).unwrap();
    assert_eq!(told.notes[0], "no size is asked for: \"M\" is read of S, M");
    assert_eq!(
        told.warnings,
        [
            "the file does not say its units: read as millimetres, with which its largest piece is 600 mm long; \
          `--set pattern.unit=Centimetres` says another"
        ]
    );
    let mut d = Dxf::default();
    half(&mut d, "FRONT", "M", 1.0 / 25.4, 150.0);
    let (inches, told) = in_own_unit(&d.bytes(Some("English"))).unwrap();
    assert_eq!(told.notes[0], "the file says that its units are ENGLISH, which are inches");
    // A header says it, too; what says METRIC and is drawn in centimetres is refused with what
    // helps.
    let mut d = Dxf::default();
    half(&mut d, "FRONT", "M", 0.1, 150.0);
    let text = String::from_utf8(d.bytes(None)).unwrap();
    let header = "  0\nSECTION\n  2\nHEADER\n  9\n$INSUNITS\n 70\n5\n  0\nENDSEC\n".to_owned() + &text;
    let (centimetres, told) = in_own_unit(header.as_bytes()).unwrap();
    assert_eq!(told.notes[0], "the file's header says that its units are centimetres");
    let metric = d.bytes(Some("METRIC"));
    let refused = in_own_unit(&metric).unwrap_err();
    assert_eq!(
        (refused.to_string(), refused.remedy()),
        (
            "no one wears a garment of that size: its largest piece, \"FRONT\", would be 6.0 cm long, as the file says that its units are METRIC, which are millimetres".to_owned(),
            "`--set pattern.unit=Centimetres` makes it 60 cm long, `--set pattern.unit=Inches` makes it 152 cm long; where it is meant to be of that size, `--set pattern.unit=Millimetres` says so".to_owned()
        )
    );
    let asked = pieces_of(&metric, &asked("", DrawingUnit::Centimetres), &mut Remarks::default()).unwrap();
    let length = |p: &[Piece]| p[0].path("edge_3").unwrap().length();
    assert!((length(&inches) - length(&pieces)).abs() < 1e-6);
    assert!((length(&centimetres) - length(&pieces)).abs() < 1e-9);
    assert!((length(&asked) - length(&pieces)).abs() < 1e-9);
}

/// A leg, cut twice, and a waistband in two halves; lengths to a tenth of a millimetre as CAD
/// programs write them.
fn leggings() -> Dxf {
    let mut d = Dxf::default();
    d.block("LEG", "M", Some("1,1"));
    d.poly(1, &[[700.0, 0.0], [950.0, 40.0]]);
    d.poly(1, &[[950.0, 40.0], [950.0, 385.0]]);
    d.poly(1, &[[950.0, 385.0], [700.0, 480.0]]);
    d.poly(1, &[[700.0, 480.0], [0.0, 360.0]]);
    d.poly(1, &[[0.0, 360.0], [0.0, 120.0]]);
    d.poly(1, &[[0.0, 120.0], [700.0, 0.0]]);
    d.line(7, [200.0, 200.0], [600.0, 200.0]);
    d.end();
    d.block("BAND", "M", Some("1"));
    d.poly(1, &[[0.0, 0.0], [345.0, 0.0]]).poly(1, &[[345.0, 0.0], [690.0, 0.0]]);
    d.poly(1, &[[690.0, 0.0], [690.0, 50.0]]);
    d.poly(1, &[[690.0, 50.0], [345.0, 50.0]]).poly(1, &[[345.0, 50.0], [0.0, 50.0]]);
    d.poly(1, &[[0.0, 50.0], [0.0, 0.0]]);
    d.line(7, [100.0, 20.0], [100.0, 40.0]);
    d.end();
    d
}

#[test]
fn pairs_are_cut_as_often_as_the_quantity_says() {
    let (pieces, told) = read(&leggings().bytes(Some("METRIC")), "").unwrap();
    let all: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(all, ["LEG", "LEG_mirrored", "BAND"]);
    assert_eq!(told, ["piece \"LEG\" is cut 1 times as drawn and 1 times mirrored"]);
    assert!(pieces.iter().all(|p| polygon_area(&p.outer.points().0) > 0.0));
    let text = String::from_utf8(leggings().bytes(Some("METRIC"))).unwrap();
    let (pieces, told) = read(text.replace("Quantity: 1,1", "Quantity: 0").as_bytes(), "").unwrap();
    assert_eq!((pieces.len(), told[0].as_str()), (1, "piece \"LEG\" is cut 0 times: left out"));
    let (pieces, _) = read(text.replace("Quantity: 1,1", "Quantity: 2").as_bytes(), "").unwrap();
    assert_eq!(pieces.len(), 3);
    for (quantity, both) in
        [("2", (1, 1)), ("1 pair", (1, 1)), ("1/1", (1, 1)), ("3,0", (3, 0)), ("L1 R1", (1, 1)), ("", (1, 0))]
    {
        assert_eq!(cut(Some(quantity)), Ok(both), "{quantity}");
    }
    let (_, told) = read(text.replace("Quantity: 1,1", "Quantity: many").as_bytes(), "").unwrap();
    assert_eq!(told, ["piece \"LEG\" (line 5): the quantity \"many\" is no number: cut once"]);
}

/// A rectangle of 300 by 200 whose right end is a half circle, drawn by a change of the usual
/// boundary.
fn rounded(change: &dyn Fn(&mut Dxf)) -> Result<(Vec<Piece>, Vec<String>), DxfDamage> {
    let mut d = Dxf::default();
    d.block("TAB", "M", None);
    change(&mut d);
    d.end();
    read(&d.bytes(Some("METRIC")), "")
}

#[test]
fn arcs_are_arcs_however_they_are_drawn() {
    let lw = |d: &mut Dxf| {
        d.tag(0, "LWPOLYLINE").tag(8, 1).tag(90, 4).tag(70, 1);
        for (x, y, bulge) in [(0.0, 0.0, 0.0), (300.0, 0.0, 1.0), (300.0, 200.0, 0.0), (0.0, 200.0, 0.0)] {
            d.tag(10, x).tag(20, y).tag(42, bulge);
        }
    };
    let old = |d: &mut Dxf| {
        d.tag(0, "POLYLINE").tag(8, 1).tag(66, 1).tag(70, 1);
        for (x, y, bulge) in [(0.0, 0.0, 0.0), (300.0, 0.0, 1.0), (300.0, 200.0, 0.0), (0.0, 200.0, 0.0)] {
            d.tag(0, "VERTEX").tag(8, 1).tag(10, x).tag(20, y).tag(42, bulge);
        }
        d.tag(0, "SEQEND").tag(8, 1);
    };
    let straight = |d: &mut Dxf| {
        d.poly(1, &[[300.0, 200.0], [0.0, 200.0], [0.0, 0.0], [300.0, 0.0]]);
    };
    let arc = |d: &mut Dxf| {
        straight(d);
        d.tag(0, "ARC").tag(8, 1).tag(10, 300.0).tag(20, 100.0).tag(40, 100.0).tag(50, 270.0).tag(51, 90.0);
    };
    let ellipse = |d: &mut Dxf| {
        straight(d);
        d.tag(0, "ELLIPSE").tag(8, 1).tag(10, 300.0).tag(20, 100.0).tag(11, 0.0).tag(21, -100.0).tag(40, 1.0);
        d.tag(41, 0.0).tag(42, std::f64::consts::PI);
    };
    for (k, draw) in [&lw as &dyn Fn(&mut Dxf), &old, &arc, &ellipse].into_iter().enumerate() {
        let (pieces, told) = rounded(draw).unwrap();
        let around: f64 = (0..pieces[0].outer.edges.len()).map(|k| pieces[0].outer.path(k).length()).sum();
        assert!((around - (0.8 + 0.1 * std::f64::consts::PI)).abs() < 1e-6, "{k}: {around}");
        assert_eq!(told, Vec::<String>::new());
    }
    let circle = |d: &mut Dxf| {
        d.tag(0, "CIRCLE").tag(8, 1).tag(10, 0.0).tag(20, 0.0).tag(40, 150.0);
    };
    let area = polygon_area(&rounded(&circle).unwrap().0[0].outer.points().0);
    assert!((area / (0.0225 * std::f64::consts::PI) - 1.0).abs() < 1e-4, "{area}");
}

#[test]
fn what_is_not_read_is_told_with_its_place() {
    let square = [[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0], [0.0, 0.0]];
    let (_, told) = rounded(&|d| {
        d.poly(1, &square).poly(1, &[[50.0, 50.0], [90.0, 50.0], [90.0, 90.0], [50.0, 50.0]]);
        d.tag(0, "HATCH")
            .tag(8, 1)
            .tag(0, "LINE")
            .tag(8, "PRINT")
            .tag(10, 0.0)
            .tag(20, 0.0)
            .tag(11, 9.0)
            .tag(21, 9.0);
        d.tag(0, "DIMENSION").tag(8, 1);
    })
    .unwrap();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(
        told[0].starts_with("piece \"TAB\": beside its boundary there are closed lines on layer 1 (line ")
    );
    assert!(told[1].starts_with("left out: 1 HATCH of piece \"TAB\" (line "), "{}", told[1]);
    assert!(told[1].contains(", 1 line on layer \"PRINT\" of piece \"TAB\" (line "), "{}", told[1]);
}

#[test]
fn layouts_are_no_pieces_and_pieces_without_a_size_are_of_every_one() {
    let square = [[0.0, 0.0], [300.0, 0.0], [300.0, 300.0], [0.0, 300.0], [0.0, 0.0]];
    let mut d = tank();
    d.tag(0, "BLOCK").tag(8, 0).tag(2, "*Model_Space").poly(1, &square).end();
    d.tag(0, "BLOCK").tag(8, 0).tag(2, "POCKET_LEFT").poly(1, &square).end();
    d.tag(0, "BLOCK")
        .tag(8, 0)
        .tag(2, "COLLAR")
        .tag(0, "MTEXT")
        .tag(8, 1)
        .tag(1, "Size: S\\PPiece Name: COLLAR");
    d.poly(1, &square).end();
    let (pieces, told) = read(&d.bytes(Some("METRIC")), "").unwrap();
    let names: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["FRONT", "BACK", "POCKET_LEFT"]);
    assert!(told[0].starts_with("piece \"COLLAR\" (line "), "{}", told[0]);
    assert!(told[0].ends_with(") is not there in size \"M\", but in \"S\": left out"), "{}", told[0]);
    assert!(
        told[1].starts_with("left out: what is drawn on the layout \"*Model_Space\" (line "),
        "{}",
        told[1]
    );
}

#[test]
fn all_faults_of_a_file_are_told_at_once() {
    let mut d = Dxf::default();
    for name in ["FRONT", "BACK"] {
        d.block(name, "M", None).poly(1, &[[0.0, 0.0], [100.0, 0.0], [100.0, 90.0]]).end();
    }
    let all =
        pieces_of(&d.bytes(None), &asked("", DrawingUnit::Millimetres), &mut Remarks::default()).unwrap_err();
    assert_eq!(all.len(), 2, "{all:?}");
}

/// The proposals as pairs of words, each in order.
fn proposals(pieces: &[Piece]) -> Vec<String> {
    let mut all: Vec<String> = propose::proposed_seams(pieces).into_iter().map(|p| p.seam.name).collect();
    all.sort();
    all
}

#[test]
fn a_tank_is_sewn_at_shoulders_and_sides_and_never_at_its_hem() {
    let (pieces, _) = read(&tank().bytes(Some("METRIC")), "").unwrap();
    let found = proposals(&pieces);
    for seam in [
        "edge_1 + BACK.edge_1_m",
        "edge_1_m + BACK.edge_1",
        "edge_3 + BACK.edge_3_m",
        "edge_3_m + BACK.edge_3",
    ] {
        assert!(found.contains(&format!("FRONT.{seam}")), "{seam}: {found:?}");
    }
    assert!(found.iter().all(|s| !s.contains("edge_4")), "{found:?}");
}

#[test]
fn a_leg_is_sewn_to_itself_to_its_image_and_to_its_band() {
    let (pieces, _) = read(&leggings().bytes(Some("METRIC")), "").unwrap();
    let found = proposals(&pieces);
    for seam in
        ["LEG.edge_3 + LEG.edge_5", "LEG.edge_0 + LEG_mirrored.edge_0", "LEG.edge_2 + LEG_mirrored.edge_2"]
    {
        assert!(found.iter().any(|s| s == seam), "{seam}: {found:?}");
    }
    // Both legs to the same long side of the band: edges 0 and 1, or 3 and 4.
    let waist = |leg: &str| {
        let number = |k: &u32| found.iter().any(|s| *s == format!("{leg}.edge_1 + BAND.edge_{k}"));
        (0..6).find(number).unwrap_or_else(|| panic!("{leg}: {found:?}"))
    };
    assert_eq!(waist("LEG") / 3, waist("LEG_mirrored") / 3, "{found:?}");
    assert!(found.iter().all(|s| !s.contains("edge_4 ") && !s.ends_with("LEG_mirrored.edge_4")), "{found:?}");
}

fn run(
    folder: &FilePath,
    stage: &DxfPattern,
) -> Result<(Pattern, SewingPlan, OutputFiles, Vec<String>), StageError> {
    let cx = Context::new("DxfPattern", folder, Cancel::new(), Arc::new(()));
    let (pattern, _, plan, files) = stage.run(&cx)?;
    Ok((pattern, plan, files, cx.take_remarks().warnings))
}

#[test]
fn nothing_is_sewn_until_the_proposals_are_given_back() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("leg.dxf"), leggings().bytes(Some("METRIC"))).unwrap();
    let unit = DrawingUnit::Auto;
    let stage = DxfPattern { file: "leg.dxf".into(), ..asked("M", unit) };
    let (pattern, plan, files, told) = run(dir.path(), &stage).unwrap();
    assert!(pattern.seams.is_empty() && plan.seams.is_empty() && pattern.check().is_ok());
    let count = propose::proposed_seams(&pattern.pieces).len();
    assert_eq!(
        told.last().unwrap(),
        &format!(
            "no seams are given, and nothing is sewn: {count} are proposed in seams.ron; look through it and give it as `seams`"
        )
    );
    assert_eq!(files.0[0].path, "seams.ron");
    std::fs::write(dir.path().join("seams.ron"), &files.0[0].bytes).unwrap();
    let (pattern, plan, files, _) =
        run(dir.path(), &DxfPattern { seams: "seams.ron".into(), ..stage }).unwrap();
    assert_eq!(pattern.seams.len(), count);
    assert!(plan.seams.len() >= count && files.0.is_empty());
}

#[test]
fn damage_is_refused_with_piece_and_line() {
    #[track_caller]
    fn is(bytes: &[u8], size: &str, sentence: &str, remedy: &str) {
        let d = read(bytes, size).unwrap_err();
        assert_eq!((d.to_string().as_str(), d.remedy().as_str()), (sentence, remedy));
    }
    let pairs = "export the file again; a DXF is pairs of lines, a code and its value";
    is(b"AutoCAD Binary DXF\r\n\x1a\0", "", "it is a binary DXF", "export it as ASCII DXF, release 12");
    is(b"  0\nSECTION\nhello\nx\n", "", "\"hello\" at line 3 is no group code", pairs);
    is(b"  0\n", "", "it ends at line 1, within a pair of code and value", pairs);
    let blocks = "export it as AAMA or ASTM DXF, a block for each piece and size";
    is(b"  0\nEOF\n", "", "there are no pieces: no block has a boundary on layer 1", blocks);
    is(&tank().bytes(Some("METRIC")), "XL", "there is no size \"XL\"", "the sizes are S, M");
    let cubits = in_own_unit(&tank().bytes(Some("CUBITS"))).unwrap_err();
    assert_eq!(
        (cubits.to_string().as_str(), cubits.remedy().as_str()),
        ("the units are \"CUBITS\", they are ENGLISH or METRIC", "export it with its units")
    );
    let piece = |change: &dyn Fn(&mut Dxf)| {
        let mut d = Dxf::default();
        d.block("P", "M", None);
        change(&mut d);
        d.end();
        d.bytes(Some("METRIC"))
    };
    let closed = "draw the boundary as one closed line that meets itself nowhere";
    let open = piece(&|d| {
        d.poly(1, &[[0.0, 0.0], [100.0, 0.0]])
            .poly(1, &[[100.0, 20.0], [0.0, 90.0]])
            .poly(1, &[[0.0, 90.0], [0.0, 0.0]]);
    });
    is(
        &open,
        "",
        "piece \"P\" (line 5): its boundary is open by 20.0 mm near (100.0, 0.0) in the file's units",
        closed,
    );
    let crossing = piece(&|d| {
        d.poly(1, &[[0.0, 0.0], [100.0, 100.0], [100.0, 0.0], [0.0, 90.0], [0.0, 0.0]]);
    });
    let d = read(&crossing, "").unwrap_err();
    assert!(d.to_string().starts_with("piece \"P\" (line 5): its boundary crosses itself near ("), "{d}");
    let square = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [0.0, 0.0]];
    let far = piece(&|d| {
        d.poly(1, &square).line(6, [500.0, 0.0], [500.0, 100.0]);
    });
    is(
        &far,
        "",
        "piece \"P\" (line 5): its mirror line does not lie on its boundary",
        "let the mirror line run along a straight edge of the boundary",
    );
    let word = piece(&|d| {
        d.poly(1, &square).tag(0, "POINT").tag(8, 13).tag(10, "NaN");
    });
    let d = read(&word, "").unwrap_err();
    assert!(d.to_string().starts_with("\"NaN\" at line "), "{d}");
    assert_eq!(d.remedy(), pairs);
    let hole = piece(&|d| {
        d.poly(1, &square).poly(11, &[[20.0, 20.0], [40.0, 20.0], [40.0, 40.0]]);
    });
    let d = read(&hole, "").unwrap_err();
    assert!(
        d.to_string().ends_with("is open by 28.3 mm") && d.to_string().contains("a cut-out (line "),
        "{d}"
    );
}

#[test]
fn a_boundary_in_one_line_is_split_at_its_corners_and_a_hair_is_closed() {
    let piece = |points: &[[f64; 2]]| {
        let mut d = Dxf::default();
        d.block("P", "M", None).poly(1, points).end();
        read(&d.bytes(Some("METRIC")), "")
    };
    let (pieces, _) =
        piece(&[[0.0, 0.0], [50.0, -2.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0], [0.0, 0.0]]).unwrap();
    assert_eq!(pieces[0].outer.edges.len(), 4);
    let mut d = Dxf::default();
    d.block("P", "M", None);
    d.poly(1, &[[0.0, 0.0], [100.0, 0.0], [100.0, 99.0]])
        .poly(1, &[[100.0, 100.0], [0.0, 100.0], [0.0, 0.0]])
        .end();
    let (_, told) = read(&d.bytes(Some("METRIC")), "").unwrap();
    assert_eq!(
        told[0],
        "the boundary of piece \"P\" was open by 1.00 mm between \"edge_0\" and \"edge_1\": closed"
    );
}

#[test]
fn names_are_read_in_the_encoding_that_is_asked_for() {
    let mut d = Dxf::default();
    half(&mut d, "Front", "M", 1.0, 60.0);
    let (name, _, _) = encoding_rs::SHIFT_JIS.encode("前身頃");
    let plain = d.bytes(None);
    let cut = |bytes: &[u8], of: &[u8], by: &[u8]| -> Vec<u8> {
        let at = bytes.windows(of.len()).position(|w| w == of).unwrap();
        [&bytes[..at], by, &bytes[at + of.len()..]].concat()
    };
    let bytes = cut(&plain, b"Piece Name: Front", &[b"Piece Name: ", name.as_ref()].concat());
    let named = |encoding: &str| {
        let asked = DxfPattern { encoding: encoding.into(), ..asked("", DrawingUnit::Millimetres) };
        pieces_of(&bytes, &asked, &mut Remarks::default()).map(|p| p[0].name.clone())
    };
    assert_eq!(named("shift_jis").unwrap(), "前身頃");
    assert_ne!(named("").unwrap(), "前身頃");
    let refused = named("jis 3").unwrap_err().remove(0);
    assert_eq!(
        (refused.to_string().as_str(), refused.fault().param),
        ("there is no encoding \"jis 3\"", "encoding")
    );
    assert_eq!(named("utf-8").unwrap_err()[0].to_string(), "it is not text in \"utf-8\"");
}
