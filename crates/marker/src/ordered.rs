//! The pieces that the order of a document's marker asks for, ready to be laid.

use crate::job::FabricJob;
use crate::pieces::{Garments, pieces_to_cut};
use crate::{FinishedMarker, MarkerError, NestOptions};
use std::collections::HashMap;
use std::sync::Arc;
use toile_interchange::{FabricSettings, FlawSettings, MarkerSettings, Metres, PrintSettings};
use toile_nesting::{Nap, NestingError, Strip};
use toile_pattern::{
    Draft, Fabric, GarmentCloth, Marker, MarkerCloth, NapRule, OrderedPiece, OrderedSize, Pattern,
    SizeId,
};

/// A pattern drafted to the sizes of an order; nothing stands for the wearer's.
pub type SizeDrafts = [(Option<SizeId>, Arc<Draft>)];

/// The pieces that a marker of a document cuts, as they are cut and as its fabric lies. It stays the
/// same while pieces are moved.
pub struct MarkerPieces {
    cloth: MarkerCloth,
    fabric: Fabric,
    order: Vec<OrderedSize>,
    /// What tells the wearer's pieces from those of sizes, where both are cut.
    whose: Option<String>,
    pub(crate) job: FabricJob,
    pub(crate) options: NestOptions,
    /// Which piece of the order each copy of each item is.
    pub(crate) keys: Vec<Vec<OrderedPiece>>,
    /// The item and copy of each piece.
    pub(crate) index: HashMap<OrderedPiece, (usize, u32)>,
}

impl MarkerPieces {
    /// The pieces of a marker of a pattern on what its garment is cut from, by the drafts to the sizes of the
    /// order; where sizes are cut with them, pieces of the wearer's carry the words that say whose they are. Sizes that
    /// are gone are passed over.
    ///
    /// # Errors
    /// The fabric is gone, a size was not drafted, nothing is cut from the fabric, a piece has no cut
    /// line or cannot be cut from fabric so spread.
    pub fn new(
        (pattern, garment): (&Pattern, &GarmentCloth),
        marker: &Marker,
        (drafts, whose): (&SizeDrafts, &str),
    ) -> Result<Self, MarkerError> {
        let id = marker.cloth.fabric;
        let of_panels = pattern.fabric(id);
        let fabric = pattern.marker_fabric(marker, garment);
        let (Some(of_panels), Some(fabric)) = (of_panels, fabric) else {
            return Err(MarkerError::Unknown {
                kind: "fabric of the marker",
                name: id.to_string(),
                hint: "give the marker one of the pattern's fabrics".to_owned(),
            });
        };
        let options = options_of(&marker.cloth, &fabric.name);
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
            cloth: marker.cloth.clone(),
            fabric,
            order: marker.order.clone(),
            whose: told(&marker.order, whose).map(str::to_owned),
            index: pairs.collect(),
            job,
            options,
            keys,
        })
    }

    /// Whether these are to the bit the pieces and the fabric of others.
    pub fn is_same(&self, other: &Self) -> bool {
        self.cloth == other.cloth
            && self.order == other.order
            && self.whose == other.whose
            && self.job.items == other.job.items
            && self.job.pieces == other.job.pieces
            && self.strip() == other.strip()
    }

    /// The fabric as it lies.
    pub fn strip(&self) -> &Strip {
        self.job.strip()
    }

    /// A marker of these pieces, judged, to be drawn and written.
    pub(crate) fn finished(&self, marker: toile_nesting::Marker) -> FinishedMarker {
        self.job.whole(marker, &self.options)
    }

    /// Whether a marker of a pattern cuts the same pieces from fabric that lies alike, as long as the drafts are
    /// the same.
    pub fn serve(
        &self,
        (pattern, garment): (&Pattern, &GarmentCloth),
        (marker, whose): (&Marker, &str),
    ) -> bool {
        self.cloth == marker.cloth
            && self.order == marker.order
            && self.whose.as_deref() == told(&marker.order, whose)
            && pattern.marker_fabric(marker, garment).as_ref() == Some(&self.fabric)
    }
}

/// Whose the wearer's pieces are, where an order cuts sizes beside them.
fn told<'a>(order: &[OrderedSize], whose: &'a str) -> Option<&'a str> {
    let is_mixed = order.len() > 1 && order.iter().any(|one| one.size.is_none());
    is_mixed.then_some(whose)
}

/// The sizes of an order that are there, and how many garments of each.
pub(crate) fn ordered(pattern: &Pattern, order: &[OrderedSize]) -> Vec<(Option<SizeId>, u32)> {
    let known = |id: SizeId| pattern.sizes.iter().any(|size| size.id == id);
    let there = order.iter().filter(|one| one.size.is_none_or(known));
    there.map(|one| (one.size, one.quantity)).collect()
}

/// The options of a search that follow from a marker's fabric.
fn options_of(cloth: &MarkerCloth, fabric: &str) -> NestOptions {
    let metres = |place: [f64; 2]| place.map(Metres);
    let settings = FabricSettings {
        print: cloth.print.map(|print| PrintSettings {
            repeat: metres(print.repeat),
            origin: metres(print.origin),
        }),
        flaws: Some(
            cloth
                .flaws
                .iter()
                .map(|flaw| FlawSettings {
                    at: metres(flaw.at),
                    size: metres(flaw.size),
                    clearance: Metres(flaw.clearance),
                })
                .collect(),
        ),
        ..FabricSettings::default()
    };
    NestOptions {
        width: cloth.width,
        length: cloth.length,
        selvedge: Some(cloth.selvedge),
        end_margin: Some(cloth.end_margin),
        gap: Some(cloth.gap),
        nap: cloth.nap.map(|rule| match rule {
            NapRule::None => Nap::None,
            NapRule::OneWay => Nap::OneWay,
            NapRule::PerGarment => Nap::PerBundle,
        }),
        tilt: Some(cloth.tilt),
        spread: Some(cloth.spread),
        plies: Some(cloth.plies),
        price_per_metre: cloth.price_per_metre,
        settings: MarkerSettings {
            currency: Some(cloth.currency.clone()),
            fabrics: [(fabric.to_owned(), settings)].into(),
            ..MarkerSettings::default()
        },
        keep_best: true,
        ..NestOptions::default()
    }
}
