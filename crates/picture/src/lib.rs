//! CPU rasteriser, colour maps, legends, PNG. Needs neither a display nor a GPU, and does not
//! know what its pictures are of.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod backdrop;
mod camera;
mod chart;
mod colour;
mod colour_map;
mod depth_map;
mod drawing;
mod error;
mod floor;
mod font;
mod image;
mod ink;
mod legend;
mod occlusion;
mod outline;
mod prepare;
mod raster;
mod scene;
mod shade;
mod sheet;
mod text;

pub use backdrop::Backdrop;
pub use camera::{Camera, Projection, View};
pub use chart::{Axis, Chart, Joined, Marker, Series, palette};
pub use colour::Rgb;
pub use colour_map::{ColourMap, ColourScale};
pub use drawing::Drawing;
pub use error::PictureError;
pub use image::Image;
pub use legend::Legend;
pub use outline::{Outline, outline_picture};
pub use scene::{Edges, Finish, Lines, Paint, Scene, Surface};
pub use sheet::{Sheet, drape_picture, fit_picture, render};
pub use text::{Align, TextStyle, text_width};
