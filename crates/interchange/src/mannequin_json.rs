//! The mannequin as a file of a few kilobytes: its measurements and its template's primitives.

use crate::FormatError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toile_body::{
    Blend, BodyFrame, Deformation, Description, Features, Figure, Joint, Joints, Part, Particular,
    Primitive, Rigging,
};
use toile_measure::{Measurements, Origin, is_angle};

const KIND: &str = "mannequin";
const VERSION: u32 = 1;

/// The nine or ten numbers of a primitive: centre (0.1 mm), effective semi-axes (0.1 mm), rotation vector
/// (mrad), and its weight (0.001) unless that is 1.
type Row = Vec<i32>;

/// The native file. Measured lengths in centimetres, angles in degrees.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MannequinFile {
    toile: u32,
    kind: String,
    figure: Figure,
    measurements: BTreeMap<String, f64>,
    /// Primitives of the trunk before any measurement is applied. If this list and the next three are empty,
    /// the figure's own primitives are used.
    #[serde(default)]
    trunk: Vec<Row>,
    /// Primitives of the head, before any measurement is applied.
    #[serde(default)]
    head: Vec<Row>,
    /// Primitives of the left arm, before any measurement is applied.
    #[serde(default)]
    arm: Vec<Row>,
    /// Primitives of the left leg, before any measurement is applied.
    #[serde(default)]
    leg: Vec<Row>,
    /// Heights and joint positions (m) of a body that was fitted to a mesh; `None` for any other body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    frame: Option<BodyFrame>,
    /// Properties of single primitives that differ from the default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    particular: Vec<ParticularRow>,
    /// Groups of primitives that are moved together, given by the numbers of the primitives.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    joined: Vec<Vec<usize>>,
}

/// Properties of one primitive that differ from the default; see [`Primitive`] and [`Particular`].
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ParticularRow {
    /// Number of the primitive: primitives are counted from 0 over trunk, head, arm and leg.
    primitive: usize,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    unblendable: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    also: Option<Part>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    joint: Option<Joint>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    deformation: Option<Deformation>,
}

/// Body parts in the order of the file.
const PARTS: [Part; 4] = [Part::Trunk, Part::Head, Part::LeftArm, Part::LeftLeg];

/// Properties that differ from the default, and groups of joined primitives; both name primitives by their
/// number in the file.
fn particular(description: &Description) -> (Vec<ParticularRow>, Vec<Vec<usize>>) {
    let all = &description.primitives;
    // Index in the description of each primitive of the file.
    let order: Vec<usize> = PARTS
        .iter()
        .flat_map(|part| (0..all.len()).filter(|&k| all[k].part == *part))
        .collect();
    let rows = order.iter().enumerate().filter_map(|(primitive, &k)| {
        let own = description.rigging.of(k);
        let row = ParticularRow {
            primitive,
            unblendable: all[k].blend == Blend::Unblendable,
            also: all[k].also,
            joint: own.and_then(|p| p.joint),
            deformation: own.and_then(|p| p.deformation.clone()),
        };
        (own.is_some() || row.unblendable || row.also.is_some()).then_some(row)
    });
    let place = |k: &usize| order.iter().position(|other| other == k).unwrap_or(*k);
    let mut joined: Vec<Vec<usize>> = description
        .rigging
        .joined
        .iter()
        .map(|set| {
            let mut set: Vec<usize> = set.iter().map(place).collect();
            set.sort_unstable();
            set
        })
        .collect();
    joined.sort();
    (rows.collect(), joined)
}

/// Applies the properties of `rows` to the primitives that they name; returns those that belong to the rigging,
/// with the groups `joined`.
fn rigged(
    primitives: &mut [Primitive],
    rows: Vec<ParticularRow>,
    joined: Vec<Vec<usize>>,
) -> Result<Rigging, FormatError> {
    let mut particulars = Vec::new();
    for row in rows {
        let Some(own) = primitives.get_mut(row.primitive) else {
            let what = format!("there is no primitive {}", row.primitive);
            let remedy = "count from 0 over trunk, head, arm and leg";
            return Err(FormatError::new("particular", what, remedy));
        };
        if row.unblendable {
            own.blend = Blend::Unblendable;
        }
        own.also = row.also;
        if row.joint.is_some() || row.deformation.is_some() {
            particulars.push(Particular {
                primitive: row.primitive,
                joint: row.joint,
                deformation: row.deformation,
            });
        }
    }
    Ok(Rigging {
        particulars,
        joined,
    })
}

/// Precision of stored lengths (m), as in the templates.
const LENGTH: f64 = 1e-4;
/// Precision of stored rotations (rad), as in the templates.
const TURN: f64 = 1e-3;
/// Precision of stored weights (1).
const WEIGHT: f64 = 1e-3;

/// A frame with all lengths rounded to the precision [`LENGTH`], as they are stored.
fn rounded(frame: &BodyFrame) -> BodyFrame {
    let length = |x: f64| (x / LENGTH).round() / (1.0 / LENGTH).round();
    let place = |p: [f64; 3]| p.map(length);
    let j = &frame.joints;
    BodyFrame {
        height: length(frame.height),
        crotch: length(frame.crotch),
        armpit: length(frame.armpit),
        hand: length(frame.hand),
        neck_radius: length(frame.neck_radius),
        joints: Joints {
            shoulder: place(j.shoulder),
            elbow: place(j.elbow),
            wrist: place(j.wrist),
            hip: place(j.hip),
            knee: place(j.knee),
            ankle: place(j.ankle),
            toe: place(j.toe),
            pelvis: place(j.pelvis),
            chest: place(j.chest),
            neck: place(j.neck),
            head: place(j.head),
        },
        features: frame.features.map(|f| Features {
            thumb: f.thumb.map(place),
        }),
    }
}

/// Writes everything that a mannequin is made from: the same file gives the same body. Right limbs are mirror
/// images of the left ones, so primitives of right limbs are not written.
///
/// # Errors
/// The description has a value that JSON cannot represent.
pub fn write_mannequin(description: &Description) -> Result<String, FormatError> {
    let rows = |part: Part| -> Vec<Row> {
        let own = description.primitives.iter().filter(|p| p.part == part);
        own.map(|p| {
            let length = |x: f64| (x / LENGTH).round() as i32;
            let turn = |x: f64| (x / TURN).round() as i32;
            let ([x, y, z], [a, b, c], [u, v, w]) = (
                p.centre.map(length),
                p.radii.map(length),
                p.rotation.map(turn),
            );
            let mut row = vec![x, y, z, a, b, c, u, v, w];
            let weight = (p.weight / WEIGHT).round() as i32;
            row.extend((weight != 1000).then_some(weight));
            row
        })
        .collect()
    };
    let asked = description.measurements.iter();
    let (particular, joined) = particular(description);
    let file = MannequinFile {
        toile: VERSION,
        kind: KIND.into(),
        figure: description.figure,
        measurements: asked
            .filter(|(_, m)| m.origin == Origin::Asked)
            .map(|(name, m)| {
                let shown = match is_angle(name) {
                    true => m.value.to_degrees(),
                    false => m.value * 100.0,
                };
                (name.to_owned(), (shown * 1e6).round() / 1e6)
            })
            .collect(),
        trunk: rows(Part::Trunk),
        head: rows(Part::Head),
        arm: rows(Part::LeftArm),
        leg: rows(Part::LeftLeg),
        frame: description.frame.as_ref().map(rounded),
        particular,
        joined,
    };
    let text = serde_json::to_string(&file)
        .map_err(|error| FormatError::new("mannequin", error.to_string(), "check the values"))?;
    // One primitive per line.
    Ok(text.replace("],[", "],\n[").replace("]],\"", "]],\n\"") + "\n")
}

/// Reads a file of [`write_mannequin`].
///
/// # Errors
/// The text is not a mannequin file, or has a value that makes no sense: the fault, its place and a remedy.
pub fn read_mannequin(text: &str) -> Result<Description, FormatError> {
    let hint = "write {\"toile\": 1, \"kind\": \"mannequin\", \"figure\": \"woman\", \"measurements\": {\"height\": 170}}";
    let file: MannequinFile = serde_json::from_str(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        FormatError::new(place, error.to_string(), hint)
    })?;
    if file.kind != KIND || file.toile != VERSION {
        let what = format!(
            "{:?} of version {} is not known here",
            file.kind, file.toile
        );
        return Err(FormatError::new("kind", what, hint));
    }
    let mut measurements = Measurements::new();
    for (name, number) in file.measurements {
        let value = match is_angle(&name) {
            true => number.to_radians(),
            false => number * 0.01,
        };
        measurements
            .set(&name, value, Origin::Asked)
            .map_err(|error| {
                let place = format!("measurements.{name}");
                FormatError::new(place, error.to_string(), "correct it")
            })?;
    }
    let parts = [
        (Part::Trunk, file.trunk),
        (Part::Head, file.head),
        (Part::LeftArm, file.arm),
        (Part::LeftLeg, file.leg),
    ];
    let primitive = |part: Part, number: usize, row: Row| {
        if !(9..=10).contains(&row.len()) {
            let what = format!("{} numbers stand where 9 or 10 should", row.len());
            let place = format!("primitive {number} of the {}", part.name());
            let remedy =
                "give centre, semi-axes (0.1 mm), turn (mrad) and, if not 1000, the weight";
            return Err(FormatError::new(place, what, remedy));
        }
        let length = |k: usize| f64::from(row[k]) * LENGTH;
        let turn = |k: usize| f64::from(row[k]) * TURN;
        Ok(Primitive {
            rotation: [turn(6), turn(7), turn(8)],
            weight: row.get(9).map_or(1.0, |&weight| f64::from(weight) * WEIGHT),
            ..Primitive::new(
                part,
                [length(0), length(1), length(2)],
                [length(3), length(4), length(5)],
            )
        })
    };
    let mut primitives = Vec::new();
    for (part, rows) in parts {
        for (number, row) in rows.into_iter().enumerate() {
            primitives.push(primitive(part, number + 1, row)?);
        }
    }
    let rigging = rigged(&mut primitives, file.particular, file.joined)?;
    Ok(Description {
        figure: file.figure,
        measurements,
        primitives,
        frame: file.frame,
        rigging,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_body::Mannequin;

    #[test]
    fn a_whole_adult_in_ten_kilobytes_reads_back() {
        for figure in [Figure::Woman, Figure::Man, Figure::Child6] {
            let body = Mannequin::new(&figure.average(), figure).unwrap();
            let text = write_mannequin(&body.description()).unwrap();
            assert!(text.len() <= 10_000, "{figure:?}: {} bytes", text.len());
            let again = Mannequin::from_description(&read_mannequin(&text).unwrap()).unwrap();
            let furthest = body
                .skin()
                .positions
                .iter()
                .zip(&again.skin().positions)
                .map(|(a, b)| (a - b).norm())
                .fold(0.0, f64::max);
            assert!(furthest < 1e-4, "{figure:?}: {furthest}");
            // Writing it again gives the same file.
            assert_eq!(write_mannequin(&again.description()).unwrap(), text);
        }
    }

    #[test]
    fn what_is_particular_reads_back() {
        use toile_body::{DeformationKey, PrimitiveEdit};
        let own = Mannequin::framed(Figure::Woman).unwrap();
        let key = |angle: f64, grown: f64| DeformationKey {
            angle,
            shift: [0.0, 0.0, grown - 1.0],
            stretch: [1.0, 1.0, grown],
            turn: [0.0; 3],
        };
        let edits = [
            // Written among the trunk's primitives, before those of the head.
            PrimitiveEdit::Create {
                new: Primitive::new(Part::Trunk, [0.05, 1.1, 0.05], [0.08; 3]),
            },
            PrimitiveEdit::Join {
                primitives: vec![own.primitives.len(), 2],
            },
            PrimitiveEdit::Blend {
                primitive: own.primitives.len(),
                blend: Blend::Unblendable,
            },
            PrimitiveEdit::Group {
                primitive: 3,
                part: Part::Trunk,
                also: Some(Part::LeftLeg),
            },
            PrimitiveEdit::Deform {
                primitive: own.primitives.len() - 1,
                deformation: Some(Deformation {
                    joint: Joint::LKnee,
                    axis: [1.0, 0.0, 0.0],
                    keys: vec![key(0.0, 1.0), key(1.5, 1.25)],
                }),
            },
        ];
        // A central primitive of the trunk has no second group on the other side.
        let pair = own.primitives.iter().position(|p| !p.is_central()).unwrap();
        let edits = edits.map(|edit| match edit {
            PrimitiveEdit::Group { part, also, .. } => PrimitiveEdit::Group {
                primitive: pair,
                part,
                also,
            },
            other => other,
        });
        let made = own.edited(&edits).unwrap();
        let text = write_mannequin(&made).unwrap();
        let read = read_mannequin(&text).unwrap();
        assert_eq!(write_mannequin(&read).unwrap(), text);
        let plain = |d: &Description| {
            let own = d
                .primitives
                .iter()
                .position(|p| p.blend == Blend::Unblendable);
            (own.unwrap(), d.primitives[own.unwrap()].part)
        };
        let (place, part) = plain(&read);
        assert_eq!(part, Part::Trunk);
        assert!(read.rigging.joined[0].contains(&place));
        let bent = read.rigging.particulars[0].primitive;
        assert_eq!(read.primitives[bent].part, Part::LeftLeg);
        assert!(Mannequin::from_description(&read).is_ok());
        let lost = text.replace(
            "\"particular\":[{\"primitive\":",
            "\"particular\":[{\"primitive\":900",
        );
        assert!(read_mannequin(&lost).is_err());
    }

    #[test]
    fn damage_is_refused_with_place_and_remedy() {
        for (text, word) in [
            ("{", "line"),
            (
                "{\"toile\":1,\"kind\":\"pattern\",\"figure\":\"woman\",\"measurements\":{}}",
                "pattern",
            ),
            (
                "{\"toile\":9,\"kind\":\"mannequin\",\"figure\":\"woman\",\"measurements\":{}}",
                "version 9",
            ),
            (
                "{\"toile\":1,\"kind\":\"mannequin\",\"figure\":\"ogre\",\"measurements\":{}}",
                "ogre",
            ),
            (
                "{\"toile\":1,\"kind\":\"mannequin\",\"figure\":\"man\",\"measurements\":{},\"arm\":[[1,2]]}",
                "primitive 1 of the left arm",
            ),
        ] {
            let error = read_mannequin(text).unwrap_err();
            assert!(error.to_string().contains(word), "{error}");
        }
    }
}
