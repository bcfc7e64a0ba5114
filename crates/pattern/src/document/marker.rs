//! Markers: layouts of pieces of one or more sizes on a fabric, to be cut together.
//!
//! x runs along the warp from the start of the fabric, y across it from the lower selvedge.
//!
//! # Decided with
//! - [`crate::document::cloth_settings::ClothSettings`]: how the fabric is laid: settings, defaults, which
//!   come first;
//! - [`crate::document::piece_rule::LayingRule`], [`crate::document::piece_rule::MatchedMarks`]: rules of
//!   single pieces; marks on the same place of a print;
//! - [`crate::document::Pattern::marker_fabric`], [`crate::document::Pattern::marker_keeps`]: the garment's
//!   cloth or its own, and what does not follow;
//! - [`crate::plan`] (`marker.rs`): edits: markers made and ordered, pieces laid, turned, locked;
//! - [`crate::evaluate`] (`markers.rs`): parts it names that are gone;
//! - [`crate::document::cloth_record::ClothRecord`]: the cloth as journals write it.
//!
//! Shown in the window (`app/marker_cloth.rs`, `app/marker_laying.rs`, `app/marker_rules.rs`). Searched for by crate
//! `marker` (`options.rs`, `items.rs`); turns tried and judged by crate `nesting` (`turns.rs`, `rules.rs`). By hand,
//! overlaps and pieces beyond the fabric are watched (`clashes.rs`), and drops on pieces or flaws (crate `marker`,
//! `butting.rs`).

use super::cloth_record::ClothRecord;
use super::{ClothSettings, MatchedMarks, Panel, Pattern, PieceRule, RuledPieces};
use crate::fields::{FieldFault, ValueField, group, key};
use crate::{Fabric, FabricId, MarkerId, PanelId, SizeId, fields};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::sync::Arc;

/// Greatest number of garments of one size on a marker.
pub const MAX_GARMENTS: u32 = 2_000;

/// A marker: pieces of one fabric, laid to be cut together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "MarkerRecord", into = "MarkerRecord")]
pub struct Marker {
    /// Identifier of the marker.
    pub id: MarkerId,
    /// Name to show, unique among markers.
    pub name: String,
    /// The fabric whose pieces are laid: pieces of panels that are cut from it, and pieces that a rule cuts
    /// from it.
    pub fabric: FabricId,
    /// Whether all pieces lie on this fabric, even if the garment is cut from another.
    pub keeps_fabric: bool,
    /// Settings of how the fabric is laid.
    pub cloth: ClothSettings,
    /// Rules for single pieces.
    pub rules: Vec<PieceRule>,
    /// Sets of marks. All marks of a set must lie on the same place of the print.
    pub matched: Vec<MatchedMarks>,
    /// Number of garments of each size.
    pub order: Vec<OrderedSize>,
    /// Placements of pieces on the fabric. Pieces of the order that have no placement are not laid yet.
    pub placements: Vec<PiecePlacement>,
}

fields!(
    Marker,
    |self, v| {
        let Self {
            id,
            name,
            fabric,
            keeps_fabric,
            cloth,
            rules,
            matched,
            order,
            placements,
        } = self;
        v.own(id);
        v.value(ValueField::NAME, name);
        v.id("fabric", fabric);
        v.value(key("keeps_fabric").left_out_if(!*keeps_fabric), keeps_fabric);
        v.flat(cloth);
        v.each(group("rules"), rules);
        v.each(group("match"), matched);
        v.each(group("order"), order);
        v.each(group("placements"), placements);
    },
    fault: |self| Self::fault(self)
);

/// A marker as a journal stores it.
#[derive(Serialize, Deserialize)]
struct MarkerRecord {
    id: MarkerId,
    name: String,
    cloth: ClothRecord,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    rules: Vec<PieceRule>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    matched: Vec<MatchedMarks>,
    order: Vec<OrderedSize>,
    placements: Vec<PiecePlacement>,
}

impl From<Marker> for MarkerRecord {
    fn from(marker: Marker) -> Self {
        Self {
            id: marker.id,
            name: marker.name,
            cloth: ClothRecord::new(marker.fabric, marker.keeps_fabric, marker.cloth),
            rules: marker.rules,
            matched: marker.matched,
            order: marker.order,
            placements: marker.placements,
        }
    }
}

impl From<MarkerRecord> for Marker {
    fn from(record: MarkerRecord) -> Self {
        let (fabric, keeps_fabric) = record.cloth.fabric();
        Self {
            id: record.id,
            name: record.name,
            fabric,
            keeps_fabric,
            cloth: record.cloth.settings(),
            rules: record.rules,
            matched: record.matched,
            order: record.order,
            placements: record.placements,
        }
    }
}

/// The fabric chosen for the whole garment, if one is chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GarmentCloth {
    /// The fabric that replaces the fabric of every panel.
    pub fabric: Option<Arc<Fabric>>,
    /// Width of the roll (m); `None`: the width of the fabric.
    pub width: Option<f64>,
}

/// The number of garments of one size, or of the wearer's own measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct OrderedSize {
    /// The size; `None`: the wearer, with the pattern as drafted for the garment.
    pub size: Option<SizeId>,
    /// Number of garments, 1 to [`MAX_GARMENTS`].
    pub quantity: u32,
}

impl Default for OrderedSize {
    fn default() -> Self {
        Self {
            size: None,
            quantity: 1,
        }
    }
}

fields!(OrderedSize, |self, v| {
    let Self { size, quantity } = self;
    v.optional("size", size);
    if let Some(size) = size {
        v.id("size", size);
    }
    v.value(key("quantity").may_lack(), quantity);
});

/// One piece that an order needs: a copy of a panel for one garment.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct OrderedPiece {
    /// The panel that the piece is a copy of.
    pub panel: PanelId,
    /// Number of the copy, from 0; the odd copies of a mirrored pair are mirror images.
    pub copy: u32,
    /// The size; `None`: the wearer.
    pub size: Option<SizeId>,
    /// Number of the garment within its size, from 0.
    pub garment: u32,
}

fields!(OrderedPiece, |self, v| {
    let Self {
        panel,
        copy,
        size,
        garment,
    } = self;
    v.id("panel", panel);
    v.value(key("copy").left_out_if(*copy == 0), copy);
    v.optional("size", size);
    if let Some(size) = size {
        v.id("size", size);
    }
    v.value(key("garment").left_out_if(*garment == 0), garment);
});

/// Position of a piece on the fabric. The piece is first turned so that its grain runs along +x, then
/// mirrored (y changes sign) if `flipped`, then turned by `turn`, then moved to `at`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PiecePlacement {
    /// The piece.
    pub piece: OrderedPiece,
    /// Position of the origin of the piece's panel on the fabric (m).
    pub at: [f64; 2],
    /// Angle from the warp to the grain of the piece, counter-clockwise (rad).
    pub turn: f64,
    /// Whether the piece lies face down.
    pub flipped: bool,
    /// Whether the piece stays in place when other pieces are laid.
    pub locked: bool,
    /// Number of the roll that the piece lies on, from 0.
    #[serde(default, skip_serializing_if = "is_first")]
    pub roll: u16,
}

/// Whether a roll is the first one, which is left out of files.
fn is_first(roll: &u16) -> bool {
    *roll == 0
}

fields!(PiecePlacement, |self, v| {
    let Self {
        piece,
        at: [x, y],
        turn,
        flipped,
        locked,
        roll,
    } = self;
    v.flat(piece);
    v.list(group("at"), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
    v.value(key("turn").angle().left_out_if(turn.to_bits() == 0), turn);
    v.value(key("flipped").left_out_if(!*flipped), flipped);
    v.value(key("locked").left_out_if(!*locked), locked);
    v.value(key("roll").left_out_if(*roll == 0), roll);
});

/// A property in which a marker differs from the fabric that the garment is cut from, because the marker has
/// a value of its own.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerKeeps {
    /// The fabric.
    Fabric {
        /// Name of the marker's own fabric.
        own: String,
        /// Name of the fabric that the garment is cut from.
        garments: String,
    },
    /// The width.
    Width {
        /// The marker's own width (m).
        own: f64,
        /// Width of the fabric that the garment is cut from (m).
        garments: f64,
    },
}

impl Marker {
    /// Placement of a piece. `None`: the piece is not laid.
    pub fn placement(&self, piece: OrderedPiece) -> Option<&PiecePlacement> {
        self.placements.iter().find(|known| known.piece == piece)
    }

    /// Number of garments of a size.
    pub fn quantity(&self, size: Option<SizeId>) -> u32 {
        let own = self.order.iter().filter(|ordered| ordered.size == size);
        own.map(|ordered| ordered.quantity).sum()
    }

    /// The rule for a copy of a panel: a field that the copy's own rule leaves open is taken from the rule
    /// for the panel, then from the rule for all pieces.
    pub fn rule_for(&self, panel: PanelId, copy: u32) -> PieceRule {
        let pieces = [
            RuledPieces::Copy(panel, copy),
            RuledPieces::Panel(panel),
            RuledPieces::All,
        ];
        let rules = pieces
            .iter()
            .filter_map(|pieces| self.rules.iter().find(|rule| rule.pieces == *pieces));
        rules.fold(PieceRule::default(), |rule, below| PieceRule {
            pieces: rule.pieces,
            rule: rule.rule.over(&below.rule),
            fabric: rule.fabric.or(below.fabric),
            also: rule.also.or_else(|| below.also.clone()),
        })
    }

    /// Fault of the first setting, rule, order or placement that is not allowed in a marker.
    pub fn fault(&self) -> Option<FieldFault> {
        self.cloth
            .fault()
            .or_else(|| self.rule_fault())
            .or_else(|| self.order_fault())
            .or_else(|| self.placement_fault())
    }

    fn rule_fault(&self) -> Option<FieldFault> {
        let fault = |field, k, message: String, hint| FieldFault {
            field,
            item: Some(k),
            message,
            hint,
        };
        let rules = self.rules.iter().enumerate().find_map(|(k, rule)| {
            let twice = self.rules[..k]
                .iter()
                .any(|other| other.pieces == rule.pieces);
            match rule.rule.fault() {
                Some((message, hint)) => Some(fault("rules", k, message, hint)),
                None if twice => {
                    let message = "the same pieces have two rules".to_owned();
                    Some(fault("rules", k, message, "say it in one of them"))
                }
                None => None,
            }
        });
        let few = |marks: &MatchedMarks| marks.0.len() < 2;
        rules.or_else(|| {
            let k = self.matched.iter().position(few)?;
            let message = "it names fewer than two marks".to_owned();
            Some(fault("match", k, message, "name two"))
        })
    }

    fn order_fault(&self) -> Option<FieldFault> {
        let mut seen = HashSet::new();
        self.order.iter().enumerate().find_map(|(k, ordered)| {
            let fault = |message: &str, hint| FieldFault {
                field: "order",
                item: Some(k),
                message: message.to_owned(),
                hint,
            };
            match seen.insert(ordered.size) {
                _ if ordered.quantity == 0 => Some(fault(
                    "no garment of the size is cut",
                    "give a quantity of 1 or more, or leave the size out",
                )),
                _ if ordered.quantity > MAX_GARMENTS => Some(fault(
                    "more than 2000 garments of the size are cut",
                    "make several markers",
                )),
                false => Some(fault("the size is ordered twice", "keep one of them")),
                true => None,
            }
        })
    }

    fn placement_fault(&self) -> Option<FieldFault> {
        let mut seen = HashSet::new();
        self.placements.iter().enumerate().find_map(|(k, laid)| {
            let fault = |message: &str, hint| FieldFault {
                field: "placements",
                item: Some(k),
                message: message.to_owned(),
                hint,
            };
            let numbers = [laid.at[0], laid.at[1], laid.turn];
            match seen.insert(laid.piece) {
                _ if numbers.iter().any(|number| !number.is_finite()) => Some(fault(
                    "its place has a number that is not finite",
                    "give it a place, or take it off the marker",
                )),
                false => Some(fault("the piece is laid twice", "keep one of them")),
                true => None,
            }
        })
    }
}

impl Pattern {
    /// The marker with this id.
    pub fn marker(&self, id: MarkerId) -> Option<&Arc<Marker>> {
        self.markers.iter().find(|marker| marker.id == id)
    }

    /// The marker with this name.
    pub fn marker_named(&self, name: &str) -> Option<&Arc<Marker>> {
        self.markers.iter().find(|marker| marker.name == name)
    }

    /// The fabric that a marker's pieces lie on, with the width used: the fabric that the garment is cut
    /// from, unless the marker keeps its own. `None`: the marker's own fabric no longer exists.
    pub fn marker_fabric(&self, marker: &Marker, garment: &GarmentCloth) -> Option<Fabric> {
        let own = self.fabric(marker.fabric)?;
        let (fabric, roll) = match (marker.keeps_fabric, &garment.fabric) {
            (true, _) => (own, None),
            (false, Some(chosen)) => (chosen, garment.width),
            (false, None) => (own, garment.width),
        };
        Some(Fabric {
            width: marker.cloth.width.or(roll).unwrap_or(fabric.width),
            ..(**fabric).clone()
        })
    }

    /// The property in which a marker differs from the fabric that the garment is cut from, if any.
    pub fn marker_keeps(&self, marker: &Marker, garment: &GarmentCloth) -> Option<MarkerKeeps> {
        let own = self.fabric(marker.fabric)?;
        let follows = Marker {
            fabric: marker.fabric,
            ..Marker::default()
        };
        let garments = self.marker_fabric(&follows, garment)?;
        let keeps_fabric = marker.keeps_fabric && garments.name != own.name;
        if keeps_fabric {
            return Some(MarkerKeeps::Fabric {
                own: own.name.clone(),
                garments: garments.name,
            });
        }
        let is_chosen = garment.fabric.is_some() || garment.width.is_some();
        let own = marker
            .cloth
            .width
            .filter(|own| is_chosen && *own != garments.width)?;
        Some(MarkerKeeps::Width {
            own,
            garments: garments.width,
        })
    }

    /// All pieces that a marker's order cuts from its fabric, by size, garment, panel and copy. On folded or
    /// tubular fabric some of them are cut in the layer below another piece and are not laid themselves.
    pub fn ordered_pieces<'a>(
        &'a self,
        marker: &'a Marker,
    ) -> impl Iterator<Item = OrderedPiece> + 'a {
        let garments = marker
            .order
            .iter()
            .flat_map(|ordered| (0..ordered.quantity).map(|garment| (ordered.size, garment)));
        garments.flat_map(move |(size, garment)| {
            let panels = self.panels.iter();
            panels.flat_map(move |panel| {
                let copies = copies_on(marker, panel);
                copies.map(move |copy| OrderedPiece {
                    panel: panel.id,
                    copy,
                    size,
                    garment,
                })
            })
        })
    }

    /// Description of a piece of an order: its panel, and copy, size and garment if needed to tell it from
    /// other pieces.
    pub fn piece_words(&self, piece: OrderedPiece) -> String {
        let panel = self.panel(piece.panel);
        let name = panel.map_or_else(|| piece.panel.to_string(), |p| format!("{:?}", p.name));
        let mut words = format!("piece {name}");
        if piece.copy > 0 || panel.is_some_and(|panel| panel.cut.quantity > 1) {
            words += &format!(", copy {}", piece.copy + 1);
        }
        if let Some(id) = piece.size {
            let found = self.sizes.iter().find(|size| size.id == id);
            let size = found.map_or_else(|| id.to_string(), |size| format!("size {:?}", size.name));
            words += &format!(", {size}");
        } else if !self.sizes.is_empty() {
            words += ", the wearer's";
        }
        let garments = self
            .markers
            .iter()
            .map(|marker| marker.quantity(piece.size));
        if piece.garment > 0 || garments.max().is_some_and(|most| most > 1) {
            words += &format!(", garment {}", piece.garment + 1);
        }
        words
    }
}

/// Numbers of the copies of a panel that are cut from a marker's fabric. Copies that are cut in addition,
/// such as interfacing, have the numbers after those of the panel's own copies.
fn copies_on<'a>(marker: &'a Marker, panel: &'a Panel) -> impl Iterator<Item = u32> + 'a {
    let own = move |copy: &u32| {
        let rule = marker.rule_for(panel.id, *copy);
        rule.fabric.unwrap_or(panel.fabric) == marker.fabric
    };
    let also = marker.rule_for(panel.id, 0).also.unwrap_or_default();
    let further = also.iter().filter(|also| also.fabric == marker.fabric);
    let further: u32 = further.map(|also| also.quantity).sum();
    let quantity = panel.cut.quantity;
    let beside = match quantity {
        0 => 0,
        _ => further,
    };
    (0..quantity)
        .filter(own)
        .chain(quantity..quantity.saturating_add(beside))
}
