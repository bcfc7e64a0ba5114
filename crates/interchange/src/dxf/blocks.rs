//! The pieces of a drawing: those of its blocks, each where the file puts it; without blocks, its outermost closed lines.

use super::block_piece::{BlockPiece, Layer};
use super::drawing::{Block, Drawn, DxfDrawing, Entity, Insert};
use super::labels::Labels;
use super::outlines::split;
use super::placed::moved;
use crate::{FormatError, Guess, Loss, ReadOption};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};

/// Most pieces of a file, each size counted.
const MAX_PIECES: usize = 20_000;

/// Contents of the blocks of a drawing hold.
#[derive(Clone, Debug, Default)]
pub(super) struct Pieces {
    /// The pieces, in the order of the file.
    pub pieces: Vec<BlockPiece>,
    /// Texts about the whole style.
    pub style: Labels,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
}

impl Pieces {
    /// The pieces of a drawing.
    ///
    /// # Errors
    /// There is none, or there are too many.
    pub fn of(drawing: &DxfDrawing) -> Result<Self, FormatError> {
        let mut found = Self::default();
        found.entities(drawing);
        // Names of blocks are the same in capitals and small letters.
        let mut inserts: HashMap<String, &Insert> = HashMap::new();
        let names: HashSet<String> = drawing
            .blocks
            .iter()
            .map(|b| b.name.to_uppercase())
            .collect();
        for insert in &drawing.inserts {
            let key = insert.block.to_uppercase();
            if !names.contains(&key) {
                let why = "the file has no block of that name";
                found
                    .losses
                    .push(Loss::at(&insert.block, "a piece put in", why));
                continue;
            }
            match inserts.entry(key) {
                Entry::Vacant(place) => {
                    place.insert(insert);
                }
                Entry::Occupied(_) => {
                    let why = "a piece is read where it is put in first";
                    let what = "a further place of a piece";
                    found.losses.push(Loss::at(&insert.block, what, why));
                }
            }
        }
        let mut placed = Vec::with_capacity(drawing.blocks.len());
        for block in &drawing.blocks {
            placed.push(match inserts.get(&block.name.to_uppercase()) {
                Some(insert) => moved(block, insert),
                None => block.clone(),
            });
        }
        let mut empty = Vec::new();
        for block in &placed {
            let piece = BlockPiece::of(block);
            let labels = piece.labels.clone();
            let own = split(piece);
            if own.is_empty() {
                // A text beside no piece is about the style.
                found.style.add_all(&labels);
                empty.push(block);
            }
            found.pieces.extend(own);
            found.check_count()?;
        }
        if found.pieces.is_empty() {
            found.loose(drawing, &placed)?;
        } else {
            found.left_out(drawing, &empty);
        }
        if found.pieces.is_empty() {
            return Err(FormatError::new(
                "the whole file",
                "no closed line is in it that could be the outline of a piece",
                "export the pattern as DXF-AAMA or DXF-ASTM from the program that it comes from",
            ));
        }
        found.check_count()?;
        Ok(found)
    }

    fn check_count(&self) -> Result<(), FormatError> {
        match self.pieces.len() > MAX_PIECES {
            false => Ok(()),
            true => Err(FormatError::new(
                "the whole file",
                format!("it has more than {MAX_PIECES} closed outlines"),
                "save fewer pieces or sizes in one file",
            )),
        }
    }

    /// Texts of the style, and entities that were not read as they are drawn.
    fn entities(&mut self, drawing: &DxfDrawing) {
        for entity in &drawing.loose {
            if let Drawn::Text { text, .. } = &entity.drawn {
                self.style.add(text);
            }
        }
        for (kind, &count) in &drawing.left_out {
            self.losses.push(Loss {
                count,
                ..Loss::at(
                    "",
                    format!("{kind} entities"),
                    "this program does not read them",
                )
            });
        }
        for (kind, &count) in &drawing.curves {
            let why = "read as curves that stay within 0.01 mm of them";
            self.losses.push(Loss {
                count,
                ..Loss::at("", format!("exact shapes of {kind}"), why)
            });
        }
    }

    /// Tells what lies in no piece.
    fn left_out(&mut self, drawing: &DxfDrawing, empty: &[&Block]) {
        let is_drawn = |entity: &&Entity| !matches!(entity.drawn, Drawn::Text { .. });
        let loose = drawing.loose.iter().filter(is_drawn).count();
        // Blocks with these signs belong to drawing programs.
        let drawn = |block: &&&Block| !block.name.starts_with(['*', '$']);
        let empty = empty.iter().filter(drawn).count();
        let all = [
            (
                loose,
                "lines and points outside of blocks",
                "pieces are blocks in this file",
            ),
            (empty, "blocks", "no closed outline is in them"),
        ];
        for (count, what, why) in all.into_iter().filter(|(count, ..)| *count > 0) {
            self.losses.push(Loss {
                count,
                ..Loss::at("", what, why)
            });
        }
    }

    /// The pieces of a drawing whose blocks are none: its outermost closed lines, on the layer of cut lines, else on
    /// layers of no standard.
    fn loose(&mut self, drawing: &DxfDrawing, blocks: &[Block]) -> Result<(), FormatError> {
        // The cut layer of the markers that this program writes.
        if drawing.loose.iter().any(|entity| entity.layer == "CUT") {
            let mut texts = drawing
                .loose
                .iter()
                .filter_map(|entity| match &entity.drawn {
                    Drawn::Text { text, .. } => Some(text.trim()),
                    Drawn::Line { .. } | Drawn::Point { .. } => None,
                });
            let title = texts.rfind(|text| !text.is_empty()).unwrap_or_default();
            let named = match title.is_empty() {
                true => String::new(),
                false => format!(" ({title})"),
            };
            return Err(FormatError::new(
                "the whole file",
                format!("this is a marker that `toile nest` wrote{named}, not a pattern"),
                "give the pattern that it was made of, NAME.toile.json",
            ));
        }
        let inside = blocks.iter().flat_map(|block| &block.entities);
        let mut block = Block {
            entities: drawing.loose.iter().chain(inside).cloned().collect(),
            ..Block::default()
        };
        let mut piece = BlockPiece::of(&block);
        if piece.cut.is_empty() {
            for entity in &mut block.entities {
                let is_line = matches!(entity.drawn, Drawn::Line { .. });
                if is_line && Layer::of(&entity.layer) == Layer::Other {
                    "1".clone_into(&mut entity.layer);
                }
            }
            piece = BlockPiece::of(&block);
        }
        if piece.cut.len() > MAX_PIECES {
            self.pieces.resize(MAX_PIECES + 1, BlockPiece::default());
            return self.check_count();
        }
        // The texts of the drawing are not about one of its pieces.
        piece.labels = Labels::default();
        self.pieces = split(piece);
        if !self.pieces.is_empty() {
            self.guesses.push(Guess {
                what: "pieces",
                chosen: format!("outermost closed lines ({})", self.pieces.len()),
                because: "the file has no blocks, which pieces are in these formats".to_owned(),
                option: ReadOption::Format,
            });
        }
        Ok(())
    }
}
