#![allow(clippy::unwrap_used)]
use super::{Data, Reader, Record, decode, encode, from_record, kind_named};
use crate::ErrorCode;
use crate::RunLog;
use crate::artifact::*;
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

pub(in crate::artifact) fn photo() -> Photo {
    Photo {
        pixels: Shared::new(image::RgbImage::from_fn(3, 2, |x, y| image::Rgb([x as u8, y as u8, 7]))),
        alpha: Some(Shared::new(image::GrayImage::from_pixel(3, 2, image::Luma([9])))),
        px_per_metre: Some(1000.0),
        garment_width: None,
        mirrored: true,
        joined: 3,
        file: "front.jpg".into(),
    }
}

pub(in crate::artifact) fn outline() -> Outline {
    let points = vec![Point2::new(0.0, 0.0), Point2::new(0.1, 0.0), Point2::new(0.0, 0.2)];
    let gauge = Gauge::of(&points[..2], &[]);
    let edge = |name: &str, start, end| Edge { name: name.into(), start, end, gauge };
    Outline {
        outer: Loop { points: points.clone(), corners: vec![0, 1, 2] },
        holes: vec![],
        edges: vec![edge("hem", 0, 1), edge("side", 1, 2), edge("neck", 2, 0)],
        inner: vec![InnerLine {
            name: "dart".into(),
            kind: InnerKind::Dart,
            points: vec![Point2::new(0.01, 0.01), Point2::new(0.02, 0.02)],
            gauge: None,
        }],
        frame: Some(PhotoFrame {
            origin_px: Point2::new(1.0, 2.0),
            px_per_metre: 900.0,
            mirrored: false,
            turn: 0.0,
        }),
        lies: points.iter().map(|p| p * 1.1).collect(),
    }
}

pub(in crate::artifact) fn panel() -> Panel {
    Panel {
        positions: vec![Point2::new(0.0, 0.0), Point2::new(0.1, 0.0), Point2::new(0.0, 0.2)],
        triangles: vec![[0, 1, 2]],
        boundary: vec![0, 1, 2],
        holes: vec![],
        edges: vec![PanelEdge { name: "hem".into(), vertices: vec![0, 1] }],
        inner: vec![],
        photo_px: vec![],
        outline_area: 0.01,
        outline_length: 0.52,
    }
}

pub(in crate::artifact) fn fabric() -> Fabric {
    Fabric {
        name: "poplin".into(),
        area_density: 0.12,
        warp: Curve(vec![(0.01, 10.0), (0.02, 40.0)]),
        weft: Curve::linear(900.0),
        shear: Curve::linear(40.0),
        bending_warp: 1e-5,
        bending_weft: 8e-6,
        bending_friction_warp: 3e-4,
        bending_friction_weft: 2e-4,
        thickness: 3e-4,
        friction: 0.4,
        damping: 0.1,
        source: "test".into(),
    }
}

pub(in crate::artifact) fn garment() -> Garment {
    let at = |p: &Point2| Point3::new(p.x, p.y, 0.0);
    let flat = panel();
    Garment {
        positions: flat.positions.iter().map(at).collect(),
        velocities: vec![Vector3::zeros(); 3],
        rest: flat.positions,
        triangles: flat.triangles,
        panels: vec![GarmentPanel {
            name: "front".into(),
            vertices: 0..3,
            triangles: 0..1,
            boundary: vec![0, 1, 2],
            photo_px: vec![],
            fabric: Arc::new(fabric()),
            layer: 0,
        }],
        seams: vec![GarmentSeam {
            name: "a + b".into(),
            kind: SeamKind::Gathered,
            pairs: vec![[0, 1]],
            state: SeamState::Closed,
        }],
        weld: vec![0, 0, 2],
        pinned: vec![2],
        status: SolveStatus {
            steps: 5,
            converged: true,
            energy: 0.25,
            max_speed: 1e-4,
            on_body: vec![0.9],
            held: held(),
        },
        starts: vec![],
        motion: None,
    }
}

/// Two frames of a triangle.
pub(in crate::artifact) fn motion() -> RecordedMotion {
    let places = (0..6).map(|k| [k as f32, 0.5, -1.0]).collect();
    RecordedMotion { every: 0.04, end: 0.05, triangles: vec![[0, 1, 2]], vertices: 3, positions: places }
}

/// What friction holds of a garment of three vertices.
pub(in crate::artifact) fn held() -> Held {
    Held {
        slides: vec![Vector3::new(1e-4, 0.0, 0.0), Vector3::zeros(), Vector3::zeros()],
        offsets: vec![1e-3; 3],
        folds: vec![0.5],
        contacts: vec![[0, 1, 2, 0]],
        figures: vec![0.25; 15],
    }
}

pub(in crate::artifact) fn body() -> Body {
    Body {
        positions: vec![
            Point3::origin(),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, 1.0, 0.0),
            Point3::new(0.0, 0.0, 1.0),
        ],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        landmarks: BTreeMap::from([("crotch".to_owned(), Point3::new(0.1, 0.1, 0.1))]),
        measurements: BTreeMap::from([("height".to_owned(), 1.72)]),
    }
}

pub(in crate::artifact) fn model() -> Model {
    Model {
        meshes: vec![Mesh {
            name: "front".into(),
            positions: vec![Point3::origin(); 3],
            normals: vec![Vector3::z(); 3],
            uv: vec![[0.0, 1.0]; 3],
            triangles: vec![[0, 1, 2]],
            material: 0,
        }],
        materials: vec![Material {
            name: "cloth".into(),
            colour: [1.0, 0.5, 0.25],
            texture: Some(0),
            normal_texture: Some(1),
            unlit: false,
            roughness: 0.9,
            sheen: Some(Sheen { colour: [0.1, 0.2, 0.3], roughness: 0.5 }),
            double_sided: true,
            wrong_side: Some([0.2, 0.3, 0.4]),
            fabric: "poplin".into(),
        }],
        textures: vec![
            Texture { name: "t".into(), pixels: photo().pixels, repeats: true },
            Texture { name: "n".into(), pixels: photo().pixels, repeats: true },
        ],
        variants: vec![Variant { name: "red".into(), materials: vec![0] }],
    }
}

pub(in crate::artifact) fn plan() -> SewingPlan {
    let edge = |text: &str| EdgeRef::try_from(text.to_owned()).unwrap();
    SewingPlan {
        seams: vec![Seam {
            a: edge("front.hem"),
            b: edge("back.hem"),
            kind: SeamKind::Matched,
            reversed: true,
        }],
    }
}

pub(in crate::artifact) fn figures() -> Figures {
    Figures {
        panels: BTreeMap::from([(
            "front".to_owned(),
            PanelFigures { area_error: 0.01, outline_error: 0.02 },
        )]),
        garment: GarmentFigures {
            vertices: 3,
            body_penetration: Some(PenetrationFigures { vertices: 1, max_m: 2e-4 }),
            body_crossings: Some(3),
            self_crossings: Some(4),
            tight_p99: Some(0.06),
            on_body: Some(0.75),
            girths: BTreeMap::from([("bust".to_owned(), GirthFigures { cloth_m: 0.95, body_m: 0.88 })]),
            ..GarmentFigures::default()
        },
        flat: BTreeMap::from([("front".to_owned(), PanelFigures { area_error: 0.03, outline_error: 0.04 })]),
        shortfalls: vec![Shortfall { code: ErrorCode::BodyIntersection, message: "inside".into() }],
    }
}

pub(in crate::artifact) fn phases() -> Phases {
    let gravity = Vector3::new(0.0, -9.81, 0.0);
    let air = Air { density: 1.2, normal: 1.17, tangential: 0.01, wind: Vector3::new(3.0, 0.0, -0.5) };
    let phase = |name: &str, air| Phase { name: name.into(), seconds: 0.5, gravity, air };
    Phases(vec![phase("sew", None), phase("drape", Some(air))])
}

fn every_kind() -> Vec<Arc<dyn Artifact>> {
    vec![
        Arc::new(photo()),
        Arc::new(Mask { pixels: Shared::new(image::GrayImage::from_pixel(2, 2, image::Luma([255]))) }),
        Arc::new(outline()),
        Arc::new(panel()),
        Arc::new(fabric()),
        Arc::new(garment()),
        Arc::new(body()),
        Arc::new(model()),
        Arc::new(plan()),
        Arc::new(crate::artifact::pattern::tests::tunic()),
        Arc::new(phases()),
        Arc::new(figures()),
        Arc::new(OutputFiles::one("a/b.txt", b"content".to_vec())),
    ]
}

#[test]
fn every_kind_comes_back_as_it_was() {
    for artifact in every_kind() {
        let bytes = encode(artifact.as_ref()).unwrap();
        let again = decode(artifact.kind(), &bytes).unwrap();
        assert_eq!(format!("{again:?}"), format!("{artifact:?}"));
        assert_eq!(encode(again.as_ref()).unwrap(), bytes, "{}", artifact.kind());
        assert_eq!(kind_named(artifact.kind().0), Some(artifact.kind()));
    }
}

#[test]
fn services_have_no_record() {
    assert!(encode(&RunLog::default()).is_none());
    let e = from_record(RunLog::KIND, &Record::new()).unwrap_err();
    assert_eq!(e, "a run log cannot be made from a record");
}

#[test]
fn errors_name_the_field() {
    let make = |record: Record<'_>| from_record(Panel::KIND, &record).unwrap_err();
    assert_eq!(make(Record::new()), "the field `positions` is missing");
    let flat = Record::new().owned("positions", [Point3::origin()]);
    assert_eq!(make(flat), "`positions` has 3 numbers an element, 2 are wanted");
    let whole = Record::new().owned("positions", [[1_u32, 2]]);
    assert_eq!(make(whole), "`positions` holds 32-bit whole numbers, 64-bit floats are wanted");
    let odd = Record::new().field("positions", 2, Data::F64(vec![1.0].into()));
    assert_eq!(make(odd), "`positions` has 1 numbers, no whole number of elements");
}

#[test]
fn a_picture_that_claims_another_size_is_refused() {
    let record = Record::new().owned("size", [[4_u32, 4]]).owned("pixels", [0_u8; 3]);
    let e = from_record(Mask::KIND, &record).unwrap_err();
    assert_eq!(e, "`pixels` has 3 bytes, 4 x 4 pixels are 16");
}

#[test]
fn an_unsound_artifact_is_refused() {
    let broken = Panel { triangles: vec![[0, 1, 9]], ..panel() };
    let e = decode(Panel::KIND, &encode(&broken).unwrap()).unwrap_err();
    assert_eq!(e, "a triangle names vertex 9 of 3");
}

#[test]
fn fields_that_are_not_known_are_passed_over() {
    let panel = panel();
    let record = panel.record().unwrap().text("invented_later", "x");
    assert_eq!(Panel::from_record_for_test(&record).unwrap(), panel);
}

impl Panel {
    fn from_record_for_test(record: &Record<'_>) -> Result<Self, String> {
        super::Stored::from_record(&Reader::new(record))
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Damaged bytes are refused or give a sound artifact; nothing panics or claims memory.
    #[test]
    fn damaged_bytes_never_panic(which in 0..13usize, cut in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(), byte in any::<u8>()) {
        let artifact = every_kind().swap_remove(which);
        let mut bytes = encode(artifact.as_ref()).unwrap();
        let i = at.index(bytes.len());
        bytes[i] = byte;
        if let Ok(sound) = decode(artifact.kind(), &bytes) {
            prop_assert!(sound.check().is_ok());
        }
        bytes.truncate(cut.index(bytes.len()));
        prop_assert!(decode(artifact.kind(), &bytes).is_err());
    }

    #[test]
    fn noise_is_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(decode(Panel::KIND, &bytes).is_err());
    }
}
