//! `marker.json`: a marker as readable, versioned JSON. Lengths in metres, angles in degrees.

use crate::FormatError;
use serde::{Deserialize, Serialize};
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{
    Flaw, Fold, Item, Marker, MatchPoint, Nap, Phase, Placement, Strip, Stripes, Unplaced,
};

const FORMAT: &str = "toile-marker";
const VERSION: u32 = 1;

/// The content of a `marker.json` file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerFile {
    /// Kind of the file: `toile-marker`.
    pub format: String,
    /// Version of the format, from 1.
    pub version: u32,
    /// Unit of all lengths: `m`.
    pub unit: String,
    /// Name of the marker.
    pub name: String,
    /// The fabric.
    pub fabric: MarkerFabric,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
    /// Area of the pieces divided by width times length between the end margins (0 to 1).
    pub efficiency: f64,
    /// Area of the pieces divided by width times length (0 to 1).
    pub utilisation: f64,
    /// The roll that the marker is cut from, if there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roll: Option<String>,
    /// Number of layers cut at once; the two layers of folded fabric count as one.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub plies: u32,
    /// Whether every second ply is turned over.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub face_to_face: bool,
    /// The pieces laid on the fabric.
    pub pieces: Vec<MarkerFilePiece>,
    /// Copies that could not be placed.
    pub unplaced: Vec<MarkerFileUnplaced>,
}

/// Fabric in a marker file. x runs along the warp, y from the lower selvedge to the upper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerFabric {
    /// Name of the fabric in the pattern.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Full width (m).
    pub width: f64,
    /// Width of the unusable edge on either side (m).
    pub selvedge: f64,
    /// Free fabric left at either end (m).
    pub end_margin: f64,
    /// Least distance between pieces (m).
    pub gap: f64,
    /// Length of fabric available (m); null for no limit.
    pub max_length: Option<f64>,
    /// Whether the fabric has a nap, so that all pieces point in one direction.
    pub one_way: bool,
    /// Whether all pieces of one garment point in the same of the two directions along the warp.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub one_way_per_garment: bool,
    /// Folds along the warp.
    #[serde(default, skip_serializing_if = "MarkerFold::is_open")]
    pub fold: MarkerFold,
    /// Repeating print.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub print: Option<MarkerPrint>,
    /// Flaws that no piece may lie on.
    #[serde(rename = "defects", default, skip_serializing_if = "Vec::is_empty")]
    pub flaws: Vec<MarkerFlaw>,
}

/// Folds of the fabric, in a marker file; the width is then that of the folded fabric.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkerFold {
    /// No fold.
    #[default]
    Open,
    /// Folded at y = 0.
    Lower,
    /// Folded at y = 0 and at y = width.
    Both,
}

impl MarkerFold {
    fn is_open(&self) -> bool {
        *self == Self::Open
    }
}

fn one() -> u32 {
    1
}

fn is_nought(number: &u32) -> bool {
    *number == 0
}

fn is_nothing(length: &f64) -> bool {
    *length == 0.0
}

fn is_one(plies: &u32) -> bool {
    *plies == 1
}

/// A repeating print, in a marker file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerPrint {
    /// Length of a repeat along the warp and across it (m); 0 in a direction without repeat.
    pub repeat: [f64; 2],
    /// A point at which lines of the print cross (m).
    pub origin: [f64; 2],
}

/// A flaw of the fabric, in a marker file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerFlaw {
    /// Outline of the flaw (m).
    pub outline: Vec<[f64; 2]>,
    /// Clearance between pieces and the flaw (m).
    pub clearance: f64,
}

/// A piece laid on the fabric, in a marker file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerFilePiece {
    /// Name of the piece.
    pub name: String,
    /// Number of the item it is a copy of, from 0.
    pub item: usize,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Direction of the warp on the piece as drawn, counter-clockwise from +x (deg).
    pub grain: f64,
    /// Angle from the warp of the fabric to the grain of the laid piece (deg).
    pub turn: f64,
    /// Whether the piece lies face down: it is turned over across the grain before it is rotated.
    pub face_down: bool,
    /// Translation after the rotation (m).
    pub at: [f64; 2],
    /// Number of the garment that the piece belongs to, from 0.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub garment: u32,
    /// Distance the piece needs to any other piece (m).
    #[serde(default, skip_serializing_if = "is_nothing")]
    pub gap: f64,
    /// Whether the piece may lie on flaws.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub over_flaws: bool,
    /// The point of the piece that must match the print.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on_print: Option<MarkerMatch>,
    /// Cut outline of the laid piece, rounded to micrometres (m).
    pub outline: Vec<[f64; 2]>,
    /// Outlines of holes cut into the piece, also laid and rounded (m).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub holes: Vec<Vec<[f64; 2]>>,
}

/// A point of a piece that must match the print, in a marker file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerMatch {
    /// Position in the piece as drawn (m).
    pub point: [f64; 2],
    /// Offset of the point from the lines of the print, along the warp and across it (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub after: Option<[f64; 2]>,
    /// Number of a set of points, if `after` is not given: all points of the set lie at one place of the
    /// repeat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub set: Option<u32>,
}

impl MarkerMatch {
    fn of(point: MatchPoint) -> Self {
        let (after, set) = match point.phase {
            Phase::At(phase) => (Some(phase.into()), None),
            Phase::Set(set) => (None, Some(set)),
        };
        Self {
            point: point.point.into(),
            after,
            set,
        }
    }

    /// The match point in the form that the nesting crate uses.
    pub fn match_point(&self) -> MatchPoint {
        MatchPoint {
            point: Vec2::from(self.point),
            phase: match self.set {
                Some(set) => Phase::Set(set),
                None => Phase::At(Vec2::from(self.after.unwrap_or_default())),
            },
        }
    }
}

/// A copy that could not be placed, in a marker file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerFileUnplaced {
    /// Name of the piece.
    pub name: String,
    /// Number of the item it is a copy of, from 0.
    pub item: usize,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// The reason, and the remedy.
    pub reason: String,
}

impl MarkerFile {
    /// The file of a marker made from items on a strip. Placements of items that do not exist are left out.
    pub fn new(name: &str, items: &[Item], strip: &Strip, marker: &Marker) -> Self {
        let piece = |placement: &Placement| {
            let item = items.get(placement.item)?;
            let laid = placement.pose(item).lay(&item.outline);
            let ring = |ring: &Vec<Vec2>| {
                let points = ring.iter();
                points
                    .map(|p| [micrometres(p.x), micrometres(p.y)])
                    .collect()
            };
            Some(MarkerFilePiece {
                name: item.name.clone(),
                item: placement.item,
                copy: placement.copy,
                grain: item.grain.to_degrees(),
                turn: placement.turn.to_degrees(),
                face_down: placement.mirrored,
                at: [placement.translation.x, placement.translation.y],
                garment: item.bundle(placement.copy),
                gap: item.gap,
                over_flaws: item.over_flaws,
                on_print: item
                    .match_point
                    .filter(|_| strip.stripes.is_some())
                    .map(MarkerMatch::of),
                outline: ring(&laid.outer),
                holes: laid.holes.iter().map(ring).collect(),
            })
        };
        let left = |unplaced: &Unplaced| MarkerFileUnplaced {
            name: items
                .get(unplaced.item)
                .map_or_else(String::new, |i| i.name.clone()),
            item: unplaced.item,
            copy: unplaced.copy,
            reason: unplaced.reason.clone(),
        };
        Self {
            format: FORMAT.into(),
            version: VERSION,
            unit: "m".into(),
            name: name.into(),
            fabric: MarkerFabric {
                name: None,
                width: strip.width,
                selvedge: strip.selvedge,
                end_margin: strip.end_margin,
                gap: strip.gap,
                max_length: strip.max_length,
                one_way: strip.nap == Nap::OneWay,
                one_way_per_garment: strip.nap == Nap::PerBundle,
                fold: match strip.fold {
                    Fold::Open => MarkerFold::Open,
                    Fold::Lower => MarkerFold::Lower,
                    Fold::Both => MarkerFold::Both,
                },
                print: strip.stripes.map(|s| MarkerPrint {
                    repeat: s.repeat.into(),
                    origin: s.origin.into(),
                }),
                flaws: strip.flaws.iter().map(MarkerFlaw::of).collect(),
            },
            length: marker.length,
            efficiency: marker.efficiency,
            utilisation: marker.utilisation,
            roll: None,
            plies: 1,
            face_to_face: false,
            pieces: marker.placements.iter().filter_map(piece).collect(),
            unplaced: marker.unplaced.iter().map(left).collect(),
        }
    }

    /// The marker that the file describes.
    pub fn marker(&self) -> Marker {
        let placement = |p: &MarkerFilePiece| Placement {
            item: p.item,
            copy: p.copy,
            turn: p.turn.to_radians(),
            mirrored: p.face_down,
            translation: Vec2::new(p.at[0], p.at[1]),
        };
        let unplaced = |u: &MarkerFileUnplaced| Unplaced {
            item: u.item,
            copy: u.copy,
            reason: u.reason.clone(),
        };
        Marker {
            placements: self.pieces.iter().map(placement).collect(),
            length: self.length,
            efficiency: self.efficiency,
            utilisation: self.utilisation,
            unplaced: self.unplaced.iter().map(unplaced).collect(),
        }
    }

    /// The fabric that the file describes.
    pub fn strip(&self) -> Strip {
        Strip {
            width: self.fabric.width,
            selvedge: self.fabric.selvedge,
            end_margin: self.fabric.end_margin,
            gap: self.fabric.gap,
            max_length: self.fabric.max_length,
            nap: match (self.fabric.one_way, self.fabric.one_way_per_garment) {
                (true, _) => Nap::OneWay,
                (_, true) => Nap::PerBundle,
                _ => Nap::None,
            },
            fold: match self.fabric.fold {
                MarkerFold::Open => Fold::Open,
                MarkerFold::Lower => Fold::Lower,
                MarkerFold::Both => Fold::Both,
            },
            stripes: self.fabric.print.map(|print| Stripes {
                repeat: Vec2::from(print.repeat),
                origin: Vec2::from(print.origin),
            }),
            flaws: self.fabric.flaws.iter().map(MarkerFlaw::flaw).collect(),
        }
    }
}

impl MarkerFlaw {
    fn of(flaw: &Flaw) -> Self {
        Self {
            outline: flaw.outline.outer.iter().map(|&p| p.into()).collect(),
            clearance: flaw.clearance,
        }
    }

    fn flaw(&self) -> Flaw {
        Flaw {
            outline: Polygon::new(self.outline.iter().map(|&p| Vec2::from(p)).collect()),
            clearance: self.clearance,
        }
    }
}

fn micrometres(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

/// The text of a marker file, one line per piece. The same marker gives the same bytes.
///
/// # Errors
/// A number is not finite.
pub fn write_marker_json(file: &MarkerFile) -> Result<String, FormatError> {
    check_numbers(file)?;
    let list = |name: &str, lines: Vec<String>| {
        if lines.is_empty() {
            format!("  \"{name}\": []")
        } else {
            format!("  \"{name}\": [\n    {}\n  ]", lines.join(",\n    "))
        }
    };
    let pieces: Result<_, _> = file.pieces.iter().map(line).collect();
    let unplaced: Result<_, _> = file.unplaced.iter().map(line).collect();
    let mut fields = vec![
        format!("  \"format\": {}", line(&file.format)?),
        format!("  \"version\": {}", line(&file.version)?),
        format!("  \"unit\": {}", line(&file.unit)?),
        format!("  \"name\": {}", line(&file.name)?),
        format!("  \"fabric\": {}", line(&file.fabric)?),
        format!("  \"length\": {}", line(&file.length)?),
        format!("  \"efficiency\": {}", line(&file.efficiency)?),
        format!("  \"utilisation\": {}", line(&file.utilisation)?),
    ];
    if let Some(roll) = &file.roll {
        fields.push(format!("  \"roll\": {}", line(roll)?));
    }
    if file.plies != 1 {
        fields.push(format!("  \"plies\": {}", file.plies));
    }
    if file.face_to_face {
        fields.push("  \"face_to_face\": true".to_owned());
    }
    fields.extend([list("pieces", pieces?), list("unplaced", unplaced?)]);
    Ok(format!("{{\n{}\n}}\n", fields.join(",\n")))
}

fn line<T: Serialize>(value: &T) -> Result<String, FormatError> {
    serde_json::to_string(value)
        .map_err(|error| FormatError::new("marker", error.to_string(), "make the marker again"))
}

fn check_numbers(file: &MarkerFile) -> Result<(), FormatError> {
    let fabric = &file.fabric;
    let own = [
        fabric.width,
        fabric.selvedge,
        fabric.end_margin,
        fabric.gap,
        fabric.max_length.unwrap_or(0.0),
        file.length,
        file.efficiency,
        file.utilisation,
    ];
    let print = fabric
        .print
        .iter()
        .flat_map(|p| p.repeat.into_iter().chain(p.origin));
    let flaws = fabric
        .flaws
        .iter()
        .flat_map(|d| d.outline.iter().flatten().copied());
    let clearances = fabric.flaws.iter().map(|d| d.clearance);
    let own: Vec<f64> = own
        .into_iter()
        .chain(print)
        .chain(flaws)
        .chain(clearances)
        .collect();
    let bad = |place: String| {
        let hint = "check the piece's outline and make the marker again";
        Err(FormatError::new(place, "a number is not finite", hint))
    };
    if !own.iter().all(|x| x.is_finite()) {
        return bad("marker".into());
    }
    for piece in &file.pieces {
        let print = piece.on_print.iter();
        let print = print.flat_map(|p| p.point.into_iter().chain(p.after.unwrap_or_default()));
        let numbers = [piece.grain, piece.turn, piece.gap].into_iter();
        let numbers = numbers.chain(piece.at).chain(print);
        let rings = std::iter::once(&piece.outline).chain(&piece.holes);
        let mut all = numbers.chain(rings.flatten().flatten().copied());
        if !all.all(f64::is_finite) {
            return bad(format!("piece \"{}\"", piece.name));
        }
    }
    Ok(())
}

/// Reads a marker file.
///
/// # Errors
/// The text is not JSON, not a marker, of a newer version, or has an unknown field.
pub fn read_marker_json(text: &str) -> Result<MarkerFile, FormatError> {
    #[derive(Deserialize)]
    struct Head {
        format: Option<String>,
        version: Option<u32>,
        unit: Option<String>,
    }
    let broken = |error: serde_json::Error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or(&what).to_owned();
        FormatError::new(place, what, "write the marker again with this program")
    };
    let head: Head = serde_json::from_str(text).map_err(broken)?;
    if head.format.as_deref() != Some(FORMAT) {
        return Err(FormatError::new(
            "format",
            format!("this is not a marker: the field is not \"{FORMAT}\""),
            "choose a marker.json",
        ));
    }
    if head.version != Some(VERSION) {
        return Err(FormatError::new(
            "version",
            format!("only version {VERSION} is known here"),
            "open it with the program that wrote it, or a newer one",
        ));
    }
    if head.unit.as_deref() != Some("m") {
        return Err(FormatError::new(
            "unit",
            "lengths are not in metres",
            "write the marker in metres, with unit \"m\"",
        ));
    }
    let file: MarkerFile = serde_json::from_str(text).map_err(broken)?;
    check_numbers(&file)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_geometry::Bounds2;
    use toile_nesting::{Control, Mirror, Search, judge, make_marker};

    fn job() -> (Vec<Item>, Strip, Marker) {
        let outline = Polygon::rectangle(Bounds2 {
            min: Vec2::new(0.1, 0.2),
            max: Vec2::new(0.7, 0.9),
        });
        let mut item = Item::new("back \"left\" & <right>", outline);
        item.grain = 1.234_567_89;
        item.quantity = 4;
        item.allowed.mirror = Mirror::Pairs;
        let strip = Strip {
            selvedge: 0.01,
            gap: 0.003,
            max_length: Some(1.3),
            nap: Nap::PerBundle,
            fold: Fold::Lower,
            stripes: Some(Stripes {
                repeat: Vec2::new(0.05, 0.0),
                origin: Vec2::zeros(),
            }),
            flaws: vec![Flaw {
                outline: Polygon::rectangle(Bounds2 {
                    min: Vec2::new(0.1, 0.1),
                    max: Vec2::new(0.12, 0.12),
                }),
                clearance: 0.01,
            }],
            ..Strip::of_width(1.5)
        };
        let items = vec![item];
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &std::sync::atomic::AtomicBool::new(false),
        };
        let search = Search::evaluations(1);
        let marker = make_marker(&items, &strip, search, &mut control).unwrap();
        (items, strip, marker)
    }

    #[test]
    fn a_marker_read_back_is_the_marker_and_still_sound() {
        let (items, strip, marker) = job();
        let mut file = MarkerFile::new("shirt", &items, &strip, &marker);
        file.roll = Some("first \"roll\"".into());
        file.plies = 4;
        file.face_to_face = true;
        let text = write_marker_json(&file).unwrap();
        assert_eq!(text, write_marker_json(&file).unwrap());
        let back = read_marker_json(&text).unwrap();
        assert_eq!(back, file);
        assert_eq!(back.strip(), strip);
        let read = back.marker();
        assert_eq!(read.placements.len() + read.unplaced.len(), 4);
        assert!(!read.unplaced.is_empty(), "short fabric");
        assert!(judge(&items, &strip, &read).is_sound());
        let piece = text
            .lines()
            .filter(|l| l.starts_with("    {\"name\""))
            .count();
        assert_eq!(piece, 4, "one line a piece");
    }

    #[test]
    fn damaged_files_are_refused_with_place_and_remedy() {
        let (items, strip, marker) = job();
        let mut file = MarkerFile::new("shirt", &items, &strip, &marker);
        let text = write_marker_json(&file).unwrap();
        for (old, new, place) in [
            ("toile-marker", "toile-scene", "format"),
            ("\"version\": 1", "\"version\": 9", "version"),
            ("\"unit\": \"m\"", "\"unit\": \"mm\"", "unit"),
            ("\"efficiency\"", "\"efficency\"", "line 8"),
            ("\"width\":1.5", "\"width\":\"wide\"", "line 6"),
        ] {
            assert!(text.contains(old), "{old}");
            let error = read_marker_json(&text.replacen(old, new, 1)).unwrap_err();
            assert!(error.place.starts_with(place), "{error}");
        }
        assert!(read_marker_json(&text[..text.len() / 2]).is_err());
        assert!(read_marker_json("").is_err());
        file.pieces[0].at[0] = f64::NAN;
        assert!(write_marker_json(&file).unwrap_err().place.contains("back"));
    }
}
