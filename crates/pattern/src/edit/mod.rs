//! Edits: every change of a document puts in a part, removes a part, or moves a part within its list.
//! Planners work out the edits that an action of the user needs.
//!
//! # Decided with
//! - [`crate::document::Pattern::apply`] (`apply.rs`): edits applied, all or none;
//! - [`crate::edit::references`]: which parts a part refers to, and which refer to it;
//! - [`crate::plan::remove_parts`]: parts taken away with one;
//! - [`crate::ids::Ids`], [`crate::document::Pattern`]: ids given once;
//! - [`crate::plan`]: planners, which make the edits;
//! - [`crate::diagnostic::Code::MissingReference`]: lost parts told;
//! - [`crate::evaluate::Evaluation::take_changes`] (`graph.rs`): computed anew once the part is back.

mod apply;
mod references;

use crate::{
    Curve, DisplayUnit, Fabric, Guide, Marker, OperationId, Panel, PanelId, PartId, Point, Seam,
    SheetId, Size, SizeId, Variable,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// One change of a pattern. It gives new values, not differences, so its meaning does not depend on earlier
/// changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edit {
    /// Adds a part at the end of its list, or replaces the part with the same id.
    Put(Entity),
    /// Removes a part. References to it stay, and are valid again if the part comes back.
    Remove(PartId),
    /// Moves a part to another index of its list, counted from 0; an index beyond the end means the end.
    Order {
        /// The part.
        part: PartId,
        /// New index of the part in its list.
        at: usize,
    },
}

/// A part of a document, as edits contain it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Entity {
    /// Name, unit and base size of the pattern.
    Head(Head),
    /// A size.
    Size(Arc<Size>),
    /// A variable.
    Variable(Arc<Variable>),
    /// A fabric.
    Fabric(Arc<Fabric>),
    /// A sheet without its points and curves.
    Sheet(SheetHead),
    /// A point of a sheet.
    Point(SheetId, Arc<Point>),
    /// A curve of a sheet.
    Curve(SheetId, Arc<Curve>),
    /// A panel.
    Panel(Arc<Panel>),
    /// A seam.
    Seam(Arc<Seam>),
    /// A marker.
    Marker(Arc<Marker>),
    /// A guide.
    Guide(Arc<Guide>),
}

/// Properties of the pattern itself, which belong to no part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// Name to show.
    pub name: String,
    /// Unit in which lengths are shown.
    pub unit: DisplayUnit,
    /// The size used when no other is asked for.
    pub base_size: Option<SizeId>,
}

/// A sheet without its points and curves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SheetHead {
    /// Identifier of the sheet.
    pub id: SheetId,
    /// Name to show and for formulas.
    pub name: String,
    /// The panel stage that the sheet lies on, as in [`Sheet::on`](crate::Sheet::on); `None`: it lies on no
    /// panel.
    pub on: Option<(PanelId, Option<OperationId>)>,
    /// Position of the sheet's origin on the table (m).
    pub on_table: [f64; 2],
}

/// Reason why edits were refused. The document is unchanged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// The part that the edit names does not exist.
    #[error("{0} is not there: choose one that is")]
    Missing(String),
    /// A name cannot be used.
    #[error(
        "{0:?} cannot be a name: use 1 to 80 characters without quotes, control characters or spaces at the ends"
    )]
    Name(String),
    /// A name or id is used by another part.
    #[error("{0} is taken: choose another")]
    Taken(String),
    /// A number is not finite.
    #[error("{0} has a number that is not finite: give a finite one")]
    NotFinite(String),
    /// The part refers to an id that was never given, or to a part of another kind.
    #[error("{what} refers to {to}, which {why}: refer to a part of the document")]
    Reference {
        /// The part that contains the reference.
        what: String,
        /// The part that is referred to.
        to: String,
        /// The fault of the reference.
        why: &'static str,
    },
    /// The edit cannot be done in this document.
    #[error("{message}: {hint}")]
    Impossible {
        /// Description of the fault.
        message: String,
        /// Advice on how to remedy the fault.
        hint: String,
    },
}

impl Entity {
    /// Identifier of the part. `None`: the entity is the head of the pattern.
    pub fn id(&self) -> Option<PartId> {
        Some(match self {
            Self::Head(_) => return None,
            Self::Size(size) => size.id.into(),
            Self::Variable(variable) => variable.id.into(),
            Self::Fabric(fabric) => fabric.id.into(),
            Self::Sheet(sheet) => sheet.id.into(),
            Self::Point(_, point) => point.id.into(),
            Self::Curve(_, curve) => curve.id.into(),
            Self::Panel(panel) => panel.id.into(),
            Self::Seam(seam) => seam.id.into(),
            Self::Marker(marker) => marker.id.into(),
            Self::Guide(guide) => guide.id.into(),
        })
    }

    /// Name of the part. A guide has no name: for it, the name of its direction.
    pub fn name(&self) -> &str {
        match self {
            Self::Head(head) => &head.name,
            Self::Size(size) => &size.name,
            Self::Variable(variable) => &variable.name,
            Self::Fabric(fabric) => &fabric.name,
            Self::Sheet(sheet) => &sheet.name,
            Self::Point(_, point) => &point.name,
            Self::Curve(_, curve) => &curve.name,
            Self::Panel(panel) => &panel.name,
            Self::Seam(seam) => &seam.name,
            Self::Marker(marker) => &marker.name,
            Self::Guide(guide) => guide.runs.words(),
        }
    }
}
