//! A finished, textured model.

use super::body::obj_text;
use super::sound::{ensure, finite, indices, length};
use super::{Artifact, ArtifactType, Kind, Measures, Point3, RgbImage, Shared, Vector3};

/// A colour picture that materials refer to.
#[derive(Debug, Clone)]
pub struct Texture {
    /// Name, also its file's stem.
    pub name: String,
    /// Pixels, sRGB, top row first.
    pub pixels: Shared<RgbImage>,
    /// True where the picture goes on beyond its edges by repeating itself; else its border goes on.
    pub repeats: bool,
}

/// How a surface looks.
#[derive(Debug, Clone)]
pub struct Material {
    /// Name.
    pub name: String,
    /// Colour, linear RGB, multiplied with the texture.
    pub colour: [f32; 3],
    /// Index into the model's textures.
    pub texture: Option<usize>,
    /// True where the texture is the final colour (*replace*), false where light acts on it
    /// (*modulate*).
    pub unlit: bool,
    /// Roughness, 0 (mirror) to 1 (matt).
    pub roughness: f32,
    /// True where both faces are seen, as for cloth.
    pub double_sided: bool,
}

/// A part of the model with one material.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Name: the panel's, or `body`.
    pub name: String,
    /// Vertices, metres.
    pub positions: Vec<Point3>,
    /// Unit normals, one a vertex.
    pub normals: Vec<Vector3>,
    /// Texture coordinates, one a vertex: (0, 0) is the picture's top left, (1, 1) its bottom right, and what lies outside is as
    /// [`Texture::repeats`] says.
    /// Empty where the material has no texture.
    pub uv: Vec<[f32; 2]>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Index into the model's materials.
    pub material: usize,
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
}

impl Model {
    fn check_mesh(&self, mesh: &Mesh) -> Result<(), String> {
        let n = mesh.positions.len();
        finite("vertex", mesh.positions.iter().map(|p| &p.coords))?;
        length("normals", mesh.normals.len(), n)?;
        finite("normal", &mesh.normals)?;
        indices("a triangle", n, mesh.triangles.iter().flatten())?;
        let material = self.materials.get(mesh.material);
        let material = material.ok_or_else(|| format!("there is no material {}", mesh.material))?;
        let texture = material.texture.is_none_or(|t| t < self.textures.len());
        ensure(texture, || format!("material \"{}\" names a texture that does not exist", material.name))?;
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
            .try_for_each(|m| self.check_mesh(m).map_err(|e| format!("mesh \"{}\": {e}", m.name)))
    }

    fn record(&self) -> Option<super::stored::Record<'_>> {
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
