//! `FabricTexturer`: cloth of a weave and a colour, for garments without photos.
//!
//! Every panel is covered by a small picture of cloth that repeats, upright along the panel's grain. Cost: one picture of `size` squared
//! pixels a kind of cloth. Limit: stripes and checks of two panels do not meet at their seam; each panel's begin at its own origin.

use super::weave::{Cloth, Colour, Tile, tile};
use super::{BodyShown, parts};
use crate::render::LINEAR;
use toile_core::prelude::*;

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
/// For patterns, which come without photos. The cloth lies along the grain: the y axis of the flat panel. Its picture repeats, so texture
/// coordinates go beyond 0 to 1.
#[stage(
    role = Texturer,
    source = "Adanur, Handbook of Weaving, 2001: plain, twill and denim weaves",
    example = "FabricTexturer(texture: Denim, colour: \"#2b3f5c\")",
    contracts(Deterministic, ThreadInvariant, Cancellable)
)]
pub struct FabricTexturer {
    /// What the cloth looks like.
    #[param(default = FabricTexture::Auto)]
    texture: FabricTexture,
    /// Colour of the cloth, of denim's warp or of the first band, as `#rrggbb` (sRGB); indigo for denim, else natural white where it is not
    /// given.
    #[param(default = None)]
    colour: Option<String>,
    /// Colour of denim's weft or of the second band, as `#rrggbb` (sRGB); white where it is not given.
    #[param(default = None)]
    second: Option<String>,
    /// Width of both bands of a check or a stripe together; 2 cm where it is not given.
    #[param(default = None, min = 0.001, max = 0.5)]
    repeat: Option<Length>,
    /// Side of the square picture that repeats.
    #[param(default = 1024, min = 64, max = 4096, unit = "px", trades)]
    size: u32,
    /// Whether the body stands in the model.
    #[param(default = BodyShown::Show)]
    body: BodyShown,
}

/// Indigo, natural and bleached white; what a colour is where none is given.
const INDIGO: &str = "#34486b";
const NATURAL: &str = "#d9d2c3";
const WHITE: &str = "#f2f0ea";
/// Bands of a check or a stripe, metres.
const BANDS: f64 = 0.02;

#[stage]
impl FabricTexturer {
    fn run(&self, garment: &Garment, body: Option<&Body>, cx: &Context) -> Result<Model, StageError> {
        crate::engine::check_garment(garment)?;
        self.fault().map_or(Ok(()), Err)?;
        let normals = garment.vertex_normals();
        let mut model = Model::default();
        let mut tiles: Vec<(FabricTexture, f64)> = Vec::new();
        for (i, panel) in garment.panels.iter().enumerate() {
            cx.check()?;
            let shows = self.shows(&panel.fabric.name);
            let known = tiles.iter().position(|t| t.0 == shows);
            let k = match known {
                Some(k) => k,
                None => {
                    let repeat = self.repeat.map_or(BANDS, |l| l.metres());
                    let Tile { pixels, side } = tile(self.cloth(shows)?, repeat, self.size);
                    let name = format!("{shows:?}").to_lowercase();
                    model.textures.push(Texture { name, pixels: Shared::new(pixels), repeats: true });
                    tiles.push((shows, side));
                    tiles.len() - 1
                }
            };
            let side = tiles[k].1;
            let mut mesh = parts::panel_mesh(garment, panel, &normals, i);
            let flat = &garment.rest[panel.vertices.clone()];
            mesh.uv = flat.iter().map(|p| [(p.x / side) as f32, (-p.y / side) as f32]).collect();
            model.meshes.push(mesh);
            let plain = parts::plain_cloth(&panel.name, [1.0; 3]);
            model.materials.push(Material { texture: Some(k), ..plain });
        }
        // Only the fabrics tell whether `Auto` finds denim.
        let is_denim = |t: &(FabricTexture, f64)| t.0 == FabricTexture::Denim;
        if self.texture == FabricTexture::Auto && self.second.is_some() && !tiles.iter().any(is_denim) {
            return Err(idle("second", "`texture: Auto`, which found no denim", OF_SECOND));
        }
        if let (Some(body), BodyShown::Show) = (body.filter(|b| !b.triangles.is_empty()), &self.body) {
            model.meshes.push(parts::body_mesh(body, model.materials.len()));
            model.materials.push(parts::mannequin());
        }
        Ok(model)
    }

    fn precheck(&self, _placed: &Placed<'_>) -> Vec<StageError> {
        self.fault().into_iter().collect()
    }
}

impl FabricTexturer {
    /// The first parameter that is not understood or does nothing here.
    fn fault(&self) -> Option<StageError> {
        use FabricTexture::{Auto, Check, Denim, Stripe};
        let of = |name: &'static str, given: bool, with: &[FabricTexture], what: &str| {
            let texture = || format!("`texture: {:?}`", self.texture);
            (given && !with.contains(&self.texture)).then(|| idle(name, &texture(), what))
        };
        let colours = [("colour", &self.colour), ("second", &self.second)];
        let bad = |(name, text): (&'static str, &Option<String>)| Some(parse(text.as_ref()?).err()?.at(name));
        of("second", self.second.is_some(), &[Auto, Denim, Check, Stripe], OF_SECOND)
            .or_else(|| of("repeat", self.repeat.is_some(), &[Check, Stripe], "checks and stripes"))
            .or_else(|| colours.into_iter().find_map(bad))
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

    fn cloth(&self, shows: FabricTexture) -> Result<Cloth, StageError> {
        let standard = if shows == FabricTexture::Denim { INDIGO } else { NATURAL };
        let colour = parse(self.colour.as_deref().unwrap_or(standard))?;
        let second = parse(self.second.as_deref().unwrap_or(WHITE))?;
        Ok(match shows {
            FabricTexture::Auto | FabricTexture::Plain => Cloth::Plain(colour),
            FabricTexture::Twill => Cloth::Twill(colour),
            FabricTexture::Denim => Cloth::Denim { warp: colour, weft: second },
            FabricTexture::Rib => Cloth::Rib(colour),
            FabricTexture::Jersey => Cloth::Jersey(colour),
            FabricTexture::Check => Cloth::Check { first: colour, second },
            FabricTexture::Stripe => Cloth::Stripe { first: colour, second },
        })
    }
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use toile_core::testkit::dress;

    fn texturer(texture: FabricTexture) -> FabricTexturer {
        FabricTexturer { texture, colour: None, second: None, repeat: None, size: 64, body: BodyShown::Hide }
    }

    fn fault(texturer: &FabricTexturer) -> (String, String) {
        let e = texturer.fault().unwrap();
        (e.message, e.hint.unwrap())
    }

    #[test]
    fn every_panel_gets_its_cloth_along_the_grain_once_a_kind() {
        let garment = dress::garment();
        let model = texturer(FabricTexture::Twill).run(&garment, None, &Context::quiet()).unwrap();
        assert_eq!((model.meshes.len(), model.textures.len()), (garment.panels.len(), 1));
        assert!(model.textures[0].repeats && model.textures[0].name == "twill");
        let (uv, flat) = (&model.meshes[0].uv, &garment.rest[garment.panels[0].vertices.clone()]);
        // 64 mm a repeat; up the grain is up the picture.
        let rises = f64::from(uv[0][1] - uv[uv.len() - 1][1]);
        assert!((rises - (flat[flat.len() - 1].y - flat[0].y) / 0.064).abs() < 1e-4);
    }

    #[test]
    fn the_fabrics_name_says_what_it_looks_like() {
        let shows = |name: &str| texturer(FabricTexture::Auto).shows(name);
        let told = ["denim", "cotton twill", "Cotton Jersey", "rib knit", "ripstop nylon", "silk charmeuse"]
            .map(shows);
        use FabricTexture::{Denim, Jersey, Plain, Rib, Twill};
        assert_eq!(told, [Denim, Twill, Jersey, Rib, Plain, Plain]);
    }

    #[test]
    fn what_does_nothing_is_refused() {
        let striped = FabricTexturer { repeat: Some(Length::mm(10.0)), ..texturer(FabricTexture::Jersey) };
        let hint = "it is for checks and stripes: leave it out, or choose one of these";
        assert_eq!(fault(&striped), ("`repeat` does nothing with `texture: Jersey`".into(), hint.into()));
        let two = FabricTexturer { second: Some("#ffffff".into()), ..texturer(FabricTexture::Plain) };
        assert_eq!(fault(&two).0, "`second` does nothing with `texture: Plain`");
        // No panel of the garment is of denim.
        let auto = FabricTexturer { texture: FabricTexture::Auto, ..two };
        let e = auto.run(&dress::garment(), None, &Context::quiet()).unwrap_err();
        assert_eq!(e.message, "`second` does nothing with `texture: Auto`, which found no denim");
        assert_eq!(
            e.hint.unwrap(),
            "it is for denim, checks and stripes: leave it out, or choose one of these"
        );
    }

    #[test]
    fn a_colour_is_six_digits() {
        let red = FabricTexturer { colour: Some("red".into()), ..texturer(FabricTexture::Plain) };
        let hint =
            "a colour is # and six digits of 0 to 9 and a to f: red, green and blue, such as \"#2b3f5c\"";
        assert_eq!(fault(&red), ("\"red\" is no colour".into(), hint.into()));
        assert_eq!(parse("#ff0000").unwrap(), [1.0, 0.0, 0.0]);
        assert!(parse("#ff00é").is_err());
    }
}
