//! Solvers that step in time take over a garment that `SpringStitcher` has sewn, where cloth passes
//! through cloth while its seams close: springs on a coarse mesh do that in seconds, whatever steps
//! the solver makes then.

use super::motion::{InTime, SewThrough};
use crate::stitch::{SewingFor, SpringStitcher};
use std::borrow::Cow;
use toile_core::prelude::*;

impl InTime {
    /// The garment with its seams closed, where they are open and cloth is to pass through cloth
    /// meanwhile; else as it is.
    pub(super) fn sewn_first<'a>(
        &self,
        garment: &'a Garment,
        collider: Option<&Collider>,
        cx: &Context,
    ) -> Result<Cow<'a, Garment>, StageError> {
        let sewing = SewingFor { longest: "longest", wall: Some(self.time_limit), has_stiffest: false };
        self.sewn.sewn_first(garment, collider, (self.longest, self.frames), &sewing, cx)
    }
}

impl SewThrough {
    /// The same, sewn for at most so long, s, with a frame every so many seconds.
    pub(super) fn sewn_first<'a>(
        &self,
        garment: &'a Garment,
        collider: Option<&Collider>,
        (time_limit, frames): (f64, f64),
        sewing: &SewingFor,
        cx: &Context,
    ) -> Result<Cow<'a, Garment>, StageError> {
        let is_open = garment.seams.iter().any(|s| s.state == SeamState::Open);
        if !self.sew_through || !is_open {
            return Ok(Cow::Borrowed(garment));
        }
        let stitcher = SpringStitcher { sewn: *self, time_limit, frames, ..SpringStitcher::default() };
        stitcher.sew(garment, collider, sewing, cx).map(Cow::Owned)
    }
}
