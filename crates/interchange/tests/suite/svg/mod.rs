//! Patterns in SVG: drawings of other programs, files of this one and back, damaged files.

mod back;
mod damaged;
mod drawings;
mod freesewing;
mod freesewing_parts;

use toile_interchange::{FormatError, ReadOptions, Reading};
use toile_measure::Measurements;
use toile_pattern::{Draft, Evaluation, Pattern, Wearer};

fn read(text: &str) -> Result<Reading, FormatError> {
    read_with(text, &ReadOptions::default())
}

fn read_with(text: &str, options: &ReadOptions) -> Result<Reading, FormatError> {
    toile_interchange::read(text.as_bytes(), options, &[])
}

fn drafted(pattern: &Pattern, size: Option<&str>) -> Draft {
    let known = size.map(|name| pattern.size_named(name).unwrap());
    let wearer = Wearer {
        measurements: known.map_or_else(Measurements::adult, |size| size.measurements.clone()),
        size: known.map(|size| size.id),
    };
    Evaluation::new(pattern, wearer).draft().0
}
