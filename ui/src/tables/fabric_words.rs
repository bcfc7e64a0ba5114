//! Sources of the figures of a fabric; colours as text.

use crate::theme::bytes;
use toile_fabric::LibraryFabric;
use toile_pattern::Fabric;
use toile_pattern::plan::FabricFigure;
use toile_session::{library_fabric, library_origin, with_hardening};

/// Source of a figure of a library fabric, in words.
pub fn library_source(figure: FabricFigure, library: &LibraryFabric) -> &'static str {
    match figure {
        FabricFigure::Width => "a usual width, without a source",
        FabricFigure::Material(component) => match component.figure.source {
            Some(source) => source(&library.sources),
            None => "usual for its kind, without a source",
        },
    }
}

/// Source of a figure of the pattern's own fabric: the library, while the figure is unchanged; else the
/// pattern.
pub fn own_source(figure: FabricFigure, fabric: &Fabric) -> String {
    let given = "given in the pattern".to_owned();
    let Some(library) = library_origin(fabric) else {
        return given;
    };
    let Some(copied) = library_fabric(library.name) else {
        return given;
    };
    match figure.of(&with_hardening(fabric)) == figure.of(&copied) {
        true => format!(
            "{} of the library: {}",
            library.name,
            library_source(figure, library)
        ),
        false => given,
    }
}

/// A colour as text, in the form in which it is typed: `#8099cc`.
pub fn colour_text(colour: [f64; 3]) -> String {
    let [red, green, blue] = bytes(colour);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Red, green and blue of a colour (0..=1), from steps of 1/255.
pub fn shares(bytes: [u8; 3]) -> [f64; 3] {
    bytes.map(|byte| f64::from(byte) / 255.0)
}

/// Reads a typed colour.
///
/// # Errors
/// A description of the form in which colours are written.
pub fn read_colour(text: &str) -> Result<[f64; 3], String> {
    let digits = text.trim().trim_start_matches('#');
    let read = |k: usize| u8::from_str_radix(digits.get(2 * k..2 * k + 2)?, 16).ok();
    let read = (digits.len() == 6 && !digits.starts_with('+'))
        .then(|| Some([read(0)?, read(1)?, read(2)?]));
    let read = read.flatten().map(shares);
    read.ok_or_else(|| "write red, green and blue as in #8099cc".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_fabric::{Component, Figure, LIBRARY};

    #[test]
    fn a_copy_of_the_library_keeps_its_sources_until_a_figure_is_changed() {
        for library in &LIBRARY {
            let mut fabric = library_fabric(library.name).unwrap();
            fabric.name = "mine".into();
            for figure in FabricFigure::all() {
                let source = own_source(figure, &fabric);
                assert!(source.contains(library_source(figure, library)), "{source}");
            }
            let figure = |name| {
                FabricFigure::Material(Component {
                    figure: Figure::named(name).unwrap(),
                    index: 0,
                })
            };
            fabric.material.density += 0.001;
            let source = own_source(figure("density"), &fabric);
            assert_eq!(source, "given in the pattern");
            assert!(own_source(figure("thickness"), &fabric).contains(library.name));
        }
    }

    #[test]
    fn colours_are_read_as_they_are_written() {
        assert_eq!(colour_text(read_colour("#8099Cc").unwrap()), "#8099cc");
        for text in [
            "",
            "blue",
            "#12345",
            "#1234567",
            "\u{e9}\u{e9}\u{e9}",
            "+1+1+1",
        ] {
            assert!(read_colour(text).is_err(), "{text}");
        }
    }
}
