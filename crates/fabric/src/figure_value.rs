//! The value of a figure as JSON has it: read by the shape that the figure has, given to a material.

use crate::domain::Domain;
use crate::material::{Access, Compression, Figure, Material};
use serde::de::DeserializeSeed;
use serde::{Deserialize, Deserializer, Serialize};

/// The value of a figure as it is written: infinity as `null`, compression as a word.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum FigureValue {
    /// A single number.
    Number(f64),
    /// Two numbers.
    Pair([f64; 2]),
    /// Two limits, `null` for none.
    Limits([Option<f64>; 2]),
    /// Three numbers.
    Triple([f64; 3]),
    /// A word.
    Word(String),
    /// Absent.
    Absent,
}

/// Form in which a figure is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// As a single number.
    Number,
    /// As two numbers.
    Pair,
    /// As two numbers, each of which may be `null`.
    Limits,
    /// As three numbers.
    Triple,
    /// As a word.
    Word,
}

/// Reads a value of the shape; nothing where it is `null`.
impl<'de> DeserializeSeed<'de> for Shape {
    type Value = Option<FigureValue>;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<Self::Value, D::Error> {
        Ok(match self {
            Self::Number => Option::deserialize(from)?.map(FigureValue::Number),
            Self::Pair => Option::deserialize(from)?.map(FigureValue::Pair),
            Self::Limits => Option::deserialize(from)?.map(FigureValue::Limits),
            Self::Triple => Option::deserialize(from)?.map(FigureValue::Triple),
            Self::Word => Option::deserialize(from)?.map(FigureValue::Word),
        })
    }
}

impl Figure {
    /// Form in which the figure is written.
    pub fn shape(&self) -> Shape {
        match (self.access, self.components.len()) {
            (Access::Compression { .. }, _) => Shape::Word,
            (Access::Numbers { .. } | Access::Optional { .. }, 0 | 1) => Shape::Number,
            (Access::Numbers { .. } | Access::Optional { .. }, 2) => match self.domain {
                Domain::Limit => Shape::Limits,
                Domain::Positive | Domain::NotNegative | Domain::Ratio | Domain::Share => {
                    Shape::Pair
                }
            },
            (Access::Numbers { .. } | Access::Optional { .. }, _) => Shape::Triple,
        }
    }

    /// Value of the figure in a material.
    pub fn value(&self, material: &Material) -> FigureValue {
        if let Access::Compression { get, .. } = self.access {
            return FigureValue::Word(get(material).word().to_owned());
        }
        match (self.shape(), &*self.numbers(material)) {
            (Shape::Limits, &[warp, weft]) => {
                let finite = |limit: f64| limit.is_finite().then_some(limit);
                FigureValue::Limits([finite(warp), finite(weft)])
            }
            (_, &[number]) => FigureValue::Number(number),
            (_, &[warp, weft]) => FigureValue::Pair([warp, weft]),
            (_, &[warp, weft, bias]) => FigureValue::Triple([warp, weft, bias]),
            (_, _) => FigureValue::Absent,
        }
    }

    /// Gives a material the value, which has the shape of the figure.
    ///
    /// # Errors
    /// A word that is not known: the word.
    pub fn give(&self, material: &mut Material, value: &FigureValue) -> Result<(), String> {
        match (self.access, value) {
            (Access::Numbers { get_mut, .. }, value) => {
                let own = get_mut(material);
                match value {
                    FigureValue::Number(number) => own.fill(*number),
                    FigureValue::Pair(numbers) => own.copy_from_slice(numbers),
                    FigureValue::Triple(numbers) => own.copy_from_slice(numbers),
                    FigureValue::Limits(limits) => {
                        own.copy_from_slice(&limits.map(|limit| limit.unwrap_or(f64::INFINITY)));
                    }
                    FigureValue::Word(_) | FigureValue::Absent => {}
                }
            }
            (Access::Optional { get_mut, .. }, value) => {
                *get_mut(material) = match value {
                    FigureValue::Number(number) => Some(*number),
                    FigureValue::Pair(_)
                    | FigureValue::Limits(_)
                    | FigureValue::Triple(_)
                    | FigureValue::Word(_)
                    | FigureValue::Absent => None,
                };
            }
            (Access::Compression { get_mut, .. }, FigureValue::Word(word)) => {
                *get_mut(material) = Compression::named(word).ok_or_else(|| word.clone())?;
            }
            (Access::Compression { .. }, _) => {}
        }
        Ok(())
    }
}

impl Material {
    /// The material with other values of the figures given. Stretch given anew without hardening has none: the curve of the
    /// cloth it stands for is no longer its own.
    ///
    /// # Errors
    /// A word that is not known: its figure and the word.
    pub fn with(
        mut self,
        given: &[(&'static Figure, FigureValue)],
    ) -> Result<Self, (&'static Figure, String)> {
        if given.iter().any(|(figure, _)| figure.name == "stretch") {
            self.hardening = [0.0; 2];
        }
        for (figure, value) in given {
            let known = figure.give(&mut self, value);
            known.map_err(|word| (*figure, word))?;
        }
        Ok(self)
    }
}

impl Compression {
    /// The kind of a word.
    pub fn named(word: &str) -> Option<Self> {
        let place = <Self as strum::VariantNames>::VARIANTS
            .iter()
            .position(|known| *known == word)?;
        Some(<Self as strum::VariantArray>::VARIANTS[place])
    }

    /// The word in files.
    pub fn word(self) -> &'static str {
        let place = <Self as strum::VariantArray>::VARIANTS
            .iter()
            .position(|known| *known == self);
        place.map_or("", |k| <Self as strum::VariantNames>::VARIANTS[k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Component;
    use crate::material::FIGURES;

    /// A material with another value of every figure.
    fn strange() -> Material {
        let mut material = Material {
            compression: Compression::TensionField,
            restitution: Some(0.25),
            strain_limit: [0.05, f64::INFINITY],
            ..Material::default()
        };
        for (k, component) in Component::all().enumerate() {
            let own = component.of(&material).unwrap_or(0.4);
            if component.figure.domain != Domain::Limit {
                component.set(&mut material, Some(own * 0.5 + 0.01 * (k as f64 + 1.0)));
            }
        }
        material
    }

    #[test]
    fn every_figure_is_written_and_read_to_the_bit() {
        let mut read = Material::default();
        for figure in &FIGURES {
            assert!(!figure.is_default(&strange()), "{}", figure.name);
            let text = serde_json::to_string(&figure.value(&strange())).unwrap();
            let mut json = serde_json::Deserializer::from_str(&text);
            let value = figure.shape().deserialize(&mut json).unwrap().unwrap();
            figure.give(&mut read, &value).unwrap();
        }
        assert_eq!(read, strange());
        assert_eq!(read.strain_limit, [0.05, f64::INFINITY]);
    }

    #[test]
    fn a_value_of_another_shape_is_refused() {
        for (name, text) in [
            ("density", "[1]"),
            ("stretch", "3"),
            ("bend", "[1, 2]"),
            ("strain_limit", "[1]"),
            ("compression", "4"),
        ] {
            let shape = Figure::named(name).unwrap().shape();
            let mut json = serde_json::Deserializer::from_str(text);
            assert!(shape.deserialize(&mut json).is_err(), "{name}");
        }
        let compression = Figure::named("compression").unwrap();
        let word = FigureValue::Word("half".into());
        let given = compression.give(&mut Material::default(), &word);
        assert_eq!(given, Err("half".into()));
    }
}
