#![allow(clippy::unwrap_used, clippy::expect_used)]
use super::*;
use proptest::prelude::*;

/// A cube from 0 to 1, its quads as an OBJ lists them.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n\
    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

fn cube() -> Mesh {
    parse(CUBE.as_bytes()).unwrap()
}

fn message(text: impl AsRef<[u8]>) -> String {
    parse(text.as_ref()).unwrap_err().to_string()
}

/// Reads, mends and takes the outer surface.
fn body(text: impl AsRef<[u8]>) -> (Mesh, Option<String>) {
    let (mesh, mut repairs) = repair(parse(text.as_ref()).unwrap());
    (outer_surface(mesh, &mut repairs), repairs.words())
}

fn volume(mesh: &Mesh) -> f64 {
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
        a.dot(&b.cross(&c))
    };
    mesh.triangles.iter().map(six).sum::<f64>() / 6.0
}

fn is_closed(mesh: &Mesh) -> bool {
    pieces::MeshPieces::new(mesh).closed.iter().all(|c| *c)
}

#[test]
fn whatever_wrote_the_file_it_is_read_alike() {
    let clean = cube();
    assert_eq!((clean.vertices.len(), clean.triangles.len()), (8, 12));
    let wide = |unit: fn(u16) -> [u8; 2]| -> Vec<u8> {
        std::iter::once(0xFEFF).chain(CUBE.encode_utf16()).flat_map(unit).collect()
    };
    let ways: [(&str, Vec<u8>); 12] = [
        ("byte order mark", [b"\xEF\xBB\xBF", CUBE.as_bytes()].concat()),
        ("UTF-16, little endian", wide(u16::to_le_bytes)),
        ("UTF-16, big endian", wide(u16::to_be_bytes)),
        ("Latin-1 names", [b"# K\xF6rper\no W\xFCrfel\n", CUBE.as_bytes()].concat()),
        ("CR LF", CUBE.replace('\n', "\r\n").into()),
        ("CR", CUBE.replace('\n', "\r").into()),
        ("tabs", CUBE.replace(' ', "\t ").into()),
        ("continued lines", CUBE.replace("f 1 ", "f 1 \\\n  ").replace("v 1 1 ", "v \\\r\n1 1\\\n ").into()),
        ("a comment that ends in a backslash", format!("# C:\\bodies\\\n{CUBE}").into()),
        ("colours", CUBE.replace(" 0\n", " 0 0.5 0.5 1\n").into()),
        ("texture and normal indices", CUBE.replace("f 1 3 4 2", "f 1/7 3/8/9 4//2 2/1/1").into()),
        ("negative indices", CUBE.replace("f 1 3 4 2", "f -8 -6 -5 -7").into()),
    ];
    for (way, text) in ways {
        assert_eq!(parse(&text).unwrap(), clean, "{way}");
    }
    let (vertices, faces) = CUBE.split_at(CUBE.find('f').unwrap());
    assert_eq!(parse(format!("{faces}{vertices}").as_bytes()).unwrap(), clean, "faces before their vertices");
}

#[test]
fn faults_name_their_line_and_word() {
    assert_eq!(message("v 0 0\n"), "line 1 of the OBJ: a vertex needs three numbers");
    assert_eq!(message("\nv 0 1,5 0\n"), "line 2 of the OBJ: a vertex needs three numbers, `1,5` is none");
    assert_eq!(message("v 0 0 NaN\n"), "line 1 of the OBJ: the coordinate NaN is not between -1e7 and 1e7");
    assert_eq!(
        message("v 0 0 1e999\n"),
        "line 1 of the OBJ: the coordinate 1e999 is not between -1e7 and 1e7"
    );
    assert_eq!(
        message("v 0 0 -1e30\n"),
        "line 1 of the OBJ: the coordinate -1e30 is not between -1e7 and 1e7"
    );
    assert_eq!(message("v 0 0 0\nf 1 2 3\n"), "line 2 of the OBJ: there is no vertex 2, the file has 1");
    assert_eq!(message("v 0 0 0\nf 1 0 1\n"), "line 2 of the OBJ: there is no vertex 0, the file has 1");
    assert_eq!(message("v 0 0 0\nf 1 -2 1\n"), "line 2 of the OBJ: there is no vertex -2, the file has 1");
    assert_eq!(message("v 0 0 0\nf 1 1\n"), "line 2 of the OBJ: a face needs three corners");
    assert_eq!(message("v 0 0 0\nf 1 1 a\n"), "line 2 of the OBJ: `a` is no corner of a face");
    assert_eq!(
        message("v 0 0 0\nf 1 1 9999999999999999999\n"),
        "line 2 of the OBJ: `9999999999999999999` is no corner of a face"
    );
    assert_eq!(
        message("v 0 0 0\nf 1 1 \\\n\\\n 4294967297\n"),
        "line 2 of the OBJ: there is no vertex 4294967297, the file has 1"
    );
    assert_eq!(message("hello"), "the OBJ holds no faces");
    assert_eq!(message(""), "the OBJ holds no faces");
    let many = "v 0 0 0\n".repeat(MAX_VERTICES + 1);
    assert_eq!(
        message(many),
        "line 4000001 of the OBJ: there are more than 4000000 vertices; make the mesh coarser"
    );
}

#[test]
fn a_face_that_is_not_convex_is_cut_within_itself() {
    // An arrowhead: a fan from its first corner would leave it.
    let flat = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\n";
    for first in 0..4 {
        let corners: Vec<String> = (0..4).map(|k| ((first + k) % 4 + 1).to_string()).collect();
        let mesh = parse(format!("{flat}f {}\n", corners.join(" ")).as_bytes()).unwrap();
        let areas: Vec<f64> = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
                0.5 * (b - a).cross(&(c - a)).z
            })
            .collect();
        assert!(areas.iter().all(|a| *a > 0.0), "{areas:?}");
        assert!((areas.iter().sum::<f64>() - 1.5).abs() < 1e-12, "{areas:?}");
    }
    // A comb of 150 teeth.
    let teeth = 150;
    let mut text = String::new();
    for k in 0..teeth {
        text += &format!("v {k} 1 0\nv {} 0.1 0\n", f64::from(k) + 0.5);
    }
    text += "v 150 0 0\nv 0 0 0\n";
    let corners: Vec<String> = (1..=2 * teeth + 2).rev().map(|k| k.to_string()).collect();
    text += &format!("f {}\n", corners.join(" "));
    assert_eq!(
        message(&text),
        "line 303 of the OBJ: the face of 302 corners is not convex; cut it into triangles"
    );
}

#[test]
fn a_clean_body_keeps_its_bits_and_nothing_is_told() {
    assert_eq!(body(CUBE), (cube(), None));
}

#[test]
fn vertices_split_at_the_seam_of_a_texture_are_joined() {
    // Every face with four vertices of its own, some off by the sixth digit.
    let clean = cube();
    let mut text = String::new();
    for (k, t) in clean.triangles.iter().enumerate() {
        for &v in t {
            let p = clean.vertices[v as usize];
            text += &format!("v {} {} {}\n", p.x + 1e-7 * (k % 3) as f64, p.y, p.z);
        }
        text += "f -3 -2 -1\n";
    }
    let (mesh, told) = body(&text);
    assert!(is_closed(&mesh) && (volume(&mesh) - 1.0).abs() < 1e-6);
    assert_eq!(mesh.vertices.len(), 8);
    assert_eq!(told.unwrap(), "28 vertices are joined to others at their places");
}

#[test]
fn bodies_that_touch_stay_two() {
    let beside = CUBE.replace("v 0 ", "v 2 ").replace("f 1 3 4 2", "f 1 2 4 3");
    let turned = ["f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"];
    let faces = turned.iter().fold(String::from("f 9 10 12 11\n"), |text, face| {
        let moved: Vec<String> =
            face[2..].split(' ').map(|k| (k.parse::<u32>().unwrap() + 8).to_string()).collect();
        text + &format!("f {}\n", moved.join(" "))
    });
    let vertices: String = beside.lines().filter(|l| l.starts_with('v')).map(|l| format!("{l}\n")).collect();
    let own: String = CUBE.lines().filter(|l| l.starts_with('v')).map(|l| format!("{l}\n")).collect();
    let first: String = CUBE.lines().filter(|l| l.starts_with('f')).map(|l| format!("{l}\n")).collect();
    let (mesh, told) = body(format!("{own}{vertices}{first}{faces}"));
    assert_eq!((mesh.vertices.len(), mesh.triangles.len(), told), (16, 24, None));
    assert!(is_closed(&mesh) && (volume(&mesh) - 2.0).abs() < 1e-12);
}

#[test]
fn what_bounds_nothing_is_dropped_and_counted() {
    let (mesh, told) = body(format!("{CUBE}v 9 9 9\nf 1 1 2\nf 3 3 3\nf 2 4 8\nf 8 4 2\n"));
    assert_eq!(mesh, cube());
    assert_eq!(
        told.unwrap(),
        "2 triangles without area are removed, 2 triangles that are listed twice are removed, 1 vertex that no face uses is left out"
    );
    let (mesh, told) = body(format!("{CUBE}f 3 4 2 1\n"));
    assert_eq!(mesh, cube(), "the first face again, from its second corner on");
    assert_eq!(told.unwrap(), "2 triangles that are listed twice are removed");
    // Double-sided: every face the other way round as well.
    let back: String = CUBE
        .lines()
        .filter(|l| l.starts_with('f'))
        .map(|l| format!("f {}\n", l[2..].split(' ').rev().collect::<Vec<_>>().join(" ")))
        .collect();
    let (mesh, _) = body(format!("{CUBE}{back}"));
    assert!(is_closed(&mesh) && (volume(&mesh).abs() - 1.0).abs() < 1e-12);
}

#[test]
fn a_flat_triangle_between_three_vertices_in_a_line_gives_its_side_away() {
    // The cube's edge from 1 to 2 has a vertex in its middle that one of its faces does not know.
    let text = CUBE.replace("f 1 2 6 5\n", "v 0.5 0 0\nf 1 9 6 5\nf 9 2 6\nf 1 2 9\n");
    let (mesh, told) = body(text);
    assert!(is_closed(&mesh) && (volume(&mesh) - 1.0).abs() < 1e-12, "{mesh:?}");
    let flat = |t: &[u32; 3]| is_flat(t.map(|v| mesh.vertices[v as usize]));
    assert!(!mesh.triangles.iter().any(flat));
    assert_eq!(told.unwrap(), "1 triangle without area is removed");
}

#[test]
fn beside_a_closed_body_open_pieces_and_inner_walls_are_left_out_and_others_turned() {
    let hair = "v 0 3 0\nv 1 3 0\nv 1 4 0\nf 1 2 3\n";
    let (mesh, told) = body(format!("{hair}{}", shifted(CUBE, 3)));
    assert_eq!((mesh, told.as_deref()), (cube(), Some("1 open piece is left out")));
    let (mesh, told) = body(inside_out(CUBE));
    assert!((volume(&mesh) - 1.0).abs() < 1e-12);
    assert_eq!(told.unwrap(), "1 piece is turned to face outwards");
    // A smaller cube that faces inwards: the inner side of a wall within the first, a thing turned
    // over beside it.
    let small = |x: f64| -> String {
        let line = |l: &str| {
            let p: Vec<f64> = l[2..].split(' ').map(|w| w.parse().unwrap()).collect();
            format!("v {} {} {}\n", 0.25 + 0.5 * p[0] + x, 0.25 + 0.5 * p[1], 0.25 + 0.5 * p[2])
        };
        let made = inside_out(CUBE);
        made.lines().map(|l| if l.starts_with('v') { line(l) } else { format!("{l}\n") }).collect()
    };
    let (mesh, told) = body(format!("{CUBE}{}", shifted(&small(0.0), 8)));
    assert_eq!((mesh, told.as_deref()), (cube(), Some("1 inner surface is left out")));
    let (mesh, told) = body(format!("{CUBE}{}", shifted(&small(2.0), 8)));
    assert!((volume(&mesh) - 1.125).abs() < 1e-12);
    assert_eq!(told.unwrap(), "1 piece is turned to face outwards");
}

#[test]
fn a_body_with_a_hole_keeps_it() {
    let holed = CUBE.replace("f 2 4 8 6\n", "");
    let (mesh, told) = body(format!("{holed}v 5 5 5\nv 6 5 5\nv 5 6 5\nf 9 10 11\n"));
    assert_eq!((mesh.triangles.len(), told), (11, None), "what is missing cannot be guessed");
}

/// The faces the other way round.
fn inside_out(text: &str) -> String {
    let face = |l: &str| format!("f {}\n", l[2..].split(' ').rev().collect::<Vec<_>>().join(" "));
    text.lines().map(|l| if l.starts_with('f') { face(l) } else { format!("{l}\n") }).collect()
}

/// The text with its face indices moved by so many vertices.
fn shifted(text: &str, by: u32) -> String {
    let face = |l: &str| {
        let corners = l[2..].split(' ').map(|k| (k.parse::<u32>().unwrap() + by).to_string());
        format!("f {}\n", corners.collect::<Vec<_>>().join(" "))
    };
    text.lines().map(|l| if l.starts_with('f') { face(l) } else { format!("{l}\n") }).collect()
}

/// A ball of so many rings and columns, split, doubled and written in ways that exporters have; the
/// clean one comes out again.
#[derive(Debug, Clone)]
struct Spoiled {
    split: Vec<bool>,
    doubled: Vec<bool>,
    collapsed: Vec<bool>,
    mark: bool,
    continued: bool,
}

fn ball() -> Mesh {
    let (vertices, triangles) = crate::shapes::sphere(0.3, 24, 48);
    Mesh { vertices, triangles }
}

fn spoil(clean: &Mesh, s: &Spoiled) -> Vec<u8> {
    let mut text = String::from(if s.mark { "\u{feff}" } else { "" });
    for p in &clean.vertices {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    let mut count = clean.vertices.len();
    for (k, t) in clean.triangles.iter().enumerate() {
        let at = |list: &[bool]| list[k % list.len()];
        let corners = t.map(|v| {
            if !at(&s.split) {
                return v as usize + 1;
            }
            let p = clean.vertices[v as usize];
            text += &format!("v {} {} {}\n", p.x, p.y, p.z);
            count += 1;
            count
        });
        let [a, b, c] = corners;
        let line =
            if s.continued { format!("f {a} \\\n{b} {c}\n") } else { format!("f {a}/1 {b}/2 {c}/3\n") };
        text += &line;
        if at(&s.doubled) {
            text += &line;
        }
        if at(&s.collapsed) {
            text += &format!("f {a} {a} {b}\n");
        }
    }
    text.into_bytes()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_spoiled_body_reads_as_the_clean_one(
        split in prop::collection::vec(any::<bool>(), 1..9),
        doubled in prop::collection::vec(any::<bool>(), 1..9),
        collapsed in prop::collection::vec(any::<bool>(), 1..9),
        mark: bool,
        continued: bool,
    ) {
        let clean = ball();
        let spoiled = Spoiled { split, doubled, collapsed, mark, continued };
        let (mesh, _) = body(spoil(&clean, &spoiled));
        let corners = |m: &Mesh| -> Vec<[[u64; 3]; 3]> {
            let bits = |v: u32| <[f64; 3]>::from(m.vertices[v as usize]).map(f64::to_bits);
            let mut all: Vec<_> = m.triangles.iter().map(|t| t.map(bits)).collect();
            all.sort_unstable();
            all
        };
        prop_assert_eq!(mesh.vertices.len(), clean.vertices.len());
        prop_assert_eq!(corners(&mesh), corners(&clean));
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        cuts in prop::collection::vec((0..CUBE.len(), prop::collection::vec(any::<u8>(), 0..6)), 1..8),
        words in prop::collection::vec("(v|f|\\\\|\n|\r| |-?[0-9]{1,3}|1e400|nan|/|1//2)", 0..40),
    ) {
        let mut bytes = CUBE.as_bytes().to_vec();
        for (at, with) in cuts {
            let at = at.min(bytes.len());
            let end = (at + with.len()).min(bytes.len());
            bytes.splice(at..end, with);
        }
        bytes.extend(words.concat().bytes());
        if let Ok(mesh) = parse(&bytes) {
            let (mesh, mut repairs) = repair(mesh);
            let mesh = outer_surface(mesh, &mut repairs);
            let known = |v: &u32| (*v as usize) < mesh.vertices.len();
            prop_assert!(mesh.triangles.iter().flatten().all(known));
            let _ = repairs.words();
        }
    }
}

#[test]
fn faces_are_counted_as_they_are_cut() {
    let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n# f 1 2 3\nf 1 2 3 4\nf 1 2 \\\n3\nf 1\n";
    assert_eq!(count_triangles(text), 3);
    assert_eq!(count_triangles(b""), 0);
}
