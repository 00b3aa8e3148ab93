//! The groups of triangles in a written result: GLB or OBJ.

use serde_json::Value;

/// A mesh of a GLB file or a group of an OBJ file: name and number of triangles, in the order of
/// the file.
pub(super) type MeshGroup = (String, usize);

/// The groups of a file of that extension that hold triangles.
///
/// Errors: why they cannot be told.
pub(super) fn groups(bytes: &[u8], extension: &str) -> Result<Vec<MeshGroup>, String> {
    let groups = match extension {
        "glb" => glb(bytes).ok_or("it is not a GLB file that toile wrote")?,
        "obj" => obj(&String::from_utf8_lossy(bytes)),
        _ => return Err("only the triangles of .glb and .obj files can be followed".into()),
    };
    Ok(groups.into_iter().filter(|(_, count)| *count > 0).collect())
}

fn glb(bytes: &[u8]) -> Option<Vec<MeshGroup>> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    if bytes.get(..4)? != b"glTF" || bytes.get(16..20)? != b"JSON" {
        return None;
    }
    let length = usize::try_from(word(12)?).ok()?;
    let root: Value = serde_json::from_slice(bytes.get(20..20usize.checked_add(length)?)?).ok()?;
    let group = |mesh: &Value| {
        let accessor = mesh["primitives"][0]["indices"].as_u64()?;
        let count = root["accessors"].get(usize::try_from(accessor).ok()?)?["count"].as_u64()?;
        Some((mesh["name"].as_str()?.to_owned(), usize::try_from(count / 3).ok()?))
    };
    root["meshes"].as_array()?.iter().map(group).collect()
}

fn obj(text: &str) -> Vec<MeshGroup> {
    let mut groups = vec![(String::new(), 0)];
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("g ") {
            groups.push((name.trim().to_owned(), 0));
        } else if let (true, Some(group)) = (line.starts_with("f "), groups.last_mut()) {
            group.1 += 1;
        }
    }
    groups
}
