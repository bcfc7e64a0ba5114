//! The nest: blocks of one piece are its sizes.
//!
//! Names and sizes are told by labels. Most labels stand in the block of the sample size alone, so a block without them
//! is known by its own name, which ends in the size.

use super::block_piece::BlockPiece;
use super::labels::Labels;
use super::sizes::{is_size, ordered};
use crate::{Guess, Loss, ReadOption};
use std::collections::{BTreeMap, HashMap, HashSet};

/// A piece in its sizes.
#[derive(Clone, Debug, Default)]
pub(super) struct NestedPiece {
    pub name: String,
    /// The piece by the index of the size.
    pub sized: BTreeMap<usize, BlockPiece>,
}

/// All pieces in all sizes.
#[derive(Clone, Debug, Default)]
pub(super) struct Nest {
    /// Names of the sizes, from small to large; empty if there is one size only.
    pub sizes: Vec<String>,
    /// Index of the base size.
    pub base: usize,
    pub pieces: Vec<NestedPiece>,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
}

/// A block, with its size if it is known.
type InSize = (Option<String>, BlockPiece);

/// A piece by its name, with its blocks.
type Group = (String, Vec<InSize>);

/// A block with the name of its piece and its size, as far as they are known.
struct Named {
    name: Option<String>,
    size: Option<String>,
    piece: BlockPiece,
}

impl Nest {
    /// Puts the blocks of a file together.
    pub fn of(pieces: Vec<BlockPiece>, style: &Labels) -> Self {
        let mut nest = Self::default();
        let blocks = nest.named(pieces);
        let groups = grouped(blocks);
        let sizes = groups.iter().flat_map(|(_, sizes)| sizes);
        let mut names: Vec<String> = Vec::new();
        let mut known = HashSet::new();
        for (size, _) in sizes {
            if let Some(size) = size.as_ref().filter(|size| known.insert((*size).clone())) {
                names.push(size.clone());
            }
        }
        nest.sizes = ordered(names);
        nest.base = nest.base(style, &groups);
        for (name, blocks) in groups {
            let sized = nest.in_sizes(&name, blocks);
            nest.pieces.push(NestedPiece { name, sized });
        }
        nest
    }

    /// Names and sizes of blocks, from their labels or the names of the blocks.
    fn named(&mut self, pieces: Vec<BlockPiece>) -> Vec<Named> {
        let distinct = |of: &dyn Fn(&BlockPiece) -> Option<String>| -> Vec<String> {
            let mut known = HashSet::new();
            let all = pieces.iter().filter_map(of);
            all.filter(|size| known.insert(size.clone())).collect()
        };
        let mut sizes = distinct(&BlockPiece::size);
        // If all say the same, it is the sample size of the style.
        let of_sample = distinct(&BlockPiece::sample_size);
        let is_sample = sizes.is_empty() && of_sample.len() > 1;
        if is_sample {
            sizes = of_sample;
        }
        if sizes.len() < 2 && pieces.iter().any(|piece| piece.size().is_none()) {
            let of_names = self.sizes_of_names(&pieces, sizes.first());
            if !of_names.is_empty() {
                sizes = of_names;
            }
        }
        // Of two sizes that a name ends in, the longer one is meant.
        sizes.sort_by_key(|size| std::cmp::Reverse(size.len()));
        let mut names: HashMap<String, String> = HashMap::new();
        let blocks: Vec<InSize> = pieces
            .into_iter()
            .map(|piece| {
                let own = match is_sample {
                    true => piece.sample_size(),
                    false => piece.size(),
                };
                let end = || {
                    sizes
                        .iter()
                        .find(|size| piece.stem(size).is_some())
                        .cloned()
                };
                let size = own.or_else(end);
                let stem = size.as_deref().and_then(|size| piece.stem(size));
                if let (Some(stem), Some(label)) = (stem, piece.label()) {
                    names.entry(stem.to_owned()).or_insert(label.to_owned());
                }
                (size, piece)
            })
            .collect();
        let named = blocks.into_iter().map(|(size, piece)| {
            let stem = size.as_deref().and_then(|size| piece.stem(size));
            let of_stem = stem.map(|stem| names.get(stem).cloned().unwrap_or(stem.to_owned()));
            let name = piece.label().map(str::to_owned).or(of_stem);
            Named { name, size, piece }
        });
        named.collect()
    }

    /// The sizes that the names of blocks end in, where no label tells any, or those of the sample alone: every piece
    /// must have all of them, with as many vertices in each.
    fn sizes_of_names(&mut self, pieces: &[BlockPiece], sample: Option<&String>) -> Vec<String> {
        let mut by_stem: BTreeMap<&str, (HashSet<&str>, HashSet<usize>)> = BTreeMap::new();
        let mut sizes: Vec<&str> = Vec::new();
        for piece in pieces {
            let parts = piece.block.rsplit_once(['_', '-', ' ']);
            let Some((stem, size)) = parts.filter(|(_, size)| sample.is_some() || is_size(size))
            else {
                return Vec::new();
            };
            let own = by_stem.entry(stem).or_default();
            let is_first = own.0.insert(size);
            own.1
                .insert(piece.cut.first().map_or(0, |line| line.points.len()));
            if !is_first || own.1.len() > 1 {
                return Vec::new();
            }
            if !sizes.contains(&size) {
                sizes.push(size);
            }
        }
        let has_all = by_stem.values().all(|(own, _)| own.len() == sizes.len());
        let has_sample = sample.is_none_or(|sample| sizes.contains(&sample.as_str()));
        if sizes.len() < 2 || !has_all || !has_sample {
            return Vec::new();
        }
        self.guesses.push(Guess {
            what: "sizes",
            chosen: sizes.join(", "),
            because: "no text tells them, and the names of all blocks end so".to_owned(),
            option: ReadOption::Format,
        });
        sizes.into_iter().map(str::to_owned).collect()
    }

    /// Index of the base size: the one that the file names, else the one whose blocks hold most.
    fn base(&mut self, style: &Labels, groups: &[Group]) -> usize {
        let sizes = &self.sizes;
        let alike = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(a), Ok(b)) => a == b,
            _ => a.eq_ignore_ascii_case(b),
        };
        let named = style.value(&["samplesize", "basesize"]);
        let of_name = named.and_then(|name| sizes.iter().position(|size| alike(size, name)));
        if let Some(k) = of_name {
            return k;
        }
        let mut marks: HashMap<&str, usize> = HashMap::new();
        for (size, piece) in groups.iter().flat_map(|(_, blocks)| blocks) {
            *marks
                .entry(size.as_deref().unwrap_or_default())
                .or_default() += piece.marks();
        }
        let marks = |k: usize| marks.get(sizes[k].as_str()).copied().unwrap_or(0);
        let most = (0..sizes.len()).rev().max_by_key(|&k| marks(k));
        let base = most.unwrap_or(0);
        if sizes.len() > 1 && (0..sizes.len()).filter(|&k| marks(k) > 0).count() != 1 {
            let chosen = sizes[base].clone();
            self.guesses.push(Guess {
                what: "base size",
                chosen,
                because:
                    "the file names no sample size, and its pieces hold most marks in this one"
                        .to_owned(),
                option: ReadOption::Format,
            });
        }
        base
    }

    /// A piece in all sizes, the index of each its size; sizes that do not fit the base are left out.
    fn in_sizes(&mut self, name: &str, blocks: Vec<InSize>) -> BTreeMap<usize, BlockPiece> {
        let mut sized: BTreeMap<usize, BlockPiece> = BTreeMap::new();
        for (size, piece) in blocks {
            let k = size.and_then(|size| self.sizes.iter().position(|known| *known == size));
            // The first block of a size holds; groups have one of each.
            sized.entry(k.unwrap_or(self.base)).or_insert(piece);
        }
        if !sized.contains_key(&self.base) {
            // A piece that the base size lacks is there as in the size that holds most.
            let most = sized.iter().rev().max_by_key(|(_, piece)| piece.marks());
            let most = most.map(|(&k, piece)| (k, piece.clone()));
            if let Some((k, piece)) = most {
                sized.insert(self.base, piece);
                let why = format!(
                    "the piece is not in the base size, which takes its shape of size {}",
                    self.sizes.get(k).map_or("", String::as_str)
                );
                self.losses
                    .push(Loss::at(name, "the base size of a piece", why));
            }
        }
        self.unlike(name, &mut sized);
        sized
    }

    /// Leaves out sizes whose lines have another number of vertices than the base size.
    fn unlike(&mut self, name: &str, sized: &mut BTreeMap<usize, BlockPiece>) {
        let count = |piece: &BlockPiece| piece.outline().map_or(0, |line| line.points.len());
        let counts: HashSet<usize> = sized.values().map(count).collect();
        if counts.len() > 1 {
            // Some sizes may repeat their start where others do not.
            sized
                .values_mut()
                .for_each(BlockPiece::drop_repeated_starts);
        }
        let Some(expected) = sized.get(&self.base).map(count) else {
            return;
        };
        let unlike: Vec<usize> = sized
            .iter()
            .filter(|(_, piece)| count(piece) != expected)
            .map(|(&k, _)| k)
            .collect();
        if unlike.is_empty() {
            return;
        }
        let names: Vec<&str> = unlike.iter().map(|&k| self.sizes[k].as_str()).collect();
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
}

/// Blocks by the names of their pieces, in the order of the file. Where a name has two blocks of one size, they are told
/// apart by the names of the blocks, else they are pieces of their own.
fn grouped(blocks: Vec<Named>) -> Vec<Group> {
    let mut groups: Vec<(String, Vec<Named>)> = Vec::new();
    let mut index: HashMap<String, usize> = HashMap::new();
    for block in blocks {
        let name = block.name.clone().unwrap_or(block.piece.block.clone());
        match index.get(&name) {
            Some(&k) => groups[k].1.push(block),
            None => {
                index.insert(name.clone(), groups.len());
                groups.push((name, vec![block]));
            }
        }
    }
    let mut found = Vec::new();
    for (name, blocks) in groups {
        let sizes: HashSet<&Option<String>> = blocks.iter().map(|block| &block.size).collect();
        let is_single = sizes.len() == blocks.len();
        let mut own: Vec<Group> = Vec::new();
        // The next group for a block of a stem and a size.
        let mut taken: HashMap<(String, Option<String>), usize> = HashMap::new();
        let mut groups_of: HashMap<String, Vec<usize>> = HashMap::new();
        for block in blocks {
            let stem = match (is_single, &block.size) {
                (true, _) => String::new(),
                (false, Some(size)) => block.piece.stem(size).unwrap_or_default().to_owned(),
                (false, None) => block.piece.block.clone(),
            };
            let turn = taken.entry((stem.clone(), block.size.clone())).or_default();
            let groups = groups_of.entry(stem).or_default();
            if *turn == groups.len() {
                groups.push(own.len());
                own.push((name.clone(), Vec::new()));
            }
            own[groups[*turn]].1.push((block.size, block.piece));
            *turn += 1;
        }
        found.extend(own);
    }
    found
}
