//! The numbers of a GLB's lists, whatever they are stored as: 32-bit floats, or whole numbers
//! (`KHR_mesh_quantization`, Khronos, 2020).
//!
//! Cost: one pass over a list. Limit: sparse lists are refused by name.

use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;

/// Most vertices, all meshes together.
pub(in crate::flat) const MOST: usize = 4_000_000;
/// Most items of one list: the corners of twice as many triangles.
const MOST_ITEMS: usize = 6 * MOST;
/// Most bytes from one item to the next: more than the format allows.
const MOST_STRIDE: usize = 1 << 12;

/// What a list must hold.
pub(in crate::flat) struct Wanted {
    types: &'static [DataType],
    dimensions: Dimensions,
}

const SMALL: [DataType; 5] = [DataType::I8, DataType::U8, DataType::I16, DataType::U16, DataType::F32];
/// Places of vertices.
pub(in crate::flat) const PLACES: Wanted = Wanted { types: &SMALL, dimensions: Dimensions::Vec3 };
/// Texture points.
pub(in crate::flat) const TEXTURE: Wanted = Wanted { types: &SMALL, dimensions: Dimensions::Vec2 };
/// Corners of triangles.
pub(in crate::flat) const CORNERS: Wanted =
    Wanted { types: &[DataType::U8, DataType::U16, DataType::U32], dimensions: Dimensions::Scalar };

/// Refuses a list that is not what its mesh needs, or does not lie within its part of the file.
pub(in crate::flat) fn is_sound(accessor: &gltf::Accessor<'_>, wanted: &Wanted) -> Result<(), String> {
    let bad = |what: &str| Err(format!("accessor {} {what}", accessor.index()));
    if !wanted.types.contains(&accessor.data_type()) || accessor.dimensions() != wanted.dimensions {
        return bad("holds numbers of another kind than its mesh needs");
    }
    if accessor.sparse().is_some() {
        return bad("is sparse, which is not read");
    }
    let Some(view) = accessor.view() else { return bad("names no part of the file") };
    if !(1..=MOST_ITEMS).contains(&accessor.count()) {
        return bad(&format!("holds {} items, not 1 to {MOST_ITEMS}", accessor.count()));
    }
    if let Source::Uri(uri) = view.buffer().source() {
        let name: String = uri.chars().take(60).collect();
        return Err(format!("its buffer \"{name}\" is not in the .glb file itself"));
    }
    let stride = view.stride().unwrap_or_else(|| accessor.size());
    let last = (accessor.count() - 1).checked_mul(stride).and_then(|n| n.checked_add(accessor.size()));
    let end = last.and_then(|n| n.checked_add(accessor.offset()));
    if !(accessor.size()..=MOST_STRIDE).contains(&stride) || end.is_none_or(|end| end > view.length()) {
        return bad("lies outside its part of the file");
    }
    Ok(())
}

/// The items of a list that is sound.
pub(in crate::flat) fn numbers<const N: usize>(
    accessor: &gltf::Accessor<'_>,
    blob: Option<&[u8]>,
) -> Result<Vec<[f64; N]>, String> {
    let outside = || format!("accessor {} lies outside its part of the file", accessor.index());
    let view = accessor.view().ok_or_else(outside)?;
    let blob = blob.ok_or("the file has no binary part, which holds the mesh")?;
    let part = view.offset().checked_add(view.length()).and_then(|end| blob.get(view.offset()..end));
    let part = part.ok_or("the file is cut off: its binary part is shorter than it says")?;
    let stride = view.stride().unwrap_or_else(|| accessor.size());
    let wide = accessor.data_type().size();
    let one = |i: usize| {
        let first = accessor.offset() + i * stride;
        let mut item = [0.0; N];
        for (k, number) in item.iter_mut().enumerate() {
            let bytes = part.get(first + k * wide..first + (k + 1) * wide).ok_or_else(outside)?;
            *number = component(accessor.data_type(), accessor.normalized(), bytes);
        }
        Ok(item)
    };
    (0..accessor.count()).map(one).collect()
}

/// A number of so many bytes as the type says; whole numbers may stand for shares of one.
fn component(of: DataType, normalized: bool, bytes: &[u8]) -> f64 {
    let mut all = [0_u8; 4];
    all[..bytes.len()].copy_from_slice(bytes);
    let [a, b, ..] = all;
    let (number, one) = match of {
        DataType::I8 => (f64::from(i8::from_le_bytes([a])), 127.0),
        DataType::U8 => (f64::from(a), 255.0),
        DataType::I16 => (f64::from(i16::from_le_bytes([a, b])), 32_767.0),
        DataType::U16 => (f64::from(u16::from_le_bytes([a, b])), 65_535.0),
        DataType::U32 => return f64::from(u32::from_le_bytes(all)),
        DataType::F32 => return f64::from(f32::from_le_bytes(all)),
    };
    if normalized { (number / one).max(-1.0) } else { number }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_stand_for_themselves_or_for_shares_of_one() {
        assert_eq!(component(DataType::I16, false, &(-7_i16).to_le_bytes()), -7.0);
        assert_eq!(component(DataType::I16, true, &i16::MIN.to_le_bytes()), -1.0);
        assert_eq!(component(DataType::U8, true, &[51]), 0.2);
        assert_eq!(component(DataType::I8, false, &[0xFF]), -1.0);
        assert_eq!(component(DataType::F32, true, &2.5_f32.to_le_bytes()), 2.5);
    }
}
