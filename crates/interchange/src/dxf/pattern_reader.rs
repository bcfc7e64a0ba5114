//! Patterns from DXF (ANSI/AAMA-292 and ASTM D6673): blocks become pieces, blocks of one piece its sizes.
//!
//! Notches, corners and quantities stand in the block of the sample size alone; other sizes have as many
//! vertices, and take them by number.

use super::block_piece::{BlockLine, BlockPiece, Layer};
use super::drawing::{Block, Drawn, DxfDrawing};
use super::labels::Labels;
use super::outlines::split;
use super::placed::moved;
use super::sizes::sizes;
use super::with_table::{Units, with_table};
use crate::drawn::allowance::{distance, is_evenly_inside};
use crate::drawn::builder::document;
use crate::drawn::inset::inset;
use crate::drawn::piece::{DrawnLine, DrawnNotch, DrawnPattern, DrawnPiece};
use crate::drawn::unit::unit;
use crate::{Companion, Format, FormatError, Guess, Loss, ReadOptions};
use std::collections::BTreeMap;
use toile_geometry::{Bounds2, Vec2, ring_area};
use toile_pattern::{Cut, DisplayUnit, NotchKind, Pattern};

/// Largest distance of a mark from the vertex that it names (m).
const ON_VERTEX: f64 = 5e-4;
/// Vertices that lie nearer to the one before in every size are repeats (m).
const REPEAT: f64 = 1e-6;
/// Largest allowance between a sew line on the layer of internal lines and the cut line (m).
const MAX_ALLOWANCE: f64 = 0.05;

/// A pattern that was read.
pub(crate) struct DxfReading {
    pub pattern: Pattern,
    pub format: Format,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
}

/// Reads a pattern, with the grade rule table among its companions if there is one.
///
/// # Errors
/// A damaged file, or one without a closed line; a companion that is no grade rule table, or one of other sizes:
/// the fault, its place and a remedy.
pub(crate) fn read_dxf(
    bytes: &[u8],
    options: &ReadOptions,
    companions: &[Companion],
) -> Result<DxfReading, FormatError> {
    let drawing = DxfDrawing::read(bytes)?;
    let mut reader = Reader::new(&drawing);
    let pieces = reader.pieces(&drawing)?;
    let style = &reader.style;
    let stated = match style.value(&["units"]).map(str::to_lowercase).as_deref() {
        Some("english") => Some(DisplayUnit::Inch),
        Some("metric") => Some(DisplayUnit::Millimetre),
        _ => match drawing.header_unit {
            1 => Some(DisplayUnit::Inch),
            4 => Some(DisplayUnit::Millimetre),
            5 => Some(DisplayUnit::Centimetre),
            6 => Some(DisplayUnit::Metre),
            _ => None,
        },
    };
    let (unit, guess) = unit(options.unit, stated, largest(&pieces));
    reader.guesses.extend(guess);
    let is_astm = pieces.iter().any(|piece| piece.has_twins);
    let units = Units { unit, stated };
    let sized = with_table(pieces, companions, (&mut reader.style, units))?;
    reader.guesses.extend(sized.guesses);
    reader.losses.extend(sized.losses);
    let mut drawn = reader.drawn(sized.pieces, unit.metres(), options.allowance_inside)?;
    drawn.rules = sized.rules;
    drawn.name = reader
        .style
        .value(&["stylename", "style"])
        .unwrap_or_default()
        .to_owned();
    let (mut pattern, losses) = document(&drawn);
    pattern.unit = match unit {
        DisplayUnit::Inch => DisplayUnit::Inch,
        DisplayUnit::Millimetre | DisplayUnit::Centimetre | DisplayUnit::Metre => {
            DisplayUnit::Centimetre
        }
    };
    reader.losses.extend(losses);
    Ok(DxfReading {
        pattern,
        format: if is_astm {
            Format::DxfAstm
        } else {
            Format::DxfAama
        },
        guesses: reader.guesses,
        losses: reader.losses,
    })
}

/// The larger side of the largest piece (units of the file).
fn largest(pieces: &[BlockPiece]) -> f64 {
    let sides = pieces.iter().filter_map(|piece| {
        let outline = piece.cut.first()?;
        let size = Bounds2::of(outline.points.iter().copied()).size();
        Some(size.x.max(size.y))
    });
    sides.fold(0.0, f64::max)
}

struct Reader {
    style: Labels,
    guesses: Vec<Guess>,
    losses: Vec<Loss>,
}

/// The notches of a piece, with their places in those sizes whose blocks have as many.
fn notches(
    own: &BlockPiece,
    sized: &BTreeMap<usize, BlockPiece>,
    (count, unit): (usize, f64),
) -> Vec<DrawnNotch> {
    let of = |(k, &(at, kind)): (usize, &(Vec2, NotchKind))| {
        let in_size = |size: usize| {
            let piece = sized.get(&size)?;
            let is_alike = piece.notches.len() == own.notches.len();
            is_alike.then(|| piece.notches[k].0 * unit)
        };
        DrawnNotch {
            at: at * unit,
            in_sizes: (0..count).map(in_size).collect(),
            kind,
        }
    };
    own.notches.iter().enumerate().map(of).collect()
}

impl Reader {
    fn new(drawing: &DxfDrawing) -> Self {
        let mut style = Labels::default();
        for entity in &drawing.loose {
            if let Drawn::Text { text, .. } = &entity.drawn {
                style.add(text);
            }
        }
        let left_out = drawing.left_out.iter();
        let losses = left_out.map(|(kind, &count)| Loss {
            count,
            ..Loss::at(
                "",
                format!("{kind} entities"),
                "this program does not read them",
            )
        });
        Self {
            style,
            guesses: Vec::new(),
            losses: losses.collect(),
        }
    }

    /// The pieces of all blocks, each where the file puts it; without blocks, of what is drawn outside.
    fn pieces(&mut self, drawing: &DxfDrawing) -> Result<Vec<BlockPiece>, FormatError> {
        let insert_of = |block: &Block| drawing.inserts.iter().find(|i| i.block == block.name);
        let blocks = drawing.blocks.iter().map(|block| match insert_of(block) {
            Some(insert) => BlockPiece::of(&moved(block, insert)),
            None => BlockPiece::of(block),
        });
        let mut pieces: Vec<BlockPiece> = blocks.flat_map(split).collect();
        for (k, insert) in drawing.inserts.iter().enumerate() {
            let name = &insert.block;
            if drawing.blocks.iter().all(|block| block.name != *name) {
                let why = "the file has no block of that name";
                self.losses.push(Loss::at(name, "a piece put in", why));
            } else if drawing.inserts[..k]
                .iter()
                .any(|before| before.block == *name)
            {
                let why = "a piece is read where it is put in first";
                self.losses
                    .push(Loss::at(name, "a further place of a piece", why));
            }
        }
        if pieces.is_empty() {
            // The cut layer of the markers that this program writes.
            if drawing.loose.iter().any(|entity| entity.layer == "CUT") {
                return Err(FormatError::new(
                    "the whole file",
                    "this is a marker that `toile nest` wrote, not a pattern",
                    "give the pattern that it was made of",
                ));
            }
            pieces = self.loose(drawing);
        }
        if pieces.is_empty() {
            return Err(FormatError::new(
                "the whole file",
                "no closed line is in it that could be the outline of a piece",
                "export the pattern as DXF-AAMA or DXF-ASTM from the program that it comes from",
            ));
        }
        Ok(pieces)
    }

    /// The pieces of a drawing without blocks: its outermost closed lines, whatever layer they are on.
    fn loose(&mut self, drawing: &DxfDrawing) -> Vec<BlockPiece> {
        let block = Block {
            entities: drawing.loose.clone(),
            ..Block::default()
        };
        let mut piece = BlockPiece::of(&block);
        if piece.cut.is_empty() {
            let mut block = block;
            for entity in &mut block.entities {
                let is_line = matches!(entity.drawn, Drawn::Line { .. });
                if is_line && Layer::of(&entity.layer) == Layer::Other {
                    "1".clone_into(&mut entity.layer);
                }
            }
            piece = BlockPiece::of(&block);
        }
        let pieces = split(piece);
        if !pieces.is_empty() {
            self.guesses.push(Guess {
                what: "pieces",
                chosen: format!("{} outermost closed lines", pieces.len()),
                because: "the file has no blocks, which pieces are in these formats".to_owned(),
                option: "--from",
            });
        }
        pieces
    }

    /// The pattern of the pieces in metres; `inside` is the distance from a cut line to the sew line of pieces
    /// that have no other.
    fn drawn(
        &mut self,
        pieces: Vec<BlockPiece>,
        unit: f64,
        inside: Option<f64>,
    ) -> Result<DrawnPattern, FormatError> {
        let mut by_name: Vec<(String, Vec<BlockPiece>)> = Vec::new();
        for piece in pieces {
            let name = piece.name();
            match by_name.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sizes)) => sizes.push(piece),
                None => by_name.push((name, vec![piece])),
            }
        }
        let sizes = sizes(&by_name);
        let base = self.base(&sizes, &by_name);
        let mut drawn = DrawnPattern {
            sizes: sizes.clone(),
            base,
            ..DrawnPattern::default()
        };
        let mut without_sew_line = 0;
        for (name, blocks) in by_name {
            let sized = self.in_sizes((&name, blocks), (&sizes, base));
            let piece = self.piece((&name, &sized), (base, sizes.len()), unit, inside);
            without_sew_line += usize::from(piece.cut_line.is_none());
            drawn.pieces.push(piece);
        }
        if without_sew_line > 0 && inside.is_none() {
            self.guesses.push(Guess {
                what: "sew line",
                chosen: "the cut line with no allowance".to_owned(),
                because: format!(
                    "{without_sew_line} of {} pieces have no sew line",
                    drawn.pieces.len()
                ),
                option: "--inside",
            });
        }
        Ok(drawn)
    }

    /// Index of the base size: the one that the file names, else the one whose blocks hold most.
    fn base(&mut self, sizes: &[String], pieces: &[(String, Vec<BlockPiece>)]) -> usize {
        let named = self.style.value(&["samplesize"]);
        if let Some(k) = named.and_then(|name| sizes.iter().position(|size| size == name)) {
            return k;
        }
        let marks = |size: &String| {
            let all = pieces.iter().flat_map(|(_, blocks)| blocks);
            let own = all.filter(|piece| piece.size().as_ref() == Some(size));
            own.map(|piece| piece.turn_points.len() + piece.notches.len())
                .sum::<usize>()
        };
        let most = (0..sizes.len()).rev().max_by_key(|&k| marks(&sizes[k]));
        let base = most.unwrap_or(0);
        if sizes.len() > 1 && sizes.iter().filter(|size| marks(size) > 0).count() != 1 {
            self.guesses.push(Guess {
                what: "base size",
                chosen: sizes[base].clone(),
                because:
                    "the file names no sample size, and its pieces hold most marks in this one"
                        .to_owned(),
                option: "--from",
            });
        }
        base
    }

    /// A piece in all sizes, the index of each its size; sizes that do not fit the base are left out.
    fn in_sizes(
        &mut self,
        (name, blocks): (&str, Vec<BlockPiece>),
        (sizes, base): (&[String], usize),
    ) -> BTreeMap<usize, BlockPiece> {
        let mut sized: BTreeMap<usize, BlockPiece> = BTreeMap::new();
        for piece in blocks {
            let size = piece.size();
            let k = size.and_then(|size| sizes.iter().position(|known| *known == size));
            let k = k.unwrap_or(base);
            if sized.contains_key(&k) {
                self.losses.push(Loss::at(
                    name,
                    "a second block of one size",
                    format!("block {:?} is left out", piece.block),
                ));
                continue;
            }
            sized.insert(k, piece);
        }
        if !sized.contains_key(&base)
            && let Some((_, first)) = sized.pop_first()
        {
            // A piece that the base size lacks is the same in all sizes.
            sized.insert(base, first);
        }
        // The line that the panel becomes: the sew line where there is one.
        let count = |piece: &BlockPiece| {
            let sew = piece.sew.iter().find(|line| line.is_closed);
            sew.or(piece.cut.first())
                .map_or(0, |line| line.points.len())
        };
        let Some(expected) = sized.get(&base).map(count) else {
            return sized;
        };
        let unlike: Vec<usize> = sized
            .iter()
            .filter(|(_, piece)| count(piece) != expected)
            .map(|(&k, _)| k)
            .collect();
        if !unlike.is_empty() {
            let names: Vec<&str> = unlike.iter().map(|&k| sizes[k].as_str()).collect();
            self.losses.push(Loss {
                count: unlike.len(),
                ..Loss::at(
                    name,
                    format!("sizes {}", names.join(", ")),
                    "they have another number of vertices than the base size, whose shape they take",
                )
            });
            sized.retain(|k, _| !unlike.contains(k));
        }
        sized
    }

    fn piece(
        &mut self,
        (name, sized): (&str, &BTreeMap<usize, BlockPiece>),
        (base, count): (usize, usize),
        unit: f64,
        inside: Option<f64>,
    ) -> DrawnPiece {
        let Some(own) = sized.get(&base) else {
            return DrawnPiece::default();
        };
        let metres = |points: &[Vec2]| -> Vec<Vec2> { points.iter().map(|p| p * unit).collect() };
        // A line in all sizes: the same of each block, or that of the base size where a block lacks it.
        let in_all = |of: &dyn Fn(&BlockPiece) -> Option<BlockLine>| -> Option<DrawnLine> {
            let usual = of(own)?;
            let by_size = (0..count.max(1)).map(|k| {
                let line = sized.get(&k).and_then(of);
                let fits = line.filter(|line| line.points.len() == usual.points.len());
                metres(&fits.unwrap_or_else(|| usual.clone()).points)
            });
            Some(DrawnLine {
                by_size: by_size.collect(),
                is_closed: usual.is_closed,
                is_corner: Vec::new(),
            })
        };
        let cut = in_all(&|piece| piece.cut.first().cloned()).unwrap_or_default();
        let cut_points = cut.by_size.get(base).cloned().unwrap_or_default();
        let sew = in_all(&|piece| piece.sew.iter().find(|line| line.is_closed).cloned());
        // Valentina draws the sew line on the layer of internal lines.
        let on_internal = own.internal.iter().position(|line| {
            line.is_closed && is_evenly_inside(&metres(&line.points), &cut_points, MAX_ALLOWANCE)
        });
        let sew = sew.or_else(|| {
            let k = on_internal?;
            in_all(&|piece| piece.internal.get(k).cloned())
        });
        let is_on_internal = sew.is_some() && own.sew.is_empty();
        let fold = own
            .mirror
            .first()
            .map(|line| [line.points[0], line.points[line.points.len() - 1]].map(|p| p * unit));
        let sew = sew.or_else(|| self.inside(name, (&cut, base), fold, inside?));
        let is_found = sew.is_some();
        let mut outline = sew.unwrap_or_else(|| cut.clone());
        // Turn points stand on the cut line; the sew line of most files has as many vertices.
        let marked = match outline.len() == cut.len() {
            true => &cut,
            false => &outline,
        };
        outline.is_corner = self.corners(marked.in_size(base), own, unit);
        outline.drop_repeats(REPEAT);
        let mut inside_lines = Vec::new();
        for k in 0..own.internal.len() {
            if is_on_internal && on_internal == Some(k) {
                continue;
            }
            inside_lines.extend(in_all(&|piece| piece.internal.get(k).cloned()));
        }
        let holes = own
            .cutouts
            .iter()
            .enumerate()
            .filter(|(_, line)| line.is_closed);
        let holes = holes.filter_map(|(k, _)| in_all(&|piece| piece.cutouts.get(k).cloned()));
        let mut piece = DrawnPiece {
            name: name.to_owned(),
            fabric: own.labels.value(&["fabric", "material"]).map(str::to_owned),
            cut: self.quantity(own),
            cut_line: is_found.then_some(cut_points),
            holes: holes.collect(),
            inside: inside_lines,
            notches: notches(own, sized, (count, unit)),
            grain: own
                .grain
                .iter()
                .max_by(|a, b| a.length().total_cmp(&b.length()))
                .map(|line| {
                    let along = line.points[line.points.len() - 1] - line.points[0];
                    along.y.atan2(along.x)
                }),
            fold,
            outline,
        };
        for line in piece.inside.iter_mut().chain(&mut piece.holes) {
            line.drop_repeats(REPEAT);
        }
        piece.inside.retain(|line| line.len() > 1);
        piece.holes.retain(|line| line.len() > 2);
        self.left_out(name, own);
        piece
    }

    /// A sew line at a distance inside a cut line, but on it along the fold; `None`, with a loss, where the piece
    /// is too narrow for it.
    fn inside(
        &mut self,
        name: &str,
        (cut, base): (&DrawnLine, usize),
        fold: Option<[Vec2; 2]>,
        by: f64,
    ) -> Option<DrawnLine> {
        let mut line = cut.clone();
        if ring_area(line.in_size(base)) < 0.0 {
            line.reverse();
        }
        let ends = fold.map(|[a, b]| [a, b, a]);
        let ring = line.in_size(base).to_vec();
        let on_fold = |k: usize| {
            let on = |p: Vec2| match &ends {
                Some(ends) => distance(p, ends) <= ON_VERTEX,
                None => false,
            };
            on(ring[k]) && on(ring[(k + 1) % ring.len()])
        };
        let by = |k: usize| if on_fold(k) { 0.0 } else { by };
        let moved: Option<Vec<Vec<Vec2>>> = line
            .by_size
            .iter()
            .map(|points| inset(points, by))
            .collect();
        match moved {
            Some(by_size) => {
                line.by_size = by_size;
                if ring_area(cut.in_size(base)) < 0.0 {
                    line.reverse();
                }
                Some(line)
            }
            None => {
                self.losses.push(Loss::at(
                    name,
                    "the allowance that was asked for",
                    "the piece is too narrow for it",
                ));
                None
            }
        }
    }

    /// For each vertex, whether a turn point of the file lies there; empty without turn points.
    fn corners(&self, vertices: &[Vec2], own: &BlockPiece, unit: f64) -> Vec<bool> {
        if own.turn_points.is_empty() {
            return Vec::new();
        }
        let mut is_corner = vec![false; vertices.len()];
        for point in &own.turn_points {
            let at = point * unit;
            let near = |k: &usize| (vertices[*k] - at).norm();
            let best = (0..vertices.len()).min_by(|a, b| near(a).total_cmp(&near(b)));
            if let Some(k) = best.filter(|k| near(k) <= ON_VERTEX) {
                is_corner[k] = true;
            }
        }
        match is_corner.iter().any(|&is_corner| is_corner) {
            true => is_corner,
            false => Vec::new(),
        }
    }

    fn quantity(&mut self, own: &BlockPiece) -> Cut {
        match own.labels.quantity() {
            None => Cut::default(),
            Some([left, 0]) => Cut {
                quantity: left,
                mirrored: false,
            },
            Some([0, right]) => Cut {
                quantity: right,
                mirrored: false,
            },
            Some([left, right]) => Cut {
                quantity: left + right,
                mirrored: true,
            },
        }
    }

    /// Tells what of a block has no place in the document.
    fn left_out(&mut self, name: &str, own: &BlockPiece) {
        let no_place = "the document has no place for them";
        let all = [
            (own.drills.len(), "drill holes", no_place),
            (
                own.rules.len(),
                "numbers of grade rules",
                "rules come from the blocks of sizes, or from a table given with --with",
            ),
            (own.u_notches, "U notches", "read as V notches"),
            (
                own.depths,
                "depths of notches",
                "all are cut as deep as this program does",
            ),
            (own.open_cuts, "cut lines", "they are not closed"),
            (own.references + own.axes.len(), "reference lines", no_place),
            (
                own.others,
                "lines and points on layers of no standard",
                "their meaning is not known",
            ),
            (own.labels.others.len(), "texts", no_place),
        ];
        for (count, what, why) in all.into_iter().filter(|(count, ..)| *count > 0) {
            // What several pieces lose is told once.
            let alike = |loss: &&mut Loss| loss.what == what && loss.why == why;
            match self.losses.iter_mut().find(alike) {
                Some(loss) => {
                    loss.count += count;
                    loss.place.clear();
                }
                None => self.losses.push(Loss {
                    count,
                    ..Loss::at(name, what, why)
                }),
            }
        }
    }
}
