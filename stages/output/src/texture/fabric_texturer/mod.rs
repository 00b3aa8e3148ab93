//! `FabricTexturer`: cloth of a weave and a colour, for garments without photos.
//!
//! Every panel is covered by a small picture of cloth that repeats, upright along the panel's
//! grain. Cost: one picture of `size` squared pixels a kind of cloth. Limit: stripes and checks of
//! two panels do not meet at their seam; each panel's begin at its own origin.

mod edges;
#[cfg(test)]
mod tests;

use self::edges::{finishes, lacking};
use super::edge::add_edges;
use super::finish::{EdgeFinish, MOST_PX, PanelPicture};
use super::weave::{ClothKind, Colour, Tile, tile};
use super::{BodyShown, variants};
use crate::render::LINEAR;
use crate::render::parts;
use std::collections::BTreeMap;
use toile_core::prelude::*;

/// The relief of the threads, which light brings out beside the folds.
#[choice]
#[derive(Copy, Eq)]
pub enum FabricDetail {
    /// None: cloth as smooth as its mesh.
    None,
    /// A normal map of the same threads.
    Weave,
}

/// What cloth looks like.
#[choice]
#[derive(Copy, Eq, PartialOrd, Ord)]
pub enum FabricTexture {
    /// What the fabric's name says: denim, twill, rib or jersey; else plain.
    Auto,
    /// Plain weave: poplin, linen.
    Plain,
    /// Diagonal ribs: chino, suiting.
    Twill,
    /// Twill of a coloured warp on a light weft.
    Denim,
    /// Knitted ribs of two columns.
    Rib,
    /// Plain knit: T-shirts.
    Jersey,
    /// Gingham: bands of two colours both ways.
    Check,
    /// Bands of two colours along the grain.
    Stripe,
}

/// Dresses every panel in cloth of a weave and a colour.
///
/// For patterns, which come without photos. The cloth lies along the grain: the y axis of the flat
/// panel. Its picture repeats, so texture coordinates go beyond 0 to 1. A panel with a rib or a
/// stitched hem has a picture of its own, in which nothing is smaller than 0.4 mm.
#[stage(
    role = Texturer,
    version = 5,
    source = "Adanur, Handbook of Weaving, 2001: plain, twill and denim weaves; Blinn 1978: normals from heights; Estevez, Kulla 2017: sheen",
    example = "FabricTexturer(texture: Denim, colour: \"#2b3f5c\")",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct FabricTexturer {
    /// What the cloth looks like.
    #[param(default = FabricTexture::Auto)]
    texture: FabricTexture,
    /// Colour of the cloth, of denim's warp or of the first band, as `#rrggbb` (sRGB); indigo for
    /// denim, else natural white where it is not given.
    #[param(default = None)]
    colour: Option<String>,
    /// Colours of the garments of an outfit, from the innermost, in the place of `colour`:
    /// `["#f2f0ea", "#7a2f3a"]`; garments beyond the list have `colour`.
    #[param(default = Vec::new())]
    colours: Vec<String>,
    /// Colour of denim's weft or of the second band, as `#rrggbb` (sRGB); white where it is not
    /// given.
    #[param(default = None)]
    second: Option<String>,
    /// Width of both bands of a check or a stripe together; 2 cm where it is not given.
    #[param(default = None, min = 0.001, max = 0.5)]
    repeat: Option<Length>,
    /// Side of the square picture that repeats.
    #[param(default = 1024, min = 64, max = 4096, unit = "px", trades)]
    size: u32,
    /// Thickness of open edges, as of a hem, neckline or cuff that is turned under; 0 for none.
    #[param(default = Length::mm(2.0), min = 0.0, max = 0.02)]
    edge: Length,
    /// Edges that are bound with a knitted rib, by their names in the pattern, and its width:
    /// `{"neck": "20 mm", "left_cuff.wrist": "6 cm"}`.
    #[param(default = BTreeMap::new(), min = 0.002, max = 0.3)]
    ribs: BTreeMap<String, Length>,
    /// Edges that are turned under and stitched, by their names in the pattern, and the distance of
    /// the stitches: `{"hem": "25 mm"}`.
    #[param(default = BTreeMap::new(), min = 0.002, max = 0.3)]
    stitches: BTreeMap<String, Length>,
    /// Whether the body stands in the model.
    #[param(default = BodyShown::Show)]
    body: BodyShown,
    /// Where the normal map of the cloth comes from.
    #[param(default = FabricDetail::None)]
    detail: FabricDetail,
    /// Factor of the relief's height; 1 where it is not given.
    #[param(default = None, min = 0.05, max = 10.0)]
    strength: Option<f64>,
    /// The soft shine of fibres at grazing angles, as a share of white.
    #[param(default = parts::SHEEN, min = 0.0, max = 1.0)]
    sheen: f64,
    /// Further looks of the model by name, each with its `colour`: `{"red": "#a03028"}`. The look
    /// without them is then named `original`.
    #[param(default = BTreeMap::new())]
    variants: BTreeMap<String, String>,
}

/// Indigo, natural and bleached white; what a colour is where none is given.
const INDIGO: &str = "#34486b";
const NATURAL: &str = "#d9d2c3";
const WHITE: &str = "#f2f0ea";
/// Bands of a check or a stripe, metres.
const BANDS: f64 = 0.02;

#[stage]
impl FabricTexturer {
    fn run(
        &self,
        garment: &Garment,
        panels: Option<Set<Panel>>,
        body: Option<&Body>,
        cx: &Context,
    ) -> Result<Model, StageError> {
        garment.check_solvable()?;
        self.fault().map_or(Ok(()), Err)?;
        let mut kinds = Vec::new();
        for shown in garment.panels.iter().map(|p| self.shown(p)) {
            if !kinds.contains(&shown) {
                kinds.push(shown);
            }
        }
        // Whether `Auto` finds denim depends on the fabrics.
        let has_denim = kinds.iter().any(|k| k.texture == FabricTexture::Denim);
        if self.texture == FabricTexture::Auto && self.second.is_some() && !has_denim {
            return Err(idle("second", "`texture: Auto`, which found no denim", OF_SECOND));
        }
        let finishes = finishes(&self.ribs, &self.stitches, garment, panels.as_ref(), cx)?;
        let dress = Dress { garment, kinds: &kinds, finishes: &finishes };
        let pictures = self.pictures(&dress, self.colour.as_deref(), cx)?;
        let mut model = self.dressed(&dress, pictures, cx)?;
        self.body.add(&mut model, body)?;
        let own = model.clone();
        for (name, colour) in &self.variants {
            let pictures = self.pictures(&dress, Some(colour), cx)?;
            let mut other = own.clone();
            let tiles = pictures.tiles.into_iter().map(|t| t.pixels);
            let looks = tiles.chain(pictures.sheets.into_iter().flatten().map(|s| s.pixels));
            for (texture, pixels) in other.textures.iter_mut().zip(looks) {
                texture.name = format!("{} {name}", texture.name);
                texture.pixels = Shared::new(pixels);
            }
            model.add_variant(variants::ORIGINAL, name, &other).map_err(StageError::internal)?;
        }
        Ok(model)
    }

    fn faults(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.fault().into_iter().collect()
    }

    /// Names of edges that the pattern's file lacks, where a file makes the outlines: reading it is
    /// quick.
    fn warnings(&self, placed: &Placed<'_>) -> Vec<StageError> {
        let makes_outlines = |n: &&toile_core::Node| n.card.outputs.iter().any(|o| o.kind == Outline::KIND);
        let is_reader = |n: &&toile_core::Node| n.card.inputs.is_empty();
        let names = self.ribs.len() + self.stitches.len();
        let sources = placed.sources();
        let Some(reader) =
            sources.iter().copied().find(makes_outlines).filter(is_reader).filter(|_| names > 0)
        else {
            return Vec::new();
        };
        let Ok(made) = reader.stage.run_ports(&toile_core::Inputs(Vec::new()), placed.cx) else {
            return Vec::new();
        };
        let entries = made.iter().flat_map(toile_core::PortValue::entries);
        let outlines: Vec<(&str, &Outline)> = entries
            .filter_map(|(name, artifact)| {
                let any: &dyn std::any::Any = artifact.as_ref();
                Some((name, any.downcast_ref::<Outline>()?))
            })
            .collect();
        lacking(&self.ribs, &self.stitches, &outlines)
    }
}

impl FabricTexturer {
    /// What is seen: a picture of each kind of cloth that repeats, then one of each panel with
    /// finished edges.
    fn pictures(
        &self,
        dress: &Dress<'_>,
        colour: Option<&str>,
        cx: &Context,
    ) -> Result<ClothPictures, StageError> {
        let tiles: Vec<Tile> =
            dress.kinds.iter().map(|k| self.tile(k, colour)).collect::<Result<_, StageError>>()?;
        let mut sheets = Vec::new();
        for (panel, finishes) in dress.garment.panels.iter().zip(dress.finishes) {
            cx.check()?;
            if finishes.is_empty() {
                sheets.push(None);
                continue;
            }
            let flat = &dress.garment.rest[panel.vertices.clone()];
            let kind = dress.kind_of(&self.shown(panel));
            let swatch = tiles[kind].swatch(longest(flat) / MOST_PX);
            let rib = self.cloth(&dress.kinds[kind], colour)?.first();
            sheets.push(Some(PanelPicture::new(flat, &swatch, finishes, rib)));
        }
        Ok(ClothPictures { tiles, sheets })
    }

    /// The panels in their cloth: its pictures, then their normal maps where they are requested.
    fn dressed(&self, dress: &Dress<'_>, pictures: ClothPictures, cx: &Context) -> Result<Model, StageError> {
        let garment = dress.garment;
        let mut model = Model::default();
        let normals = garment.vertex_normals();
        let mut next = dress.kinds.len();
        for (i, panel) in garment.panels.iter().enumerate() {
            cx.check()?;
            let kind = dress.kind_of(&self.shown(panel));
            let mut mesh = parts::panel_mesh(garment, panel, &normals, i);
            let flat = &garment.rest[panel.vertices.clone()];
            let texture = match &pictures.sheets[i] {
                Some(sheet) => {
                    mesh.uv = flat.iter().map(|p| sheet.uv(p)).collect();
                    next += 1;
                    next - 1
                }
                None => {
                    let side = pictures.tiles[kind].side;
                    mesh.uv = flat.iter().map(|p| [(p.x / side) as f32, (-p.y / side) as f32]).collect();
                    kind
                }
            };
            model.meshes.push(mesh);
            model
                .materials
                .push(Material { texture: Some(texture), ..parts::panel_cloth(panel, [1.0; 3], self.sheen) });
        }
        self.add_textures(&mut model, dress, pictures);
        add_edges(&mut model, garment, &normals, self.edge.metres());
        Ok(model)
    }

    /// Gives a model its pictures.
    fn add_textures(&self, model: &mut Model, dress: &Dress<'_>, pictures: ClothPictures) {
        let mut reliefs = Vec::new();
        let mut add = |name: String, pixels, map: &dyn Fn(f64) -> image::RgbImage, repeats| {
            if self.detail == FabricDetail::Weave {
                let map = Shared::new(map(self.strength.unwrap_or(1.0)));
                reliefs.push(Texture { name: format!("{name} normals"), pixels: map, repeats });
            }
            model.textures.push(Texture { name, pixels: Shared::new(pixels), repeats });
        };
        for (kind, tile) in dress.kinds.iter().zip(pictures.tiles) {
            let texture = format!("{:?}", kind.texture).to_lowercase();
            let name = kind.colour.map_or(texture.clone(), |colour| format!("{texture} {colour}"));
            add(name, tile.pixels.clone(), &|strength| tile.normal_map(strength), true);
        }
        for (panel, sheet) in dress.garment.panels.iter().zip(pictures.sheets) {
            let Some(sheet) = sheet else { continue };
            add(panel.name.clone(), sheet.pixels.clone(), &|strength| sheet.normal_map(strength), false);
        }
        if !reliefs.is_empty() {
            let count = reliefs.len();
            model.materials.iter_mut().for_each(|m| m.normal_texture = m.texture.map(|t| t + count));
            model.textures.extend(reliefs);
        }
    }

    fn tile(&self, shown: &Shown<'_>, colour: Option<&str>) -> Result<Tile, StageError> {
        let repeat = self.repeat.map_or(BANDS, |l| l.metres());
        Ok(tile(self.cloth(shown, colour)?, repeat, self.size))
    }

    /// The first parameter that is not understood or does nothing here.
    fn fault(&self) -> Option<StageError> {
        use FabricTexture::{Auto, Check, Denim, Stripe};
        let of = |name: &'static str, given: bool, with: &[FabricTexture], what: &str| {
            let texture = || format!("`texture: {:?}`", self.texture);
            (given && !with.contains(&self.texture)).then(|| idle(name, &texture(), what))
        };
        let colours = [("colour", &self.colour), ("second", &self.second)];
        let bad = |(name, text): (&'static str, &Option<String>)| Some(parse(text.as_ref()?).err()?.at(name));
        let bad_layer = || self.colours.iter().find_map(|c| Some(parse(c).err()?.at("colours")));
        of("second", self.second.is_some(), &[Auto, Denim, Check, Stripe], OF_SECOND)
            .or_else(|| of("repeat", self.repeat.is_some(), &[Check, Stripe], "checks and stripes"))
            .or_else(|| {
                let given = self.strength.is_some() && self.detail == FabricDetail::None;
                let text = "`strength` does nothing with `detail: None`";
                let hint = "leave it out, or give `detail: Weave`";
                given.then(|| StageError::invalid(text).hint(hint).at("strength"))
            })
            .or_else(|| colours.into_iter().find_map(bad))
            .or_else(bad_layer)
            .or_else(|| {
                let both = !self.colours.is_empty() && !self.variants.is_empty();
                let text = "`variants` have one colour, the garments of an outfit have several";
                both.then(|| {
                    StageError::invalid(text).hint("leave out `colours` or `variants`").at("variants")
                })
            })
            .or_else(|| self.variants.iter().find_map(bad_variant))
    }

    /// What is seen of a panel.
    fn shown(&self, panel: &GarmentPanel) -> Shown<'_> {
        let colour = self.colours.get(panel.layer as usize).map(String::as_str);
        Shown { texture: self.shows(&panel.fabric.name), colour }
    }

    /// What cloth of this name looks like.
    fn shows(&self, fabric: &str) -> FabricTexture {
        if self.texture != FabricTexture::Auto {
            return self.texture;
        }
        let name = fabric.to_lowercase();
        let has = |words: &[&str]| words.iter().any(|w| name.contains(w));
        match () {
            () if has(&["denim", "jeans"]) => FabricTexture::Denim,
            () if has(&["rib", "interlock"]) && !has(&["ripstop"]) => FabricTexture::Rib,
            () if has(&["jersey", "knit"]) => FabricTexture::Jersey,
            () if has(&["twill", "chino", "suiting", "gabardine"]) => FabricTexture::Twill,
            () => FabricTexture::Plain,
        }
    }

    fn cloth(&self, shown: &Shown<'_>, colour: Option<&str>) -> Result<ClothKind, StageError> {
        let standard = if shown.texture == FabricTexture::Denim { INDIGO } else { NATURAL };
        let colour = parse(shown.colour.or(colour).unwrap_or(standard))?;
        let second = parse(self.second.as_deref().unwrap_or(WHITE))?;
        Ok(match shown.texture {
            FabricTexture::Auto | FabricTexture::Plain => ClothKind::Plain(colour),
            FabricTexture::Twill => ClothKind::Twill(colour),
            FabricTexture::Denim => ClothKind::Denim { warp: colour, weft: second },
            FabricTexture::Rib => ClothKind::Rib(colour),
            FabricTexture::Jersey => ClothKind::Jersey(colour),
            FabricTexture::Check => ClothKind::Check { first: colour, second },
            FabricTexture::Stripe => ClothKind::Stripe { first: colour, second },
        })
    }
}

/// A kind of cloth that is seen.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Shown<'a> {
    texture: FabricTexture,
    /// The colour of its garment, where the garments of an outfit have their own.
    colour: Option<&'a str>,
}

/// What is to be dressed: a garment, the kinds of its cloth, and the finished edges of each panel.
struct Dress<'a> {
    garment: &'a Garment,
    kinds: &'a [Shown<'a>],
    finishes: &'a [Vec<EdgeFinish>],
}

impl Dress<'_> {
    fn kind_of(&self, shown: &Shown<'_>) -> usize {
        self.kinds.iter().position(|kind| kind == shown).unwrap_or(0)
    }
}

/// A picture of each kind of cloth, and of each panel that has one of its own.
struct ClothPictures {
    tiles: Vec<Tile>,
    sheets: Vec<Option<PanelPicture>>,
}

/// The longer side of the box around a flat panel, metres.
fn longest(flat: &[Point2]) -> f64 {
    let side = |of: fn(&Point2) -> f64| {
        let (lo, hi) = flat.iter().map(of).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        hi - lo
    };
    side(|p| p.x).max(side(|p| p.y))
}

/// Refuses a variant without a name or colour of its own.
fn bad_variant((name, colour): (&String, &String)) -> Option<StageError> {
    let hint = "a variant is a name with a colour, such as \"red\": \"#a03028\"";
    let text = format!("the variant {name:?} has the name of the model's own look, or none");
    (!variants::is_name(name))
        .then(|| StageError::invalid(text).hint(hint))
        .or_else(|| parse(colour).err())
        .map(|e| e.at("variants"))
}

/// What a second colour is for.
const OF_SECOND: &str = "denim, checks and stripes";

/// A parameter that does nothing with a texture.
fn idle(name: &'static str, texture: &str, what: &str) -> StageError {
    StageError::invalid(format!("`{name}` does nothing with {texture}"))
        .hint(format!("it is for {what}: leave it out, or choose one of these"))
        .at(name)
}

/// Linear light of `#rrggbb`.
fn parse(text: &str) -> Result<Colour, StageError> {
    let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()));
    let value = digits.and_then(|d| u32::from_str_radix(d, 16).ok()).ok_or_else(|| {
        StageError::invalid(format!("\"{text}\" is no colour")).hint(
            "a colour is # and six digits of 0 to 9 and a to f: red, green and blue, such as \"#2b3f5c\"",
        )
    })?;
    Ok([16, 8, 0].map(|shift| LINEAR[(value >> shift & 255) as usize]))
}
