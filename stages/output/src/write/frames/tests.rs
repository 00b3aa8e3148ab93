//! What is written is read back, by readers of the formats' own descriptions.
#![allow(clippy::unwrap_used)]

use super::*;
use serde_json::Value;
use std::sync::Arc;
use toile_core::artifact::RecordedMotion;
use toile_core::testkit::dress;

/// A square of two triangles that rises and turns into the depth.
fn motion(frames: usize) -> RecordedMotion {
    let frame = |k: usize| {
        let t = k as f32;
        [[0.0, t, 0.0], [1.0, t, 0.25 * t], [1.0, 1.0 + t, 0.25 * t], [0.0, 1.0 + t, 0.0]]
    };
    RecordedMotion {
        every: 0.04,
        end: 0.04 * frames as f64,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        vertices: 4,
        positions: (0..frames).flat_map(frame).collect(),
    }
}

fn moved(motion: RecordedMotion) -> Garment {
    Garment { motion: Some(Arc::new(motion)), ..dress::garment() }
}

fn written(stage: &Frames, motion: RecordedMotion) -> Vec<OutputFile> {
    stage.run(&moved(motion), &Context::quiet()).unwrap().0
}

fn file(files: &[OutputFile], path: &str) -> Vec<u8> {
    files.iter().find(|f| f.path == path).unwrap().bytes.clone()
}

#[test]
fn every_format_is_written_unless_it_is_left_out() {
    let names =
        |stage: &Frames| -> Vec<String> { written(stage, motion(3)).into_iter().map(|f| f.path).collect() };
    let all = [
        "motion.pc2",
        "motion.mdd",
        "motion/motion_0000.obj",
        "motion/motion_0001.obj",
        "motion/motion_0002.obj",
        "motion.glb",
        "motion.usdz",
        "motion.html",
    ];
    assert_eq!(names(&Frames::default()), all);
    let few = Frames { obj: false, glb: false, usdz: false, page: false, ..Frames::default() };
    assert_eq!(names(&few), ["motion.pc2", "motion.mdd", "motion/motion_0000.obj"]);
    let none = Frames { caches: false, ..few };
    let e = none.run(&moved(motion(3)), &Context::quiet()).unwrap_err();
    assert_eq!(e.message, "every format is left out: nothing would be written");
    assert_eq!(e.hint.as_deref(), Some("leave one of `caches`, `obj`, `glb`, `usdz` and `page` true"));
}

#[test]
fn a_garment_without_a_motion_is_refused() {
    let e = Frames::default().run(&Garment { motion: None, ..dress::garment() }, &Context::quiet());
    let e = e.unwrap_err();
    assert_eq!(e.message, "the garment has no motion: no solver before it has recorded frames");
    let hint = "put `SpringStitcher(), SpringDraper()` or `ImplicitEuler()` before it, in the place of `StaticEquilibrium()`";
    assert_eq!(e.hint.as_deref(), Some(hint));
}

#[test]
fn it_asks_solvers_for_frames_and_takes_others_as_they_are() {
    let stage = |every: f64| Frames { every, ..Frames::default() };
    assert_eq!(stage(0.02).asks(), [("frames", "0.02".to_owned())]);
    let first = |every: f64, cx: &Context| {
        let files = stage(every).run(&moved(motion(5)), cx).unwrap().0;
        let pc2 = file(&files, "motion.pc2");
        let rows: Vec<f32> = pc2[32..].chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
        // The height of the first vertex.
        rows.chunks(12).map(|frame| frame[1]).collect::<Vec<f32>>()
    };
    let cx = Context::quiet();
    assert_eq!(first(0.04, &cx), [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(first(0.08, &cx), [0.0, 2.0, 4.0]);
    assert_eq!(first(0.06, &cx), [0.0, 1.5, 3.0]);
    assert!(cx.take_remarks().notes.is_empty());
    assert_eq!(first(0.03, &cx), [0.0, 0.75, 1.5, 2.25, 3.0, 3.75]);
    assert_eq!(
        cx.take_remarks().notes,
        ["frames were recorded every 0.04 s: those in between are interpolated"]
    );
}

#[test]
fn caches_hold_every_place() {
    let (files, motion) = (written(&Frames::default(), motion(3)), motion(3));
    let pc2 = file(&files, "motion.pc2");
    let int = |at: usize| i32::from_le_bytes(pc2[at..at + 4].try_into().unwrap());
    let float = |at: usize| f32::from_le_bytes(pc2[at..at + 4].try_into().unwrap());
    assert_eq!(&pc2[..12], b"POINTCACHE2\0");
    assert_eq!((int(12), int(16), float(20), float(24), int(28)), (1, 4, 0.0, 1.0, 3));
    let places: Vec<f32> = (0..36).map(|i| float(32 + 4 * i)).collect();
    assert_eq!(places, motion.positions.concat());
    assert_eq!(pc2.len(), 32 + 4 * 36);

    let mdd = file(&files, "motion.mdd");
    let int = |at: usize| i32::from_be_bytes(mdd[at..at + 4].try_into().unwrap());
    let float = |at: usize| f32::from_be_bytes(mdd[at..at + 4].try_into().unwrap());
    assert_eq!((int(0), int(4)), (3, 4));
    assert_eq!([8, 12, 16].map(float), [0.0, 0.04, 0.08]);
    let places: Vec<f32> = (0..36).map(|i| float(20 + 4 * i)).collect();
    assert_eq!(places, motion.positions.concat());
    assert_eq!(mdd.len(), 20 + 4 * 36);
}

#[test]
fn numbered_files_have_the_vertices_in_order() {
    let files = written(&Frames::default(), motion(3));
    let last = toile_geometry::obj::parse(&file(&files, "motion/motion_0002.obj")).unwrap();
    assert_eq!(last.triangles, motion(3).triangles);
    let places: Vec<[f32; 3]> = last.vertices.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
    assert_eq!(places, motion(3).positions[8..]);
}

/// Chunks of a GLB: its JSON and its bytes.
fn chunks(glb: &[u8]) -> (Value, Vec<u8>) {
    let length = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(length(8), glb.len());
    let json = length(12);
    (serde_json::from_slice(&glb[20..20 + json]).unwrap(), glb[28 + json..].to_vec())
}

#[test]
fn a_glb_goes_from_frame_to_frame() {
    let glb = file(&written(&Frames::default(), motion(4)), "motion.glb");
    // A second reader, which checks indices, offsets and required fields.
    let read = gltf::Gltf::from_slice(&glb).unwrap();
    let bytes = read.blob.clone().unwrap();
    let mesh = read.meshes().next().unwrap();
    assert_eq!(mesh.weights().unwrap(), [0.0; 3]);
    let primitive = mesh.primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&bytes));
    let first: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
    assert_eq!(first, motion(4).positions[..4]);
    let targets: Vec<Vec<[f32; 3]>> =
        reader.read_morph_targets().map(|(p, ..)| p.unwrap().collect()).collect();
    for (k, target) in targets.iter().enumerate() {
        let sum = first.iter().zip(target).map(|(a, b)| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
        assert_eq!(sum.collect::<Vec<_>>(), motion(4).positions[4 * (k + 1)..4 * (k + 2)]);
    }
    let animation = read.animations().next().unwrap();
    let channel = animation.channels().next().unwrap();
    let reader = channel.reader(|_| Some(&bytes));
    assert_eq!(reader.read_inputs().unwrap().collect::<Vec<_>>(), [0.0, 0.04, 0.08, 0.12]);
    let gltf::animation::util::ReadOutputs::MorphTargetWeights(weights) = reader.read_outputs().unwrap()
    else {
        unreachable!("the animation is of weights")
    };
    let weights: Vec<f32> = weights.into_f32().collect();
    let expected = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(weights, expected);
}

#[test]
fn a_glb_keeps_the_rules_of_khronos_for_targets_and_animations() {
    let (json, bytes) = chunks(&file(&written(&Frames::default(), motion(4)), "motion.glb"));
    let accessor = |i: &Value| json["accessors"][i.as_u64().unwrap() as usize].clone();
    let primitive = &json["meshes"][0]["primitives"][0];
    let targets = primitive["targets"].as_array().unwrap();
    let positions = targets.iter().map(|t| &t["POSITION"]).chain([&primitive["attributes"]["POSITION"]]);
    for position in positions {
        let a = accessor(position);
        assert_eq!((a["count"].as_u64(), a["type"].as_str()), (Some(4), Some("VEC3")));
        assert_eq!((a["min"].as_array().unwrap().len(), a["max"].as_array().unwrap().len()), (3, 3));
    }
    let sampler = &json["animations"][0]["samplers"][0];
    let (input, output) = (accessor(&sampler["input"]), accessor(&sampler["output"]));
    assert_eq!((input["count"].as_u64(), output["count"].as_u64()), (Some(4), Some(12)));
    assert!(input["min"][0] == 0.0 && (input["max"][0].as_f64().unwrap() - 0.12).abs() < 1e-7);
    // What no vertex shader reads has no target; all of it lies in the buffer, on multiples of
    // four.
    for a in [input, output] {
        assert!(json["bufferViews"][a["bufferView"].as_u64().unwrap() as usize].get("target").is_none());
    }
    for view in json["bufferViews"].as_array().unwrap() {
        let (offset, length) = (view["byteOffset"].as_u64().unwrap(), view["byteLength"].as_u64().unwrap());
        assert!(offset % 4 == 0 && offset + length <= bytes.len() as u64);
    }
    assert_eq!(json["meshes"][0]["extras"]["targetNames"].as_array().unwrap().len(), targets.len());
}

#[test]
fn a_motion_of_one_frame_is_a_still_model() {
    let files = written(&Frames::default(), motion(1));
    let (json, _) = chunks(&file(&files, "motion.glb"));
    assert!(json.get("animations").is_none() && json["meshes"][0].get("weights").is_none());
    gltf::Gltf::from_slice(&file(&files, "motion.glb")).unwrap();
}

#[test]
fn usdz_has_a_sample_for_every_frame() {
    let usdz = file(&written(&Frames::default(), motion(3)), "motion.usdz");
    let text = String::from_utf8_lossy(&usdz);
    for line in ["endTimeCode = 2", "timeCodesPerSecond = 25", "startTimeCode = 0", "upAxis = \"Y\""] {
        assert!(text.contains(&format!("    {line}\n")), "{line}");
    }
    assert!(text.contains("            2: [(0, 2, 0), (1, 2, 0.5), (1, 3, 0.5), (0, 3, 0)],\n"));
    assert!(text.contains("            1: [(0, 1, 0), (1, 2, 0.25)],\n"), "the box of a frame");
    assert!(text.contains("def Mesh \"motion\""));
}

#[test]
fn the_page_holds_the_places_and_asks_nothing_outside() {
    let page = String::from_utf8(file(&written(&Frames::default(), motion(3)), "motion.html")).unwrap();
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("/*"));
    let data = page.split("id=\"motion-data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let data: Value = serde_json::from_str(data).unwrap();
    assert_eq!((data["frames"].as_u64(), data["vertices"].as_u64()), (Some(3), Some(4)));
    use base64::Engine;
    let places = base64::engine::general_purpose::STANDARD.decode(data["places"].as_str().unwrap()).unwrap();
    let step = data["step"].as_f64().unwrap();
    for (k, (bytes, want)) in places.chunks(2).zip(motion(3).positions.concat()).enumerate() {
        let number = u16::from_le_bytes([bytes[0], bytes[1]]);
        let place = data["low"][k % 3].as_f64().unwrap() + step * f64::from(number);
        assert!((place - f64::from(want)).abs() <= 0.51 * step, "{k}: {place} {want}");
    }
}

#[test]
fn a_hundred_frames_of_five_thousand_triangles_are_a_page_of_less_than_5_mb() {
    let (rows, columns) = (50usize, 50usize);
    let at = |r: usize, c: usize| (r * (columns + 1) + c) as u32;
    let cell =
        |r, c| [[at(r, c), at(r, c + 1), at(r + 1, c)], [at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)]];
    let triangles: Vec<[u32; 3]> =
        (0..rows).flat_map(|r| (0..columns).flat_map(move |c| cell(r, c))).collect();
    let vertices = (rows + 1) * (columns + 1);
    let place = |i: usize| [(i as f32 * 0.37).sin(), (i as f32 * 0.11).cos(), (i as f32 * 0.77).sin()];
    let positions = (0..100 * vertices).map(place).collect();
    let motion = RecordedMotion { every: 0.04, end: 4.0, triangles, vertices, positions };
    assert_eq!(motion.triangles.len(), 5000);
    let files = written(&Frames { obj: false, usdz: false, ..Frames::default() }, motion);
    let size = file(&files, "motion.html").len();
    assert!(size < 5_000_000, "{size}");
}
