//! CPU rasteriser, colour maps, legends, PNG.
