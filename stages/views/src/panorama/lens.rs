//! The focal length of a camera as a user knows it.

use toile_core::prelude::*;

/// The narrowest and the widest picture of a camera that is no fisheye, degrees across.
const VIEWS_DEG: std::ops::RangeInclusive<f64> = 5.0..=150.0;
/// The diagonal of the film that "35 mm equivalent" speaks of, 36 x 24 mm.
const FILM_DIAGONAL_MM: f64 = 43.266_615_305_567_87;

/// The focal length of the camera, which is the radius of the cylinder.
#[choice]
#[derive(Copy)]
pub enum Lens {
    /// Found from the photos: that with which neighbours fit best, or a whole turn closes.
    Estimate,
    /// The angle that a photo shows from its left to its right side, degrees: 5 to 150.
    Degrees(f64),
    /// The focal length in pixels of the photos.
    Pixels(f64),
    /// The 35 mm equivalent that cameras and phones name, mm: 26 for the main camera of most.
    Equivalent(f64),
}

impl Lens {
    /// The focal length for photos of that size, px; none where it is to be estimated.
    ///
    /// # Errors
    /// For a lens that shows less than 5 or more than 150 degrees across.
    pub(crate) fn focal(self, [width, height]: [u32; 2]) -> Result<Option<f64>, StageError> {
        let (w, h) = (f64::from(width), f64::from(height));
        let focal = match self {
            Lens::Estimate => return Ok(None),
            Lens::Degrees(view) => {
                // Beyond 180 degrees the tangent turns round.
                let view = if VIEWS_DEG.contains(&view) { view } else { return Err(no_such_view(view)) };
                w / 2.0 / (view.to_radians() / 2.0).tan()
            }
            Lens::Pixels(focal) => focal,
            Lens::Equivalent(mm) => mm / FILM_DIAGONAL_MM * w.hypot(h),
        };
        let view = view_of(focal, w);
        match focal > 0.0 && VIEWS_DEG.contains(&view) {
            true => Ok(Some(focal)),
            false => Err(no_such_view(view)),
        }
    }

    /// What is wrong with it whatever the photos are.
    pub(crate) fn fault(self) -> Option<StageError> {
        match self {
            Lens::Degrees(view) if !VIEWS_DEG.contains(&view) => Some(no_such_view(view)),
            Lens::Pixels(length) | Lens::Equivalent(length) if !(length > 0.0 && length.is_finite()) => Some(
                StageError::new(ErrorCode::InvalidParameter, format!("`lens` has the focal length {length}"))
                    .hint("give a positive number, or `lens: Estimate`")
                    .at("lens"),
            ),
            _ => None,
        }
    }
}

/// The angle across, degrees.
pub(super) fn view_of(focal: f64, width: f64) -> f64 {
    2.0 * (width / 2.0).atan2(focal).to_degrees()
}

fn no_such_view(view: f64) -> StageError {
    let text = format!("with `lens` a photo shows {view:.1} degrees from left to right");
    StageError::new(ErrorCode::InvalidParameter, text)
        .hint("a photo shows 5 to 150 degrees; `lens: Estimate` finds the focal length from the photos")
        .at("lens")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn the_ways_to_name_a_focal_length_agree() {
        let size = [4000, 3000];
        let by_degrees = Lens::Degrees(67.38).focal(size).unwrap().unwrap();
        assert!((by_degrees - 3000.0).abs() < 1.0, "{by_degrees}");
        // 26 mm on a picture of 4:3 is 67 degrees across.
        let by_film = Lens::Equivalent(26.0).focal(size).unwrap().unwrap();
        assert!((view_of(by_film, 4000.0) - 67.3).abs() < 0.2, "{by_film}");
        assert_eq!(Lens::Pixels(3000.0).focal(size).unwrap(), Some(3000.0));
        assert_eq!(Lens::Estimate.focal(size).unwrap(), None);
    }

    #[test]
    fn a_lens_that_cannot_be_is_refused() {
        let words = |lens: Lens| lens.focal([400, 300]).unwrap_err().to_string();
        assert_eq!(words(Lens::Degrees(200.0)), "with `lens` a photo shows 200.0 degrees from left to right");
        assert_eq!(words(Lens::Pixels(20.0)), "with `lens` a photo shows 168.6 degrees from left to right");
        assert!(Lens::Pixels(f64::NAN).fault().is_some() && Lens::Pixels(f64::NAN).focal([9, 9]).is_err());
        let fault = Lens::Equivalent(-26.0).fault().unwrap();
        assert_eq!(fault.to_string(), "`lens` has the focal length -26");
        assert_eq!(fault.hint.as_deref(), Some("give a positive number, or `lens: Estimate`"));
    }
}
