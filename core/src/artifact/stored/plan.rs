//! Records of plans and judgements: fabrics, seams, phases, figures, finished files.

use super::{Reader, Record, Stored};
use crate::artifact::{
    Air, Curve, EdgeRef, Fabric, Figures, GarmentFigures, GirthFigures, OutputFile, OutputFiles,
    PanelFigures, PenetrationFigures, Phase, Phases, Seam, SeamKind, SewingPlan, Shortfall, StrainFigures,
    Vector3,
};
use crate::error::ErrorCode;
use std::collections::BTreeMap;

impl Fabric {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .text("name", &self.name)
            .number("area_density", self.area_density)
            .owned("warp", self.warp.0.iter().map(|p| [p.0, p.1]))
            .owned("weft", self.weft.0.iter().map(|p| [p.0, p.1]))
            .owned("shear", self.shear.0.iter().map(|p| [p.0, p.1]))
            .number("bending_warp", self.bending_warp)
            .number("bending_weft", self.bending_weft)
            .number("bending_friction_warp", self.bending_friction_warp)
            .number("bending_friction_weft", self.bending_friction_weft)
            .number("thickness", self.thickness)
            .number("friction", self.friction)
            .number("damping", self.damping)
            .text("source", &self.source)
    }
}

impl Stored for Fabric {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let curve =
            |name| Ok::<_, String>(Curve(r.list(name)?.into_iter().map(|[x, y]: [f64; 2]| (x, y)).collect()));
        Ok(Fabric {
            name: r.text("name")?,
            area_density: r.one("area_density")?,
            warp: curve("warp")?,
            weft: curve("weft")?,
            shear: curve("shear")?,
            bending_warp: r.one("bending_warp")?,
            bending_weft: r.one("bending_weft")?,
            // Older plugins do not know of it.
            bending_friction_warp: r.maybe_one("bending_friction_warp")?.unwrap_or(0.0),
            bending_friction_weft: r.maybe_one("bending_friction_weft")?.unwrap_or(0.0),
            thickness: r.one("thickness")?,
            friction: r.one("friction")?,
            damping: r.one("damping")?,
            source: r.text("source")?,
        })
    }
}

/// A seam's kind as its word, and its figures where it has any.
pub(super) fn kind_fields<'a>(record: Record<'a>, kind: SeamKind) -> Record<'a> {
    let (record, figures) = (record.text("kind", kind.word()), kind.figures());
    if figures.is_empty() { record } else { record.owned("kind_figures", figures) }
}

pub(super) fn kind_of(r: &Reader<'_>) -> Result<SeamKind, String> {
    let figures = if r.find("kind_figures").is_some() { r.list("kind_figures")? } else { Vec::new() };
    SeamKind::of(&r.text("kind")?, &figures)
}

impl SewingPlan {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .records("seams", self.seams.iter().map(seam_fields))
            // Older plugins ask for it.
            .records("placements", [])
    }
}

impl Stored for SewingPlan {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        Ok(SewingPlan { seams: r.records("seams")?.map(|s| seam_of(&s)).collect::<Result<_, _>>()? })
    }
}

fn seam_fields(s: &Seam) -> Record<'_> {
    let sides = Record::new().records("a", [edge_fields(&s.a)]).records("b", [edge_fields(&s.b)]);
    kind_fields(sides, s.kind).flag("reversed", s.reversed)
}

fn seam_of(r: &Reader<'_>) -> Result<Seam, String> {
    let side = |name| edge_of(&r.maybe(name)?.ok_or_else(|| format!("the field `{name}` is missing"))?);
    Ok(Seam { a: side("a")?, b: side("b")?, kind: kind_of(r)?, reversed: r.flag("reversed")? })
}

pub(super) fn edge_fields(e: &EdgeRef) -> Record<'_> {
    Record::new().text("panel", &e.panel).text("edge", &e.edge)
}

pub(super) fn edge_of(r: &Reader<'_>) -> Result<EdgeRef, String> {
    Ok(EdgeRef { panel: r.text("panel")?, edge: r.text("edge")? })
}

impl Phases {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new().records("phases", self.0.iter().map(phase_fields))
    }
}

fn phase_fields(p: &Phase) -> Record<'_> {
    let record =
        Record::new().text("name", &p.name).number("seconds", p.seconds).owned("gravity", [p.gravity]);
    match p.air {
        Some(air) => record.owned("air", air.figures()),
        None => record,
    }
}

fn air_of(r: &Reader<'_>) -> Result<Option<Air>, String> {
    if r.find("air").is_none() {
        return Ok(None);
    }
    match r.list::<f64>("air")?[..] {
        [density, normal, tangential, x, y, z] => {
            Ok(Some(Air { density, normal, tangential, wind: Vector3::new(x, y, z) }))
        }
        ref other => Err(format!("`air` has {} numbers, 6 are wanted", other.len())),
    }
}

impl Stored for Phases {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let phase = |p: Reader<'_>| {
            let (name, seconds, gravity) = (p.text("name")?, p.one("seconds")?, p.one("gravity")?);
            Ok::<_, String>(Phase { name, seconds, gravity, air: air_of(&p)? })
        };
        r.records("phases")?.map(phase).collect::<Result<_, _>>().map(Phases)
    }
}

impl Figures {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .records("panels", self.panels.iter().map(|(name, p)| panel_fields(name, p)))
            .records("garment", [garment_fields(&self.garment)])
            .records("flat", self.flat.iter().map(|(name, p)| panel_fields(name, p)))
            .records("shortfalls", self.shortfalls.iter().map(shortfall_fields))
    }
}

impl Stored for Figures {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let garment = r.maybe("garment")?.ok_or("the field `garment` is missing")?;
        let panels =
            |name| r.records(name)?.map(|p| panel_of(&p)).collect::<Result<BTreeMap<_, _>, String>>();
        Ok(Figures {
            panels: panels("panels")?,
            garment: garment_of(&garment)?,
            // Not there in what was kept before there was one.
            flat: r.find("flat").map(|_| panels("flat")).transpose()?.unwrap_or_default(),
            shortfalls: r.records("shortfalls")?.map(|s| shortfall_of(&s)).collect::<Result<_, _>>()?,
        })
    }
}

fn panel_fields<'a>(name: &'a str, p: &PanelFigures) -> Record<'a> {
    Record::new()
        .text("panel", name)
        .number("area_error", p.area_error)
        .number("outline_error", p.outline_error)
}

fn panel_of(r: &Reader<'_>) -> Result<(String, PanelFigures), String> {
    let figures = PanelFigures { area_error: r.one("area_error")?, outline_error: r.one("outline_error")? };
    Ok((r.text("panel")?, figures))
}

fn garment_fields(g: &GarmentFigures) -> Record<'_> {
    let inside = g.body_penetration.as_ref();
    let record = Record::new()
        .count("vertices", g.vertices)
        .count("triangles", g.triangles)
        .number("seam_gap_max_m", g.seam_gap_max_m)
        .owned("edge_strain", [g.edge_strain.p50, g.edge_strain.p99, g.edge_strain.max])
        .maybe(
            "body_penetration",
            inside.map(|p| Record::new().count("vertices", p.vertices).number("max_m", p.max_m)),
        )
        .number("energy_j", g.energy_j)
        .number("max_speed_m_s", g.max_speed_m_s)
        .count("steps", g.steps)
        .flag("converged", g.converged)
        .maybe_number("tight_p99", g.tight_p99)
        .maybe_number("on_body", g.on_body)
        .records("girths", g.girths.iter().map(|(level, g)| girth_fields(level, g)));
    let counts = [("body_crossings", g.body_crossings), ("self_crossings", g.self_crossings)];
    counts.into_iter().filter_map(|(name, n)| Some((name, n?))).fold(record, |r, (name, n)| r.count(name, n))
}

fn girth_fields<'a>(level: &'a str, g: &GirthFigures) -> Record<'a> {
    Record::new().text("level", level).number("cloth_m", g.cloth_m).number("body_m", g.body_m)
}

fn girth_of(r: &Reader<'_>) -> Result<(String, GirthFigures), String> {
    Ok((r.text("level")?, GirthFigures { cloth_m: r.one("cloth_m")?, body_m: r.one("body_m")? }))
}

fn garment_of(r: &Reader<'_>) -> Result<GarmentFigures, String> {
    let strain = r.list::<f64>("edge_strain")?;
    let [p50, p99, max] = strain[..] else { return Err("`edge_strain` has other than 3 figures".into()) };
    let inside = |p: Reader<'_>| {
        Ok::<_, String>(PenetrationFigures { vertices: p.count("vertices")?, max_m: p.one("max_m")? })
    };
    let maybe_count = |name| r.find(name).map(|_| r.count(name)).transpose();
    Ok(GarmentFigures {
        vertices: r.count("vertices")?,
        triangles: r.count("triangles")?,
        seam_gap_max_m: r.one("seam_gap_max_m")?,
        edge_strain: StrainFigures { p50, p99, max },
        tight_p99: r.maybe_one("tight_p99")?,
        body_penetration: r.maybe("body_penetration")?.map(inside).transpose()?,
        body_crossings: maybe_count("body_crossings")?,
        self_crossings: maybe_count("self_crossings")?,
        on_body: r.maybe_one("on_body")?,
        girths: r.records("girths")?.map(|g| girth_of(&g)).collect::<Result<_, _>>()?,
        energy_j: r.one("energy_j")?,
        max_speed_m_s: r.one("max_speed_m_s")?,
        steps: r.count("steps")?,
        converged: r.flag("converged")?,
    })
}

fn shortfall_fields(s: &Shortfall) -> Record<'_> {
    Record::new().text("code", s.code.as_str()).text("message", &s.message)
}

fn shortfall_of(r: &Reader<'_>) -> Result<Shortfall, String> {
    let code = r.text("code")?;
    let code = ErrorCode::named(&code)
        .ok_or_else(|| format!("`code` is \"{code}\", which is not one of its values"))?;
    Ok(Shortfall { code, message: r.text("message")? })
}

impl OutputFiles {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new().records("files", self.0.iter().map(file_fields))
    }
}

fn file_fields(f: &OutputFile) -> Record<'_> {
    Record::new().text("path", &f.path).list("bytes", &f.bytes)
}

impl Stored for OutputFiles {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let file =
            |f: Reader<'_>| Ok::<_, String>(OutputFile { path: f.text("path")?, bytes: f.list("bytes")? });
        r.records("files")?.map(file).collect::<Result<_, _>>().map(OutputFiles)
    }
}
