//! Markers: which pieces of which sizes lie where on a fabric, to be cut together.
//!
//! x runs along the warp from the start of the fabric, y across it from the lower selvedge.

use super::{Flaw, NapRule, Pattern, Print, Spread};
use crate::fields::{FieldFault, ValueField, group, key};
use crate::{Fabric, FabricId, MarkerId, PanelId, SizeId, fields};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::sync::Arc;

/// Unusable edge at either side of fabric where nothing else is said [m].
pub const USUAL_SELVEDGE: f64 = 0.010;
/// Room for the blade between two pieces where nothing else is said [m].
pub const USUAL_GAP: f64 = 0.002;

/// Most garments of a size on a marker.
pub const MOST_GARMENTS: u32 = 2_000;

/// Pieces of one fabric, laid to be cut together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// Its id.
    pub id: MarkerId,
    /// Name to show, unique among markers.
    pub name: String,
    /// The fabric and how it is spread.
    pub cloth: MarkerCloth,
    /// How many garments of which sizes are cut.
    pub order: Vec<OrderedSize>,
    /// The placements. Pieces of the order that are not here wait to be laid.
    pub placements: Vec<PiecePlacement>,
}

fields!(
    Marker,
    |self, v| {
        let Self { id, name, cloth, order, placements } = self;
        v.own(id);
        v.value(ValueField::NAME, name);
        v.flat(cloth);
        v.each(group("order"), order);
        v.each(group("placements"), placements);
    },
    fault: |self| Self::fault(self)
);

/// Fabric as a marker takes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MarkerCloth {
    /// The fabric; the pieces cut from it are laid.
    pub fabric: FabricId,
    /// Whether they lie on it whatever the garment is cut from. Journals of older versions do not say it.
    #[serde(default)]
    pub keeps_fabric: bool,
    /// Full width laid open, of a tube its girth [m]; nothing means the roll's, or the fabric's own.
    pub width: Option<f64>,
    /// Length at hand, all plies together [m]; nothing means as much as it takes.
    pub length: Option<f64>,
    /// Unusable edge at either side [m].
    pub selvedge: f64,
    /// Fabric left free at either end [m].
    pub end_margin: f64,
    /// Least distance between two pieces [m].
    pub gap: f64,
    /// Which way pieces may point; nothing means as the fabric's nap has it.
    pub nap: Option<NapRule>,
    /// How far the grain of a piece may lie off the warp [rad].
    pub tilt: f64,
    /// How it is spread.
    pub spread: Spread,
    /// Layers cut at once; a fold does not count.
    pub plies: u32,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Currency of the price, as in EUR.
    pub currency: String,
    /// Print that repeats.
    pub print: Option<Print>,
    /// Flaws no piece may lie on.
    pub flaws: Vec<Flaw>,
}

impl Default for MarkerCloth {
    fn default() -> Self {
        Self::of(FabricId::default())
    }
}

fields!(MarkerCloth, |self, v| {
    let Self {
        fabric,
        keeps_fabric,
        width,
        length,
        selvedge,
        end_margin,
        gap,
        nap,
        tilt,
        spread,
        plies,
        price_per_metre,
        currency,
        print,
        flaws,
    } = self;
    let same = |value: f64, usual: f64| value.to_bits() == usual.to_bits();
    v.id("fabric", fabric);
    v.value(
        key("keeps_fabric").left_out_if(!*keeps_fabric),
        keeps_fabric,
    );
    v.optional("width", width);
    if let Some(width) = width {
        v.value(key("width").length(), width);
    }
    v.optional("length", length);
    if let Some(length) = length {
        v.value(key("length").length(), length);
    }
    v.value(
        key("selvedge")
            .length()
            .left_out_if(same(*selvedge, USUAL_SELVEDGE)),
        selvedge,
    );
    v.value(
        key("end_margin")
            .length()
            .left_out_if(same(*end_margin, 0.0)),
        end_margin,
    );
    v.value(key("gap").length().left_out_if(same(*gap, USUAL_GAP)), gap);
    v.optional("nap", nap);
    if let Some(nap) = nap {
        v.value(key("nap"), nap);
    }
    v.value(key("tilt").angle().left_out_if(same(*tilt, 0.0)), tilt);
    v.value(
        key("spread").left_out_if(*spread == Spread::default()),
        spread,
    );
    let usual = spread.usual_plies();
    v.value(
        key("plies")
            .left_out_if(*plies == usual)
            .count_if_absent(usual),
        plies,
    );
    v.optional("price_per_metre", price_per_metre);
    if let Some(price) = price_per_metre {
        v.value(key("price_per_metre"), price);
    }
    v.value(key("currency").left_out_if(currency.is_empty()), currency);
    v.optional("print", print);
    if let Some(print) = print {
        v.part(group("print"), print);
    }
    v.each(group("flaws"), flaws);
});

/// What a whole garment is cut from, where that is chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GarmentCloth {
    /// The fabric that takes the place of every panel's.
    pub fabric: Option<Arc<Fabric>>,
    /// Width of the roll [m]; nothing means the fabric's own.
    pub width: Option<f64>,
}

/// Garments of one size, or of the wearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct OrderedSize {
    /// The size; nothing is the wearer's: as the pattern is drafted for the garment.
    pub size: Option<SizeId>,
    /// How many garments, 1 to [`MOST_GARMENTS`].
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

/// One piece that an order cuts.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
pub struct OrderedPiece {
    /// The panel it is cut from.
    pub panel: PanelId,
    /// Number of the copy, from 0; of a mirrored pair the odd ones are mirror images.
    pub copy: u32,
    /// The size; nothing is the wearer's.
    pub size: Option<SizeId>,
    /// The garment, from 0 within its size.
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

/// Where a piece lies: its grain turned to +x, then turned over (y changes sign) if it is flipped,
/// then turned, then moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PiecePlacement {
    /// The piece.
    pub piece: OrderedPiece,
    /// Where the origin of its panel comes to lie [m].
    pub at: [f64; 2],
    /// Angle from the warp to its grain, counter-clockwise [rad].
    pub turn: f64,
    /// Whether it lies face down.
    pub flipped: bool,
    /// Whether it stays where it is while others are laid.
    pub locked: bool,
}

fields!(PiecePlacement, |self, v| {
    let Self {
        piece,
        at: [x, y],
        turn,
        flipped,
        locked,
    } = self;
    v.flat(piece);
    v.list(group("at"), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
    v.value(key("turn").angle().left_out_if(turn.to_bits() == 0), turn);
    v.value(key("flipped").left_out_if(!*flipped), flipped);
    v.value(key("locked").left_out_if(!*locked), locked);
});

/// What a marker keeps though the garment is cut otherwise.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerKeeps {
    /// Its fabric.
    Fabric {
        /// Its name.
        own: String,
        /// Name of what the garment is cut from.
        garments: String,
    },
    /// Its width.
    Width {
        /// Its own [m].
        own: f64,
        /// That of what the garment is cut from [m].
        garments: f64,
    },
}

impl MarkerCloth {
    /// Fabric spread open in one ply, of its own width and nap.
    pub fn of(fabric: FabricId) -> Self {
        Self {
            fabric,
            keeps_fabric: false,
            width: None,
            length: None,
            selvedge: USUAL_SELVEDGE,
            end_margin: 0.0,
            gap: USUAL_GAP,
            nap: None,
            tilt: 0.0,
            spread: Spread::Open,
            plies: 1,
            price_per_metre: None,
            currency: String::new(),
            print: None,
            flaws: Vec::new(),
        }
    }
}

impl Marker {
    /// Where a piece lies, if it is laid.
    pub fn placement(&self, piece: OrderedPiece) -> Option<&PiecePlacement> {
        self.placements.iter().find(|known| known.piece == piece)
    }

    /// How many garments of a size are cut.
    pub fn quantity(&self, size: Option<SizeId>) -> u32 {
        let own = self.order.iter().filter(|ordered| ordered.size == size);
        own.map(|ordered| ordered.quantity).sum()
    }

    /// The first thing that no marker may have.
    pub fn fault(&self) -> Option<FieldFault> {
        self.cloth
            .fault()
            .or_else(|| self.order_fault())
            .or_else(|| self.placement_fault())
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
                _ if ordered.quantity > MOST_GARMENTS => Some(fault(
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

impl MarkerCloth {
    fn fault(&self) -> Option<FieldFault> {
        let sound = |value: f64| value.is_finite() && value >= 0.0;
        let numbers = [
            ("width", self.width.unwrap_or_default()),
            ("length", self.length.unwrap_or_default()),
            ("selvedge", self.selvedge),
            ("end_margin", self.end_margin),
            ("gap", self.gap),
            ("tilt", self.tilt),
            ("price_per_metre", self.price_per_metre.unwrap_or_default()),
        ];
        let fault = |field, item, message: String, hint| FieldFault {
            field,
            item,
            message,
            hint,
        };
        if let Some((field, value)) = numbers.iter().find(|(_, value)| !sound(*value)) {
            let message = format!("the {} is {value}", field.replace('_', " "));
            return Some(fault(field, None, message, "give 0 or more"));
        }
        if !self.spread.allows(self.plies) {
            let message = format!("it is spread in {} plies", self.plies);
            return Some(fault("plies", None, message, Spread::PLIES));
        }
        if let Some(print) = &self.print
            && !(print.repeat.iter().all(|v| sound(*v))
                && print.origin.iter().all(|v| v.is_finite()))
        {
            let message = "the repeat of the print is not 0 or more".to_owned();
            return Some(fault("print", None, message, "give lengths"));
        }
        let flawed = |flaw: &Flaw| {
            let at = flaw.at.iter().all(|v| v.is_finite());
            at && flaw.size.iter().all(|v| sound(*v)) && sound(flaw.clearance)
        };
        let wrong = self.flaws.iter().position(|flaw| !flawed(flaw));
        wrong.map(|k| {
            let message = "the flaw's size or clearance is not 0 or more".to_owned();
            fault("flaws", Some(k), message, "give lengths")
        })
    }
}

impl Pattern {
    /// The marker with that id.
    pub fn marker(&self, id: MarkerId) -> Option<&Arc<Marker>> {
        self.markers.iter().find(|marker| marker.id == id)
    }

    /// The marker with that name.
    pub fn marker_named(&self, name: &str) -> Option<&Arc<Marker>> {
        self.markers.iter().find(|marker| marker.name == name)
    }

    /// The fabric that a marker's pieces lie on, as wide as it is there: what the garment is cut from, unless the
    /// marker keeps its own. Nothing where its own is gone.
    pub fn marker_fabric(&self, marker: &Marker, garment: &GarmentCloth) -> Option<Fabric> {
        let own = self.fabric(marker.cloth.fabric)?;
        let (fabric, roll) = match (marker.cloth.keeps_fabric, &garment.fabric) {
            (true, _) => (own, None),
            (false, Some(chosen)) => (chosen, garment.width),
            (false, None) => (own, garment.width),
        };
        Some(Fabric {
            width: marker.cloth.width.or(roll).unwrap_or(fabric.width),
            ..(**fabric).clone()
        })
    }

    /// What of a marker does not follow what the garment is cut from, in words.
    pub fn marker_keeps(&self, marker: &Marker, garment: &GarmentCloth) -> Option<MarkerKeeps> {
        let own = self.fabric(marker.cloth.fabric)?;
        let follows = Marker {
            cloth: MarkerCloth {
                keeps_fabric: false,
                width: None,
                ..marker.cloth.clone()
            },
            ..marker.clone()
        };
        let garments = self.marker_fabric(&follows, garment)?;
        let keeps_fabric = marker.cloth.keeps_fabric && garments.name != own.name;
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

    /// Every piece that a marker's order cuts from its fabric: by size, garment, panel and copy.
    /// Where the fabric lies double some of them are cut with another and not laid.
    pub fn ordered_pieces<'a>(
        &'a self,
        marker: &'a Marker,
    ) -> impl Iterator<Item = OrderedPiece> + 'a {
        let garments = marker
            .order
            .iter()
            .flat_map(|ordered| (0..ordered.quantity).map(|garment| (ordered.size, garment)));
        let fabric = marker.cloth.fabric;
        garments.flat_map(move |(size, garment)| {
            let panels = self
                .panels
                .iter()
                .filter(move |panel| panel.fabric == fabric);
            panels.flat_map(move |panel| {
                (0..panel.cut.quantity).map(move |copy| OrderedPiece {
                    panel: panel.id,
                    copy,
                    size,
                    garment,
                })
            })
        })
    }

    /// A piece of an order in words: panel, and of copy, size and garment what tells it from others.
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
