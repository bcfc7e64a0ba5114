//! Which panes of the window and which overlays of the pattern are visible.

use crate::canvas::selection::Selection;
use crate::tables::FabricTable;
use crate::tables::WearerTable;
use serde::{Deserialize, Serialize};
use toile_pattern::VariableId;

/// Visibility of the parts of the window that can be hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Panes {
    /// The 3D view.
    pub garment: bool,
    /// The marker.
    pub marker: bool,
    /// Measurements, variables, sizes, history.
    pub tables: bool,
    /// Whether these stand under the garment, beside the pattern; else they stand below it. Until they were
    /// dragged, where there is room.
    pub tables_beside: Option<bool>,
    /// Names of the tools beside their signs.
    pub tool_names: bool,
    /// The list of faults.
    pub findings: bool,
    /// Lines to cut along.
    pub allowances: bool,
    /// Rulers.
    pub rulers: bool,
    /// Guides.
    pub guides: bool,
}

impl Default for Panes {
    fn default() -> Self {
        Self {
            garment: true,
            marker: false,
            tables: false,
            tables_beside: None,
            tool_names: false,
            findings: false,
            allowances: true,
            rulers: true,
            guides: true,
        }
    }
}

/// Which table is on show, and what is typed into it.
#[derive(Default)]
pub struct Tables {
    pub tab: Tab,
    pub new_variable: String,
    pub new_measurement: String,
    /// A variable was added and is to be seen.
    pub added: bool,
    /// A measurement whose first value is to be typed next.
    pub entered_measurement: Option<String>,
    pub fabric: FabricTable,
    pub wearer: WearerTable,
    /// A variable whose number is to be typed next.
    pub entered_variable: Option<VariableId>,
}

impl Tables {
    /// The least height that a table is of use in (pixels).
    pub fn least_height(&self) -> f32 {
        match self.tab {
            Tab::Fabric | Tab::Wearer => 290.0,
            Tab::WornWith => 180.0,
            Tab::Measurements | Tab::Variables | Tab::History | Tab::Pattern => 80.0,
        }
    }

    /// Leaves what is typed: another document is opened.
    pub fn forget_typed(&mut self) {
        *self = Self {
            tab: self.tab,
            ..Self::default()
        };
    }
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub enum Tab {
    #[default]
    Measurements,
    Variables,
    Fabric,
    Wearer,
    WornWith,
    History,
    Pattern,
}

/// In which corner of the table the inspector stands, and what it tells there.
#[derive(Default)]
pub(crate) struct InspectorPlace {
    /// What was selected when it got there.
    pub told: Selection,
    /// Whether it is the left corner.
    pub is_left: bool,
}
