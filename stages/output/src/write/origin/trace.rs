//! From a triangle of a result back to panel, outline edge and photo pixel.

use super::result::{MeshGroup, groups};
use super::{FILE, Origins, PanelOrigin};
use crate::write::sides::WRONG_SIDE;

/// Where a triangle comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// The panel.
    pub panel: String,
    /// The triangle in the panel, counted from 0.
    pub triangle: usize,
    /// Its centre in the flat panel, metres: x to the right, y up, as seen from outside the wearer.
    pub place: [f64; 2],
    /// The nearest named edge of the outline and the distance to it, metres; none where no edge has
    /// a name.
    pub edge: Option<(String, f64)>,
    /// The photo's file and the pixel of the centre, x to the right and y down; none without a
    /// photo.
    pub photo: Option<(String, [f64; 2])>,
    /// True where the panel is the photo's mirror image.
    pub mirrored: bool,
}

/// Follows triangle `face` (from 0, in the order of the file) of a result back; `origin` is the
/// content of the `origin.json` beside it, `extension` that of the result.
///
/// Errors: what is wrong, one sentence.
pub fn trace(origin: &[u8], result: &[u8], extension: &str, face: usize) -> Result<Trace, String> {
    let origins: Origins =
        serde_json::from_slice(origin).map_err(|e| format!("\"{FILE}\" cannot be read: {e}"))?;
    let groups = groups(result, extension)?;
    let (panel, triangle) = locate(&origins, &groups, face)?;
    panel.trace(triangle).ok_or_else(|| {
        format!("\"{FILE}\" is damaged: triangle {triangle} of panel \"{}\" has no corners", panel.name)
    })
}

/// The panel of a face, and which of its triangles it is.
fn locate<'o>(
    origins: &'o Origins,
    groups: &[MeshGroup],
    face: usize,
) -> Result<(&'o PanelOrigin, usize), String> {
    let total: usize = groups.iter().map(|(_, count)| count).sum();
    if face >= total {
        return Err(format!("face {face} is out of range: the file has {total} triangles, counted from 0"));
    }
    let panels = || origins.panels.iter().filter(|p| !p.triangles.is_empty());
    let sewn: usize = panels().map(|p| p.triangles.len()).sum();
    // A file without groups holds all panels in a row.
    let whole = matches!(groups, [(name, count)] if name.is_empty() && *count == sewn);
    let fits = whole
        || panels().count() <= groups.len() && panels().zip(groups).all(|(p, g)| p.triangles.len() == g.1);
    if !fits {
        return Err(format!(
            "its triangles are not those of \"{FILE}\" beside it; run the pipeline again to write both"
        ));
    }
    let mut first = 0;
    for panel in panels() {
        if face < first + panel.triangles.len() {
            return Ok((panel, face - first));
        }
        first += panel.triangles.len();
    }
    let mut last = 0;
    let group = groups.iter().find(|(_, count)| {
        last += count;
        face < last
    });
    let (name, count) = group.map_or(("", 0), |(name, count)| (name.as_str(), *count));
    // The wrong side has the panel's triangles in the panel's order.
    let of = name.strip_suffix(WRONG_SIDE);
    if let Some(panel) = panels().find(|p| Some(p.name.as_str()) == of && p.triangles.len() == count) {
        return Ok((panel, face + count - last));
    }
    Err(format!("face {face} belongs to \"{name}\", which is no panel of the garment"))
}

impl PanelOrigin {
    fn trace(&self, triangle: usize) -> Option<Trace> {
        let corners = *self.triangles.get(triangle)?;
        let centre = |of: &[[f64; 2]]| {
            let [a, b, c] = corners.map(|i| of.get(i as usize).copied());
            let (a, b, c) = (a?, b?, c?);
            Some([0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0))
        };
        let place = centre(&self.positions)?;
        let photo = self.photo.as_ref().and_then(|p| Some((p.file.clone(), centre(&self.pixels)?)));
        Some(Trace {
            panel: self.name.clone(),
            triangle,
            place,
            edge: self.nearest_edge(place),
            photo,
            mirrored: self.photo.as_ref().is_some_and(|p| p.mirrored),
        })
    }

    fn nearest_edge(&self, place: [f64; 2]) -> Option<(String, f64)> {
        let distance = |chain: &Vec<[f64; 2]>| {
            chain.windows(2).map(|w| to_segment(place, w[0], w[1])).fold(f64::INFINITY, f64::min)
        };
        let edges = self.edges.iter().map(|(name, chain)| (name, distance(chain)));
        let nearest = edges.filter(|(_, d)| d.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(name, d)| (name.clone(), d))
    }
}

/// Distance of a point to a segment.
fn to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = u[0] * u[0] + u[1] * u[1];
    let t = if length > 0.0 { ((u[0] * v[0] + u[1] * v[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (v[0] - t * u[0]).hypot(v[1] - t * u[1])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::write::origin::PhotoOrigin;
    use proptest::prelude::*;

    /// A square of 10 cm, cut along its diagonal, named below and at the right.
    fn square(name: &str) -> PanelOrigin {
        PanelOrigin {
            name: name.into(),
            photo: Some(PhotoOrigin { file: "front.jpg".into(), mirrored: false }),
            positions: vec![[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]],
            pixels: vec![[10.0, 110.0], [110.0, 110.0], [110.0, 10.0], [10.0, 10.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            edges: vec![
                ("hem".into(), vec![[0.0, 0.0], [0.1, 0.0]]),
                ("side_left".into(), vec![[0.1, 0.0], [0.1, 0.1]]),
            ],
        }
    }

    fn origin() -> Vec<u8> {
        serde_json::to_vec(&Origins { panels: vec![square("front"), square("back")], seams: Vec::new() })
            .unwrap()
    }

    const OBJ: &str = "v 0 0 0\ng front\nf 1 2 3\nf 1 3 4\ng back\nf 1 2 3\nf 1 3 4\ng body\nf 1 2 3\n";

    #[test]
    fn a_triangle_is_followed_to_panel_edge_and_pixel() {
        let t = trace(&origin(), OBJ.as_bytes(), "obj", 2).unwrap();
        assert_eq!((t.panel.as_str(), t.triangle, t.mirrored), ("back", 0, false));
        assert!((t.place[0] - 0.2 / 3.0).abs() < 1e-12 && (t.place[1] - 0.1 / 3.0).abs() < 1e-12);
        let (file, pixel) = t.photo.unwrap();
        assert_eq!((file.as_str(), pixel.map(f64::round)), ("front.jpg", [77.0, 77.0]));
        let (edge, far) = t.edge.unwrap();
        assert_eq!(edge, "hem");
        assert!((far - 0.1 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_file_without_groups_holds_all_panels_in_a_row() {
        let obj = "v 0 0 0\nf 1 2 3\nf 1 2 3\nf 1 2 3\nf 1 2 3\n";
        let t = trace(&origin(), obj.as_bytes(), "obj", 3).unwrap();
        assert_eq!((t.panel.as_str(), t.triangle), ("back", 1));
    }

    #[test]
    fn what_cannot_be_followed_is_said() {
        let says = |obj: &str, kind: &str, face| trace(&origin(), obj.as_bytes(), kind, face).unwrap_err();
        assert_eq!(says(OBJ, "obj", 5), "face 5 is out of range: the file has 5 triangles, counted from 0");
        let wrong = OBJ.replace("g body", "g front wrong side");
        let message = "face 4 belongs to \"front wrong side\", which is no panel of the garment";
        assert_eq!(says(&wrong, "obj", 4), message, "it has another number of triangles");
        assert_eq!(says(OBJ, "obj", 4), "face 4 belongs to \"body\", which is no panel of the garment");
        assert_eq!(
            says("g front\nf 1 2 3\n", "obj", 0),
            "its triangles are not those of \"origin.json\" beside it; run the pipeline again to write both"
        );
        assert_eq!(says(OBJ, "ply", 0), "only the triangles of .glb and .obj files can be followed");
        assert_eq!(says(OBJ, "glb", 0), "it is not a GLB file that toile wrote");
        let e = trace(b"{", OBJ.as_bytes(), "obj", 0).unwrap_err();
        assert!(e.starts_with("\"origin.json\" cannot be read: EOF while parsing"), "{e}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn any_bytes_are_followed_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..60), face in 0usize..9) {
            let glb = [&b"glTF\x02\0\0\0\0\0\0\0\x10\0\0\0JSON"[..], &bytes].concat();
            prop_assert!(trace(&origin(), &glb, "glb", face).is_err());
            prop_assert!(trace(&bytes, OBJ.as_bytes(), "obj", face).is_err());
            let _ = trace(&origin(), &bytes, "obj", face);
        }
    }
}
