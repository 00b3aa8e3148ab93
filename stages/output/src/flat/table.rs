//! `FlatTable`: how true a flattening is.

use super::overlay::outline_distance;
use super::sheet::GarmentPieces;
use super::strain_svg;
use crate::file_names::check_name;
use rayon::prelude::*;
use serde::Serialize;
use toile_core::prelude::*;
use toile_flatten::distortion::{Distortion, StrainSpread, distortion};

/// Writes how far the flat pieces are from the garment, in both directions, and draws them coloured
/// by strain.
///
/// Of each piece: area and outline on the garment and in the plane, their errors from 3D to 2D and
/// from 2D to 3D, inner angles of its corners, strain along warp and weft; of each seam the lengths
/// of its sides. Where the garment was cut from a known pattern, area and outline are held against
/// that, too, and the greatest distance between both outlines is told. `NAME.json` holds the table,
/// `NAME_strain.svg` the picture.
#[stage(
    role = Writer,
    source = "Fan, Zhou, Wang, Yuen 1999",
    example = "FlatTable(name: \"flat\")",
    contracts(Deterministic, ThreadInvariant, RefusesEmpty)
)]
pub struct FlatTable {
    /// The files' name without extension.
    #[param(default = "flat".to_owned())]
    pub name: String,
    /// Strain of the strongest colour.
    #[param(default = 0.03, min = 0.0001, max = 10.0)]
    pub full: f64,
}

#[stage]
impl FlatTable {
    /// Runs the stage.
    pub fn run(
        &self,
        garment: &Garment,
        #[original] sewn: Option<&Garment>,
        pattern: Option<&Pattern>,
        cx: &Context,
    ) -> Result<OutputFiles, StageError> {
        check_name(&self.name)?;
        let sheet = GarmentPieces::of(garment)?;
        let flat = sheet.rest(garment);
        let judged = judged(&sheet, &flat)?;
        let table = TableContents {
            garment: pattern.map_or_else(String::new, |p| p.name.clone()),
            pieces: pieces(&sheet, &flat, &judged, &Truth::of(sewn), pattern),
            seams: pattern.map_or_else(Vec::new, seams),
        };
        table.tell(cx);
        let json = serde_json::to_string_pretty(&table)
            .map_err(|e| StageError::internal(format!("the table cannot be written: {e}")))?;
        let svg = strain_svg::drawn(&sheet, &flat, &judged, garment, self.full);
        Ok(OutputFiles(vec![
            OutputFile::new(format!("{}.json", self.name), (json + "\n").into_bytes()),
            OutputFile::new(format!("{}_strain.svg", self.name), svg.into_bytes()),
        ]))
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        check_name(&self.name).err().into_iter().collect()
    }
}

/// The distortion of each piece.
fn judged(sheet: &GarmentPieces, flat: &[Vec<Point2>]) -> Result<Vec<Distortion>, StageError> {
    let one = |(i, flat): (usize, &Vec<Point2>)| {
        let name = &sheet.names[i];
        let unknown = || {
            StageError::invalid(format!("the flat shape of piece \"{name}\" is not known"))
                .hint("put a flattener before, such as `Arap()`")
        };
        let surface = &sheet.pieces.pieces[i].surface;
        let table = distortion(surface, flat).map_err(|e| super::fault::surface_fault(e, &[]))?;
        let sound =
            table.area_2d > 0.0 && table.triangles.iter().all(|t| t.warp.is_finite() && t.weft.is_finite());
        if sound { Ok(table) } else { Err(unknown()) }
    };
    flat.iter().enumerate().map(one).collect()
}

/// What is written.
#[derive(Debug, Serialize)]
struct TableContents {
    garment: String,
    pieces: Vec<PieceRow>,
    seams: Vec<SeamRow>,
}

#[derive(Debug, Serialize)]
struct PieceRow {
    name: String,
    triangles: usize,
    area_3d_m2: f64,
    area_2d_m2: f64,
    /// `(S3 - S2) / S3`.
    area_error_3d_to_2d: f64,
    /// `(S2 - S3) / S2`.
    area_error_2d_to_3d: f64,
    local_area_error: f64,
    outline_3d_m: f64,
    outline_2d_m: f64,
    /// `(L3 - L2) / L3`.
    outline_error_3d_to_2d: f64,
    /// `(L2 - L3) / L2`.
    outline_error_2d_to_3d: f64,
    corner_change_deg: f64,
    corners: Vec<CornerRow>,
    strain: StrainRow,
    flipped_triangles: usize,
    outline_crossings: usize,
    /// The pattern that it was cut from; none where that is not known.
    true_piece: Option<TrueRow>,
    proposed_darts: Vec<DartRow>,
}

#[derive(Debug, Serialize)]
struct CornerRow {
    angle_3d_deg: f64,
    angle_2d_deg: f64,
}

#[derive(Debug, Serialize)]
struct StrainRow {
    warp: SpreadRow,
    weft: SpreadRow,
    principal: SpreadRow,
}

#[derive(Debug, Serialize)]
struct SpreadRow {
    signed_mean: f64,
    mean: f64,
    p99: f64,
    max: f64,
}

impl SpreadRow {
    fn of(s: StrainSpread) -> Self {
        Self { signed_mean: s.signed_mean, mean: s.mean, p99: s.p99, max: s.max }
    }
}

#[derive(Debug, Serialize)]
struct TrueRow {
    area_m2: f64,
    outline_m: f64,
    /// Flat area over true area, less 1.
    area_error: f64,
    /// Flat outline over true outline, less 1.
    outline_error: f64,
    /// The greatest distance between the outlines, laid over each other.
    outline_distance_max_mm: Option<f64>,
    /// The root of its mean square.
    outline_distance_rms_mm: Option<f64>,
}

#[derive(Debug, Serialize)]
struct DartRow {
    name: String,
    length_m: f64,
}

#[derive(Debug, Serialize)]
struct SeamRow {
    name: String,
    kind: &'static str,
    lengths_m: Vec<f64>,
    /// The difference of the longest and the shortest side over their mean.
    mismatch: f64,
}

impl TableContents {
    /// The worst of the table, as figures of the run.
    fn tell(&self, cx: &Context) {
        let worst =
            |of: fn(&PieceRow) -> f64| self.pieces.iter().map(of).map(f64::abs).fold(0.0, f64::max) * 1e2;
        cx.figure("area_error", worst(|p| p.area_error_3d_to_2d), "%");
        cx.figure("outline_error", worst(|p| p.outline_error_3d_to_2d), "%");
        cx.figure("warp_strain_p99", worst(|p| p.strain.warp.p99), "%");
        cx.figure("weft_strain_p99", worst(|p| p.strain.weft.p99), "%");
        let even = self.seams.iter().filter(|s| s.kind != SeamKind::Gathered.word());
        cx.figure("seam_mismatch", even.map(|s| s.mismatch).fold(0.0, f64::max) * 1e2, "%");
        let far = self.pieces.iter().filter_map(|p| p.true_piece.as_ref()?.outline_distance_max_mm);
        if let Some(far) = far.reduce(f64::max) {
            cx.figure("outline_from_true", far, "mm");
        }
    }
}

fn pieces(
    sheet: &GarmentPieces,
    flat: &[Vec<Point2>],
    judged: &[Distortion],
    truth: &Truth,
    pattern: Option<&Pattern>,
) -> Vec<PieceRow> {
    let row = |(i, d): (usize, &Distortion)| PieceRow {
        name: sheet.names[i].clone(),
        triangles: d.triangles.len(),
        area_3d_m2: d.area_3d,
        area_2d_m2: d.area_2d,
        area_error_3d_to_2d: d.area_error,
        area_error_2d_to_3d: (d.area_2d - d.area_3d) / d.area_2d,
        local_area_error: d.local_area_error,
        outline_3d_m: d.outline_3d,
        outline_2d_m: d.outline_2d,
        outline_error_3d_to_2d: d.outline_error,
        outline_error_2d_to_3d: (d.outline_2d - d.outline_3d) / d.outline_2d,
        corner_change_deg: d.corner_change,
        corners: d
            .corners
            .iter()
            .map(|c| CornerRow { angle_3d_deg: c.space, angle_2d_deg: c.plane })
            .collect(),
        strain: StrainRow {
            warp: SpreadRow::of(d.warp),
            weft: SpreadRow::of(d.weft),
            principal: SpreadRow::of(d.principal),
        },
        flipped_triangles: d.flipped,
        outline_crossings: d.crossings,
        true_piece: truth.row(&sheet.names[i], sheet, i, &flat[i], d),
        proposed_darts: pattern.and_then(|p| p.piece(&sheet.names[i])).map_or_else(Vec::new, darts),
    };
    judged.par_iter().enumerate().map(row).collect()
}

fn darts(piece: &Piece) -> Vec<DartRow> {
    let proposed = piece.lines.iter().filter(|l| l.name.starts_with("proposed_dart"));
    proposed.map(|l| DartRow { name: l.name.clone(), length_m: polyline_length(&l.points) }).collect()
}

fn seams(pattern: &Pattern) -> Vec<SeamRow> {
    let row = |s: &PatternSeam| {
        let lengths: Vec<f64> = s.sides.iter().map(|side| pattern.side_length(side)).collect();
        let (least, most) = lengths.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), x| (l.min(*x), m.max(*x)));
        let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let mismatch = if mean > 0.0 { (most - least) / mean } else { 0.0 };
        SeamRow { name: s.name.clone(), kind: s.kind.word(), lengths_m: lengths, mismatch }
    };
    pattern.seams.iter().map(row).collect()
}

/// The pieces as they were cut, where the garment knew them before it was flattened.
struct Truth(Option<(GarmentPieces, Vec<Vec<Point2>>)>);

impl Truth {
    fn of(sewn: Option<&Garment>) -> Self {
        let known = sewn.and_then(|g| {
            let sheet = GarmentPieces::of(g).ok()?;
            let rest = sheet.rest(g);
            Some((sheet, rest))
        });
        Self(known)
    }

    fn row(
        &self,
        name: &str,
        flat_sheet: &GarmentPieces,
        i: usize,
        flat: &[Point2],
        d: &Distortion,
    ) -> Option<TrueRow> {
        let (sheet, rest) = self.0.as_ref()?;
        let k = sheet.names.iter().position(|n| n == name)?;
        let surface = &sheet.pieces.pieces[k].surface;
        let truth = distortion(surface, &rest[k]).ok().filter(|t| t.area_2d > 0.0)?;
        let outer = |sheet: &GarmentPieces, i: usize, places: &[Point2]| {
            let l = sheet.pieces.pieces[i].surface.loops().first().map_or(&[][..], Vec::as_slice);
            l.iter().map(|&v| places[v as usize]).collect::<Vec<_>>()
        };
        let apart = outline_distance(&outer(flat_sheet, i, flat), &outer(sheet, k, &rest[k]));
        Some(TrueRow {
            area_m2: truth.area_2d,
            outline_m: truth.outline_2d,
            area_error: d.area_2d / truth.area_2d - 1.0,
            outline_error: d.outline_2d / truth.outline_2d - 1.0,
            outline_distance_max_mm: apart.map(|a| a.1 * 1e3),
            outline_distance_rms_mm: apart.map(|a| a.0 * 1e3),
        })
    }
}
