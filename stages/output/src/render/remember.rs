//! Light that an earlier run found on the same shape: the textures of a garment may change without
//! it.

use toile_core::artifact::{Digest, Digester, Model};
use toile_core::{Context, StageError};

/// Where light is looked for before it is worked out, and the shape that it falls on.
#[derive(Clone, Copy)]
pub(super) struct Remember<'a> {
    cx: &'a Context,
    shape: Digest,
}

impl std::fmt::Debug for Remember<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Remember({})", self.shape.short())
    }
}

impl<'a> Remember<'a> {
    /// For a model, whose shape alone counts: vertices, normals, triangles, and which meshes are
    /// closed.
    pub(super) fn new(model: &Model, cx: &'a Context) -> Self {
        let mut d = Digester::new();
        for mesh in &model.meshes {
            d.text(&mesh.name)
                .count(mesh.positions.len())
                .count(mesh.normals.len())
                .count(mesh.triangles.len());
            d.floats(mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]));
            d.floats(mesh.normals.iter().flat_map(|n| [n.x, n.y, n.z]));
            d.indices(mesh.triangles.iter().flatten().copied());
            let closed = model.materials.get(mesh.material).is_some_and(|m| !m.double_sided);
            d.count(usize::from(closed));
        }
        Remember { cx, shape: d.finish() }
    }

    /// Light at every vertex of every mesh, which `key` and the shape fix. Of a run that is stopped
    /// meanwhile nothing is kept.
    ///
    /// Errors: that of a stop.
    pub(super) fn light<const N: usize>(
        &self,
        key: impl FnOnce(&mut Digester),
        make: impl Fn() -> Vec<Vec<[f32; N]>>,
    ) -> Result<Vec<Vec<[f32; N]>>, StageError> {
        let mut d = Digester::new();
        d.text("light").bytes(&self.shape.0).count(N);
        key(&mut d);
        let mut made = None;
        let whole = || {
            let light = make();
            self.cx.check().map(|()| light)
        };
        let bytes = self.cx.memo(&d, || Ok(bytes_of(made.insert(whole()?))))?;
        made.or_else(|| light_of(&bytes)).map_or_else(whole, Ok)
    }
}

/// Meshes one after the other: the number of vertices, then their floats.
fn bytes_of<const N: usize>(light: &[Vec<[f32; N]>]) -> Vec<u8> {
    let mesh = |mesh: &Vec<[f32; N]>| {
        let floats = mesh.iter().flatten().flat_map(|f| f.to_le_bytes());
        (mesh.len() as u64).to_le_bytes().into_iter().chain(floats).collect::<Vec<u8>>()
    };
    light.iter().flat_map(mesh).collect()
}

fn light_of<const N: usize>(mut bytes: &[u8]) -> Option<Vec<Vec<[f32; N]>>> {
    let mut meshes = Vec::new();
    while !bytes.is_empty() {
        let (count, rest) = bytes.split_first_chunk::<8>()?;
        let (floats, rest) =
            rest.split_at_checked(usize::try_from(u64::from_le_bytes(*count)).ok()?.checked_mul(4 * N)?)?;
        let float = |b: &[u8]| Some(f32::from_le_bytes(b.try_into().ok()?));
        let vertex = |v: &[u8]| v.chunks_exact(4).map(float).collect::<Option<Vec<f32>>>()?.try_into().ok();
        meshes.push(floats.chunks_exact(4 * N).map(vertex).collect::<Option<Vec<[f32; N]>>>()?);
        bytes = rest;
    }
    Some(meshes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn light_comes_back_as_it_was(light in proptest::collection::vec(proptest::collection::vec(any::<[f32; 2]>(), 0..5), 0..4)) {
            let back = light_of::<2>(&bytes_of(&light)).map(|l| bytes_of(&l));
            prop_assert_eq!(back, Some(bytes_of(&light)));
        }

        #[test]
        fn any_bytes_are_light_or_none(bytes in proptest::collection::vec(any::<u8>(), 0..40)) {
            let _ = light_of::<1>(&bytes);
        }
    }
}
