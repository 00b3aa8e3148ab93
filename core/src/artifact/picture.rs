//! Pictures: the rows of pixels of photos, masks and textures, from the top.
//!
//! With the feature `image` they are those of the crate of that name, whose functions stages that
//! look at pixels use. Without it the same names have the functions below and no more, so that a
//! mesher does not build what it never calls; what compiles without the feature compiles with it,
//! and does the same.

#[cfg(feature = "image")]
pub use image::{GrayImage, RgbImage};
#[cfg(not(feature = "image"))]
pub use own::{GrayImage, RgbImage};

/// A picture that can be made of its bytes.
pub trait Picture: Default + Sized {
    /// Bytes of a pixel.
    const CHANNELS: u32;
    /// The picture of that width and height; none where there are not as many bytes.
    fn of_bytes(width: u32, height: u32, bytes: Vec<u8>) -> Option<Self>;
}

impl Picture for RgbImage {
    const CHANNELS: u32 = 3;
    fn of_bytes(width: u32, height: u32, bytes: Vec<u8>) -> Option<Self> {
        RgbImage::from_raw(width, height, bytes)
    }
}

impl Picture for GrayImage {
    const CHANNELS: u32 = 1;
    fn of_bytes(width: u32, height: u32, bytes: Vec<u8>) -> Option<Self> {
        GrayImage::from_raw(width, height, bytes)
    }
}

#[cfg(not(feature = "image"))]
mod own {
    /// A colour picture, sRGB, three bytes per pixel.
    pub type RgbImage = Rows<3>;
    /// A grey picture, one byte per pixel.
    pub type GrayImage = Rows<1>;

    /// Rows of pixels of `C` bytes.
    #[derive(Debug, Clone, Default, PartialEq, Eq)]
    pub struct Rows<const C: usize> {
        width: u32,
        height: u32,
        bytes: Vec<u8>,
    }

    impl<const C: usize> Rows<C> {
        /// A black picture.
        pub fn new(width: u32, height: u32) -> Self {
            Rows { width, height, bytes: vec![0; C * width as usize * height as usize] }
        }

        /// The picture of these bytes; none where they are too few. What is beyond the last pixel
        /// is kept.
        pub fn from_raw(width: u32, height: u32, bytes: Vec<u8>) -> Option<Self> {
            let wanted = (C as u64).checked_mul(u64::from(width))?.checked_mul(u64::from(height))?;
            (bytes.len() as u64 >= wanted).then_some(Rows { width, height, bytes })
        }

        /// Its width, pixels.
        pub fn width(&self) -> u32 {
            self.width
        }

        /// Its height, pixels.
        pub fn height(&self) -> u32 {
            self.height
        }

        /// Width and height, pixels.
        pub fn dimensions(&self) -> (u32, u32) {
            (self.width, self.height)
        }

        /// Its bytes.
        pub fn as_raw(&self) -> &Vec<u8> {
            &self.bytes
        }

        /// Its bytes, without the picture.
        pub fn into_raw(self) -> Vec<u8> {
            self.bytes
        }
    }
}
