//! MDD, the point cache of LightWave, which Blender, Maya and Cinema 4D read.
//!
//! In big endian: frames, points (32-bit whole numbers), the time of every frame in seconds, and
//! the places of every frame (32-bit floats).

use super::most;
use toile_core::StageError;
use toile_core::artifact::RecordedMotion;

pub(super) fn mdd(motion: &RecordedMotion) -> Result<Vec<u8>, StageError> {
    let mut file = Vec::with_capacity(8 + 4 * motion.len() + 12 * motion.positions.len());
    file.extend_from_slice(&most(motion.len())?.to_be_bytes());
    file.extend_from_slice(&most(motion.vertices)?.to_be_bytes());
    file.extend(motion.times().flat_map(|t| (t as f32).to_be_bytes()));
    file.extend(motion.positions.iter().flatten().flat_map(|x| x.to_be_bytes()));
    Ok(file)
}
