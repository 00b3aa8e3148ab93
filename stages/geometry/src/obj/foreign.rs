//! What a file is that holds no OBJ mesh: another format, by its first bytes, or an OBJ without
//! faces.

use super::text::{NumberedLines, decode, words};

/// Formats by how their files begin.
const BEGINNINGS: [(&[u8], &str); 33] = [
    (b"glTF", "a binary glTF (.glb)"),
    (b"Kaydara FBX Binary", "an FBX"),
    (b"; FBX", "an FBX"),
    (b"ply\n", "a PLY"),
    (b"ply\r", "a PLY"),
    (b"PXR-USDC", "a USD scene"),
    (b"#usda", "a USD scene"),
    (b"BLENDER", "a Blender project (.blend)"),
    (b"Ogawa", "an Alembic scene (.abc)"),
    (b"\x89HDF", "an Alembic scene or another HDF5 file"),
    (b"//Maya ASCII", "a Maya scene"),
    (b"FOR4", "a Maya scene"),
    (b"FOR8", "a Maya scene"),
    (b"\xD0\xCF\x11\xE0", "a 3ds Max scene or an Office document"),
    (b"ISO-10303-21", "a STEP file of a CAD program"),
    (b"OFF\n", "an OFF"),
    (b"OFF\r", "an OFF"),
    (b"#VRML", "a VRML scene"),
    (b"AutoCAD Binary DXF", "a DXF drawing"),
    (b"%PDF-", "a PDF"),
    (b"\x89PNG", "a picture (PNG)"),
    (b"\xFF\xD8\xFF", "a picture (JPEG)"),
    (b"GIF8", "a picture (GIF)"),
    (b"RIFF", "a picture or a sound (RIFF)"),
    (b"\x28\xB5\x2F\xFD", "a compressed file, as Blender saves its projects (.blend)"),
    (b"\x1F\x8B", "a compressed file (gzip)"),
    (b"7z\xBC\xAF", "an archive (7z)"),
    (b"Rar!", "an archive (RAR)"),
    (b"version https://git-lfs", "a Git LFS pointer, which only names the file"),
    (b"<svg", "an SVG drawing"),
    (b"<html", "a web page"),
    (b"<!DOCTYPE html", "a web page"),
    (b"<!doctype html", "a web page"),
];

/// How far into a file a word is looked for that tells its format.
const LOOK: usize = 4096;

/// The format of a file that is no OBJ, with its article: `a binary STL`. None where the bytes may
/// be an OBJ.
#[must_use]
pub fn other_format(bytes: &[u8]) -> Option<&'static str> {
    let text = decode(bytes);
    let start = text.trim_ascii_start();
    let named = BEGINNINGS.iter().find(|(begins, _)| bytes.starts_with(begins) || start.starts_with(begins));
    let holds = |word: &str| {
        let word = word.as_bytes();
        bytes[..bytes.len().min(LOOK)].windows(word.len()).any(|w| w == word)
    };
    match () {
        () if is_binary_stl(bytes) => Some("a binary STL"),
        () if bytes.starts_with(b"PK\x03\x04") => Some(zip(bytes)),
        () if named.is_some() => named.map(|n| n.1),
        () if start.starts_with(b"solid") && holds("facet") => Some("an STL"),
        () if start.starts_with(b"<?xml") && holds("COLLADA") => Some("a COLLADA scene (.dae)"),
        () if start.starts_with(b"<?xml") && holds("<svg") => Some("an SVG drawing"),
        () if start.starts_with(b"<?xml") => Some("an XML file"),
        () if start.starts_with(b"{") && holds("\"asset\"") => Some("a glTF in several files (.gltf)"),
        () if start.starts_with(b"{") && holds("\"panels\"") => Some("a sewing pattern (GarmentCode)"),
        () if start.starts_with(b"{") || start.starts_with(b"[") => Some("a JSON file"),
        () if is_dxf(start) => Some("a DXF drawing"),
        () => None,
    }
}

/// 80 bytes, the number of triangles, and 50 bytes for each.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..84).and_then(|b| <[u8; 4]>::try_from(b).ok()).map(u32::from_le_bytes);
    count.is_some_and(|n| n > 0 && bytes.len() as u64 == 84 + 50 * u64::from(n))
}

/// What a ZIP archive holds, by the names in its directory, which stands at its end.
fn zip(bytes: &[u8]) -> &'static str {
    let end = &bytes[bytes.len().saturating_sub(64 * LOOK)..];
    let holds = |word: &str| end.windows(word.len()).any(|w| w == word.as_bytes());
    match () {
        () if holds("3D/3dmodel.model") => "a 3MF",
        () if holds(".usdc") || holds(".usda") => "a USDZ",
        () => "a ZIP archive",
    }
}

fn is_dxf(text: &[u8]) -> bool {
    let mut lines = NumberedLines::new(text).map(|(_, line)| line);
    lines.next().is_some_and(|l| l.trim_ascii() == b"0")
        && lines.next().is_some_and(|l| l.trim_ascii() == b"SECTION")
}

/// What an OBJ without faces holds: `8 points and no faces`. None where it holds nothing at all.
#[must_use]
pub fn without_faces(bytes: &[u8]) -> Option<String> {
    let (mut points, mut lines, mut curved) = (0_usize, 0_usize, false);
    for (_, line) in NumberedLines::new(&decode(bytes)) {
        match words(&line).next() {
            Some(b"v") => points += 1,
            Some(b"l") => lines += 1,
            Some(b"surf" | b"curv" | b"curv2") => curved = true,
            _ => {}
        }
    }
    let count = |n: usize, what: &str| if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") };
    match (points, lines, curved) {
        (0, ..) => None,
        (_, _, true) => Some("curved surfaces (NURBS) and no faces".to_owned()),
        (_, 0, _) => Some(format!("{} and no faces", count(points, "point"))),
        (..) => Some(format!("{}, {} and no faces", count(points, "point"), count(lines, "line"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_told_by_their_bytes() {
        let mut stl = b"solid that is none: an exporter's name".to_vec();
        stl.resize(80, b' ');
        stl.extend_from_slice(&2_u32.to_le_bytes());
        stl.resize(84 + 100, 0);
        for (bytes, what) in [
            (&stl[..], "a binary STL"),
            (b"solid cube\n facet normal 0 0 1\n", "an STL"),
            (b"ply\r\nformat ascii 1.0\n", "a PLY"),
            (b"Kaydara FBX Binary  \0\x1a\0", "an FBX"),
            (b"PK\x03\x04 ... 3D/3dmodel.model ...", "a 3MF"),
            (b"PK\x03\x04 ... scene.usdc", "a USDZ"),
            (b"{\n \"asset\": {\"version\": \"2.0\"}}", "a glTF in several files (.gltf)"),
            (b"\xEF\xBB\xBF<?xml version=\"1.0\"?><COLLADA>", "a COLLADA scene (.dae)"),
            (b"  0\r\nSECTION\r\n", "a DXF drawing"),
            (b"<!DOCTYPE html><p>not found", "a web page"),
        ] {
            assert_eq!(other_format(bytes), Some(what));
        }
        for obj in [&b""[..], b"# solid facet\nv 0 0 0\n", b"o ply\nv 0 0 0\n", b"0\n1\n", b"v 1 2 3\n"] {
            assert_eq!(other_format(obj), None);
        }
    }

    #[test]
    fn a_file_without_faces_says_what_it_holds() {
        assert_eq!(without_faces(b"# nothing\n"), None);
        assert_eq!(without_faces(b"v 0 0 0\n").as_deref(), Some("1 point and no faces"));
        assert_eq!(
            without_faces(b"v 0 0 0\nv 1 0 0\nl 1 2\n").as_deref(),
            Some("2 points, 1 line and no faces")
        );
        assert_eq!(
            without_faces(b"v 0 0 0\ncstype bspline\nsurf 0 1 0 1 1\n").as_deref(),
            Some("curved surfaces (NURBS) and no faces")
        );
    }
}
