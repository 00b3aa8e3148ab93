//! Every error of the engine as people read it: the whole text, and none of the engine's own words
//! in it.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::{MessageContext, Motions, Rests};
use crate::collide::{BvhScheme, Distances};
use nalgebra::Vector3;
use toile_cloth::contact::past::{Fallen, Start};
use toile_cloth::error::ClothError;
use toile_cloth::motion::MotionError;
use toile_cloth::statics::drive::solve::{Load, StaticsError, Unsolvable};
use toile_cloth::statics::factor::multifrontal::NotPositive;
use toile_cloth::statics::report::start::StartError;
use toile_core::{Context, StageError};
use toile_fixtures::cloth::{Capsules, plain, vest};
use toile_geometry::volume::Aabb;

/// What only who knows the engine understands. A parameter's name stands in backticks, and may be
/// one of them.
const ENGINE_WORDS: [&str; 18] = [
    " lay,",
    "smoother lay",
    "coarsest",
    "mesh level",
    "level ",
    "n/m",
    "n a metre",
    "residual",
    "newton",
    "factoriz",
    "stiffness",
    "hinge",
    "vertex",
    "vertices",
    "pairs of an edge",
    "manifold",
    "degenerate",
    "converge",
];

/// Texts in which pairs of a scene's file are meant.
fn spoken(e: &StageError) -> String {
    let hint = e.hint.clone().unwrap_or_default();
    format!("{}\n{hint}", e.message)
}

/// The text without what stands in backticks.
fn prose(text: &str) -> String {
    text.split('`').step_by(2).collect::<String>().to_lowercase()
}

fn check(told: Vec<(StageError, &str)>) {
    let mut wrong = Vec::new();
    for (e, wanted) in told {
        let text = spoken(&e);
        if text != wanted {
            wrong.push(format!("told:   {text}\nwanted: {wanted}"));
        }
        let prose = prose(&text).replace("second vertices of its pairs", "");
        for word in ENGINE_WORDS.iter().filter(|w| prose.contains(**w)) {
            wrong.push(format!("`{word}` stands in: {text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

fn panels() -> [String; 2] {
    ["panel 'front'".into(), "panel 'back'".into()]
}

const AT: Vector3<f64> = Vector3::new(0.177, 1.27, 0.009);

fn starts() -> Vec<(StartError, &'static str)> {
    vec![
        (
            StartError::InBody { vertices: 198, depth: 0.1, panel: "panel 'front'".into(), at: AT },
            "'front' starts inside the body, by 10 cm at (0.177, 1.270, 0.009) m\n\
             place it outside the body (what is less than 5.0 cm deep is moved out), or let the solver move it apart: \
             `--set 'stages.Drape.sew_through=true'`",
        ),
        (
            StartError::Crossing { panels: panels(), pairs: 7, at: AT, more: 1 },
            "'front' and 'back' pass through each other where they start, at (0.177, 1.270, 0.009) m, and so do two other pieces\n\
             place them so that none does, or let the solver move it apart: `--set 'stages.Drape.sew_through=true'`",
        ),
        (
            StartError::Lying {
                panels: panels(),
                share: 0.4,
                within: 2e-5,
                thickness: 1e-3,
                at: AT,
                more: 0,
            },
            "'front' and 'back' lie in each other where they start: 40 % of 'front', at (0.177, 1.270, 0.009) m\n\
             place them 1.0 mm apart, as thick as the cloth is, or let the solver move it apart: `--set 'stages.Drape.sew_through=true'`",
        ),
        (
            StartError::Squeezed {
                panel: "panel 'front'".into(),
                share: 0.5,
                at: AT,
                height: 1e-6,
                cut: 1e-2,
            },
            "'front' starts squeezed together: 50 % of it has hardly any width, at (0.177, 1.270, 0.009) m\n\
             place it as large as it is cut",
        ),
        (
            StartError::Reversed { seams: vec!["front.side + back.edge_0".into()], apart: 0.2, turned: 0.02 },
            "the seam from front.side to back.edge_0 runs the wrong way: its sides start 20 cm apart in the mean, and 2.0 cm if one \
             of them is turned round\n\
             turn one of its sides round: in a file of seams `\"-back.edge_0\"` for `\"back.edge_0\"`, or the other way; in a scene \
             the second vertices of its pairs in reverse order",
        ),
        (
            StartError::PinnedApart { seam: "rail".into(), gap: 0.003 },
            "the seam 'rail' joins points that are pinned 3.0 mm apart\npin them at one place, or unpin one of them",
        ),
    ]
}

fn statics() -> Vec<(StaticsError, &'static str)> {
    let light = Load { length: 0.49, weight: 0.8, stiffness: 653.8 };
    let fallen = |start| {
        StaticsError::FallsPast(Box::new(Fallen {
            cloth: "'front'".into(),
            start,
            body: 1.7,
            is_certain: true,
        }))
    };
    let open = |reversed: &[&str]| StaticsError::SeamNotClosed {
        seam: "front.side + back.side".into(),
        gap: 0.041,
        force: 15.0,
        reversed: reversed.iter().map(ToString::to_string).collect(),
        positions: vec![],
    };
    let stuck = |why| StaticsError::Unsolvable { vertex: 4, panel: "panel 'front'".into(), why };
    let tangled = |load| StaticsError::Tangled { panels: panels(), pairs: 3, at: AT, load };
    let mut all = vec![
        (
            StaticsError::Falls,
            "nothing holds the garment: there is no body under it, and nothing of it is pinned\n\
             put a body and a collider before it (`body: Mannequin()`, `BvhCollider()`), or pin some of it (`pinned` of a scene)",
        ),
        (
            fallen(Start::Below(0.5)),
            "the cloth of 'front' falls away from the body: it starts 0.50 m below it, and the body is 1.70 m tall\n\
             place it around or above the body, and see that both are in the same unit of length",
        ),
        (
            fallen(Start::Beside(Vector3::new(0.8, 0.0, 0.0))),
            "the cloth of 'front' falls past the body: its middle starts 0.800 m beside the body's\n\
             move it by (-0.80, 0.00, 0.00) m, around or above the body, which is 1.70 m tall, and see that both are in the same unit of \
             length",
        ),
        (
            fallen(Start::Around),
            "the cloth of 'front' finds no hold on the body and falls past it\n\
             place it around the body, cut it narrower where the body is to hold it (a skirt at its waist) or raise the friction, and see \
             that it is not too heavy and that the body, 1.70 m tall, is in metres",
        ),
        (
            open(&[]),
            "the seam from front.side to back.side stays open by 4.1 cm\n\
             let cloth pass through what lies in its way while it is sewn: `--set 'stages.Drape.sew_through=true'`; where the body is in \
             the way, cut the pieces wider or take a smaller body",
        ),
        (
            open(&["front.side + back.side"]),
            "the seam from front.side to back.side stays open by 4.1 cm: its two sides run the opposite way\n\
             turn one of its sides round: in a file of seams `\"-back.side\"` for `\"back.side\"`, or the other way; in a scene the second \
             vertices of its pairs in reverse order",
        ),
        (
            tangled(light),
            "'front' and 'back' came through each other at (0.177, 1.270, 0.009) m, and did not come free\n\
             let cloth pass through what lies in its way while it is sewn: `--set 'stages.Drape.sew_through=true'`; or sew on a finer mesh: \
             `--set 'stages.Drape.coarsest=2000'`",
        ),
        (
            tangled(Load { weight: 800.0, ..light }),
            "'front' and 'back' came through each other at (0.177, 1.270, 0.009) m, and did not come free\n\
             look at the fabric: its weight, stretch and bending, or the lengths of the pieces, are beyond those of cloth (see the units of \
             its file)",
        ),
        (
            StaticsError::Timeout { seconds: 600.04, level: 2, levels: 3, positions: vec![] },
            "out of time after 600.0 s, on mesh 2 of 3\nallow more time: `--set 'stages.Drape.time_limit=1200'`",
        ),
        (
            StaticsError::NotPositive(NotPositive { node: 3 }),
            "the forces in the cloth cannot be balanced\n\
             look at the fabric: its weight, stretch and bending, or the lengths of the pieces, are beyond those of cloth (see the units of \
             its file)",
        ),
        (
            stuck(Unsolvable::Loose),
            "a point of 'front' belongs to no triangle\ntake it out of the file, or give it a triangle",
        ),
        (
            stuck(Unsolvable::Lost),
            "a point of 'front' has left every place: its numbers are too large\n\
             look at the fabric: its weight, stretch and bending, or the lengths of the pieces, are beyond those of cloth (see the units of \
             its file)",
        ),
        (
            stuck(Unsolvable::Flat),
            "a point of 'front' has no cloth around it where it starts\nplace the piece as large as it is cut",
        ),
        (
            stuck(Unsolvable::Apart),
            "a point of 'front' has forces that differ too much in size to be balanced\n\
             look at the fabric: its weight, stretch and bending, or the lengths of the pieces, are beyond those of cloth (see the units of \
             its file)",
        ),
        (StaticsError::Stopped, "stopped on request\n"),
    ];
    all.extend(starts().into_iter().map(|(e, text)| (StaticsError::Start(e), text)));
    all
}

fn motions() -> Vec<(MotionError, &'static str)> {
    let open = |time, reversed: &[&str]| MotionError::SeamNotClosed {
        positions: vec![],
        seam: "side".into(),
        gap: 0.239,
        time,
        reversed: reversed.iter().map(ToString::to_string).collect(),
    };
    vec![
        (
            open(4.0, &[]),
            "the seam 'side' stays open by 24 cm after 4.00 s of sewing\nsew for longer: `--set 'stages.Drape.time_limit=16'`",
        ),
        (
            open(1.5, &[]),
            "the seam 'side' stays open by 24 cm after 1.50 s of sewing\n\
             place its pieces nearer, with nothing between its sides, cut them wider, or sew with `StaticEquilibrium(sew_through: true)`",
        ),
        (
            open(1.5, &["side"]),
            "the seam 'side' stays open by 24 cm after 1.50 s of sewing: its two sides run the opposite way\n\
             turn one of its sides round: in a file of seams `\"-piece.edge\"` for `\"piece.edge\"`, or the other way; in a scene the second \
             vertices of its pairs in reverse order",
        ),
        (
            MotionError::TooStiff { step: 1e-8, least: 2e-7, time: 0.25, gap: 0.012 },
            "the cloth is too stiff for how light it is: 0.250 s of the motion are done, the widest seam is open by 1.2 cm, the next step \
             would take too long\n\
             sew with softer cloth: `--set 'stages.Drape.stiffest=125'`, or with a larger edge length of the mesh",
        ),
        (
            MotionError::Timeout { seconds: 600.0, time: 1.25, gap: 0.0, positions: vec![] },
            "out of time after 600.0 s: 1.250 s of the motion are done\ntake a larger edge length of the mesh",
        ),
        (
            MotionError::Fabrics { panel: "back".into() },
            "'back' is of another fabric than the first piece, and `Drape` takes one fabric\n\
             take another draper, such as `StaticEquilibrium()`, or one fabric for all pieces",
        ),
        (MotionError::Stopped, "stopped on request\n"),
    ]
}

fn numbers() -> Vec<(ClothError, &'static str)> {
    vec![
        (
            ClothError::DegenerateTriangle { index: 0, quality: 0.0 },
            "'front' has a triangle without area\n\
             mesh the piece again with another edge length, or merge points that lie on each other in the file",
        ),
        (
            ClothError::ZeroLengthEdge { a: 0, b: 1 },
            "'front' has two points at one place\n\
             mesh the piece again with another edge length, or merge points that lie on each other in the file",
        ),
        (
            ClothError::InvertedTriangle { index: 0 },
            "'front' has a triangle that is turned over\n\
             let all triangles of the piece run counter-clockwise where it lies flat",
        ),
        (
            ClothError::TriangleTwice { first: 0, second: 1, of: [0, 1, 2] },
            "'front' has a triangle twice\ntake one of them out of the file",
        ),
        (
            ClothError::NonManifoldEdge { a: 0, b: 1, why: "three triangles meet" },
            "the sewn cloth is no single surface: along one edge of it, three triangles meet\n\
             look for a seam that is listed twice, or that joins more than two edges",
        ),
        (
            ClothError::Wind { speed: 5.0 },
            "`Drape` finds no rest in a wind of 5 m/s\n\
             take ImplicitEuler, CentralDifferences, Xpbd or Projective in its place: they move the cloth until it rests",
        ),
        (
            ClothError::StrainLimitExceeded { index: 0, strain: 0.123, limit: 0.08 },
            "'front' is stretched by 12 %, its limit is 8 %\n\
             cut it wider, take a smaller body, or raise the scene's `strain_limit`",
        ),
        (
            ClothError::Diverged { what: "position", step: 7 },
            "the forces in the cloth cannot be balanced\n\
             look at the fabric: its weight, stretch and bending, or the lengths of the pieces, are beyond those of cloth (see the units of \
             its file)",
        ),
    ]
}

#[test]
fn every_error_of_the_engine_is_told_in_the_words_of_its_user() {
    let garment = vest(&plain(6000.0, 80.0, 1e-5));
    let words = MessageContext { garment: &garment, scheme: None, stage: "Drape" };
    let rests = Rests { reversed: &[], sew_through: false, coarsest: 300, steps: 500, time_limit: 600.0 };
    let can = Motions { longest: ("time_limit", 4.0), closing: 0.5, time_limit: None, stiffest: Some(500.0) };
    check(statics().into_iter().map(|(e, text)| (words.rest(&e, &rests), text)).collect());
    check(motions().into_iter().map(|(e, text)| (words.motion(&e, &can), text)).collect());
    check(numbers().into_iter().map(|(e, text)| (words.numbers(&e), text)).collect());
}

#[test]
fn what_the_engine_says_is_the_detail() {
    let garment = vest(&plain(6000.0, 80.0, 1e-5));
    let words = MessageContext { garment: &garment, scheme: None, stage: "Drape" };
    let rests = Rests { reversed: &[], sew_through: true, coarsest: 300, steps: 500, time_limit: 600.0 };
    let load = Load { length: 0.49, weight: 0.8, stiffness: 653.8 };
    let e = words.rest(&StaticsError::Tangled { panels: panels(), pairs: 3, at: AT, load }, &rests);
    assert_eq!(
        e.detail.as_deref(),
        Some(
            "cloth passes through cloth under its load: panels 'front' and 'back' came through each other while solving, and 3 pairs \
             cross or lie in each other, one at (0.177, 1.270, 0.009) m, while a length of 0.49 m weighs 0.8 N a metre of width, which \
             stretches a stiffness of 653.8 N/m by 0 %"
        )
    );
    assert_eq!(e.hint.as_deref(), Some("sew on a finer mesh: `--set 'stages.Drape.coarsest=2000'`"));
}

#[test]
fn a_place_on_a_body_is_told_by_its_landmark_or_its_height() {
    let garment = vest(&plain(6000.0, 80.0, 1e-5));
    let body = toile_fixtures::mannequin("(height: \"172 cm\")").unwrap();
    let card = Capsules::torso().card;
    let scheme = BvhScheme::<Aabb>::new(card, Some(&body), Distances::Asked, &Context::quiet()).unwrap();
    let words = MessageContext { garment: &garment, scheme: Some(&scheme), stage: "Drape" };
    let armpit = body.landmarks["armpit_left"].coords;
    let floor = body.positions.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    assert_eq!(
        words.place(&armpit),
        format!("at the left armpit, {:.2} m above the floor", armpit.y - floor)
    );
    let before = words.place(&Vector3::new(-0.3, floor + 0.4, 0.4));
    assert_eq!(before, "in front on the right, 0.40 m above the floor");
    let none = MessageContext { scheme: None, ..words };
    assert_eq!(none.place(&AT), "at (0.177, 1.270, 0.009) m");
}
