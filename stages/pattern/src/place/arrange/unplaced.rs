//! Patterns without poses: what is decided of each piece, where it stands, what is refused.
#![allow(clippy::unwrap_used)]

use super::Arrange;
use super::region::{Decided, Region, Side, decide, undecided};
use crate::mesh::GridMesher;
use std::collections::BTreeSet;
use toile_core::prelude::*;

fn piece(name: &str, corners: &[[f64; 2]], edges: &[&str]) -> Piece {
    Piece {
        name: name.into(),
        outer: PatternLoop {
            corners: corners.iter().map(|[x, y]| Point2::new(*x, *y)).collect(),
            edges: edges.iter().map(|n| PieceEdge { name: (*n).into(), curve: EdgeCurve::Line }).collect(),
        },
        ..Piece::default()
    }
}

fn seam(a: (&str, &str), b: (&str, &str)) -> PatternSeam {
    let side = |(p, e): (&str, &str), reversed| {
        vec![EdgeUse { edge: EdgeRef { panel: p.into(), edge: e.into() }, reversed }]
    };
    PatternSeam {
        name: format!("{}.{} + {}.{}", a.0, a.1, b.0, b.1),
        kind: SeamKind::Matched,
        sides: vec![side(a, false), side(b, true)],
    }
}

/// A tank of front and back, named as a CAD program does.
fn tank() -> Pattern {
    let corners = [
        [-0.24, 0.0],
        [0.24, 0.0],
        [0.24, 0.4],
        [0.16, 0.6],
        [0.1, 0.61],
        [-0.1, 0.61],
        [-0.16, 0.6],
        [-0.24, 0.4],
    ];
    let edges = ["hem", "side_l", "arm_l", "shoulder_l", "neck", "shoulder_r", "arm_r", "side_r"];
    let pair =
        |a: &str, b: &str| [seam(("TANK FRT", a), ("TANK BK", b)), seam(("TANK FRT", b), ("TANK BK", a))];
    Pattern {
        name: "tank".into(),
        pieces: vec![piece("TANK FRT", &corners, &edges), piece("TANK BK", &corners, &edges)],
        seams: [pair("side_l", "side_r"), pair("shoulder_l", "shoulder_r")].concat(),
    }
}

/// Legs in one piece each with a waistband; only its name says what the band is.
fn leggings() -> Pattern {
    let left = [[0.12, 0.0], [0.36, 0.0], [0.52, 0.65], [0.46, 0.95], [0.1, 0.93], [0.02, 0.65]];
    let right: Vec<[f64; 2]> = (0..6).map(|k| left[(6 - k) % 6]).map(|[x, y]| [-x, y]).collect();
    let names = ["hem", "in_back", "rise_back", "waist", "rise_front", "in_front"];
    let turned: Vec<&str> = names.iter().rev().copied().collect();
    let band = [[0.0, 0.0], [0.36, 0.0], [0.72, 0.0], [0.72, 0.05], [0.0, 0.05]];
    let own = |p: &'static str| seam((p, "in_back"), (p, "in_front"));
    let both = |e: &'static str| seam(("LL", e), ("LL_mirrored", e));
    Pattern {
        name: "leggings".into(),
        pieces: vec![
            piece("LL", &left, &names),
            piece("LL_mirrored", &right, &turned),
            piece("WB", &band, &["low_a", "low_b", "end_a", "top", "end_b"]),
        ],
        seams: vec![
            own("LL"),
            own("LL_mirrored"),
            both("rise_back"),
            both("rise_front"),
            seam(("WB", "end_a"), ("WB", "end_b")),
            seam(("WB", "low_a"), ("LL_mirrored", "waist")),
            seam(("WB", "low_b"), ("LL", "waist")),
        ],
    }
}

/// The tank with sleeves, sewn in with their fronts to the front.
fn tee() -> Pattern {
    let mut tee = tank();
    let corners = [[-0.2, 0.0], [0.2, 0.0], [0.2, 0.1], [0.0, 0.2], [-0.2, 0.1]];
    let names = ["hem", "under_a", "cap_a", "cap_b", "under_b"];
    for (sleeve, arms) in [("right sleeve", ["arm_r", "arm_l"]), ("left sleeve", ["arm_r", "arm_l"])] {
        tee.pieces.push(piece(sleeve, &corners, &names));
        tee.seams.push(seam((sleeve, "under_a"), (sleeve, "under_b")));
        let bodies = if sleeve == "right sleeve" { ["TANK FRT", "TANK BK"] } else { ["TANK BK", "TANK FRT"] };
        let mut cap = seam((sleeve, "cap_a"), (bodies[0], arms[0]));
        cap.sides[0]
            .push(EdgeUse { reversed: false, ..seam((sleeve, "cap_b"), ("", "")).sides[0][0].clone() });
        cap.sides[1].extend(seam((sleeve, "cap_b"), (bodies[1], arms[1])).sides[1].clone());
        tee.seams.push(cap);
    }
    tee
}

fn arranged(pattern: &Pattern) -> Result<Garment, StageError> {
    arranged_with(pattern, "()")
}

fn arranged_with(pattern: &Pattern, params: &str) -> Result<Garment, StageError> {
    let lowered = pattern.lower().unwrap();
    let mesher: GridMesher = toile_core::param::ron_options().from_str("(edge: \"20 mm\")").unwrap();
    let panel =
        |(name, o): (&String, &Outline)| (name.clone(), mesher.run(o, &Context::quiet()).unwrap().into());
    let panels = Set(lowered.outlines.iter().map(panel).collect());
    let lengths = "(height: \"168 cm\", bust: \"80 cm\", waist: \"66 cm\", hip: \"85 cm\")";
    let body = toile_fixtures::mannequin(lengths).unwrap();
    let stage: Arrange = toile_core::param::ron_options().from_str(params).unwrap();
    let fabric = toile_core::testkit::dress::fabric();
    stage.run(pattern, panels, &lowered.plan, &body, &fabric, &Context::quiet())
}

fn middle(garment: &Garment, panel: &str) -> Vector3 {
    let panel = garment.panels.iter().find(|p| p.name == panel).unwrap();
    let points = &garment.positions[panel.vertices.clone()];
    points.iter().map(|p| p.coords).sum::<Vector3>() / points.len() as f64
}

fn widest_gap(garment: &Garment) -> f64 {
    let pairs = garment.seams.iter().flat_map(|s| &s.pairs);
    pairs
        .map(|[a, b]| (garment.positions[*a as usize] - garment.positions[*b as usize]).norm())
        .fold(0.0, f64::max)
}

/// The mean normal of a panel points away from the middle of the body, as its outside does.
fn looks_out(garment: &Garment, panel: &str) -> bool {
    let panel = garment.panels.iter().find(|p| p.name == panel).unwrap();
    let out: f64 = garment.triangles[panel.triangles.clone()]
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| garment.positions[v as usize]);
            let away = Vector3::new(a.x, 0.0, a.z);
            (b - a).cross(&(c - a)).dot(&away)
        })
        .sum();
    out > 0.0
}

#[test]
fn fronts_and_backs_are_known_by_the_short_words_of_cad_programs() {
    let decided = decide(&tank(), &BTreeSet::new(), &BTreeSet::new()).unwrap();
    let why = |word: &str| {
        format!(
            "the word \"{word}\" in its name; it is sewn at its upper end beside the middle, as shoulders are"
        )
    };
    let one = |side, word| Decided { region: Region::Trunk, side, hand: None, why: why(word) };
    assert_eq!(decided, [one(Side::Front, "frt"), one(Side::Back, "bk")]);
}

#[test]
fn a_tank_hangs_from_the_shoulders_before_and_behind_the_body() {
    let g = arranged(&tank()).unwrap();
    let (front, back) = (middle(&g, "TANK FRT"), middle(&g, "TANK BK"));
    assert!(front.z > 0.1 && back.z < -0.1, "{front} {back}");
    assert!(front.x.abs() < 1e-3 && (front.y - back.y).abs() < 1e-9);
    assert!(looks_out(&g, "TANK FRT") && looks_out(&g, "TANK BK"));
    // Sides and shoulders lie as far apart as the pieces.
    assert!((widest_gap(&g) - (front.z - back.z)).abs() < 1e-9, "{}", widest_gap(&g));
}

#[test]
fn legs_go_around_their_own_leg_and_the_band_around_the_waist() {
    let pattern = leggings();
    let decided = decide(&pattern, &BTreeSet::new(), &BTreeSet::new()).unwrap();
    let found: Vec<Region> = decided.iter().map(|d| d.region).collect();
    assert_eq!(found, [Region::Leg(Hand::Left), Region::Leg(Hand::Right), Region::Waist]);
    let g = arranged(&pattern).unwrap();
    assert!(middle(&g, "LL").x > 0.05 && middle(&g, "LL_mirrored").x < -0.05);
    assert!(["LL", "LL_mirrored", "WB"].iter().all(|p| looks_out(&g, p)));
    let band = g.panels.iter().find(|p| p.name == "WB").unwrap();
    let low = g.positions[band.vertices.clone()].iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let legs = g.panels.iter().filter(|p| p.name != "WB").flat_map(|p| &g.positions[p.vertices.clone()]);
    let high = legs.map(|p| p.y).fold(0.0, f64::max);
    assert!((low - high).abs() < 0.02, "{low} {high}");
}

#[test]
fn sleeves_go_around_the_arm_whose_armhole_they_are_sewn_into() {
    let pattern = tee();
    let decided = decide(&pattern, &BTreeSet::new(), &BTreeSet::new()).unwrap();
    let found: Vec<Region> = decided.iter().skip(2).map(|d| d.region).collect();
    assert_eq!(found, [Region::Arm(Hand::Right), Region::Arm(Hand::Left)]);
    let g = arranged(&pattern).unwrap();
    assert!(middle(&g, "right sleeve").x < -0.2 && middle(&g, "left sleeve").x > 0.2);
    for (sleeve, hand) in [("right sleeve", Hand::Right), ("left sleeve", Hand::Left)] {
        let panel = g.panels.iter().find(|p| p.name == sleeve).unwrap();
        let of = |far: &dyn Fn(Point2) -> f64| {
            let all = panel.vertices.clone();
            all.max_by(|a, b| far(g.rest[*a]).total_cmp(&far(g.rest[*b]))).unwrap()
        };
        // The top of the cap is over the arm, the hem farther out; the left sleeve's left half is
        // before the arm.
        let (top, hem, at_left) =
            (of(&|p| p.y), of(&|p| -p.y - p.x.abs()), of(&|p| 0.1 - (p.x + 0.1).abs() - (p.y - 0.1).abs()));
        let at = |v: usize| g.positions[v];
        assert!(at(top).y > at(hem).y && at(hem).x * hand.sign() > at(top).x * hand.sign(), "{sleeve}");
        assert!((at(at_left).z - at(top).z) * hand.sign() > 0.02, "{sleeve}: {} {}", at(at_left), at(top));
    }
}

#[test]
fn a_band_in_one_edge_is_turned_so_that_its_stretches_lie_at_what_they_are_sewn_to() {
    let flat = |name: &str| {
        piece(name, &[[-0.25, 0.0], [0.25, 0.0], [0.2, 0.6], [-0.2, 0.6]], &["hem", "left", "waist", "right"])
    };
    let band = piece(
        "WAISTBAND",
        &[[0.0, 0.0], [0.8, 0.0], [0.8, 0.05], [0.0, 0.05]],
        &["low", "end_a", "top", "end_b"],
    );
    let (sides, mut waist) =
        ([("left", "right"), ("right", "left")], seam(("WAISTBAND", "low"), ("FRONT", "waist")));
    waist.sides[1].extend(seam(("WAISTBAND", "low"), ("BACK", "waist")).sides[1].clone());
    let pattern = Pattern {
        name: "skirt".into(),
        pieces: vec![flat("FRONT"), flat("BACK"), band],
        seams: sides.iter().map(|(a, b)| seam(("FRONT", a), ("BACK", b))).chain([waist]).collect(),
    };
    let g = arranged(&pattern).unwrap();
    let panel = g.panels.iter().find(|p| p.name == "WAISTBAND").unwrap();
    // The first half of the band goes along the front, the second along the back.
    let half = |from: f64, to: f64| {
        let own: Vec<usize> =
            panel.vertices.clone().filter(|v| g.rest[*v].x > from && g.rest[*v].x < to).collect();
        own.iter().map(|v| g.positions[*v].z).sum::<f64>() / own.len() as f64
    };
    assert!(half(0.01, 0.39) > 0.05 && half(0.41, 0.79) < -0.05, "{} {}", half(0.01, 0.39), half(0.41, 0.79));
}

#[test]
fn what_cannot_be_sewn_or_placed_is_refused_by_name() {
    let refused = |pattern: &Pattern| {
        let e = arranged(pattern).unwrap_err();
        (e.message, e.hint.unwrap_or_default())
    };
    let mut bare = tank();
    bare.seams.clear();
    assert_eq!(
        refused(&bare),
        (
            "the pattern has no seams: its pieces would fall to the floor".into(),
            "give its reader the file of seams that you have looked through as `seams`".into()
        )
    );
    let mut loose = tank();
    loose.pieces.push(piece("BADGE", &[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]], &["a", "b", "c"]));
    assert_eq!(
        refused(&loose),
        (
            "the piece \"BADGE\" is sewn to nothing and would fall".into(),
            "write its seams into the file that the reader takes as `seams`, or take the piece out".into()
        )
    );
    let hint = "call it front, back or waistband, place it by `hand_places` or `key_points` of `Arrange`, or give its pattern places around the body, as GarmentCode files have";
    let renamed = |name: &str| {
        let mut p = tank();
        p.pieces[0].name = name.into();
        let uses = p.seams.iter_mut().flat_map(|s| s.sides.iter_mut().flatten());
        uses.filter(|u| u.edge.panel == "TANK FRT").for_each(|u| u.edge.panel = name.into());
        refused(&p)
    };
    assert_eq!(renamed("P1"), ("nothing says where the piece \"P1\" stands".into(), hint.into()));
    assert_eq!(
        renamed("TANK SLV"),
        ("nothing tells whether the sleeve \"TANK SLV\" is the left or the right one".into(), hint.into())
    );
    assert_eq!(
        renamed("TANK COLLAR"),
        (
            "nothing places the piece \"TANK COLLAR\", a \"collar\" by its name, without a pose".into(),
            hint.into()
        )
    );
}

/// A tank with a collar, which no rule places.
fn collared() -> Pattern {
    let mut tank = tank();
    let corners = [[0.0, 0.0], [0.2, 0.0], [0.2, 0.06], [0.0, 0.06]];
    tank.pieces.push(piece("TANK COLLAR", &corners, &["neck", "end_l", "top", "end_r"]));
    tank.seams.push(seam(("TANK COLLAR", "neck"), ("TANK BK", "neck")));
    tank
}

#[test]
fn key_points_place_a_piece_that_no_rule_does() {
    let at = "(key_points: [(edge: \"TANK COLLAR.neck\", at: 0.5, landmark: \"neck_base_back\")])";
    let garment = arranged_with(&collared(), at).unwrap();
    let lengths = "(height: \"168 cm\", bust: \"80 cm\", waist: \"66 cm\", hip: \"85 cm\")";
    let neck = toile_fixtures::mannequin(lengths).unwrap().landmarks["neck_base_back"];
    let collar = middle(&garment, "TANK COLLAR");
    assert!((collar.x - neck.x).abs() < 1e-3 && (collar.y - neck.y - 0.03).abs() < 1e-3, "{collar} {neck}");
    assert!((neck.z - collar.z - 0.02).abs() < 1e-3, "{collar} {neck}");
    assert!(looks_out(&garment, "TANK COLLAR"));
    // The others stand as they do without the collar, whose seam divides the neckline otherwise.
    let off = middle(&garment, "TANK FRT") - middle(&arranged(&tank()).unwrap(), "TANK FRT");
    assert!(off.norm() < 5e-3, "{off}");
}

#[test]
fn every_piece_may_be_placed_by_hand() {
    let front = "(edge: \"TANK FRT.neck\", at: 0.5, landmark: \"neck_base_front\")";
    let back = "(edge: \"TANK BK.neck\", at: 0.5, landmark: \"neck_base_back\")";
    let garment = arranged_with(&tank(), &format!("(key_points: [{front}, {back}])")).unwrap();
    assert!(middle(&garment, "TANK FRT").z > middle(&garment, "TANK BK").z);
}

#[test]
fn key_points_on_what_is_not_there_are_refused_with_what_is() {
    let refused = |edge: &str, landmark: &str| {
        let key = format!("(key_points: [(edge: \"{edge}\", at: 0.5, landmark: \"{landmark}\")])");
        let e = arranged_with(&tank(), &key).unwrap_err();
        (e.message, e.hint.unwrap_or_default())
    };
    let (message, hint) = refused("TANK SIDE.neck", "waist_back");
    assert_eq!(message, "there is no panel \"TANK SIDE\"");
    assert_eq!(hint, "the panels are \"TANK BK\", \"TANK FRT\"");
    let (message, hint) = refused("TANK FRT.nek", "waist_back");
    assert_eq!(message, "the panel \"TANK FRT\" has no edge \"nek\"");
    assert!(hint.starts_with("its edges are \""), "{hint}");
    let (message, hint) = refused("TANK FRT.neck", "waist");
    assert_eq!(message, "the body has no landmark \"waist\"");
    assert!(hint.contains("\"waist_back\", \"waist_front\""), "{hint}");
}

#[test]
fn a_piece_that_no_rule_places_stands_where_it_was_dragged() {
    assert_eq!(undecided(&collared()), ["TANK COLLAR"]);
    let at = "(hand_places: [(piece: \"TANK COLLAR\", middle: (\"0 mm\", \"1500 mm\", \"-90 mm\"), turn: (0, 180, 0))])";
    let garment = arranged_with(&collared(), at).unwrap();
    let collar = middle(&garment, "TANK COLLAR");
    assert!((collar - Vector3::new(0.0, 1.5, -0.09)).norm() < 2e-3, "{collar}");
    assert!(looks_out(&garment, "TANK COLLAR"));
    let off = middle(&garment, "TANK FRT") - middle(&arranged(&tank()).unwrap(), "TANK FRT");
    assert!(off.norm() < 5e-3, "{off}");
}

#[test]
fn a_dragged_sleeve_stays_bent() {
    let stands = arranged(&tee()).unwrap();
    let of = |garment: &Garment| -> Vec<Point3> {
        let panel = garment.panels.iter().find(|p| p.name == "left sleeve").unwrap();
        garment.positions[panel.vertices.clone()].to_vec()
    };
    let place = "(piece: \"left sleeve\", middle: (\"500 mm\", \"1300 mm\", \"50 mm\"))";
    let dragged = arranged_with(&tee(), &format!("(hand_places: [{place}])")).unwrap();
    let way = of(&dragged)[0] - of(&stands)[0];
    assert!(way.norm() > 0.01);
    for (before, after) in of(&stands).iter().zip(of(&dragged)) {
        assert!((after - before - way).norm() < 1e-9);
    }
    // The right sleeve stays, and so does the body.
    for name in ["right sleeve", "TANK FRT", "TANK BK"] {
        assert_eq!(middle(&stands, name), middle(&dragged, name), "{name}");
    }
}

#[test]
fn turns_go_around_the_three_axes_one_after_the_other() {
    let turned = |turn: &str| {
        let place = format!("(piece: \"TANK FRT\", middle: (\"0 m\", \"1.2 m\", \"0.3 m\"), turn: {turn})");
        let garment = arranged_with(&tank(), &format!("(hand_places: [{place}])")).unwrap();
        let panel = garment.panels.iter().find(|p| p.name == "TANK FRT").unwrap();
        garment.positions[panel.vertices.clone()].to_vec()
    };
    let (before, after) = (turned("(0, 0, 0)"), turned("(90, 90, 0)"));
    let middle = Vector3::new(0.0, 1.2, 0.3);
    for (p, q) in before.iter().zip(after) {
        let d = p.coords - middle;
        // Around x: y goes to z; then around y: z goes to x.
        let expected = middle + Vector3::new(d.y, -d.z, -d.x);
        assert!((q.coords - expected).norm() < 1e-9, "{q} {expected}");
    }
}

#[test]
fn places_by_hand_that_cannot_be_are_refused() {
    let refused = |params: &str| {
        let e = arranged_with(&tank(), params).unwrap_err();
        (e.message, e.hint.unwrap_or_default())
    };
    let front = "(piece: \"TANK FRT\", middle: (\"0 m\", \"1.2 m\", \"0.3 m\"))";
    assert_eq!(
        refused(&format!("(hand_places: [{}])", front.replace("FRT", "SIDE"))),
        ("the pattern has no piece \"TANK SIDE\"".into(), "its pieces are \"TANK BK\", \"TANK FRT\"".into())
    );
    assert_eq!(
        refused(&format!("(hand_places: [{front}, {front}])")),
        ("the piece \"TANK FRT\" has two places".into(), "keep one of them".into())
    );
    let key = "(edge: \"TANK FRT.neck\", at: 0.5, landmark: \"neck_base_front\")";
    assert_eq!(
        refused(&format!("(key_points: [{key}], hand_places: [{front}])")),
        (
            "the piece \"TANK FRT\" has key points, too".into(),
            "keep one of `key_points` and `hand_places` for it".into()
        )
    );
    assert_eq!(
        refused(&format!("(hand_places: [{}])", front.replace("1.2 m", "120 m"))),
        (
            "the piece \"TANK FRT\" starts more than 10 m away".into(),
            "give its middle in metres from the floor below the wearer, such as (\"0 m\", \"1.2 m\", \"0.2 m\")"
                .into()
        )
    );
}
