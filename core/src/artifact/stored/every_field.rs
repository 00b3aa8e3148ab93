//! A digest tells artifacts apart that differ in any one field.
//!
//! Each type is taken apart without `..`: who adds a field must change it here as well.
#![allow(clippy::unwrap_used, clippy::needless_update)]

use crate::artifact::stored::tests::{
    body, fabric, figures, garment, model, motion, outline, panel, phases, photo, plan,
};
use crate::artifact::*;
use crate::cost::Used;
use crate::stage::PortValue;
use crate::{ErrorCode, Remarks, Role};
use crate::{Failure, RunLog, StageRecord};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The value, once for every field with that field changed.
macro_rules! changed {
    ($base:expr, $type:ident { $($field:ident: $other:expr),* $(,)? }) => {{
        let base = $base;
        let $type { $($field: _),* } = &base;
        vec![$($type { $field: $other, ..base.clone() }),*]
    }};
}

fn digest(artifact: &dyn Artifact) -> Digest {
    let mut d = Digester::new();
    artifact.digest(&mut d);
    d.finish()
}

/// The value and all changed ones have digests of their own.
fn all_differ<T: ArtifactType>(base: &T, changed: Vec<T>) {
    let digests: BTreeSet<Digest> = changed.iter().chain([base]).map(|a| digest(a)).collect();
    for (k, other) in changed.iter().enumerate() {
        assert_ne!(digest(other), digest(base), "change {k} of a {}: {other:?}", T::KIND);
    }
    assert_eq!(digests.len(), changed.len() + 1, "two changes of a {} are one", T::KIND);
}

fn grey(level: u8) -> Shared<GrayImage> {
    Shared::new(GrayImage::from_pixel(3, 2, image::Luma([level])))
}

fn rgb(level: u8) -> Shared<RgbImage> {
    Shared::new(RgbImage::from_pixel(3, 2, image::Rgb([level; 3])))
}

fn p(x: f64, y: f64) -> Point2 {
    Point2::new(x, y)
}

fn v(x: f64) -> Vector3 {
    Vector3::new(x, 0.5, 0.25)
}

#[test]
fn of_photos_and_masks() {
    let others = changed!(
        photo(),
        Photo {
            pixels: rgb(9),
            alpha: None,
            px_per_metre: None,
            garment_width: Some(0.5),
            mirrored: false,
            joined: 1,
            file: "back.jpg".into(),
        }
    );
    all_differ(&photo(), others);
    let mask = Mask { pixels: grey(255) };
    all_differ(&mask, changed!(mask.clone(), Mask { pixels: grey(0) }));
}

#[test]
fn of_outlines() {
    let base = outline();
    let with_edge = |e| Outline { edges: vec![e], ..outline() };
    let with_line = |l| Outline { inner: vec![l], ..outline() };
    let with_frame = |f| Outline { frame: Some(f), ..outline() };
    let gauge = Gauge::straight(0.77);
    let mut others = changed!(
        base.clone(),
        Outline {
            outer: Loop::default(),
            holes: vec![Loop::default()],
            edges: vec![],
            inner: vec![],
            frame: None,
            lies: vec![],
        }
    );
    let loops = changed!(base.outer.clone(), Loop { points: vec![p(0.0, 0.0)], corners: vec![0] });
    others.extend(loops.into_iter().map(|outer| Outline { outer, ..outline() }));
    let edges = changed!(base.edges[0].clone(), Edge { name: "cuff".into(), start: 2, end: 2, gauge: gauge });
    others.extend(edges.into_iter().map(with_edge));
    let lines = changed!(
        base.inner[0].clone(),
        InnerLine { name: "tuck".into(), kind: InnerKind::Fold, points: vec![], gauge: Some(gauge) }
    );
    others.extend(lines.into_iter().map(with_line));
    let frames = changed!(
        base.frame.unwrap(),
        PhotoFrame { origin_px: p(5.0, 2.0), px_per_metre: 901.0, mirrored: true, turn: 0.1 }
    );
    others.extend(frames.into_iter().map(with_frame));
    all_differ(&base, others);
}

#[test]
fn of_panels() {
    let chain = InnerChain { name: "dart".into(), kind: InnerKind::Dart, vertices: vec![0] };
    let base = Panel { inner: vec![chain.clone()], ..panel() };
    let mut others = changed!(
        base.clone(),
        Panel {
            positions: vec![p(0.0, 0.0)],
            triangles: vec![],
            boundary: vec![],
            holes: vec![vec![0]],
            edges: vec![],
            inner: vec![],
            photo_px: vec![p(1.0, 1.0)],
            outline_area: 0.02,
            outline_length: 0.53,
        }
    );
    let edges = changed!(base.edges[0].clone(), PanelEdge { name: "neck".into(), vertices: vec![1] });
    others.extend(edges.into_iter().map(|e| Panel { edges: vec![e], ..base.clone() }));
    let chains =
        changed!(chain, InnerChain { name: "tuck".into(), kind: InnerKind::Pleat, vertices: vec![1] });
    others.extend(chains.into_iter().map(|c| Panel { inner: vec![c], ..base.clone() }));
    all_differ(&base, others);
}

fn fabrics() -> Vec<Fabric> {
    changed!(
        fabric(),
        Fabric {
            name: "denim".into(),
            area_density: 0.3,
            warp: Curve::linear(1.0),
            weft: Curve::linear(1.0),
            shear: Curve::linear(1.0),
            bending_warp: 1.0,
            bending_weft: 1.0,
            bending_friction_warp: 1.0,
            bending_friction_weft: 1.0,
            thickness: 1.0,
            friction: 1.0,
            damping: 1.0,
            source: "a sheet".into(),
        }
    )
}

#[test]
fn of_fabrics() {
    all_differ(&fabric(), fabrics());
}

#[test]
fn of_garments() {
    let base = garment();
    let mut others = changed!(
        base.clone(),
        Garment {
            positions: vec![],
            velocities: vec![v(1.0)],
            rest: vec![],
            triangles: vec![],
            panels: vec![],
            seams: vec![],
            weld: vec![],
            pinned: vec![],
            status: SolveStatus::default(),
            starts: vec![GarmentStart { told: "as drawn".into(), positions: garment().positions }],
            motion: Some(Arc::new(motion())),
        }
    );
    let panels = changed!(
        base.panels[0].clone(),
        GarmentPanel {
            name: "back".into(),
            vertices: 0..2,
            triangles: 0..0,
            boundary: vec![],
            photo_px: vec![p(1.0, 2.0)],
            fabric: Arc::new(Fabric { damping: 2.0, ..fabric() }),
            layer: 1,
        }
    );
    let made_of = |f| GarmentPanel { fabric: Arc::new(f), ..garment().panels[0].clone() };
    let panels = panels.into_iter().chain(fabrics().into_iter().map(made_of));
    others.extend(panels.map(|panel| Garment { panels: vec![panel], ..garment() }));
    let seams = changed!(
        base.seams[0].clone(),
        GarmentSeam { name: "c + d".into(), kind: SeamKind::Matched, pairs: vec![], state: SeamState::Open }
    );
    let kinds = [
        SeamKind::Dart,
        SeamKind::Pleat(PleatFold::Knife),
        SeamKind::Pleat(PleatFold::Box),
        SeamKind::Elastic { ratio: 0.8, stiffness: 1.0 },
        SeamKind::Elastic { ratio: 0.8, stiffness: 2.0 },
        SeamKind::Elastic { ratio: 0.9, stiffness: 1.0 },
        SeamKind::Patch,
        SeamKind::Folded { angle: 1.0 },
        SeamKind::Folded { angle: 2.0 },
    ];
    let of_kind = |kind| GarmentSeam { kind, ..garment().seams[0].clone() };
    let seams = seams.into_iter().chain(kinds.map(of_kind));
    others.extend(seams.map(|seam| Garment { seams: vec![seam], ..garment() }));
    let motions = changed!(
        motion(),
        RecordedMotion {
            every: 0.05,
            end: 0.06,
            triangles: vec![],
            vertices: 2,
            positions: vec![[0.0; 3]; 3]
        }
    );
    others.extend(motions.into_iter().map(|m| Garment { motion: Some(Arc::new(m)), ..garment() }));
    let states = changed!(
        base.status.clone(),
        SolveStatus {
            steps: 6,
            converged: false,
            energy: 0.5,
            max_speed: 1.0,
            on_body: vec![],
            held: Held::default(),
        }
    );
    others.extend(states.into_iter().map(|status| Garment { status, ..garment() }));
    let helds = changed!(
        base.status.held.clone(),
        Held {
            slides: vec![Vector3::zeros(); 3],
            offsets: vec![2e-3; 3],
            folds: vec![],
            contacts: vec![[0, 2, 1, 0]],
            figures: vec![0.5; 15],
        }
    );
    let of_held = |held| Garment { status: SolveStatus { held, ..garment().status }, ..garment() };
    others.extend(helds.into_iter().map(of_held));
    all_differ(&base, others);
}

#[test]
fn of_bodies() {
    let others = changed!(
        body(),
        Body {
            positions: vec![],
            triangles: vec![],
            landmarks: BTreeMap::from([("crotch".to_owned(), Point3::origin())]),
            measurements: BTreeMap::from([("height".to_owned(), 1.73)]),
        }
    );
    all_differ(&body(), others);
}

#[test]
fn of_models() {
    let base = model();
    let mut others = changed!(
        base.clone(),
        Model { meshes: vec![], materials: vec![], textures: vec![], variants: vec![] }
    );
    let meshes = changed!(
        base.meshes[0].clone(),
        Mesh {
            name: "back".into(),
            positions: vec![],
            normals: vec![v(1.0)],
            uv: vec![],
            triangles: vec![],
            material: 1,
        }
    );
    others.extend(meshes.into_iter().map(|mesh| Model { meshes: vec![mesh], ..model() }));
    let materials = changed!(
        base.materials[0].clone(),
        Material {
            name: "skin".into(),
            colour: [0.0; 3],
            texture: None,
            normal_texture: None,
            unlit: true,
            roughness: 0.1,
            sheen: None,
            double_sided: false,
            wrong_side: Some([0.1; 3]),
            fabric: String::new(),
        }
    );
    others.extend(materials.into_iter().map(|m| Model { materials: vec![m], ..model() }));
    let textures =
        changed!(base.textures[0].clone(), Texture { name: "u".into(), pixels: rgb(1), repeats: false });
    others.extend(textures.into_iter().map(|t| Model { textures: vec![t], ..model() }));
    let sheen = Sheen { colour: [0.1, 0.2, 0.3], roughness: 0.5 };
    let sheens = changed!(sheen, Sheen { colour: [0.1, 0.2, 0.4], roughness: 0.6 });
    let shiny = |sheen| Material { sheen: Some(sheen), ..base.materials[0].clone() };
    others.extend(sheens.into_iter().map(|s| Model { materials: vec![shiny(s)], ..model() }));
    let variants = changed!(base.variants[0].clone(), Variant { name: "blue".into(), materials: vec![0, 0] });
    others.extend(variants.into_iter().map(|v| Model { variants: vec![v], ..model() }));
    all_differ(&base, others);
}

#[test]
fn of_sewing_plans() {
    let base = plan();
    let edge = |text: &str| EdgeRef::try_from(text.to_owned()).unwrap();
    let mut others = changed!(base.clone(), SewingPlan { seams: vec![] });
    let seams = changed!(
        base.seams[0].clone(),
        Seam { a: edge("front.neck"), b: edge("back.neck"), kind: SeamKind::Gathered, reversed: false }
    );
    others.extend(seams.into_iter().map(|s| SewingPlan { seams: vec![s] }));
    all_differ(&base, others);
}

#[test]
fn of_patterns() {
    let base = pattern::tests::tunic();
    let mut others = changed!(base.clone(), Pattern { name: "coat".into(), pieces: vec![], seams: vec![] });
    let piece = Piece {
        lines: vec![PieceLine { name: "l".into(), purpose: LinePurpose::Mark, points: vec![p(0.1, 0.1)] }],
        notches: vec![Notch { edge: "hem".into(), along: 0.1, depth: 0.0 }],
        ..base.pieces[0].clone()
    };
    let mut pieces = changed!(
        piece.clone(),
        Piece {
            name: "hood".into(),
            outer: PatternLoop::default(),
            holes: vec![PatternLoop::default(); 3],
            lines: vec![],
            notches: vec![],
            drill_holes: vec![p(0.3, 0.3)],
            grain: Some([p(0.0, 0.0), p(0.0, 0.7)]),
            body_part: Some(BodyPart::Head),
            pose: Some(Pose { origin: Point3::new(7.0, 0.0, 0.0), across: v(1.0), along: v(2.0) }),
            layer: 7,
        }
    );
    let pose = Pose { origin: Point3::origin(), across: v(3.0), along: v(4.0) };
    let poses = changed!(pose, Pose { origin: Point3::new(8.0, 0.0, 0.0), across: v(5.0), along: v(6.0) });
    pieces.extend(poses.into_iter().map(|pose| Piece { pose: Some(pose), ..piece.clone() }));
    let lines = changed!(
        piece.lines[0].clone(),
        PieceLine { name: "m".into(), purpose: LinePurpose::Cut, points: vec![p(0.2, 0.1)] }
    );
    pieces.extend(lines.into_iter().map(|line| Piece { lines: vec![line], ..piece.clone() }));
    let notches = changed!(piece.notches[0].clone(), Notch { edge: "neck".into(), along: 0.2, depth: 0.01 });
    pieces.extend(notches.into_iter().map(|notch| Piece { notches: vec![notch], ..piece.clone() }));
    let curves = [
        EdgeCurve::Quadratic { control: p(1.0, 2.0) },
        EdgeCurve::Cubic { controls: [p(1.0, 2.0), p(3.0, 4.0)] },
        EdgeCurve::Arc { bulge: 0.3 },
        EdgeCurve::Arc { bulge: 0.4 },
        EdgeCurve::Polyline { points: vec![p(1.0, 2.0)] },
    ];
    let straight = PieceEdge { name: "hem".into(), curve: EdgeCurve::Line };
    let mut edges =
        changed!(straight, PieceEdge { name: "seam".into(), curve: EdgeCurve::Arc { bulge: 1.0 } });
    edges.extend(curves.map(|curve| PieceEdge { name: "hem".into(), curve }));
    let corners = vec![p(0.0, 0.0)];
    let loops = changed!(
        PatternLoop { corners, edges: vec![] },
        PatternLoop {
            corners: vec![p(0.5, 0.0)],
            edges: vec![PieceEdge { name: "only".into(), curve: EdgeCurve::Line }],
        }
    );
    let loops = loops
        .into_iter()
        .chain(edges.into_iter().map(|e| PatternLoop { corners: vec![p(0.0, 0.0)], edges: vec![e] }));
    pieces.extend(loops.map(|outer| Piece { outer, ..piece.clone() }));
    others.extend(pieces.into_iter().map(|piece| Pattern { pieces: vec![piece], ..base.clone() }));
    let seams = changed!(
        base.seams[0].clone(),
        PatternSeam { name: "s".into(), kind: SeamKind::Patch, sides: vec![] }
    );
    let link = base.seams[0].sides[0][0].clone();
    let links = changed!(
        link.clone(),
        EdgeUse { edge: EdgeRef { panel: "x".into(), edge: "y".into() }, reversed: !link.reversed }
    );
    let of_link = |link| PatternSeam { sides: vec![vec![link]], ..base.seams[0].clone() };
    let seams = seams.into_iter().chain(links.into_iter().map(of_link));
    others.extend(seams.map(|seam| Pattern { seams: vec![seam], ..base.clone() }));
    all_differ(&base, others);
}

#[test]
fn of_phases() {
    let base = phases();
    let air = base.0[1].air.unwrap();
    let spans =
        changed!(base.0[1].clone(), Phase { name: "hang".into(), seconds: 0.6, gravity: v(1.0), air: None });
    let airs = changed!(air, Air { density: 2.0, normal: 2.0, tangential: 2.0, wind: v(9.0) });
    let blown = airs.into_iter().map(|air| Phase { air: Some(air), ..base.0[1].clone() });
    let spans: Vec<Phase> = spans.into_iter().chain(blown).collect();
    let mut others = vec![Phases::default()];
    others.extend(spans.into_iter().map(|span| Phases(vec![base.0[0].clone(), span])));
    all_differ(&base, others);
}

#[test]
fn of_figures() {
    let base = figures();
    let mut others = changed!(
        base.clone(),
        Figures {
            panels: BTreeMap::new(),
            garment: GarmentFigures::default(),
            flat: BTreeMap::new(),
            shortfalls: vec![],
        }
    );
    let named = |f| BTreeMap::from([("front".to_owned(), f)]);
    let panels = changed!(base.panels["front"], PanelFigures { area_error: 0.5, outline_error: 0.5 });
    others.extend(panels.into_iter().map(|f| Figures { panels: named(f), ..figures() }));
    let flat = changed!(base.flat["front"], PanelFigures { area_error: 0.5, outline_error: 0.5 });
    others.extend(flat.into_iter().map(|f| Figures { flat: named(f), ..figures() }));
    let mut garments = changed!(
        base.garment.clone(),
        GarmentFigures {
            vertices: 4,
            triangles: 5,
            seam_gap_max_m: 1.0,
            edge_strain: StrainFigures { p50: 4.0, p99: 4.0, max: 4.0 },
            tight_p99: None,
            body_penetration: None,
            body_crossings: None,
            self_crossings: None,
            on_body: None,
            girths: BTreeMap::new(),
            energy_j: 1.0,
            max_speed_m_s: 1.0,
            steps: 9,
            converged: true,
        }
    );
    let strains = changed!(base.garment.edge_strain, StrainFigures { p50: 1.0, p99: 1.0, max: 1.0 });
    garments.extend(strains.into_iter().map(|s| GarmentFigures { edge_strain: s, ..base.garment.clone() }));
    let depth = base.garment.body_penetration.unwrap();
    let depths = changed!(depth, PenetrationFigures { vertices: 2, max_m: 1.0 });
    garments.extend(
        depths.into_iter().map(|d| GarmentFigures { body_penetration: Some(d), ..base.garment.clone() }),
    );
    let girths = changed!(base.garment.girths["bust"], GirthFigures { cloth_m: 2.0, body_m: 2.0 });
    let bust = |g| BTreeMap::from([("bust".to_owned(), g)]);
    garments.extend(girths.into_iter().map(|g| GarmentFigures { girths: bust(g), ..base.garment.clone() }));
    others.extend(garments.into_iter().map(|garment| Figures { garment, ..figures() }));
    let falls = changed!(
        base.shortfalls[0].clone(),
        Shortfall { code: ErrorCode::StitchingError, message: "open".into() }
    );
    others.extend(falls.into_iter().map(|s| Figures { shortfalls: vec![s], ..figures() }));
    all_differ(&base, others);
}

#[test]
fn of_files() {
    let file = OutputFile::new("a/b.txt", b"content".to_vec());
    let files = changed!(file.clone(), OutputFile { path: "a/c.txt".into(), bytes: vec![] });
    let mut others = vec![OutputFiles::default()];
    others.extend(files.into_iter().map(|f| OutputFiles(vec![f])));
    all_differ(&OutputFiles(vec![file]), others);
}

/// Times and memory are left out: they differ from run to run.
#[test]
fn of_run_logs() {
    let stage = StageRecord {
        id: "Otsu".into(),
        name: "Otsu".into(),
        role: Role::Binariser,
        params: "()".into(),
        wall_s: 1.0,
        outputs: vec![],
        figures: vec![],
        remarks: Remarks::default(),
        used: None,
        predicted: None,
    };
    let failure =
        Failure { stage: "StaticEquilibrium".into(), message: "it hangs".into(), hint: None, detail: None };
    let base = RunLog { stages: vec![stage.clone()], failure: Some(failure.clone()), ..RunLog::default() };
    let mut others = changed!(
        base.clone(),
        RunLog {
            pipeline: "vest".into(),
            quality: Some("Draft".into()),
            stages: vec![],
            skipped: vec![("Obj".into(), "nobody asked".into())],
            failure: None,
        }
    );
    let failures = changed!(
        failure,
        Failure {
            stage: "Place".into(),
            message: "it falls".into(),
            hint: Some("pin it".into()),
            detail: Some("by 9.81 m/s2".into()),
        }
    );
    others.extend(failures.into_iter().map(|f| RunLog { failure: Some(f), ..base.clone() }));
    let measure = Measure { name: "a".into(), value: 1.0, unit: "mm", tolerance: 0.0 };
    let mut stages = changed!(
        stage.clone(),
        StageRecord {
            id: "Otsu2".into(),
            name: "Kapur".into(),
            role: Role::Mesher,
            params: "(bias: 1)".into(),
            wall_s: 2.0,
            outputs: vec![PortValue::One(Arc::new(fabric()))],
            figures: vec![measure.clone()],
            remarks: Remarks { notes: vec![], warnings: vec!["dark".into()] },
            used: Some(Used::default()),
            predicted: Some(Default::default()),
        }
    );
    let measures = changed!(measure, Measure { name: "b".into(), value: 2.0, unit: "cm", tolerance: 1.0 });
    stages.extend(measures.into_iter().map(|m| StageRecord { figures: vec![m], ..stage.clone() }));
    let logs: Vec<RunLog> = stages.into_iter().map(|s| RunLog { stages: vec![s], ..base.clone() }).collect();
    let (timed, told): (Vec<_>, Vec<_>) = logs.into_iter().partition(|log| {
        let s = &log.stages[0];
        s.wall_s != 1.0 || s.used.is_some() || s.predicted.is_some()
    });
    assert_eq!(timed.len(), 3);
    assert!(timed.iter().all(|log| digest(log) == digest(&base)));
    others.extend(told);
    all_differ(&base, others);
}

/// A collision scheme that is nothing but its settings.
#[derive(Debug, Clone)]
struct Still(ColliderCard);

impl Collide for Still {
    fn card(&self) -> ColliderCard {
        self.0
    }
    fn body_contacts(&self, _: &[Point3], _: f64, _: &mut Vec<BodyContact>) {}
    fn body_hits(&self, _: &[Point3], _: &[Point3], _: &mut Vec<BodyContact>) {}
    fn self_contacts(&self, _: &[Point3], _: &[[u32; 3]], _: f64, _: &mut Vec<SelfContact>) {}
    fn conservative_bounds(&self, positions: &[Point3], _: &[[u32; 3]], reach: f64) -> Vec<f64> {
        vec![reach; positions.len()]
    }
    fn self_crossings(&self, _: &[Point3], _: &[[u32; 3]]) -> Vec<[u32; 2]> {
        Vec::new()
    }
}

#[test]
fn of_colliders() {
    let card = ColliderCard {
        thickness: 1e-3,
        friction: 0.3,
        restitution: 0.0,
        self_collision: true,
        penalty: None,
    };
    let made = |card| Arc::new(Still(card));
    let base = Collider { scheme: made(card), signature: "still".into() };
    let cards = changed!(
        card,
        ColliderCard {
            thickness: 2e-3,
            friction: 0.4,
            restitution: 0.5,
            self_collision: false,
            penalty: Some(Penalty::Linear(9.0)),
        }
    );
    let mut others = changed!(
        base.clone(),
        Collider { scheme: made(ColliderCard { thickness: 5e-3, ..card }), signature: "moving".into() }
    );
    others.extend(cards.into_iter().map(|c| Collider { scheme: made(c), ..base.clone() }));
    all_differ(&base, others);
}
