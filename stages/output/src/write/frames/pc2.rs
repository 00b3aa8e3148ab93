//! PC2, the point cache of 3ds Max, which Blender's modifier Mesh Cache reads.
//!
//! `POINTCACHE2`, a zero byte, then in little endian: version, points (32-bit whole numbers), first
//! frame, frames a sample (32-bit floats), samples, and the places of every sample.

use super::most;
use toile_core::StageError;
use toile_core::artifact::RecordedMotion;

pub(super) fn pc2(motion: &RecordedMotion) -> Result<Vec<u8>, StageError> {
    let (points, samples) = (most(motion.vertices)?, most(motion.len())?);
    let mut file = Vec::with_capacity(32 + 12 * motion.positions.len());
    file.extend_from_slice(b"POINTCACHE2\0");
    file.extend_from_slice(&1i32.to_le_bytes());
    file.extend_from_slice(&points.to_le_bytes());
    file.extend_from_slice(&0f32.to_le_bytes());
    file.extend_from_slice(&1f32.to_le_bytes());
    file.extend_from_slice(&samples.to_le_bytes());
    file.extend(motion.positions.iter().flatten().flat_map(|x| x.to_le_bytes()));
    Ok(file)
}
