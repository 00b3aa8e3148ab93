//! The binary chunk of a GLB file in the making.

use serde_json::{Value, json};

/// Component types and buffer targets of the standard.
const BYTE: u32 = 5120;
const SHORT: u32 = 5122;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Bytes with the views and accessors that name their parts.
#[derive(Default)]
pub(in crate::write) struct Buffer {
    pub(in crate::write) bytes: Vec<u8>,
    pub(in crate::write) views: Vec<Value>,
    pub(in crate::write) accessors: Vec<Value>,
}

impl Buffer {
    /// Appends bytes on a multiple of four; returns the view's index.
    pub(in crate::write) fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Appends vectors of floats; returns the accessor's index.
    pub(in crate::write) fn floats<const N: usize>(
        &mut self,
        rows: Vec<[f32; N]>,
        kind: &str,
        bounds: bool,
    ) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|f| f.to_le_bytes()).collect();
        let view = self.view(&bytes, Some(ARRAY_BUFFER));
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": rows.len(), "type": kind });
        if bounds {
            (accessor["min"], accessor["max"]) =
                (json!(fold(&rows, f32::min).to_vec()), json!(fold(&rows, f32::max).to_vec()));
        }
        self.accessor(accessor)
    }

    /// Appends positions of 16 bits per coordinate, each row padded to eight bytes; returns the
    /// accessor's index.
    pub(in crate::write) fn shorts(&mut self, rows: Vec<[i16; 3]>) -> usize {
        let row = |[x, y, z]: &[i16; 3]| [*x, *y, *z, 0];
        let bytes: Vec<u8> = rows.iter().flat_map(row).flat_map(i16::to_le_bytes).collect();
        let view = self.strided(&bytes, 8);
        self.accessor(json!({
            "bufferView": view, "componentType": SHORT, "normalized": true, "count": rows.len(), "type": "VEC3",
            "min": fold(&rows, i16::min).to_vec(), "max": fold(&rows, i16::max).to_vec(),
        }))
    }

    /// Appends vectors of 8 bits a coordinate, each row filled up to four bytes; returns the
    /// accessor's index.
    pub(in crate::write) fn bytes_of_vectors<const N: usize>(
        &mut self,
        rows: Vec<[i8; N]>,
        kind: &str,
    ) -> usize {
        let row = |r: &[i8; N]| -> [i8; 4] { std::array::from_fn(|k| r.get(k).copied().unwrap_or(0)) };
        let bytes: Vec<u8> = rows.iter().flat_map(row).flat_map(i8::to_le_bytes).collect();
        let view = self.strided(&bytes, 4);
        self.accessor(json!({
            "bufferView": view, "componentType": BYTE, "normalized": true, "count": rows.len(), "type": kind,
        }))
    }

    fn strided(&mut self, bytes: &[u8], stride: usize) -> usize {
        let view = self.view(bytes, Some(ARRAY_BUFFER));
        self.views[view]["byteStride"] = json!(stride);
        view
    }

    /// Appends triangles; 16 bits suffice for up to 65,535 vertices (the last value restarts a
    /// strip).
    pub(in crate::write) fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> usize {
        let flat = triangles.iter().flatten();
        let (bytes, kind): (Vec<u8>, u32) = match vertices <= usize::from(u16::MAX) {
            true => (flat.flat_map(|&i| (i as u16).to_le_bytes()).collect(), UNSIGNED_SHORT),
            false => (flat.flat_map(|i| i.to_le_bytes()).collect(), UNSIGNED_INT),
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let count = 3 * triangles.len();
        self.accessor(json!({
            "bufferView": view, "componentType": kind, "count": count, "type": "SCALAR",
        }))
    }
}

/// The least or greatest of every column; zeros for no row.
fn fold<T: Copy + Default, const N: usize>(rows: &[[T; N]], pick: fn(T, T) -> T) -> [T; N] {
    let join = |a: [T; N], b: &[T; N]| std::array::from_fn(|k| pick(a[k], b[k]));
    rows.iter().skip(1).fold(rows.first().copied().unwrap_or([T::default(); N]), join)
}
