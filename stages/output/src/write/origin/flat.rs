//! What `origin.json` says of the flat pieces of a garment and of its seams.

use super::{FILE, Origins};
use toile_core::artifact::{Point2, SeamKind};

/// A panel as it was cut.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatPanel {
    /// Its name.
    pub name: String,
    /// Flat places of its vertices, metres, to a hundredth of a millimetre.
    pub positions: Vec<Point2>,
    /// Its triangles, by its own vertices.
    pub triangles: Vec<[u32; 3]>,
}

/// Which vertices a seam joins.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatSeam {
    /// Its name.
    pub name: String,
    /// How its sides meet.
    pub kind: SeamKind,
    /// Pairs of vertices, counted through all panels in their order.
    pub pairs: Vec<[u32; 2]>,
}

/// The flat pieces of a garment, in its order.
#[derive(Debug, Clone, PartialEq)]
pub struct FlatPieces {
    /// The panels.
    pub panels: Vec<FlatPanel>,
    /// The seams; none where the file is of version 2 or before.
    pub seams: Vec<FlatSeam>,
}

/// Reads the content of an `origin.json`.
///
/// # Errors
/// What is wrong with it, one sentence.
pub fn flat(origin: &[u8]) -> Result<FlatPieces, String> {
    let origins: Origins =
        serde_json::from_slice(origin).map_err(|e| format!("\"{FILE}\" cannot be read: {e}"))?;
    let damaged = |what: String| format!("\"{FILE}\" is damaged: {what}");
    let mut panels = Vec::with_capacity(origins.panels.len());
    for p in origins.panels {
        let n = p.positions.len();
        if p.triangles.iter().flatten().any(|v| *v as usize >= n) {
            return Err(damaged(format!("a triangle of panel \"{}\" has no corners", p.name)));
        }
        let positions = p.positions.into_iter().map(Point2::from).collect();
        panels.push(FlatPanel { name: p.name, positions, triangles: p.triangles });
    }
    let count: usize = panels.iter().map(|p: &FlatPanel| p.positions.len()).sum();
    let mut seams = Vec::with_capacity(origins.seams.len());
    for s in origins.seams {
        let kind =
            SeamKind::of(&s.kind, &s.figures).map_err(|e| damaged(format!("seam \"{}\": {e}", s.name)))?;
        if s.pairs.iter().flatten().any(|v| *v as usize >= count) {
            return Err(damaged(format!("seam \"{}\" names a point that does not exist", s.name)));
        }
        seams.push(FlatSeam { name: s.name, kind, pairs: s.pairs });
    }
    Ok(FlatPieces { panels, seams })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const PANEL: &str = r#"{"name":"front","photo":null,"positions":[[0,0],[1,0],[0,1]],"pixels":[],"triangles":[[0,1,2]],"edges":[]}"#;

    fn read(seams: &str) -> Result<FlatPieces, String> {
        flat(format!("{{\"panels\":[{PANEL}]{seams}}}").as_bytes())
    }

    #[test]
    fn pieces_and_seams_come_back() {
        let pieces =
            read(r#","seams":[{"name":"dart","kind":"dart","figures":[],"pairs":[[1,2]]}]"#).unwrap();
        assert_eq!(pieces.panels[0].positions[1], Point2::new(1.0, 0.0));
        let dart = FlatSeam { name: "dart".into(), kind: SeamKind::Dart, pairs: vec![[1, 2]] };
        assert_eq!(pieces.seams, [dart]);
        assert!(read("").unwrap().seams.is_empty(), "a file of version 2 tells none");
    }

    #[test]
    fn damage_is_named() {
        let says = |seams: &str| read(seams).unwrap_err();
        assert_eq!(
            says(r#","seams":[{"name":"side","kind":"glued","figures":[],"pairs":[]}]"#),
            "\"origin.json\" is damaged: seam \"side\": `kind` is \"glued\", which is not one of its values"
        );
        assert_eq!(
            says(r#","seams":[{"name":"side","kind":"matched","figures":[],"pairs":[[0,3]]}]"#),
            "\"origin.json\" is damaged: seam \"side\" names a point that does not exist"
        );
    }
}
