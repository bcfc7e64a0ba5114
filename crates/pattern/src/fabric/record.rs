//! A fabric as journals write it: the figures that every fabric has beside its name, five that came later under
//! `rheology`, those that came last only where they are not the default.

use super::Fabric;
use crate::FabricId;
use serde::de::{DeserializeSeed, Error, IgnoredAny, MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use toile_fabric::{FIGURES, Figure, FigureValue, Material};

/// Figures that journals always write, under the key `rheology`.
const RHEOLOGY: [&str; 5] = [
    "hardening",
    "viscosity",
    "bend_viscosity",
    "kept",
    "relaxation_time",
];

fn is_of_rheology(figure: &Figure) -> bool {
    RHEOLOGY.contains(&figure.name)
}

impl Serialize for Fabric {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self {
            id,
            name,
            material,
            width,
            nap,
            colour,
        } = self;
        let mut map = to.serialize_map(None)?;
        map.serialize_entry("id", id)?;
        map.serialize_entry("name", name)?;
        for figure in FIGURES.iter().filter(|figure| figure.is_always_written) {
            map.serialize_entry(figure.name, &figure.value(material))?;
        }
        map.serialize_entry("width", width)?;
        map.serialize_entry("nap", nap)?;
        map.serialize_entry("colour", colour)?;
        map.serialize_entry("rheology", &Rheology(material))?;
        for figure in &FIGURES {
            let is_written = figure.is_always_written || is_of_rheology(figure);
            if !is_written && !figure.is_default(material) {
                map.serialize_entry(figure.name, &figure.value(material))?;
            }
        }
        map.end()
    }
}

/// The figures of a material that journals write under `rheology`.
struct Rheology<'a>(&'a Material);

impl Serialize for Rheology<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let figures = FIGURES.iter().filter(|figure| is_of_rheology(figure));
        to.collect_map(figures.map(|figure| (figure.name, figure.value(self.0))))
    }
}

/// Reads the object under `rheology`, and sets its figures in a material.
struct RheologyReader<'a>(&'a mut Material);

impl<'de> DeserializeSeed<'de> for RheologyReader<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<(), D::Error> {
        from.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for RheologyReader<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object of figures")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(name) = map.next_key::<String>()? {
            let figure = Figure::named(&name).filter(|figure| is_of_rheology(figure));
            let figure = figure.ok_or_else(|| A::Error::unknown_field(&name, &RHEOLOGY))?;
            read_figure(figure, &mut map, self.0)?;
        }
        Ok(())
    }
}

fn read_figure<'de, A: MapAccess<'de>>(
    figure: &Figure,
    map: &mut A,
    material: &mut Material,
) -> Result<(), A::Error> {
    let value = map.next_value_seed(figure.shape())?;
    let value = value.unwrap_or(FigureValue::Absent);
    let unknown =
        |word: String| A::Error::custom(format!("{}: {word:?} is not known", figure.name));
    figure.give(material, &value).map_err(unknown)
}

impl<'de> Deserialize<'de> for Fabric {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(FabricReader)
    }
}

/// Reads a fabric from an object.
struct FabricReader;

impl<'de> Visitor<'de> for FabricReader {
    type Value = Fabric;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a fabric")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Fabric, A::Error> {
        let mut fabric = Fabric::default();
        let mut read: Vec<String> = Vec::new();
        while let Some(name) = map.next_key::<String>()? {
            match &*name {
                "id" => fabric.id = map.next_value::<FabricId>()?,
                "name" => fabric.name = map.next_value()?,
                "width" => fabric.width = map.next_value()?,
                "nap" => fabric.nap = map.next_value()?,
                "colour" => fabric.colour = map.next_value()?,
                "rheology" => map.next_value_seed(RheologyReader(&mut fabric.material))?,
                _ => match Figure::named(&name) {
                    Some(figure) => read_figure(figure, &mut map, &mut fabric.material)?,
                    None => drop(map.next_value::<IgnoredAny>()?),
                },
            }
            read.push(name);
        }
        let always = FIGURES.iter().filter(|figure| figure.is_always_written);
        let always = always.map(|figure| figure.name);
        let missing = ["id", "name", "width", "nap", "colour"]
            .into_iter()
            .chain(always)
            .find(|name| !read.iter().any(|known| known == name));
        match missing {
            Some(name) => Err(A::Error::missing_field(name)),
            None => Ok(fabric),
        }
    }
}
