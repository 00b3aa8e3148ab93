//! A finished, textured model.

use super::body::obj_text;
use super::{Artifact, ArtifactType, Kind, Measures, Point3, RgbImage, Shared, Vector3};
use crate::artifact::store::sound::{ensure, finite, indices, length};

/// A picture that materials refer to: colours, or the normals of a normal map.
#[derive(Debug, Clone)]
pub struct Texture {
    /// Name, also its file's stem.
    pub name: String,
    /// Pixels, top row first: sRGB colours. In a normal map (Blinn, 1978) the share of 255 counts,
    /// without a transfer function: red is x along growing u, green y along falling v (up the
    /// picture), blue z out of the surface, each from -1 to 1.
    pub pixels: Shared<RgbImage>,
    /// True where the picture goes on beyond its edges by repeating itself; else its border goes
    /// on.
    pub repeats: bool,
}

/// The soft shine of fibres that stand off a cloth, seen at grazing angles (Estevez and Kulla,
/// 2017).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheen {
    /// Colour, linear RGB, 0 (none) to 1.
    pub colour: [f32; 3],
    /// Roughness, 0 (a thin rim) to 1 (all over).
    pub roughness: f32,
}

/// How a surface looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Colour, linear RGB, multiplied with the texture.
    pub colour: [f32; 3],
    /// Index into the model's textures.
    pub texture: Option<usize>,
    /// Index of the texture that is this surface's normal map. It is read at the same texture
    /// coordinates.
    pub normal_texture: Option<usize>,
    /// True where the texture is the final colour (*replace*), false where light acts on it
    /// (*modulate*).
    pub unlit: bool,
    /// Roughness, 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// The shine of its fibres, where it has one.
    pub sheen: Option<Sheen>,
    /// True where both faces are seen, as for cloth.
    pub double_sided: bool,
    /// Colour of the cloth's wrong side, linear RGB, which is then plain; none where it looks like
    /// the right side.
    pub wrong_side: Option<[f32; 3]>,
    /// Name of the fabric; empty where it is none.
    pub fabric: String,
}

/// A part of the model with one material.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Name: the panel's, or `body`.
    pub name: String,
    /// Vertices, metres.
    pub positions: Vec<Point3>,
    /// Unit normals, one per vertex.
    pub normals: Vec<Vector3>,
    /// Texture coordinates, one per vertex: (0, 0) is the picture's top left, (1, 1) its bottom
    /// right, and what lies outside is as [`Texture::repeats`] says. Empty where the material has
    /// no texture.
    pub uv: Vec<[f32; 2]>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Index into the model's materials.
    pub material: usize,
}

/// The same meshes in other materials.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    /// Name, unlike that of any other variant.
    pub name: String,
    /// Index into the model's materials, one per mesh.
    pub materials: Vec<usize>,
}

/// Meshes with materials and textures; the garment first, the body (where it is shown) last.
#[derive(Debug, Clone, Default)]
pub struct Model {
    /// Parts.
    pub meshes: Vec<Mesh>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Textures.
    pub textures: Vec<Texture>,
    /// Looks to choose from; the first is that of the meshes' own materials. None where there is
    /// one look only.
    pub variants: Vec<Variant>,
}

impl Model {
    /// Whether a texture is the normal map of a material.
    pub fn is_normal_map(&self, texture: usize) -> bool {
        self.materials.iter().any(|m| m.normal_texture == Some(texture))
    }

    /// Adds the look of another model of the same meshes as a variant; what both share is kept
    /// once. `own` names this model's look where it has no variants yet.
    ///
    /// Errors: the other model has more or fewer meshes.
    pub fn add_variant(&mut self, own: &str, name: &str, other: &Model) -> Result<(), String> {
        let (have, given) = (self.meshes.len(), other.meshes.len());
        ensure(have == given, || format!("the variant \"{name}\" has {given} meshes, the model {have}"))?;
        if self.variants.is_empty() {
            let materials = self.meshes.iter().map(|m| m.material).collect();
            self.variants.push(Variant { name: own.to_owned(), materials });
        }
        let textures: Vec<usize> = other.textures.iter().map(|t| self.texture_like(t)).collect();
        let here = |t: Option<usize>| t.map(|t| textures.get(t).copied().unwrap_or(t));
        let materials: Vec<usize> = other
            .materials
            .iter()
            .map(|m| Material {
                texture: here(m.texture),
                normal_texture: here(m.normal_texture),
                ..m.clone()
            })
            .map(|m| self.material_like(m))
            .collect();
        let of_mesh = |m: &Mesh| materials.get(m.material).copied().unwrap_or(m.material);
        let materials = other.meshes.iter().map(of_mesh).collect();
        self.variants.push(Variant { name: name.to_owned(), materials });
        Ok(())
    }

    /// The index of the very same picture under the same name, which is added where there is none.
    fn texture_like(&mut self, like: &Texture) -> usize {
        let same =
            |t: &Texture| t.name == like.name && t.repeats == like.repeats && t.pixels.is_same(&like.pixels);
        self.textures.iter().position(same).unwrap_or_else(|| {
            self.textures.push(like.clone());
            self.textures.len() - 1
        })
    }

    /// The index of an equal material, which is added where there is none.
    fn material_like(&mut self, like: Material) -> usize {
        self.materials.iter().position(|m| *m == like).unwrap_or_else(|| {
            self.materials.push(like);
            self.materials.len() - 1
        })
    }

    fn check_material(&self, m: &Material) -> Result<(), String> {
        let known = |t: Option<usize>| t.is_none_or(|t| t < self.textures.len());
        ensure(known(m.texture) && known(m.normal_texture), || {
            format!("material \"{}\" names a texture that does not exist", m.name)
        })?;
        ensure(!m.texture.is_some_and(|t| self.is_normal_map(t)), || {
            format!("material \"{}\" takes a normal map for colours", m.name)
        })?;
        let sheen = m.sheen.map_or([0.0; 4], |s| [s.colour[0], s.colour[1], s.colour[2], s.roughness]);
        ensure(sheen.iter().all(|v| (0.0..=1.0).contains(v)), || {
            format!("the sheen of material \"{}\" is not between 0 and 1", m.name)
        })?;
        let back = m.wrong_side.unwrap_or_default();
        ensure(back.iter().all(|v| (0.0..=1.0).contains(v)), || {
            format!("the wrong side of material \"{}\" is not between 0 and 1", m.name)
        })
    }

    fn check_variant(&self, variant: &Variant) -> Result<(), String> {
        length("materials", variant.materials.len(), self.meshes.len())?;
        let known = variant.materials.iter().all(|&m| m < self.materials.len());
        ensure(known, || "a mesh has a material that does not exist".to_owned())
    }

    fn check_mesh(&self, mesh: &Mesh) -> Result<(), String> {
        let n = mesh.positions.len();
        finite("vertex", mesh.positions.iter().map(|p| &p.coords))?;
        length("normals", mesh.normals.len(), n)?;
        finite("normal", &mesh.normals)?;
        indices("a triangle", n, mesh.triangles.iter().flatten())?;
        let material = self.materials.get(mesh.material);
        let material = material.ok_or_else(|| format!("there is no material {}", mesh.material))?;
        self.check_material(material)?;
        if !mesh.uv.is_empty() {
            length("texture coordinates", mesh.uv.len(), n)?;
        }
        ensure(mesh.uv.iter().flatten().all(|c| c.is_finite()), || {
            "a texture coordinate is not a finite number".to_owned()
        })
    }
}

impl ArtifactType for Model {
    const KIND: Kind = Kind("model");
    const IN_SETS: bool = false;
}

impl Artifact for Model {
    fn kind(&self) -> Kind {
        Self::KIND
    }

    fn measures(&self) -> Measures {
        let mut m = Measures::new();
        m.count("meshes", self.meshes.len()).count("textures", self.textures.len());
        for t in &self.textures {
            let sum: u64 = t.pixels.as_raw().iter().map(|&v| u64::from(v)).sum();
            let mean = sum as f64 / t.pixels.as_raw().len().max(1) as f64;
            m.push(&format!("{}.mean_level", t.name), mean, "grey levels", 1.0);
        }
        m
    }

    fn check(&self) -> Result<(), String> {
        for t in &self.textures {
            let (w, h) = t.pixels.dimensions();
            ensure(w > 0 && h > 0, || format!("texture \"{}\" is {w} x {h} pixels", t.name))?;
        }
        self.meshes
            .iter()
            .try_for_each(|m| self.check_mesh(m).map_err(|e| format!("mesh \"{}\": {e}", m.name)))?;
        self.materials.iter().try_for_each(|m| self.check_material(m))?;
        self.variants
            .iter()
            .try_for_each(|v| self.check_variant(v).map_err(|e| format!("variant \"{}\": {e}", v.name)))
    }

    fn record(&self) -> Option<crate::artifact::store::Record<'_>> {
        Some(self.fields())
    }

    fn export(&self) -> Vec<(&'static str, Vec<u8>)> {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for mesh in &self.meshes {
            let base = positions.len() as u32;
            positions.extend_from_slice(&mesh.positions);
            triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| i + base)));
        }
        vec![("obj", obj_text(&positions, &triangles))]
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::artifact::stored::tests::model;

    #[test]
    fn a_variant_brings_what_is_its_own_and_shares_the_rest() {
        let base = Model { variants: vec![], ..model() };
        let mut red = base.clone();
        red.materials[0].colour = [1.0, 0.0, 0.0];
        let mut both = base.clone();
        both.add_variant("plain", "red", &red).unwrap();
        let variants = [("plain", 0), ("red", 1)];
        let variants = variants.map(|(name, m)| Variant { name: name.into(), materials: vec![m] });
        assert_eq!(both.variants, variants);
        assert_eq!((both.materials.len(), both.textures.len()), (2, base.textures.len()));
        assert_eq!(both.check(), Ok(()));
        let told = both.add_variant("plain", "none", &Model::default());
        assert_eq!(told, Err("the variant \"none\" has 0 meshes, the model 1".to_owned()));
    }

    #[test]
    fn unsound_materials_and_variants_are_named() {
        let fault = |change: &dyn Fn(&mut Model)| {
            let mut model = model();
            change(&mut model);
            model.check().unwrap_err()
        };
        let colours = fault(&|m| m.materials[0].texture = Some(1));
        assert_eq!(colours, "mesh \"front\": material \"cloth\" takes a normal map for colours");
        let none = fault(&|m| m.materials[0].normal_texture = Some(9));
        assert_eq!(none, "mesh \"front\": material \"cloth\" names a texture that does not exist");
        let sheen =
            fault(&|m| m.materials[0].sheen = Some(Sheen { colour: [0.0, 2.0, 0.0], roughness: 0.5 }));
        assert_eq!(sheen, "mesh \"front\": the sheen of material \"cloth\" is not between 0 and 1");
        let back = fault(&|m| m.materials[0].wrong_side = Some([f32::NAN; 3]));
        assert_eq!(back, "mesh \"front\": the wrong side of material \"cloth\" is not between 0 and 1");
        let worn = fault(&|m| m.variants[0].materials = vec![7]);
        assert_eq!(worn, "variant \"red\": a mesh has a material that does not exist");
    }
}
