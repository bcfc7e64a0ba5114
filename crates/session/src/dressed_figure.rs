//! Figures of scenes that wear garments: all that one wears is sewn together and draped to rest on it, before
//! the scene begins.

use crate::choice::figure_named;
use crate::drape::Drape;
use crate::scene_place::ScenePlace;
use crate::{Command, Event, OtherGarment, Quality, Session, SessionError, Watcher};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_body::Mannequin;
use toile_drape::{Cloth, merge_map};
use toile_interchange::{ObjectFile, SceneFile};

/// A body of a scene as it stands when it is dressed, and the garments that it wears.
pub(crate) struct DressedFigure {
    pub body: Arc<Mannequin>,
    /// The garments by the index of their object.
    pub garments: Vec<(usize, HungGarment)>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// A sewn garment in the position in which it hangs.
pub(crate) struct HungGarment {
    pub cloth: Cloth,
    /// For each triangle, whether its strain counts in reports; it does not near gathers.
    pub counted: Vec<bool>,
}

/// A garment that a scene file lists, with the index of its object.
struct Worn<'a> {
    index: usize,
    pattern: &'a str,
    layer: u16,
    quality: Quality,
}

/// The garments that a body of a scene wears, innermost first. A garment without a layer is given the number
/// of garments listed before it as its layer.
fn worn_by<'a>(
    place: ScenePlace<'_>,
    file: &'a SceneFile,
    name: &str,
) -> Result<Vec<Worn<'a>>, SessionError> {
    let mut worn: Vec<Worn<'a>> = Vec::new();
    for (index, object) in file.objects.iter().enumerate() {
        let (Some(on), Some(pattern)) = (&object.on, &object.pattern) else {
            continue;
        };
        if on != name {
            continue;
        }
        let quality = match object.quality.as_deref() {
            None => Quality::Preview,
            Some(text) => Quality::named(text).ok_or_else(|| {
                let what = format!("there is no quality \"{text}\"");
                place.wrong(
                    format!("objects[{index}].quality"),
                    what,
                    "write preview, fit or final",
                )
            })?,
        };
        if let Some(other) = worn.iter().find(|other| other.quality != quality) {
            let what = format!(
                "\"{}\" is made in another quality than \"{}\", and they are sewn together",
                object.name, file.objects[other.index].name
            );
            let remedy = "give all that one body wears the same quality";
            return Err(place.wrong(format!("objects[{index}].quality"), what, remedy));
        }
        worn.push(Worn {
            index,
            pattern,
            layer: object.layer.unwrap_or(worn.len() as u16),
            quality,
        });
    }
    worn.sort_by_key(|garment| garment.layer);
    Ok(worn)
}

impl DressedFigure {
    /// Sews and drapes all garments that a body of a scene wears; `None` if it wears no garment.
    ///
    /// # Errors
    /// Patterns that cannot be read or sewn, garments of several qualities.
    pub fn of(
        place: ScenePlace<'_>,
        file: &SceneFile,
        figure: &ObjectFile,
        watcher: &mut dyn Watcher,
    ) -> Result<Option<Self>, SessionError> {
        let (worn, Some(body)) = (worn_by(place, file, &figure.name)?, &figure.body) else {
            return Ok(None);
        };
        let Some((first, others)) = worn.split_first() else {
            return Ok(None);
        };
        let mut session = Session::new();
        let of_base = |name: &str| place.beside(name);
        let named = figure_named(body);
        let mut notes = Vec::new();
        for command in [
            Command::open(of_base(first.pattern)),
            Command::SetBody {
                figure: named,
                measurements: named.is_none().then(|| of_base(body)),
            },
            Command::SetLayers {
                layer: first.layer,
                others: others
                    .iter()
                    .map(|garment| OtherGarment {
                        path: of_base(garment.pattern),
                        layer: garment.layer,
                    })
                    .collect(),
            },
            Command::SetQuality {
                quality: first.quality,
            },
            Command::drape(),
        ] {
            for event in session.execute(command, watcher)? {
                if let Event::Warned { message } = event {
                    notes.push(format!("{}: {message}", figure.name));
                }
            }
        }
        let body = session.mannequin()?;
        let Some(drape) = session.present_drape() else {
            return Ok(None);
        };
        let parts = drape.job.parts.iter().enumerate();
        let garments = parts.map(|(k, _)| (worn[k].index, part_of(&drape, k)));
        Ok(Some(Self {
            body,
            garments: garments.collect(),
            notes,
        }))
    }
}

/// One of the garments of a drape, sewn, in the position in which it hangs.
fn part_of(drape: &Drape, part: usize) -> HungGarment {
    let part = &drape.job.parts[part];
    let (first, range) = (part.vertices.start as u32, part.triangles.clone());
    let whole = drape.job.setup.levels.last();
    let whole = whole.map(|level| level.cloth.clone()).unwrap_or_default();
    let places = part.vertices.clone();
    let cloth = Cloth {
        positions: places
            .clone()
            .map(|v| drape.mesh.positions[drape.target[v] as usize])
            .collect(),
        triangles: whole.triangles[range.clone()]
            .iter()
            .map(|t| t.map(|v| v - first))
            .collect(),
        rest: whole.rest[range.clone()].to_vec(),
        material: whole.material[range.clone()].to_vec(),
        panel: whole.panel[range].to_vec(),
        materials: whole.materials,
    };
    // Vertices that the drape merged are merged again, numbered within the garment.
    let mut first_of = BTreeMap::new();
    let pairs = places.enumerate().map(|(own, v)| {
        let known = *first_of.entry(drape.target[v]).or_insert(own as u32);
        [known, own as u32]
    });
    let (target, count) = merge_map(cloth.positions.len(), pairs);
    let counted = &drape.job.setup.counted[part.triangles.clone()];
    let kept = cloth.merged_triangles(&target);
    HungGarment {
        cloth: cloth.merged(&target, count),
        counted: kept.into_iter().map(|t| counted[t]).collect(),
    }
}
