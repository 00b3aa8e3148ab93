//! Pipelines, scenes, bodies, garments, goldens and locks.

use crate::{fuzz, spoil};
use std::path::Path;
use std::sync::{Arc, LazyLock};
use toile_core::{Artifact, Cancel, Context, ErrorCode, Inputs, PortValue, Registry, testkit};
use toile_pipeline::lock::Lock;
use toile_pipeline::{golden, load, to_json};
use toile_tests::{PIPELINES, napkin, pipeline, root};

static REGISTRY: LazyLock<Registry> = LazyLock::new(toile::registry);

fn read(path: impl AsRef<Path>) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// A file that is no UTF-8 is refused before anything reads it as text.
fn as_text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

#[test]
fn pipelines() {
    let seeds = PIPELINES.map(|name| read(pipeline(name)));
    let base = root().join("pipelines");
    fuzz(
        "pipeline",
        400,
        |dice| spoil::text(&seeds, dice),
        |bytes| {
            let Some(text) = as_text(bytes) else { return Ok(()) };
            let _ = to_json(text, "fuzz.ron");
            match load(text, "fuzz.ron", &base, &REGISTRY, &[]) {
                Err(faults) if faults.faults.is_empty() => Err("it is refused without a fault".to_owned()),
                Err(faults) if faults.render(false).trim().is_empty() => {
                    Err("it is refused without a word".to_owned())
                }
                Err(faults) => {
                    match faults.faults.iter().flat_map(|f| &f.labels).find(|l| l.span.end > text.len()) {
                        Some(l) => Err(format!("a fault points at {:?} of {} bytes", l.span, text.len())),
                        None => Ok(()),
                    }
                }
                Ok(_) => Ok(()),
            }
        },
    );
}

/// Runs a stage that reads `file` beside it; what it gives is sound, what it refuses has words.
/// True where it answers.
fn reads(stage: &str, file: &str, folder: &Path) -> Result<bool, String> {
    let options = format!("(file: \"{file}\")");
    answers(stage, &options, Inputs::default(), folder).map(|made| made.is_some())
}

/// Runs a stage; its result must be sound, and a refusal must have a message.
fn answers(
    stage: &str,
    options: &str,
    inputs: Inputs,
    folder: &Path,
) -> Result<Option<Vec<PortValue>>, String> {
    let card = REGISTRY.named(stage).next().ok_or("there is no such stage")?;
    let stage = REGISTRY.make(card, options)?;
    let cx = Context::new(card.name, folder, Cancel::new(), Arc::new(()));
    match stage.run_ports(&inputs, &cx) {
        Err(e) if e.code == ErrorCode::Internal => Err(format!("it calls it its own fault: {e}")),
        Err(e) if e.message.is_empty() => Err("it refuses without a word".to_owned()),
        Err(_) => Ok(None),
        Ok(made) => {
            for (_, a) in made.iter().flat_map(PortValue::entries) {
                let _ = (a.measures(), a.export());
                a.check().map_err(|e| format!("it gave a {} that cannot be: {e}", a.kind()))?;
            }
            Ok(Some(made))
        }
    }
}

/// Reads a garment and lays what it is flat, with the flattener of this number. True where the
/// garment was read.
fn flattens(file: &str, number: usize, folder: &Path) -> Result<bool, String> {
    const FLATTENERS: [(&str, &str); 5] = [
        ("Arap", "(iterations: 20, darts: Auto(max_strain: 5))"),
        ("Lscm", "()"),
        ("SpringFlatten", "(iterations: 20)"),
        ("SymmetricDirichlet", "(iterations: 20, darts: Propose)"),
        ("Woven", "(iterations: 20)"),
    ];
    let options = format!("(file: \"{file}\")");
    let Some(mut made) = answers("Garment3d", &options, Inputs::default(), folder)? else { return Ok(false) };
    let (stage, options) = FLATTENERS[number % FLATTENERS.len()];
    let inputs = Inputs(vec![Some(made.swap_remove(0)), None]);
    answers(stage, options, inputs, folder).map(|_| true).map_err(|e| format!("{stage}: {e}"))
}

/// A box of that size, its feet at 0.
fn block(x: f64, y: f64, z: f64) -> Vec<u8> {
    let corner = |k: usize| {
        let of = |bit: usize, size: f64| if k & bit == 0 { -size / 2.0 } else { size / 2.0 };
        format!("v {} {} {}\n", of(1, x), of(2, y) + y / 2.0, of(4, z))
    };
    let faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"];
    let corners: String = (0..8).map(corner).collect();
    format!("# a block\no block\n{corners}s off\n{}", faces.map(|f| format!("f {f}\n")).concat()).into_bytes()
}

#[test]
fn scenes() {
    let dir = tempfile::tempdir().unwrap();
    let mut sewn = napkin::scene();
    let bare = sewn.to_string();
    sewn["body"] = serde_json::json!({ "obj": "block.obj", "friction": 0.3 });
    std::fs::write(dir.path().join("block.obj"), block(0.1, 0.1, 0.1)).unwrap();
    let shipped: serde_json::Value =
        serde_json::from_slice(&read(root().join("pipelines/samples/scene/skirt.json"))).unwrap();
    // What a shipped scene says beside its long lists.
    let mut head = shipped;
    for list in ["rest_uv", "positions", "triangles"] {
        head[list].as_array_mut().unwrap().truncate(30);
    }
    let seeds = [bare.into_bytes(), sewn.to_string().into_bytes(), head.to_string().into_bytes()];
    let scene = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.json"), bytes).unwrap();
        reads("Scene", "fuzz.json", dir.path())
    };
    // What is refused before it is spoilt would be refused for that alone.
    assert_eq!([&seeds[0], &seeds[1]].map(|seed| scene(seed)), [Ok(true), Ok(true)]);
    fuzz("scene", 300, |dice| spoil::text(&seeds, dice), |bytes| scene(bytes).map(drop));
}

#[test]
fn garment_code() {
    let dir = tempfile::tempdir().unwrap();
    let sample = |name: &str| read(root().join("pipelines/samples/pattern").join(name));
    testkit::files::files_for(&REGISTRY, "GarmentCode(file: \"small_specification.json\")", dir.path())
        .unwrap();
    let small = read(dir.path().join("small_specification.json"));
    let seeds = [small, sample("shirt_specification.json"), sample("trousers_specification.json")];
    let pattern = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.json"), bytes).unwrap();
        reads("GarmentCode", "fuzz.json", dir.path())
    };
    assert_eq!([0, 1, 2].map(|k| pattern(&seeds[k])), [Ok(true), Ok(true), Ok(true)]);
    fuzz("garment_code", 300, |dice| spoil::text(&seeds, dice), |bytes| pattern(bytes).map(drop));
}

#[test]
fn dxf() {
    let dir = tempfile::tempdir().unwrap();
    testkit::files::files_for(&REGISTRY, "DxfPattern(file: \"small.dxf\")", dir.path()).unwrap();
    let seeds = [read(dir.path().join("small.dxf"))];
    let pattern = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.dxf"), bytes).unwrap();
        reads("DxfPattern", "fuzz.dxf", dir.path())
    };
    assert_eq!(pattern(&seeds[0]), Ok(true));
    fuzz("dxf", 300, |dice| spoil::text(&seeds, dice), |bytes| pattern(bytes).map(drop));
}

#[test]
fn seamly() {
    let dir = tempfile::tempdir().unwrap();
    let example = "SeamlyPattern(file: \"small.sm2d\", measurements: \"body.smis\")";
    testkit::files::files_for(&REGISTRY, example, dir.path()).unwrap();
    let seeds =
        [read(dir.path().join("small.sm2d")), read(root().join("pipelines/samples/pattern/bodice.val"))];
    let pattern = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.sm2d"), bytes).unwrap();
        reads("SeamlyPattern", "fuzz.sm2d", dir.path())
    };
    assert_eq!(pattern(&seeds[0]), Ok(true));
    fuzz("seamly", 300, |dice| spoil::text(&seeds, dice), |bytes| pattern(bytes).map(drop));
}

#[test]
fn svg() {
    let dir = tempfile::tempdir().unwrap();
    testkit::files::files_for(&REGISTRY, "SvgPattern(file: \"small.svg\")", dir.path()).unwrap();
    let small = String::from_utf8(read(dir.path().join("small.svg"))).unwrap();
    let clones = small.replace(
        "</svg>",
        "<defs><g id=\"two\"><use href=\"#front\" x=\"600\"/></g></defs><use href=\"#two\"/></svg>",
    );
    let seeds = [small.into_bytes(), clones.into_bytes()];
    let pattern = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.svg"), bytes).unwrap();
        reads("SvgPattern", "fuzz.svg", dir.path())
    };
    assert_eq!([&seeds[0], &seeds[1]].map(|seed| pattern(seed)), [Ok(true), Ok(true)]);
    fuzz("svg", 300, |dice| spoil::text(&seeds, dice), |bytes| pattern(bytes).map(drop));
}

/// A body with shoulders and legs, as the reader looks for them.
fn figure() -> Vec<u8> {
    let mannequin = REGISTRY.make(REGISTRY.named("Mannequin").next().unwrap(), "()").unwrap();
    let made = mannequin.run_ports(&Inputs::default(), &Context::quiet()).unwrap();
    made[0].entries()[0].1.export().swap_remove(0).1
}

#[test]
fn bodies() {
    let dir = tempfile::tempdir().unwrap();
    let stand = testkit::dress::body().export().swap_remove(0).1;
    let seeds = [figure(), stand, block(0.5, 1.7, 0.3), block(50.0, 170.0, 30.0)];
    let body = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.obj"), bytes).unwrap();
        reads("BodyObj", "fuzz.obj", dir.path())
    };
    assert_eq!(body(&seeds[0]), Ok(true));
    fuzz("body", 60, |dice| spoil::text(&seeds, dice), |bytes| body(bytes).map(drop));
}

#[test]
fn garments() {
    let dir = tempfile::tempdir().unwrap();
    let parts = testkit::dress::sewn_garment().export().swap_remove(0).1;
    let marked = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        g front\nusemtl red\nf 1/1 2/2 3/3 4/4\ng back\nf 2/1 5/2 6/3 3/4\nl 2 3\n";
    let seeds = [parts, marked.as_bytes().to_vec()];
    let garment = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.obj"), bytes).unwrap();
        flattens("fuzz.obj", bytes.len(), dir.path())
    };
    assert_eq!([&seeds[0], &seeds[1]].map(|seed| garment(seed)), [Ok(true), Ok(true)]);
    fuzz("garment", 300, |dice| spoil::text(&seeds, dice), |bytes| garment(bytes).map(drop));
}

/// A sheet of `n` x `n` squares of 1 m with a hump, as a GLB of one node that is turned and moved.
fn glb(n: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    for k in 0..(n + 1) * (n + 1) {
        let [x, y] = [k % (n + 1), k / (n + 1)].map(|i| i as f32 / n as f32);
        bytes.extend([x, y, x * y * (1.0 - x)].iter().flat_map(|c| c.to_le_bytes()));
    }
    let places = bytes.len();
    for k in 0..n * n {
        let a = k % n + k / n * (n + 1);
        let corners = [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1];
        bytes.extend(corners.iter().flat_map(|v| v.to_le_bytes()));
    }
    let count = (n + 1) * (n + 1);
    let json = serde_json::json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "front", "mesh": 0, "rotation": [0.0, 0.6, 0.0, 0.8], "translation": [1.0, 2.0, 3.0] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1] },
            { "bufferView": 1, "componentType": 5125, "count": 6 * n * n, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": places },
            { "buffer": 0, "byteOffset": places, "byteLength": bytes.len() - places },
        ],
        "buffers": [{ "byteLength": bytes.len() }],
    });
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let chunk = |kind: &[u8], body: &[u8]| [&(body.len() as u32).to_le_bytes()[..], kind, body].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &bytes)].concat();
    let head = [&b"glTF"[..], &2_u32.to_le_bytes(), &(12 + chunks.len() as u32).to_le_bytes()].concat();
    [head, chunks].concat()
}

#[test]
fn garments_as_glb() {
    let dir = tempfile::tempdir().unwrap();
    let seeds = [glb(3), glb(1)];
    let garment = |bytes: &[u8]| {
        std::fs::write(dir.path().join("fuzz.glb"), bytes).unwrap();
        flattens("fuzz.glb", bytes.len(), dir.path())
    };
    assert_eq!([&seeds[0], &seeds[1]].map(|seed| garment(seed)), [Ok(true), Ok(true)]);
    // Half of them as text, so that what the head says is spoilt as often as the numbers.
    let spoilt = |dice: &mut crate::Dice| match dice.below(2) {
        0 => spoil::text(&seeds, dice),
        _ => spoil::binary(&seeds, dice),
    };
    fuzz("garment_glb", 300, spoilt, |bytes| garment(bytes).map(drop));
}

#[test]
fn goldens() {
    let seeds =
        PIPELINES.map(|name| read(root().join("pipelines/goldens").join(name.replace(".ron", ".txt"))));
    fuzz(
        "golden",
        1000,
        |dice| spoil::text(&seeds, dice),
        |bytes| {
            let Some(sheet) = as_text(bytes).and_then(|text| golden::parse(text).ok()) else { return Ok(()) };
            let _ = golden::compare(&sheet, &golden::GoldenSheet::default());
            let _ = golden::compare(&golden::GoldenSheet::default(), &sheet);
            // A sheet that agrees with what it is not is no golden.
            let mut other = sheet.clone();
            for m in other.sections.iter_mut().flat_map(|s| &mut s.measures) {
                m.value += 1.0 + 2.0 * m.tolerance.abs();
            }
            let seen = |m: &golden::SheetMeasure| m.value.abs() < 1e12 && m.tolerance.abs() < 1e12;
            let all_seen = sheet.sections.iter().flat_map(|s| &s.measures).all(seen);
            let differs = !golden::compare(&sheet, &other).differences.is_empty();
            match sheet.sections.iter().all(|s| s.measures.is_empty()) || !all_seen || differs {
                true => Ok(()),
                false => Err("it takes other measures for its own".to_owned()),
            }
        },
    );
}

#[test]
fn locks() {
    let dir = tempfile::tempdir().unwrap();
    napkin::write(dir.path()).unwrap();
    let file = dir.path().join("napkin.ron").display().to_string();
    let answer = toile_tests::toile(&["lock", &file, "--no-cache"]);
    assert_eq!(answer.code, 0, "{}", answer.err);
    let seeds = [read(format!("{file}.lock"))];
    let right = Lock::from_text(as_text(&seeds[0]).unwrap()).unwrap();
    fuzz(
        "lock",
        1000,
        |dice| spoil::text(&seeds, dice),
        |bytes| {
            let Some(lock) = as_text(bytes).and_then(|text| Lock::from_text(text).ok()) else {
                return Ok(());
            };
            let (there, back) = (right.differences(&lock), lock.differences(&right));
            let again = Lock::from_text(&lock.to_text());
            match again.as_ref() == Ok(&lock) && (lock != right || (there.is_empty() && back.is_empty())) {
                true => Ok(()),
                false => Err(format!("it is written as something else: {again:?}")),
            }
        },
    );
}
