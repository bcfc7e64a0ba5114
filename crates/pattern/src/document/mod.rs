//! The document: the pattern that is edited, saved and undone.
//!
//! # Decided with
//! - [`crate::fields`](mod@crate::fields): each part lists its fields once, with `fields!`;
//! - [`crate::document::operation`], [`crate::document::panel`], [`crate::document::sheet`],
//!   [`crate::document::seam`], [`crate::document::marker`], [`crate::document::guide`]: parts of the
//!   document;
//! - [`crate::ids`], [`crate::name`]: ids that are given once; names that survive operations;
//! - [`crate::edit::Edit`]: every change of a document;
//! - [`crate::evaluate::Evaluation::take_over`] (`changes.rs`): lists of the document that an evaluation
//!   compares;
//! - [`crate::document::Pattern::blank`], [`crate::plan::NewPanel`]: what a new pattern has; fabric and
//!   allowance of a new panel;
//! - [`crate::describe`]: names of parts in words.
//!
//! By hand: a new list of parts in `take_over` and in `edit/references.rs` (`entities`). The compiler asks in
//! edits. A new pattern is begun by crate `session`, `perform.rs`.

mod builder;
mod cloth_record;
mod edge_corner;
mod guide;
mod lineage;
#[macro_use]
mod cloth_settings;
mod marker;
mod operation;
mod panel;
mod piece_rule;
mod seam;
mod sheet;

pub use builder::PanelBuilder;
pub use cloth_settings::{
    ClothSettings, DEFAULT_GAP, DEFAULT_SELVEDGE, Flaw, LaidCloth, NapRule, Print, Roll, Spread,
};
pub use edge_corner::{Corner, EdgeCorner, MitreLimit};
pub use guide::{Guide, GuideRun};
pub(crate) use lineage::StageLineage;
pub use marker::{
    GarmentCloth, MAX_GARMENTS, Marker, MarkerKeeps, OrderedPiece, OrderedSize, PiecePlacement,
};
pub use operation::{
    Apex, Bridge, Operation, OperationKind, PleatKind, PleatLine, Pressed, Side, SpreadCut, Turned,
};
pub use panel::{Cut, Edge, Line, LineKind, Notch, NotchKind, Panel, Source, WornRule};
pub use piece_rule::{
    FurtherFabric, LayingRule, MarkRef, MatchedMarks, PieceRule, RULE_FLAGS, RuleFlag, RuledPieces,
    Turn,
};
pub use seam::{Seam, Span};
pub use sheet::{Curve, CurveRule, Knot, Point, PointRule, Sheet};

use crate::fields::{Choice, ValueField, any, group, key};
use crate::{
    CurveId, Fabric, FabricId, Ids, Number, PanelId, PointId, SeamId, SheetId, SizeId, VariableId,
    fields,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use strum::{VariantArray, VariantNames};
use toile_measure::Measurements;

/// Longest name of a part (characters).
pub const NAME_LENGTH: usize = 80;

/// A pattern. Cloning is cheap: parts are shared until they are edited.
///
/// Fields are public, so a pattern may be inconsistent; drafting and `check` then report the faults.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pattern {
    /// Name to show.
    pub name: String,
    /// Unit in which lengths are shown and written; in memory all lengths are in metres.
    pub unit: DisplayUnit,
    /// Named tables of measurements, in the order they are offered.
    pub sizes: Vec<Arc<Size>>,
    /// The size used when no other is asked for; `None`: the first size.
    pub base_size: Option<SizeId>,
    /// Named numbers for formulas.
    pub variables: Vec<Arc<Variable>>,
    /// The fabrics that panels are cut from.
    pub fabrics: Vec<Arc<Fabric>>,
    /// Drafting planes with points and curves.
    pub sheets: Vec<Arc<Sheet>>,
    /// The flat pieces of the garment.
    pub panels: Vec<Arc<Panel>>,
    /// The seams.
    pub seams: Vec<Arc<Seam>>,
    /// Markers: pieces laid on fabric to be cut together.
    #[serde(default)]
    pub markers: Vec<Arc<Marker>>,
    /// Guides: lines across the table to draw against.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub guides: Vec<Arc<Guide>>,
    /// Source of the ids of new parts.
    pub ids: Ids,
}

fields!(Pattern, |self, v| {
    let Self {
        name,
        unit,
        sizes,
        base_size,
        variables,
        fabrics,
        sheets,
        panels,
        seams,
        markers,
        guides,
        ids: Ids { next: next_id },
    } = self;
    v.value(key("name"), name);
    // The unit is read before the first length, because lengths are given in this unit.
    v.value(key("unit").may_lack(), unit);
    v.optional("base_size", base_size);
    if let Some(base_size) = base_size {
        v.id("base_size", base_size);
    }
    v.each(group("sizes"), sizes);
    v.each(group("variables"), variables);
    v.each(group("fabrics"), fabrics);
    v.each(group("sheets"), sheets);
    v.each(group("panels"), panels);
    v.each(group("seams"), seams);
    v.each(group("markers"), markers);
    v.each(group("guides"), guides);
    v.value(key("next_id"), next_id);
});

/// The unit lengths are shown and written in.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Hash,
    Default,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum DisplayUnit {
    /// Millimetres.
    #[strum(serialize = "mm")]
    Millimetre,
    /// Centimetres.
    #[default]
    #[strum(serialize = "cm")]
    Centimetre,
    /// Metres.
    #[strum(serialize = "m")]
    Metre,
    /// Inches.
    #[strum(serialize = "in")]
    Inch,
}

impl Choice for DisplayUnit {}

/// A named table of measurements.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Size {
    /// Identifier of the size.
    pub id: SizeId,
    /// Name, such as `M` or `42`.
    pub name: String,
    /// Measurements of the size.
    pub measurements: Measurements,
}

fields!(Size, |self, v| {
    let Self {
        id,
        name,
        measurements,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.measurements("measurements", measurements);
});

/// A named number that formulas may use. A value without a unit is a plain number; a length is written as a
/// formula with a unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Variable {
    /// Identifier of the variable.
    pub id: VariableId,
    /// Name in formulas.
    pub name: String,
    /// Value of the variable: a number or a formula.
    pub number: Number,
}

fields!(Variable, |self, v| {
    let Self { id, name, number } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.number(any("value"), number);
});

impl Pattern {
    /// An empty pattern.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// A pattern to start drafting with: one empty sheet, and poplin as its fabric.
    pub fn blank(name: impl Into<String>) -> Self {
        let mut pattern = Self::new(name);
        let sheet = Sheet {
            id: pattern.ids.take(),
            name: "draft".into(),
            ..Sheet::default()
        };
        let fabric = Fabric::poplin(pattern.ids.take());
        pattern.sheets.push(Arc::new(sheet));
        pattern.fabrics.push(Arc::new(fabric));
        pattern
    }

    /// Whether another pattern has the same content; the ids that each would give to its next part may
    /// differ.
    pub fn says_the_same(&self, other: &Self) -> bool {
        let counted_alike = Self {
            ids: other.ids,
            ..self.clone()
        };
        counted_alike == *other
    }

    /// The sheet with this id.
    pub fn sheet(&self, id: SheetId) -> Option<&Arc<Sheet>> {
        self.sheets.iter().find(|sheet| sheet.id == id)
    }

    /// A point, and the sheet that it is on.
    pub fn point(&self, id: PointId) -> Option<(&Arc<Sheet>, &Arc<Point>)> {
        let mut sheets = self.sheets.iter();
        sheets.find_map(|sheet| Some((sheet, sheet.point(id)?)))
    }

    /// A curve, and the sheet that it is on.
    pub fn curve(&self, id: CurveId) -> Option<(&Arc<Sheet>, &Arc<Curve>)> {
        let mut sheets = self.sheets.iter();
        sheets.find_map(|sheet| Some((sheet, sheet.curve(id)?)))
    }

    /// The panel with this id.
    pub fn panel(&self, id: PanelId) -> Option<&Arc<Panel>> {
        self.panels.iter().find(|panel| panel.id == id)
    }

    /// The panel with this name.
    pub fn panel_named(&self, name: &str) -> Option<&Arc<Panel>> {
        self.panels.iter().find(|panel| panel.name == name)
    }

    /// The seam with this id.
    pub fn seam(&self, id: SeamId) -> Option<&Arc<Seam>> {
        self.seams.iter().find(|seam| seam.id == id)
    }

    /// The fabric with this id.
    pub fn fabric(&self, id: FabricId) -> Option<&Arc<Fabric>> {
        self.fabrics.iter().find(|fabric| fabric.id == id)
    }

    /// The variable with this name.
    pub fn variable_named(&self, name: &str) -> Option<&Arc<Variable>> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// The size with this name.
    pub fn size_named(&self, name: &str) -> Option<&Arc<Size>> {
        self.sizes.iter().find(|size| size.name == name)
    }

    /// Measurements of the size with this name.
    pub fn size(&self, name: &str) -> Option<&Measurements> {
        self.size_named(name).map(|size| &size.measurements)
    }

    /// The base size: the chosen size if there is one, otherwise the first size. `None`: the pattern has no
    /// sizes.
    pub fn base(&self) -> Option<&Arc<Size>> {
        let chosen = self
            .sizes
            .iter()
            .find(|size| Some(size.id) == self.base_size);
        chosen.or_else(|| self.sizes.first())
    }

    /// The measurements of the base size.
    pub fn base_measurements(&self) -> Option<&Measurements> {
        self.base().map(|size| &size.measurements)
    }
}

/// Whether a part may have this name: 1 to 80 characters, no control characters, no single quotes (formulas
/// use them), no space at either end.
pub fn is_part_name(name: &str) -> bool {
    !name.is_empty()
        && name.trim() == name
        && name.chars().count() <= NAME_LENGTH
        && !name.chars().any(|c| c.is_control() || c == '\'')
}
