//! Patterns of a skirt and a sleeveless top, each in two pieces, in three formats.

use serde_json::json;
use std::fmt::Write;

/// A piece: its name and its corners, cm, counter-clockwise, y up, and a name for each edge.
pub(crate) struct Piece {
    name: &'static str,
    corners: Vec<[f64; 2]>,
}

/// Two pieces, front first, and the numbers of the edges that are sewn, from the right side to the
/// left.
pub(crate) struct Pattern {
    pieces: [Piece; 2],
    seams: Vec<usize>,
}

/// A flared skirt: widths of waist and hem of one piece, and its length, cm.
pub(crate) fn skirt(waist: f64, hem: f64, length: f64) -> Pattern {
    let half = |w: f64| w / 2.0;
    let corners = vec![[-half(hem), -length], [half(hem), -length], [half(waist), 0.0], [-half(waist), 0.0]];
    let piece = |name| Piece { name, corners: corners.clone() };
    Pattern { pieces: [piece("front"), piece("back")], seams: vec![1, 3] }
}

/// A skirt that follows waist and hip, for a hip of 96 cm: widths of waist and hem of one piece,
/// and its length, cm.
pub(crate) fn hip_skirt(waist: f64, hem: f64, length: f64) -> Pattern {
    let right = [[hem / 2.0, -length], [25.0, -20.0], [waist / 2.0, 0.0]];
    let left = right.iter().rev().map(|[x, y]| [-x, *y]);
    let corners: Vec<[f64; 2]> = right.into_iter().chain(left).collect();
    let piece = |name| Piece { name, corners: corners.clone() };
    Pattern { pieces: [piece("front"), piece("back")], seams: vec![0, 1, 3, 4] }
}

/// A sleeveless top: width of one piece and its length at the neck, cm; the front's neck is lower.
pub(crate) fn top(width: f64, length: f64) -> Pattern {
    let half = width / 2.0;
    let piece = |name, neck: f64| {
        let right = [
            [half, 0.0],
            [half, length - 22.0],
            [half - 5.0, length - 14.0],
            [17.5, length - 3.0],
            [8.5, length],
        ];
        let left = right.iter().rev().map(|[x, y]| [-x, *y]);
        let middle = [[4.0, length - neck], [-4.0, length - neck]];
        Piece { name, corners: right.into_iter().chain(middle).chain(left).collect() }
    };
    // Edges: side 0, armhole 1 and 2, shoulder 3, neck 4 to 6, shoulder 7, armhole 8 and 9, side
    // 10, hem 11.
    Pattern { pieces: [piece("front", 9.0), piece("back", 3.0)], seams: vec![0, 3, 7, 10] }
}

/// As GarmentCode writes it, with its origin that many cm above the floor.
pub(crate) fn garment_code(pattern: &Pattern, height: f64) -> Vec<u8> {
    let panel = |(k, piece): (usize, &Piece)| {
        let edges: Vec<_> = (0..piece.corners.len())
            .map(|i| json!({ "endpoints": [i, (i + 1) % piece.corners.len()] }))
            .collect();
        let (z, turned) = if k == 0 { (22.0, 0.0) } else { (-20.0, 180.0) };
        let panel = json!({
            "translation": [0.0, height, z], "rotation": [0.0, turned, 0.0], "vertices": piece.corners, "edges": edges,
        });
        (piece.name.to_owned(), panel)
    };
    let panels: serde_json::Map<_, _> = pattern.pieces.iter().enumerate().map(panel).collect();
    // The back faces backwards, so that its left edge lies at the front's right one.
    let stitch =
        |(a, b): (&usize, &usize)| json!([{ "panel": "front", "edge": a }, { "panel": "back", "edge": b }]);
    let stitches: Vec<_> = pattern.seams.iter().zip(pattern.seams.iter().rev()).map(stitch).collect();
    let file = json!({
        "pattern": { "panels": panels, "stitches": stitches, "panel_order": ["front", "back"] },
        "parameters": {}, "parameter_order": [],
        "properties": {
            "curvature_coords": "relative", "normalize_panel_translation": false, "units_in_meter": 100,
            "normalized_edge_loops": true,
        },
    });
    file.to_string().into_bytes()
}

/// Each piece as a closed line in a group of its name, in millimetres.
pub(crate) fn svg(pattern: &Pattern) -> Vec<u8> {
    let mut text = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1600mm\" height=\"900mm\" viewBox=\"0 0 1600 900\">\n",
    );
    for (k, piece) in pattern.pieces.iter().enumerate() {
        let top = piece.corners.iter().map(|c| c[1]).fold(f64::MIN, f64::max);
        let at = |[x, y]: [f64; 2]| [400.0 + 800.0 * k as f64 + 10.0 * x, 50.0 + 10.0 * (top - y)];
        let points: Vec<String> =
            piece.corners.iter().map(|c| at(*c)).map(|[x, y]| format!("{x:.3},{y:.3}")).collect();
        let path = points.join(" L ");
        writeln!(
            text,
            "<g id=\"{}\"><path d=\"M {path} Z\" fill=\"none\" stroke=\"black\"/></g>",
            piece.name
        )
        .unwrap();
    }
    text.push_str("</svg>\n");
    text.into_bytes()
}

/// A block for each piece, as programs for clothing write DXF (AAMA), in millimetres.
pub(crate) fn dxf(pattern: &Pattern) -> Vec<u8> {
    let mut pairs: Vec<(u8, String)> = Vec::new();
    let mut put = |code: u8, value: &str| pairs.push((code, value.to_owned()));
    for (code, value) in [(0, "SECTION"), (2, "HEADER"), (9, "$INSUNITS"), (70, "4"), (0, "ENDSEC")] {
        put(code, value);
    }
    put(0, "SECTION");
    put(2, "BLOCKS");
    for piece in &pattern.pieces {
        let name = piece.name.to_uppercase();
        for (code, value) in [(0, "BLOCK"), (8, "1"), (2, &*name), (70, "0"), (10, "0"), (20, "0"), (30, "0")]
        {
            put(code, value);
        }
        for (code, value) in [(0, "POLYLINE"), (8, "1"), (66, "1"), (70, "1")] {
            put(code, value);
        }
        for [x, y] in &piece.corners {
            put(0, "VERTEX");
            put(8, "1");
            put(10, &format!("{:.3}", 10.0 * x));
            put(20, &format!("{:.3}", 10.0 * y));
        }
        put(0, "SEQEND");
        for (code, value) in
            [(0, "TEXT"), (8, "1"), (10, "0"), (20, "0"), (40, "5"), (1, &*format!("Piece Name: {name}"))]
        {
            put(code, value);
        }
        put(0, "ENDBLK");
    }
    put(0, "ENDSEC");
    put(0, "SECTION");
    put(2, "ENTITIES");
    for piece in &pattern.pieces {
        let name = piece.name.to_uppercase();
        for (code, value) in [(0, "INSERT"), (8, "1"), (2, &*name), (10, "0"), (20, "0")] {
            put(code, value);
        }
    }
    put(0, "ENDSEC");
    put(0, "EOF");
    pairs.iter().map(|(code, value)| format!("{code:>3}\r\n{value}\r\n")).collect::<String>().into_bytes()
}
