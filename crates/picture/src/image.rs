//! Pixels: an image in memory, simple drawing on it, PNG.

use crate::PictureError;
use crate::colour::{Rgb, byte};

/// Pixels in rows from the top left, four bytes each: red, green, blue (sRGB), opacity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `4 * width * height` bytes.
    pub pixels: Vec<u8>,
}

/// Most pixels an image may have: 64 million, a quarter of a gigabyte.
const LARGEST: usize = 1 << 26;

impl Image {
    /// An image of one colour.
    ///
    /// # Errors
    /// No pixels, or more than 64 million.
    pub fn new(width: usize, height: usize, colour: Rgb) -> Result<Self, PictureError> {
        let count = width.saturating_mul(height);
        if count == 0 || count > LARGEST {
            return Err(PictureError::Size { width, height });
        }
        let [red, green, blue] = colour.map(byte);
        Ok(Self {
            width,
            height,
            pixels: [red, green, blue, 255].repeat(count),
        })
    }

    /// Red, green, blue and opacity of a pixel; nothing outside.
    pub fn pixel(&self, x: usize, y: usize) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y * self.width + x);
        self.pixels[at..at + 4].try_into().ok()
    }

    /// Lays a colour over a pixel; outside nothing happens.
    pub fn blend(&mut self, x: i64, y: i64, colour: Rgb, opacity: f64) {
        if x < 0 || y < 0 || x >= self.width as i64 || y >= self.height as i64 {
            return;
        }
        let at = 4 * (y as usize * self.width + x as usize);
        for (part, pixel) in colour.iter().zip(&mut self.pixels[at..at + 3]) {
            let old = f64::from(*pixel) / 255.0;
            *pixel = byte(old + (part - old) * opacity.clamp(0.0, 1.0));
        }
        self.pixels[at + 3] = self.pixels[at + 3].max(byte(opacity));
    }

    /// Copies an image to a place; what hangs over is cut off.
    pub fn place(&mut self, image: &Image, left: usize, top: usize) {
        let columns = image.width.min(self.width.saturating_sub(left));
        for row in 0..image.height.min(self.height.saturating_sub(top)) {
            let from = 4 * row * image.width;
            let to = 4 * ((top + row) * self.width + left);
            self.pixels[to..to + 4 * columns]
                .copy_from_slice(&image.pixels[from..from + 4 * columns]);
        }
    }

    /// Several images below one another, left edges aligned, on a colour.
    ///
    /// # Errors
    /// No images, or too large a result.
    pub fn stacked(images: &[Image], colour: Rgb) -> Result<Self, PictureError> {
        let width = images.iter().map(|i| i.width).max().unwrap_or(0);
        let height = images.iter().map(|i| i.height).sum();
        let mut whole = Self::new(width, height, colour)?;
        let mut top = 0;
        for image in images {
            whole.place(image, 0, top);
            top += image.height;
        }
        Ok(whole)
    }

    /// Fills a rectangle given by two corners in pixels, with soft edges.
    pub fn fill_rectangle(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb) {
        let cover = |low: f64, high: f64, cell: i64| {
            (high.min(cell as f64 + 1.0) - low.max(cell as f64)).clamp(0.0, 1.0)
        };
        let last = |high: f64, size: usize| (high.ceil() as i64).min(size as i64);
        for y in from[1].floor().max(0.0) as i64..last(to[1], self.height) {
            for x in from[0].floor().max(0.0) as i64..last(to[0], self.width) {
                let opacity = cover(from[0], to[0], x) * cover(from[1], to[1], y);
                self.blend(x, y, colour, opacity);
            }
        }
    }

    /// The image as a PNG file.
    ///
    /// # Errors
    /// The pixels do not fit the size.
    pub fn to_png(&self) -> Result<Vec<u8>, PictureError> {
        let size = |n: usize| u32::try_from(n).ok();
        let (Some(width), Some(height)) = (size(self.width), size(self.height)) else {
            return Err(PictureError::Size {
                width: self.width,
                height: self.height,
            });
        };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn png_comes_back() {
        let mut image = Image::new(5, 3, [1.0, 0.5, 0.0]).unwrap();
        image.blend(4, 2, [0.0; 3], 1.0);
        let bytes = image.to_png().unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
            .read_info()
            .unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (5, 3));
        assert_eq!(pixels, image.pixels);
        assert_eq!(image.pixel(4, 2), Some([0, 0, 0, 255]));
        assert_eq!(image.pixel(0, 0), Some([255, 128, 0, 255]));
        assert_eq!(image.pixel(5, 0), None);
    }

    #[test]
    fn sizes_that_make_no_image_are_refused() {
        for (width, height) in [(0, 5), (5, 0), (usize::MAX, 2), (1 << 20, 1 << 20)] {
            assert!(Image::new(width, height, [0.0; 3]).is_err());
        }
        assert!(Image::stacked(&[], [0.0; 3]).is_err());
    }

    #[test]
    fn rectangles_cover_their_area() {
        let mut image = Image::new(20, 20, [0.0; 3]).unwrap();
        image.fill_rectangle([2.5, 3.25], [10.0, 9.0], [1.0; 3]);
        let sum: f64 = image
            .pixels
            .chunks(4)
            .map(|p| f64::from(p[0]) / 255.0)
            .sum();
        assert!((sum - 7.5 * 5.75).abs() < 0.1, "{sum}");
        image.fill_rectangle([-5.0, -5.0], [50.0, 50.0], [1.0; 3]);
        assert!(image.pixels.iter().all(|&b| b == 255));
    }

    #[test]
    fn placing_cuts_what_hangs_over() {
        let mut image = Image::new(4, 4, [0.0; 3]).unwrap();
        let patch = Image::new(3, 3, [1.0; 3]).unwrap();
        image.place(&patch, 2, 3);
        image.place(&patch, 9, 9);
        let white = image.pixels.chunks(4).filter(|p| p[0] == 255).count();
        assert_eq!(white, 2);
        let stack = Image::stacked(&[image, patch], [0.5; 3]).unwrap();
        assert_eq!((stack.width, stack.height), (4, 7));
        assert_eq!(stack.pixel(3, 6), Some([128, 128, 128, 255]));
    }
}
