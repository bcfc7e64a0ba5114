//! Materials of cloth, as scenes and fabric files write them: figures by the names of [`FIGURES`].

use crate::FormatError;
use crate::scene_motion::Unknown;
use serde::de::{Error, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use strum::VariantNames;
use toile_fabric::{Compression, FIGURES, Figure, FigureValue, LIBRARY, LibraryFabric, Material};

/// A cloth in a scene. Values that the file leaves out are those of the fabric `fabric`, or else of
/// [`Material::default`].
#[derive(Clone, Debug, Default)]
pub struct MaterialFile {
    /// Name of a fabric of the library.
    pub fabric: Option<String>,
    /// The values given in the file.
    pub figures: Vec<(&'static Figure, FigureValue)>,
    pub(crate) unknown: Unknown,
}

impl Serialize for MaterialFile {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(None)?;
        if let Some(fabric) = &self.fabric {
            map.serialize_entry("fabric", fabric)?;
        }
        for figure in &FIGURES {
            match self.given(figure) {
                Some(value) => map.serialize_entry(figure.name, value)?,
                None if figure.is_always_written => map.serialize_entry(figure.name, &())?,
                None => {}
            }
        }
        for (name, value) in &self.unknown {
            map.serialize_entry(name, value)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for MaterialFile {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(MaterialReader)
    }
}

/// Reads a [`MaterialFile`] from a JSON object.
struct MaterialReader;

impl<'de> Visitor<'de> for MaterialReader {
    type Value = MaterialFile;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("struct MaterialFile")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<MaterialFile, A::Error> {
        let mut file = MaterialFile::default();
        while let Some(name) = map.next_key::<String>()? {
            if name == "fabric" {
                if file.fabric.is_some() {
                    return Err(A::Error::duplicate_field("fabric"));
                }
                file.fabric = map.next_value()?;
            } else if let Some(figure) = Figure::named(&name) {
                if file.given(figure).is_some() {
                    return Err(A::Error::duplicate_field(figure.name));
                }
                let given = map.next_value_seed(figure.shape())?;
                file.figures.extend(given.map(|value| (figure, value)));
            } else {
                file.unknown.insert(name, map.next_value()?);
            }
        }
        Ok(file)
    }
}

impl MaterialFile {
    fn given(&self, figure: &Figure) -> Option<&FigureValue> {
        let mut given = self.figures.iter();
        let found = given.find(|(known, _)| known.name == figure.name)?;
        Some(&found.1)
    }

    /// The material: the values given in the file; all others from the named fabric, or else the defaults.
    ///
    /// # Errors
    /// An unknown fabric or kind of compression; `place` is the place of the material in the file.
    pub fn material(&self, place: &str) -> Result<Material, FormatError> {
        let usual = match &self.fabric {
            None => Material::default(),
            Some(name) => LibraryFabric::named(name)
                .map(LibraryFabric::material)
                .ok_or_else(|| {
                    let known: Vec<_> = LIBRARY.iter().map(|fabric| fabric.name).collect();
                    FormatError::new(
                        format!("{place}.fabric"),
                        format!("\"{name}\" is neither a fabric of the library nor a file"),
                        format!("write one of {}, or name a fabric file", known.join(", ")),
                    )
                })?,
        };
        self.over(usual, place)
    }

    /// Takes the unknown fields out of the material and returns their names.
    pub(crate) fn take_unknown(&mut self) -> Vec<String> {
        std::mem::take(&mut self.unknown).into_keys().collect()
    }

    /// The material: the values given in the file; all others from `usual`, whatever fabric the file names.
    ///
    /// # Errors
    /// An unknown kind of compression; `place` is the place of the material in the file.
    pub fn over(&self, usual: Material, place: &str) -> Result<Material, FormatError> {
        usual.with(&self.figures).map_err(|(figure, word)| {
            let known: Vec<String> = Compression::VARIANTS
                .iter()
                .map(|known| format!("\"{known}\""))
                .collect();
            FormatError::new(
                format!("{place}.{}", figure.name),
                format!("\"{word}\" is not known"),
                format!("write {}", known.join(" or ")),
            )
        })
    }
}
