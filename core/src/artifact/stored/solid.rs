//! Records of what stands in space: bodies, garments, models.

use super::flat::{rgb, value, word};
use super::plan::{kind_fields, kind_of};
use super::{Reader, Record, Stored};
use crate::artifact::{
    Body, Garment, GarmentPanel, GarmentSeam, GarmentStart, Held, Material, Mesh, Model, Point3,
    RecordedMotion, SeamState, Sheen, SolveStatus, Texture, Variant,
};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

impl Body {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .list("positions", &self.positions)
            .list("triangles", &self.triangles)
            .records(
                "landmarks",
                self.landmarks.iter().map(|(name, p)| Record::new().text("name", name).owned("at", [*p])),
            )
            .records(
                "measurements",
                self.measurements
                    .iter()
                    .map(|(name, x)| Record::new().text("name", name).number("length", *x)),
            )
    }
}

impl Stored for Body {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let landmark = |l: Reader<'_>| Ok::<_, String>((l.text("name")?, l.one::<Point3>("at")?));
        let measurement = |m: Reader<'_>| Ok::<_, String>((m.text("name")?, m.one::<f64>("length")?));
        Ok(Body {
            positions: r.list("positions")?,
            triangles: r.list("triangles")?,
            landmarks: r.records("landmarks")?.map(landmark).collect::<Result<BTreeMap<_, _>, _>>()?,
            measurements: r.records("measurements")?.map(measurement).collect::<Result<_, _>>()?,
        })
    }
}

impl Garment {
    pub(crate) fn fields(&self) -> Record<'_> {
        Record::new()
            .list("positions", &self.positions)
            .list("velocities", &self.velocities)
            .list("rest", &self.rest)
            .list("triangles", &self.triangles)
            .records("panels", self.panels.iter().map(panel_fields))
            .records("seams", self.seams.iter().map(seam_fields))
            .list("weld", &self.weld)
            .list("pinned", &self.pinned)
            .records("status", [status_fields(&self.status)])
            .records(
                "starts",
                self.starts
                    .iter()
                    .map(|s| Record::new().text("told", &s.told).list("positions", &s.positions)),
            )
            // Garments that nobody recorded have the bytes that they had before there were motions.
            .maybe("motion", self.motion.as_deref().map(motion_fields))
    }
}

impl Stored for Garment {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        Ok(Garment {
            positions: r.list("positions")?,
            velocities: r.list("velocities")?,
            rest: r.list("rest")?,
            triangles: r.list("triangles")?,
            panels: r.records("panels")?.map(|p| panel_of(&p)).collect::<Result<_, _>>()?,
            seams: r.records("seams")?.map(|s| seam_of(&s)).collect::<Result<_, _>>()?,
            weld: r.list("weld")?,
            pinned: r.list("pinned")?,
            status: r.maybe("status")?.map(|s| status_of(&s)).transpose()?.unwrap_or_default(),
            starts: starts_of(r)?,
            motion: r.maybe("motion")?.map(|m| motion_of(&m)).transpose()?.map(Arc::new),
        })
    }
}

fn motion_fields(m: &RecordedMotion) -> Record<'_> {
    Record::new()
        .number("every", m.every)
        .number("end", m.end)
        .list("triangles", &m.triangles)
        .count("vertices", m.vertices)
        .list("positions", &m.positions)
}

fn motion_of(r: &Reader<'_>) -> Result<RecordedMotion, String> {
    Ok(RecordedMotion {
        every: r.one("every")?,
        end: r.one("end")?,
        triangles: r.list("triangles")?,
        vertices: r.count("vertices")?,
        positions: r.list("positions")?,
    })
}

/// Garments of plugins built before there were other starts have none.
fn starts_of(r: &Reader<'_>) -> Result<Vec<GarmentStart>, String> {
    let start = |s: Reader<'_>| Ok(GarmentStart { told: s.text("told")?, positions: s.list("positions")? });
    match r.find("starts") {
        Some(_) => r.records("starts")?.map(start).collect(),
        None => Ok(Vec::new()),
    }
}

fn panel_fields(p: &GarmentPanel) -> Record<'_> {
    let record = Record::new()
        .text("name", &p.name)
        .owned("vertices", [span(&p.vertices)])
        .owned("triangles", [span(&p.triangles)])
        .list("boundary", &p.boundary)
        .list("photo_px", &p.photo_px)
        .records("fabric", [p.fabric.fields()]);
    // Most garments have one layer, and the bytes that they had before there were more.
    if p.layer == 0 { record } else { record.count("layer", p.layer as usize) }
}

fn panel_of(r: &Reader<'_>) -> Result<GarmentPanel, String> {
    let fabric = r.maybe("fabric")?.ok_or("the field `fabric` is missing")?;
    Ok(GarmentPanel {
        name: r.text("name")?,
        vertices: range(r.one("vertices")?),
        triangles: range(r.one("triangles")?),
        boundary: r.list("boundary")?,
        photo_px: r.list("photo_px")?,
        fabric: Arc::new(Stored::from_record(&fabric)?),
        layer: match r.find("layer") {
            Some(_) => u32::try_from(r.count("layer")?).map_err(|e| format!("the field `layer`: {e}"))?,
            None => 0,
        },
    })
}

fn span(range: &Range<usize>) -> [u64; 2] {
    [range.start as u64, range.end as u64]
}

fn range([start, end]: [u64; 2]) -> Range<usize> {
    start as usize..end as usize
}

const SEAM_STATES: [(&str, SeamState); 2] = [("open", SeamState::Open), ("closed", SeamState::Closed)];

fn seam_fields(s: &GarmentSeam) -> Record<'_> {
    kind_fields(Record::new().text("name", &s.name), s.kind)
        .list("pairs", &s.pairs)
        .text("state", word(&SEAM_STATES, &s.state))
}

fn seam_of(r: &Reader<'_>) -> Result<GarmentSeam, String> {
    Ok(GarmentSeam {
        name: r.text("name")?,
        kind: kind_of(r)?,
        pairs: r.list("pairs")?,
        state: value(&SEAM_STATES, r, "state")?,
    })
}

fn status_fields(s: &SolveStatus) -> Record<'_> {
    Record::new()
        .count("steps", s.steps)
        .flag("converged", s.converged)
        .number("energy", s.energy)
        .number("max_speed", s.max_speed)
        .list("on_body", &s.on_body)
        .maybe("held", (!s.held.slides.is_empty()).then(|| held_fields(&s.held)))
}

fn held_fields(h: &Held) -> Record<'_> {
    Record::new()
        .list("slides", &h.slides)
        .list("offsets", &h.offsets)
        .list("folds", &h.folds)
        .list("contacts", &h.contacts)
        .list("figures", &h.figures)
}

fn held_of(r: &Reader<'_>) -> Result<Held, String> {
    Ok(Held {
        slides: r.list("slides")?,
        offsets: r.list("offsets")?,
        folds: r.list("folds")?,
        contacts: r.list("contacts")?,
        figures: r.list("figures")?,
    })
}

fn status_of(r: &Reader<'_>) -> Result<SolveStatus, String> {
    Ok(SolveStatus {
        steps: r.count("steps")?,
        converged: r.flag("converged")?,
        energy: r.one("energy")?,
        max_speed: r.one("max_speed")?,
        on_body: r.find("on_body").map(|_| r.list("on_body")).transpose()?.unwrap_or_default(),
        held: r.maybe("held")?.map(|h| held_of(&h)).transpose()?.unwrap_or_default(),
    })
}

impl Model {
    pub(crate) fn fields(&self) -> Record<'_> {
        let record = Record::new()
            .records("meshes", self.meshes.iter().map(mesh_fields))
            .records("materials", self.materials.iter().map(material_fields))
            .records("textures", self.textures.iter().map(texture_fields));
        match self.variants.is_empty() {
            true => record,
            false => record.records("variants", self.variants.iter().map(variant_fields)),
        }
    }
}

impl Stored for Model {
    fn from_record(r: &Reader<'_>) -> Result<Self, String> {
        let texture = |t: Reader<'_>| {
            // Programs from before textures could repeat do not name it.
            let repeats = t.find("repeats").map_or(Ok(false), |_| t.flag("repeats"))?;
            Ok::<_, String>(Texture { name: t.text("name")?, pixels: t.rgb("pixels")?, repeats })
        };
        Ok(Model {
            meshes: r.records("meshes")?.map(|m| mesh_of(&m)).collect::<Result<_, _>>()?,
            materials: r.records("materials")?.map(|m| material_of(&m)).collect::<Result<_, _>>()?,
            textures: r.records("textures")?.map(texture).collect::<Result<_, _>>()?,
            // Absent where there is one look only.
            variants: match r.find("variants") {
                Some(_) => r.records("variants")?.map(|v| variant_of(&v)).collect::<Result<_, _>>()?,
                None => Vec::new(),
            },
        })
    }
}

fn variant_fields(v: &Variant) -> Record<'_> {
    let materials = v.materials.iter().map(|&m| m as u64);
    Record::new().text("name", &v.name).owned("materials", materials)
}

fn variant_of(r: &Reader<'_>) -> Result<Variant, String> {
    let index = |m: u64| usize::try_from(m).map_err(|_| format!("`materials` holds {m}, which is too many"));
    let materials = r.list::<u64>("materials")?.into_iter().map(index).collect::<Result<_, _>>()?;
    Ok(Variant { name: r.text("name")?, materials })
}

fn texture_fields(t: &Texture) -> Record<'_> {
    let record = rgb(Record::new(), &t.pixels).text("name", &t.name);
    if t.repeats { record.flag("repeats", true) } else { record }
}

fn mesh_fields(m: &Mesh) -> Record<'_> {
    Record::new()
        .text("name", &m.name)
        .list("positions", &m.positions)
        .list("normals", &m.normals)
        .list("uv", &m.uv)
        .list("triangles", &m.triangles)
        .count("material", m.material)
}

fn mesh_of(r: &Reader<'_>) -> Result<Mesh, String> {
    Ok(Mesh {
        name: r.text("name")?,
        positions: r.list("positions")?,
        normals: r.list("normals")?,
        uv: r.list("uv")?,
        triangles: r.list("triangles")?,
        material: r.count("material")?,
    })
}

fn material_fields<'a>(m: &'a Material) -> Record<'a> {
    let record = Record::new()
        .text("name", &m.name)
        .owned("colour", [m.colour])
        .flag("unlit", m.unlit)
        .owned("roughness", [m.roughness])
        .flag("double_sided", m.double_sided);
    let numbered = |record: Record<'a>, name, index: Option<usize>| match index {
        Some(index) => record.count(name, index),
        None => record,
    };
    let record = numbered(record, "texture", m.texture);
    let record = numbered(record, "normal_texture", m.normal_texture);
    let record = record.maybe("sheen", m.sheen.map(sheen_fields));
    let record = match m.wrong_side {
        Some(colour) => record.owned("wrong_side", [colour]),
        None => record,
    };
    if m.fabric.is_empty() { record } else { record.text("fabric", &m.fabric) }
}

fn sheen_fields<'a>(s: Sheen) -> Record<'a> {
    Record::new().owned("colour", [s.colour]).owned("roughness", [s.roughness])
}

fn material_of(r: &Reader<'_>) -> Result<Material, String> {
    let index = |name: &str| r.find(name).map(|_| r.count(name)).transpose();
    let sheen =
        |s: Reader<'_>| Ok::<_, String>(Sheen { colour: s.one("colour")?, roughness: s.one("roughness")? });
    Ok(Material {
        name: r.text("name")?,
        colour: r.one("colour")?,
        texture: index("texture")?,
        normal_texture: index("normal_texture")?,
        unlit: r.flag("unlit")?,
        roughness: r.one("roughness")?,
        sheen: r.maybe("sheen")?.map(sheen).transpose()?,
        double_sided: r.flag("double_sided")?,
        wrong_side: r.find("wrong_side").map(|_| r.one("wrong_side")).transpose()?,
        fabric: r.find("fabric").map(|_| r.text("fabric")).transpose()?.unwrap_or_default(),
    })
}
