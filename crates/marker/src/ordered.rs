//! The pieces that the order of a document's marker requires, ready to be laid.

use crate::job::FabricJob;
use crate::pieces::{Garments, pieces_to_cut};
use crate::{MarkerError, NestOptions};
use std::collections::HashMap;
use std::sync::Arc;
use toile_nesting::{NestingError, Strip};
use toile_pattern::{
    Draft, Fabric, GarmentCloth, Marker, OrderedPiece, OrderedSize, Pattern, SizeId,
};

/// Drafts of a pattern, one for each size of an order; `None` stands for the wearer's own measurements.
pub type SizeDrafts = [(Option<SizeId>, Arc<Draft>)];

/// The pieces that a marker of a document cuts, with outlines and spread fabric. They do not change while
/// pieces are moved.
pub struct MarkerPieces {
    /// The marker that the pieces were made for, without placements.
    marker: Arc<Marker>,
    fabric: Fabric,
    /// Label that distinguishes the wearer's pieces from those of sizes, if both are cut.
    whose: Option<String>,
    pub(crate) job: FabricJob,
    /// For each copy of each item, its piece in the order.
    pub(crate) keys: Vec<Vec<OrderedPiece>>,
    /// Item and copy of each piece in the order.
    pub(crate) index: HashMap<OrderedPiece, (usize, u32)>,
}

impl MarkerPieces {
    /// The pieces of a pattern's marker on the garment's fabric, from drafts of the ordered sizes. If sizes
    /// are cut with them, the pieces of the wearer carry the label `whose`. Deleted sizes are skipped.
    ///
    /// # Errors
    /// The fabric was deleted, a size was not drafted, nothing is cut from the fabric, a piece has no cut
    /// line or cannot be cut from fabric with this spread.
    pub fn new(
        (pattern, garment): (&Pattern, &GarmentCloth),
        marker: &Marker,
        (drafts, whose): (&SizeDrafts, &str),
    ) -> Result<Self, MarkerError> {
        let id = marker.fabric;
        let of_panels = pattern.fabric(id);
        let fabric = pattern.marker_fabric(marker, garment);
        let (Some(of_panels), Some(fabric)) = (of_panels, fabric) else {
            return Err(MarkerError::Unknown {
                kind: "fabric of the marker",
                name: id.to_string(),
                hint: "give the marker one of the pattern's fabrics".to_owned(),
            });
        };
        let bare = Arc::new(Marker {
            placements: Vec::new(),
            ..marker.clone()
        });
        let options = NestOptions {
            marker: Some(bare.clone()),
            keep_best: true,
            ..NestOptions::default()
        };
        let ordered = ordered(pattern, &marker.order);
        let several = ordered.len() > 1;
        let mut garments = Vec::new();
        for (size, quantity) in &ordered {
            let name = size.and_then(|id| pattern.sizes.iter().find(|size| size.id == id));
            let draft = drafts.iter().find(|(known, _)| known == size);
            let (_, draft) = draft.ok_or_else(|| MarkerError::Unknown {
                kind: "draft",
                name: name.map_or_else(String::new, |size| size.name.clone()),
                hint: "draft the pattern to every size of the order".to_owned(),
            })?;
            garments.push(Garments {
                pattern,
                draft,
                count: *quantity,
                label: Some(name.map_or(whose, |size| &size.name)).filter(|_| several),
            });
        }
        let to_cut = pieces_to_cut(&garments, &options, Some(&of_panels.name))?;
        if to_cut.is_empty() {
            return Err(NestingError::NoItems.into());
        }
        let job = FabricJob::new((&fabric.name, &to_cut), Some(&fabric), &options)?;
        let keys = job.keys(&ordered);
        let pairs = keys.iter().enumerate().flat_map(|(item, copies)| {
            let copies = copies.iter().zip(0..);
            copies.map(move |(piece, copy)| (*piece, (item, copy)))
        });
        Ok(Self {
            marker: bare,
            fabric,
            whose: told(&marker.order, whose).map(str::to_owned),
            index: pairs.collect(),
            job,
            keys,
        })
    }

    /// Whether pieces and fabric are identical to those of `other`, bit by bit.
    pub fn is_same(&self, other: &Self) -> bool {
        cut_alike(&self.marker, &other.marker)
            && self.whose == other.whose
            && self.job.items == other.job.items
            && self.job.pieces == other.job.pieces
            && self.job.strips().eq(other.job.strips())
    }

    /// Names of the rolls in order; a single `None` if no rolls are defined.
    pub fn rolls(&self) -> impl Iterator<Item = Option<&str>> {
        self.job.roll_names()
    }

    /// The spread fabric of a roll.
    pub fn strip(&self, roll: usize) -> &Strip {
        self.job.strip(roll)
    }

    /// Whether a marker of a pattern cuts the same pieces from equally spread fabric, provided that the
    /// drafts are the same.
    pub fn serve(
        &self,
        (pattern, garment): (&Pattern, &GarmentCloth),
        (marker, whose): (&Marker, &str),
    ) -> bool {
        cut_alike(&self.marker, marker)
            && self.whose.as_deref() == told(&marker.order, whose)
            && pattern.marker_fabric(marker, garment).as_ref() == Some(&self.fabric)
    }
}

/// Whether two markers cut the same pieces from equally spread fabric.
fn cut_alike(one: &Marker, other: &Marker) -> bool {
    let settings = |marker: &Marker| Marker {
        placements: Vec::new(),
        name: String::new(),
        ..marker.clone()
    };
    settings(one) == settings(other)
}

/// Label of the wearer's pieces, if the order also contains sizes.
fn told<'a>(order: &[OrderedSize], whose: &'a str) -> Option<&'a str> {
    let is_mixed = order.len() > 1 && order.iter().any(|one| one.size.is_none());
    is_mixed.then_some(whose)
}

/// The sizes of an order that exist, with the number of garments of each.
pub(crate) fn ordered(pattern: &Pattern, order: &[OrderedSize]) -> Vec<(Option<SizeId>, u32)> {
    let known = |id: SizeId| pattern.sizes.iter().any(|size| size.id == id);
    let there = order.iter().filter(|one| one.size.is_none_or(known));
    there.map(|one| (one.size, one.quantity)).collect()
}
