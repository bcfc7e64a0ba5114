//! Reads the drawing in a DXF file: its sections, blocks and places of blocks.

use super::drawing::{Block, DxfDrawing, Entity, Insert};
use super::entities::{EntityReader, OpenLine, header_unit};
use super::groups::{groups, is_behind, is_closed, place, value};
use super::tags::{Tag, tags};
use super::text::TextEncoding;
use crate::FormatError;
use toile_geometry::Vec2;

/// Most vertices of all lines of a file.
const MAX_VERTICES: usize = 1_000_000;
/// Most entities, blocks and places of blocks of a file.
const MAX_ENTITIES: usize = 500_000;
/// Flag of a vertex of a polyline that only guides a spline.
const FRAME_VERTEX: i64 = 16;
/// Flags of a polyline that is a mesh.
const MESHES: i64 = 16 | 64;

/// Reads a drawing.
///
/// # Errors
/// A damaged file: the fault, its line and a remedy.
pub(super) fn read_drawing(bytes: &[u8]) -> Result<DxfDrawing, FormatError> {
    let tags = tags(bytes)?;
    let mut reader = Reader {
        entity: EntityReader::new(encoding(bytes, &tags), &tags),
        drawing: DxfDrawing::default(),
        entities: 0,
    };
    reader.sections(&tags)?;
    reader.drawing.left_out = reader.entity.left_out;
    reader.drawing.curves = reader.entity.curves;
    Ok(reader.drawing)
}

/// The encoding of the texts.
fn encoding(bytes: &[u8], tags: &[Tag<'_>]) -> TextEncoding {
    let named = tags.windows(2).find(|pair| pair[0].is(9, "$DWGCODEPAGE"));
    TextEncoding::of_file(bytes, named.map_or(b"", |pair| pair[1].value))
}

struct Reader {
    entity: EntityReader,
    drawing: DxfDrawing,
    /// Entities, blocks and places of blocks read so far.
    entities: usize,
}

impl Reader {
    fn sections(&mut self, tags: &[Tag<'_>]) -> Result<(), FormatError> {
        self.drawing.header_unit = header_unit(tags);
        let mut section = Vec::new();
        let mut block: Option<Block> = None;
        let mut line: Option<OpenLine> = None;
        for group in groups(tags) {
            let head = group[0];
            let kind = String::from_utf8_lossy(head.value).to_uppercase();
            // The vertices of a polyline are entities of their own, up to SEQEND; some programs leave that out.
            if kind != "VERTEX" {
                let entity = line.take().and_then(|line| self.entity.finished(line));
                self.put(entity, &mut block);
            }
            match kind.as_str() {
                "SECTION" => section = value(group, 2).map_or(Vec::new(), |tag| tag.value.to_vec()),
                "ENDSEC" => section.clear(),
                "BLOCK" => {
                    // A file that breaks off within a block still has that block.
                    self.drawing.blocks.extend(block.take());
                    self.entities += 1;
                    block = Some(Block {
                        name: self.entity.text(group, 2),
                        base: place(group, 10)?.unwrap_or_default(),
                        entities: Vec::new(),
                    });
                }
                "ENDBLK" => self.drawing.blocks.extend(block.take()),
                "VERTEX" => {
                    let guides =
                        value(group, 70).is_some_and(|tag| tag.count() & FRAME_VERTEX != 0);
                    if let (Some(at), Some(line), false) = (place(group, 10)?, &mut line, guides) {
                        let bulge = value(group, 42).map_or(Ok(0.0), Tag::number)?;
                        line.vertices.push((at, bulge));
                        self.entity.vertices += 1;
                    }
                }
                "POLYLINE" => {
                    line = Some(OpenLine {
                        layer: self.entity.text(group, 8),
                        vertices: Vec::new(),
                        is_closed: is_closed(group),
                        is_behind: is_behind(group),
                        is_mesh: value(group, 70).is_some_and(|tag| tag.count() & MESHES != 0),
                    });
                }
                "INSERT" if block.is_none() => self.insert(group)?,
                _ if !section.eq_ignore_ascii_case(b"BLOCKS")
                    && !section.eq_ignore_ascii_case(b"ENTITIES") => {}
                kind => {
                    let drawn = self.entity.drawn(kind, group)?;
                    let layer = drawn.as_ref().map(|_| self.entity.text(group, 8));
                    let entity = drawn.zip(layer);
                    self.put(
                        entity.map(|(drawn, layer)| Entity { layer, drawn }),
                        &mut block,
                    );
                }
            }
            self.check_counts(head.line)?;
        }
        let entity = line.and_then(|line| self.entity.finished(line));
        self.put(entity, &mut block);
        self.drawing.blocks.extend(block);
        Ok(())
    }

    fn check_counts(&self, line: usize) -> Result<(), FormatError> {
        let too_many = [
            (
                self.entity.vertices > MAX_VERTICES,
                "vertices",
                MAX_VERTICES,
            ),
            (self.entities > MAX_ENTITIES, "entities", MAX_ENTITIES),
        ];
        match too_many.iter().find(|(is_over, ..)| *is_over) {
            None => Ok(()),
            Some((_, what, most)) => Err(FormatError::new(
                format!("line {line}"),
                format!("the drawing has more than {most} {what}"),
                "save fewer pieces or sizes in one file",
            )),
        }
    }

    fn put(&mut self, entity: Option<Entity>, block: &mut Option<Block>) {
        self.entities += usize::from(entity.is_some());
        match block {
            Some(block) => block.entities.extend(entity),
            None => self.drawing.loose.extend(entity),
        }
    }

    fn insert(&mut self, group: &[Tag<'_>]) -> Result<(), FormatError> {
        let number = |code| value(group, code).map_or(Ok(None), |tag| tag.number().map(Some));
        self.entities += 1;
        let at = place(group, 10)?.unwrap_or_default();
        let [x, y] = [number(41)?.unwrap_or(1.0), number(42)?.unwrap_or(1.0)];
        let turn = number(50)?.unwrap_or(0.0).to_radians();
        // What is put in from behind is mirrored at x = 0 after everything else.
        let side = if is_behind(group) { -1.0 } else { 1.0 };
        self.drawing.inserts.push(Insert {
            block: self.entity.text(group, 2),
            at: Vec2::new(at.x * side, at.y),
            scale: [x * side, y],
            turn: turn * side,
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Drawn;
    use super::super::placed::moved;
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
            0 POINT 8 4 10 50 20 0 30 -5 0 TEXT 8 1 10 1 20 1 1 Piece_Name:_FRONT 0 HATCH 8 8 10 0 20 0 40 1
            0 ENDBLK 0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 8 1 2 FRONT_M 10 5 20 6 50 90 0 ENDSEC 0 EOF");
        let drawing = read_drawing(&file).unwrap();
        assert_eq!(drawing.blocks.len(), 1);
        let block = &drawing.blocks[0];
        assert_eq!((block.name.as_str(), block.entities.len()), ("FRONT M", 3));
        let corners = [[0.0, 0.0], [100.0, 0.0], [0.0, 50.0]].map(Vec2::from);
        assert_eq!(
            block.entities[0].drawn,
            Drawn::Line {
                points: corners.to_vec(),
                is_closed: true,
                between: Vec::new(),
            }
        );
        let notch = Drawn::Point {
            at: Vec2::new(50.0, 0.0),
            z: Some(-5.0),
            thickness: None,
            angle: None,
        };
        assert_eq!(block.entities[1].drawn, notch);
        assert_eq!(drawing.left_out["HATCH"], 1);
        let insert = &drawing.inserts[0];
        assert_eq!(insert.at, Vec2::new(5.0, 6.0));
        assert!((insert.turn - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn a_block_put_in_from_behind_is_mirrored_after_its_scale_and_turn() {
        let file = dxf("0 SECTION 2 BLOCKS 0 BLOCK 2 A 10 1 20 0 0 POINT 8 4 10 2 20 3 0 ENDBLK 0 ENDSEC
            0 SECTION 2 ENTITIES 0 INSERT 2 A 10 5 20 6 41 2 42 10 50 90 210 0 220 0 230 -1 0 ENDSEC 0 EOF");
        let drawing = read_drawing(&file).unwrap();
        let block = moved(&drawing.blocks[0], &drawing.inserts[0]);
        let Drawn::Point { at, .. } = &block.entities[0].drawn else {
            panic!("{block:?}");
        };
        // (1, 3) from the base, scaled to (2, 30), turned to (-30, 2), moved to (-25, 8).
        assert!((at - Vec2::new(25.0, 8.0)).norm() < 1e-12, "{at}");
    }

    #[test]
    fn files_without_seqend_and_without_end_are_read() {
        let file = dxf(
            "0 SECTION 2 ENTITIES 0 POLYLINE 8 1 70 0 0 VERTEX 10 0 20 0 0 VERTEX 10 1 20 0
            0 LINE 8 7 10 0 20 0 11 3 21 4 0 LWPOLYLINE 8 8 70 1 10 0 20 1 10 2 20 3",
        );
        let drawing = read_drawing(&file).unwrap();
        let counts = drawing.loose.iter().map(|entity| match &entity.drawn {
            Drawn::Line {
                points, is_closed, ..
            } => (points.len(), *is_closed),
            other => panic!("{other:?}"),
        });
        assert_eq!(
            counts.collect::<Vec<_>>(),
            [(2, false), (2, false), (2, true)]
        );
    }

    #[test]
    fn curves_become_points_of_them() {
        let file = dxf("0 SECTION 2 ENTITIES 0 CIRCLE 8 1 10 5 20 0 40 100 0 ARC 8 1 10 0 20 0 40 100 50 350 51 10
            0 ELLIPSE 8 1 10 0 20 0 11 100 21 0 40 0.5 0 LWPOLYLINE 8 1 70 1 10 0 20 0 42 1 10 50 20 0 42 1
            0 SPLINE 8 1 71 1 40 0 40 0 40 1 40 1 10 0 20 0 10 9 20 9 0 SPLINE 8 1 71 9 11 1 21 2 11 3 21 4
            0 POLYLINE 8 1 70 0 0 VERTEX 10 1 20 2 70 16 0 VERTEX 10 1 20 2 0 VERTEX 10 3 20 2 0 SEQEND
            0 LWPOLYLINE 8 1 230 -1 10 1 20 2 10 3 20 4 0 SPLINE 8 1 0 POLYLINE 8 1 70 64 0 VERTEX 10 0 20 0 0 SEQEND
            0 ENDSEC 0 EOF");
        let drawing = read_drawing(&file).unwrap();
        let lines: Vec<(Vec<Vec2>, usize)> = drawing
            .loose
            .iter()
            .map(|entity| match &entity.drawn {
                Drawn::Line {
                    points, between, ..
                } => (points.clone(), between.iter().filter(|b| **b).count()),
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(lines.len(), 8);
        assert!(
            lines[..4]
                .iter()
                .all(|(points, between)| points.len() > 8 && *between > 6)
        );
        let arc = &lines[1].0;
        assert!(
            (arc[0] - Vec2::new(98.4808, -17.3648)).norm() < 1e-3,
            "{}",
            arc[0]
        );
        assert!((arc[arc.len() - 1] - Vec2::new(98.4808, 17.3648)).norm() < 1e-3);
        let right = lines[0].0.iter().map(|p| p.x).fold(0.0, f64::max);
        assert_eq!(right, 105.0);
        assert_eq!(
            lines[5],
            (vec![Vec2::new(1.0, 2.0), Vec2::new(3.0, 4.0)], 0)
        );
        assert_eq!(
            lines[6].0.len(),
            2,
            "the frame of a spline is no part of the line"
        );
        assert_eq!(lines[7].0[0], Vec2::new(-1.0, 2.0));
        assert_eq!(drawing.curves["SPLINE"], 2);
        let left_out: Vec<&str> = drawing.left_out.keys().map(String::as_str).collect();
        assert_eq!(left_out, ["POLYLINE mesh", "SPLINE"]);
    }

    #[test]
    fn a_number_that_is_none_is_refused_with_its_line() {
        let file = dxf("0 SECTION 2 ENTITIES 0 POINT 8 4 10 inf 20 0");
        assert_eq!(read_drawing(&file).unwrap_err().place, "line 10");
    }
}
