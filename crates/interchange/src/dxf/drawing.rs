//! The drawing in a DXF file: blocks, and the lines, points and texts in them.

use super::tags::{Tag, tags};
use super::text::TextEncoding;
use crate::FormatError;
use std::collections::BTreeMap;
use toile_geometry::Vec2;

/// Most vertices of all lines of a file.
const MAX_VERTICES: usize = 2_000_000;

/// A drawing, in the units of the file.
#[derive(Clone, Debug, Default)]
pub(super) struct DxfDrawing {
    /// The blocks, in the order of the file.
    pub blocks: Vec<Block>,
    /// What is drawn outside of blocks.
    pub loose: Vec<Entity>,
    /// Where blocks are put in.
    pub inserts: Vec<Insert>,
    /// Unit that the header states (`$INSUNITS`), as its number there; 0 for none.
    pub header_unit: i64,
    /// Kinds of entities that were left out, with their numbers.
    pub left_out: BTreeMap<String, usize>,
}

/// A named group of entities.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    pub name: String,
    /// The point of the block that an insert puts at its place.
    pub base: Vec2,
    pub entities: Vec<Entity>,
}

/// A place at which a block is put in.
#[derive(Clone, Debug)]
pub(super) struct Insert {
    /// Name of the block.
    pub block: String,
    pub at: Vec2,
    /// Scales along x and y; negative for a mirror image.
    pub scale: [f64; 2],
    /// Turn (rad), counter-clockwise.
    pub turn: f64,
}

/// Something drawn on a layer.
#[derive(Clone, Debug)]
pub(super) struct Entity {
    /// The layer; text that is no number stands for a layer of no standard.
    pub layer: String,
    pub drawn: Drawn,
}

/// Lines, points and texts.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Drawn {
    /// A line through points.
    Line {
        points: Vec<Vec2>,
        /// Whether it runs back to its first point.
        is_closed: bool,
    },
    /// A point; its further values are the depth and width of a notch or the diameter of a drill hole, and the
    /// angle of a notch (degrees).
    Point {
        at: Vec2,
        /// The third coordinate, if it is there.
        z: Option<f64>,
        /// The thickness, if it is there.
        thickness: Option<f64>,
        /// The angle (degrees), if it is there.
        angle: Option<f64>,
    },
    /// A text.
    Text { at: Vec2, text: String },
}

impl DxfDrawing {
    /// Reads a drawing.
    ///
    /// # Errors
    /// A damaged file: the fault, its line and a remedy.
    pub fn read(bytes: &[u8]) -> Result<Self, FormatError> {
        let tags = tags(bytes)?;
        let mut reader = Reader {
            encoding: encoding(bytes, &tags),
            drawing: Self::default(),
            vertices: 0,
        };
        reader.sections(&tags)?;
        Ok(reader.drawing)
    }
}

/// The encoding of the texts.
fn encoding(bytes: &[u8], tags: &[Tag<'_>]) -> TextEncoding {
    let named = tags.windows(2).find(|pair| pair[0].is(9, "$DWGCODEPAGE"));
    TextEncoding::of_file(bytes, named.map_or(b"", |pair| pair[1].value))
}

struct Reader {
    encoding: TextEncoding,
    drawing: DxfDrawing,
    /// Vertices read so far.
    vertices: usize,
}

/// Splits tags into groups that each begin with a tag of code 0.
fn groups<'t, 'a>(tags: &'t [Tag<'a>]) -> impl Iterator<Item = &'t [Tag<'a>]> {
    let mut rest = tags;
    std::iter::from_fn(move || {
        let start = rest.iter().position(|tag| tag.code == 0)?;
        let after = rest[start + 1..].iter().position(|tag| tag.code == 0);
        let end = after.map_or(rest.len(), |after| start + 1 + after);
        let group = &rest[start..end];
        rest = &rest[end..];
        Some(group)
    })
}

impl Reader {
    fn sections(&mut self, tags: &[Tag<'_>]) -> Result<(), FormatError> {
        let unit = tags.windows(2).find(|pair| pair[0].is(9, "$INSUNITS"));
        self.drawing.header_unit = unit.map_or(0, |pair| pair[1].count());
        let mut section = Vec::new();
        let mut block: Option<Block> = None;
        let mut line: Option<Entity> = None;
        for group in groups(tags) {
            let head = group[0];
            let kind = String::from_utf8_lossy(head.value).to_uppercase();
            // The vertices of a polyline are entities of their own, up to SEQEND; some programs leave that out.
            if !matches!(kind.as_str(), "VERTEX") {
                self.put(line.take(), &mut block);
            }
            match kind.as_str() {
                "SECTION" => section = value(group, 2).map_or(Vec::new(), |tag| tag.value.to_vec()),
                "ENDSEC" => section.clear(),
                "BLOCK" => {
                    block = Some(Block {
                        name: self.text(group, 2),
                        base: place(group, 10)?.unwrap_or_default(),
                        entities: Vec::new(),
                    });
                }
                "ENDBLK" => self.drawing.blocks.extend(block.take()),
                "VERTEX" => {
                    if let (
                        Some(at),
                        Some(Entity {
                            drawn: Drawn::Line { points, .. },
                            ..
                        }),
                    ) = (place(group, 10)?, &mut line)
                    {
                        points.push(at);
                        self.vertices += 1;
                    }
                }
                "POLYLINE" => {
                    line = Some(self.entity(
                        group,
                        Drawn::Line {
                            points: Vec::new(),
                            is_closed: is_closed(group),
                        },
                    ))
                }
                "INSERT" if block.is_none() => self.insert(group)?,
                _ if !section.eq_ignore_ascii_case(b"BLOCKS")
                    && !section.eq_ignore_ascii_case(b"ENTITIES") => {}
                kind => {
                    let drawn = self.drawn(kind, group)?;
                    let entity = drawn.map(|drawn| self.entity(group, drawn));
                    self.put(entity, &mut block);
                }
            }
            if self.vertices > MAX_VERTICES {
                return Err(FormatError::new(
                    format!("line {}", head.line),
                    format!("the lines have more than {MAX_VERTICES} vertices"),
                    "save fewer pieces or sizes in one file",
                ));
            }
        }
        self.put(line, &mut block);
        // A file that breaks off within a block still has that block.
        self.drawing.blocks.extend(block);
        Ok(())
    }

    fn put(&mut self, entity: Option<Entity>, block: &mut Option<Block>) {
        match block {
            Some(block) => block.entities.extend(entity),
            None => self.drawing.loose.extend(entity),
        }
    }

    fn text(&self, group: &[Tag<'_>], code: i32) -> String {
        value(group, code).map_or_else(String::new, |tag| self.encoding.decode(tag.value))
    }

    fn entity(&self, group: &[Tag<'_>], drawn: Drawn) -> Entity {
        Entity {
            layer: self.text(group, 8),
            drawn,
        }
    }

    fn insert(&mut self, group: &[Tag<'_>]) -> Result<(), FormatError> {
        let number = |code| value(group, code).map_or(Ok(None), |tag| tag.number().map(Some));
        self.drawing.inserts.push(Insert {
            block: self.text(group, 2),
            at: place(group, 10)?.unwrap_or_default(),
            scale: [number(41)?.unwrap_or(1.0), number(42)?.unwrap_or(1.0)],
            turn: number(50)?.unwrap_or(0.0).to_radians(),
        });
        Ok(())
    }

    fn drawn(&mut self, kind: &str, group: &[Tag<'_>]) -> Result<Option<Drawn>, FormatError> {
        let number = |code| value(group, code).map_or(Ok(None), |tag| tag.number().map(Some));
        Ok(Some(match kind {
            "LINE" => match (place(group, 10)?, place(group, 11)?) {
                (Some(from), Some(to)) => Drawn::Line {
                    points: vec![from, to],
                    is_closed: false,
                },
                _ => return Ok(None),
            },
            "LWPOLYLINE" => {
                let points = places(group)?;
                self.vertices += points.len();
                Drawn::Line {
                    points,
                    is_closed: is_closed(group),
                }
            }
            "POINT" => match place(group, 10)? {
                Some(at) => Drawn::Point {
                    at,
                    z: number(30)?,
                    thickness: number(39)?,
                    angle: number(50)?,
                },
                None => return Ok(None),
            },
            "TEXT" | "MTEXT" | "ATTDEF" | "ATTRIB" => Drawn::Text {
                at: place(group, 10)?.unwrap_or_default(),
                text: self.text(group, 1),
            },
            "SEQEND" | "ENDTAB" | "EOF" | "" => return Ok(None),
            kind => {
                *self.drawing.left_out.entry(kind.to_owned()).or_default() += 1;
                return Ok(None);
            }
        }))
    }
}

/// The first tag of a group with a code.
fn value<'t, 'a>(group: &'t [Tag<'a>], code: i32) -> Option<&'t Tag<'a>> {
    group[1..].iter().find(|tag| tag.code == code)
}

/// The place whose x has a code; y stands under the code that is 10 higher.
fn place(group: &[Tag<'_>], code: i32) -> Result<Option<Vec2>, FormatError> {
    match (value(group, code), value(group, code + 10)) {
        (Some(x), Some(y)) => Ok(Some(Vec2::new(x.number()?, y.number()?))),
        _ => Ok(None),
    }
}

/// All places of a group.
fn places(group: &[Tag<'_>]) -> Result<Vec<Vec2>, FormatError> {
    let mut found: Vec<Vec2> = Vec::new();
    for tag in &group[1..] {
        match tag.code {
            10 => found.push(Vec2::new(tag.number()?, 0.0)),
            20 => {
                if let Some(last) = found.last_mut() {
                    last.y = tag.number()?;
                }
            }
            _ => {}
        }
    }
    Ok(found)
}

/// Whether the flags of a polyline say that it is closed.
fn is_closed(group: &[Tag<'_>]) -> bool {
    value(group, 70).is_some_and(|tag| tag.count() & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A DXF from pairs separated by blanks; `_` stands for a blank in a value.
    fn dxf(pairs: &str) -> Vec<u8> {
        let words = pairs.split_whitespace();
        words
            .map(|word| word.replace('_', " ") + "\n")
            .collect::<String>()
            .into_bytes()
    }

    #[test]
    fn blocks_with_lines_points_and_texts_are_read() {
        let file = dxf("0 SECTION 2 BLOCKS 0 BLOCK 8 1 2 FRONT_M 70 64 10 0 20 0
            0 POLYLINE 8 1 66 1 70 1 0 VERTEX 8 1 10 0 20 0 0 VERTEX 10 100 20 0 0 VERTEX 10 0 20 50 0 SEQEND
            0 POINT 8 4 10 50 20 0 30 -5 0 TEXT 8 1 10 1 20 1 1 Piece_Name:_FRONT 0 CIRCLE 8 8 10 0 20 0 40 1
            0 ENDBLK 0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 8 1 2 FRONT_M 10 5 20 6 50 90 0 ENDSEC 0 EOF");
        let drawing = DxfDrawing::read(&file).unwrap();
        assert_eq!(drawing.blocks.len(), 1);
        let block = &drawing.blocks[0];
        assert_eq!((block.name.as_str(), block.entities.len()), ("FRONT M", 3));
        let corners = [[0.0, 0.0], [100.0, 0.0], [0.0, 50.0]].map(Vec2::from);
        assert_eq!(
            block.entities[0].drawn,
            Drawn::Line {
                points: corners.to_vec(),
                is_closed: true
            }
        );
        let notch = Drawn::Point {
            at: Vec2::new(50.0, 0.0),
            z: Some(-5.0),
            thickness: None,
            angle: None,
        };
        assert_eq!(block.entities[1].drawn, notch);
        assert_eq!(drawing.left_out["CIRCLE"], 1);
        let insert = &drawing.inserts[0];
        assert_eq!(insert.at, Vec2::new(5.0, 6.0));
        assert!((insert.turn - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn files_without_seqend_and_without_end_are_read() {
        let file = dxf(
            "0 SECTION 2 ENTITIES 0 POLYLINE 8 1 70 0 0 VERTEX 10 0 20 0 0 VERTEX 10 1 20 0
            0 LINE 8 7 10 0 20 0 11 3 21 4 0 LWPOLYLINE 8 8 70 1 10 0 20 1 10 2 20 3",
        );
        let drawing = DxfDrawing::read(&file).unwrap();
        let counts = drawing.loose.iter().map(|entity| match &entity.drawn {
            Drawn::Line { points, is_closed } => (points.len(), *is_closed),
            other => panic!("{other:?}"),
        });
        assert_eq!(
            counts.collect::<Vec<_>>(),
            [(2, false), (2, false), (2, true)]
        );
    }

    #[test]
    fn a_number_that_is_none_is_refused_with_its_line() {
        let file = dxf("0 SECTION 2 ENTITIES 0 POINT 8 4 10 inf 20 0");
        assert_eq!(DxfDrawing::read(&file).unwrap_err().place, "line 10");
    }
}
